"""The way round a corner: along the road's edge, round the arc, up the side street."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.dropped_curbs import Drop, lowering
from processing.laboratory.simulate.street.junction_shape import Corner, Mouth
from processing.laboratory.simulate.street.measures import BandSurfaces, measures_along
from processing.laboratory.simulate.street.plan import SidePlan
from processing.laboratory.simulate.street.profile import Course
from processing.laboratory.simulate.street.stones import StoneNodes, lay_stones, place_nodes_evenly
from processing.laboratory.simulate.street.unevenness import Waves

_ARC_STEP_M = 0.2


@dataclass(frozen=True)
class CornerTrack:
    """Nodes round a corner.

    Attributes
    ----------
    edge_m : float
        From the road's centre to its asphalt's edge.
    along : (n,) float64
        m from the section's end, by the asphalt's edge.
    first, last : int
        Nodes at which the arc begins and ends.
    """

    mouth: Mouth
    corner: Corner
    edge_m: float
    along: Floats
    first: int
    last: int

    @property
    def turned(self) -> Floats:
        """How much of the corner lies behind each node: 0 on the road, 1 in the side street."""
        length = self.along[self.last] - self.along[self.first]
        share: Floats = np.clip((self.along - self.along[self.first]) / length, 0.0, 1.0)
        return share

    def square(self, away: Floats) -> tuple[Floats, Floats]:
        """Metres from the section's end and beside the asphalt's edge, in the square frame."""
        deep = away - self.edge_m
        radius, turn = self.corner.radius_m, self.corner.turn_m
        on_road, in_street = float(deep[self.first]), float(deep[self.last])
        angle = self.turned * np.pi / 2
        is_sharp = max(on_road, in_street) >= radius
        arc_from_end = turn - radius + (radius - deep) * np.sin(angle)
        arc_beside = radius - (radius - deep) * np.cos(angle)
        if is_sharp:
            arc_from_end, arc_beside = turn - in_street + 0 * deep, on_road + 0 * deep
        nodes = np.arange(deep.size)
        before, after = nodes <= self.first, nodes >= self.last
        up = radius + self.along - self.along[self.last]
        from_end = np.where(before, self.along, np.where(after, turn - deep, arc_from_end))
        beside = np.where(before, deep, np.where(after, up, arc_beside))
        if is_sharp:
            from_end = np.where(before, np.minimum(from_end, turn - in_street), from_end)
            beside = np.where(after, np.maximum(beside, on_road), beside)
        return from_end, beside

    def chainages(self, from_end: Floats) -> Floats:
        """Chainages of the square frame."""
        late = self.corner.is_late
        return self.mouth.end_m - from_end if late else self.mouth.start_m + from_end

    def coordinates(self, away: Floats) -> tuple[Floats, Floats]:
        """Chainages and offsets of one line's nodes."""
        from_end, beside = self.square(away)
        return self.placed(self.chainages(from_end), beside)

    def placed(self, along: Floats, beside: Floats) -> tuple[Floats, Floats]:
        """Chainages and offsets of places of the square frame."""
        return self.mouth.askew(along, beside), self.mouth.side * (self.edge_m + beside)


def corner_drops(random: Generator, side: SidePlan, corner: Corner) -> tuple[Drop, ...]:
    """Where a corner's curb is lowered: the whole arc, or where people cross the side street."""
    if side.curb not in ("raised", "semi", "flat") or side.walk_m <= 0 or random.random() < 0.15:
        return ()
    start = corner.turn_m - corner.radius_m
    end = start + corner.radius_m * np.pi / 2
    ramp = float(random.uniform(0.6, 1.2))
    # 2 cm are left at crossings (移動等円滑化のための道路構造基準, 2006, article 9).
    high = min(0.02, side.curb_high_m / 2) if random.random() < 0.7 else 0.005
    if random.random() < 0.4:
        return (
            Drop(max(start - 0.4, 0.1), end + 0.6 + ramp, min(ramp, 0.3 * (end - start)), high),
        )
    return (Drop(end - 0.3, end + float(random.uniform(2.0, 4.0)) + ramp, ramp, high),)


def corner_nodes(
    random: Generator, corner: Corner, looks: BandSurfaces, deep_m: float, drops: tuple[Drop, ...]
) -> tuple[StoneNodes, int, int]:
    """Nodes round a corner, and those at which its arc begins and ends."""
    start = corner.turn_m - corner.radius_m
    end = start + corner.radius_m * np.pi / 2
    arc = np.linspace(start, end, max(6, int((end - start) / _ARC_STEP_M)) + 1)
    breaks = np.array([position for drop in drops for position in drop.breaks()])
    clear = np.array([np.abs(breaks - one).min() > 0.01 for one in arc]) if breaks.size else None
    kept = arc if clear is None else arc[clear | np.isin(arc, arc[[0, -1]])]
    ends = np.array([0.0, end + deep_m - corner.radius_m])
    every = np.concatenate([kept, breaks])
    if looks.row.sloppiness_m > 0:
        nodes = lay_stones(random, ends, looks.row, every)
    else:
        nodes = place_nodes_evenly(ends, 0.5, every)
    first = int(np.abs(nodes.along - start).argmin())
    return nodes, first, int(np.abs(nodes.along - end).argmin())


def corner_course(
    seed: int,
    plans: tuple[SidePlan | None, SidePlan, SidePlan | None],
    track: CornerTrack,
    nodes: StoneNodes,
    *,
    looks: BandSurfaces,
    drops: tuple[Drop, ...],
    wander: Waves,
) -> Course:
    """What is built round a corner: the road's side, turning into the side street's."""
    mouth = track.mouth
    ends = np.array([mouth.start_m, mouth.end_m])
    limit = track.along[track.first]
    chainages = track.chainages(np.minimum(track.along, limit))
    own = measures_along(seed, plans, chainages, ends)
    swing = wander.at(chainages) * mouth.calm(chainages)
    return Course(
        plans[1],
        own.mixed(mouth.beside, track.turned),
        looks,
        track.edge_m + swing,
        nodes,
        lowering(drops, track.along),
    )

"""The bed of a covered gutter: where its lids may lie, the channel below and the rims beside."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers, grid
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.plan import LEFT, RIGHT
from processing.laboratory.simulate.street.section import StreetSection

GUTTER = 11

_STEP_M = 0.5
_CHANGES_M = 0.025
_STRIPS = 9  # rim, face, seat, wall, floor, wall, seat, face, rim
_FLOOR = 4
_EDGE_M = 0.003  # the least that a rim shows


@dataclass(frozen=True)
class Bed:
    """The strip between the carriageway's edge and what comes behind the gutter.

    Attributes
    ----------
    side : int
    chainages : (n,) float64
        Of the nodes, rising.
    inner, outer : (n, 3) float64
        The strip's edges on the ground, m, the street's frame; inner is the carriageway's.
    """

    side: int
    chainages: Floats
    inner: Floats
    outer: Floats

    @property
    def least_width_m(self) -> float:
        """Where the strip is narrowest."""
        return float(np.linalg.norm(self.outer - self.inner, axis=1).min())

    @property
    def widths_m(self) -> Floats:
        """At the nodes: (n,) float64."""
        widths: Floats = np.linalg.norm(self.outer - self.inner, axis=1)
        return widths

    @property
    def usual_width_m(self) -> float:
        """What it has but near its ends, where it may change to its neighbour's width."""
        widths = self.widths_m
        return float(widths[widths > np.median(widths) - _CHANGES_M].min())

    def usual_nodes(self) -> tuple[int, int]:
        """First and last node of the stretch around its middle that is nowhere narrower."""
        narrow = np.flatnonzero(self.widths_m < self.usual_width_m)
        middle = int(np.flatnonzero(self.widths_m >= np.median(self.widths_m))[0])
        before, behind = narrow[narrow < middle], narrow[narrow > middle]
        first = int(before[-1]) + 1 if before.size else 0
        last = int(behind[0]) - 1 if behind.size else self.chainages.size - 1
        return first, last

    def line(self, across_m: float | Floats) -> Floats:
        """Places at a distance (m, or (n,) float64) from the inner edge, one at each node."""
        directions = self.outer - self.inner
        share = np.asarray(across_m) / np.linalg.norm(directions, axis=1)
        positions: Floats = self.inner + share[:, None] * directions
        return positions


def beds_of(section: StreetSection) -> Iterator[Bed]:
    """The strips that the ground leaves open for covered gutters."""
    ground = section.ground
    for number, strip in enumerate(ground.strips):
        if strip.has_surface or strip.kind not in ("drain", "lids"):
            continue
        rows = _thinned(ground.nodes)
        nodes = ground.nodes[rows]
        positions = section.alignment.at(
            np.broadcast_to(nodes[:, None], (nodes.size, 2)),
            ground.offsets[rows, number : number + 2],
            ground.heights[rows, number : number + 2],
        )
        side = LEFT if ground.offsets[:, number].mean() > 0 else RIGHT
        near, far = (0, 1) if side == LEFT else (1, 0)
        yield Bed(side, nodes, positions[:, near], positions[:, far])


def _thinned(nodes: Floats) -> Integers:
    """Rows of nodes about half a metre apart, with both ends: the ground has them at each stone."""
    steps = np.floor((nodes - nodes[0]) / _STEP_M)
    rows = np.flatnonzero(np.diff(steps, prepend=-1.0) > 0)
    return np.unique(np.append(rows, nodes.size - 1))


@dataclass(frozen=True)
class Channel:
    """A gutter's cross section, m from the bed's inner edge and below its surface.

    Attributes
    ----------
    lid_at_m, opening_m : float
        Where the opening for the lids begins, and how wide it is.
    seat_m : float
        How far the lids lie on the walls at each side.
    thick_m, deep_m : float
        Depth of the seat (a lid's thickness) and of the floor.
    """

    lid_at_m: float
    opening_m: float
    seat_m: float
    thick_m: float
    deep_m: float


def channel_of(random: Generator, wide_m: float, opening_m: float) -> Channel:
    """A channel for a bed of a width: inside 10–14 cm narrower than the lid, 0.24–0.6 m deep.

    Beside the lids the walls' tops show 4–7 cm wide where there is room (落ち蓋式), else the lids
    lie on the walls (甲蓋); what is left of the bed is concrete on either side.
    """
    room = wide_m - opening_m
    at = room / 2
    if room > 0.08:
        wall = float(random.uniform(0.04, min(0.07, room / 2)))
        at = wall if random.random() < 0.6 else room - wall
    return Channel(
        float(np.clip(at, _EDGE_M, max(_EDGE_M, room - _EDGE_M))),
        opening_m,
        float(random.uniform(0.05, 0.07)),
        float(random.uniform(0.08, 0.13)),
        float(random.uniform(0.24, 0.6)),
    )


def squeeze_share(bed: Bed, end_m: float) -> Floats:
    """By how much a channel's cross section is narrowed at each node, so that it fits: (n,)."""
    share: Floats = np.minimum(1.0, (bed.widths_m - _EDGE_M) / end_m)
    return share


def add_channel(
    built: SectionBuilder,
    bed: Bed,
    channel: Channel,
    floor: Floats,
    made_of: tuple[Material, Material],
) -> int:
    """Add rims, seats, walls and floor of a channel as one thing of kind ``gutter``; its instance.

    Parameters
    ----------
    floor : (n,) float64
        Height of the silt on the floor at each node, m.
    made_of : (Material, Material)
        The walls; what covers the floor.
    """
    instance = built.thing("gutter")
    start, end = channel.lid_at_m, channel.lid_at_m + channel.opening_m
    deep = -channel.deep_m + floor
    flat, seat = np.zeros_like(deep), np.full_like(deep, -channel.thick_m)
    inside, outside = start + channel.seat_m, end - channel.seat_m
    across = [0.0, start, start, inside, inside, outside, outside, end, end]
    levels = [flat, flat, seat, seat, deep, deep, seat, seat, flat]
    squeezed = squeeze_share(bed, end)
    lines = [
        bed.line(one * squeezed) + np.column_stack([flat, flat, level])
        for one, level in zip(across, levels, strict=True)
    ]
    rows = np.stack([*lines, bed.outer], axis=1)
    materials = np.full(_STRIPS, made_of[0], np.uint8)
    materials[_FLOOR] = made_of[1]
    built.mesh.add(grid(rows), np.tile(np.repeat(materials, 2), len(deep) - 1), GUTTER, instance)
    for row in (rows[0], rows[-1]):
        cap = np.stack([row[1 : _FLOOR + 1], row[-2:_FLOOR:-1]], axis=1)
        built.mesh.add(grid(cap), made_of[0], GUTTER, instance)
    return instance

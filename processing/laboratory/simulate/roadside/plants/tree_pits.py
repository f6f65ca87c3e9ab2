"""Single tree pits (植樹桝) in paved walks: edging stones about soil, grass, gravel or a grating.

Things: ``tree_pit`` (what fills it, and its grating) and, where the edging stands higher than
3 cm, a ``curb`` for each of its sides (one for a round pit); their pieces count half metres along
the upper edge, as those of all curbs. Truth: upper and lower edge of each side, which faces away
from the tree (role ``edging``).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape, grid
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePosition, FreePositions
from processing.laboratory.simulate.street.ground import Strip
from processing.laboratory.simulate.street.measures import band_surfaces_of
from processing.laboratory.simulate.street.profile import CURB, GRASS, GROUND, Edge, RoadProfile
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.sweep import Sweep, add_runs, add_surfaces
from processing.laboratory.simulate.street.walk_lines import walk_lines

# 0.9 to 1.5 m inside walks that keep a metre free (道路緑化技術基準, 1988; 道路構造令, article 11).
_SIZES_M = (0.9, 1.5)
_LEAST_M, _FREE_WALK_M = 0.6, 0.9
_KERB_GAP_M = 0.14
_TACTILE_FROM_M = 1.3  # behind the curb: blocks along the walk lie farther out
_TRUE_FROM_M = 0.03  # lower edging is no curb of the ledger
_FLUSH_M = 0.003
_STEP_M = 0.3
_ROUND_SIDES = 24
_SKIRT_M = 0.02
_LIFTED_SHARE, _GONE_SHARE = 0.08, 0.06  # of pits: a corner raised by roots, a side broken away


@dataclass(frozen=True)
class PitStyle:
    """What the pits of one row have in common; lengths in m.

    Attributes
    ----------
    long_m, wide_m : float
        Along the road and across it, with the edging; a round pit is as long as wide.
    gap_m : float
        Between the curb's rear and the pit.
    stone_m, high_m : float
        Width of the edging, and how high it stands over the walk.
    soil_m : float
        How high the soil lies over the walk.
    """

    is_round: bool
    long_m: float
    wide_m: float
    gap_m: float
    stone_m: float
    high_m: float
    soil_m: float
    stone: Material
    filling: Material
    has_grating: bool

    def middle_m(self, near_m: float) -> float:
        """Distance of the pits' middles from the road's centre where free ground begins there."""
        return near_m + self.gap_m + self.wide_m / 2


def pit_habit(section: StreetSection, side: int) -> PitStyle | None:
    """The pits of a side's walk; None where they have no room or the trees stand in paving."""
    plan = section.plan.side(side)
    random = chance(section.seed, "pits", side, int(plan.walk_m * 1e6))
    gap = _KERB_GAP_M + float(random.uniform(0.0, 0.2))
    room = plan.walk_m - _FREE_WALK_M
    room = (min(room, _TACTILE_FROM_M) if plan.has_tactile else room) - gap
    is_round = bool(random.random() < 0.15)
    wide = min(float(random.uniform(*_SIZES_M)), room)
    long = wide if is_round or random.random() < 0.6 else float(random.uniform(*_SIZES_M))
    has_grating = bool(random.random() < 0.2)
    is_flush = has_grating or random.random() < 0.3
    high = float(random.uniform(0.01, 0.15))
    stone = float(random.uniform(0.05, 0.15))
    fillings = (Material.SOIL, Material.GRASS, Material.GRAVEL)
    filling = fillings[int(random.choice(3, p=[0.6, 0.25, 0.15]))]
    if wide < _LEAST_M or random.random() < 0.1:
        return None
    soil = float(random.uniform(0.005, 0.03))
    return PitStyle(
        is_round,
        long,
        wide,
        gap,
        stone,
        _FLUSH_M if is_flush else high,
        0.004 if is_flush else min(soil, max(0.005, high - 0.01)),
        Material.BRICK if random.random() < 0.12 else band_surfaces_of(section.seed, plan).stone,
        Material.SOIL if has_grating else filling,
        has_grating,
    )


def take_pit(positions: FreePositions, spot: FreePosition, habit: PitStyle) -> bool:
    """Give the place of a pit away; False where it isn't free or not paved."""
    long, wide = habit.long_m / 2, habit.wide_m / 2
    if not positions.is_free(spot, wide) or not _is_paved(positions.section, spot, habit):
        return False
    for along in (-long, 0.0, long):
        for across in (-wide, wide) if along else ():
            corner = FreePosition(spot.chainage_m + along, spot.offset_m + across)
            if not positions.is_free(corner, 0.01):
                return False
    positions.block(
        (spot.chainage_m - long, spot.chainage_m + long),
        (spot.offset_m - wide, spot.offset_m + wide),
    )
    return True


def _is_paved(section: StreetSection, spot: FreePosition, habit: PitStyle) -> bool:
    lines = walk_lines(section, spot.side)
    if lines is None:
        return False
    inner, outer = lines.between(spot.chainage_m + habit.long_m * np.array([-0.5, 0.0, 0.5]))
    away, half = abs(spot.offset_m), habit.wide_m / 2
    return bool((away - half > inner).all() and (away + half < outer - _KERB_GAP_M).all())


def add_pit(
    section: StreetSection,
    built: SectionBuilder,
    spot: FreePosition,
    habit: PitStyle,
    random: Generator,
) -> None:
    """Add a pit at a place that was taken for it."""
    frame = _Frame(section, spot, float(random.normal(0, 0.008)))
    outer, inner = _outlines(random, habit)
    highs = np.maximum(habit.high_m + random.normal(0, 0.003, len(outer)), _FLUSH_M)
    if habit.high_m <= _FLUSH_M:
        highs[:] = _FLUSH_M
    elif random.random() < _LIFTED_SHARE and not habit.is_round:
        highs[int(random.integers(4))] += float(random.uniform(0.02, 0.06))
    gone = int(random.integers(4)) if random.random() < _GONE_SHARE else -1
    for number, (first, last) in enumerate(_sides(habit)):
        if number == gone and not habit.is_round:
            continue
        rows = _along((outer, inner, highs), first, last)
        sweep = _stones(frame, rows, habit)
        add_surfaces(sweep, section.alignment, built, Material.PAVING)
        add_runs(sweep, section.alignment, built)
    instance = built.thing("tree_pit")
    label = GRASS if habit.filling is Material.GRASS else GROUND
    shape = _filling(frame, inner, habit.soil_m, random)
    built.mesh.add(shape, habit.filling, label, instance)
    if habit.has_grating:
        bars = _grating(frame, habit, random)
        built.mesh.add(bars, Material.GRATING, GROUND, instance)


@dataclass(frozen=True)
class _Frame:
    """A pit's own frame: along the road and to the left, m from its middle."""

    section: StreetSection
    spot: FreePosition
    turned_rad: float

    def spread(self, own: Floats) -> tuple[Floats, Floats]:
        """Chainages and offsets of (..., 2) places."""
        cosine, sine = np.cos(self.turned_rad), np.sin(self.turned_rad)
        chainages = self.spot.chainage_m + own[..., 0] * cosine - own[..., 1] * sine
        return chainages, self.spot.offset_m + own[..., 0] * sine + own[..., 1] * cosine

    def position(self, own: Floats, above_m: Floats | float) -> Floats:
        """Places over the walk: (..., 3) float64, m, the street's frame."""
        chainages, offsets = self.spread(own)
        return self.section.position(chainages, offsets, above_m)


def _outlines(random: Generator, habit: PitStyle) -> tuple[Floats, Floats]:
    """The edging's outer and inner corners in order: (n, 2) each, the first one again at the end.

    A round pit's are on circles.
    """
    if habit.is_round:
        angles = np.linspace(0, 2 * np.pi, _ROUND_SIDES + 1)
        ring = np.column_stack([np.cos(angles), np.sin(angles)])
        ring[-1] = ring[0]
        return habit.wide_m / 2 * ring, (habit.wide_m / 2 - habit.stone_m) * ring
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])
    half = np.array([habit.long_m / 2, habit.wide_m / 2])
    off = np.clip(random.normal(0, 0.005, (4, 2)), -0.012, 0.012)
    off = np.concatenate([off, off[:1]])
    return corners * half + off, corners * (half - habit.stone_m) + off


def _sides(habit: PitStyle) -> Iterator[tuple[int, int]]:
    """First and last corner of each side; those beside the road lead along the drive."""
    if habit.is_round:
        yield 0, _ROUND_SIDES
        return
    yield from ((0, 1), (1, 2), (3, 2), (4, 3))


def _along(
    outline: tuple[Floats, Floats, Floats], first: int, last: int
) -> tuple[Floats, Floats, Floats]:
    """Nodes of a side: outer and inner places (n, 2), and heights (n,)."""
    outer, inner, highs = outline
    if abs(last - first) > 1:
        closed = np.append(highs[:-1], highs[0])
        return outer, inner, closed
    long = float(np.linalg.norm(outer[last] - outer[first]))
    share = np.linspace(0.0, 1.0, int(np.ceil(long / _STEP_M)) + 1)[:, None]
    closed = np.append(highs[:-1], highs[0])
    return (
        outer[first] + share * (outer[last] - outer[first]),
        inner[first] + share * (inner[last] - inner[first]),
        closed[first] + share[:, 0] * (closed[last] - closed[first]),
    )


def _stones(frame: _Frame, rows: tuple[Floats, Floats, Floats], habit: PitStyle) -> Sweep:
    outer, inner, highs = rows
    none = np.zeros(highs.size)
    stone = Strip("edging", habit.stone, CURB)
    lines = (
        (outer, 0.0, none - _SKIRT_M),
        (outer, 0.0, none),
        (outer, 0.0, highs),
        (inner, habit.stone_m, highs),
        (inner, habit.stone_m, none - _SKIRT_M),
    )
    profile = RoadProfile()
    for number, (_, away, above) in enumerate(lines):
        profile.line(none + away, above, stone if number else None)
    if habit.high_m > _TRUE_FROM_M:
        profile.edges.append(Edge("edging", 1, 3, none, highs, 0.0, none))
    spread = [frame.spread(one[0]) for one in lines]
    chainages = np.column_stack([one[0] for one in spread])
    offsets = np.column_stack([one[1] for one in spread])
    heights = frame.section.ground.height(chainages, offsets)
    heights = heights + np.column_stack(profile.above)
    return Sweep(profile, chainages, offsets, heights, frame.spot.side)


def _filling(frame: _Frame, inner: Floats, soil_m: float, random: Generator) -> TriangleShape:
    """Soil from the middle to the edging, uneven by some millimetres."""
    shares = np.array([0.02, 0.3, 0.55, 0.8, 1.0])
    ring = np.concatenate(
        [inner[at] + np.linspace(0, 1, 5)[:-1, None] * (inner[at + 1] - inner[at])
         for at in range(len(inner) - 1)] + [inner[:1]]
    )  # fmt: skip
    bumps = random.uniform(0.0, min(0.008, soil_m), (shares.size, len(ring)))
    bumps[:, -1], bumps[0] = bumps[:, 0], 0.0
    rows = frame.position(shares[:, None, None] * ring[None], soil_m - bumps / 2)
    return grid(rows)


def _grating(frame: _Frame, habit: PitStyle, random: Generator) -> TriangleShape:
    """Bars along the road with a hole for the trunk, and a frame round them."""
    bar, slot = float(random.uniform(0.012, 0.03)), float(random.uniform(0.012, 0.02))
    hole = float(random.uniform(0.2, 0.28))
    top = float(random.uniform(0.01, 0.016))
    long = habit.long_m / 2 - habit.stone_m - 0.005
    wide = habit.wide_m / 2 - habit.stone_m - 0.005
    count = max(3, int(2 * wide / (bar + slot)))
    at = (np.arange(count) + 0.5) * 2 * wide / count - wide
    reach = long * np.sqrt(1 - (at / wide) ** 2) if habit.is_round else np.full(count, long)
    opening = np.sqrt(np.clip(hole**2 - at**2, 0.0, None))
    split = opening > 0
    ends = [
        np.column_stack([-reach, np.where(split, -opening, reach), at]),
        np.column_stack([opening, reach, at])[split],
    ]
    bars = np.concatenate(ends)
    bars = bars[bars[:, 1] - bars[:, 0] > bar]
    boxes = np.column_stack([bars[:, 0], bars[:, 1], bars[:, 2] - bar / 2, bars[:, 2] + bar / 2])
    if not habit.is_round:
        rims = [[end - bar / 2, end + bar / 2, -wide, wide] for end in (bar - long, long - bar)]
        boxes = np.concatenate([boxes, rims])
    return _low_boxes(frame, boxes, top)


def _low_boxes(frame: _Frame, boxes: Floats, top_m: float) -> TriangleShape:
    """Boxes without undersides on the walk, from rows of from and to along and across."""
    corners = boxes[:, [[0, 2], [1, 2], [1, 3], [0, 3]]]
    vertices = np.concatenate(
        [frame.position(corners, 0.0), frame.position(corners, top_m)], axis=1
    )
    faces = [[4, 5, 6], [4, 6, 7]]
    for one in range(4):
        other = (one + 1) % 4
        faces += [[one, other, other + 4], [one, other + 4, one + 4]]
    first = 8 * np.arange(len(boxes))[:, None, None]
    return vertices.reshape(-1, 3), (first + np.array(faces)).reshape(-1, 3)

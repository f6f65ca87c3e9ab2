"""Lines of walls: faces joined where one goes on behind a car or a bush, parted at gates."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.methods.road.walls.face_fits import FaceStations, FaceSurroundings
from processing.methods.road.walls.fit_kernels import robust_fit_kernel, running_fit_kernel
from processing.methods.road.walls.wall_cells import GROUND_BIT, LOWEST_M, SLAB_M, SLABS

WallType = Literal["wall", "retaining", "building"]

_HIDDEN_M = 6.0
"""How far a face may be hidden and still be one: by a parked car, seen askew."""

_OPENING_M = 8.0
"""Of the widest opening that is told: a gate for two cars."""

_JOIN_M, _APART_SHARE = 0.04, 0.01
"""How far one piece may lie beside the line of another: frames of windows stand out 3 cm; and more
for each metre between them, as their turns are known."""

_TURN, _SHORT_TURN, _SHORT_M = 0.996, 0.97, 1.0
"""Cosine of the angle between two pieces, 5 degrees, and of short ones, 14 degrees."""

_LEANS_M, _SOLID_APART = 0.1, 0.25
"""How far leans of pieces differ at most, and how solid they are: a fence goes on where a wall
ends."""

_OVERLAP_M = -0.6
_SEAMLESS_M = 0.5
"""A gap so short is none: two stations."""

_TAIL_M = 2.0
"""Of a face, what tells how it goes on at its end."""

_LOOK_M, _BACK_M = 0.2, (0.4, 0.7, 1.0)
"""Between places in a gap, and how far behind them one looks whether anything is seen."""

_OPEN_SHARE = 0.5

_BESIDE_M, _PARALLEL = 0.15, 0.95
"""A weaker face so near along a stronger one is its window, door or board."""

_LEAST_M, _SAMPLE_M = 0.5, 0.1

_CORNER_M, _CORNER_SINE = 0.6, 0.3
"""How far from where two faces meet they may end, and the sine of the least angle of a corner."""

_LEANING, HOUSE_M, _BEHIND_SHARE = 0.02, 2.7, 0.5
"""Lean of what holds back soil (1 : 0.02 and more); height of a ground floor: free walls of blocks
end at 2.2 m (建築基準法施行令 第62条の8); share of a wall with ground behind its top."""

_CURVED_M, _OFF_M, _TELLS_CURVE = 0.01, 0.025, 5
"""Bulge over the chord from which a line is curved, how far off one in five stations may lie of one
that is straight, and how many tell a curve."""

_STRAIGHT_M, _LEVEL_M = 0.005, 0.02
"""How near to the line through others vertices say nothing: in plan, and in height."""

_HUBER_M = 0.008


class WallFace(NamedTuple):
    """What the pieces of one line have in common, by their lengths."""

    lean: float
    low_m: float
    top_m: float
    noise_m: float
    solid: float
    flat: float
    near: float
    filled: float
    is_ground_behind: float
    is_open: float


@dataclass(frozen=True)
class WallLine:
    """One line of a wall.

    Attributes
    ----------
    line : (n, 3) float64
        Its foot, m about the plan's origin.
    normal : (2,) float64
        Towards the vehicle's way.
    face : WallFace
    seen_m : float
        Length of its faces; the rest was hidden.
    points : (k,) int64
        Which of the kept points are on it.
    openings : tuple of (float, float)
        At its beginning and its end, the width of the opening up to the next piece; 0 for none.
    run : int
        Pieces on both sides of an opening share it.
    """

    line: Floats
    normal: Floats
    face: WallFace
    seen_m: float
    points: Integers
    openings: tuple[float, float] = (0.0, 0.0)
    run: int = 0

    @property
    def long_m(self) -> float:
        """Length in plan."""
        return length_of(self.line)

    @property
    def hidden_m(self) -> float:
        """How much of it was not measured."""
        return max(self.long_m - self.seen_m, 0.0)

    @property
    def type(self) -> WallType:
        """What it is, by its lean, its height and what lies behind."""
        high = self.face.top_m
        if abs(self.face.lean) >= _LEANING and high < 2 * HOUSE_M:
            return "retaining"
        if high >= HOUSE_M:
            return "building"
        return "retaining" if self.face.is_ground_behind >= _BEHIND_SHARE else "wall"


def length_of(line: Floats) -> float:
    """Length in plan, m."""
    return float(np.hypot(*np.diff(line[:, :2], axis=0).T).sum())


def wall_lines(faces: Sequence[FaceStations], about: FaceSurroundings) -> list[WallLine]:
    """Lines of all faces, the strongest first.

    Notes
    -----
    1. Pieces in one plane are joined if what lies between them was hidden.
    2. Where one could look through, the gap is an opening, and told with its width.
    3. What lies along a stronger face is a part of it; lines that meet are drawn to their corner.
    """
    ends = [_Ends.of(one) for one in faces]
    joints, openings = _joints(faces, ends, about)
    lines, place = [], {}
    for number, chain in enumerate(_chains(len(faces), joints)):
        lines.append(_joined([(faces[one], forward) for one, forward in chain]))
        first, last = chain[0], chain[-1]
        # The end of a piece that is the chain's own.
        place[first[0], 0 if first[1] else 1] = (number, 0)
        place[last[0], 1 if last[1] else 0] = (number, 1)
    lines = _with_openings(lines, openings, place)
    return _with_corners(_distinct(lines))


@dataclass(frozen=True)
class _Ends:
    """Both ends of a face: places, and the ways on from there."""

    places: Floats
    ways: Floats

    @staticmethod
    def of(face: FaceStations) -> _Ends:
        plan = face.line[:, :2]
        along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(plan, axis=0).T))]
        ways = []
        for end in (0, -1):
            near = np.abs(along - along[end]) <= max(_TAIL_M, 0.3 * along[-1])
            tail = plan[near] if near.sum() >= 2 else plan
            centred = tail - tail.mean(axis=0)
            way = np.linalg.svd(centred, full_matrices=False)[2][0]
            outward = plan[end] - plan[-1 - end]
            ways.append(way if way @ outward >= 0 else -way)
        return _Ends(plan[[0, -1]], np.array(ways))


class _Joint(NamedTuple):
    """Two ends that one line runs through: (face, end) of each, and the gap, m."""

    one: tuple[int, int]
    other: tuple[int, int]
    gap_m: float


def _joints(
    faces: Sequence[FaceStations], ends: Sequence[_Ends], about: FaceSurroundings
) -> tuple[list[_Joint], list[_Joint]]:
    """Ends that are joined, and ends on both sides of an opening; each end once."""
    from scipy.spatial import cKDTree

    if not faces:
        return [], []
    places = np.concatenate([one.places for one in ends])
    near = sorted(cKDTree(places).query_pairs(max(_HIDDEN_M, _OPENING_M)))
    found = []
    for a, b in near:
        one, other = divmod(a, 2), divmod(b, 2)
        gap = _gap(faces, ends, one, other)
        if gap is not None:
            found.append(_Joint((one[0], one[1]), (other[0], other[1]), gap))
    used: set[tuple[int, int]] = set()
    joints: list[_Joint] = []
    openings: list[_Joint] = []
    for joint in sorted(found, key=lambda one: abs(one.gap_m)):
        if joint.one in used or joint.other in used:
            continue
        is_open = joint.gap_m > _SEAMLESS_M and _is_open(faces, ends, joint, about)
        if is_open or joint.gap_m <= _HIDDEN_M:
            (openings if is_open else joints).append(joint)
            used |= {joint.one, joint.other}
    return joints, openings


def _gap(
    faces: Sequence[FaceStations],
    ends: Sequence[_Ends],
    one: tuple[int, int],
    other: tuple[int, int],
) -> float | None:
    """How far two ends are apart along one line; None where they are of different ones."""
    if one[0] == other[0]:
        return None
    a, b = faces[one[0]], faces[other[0]]
    way, back = ends[one[0]].ways[one[1]], ends[other[0]].ways[other[1]]
    is_short = min(a.long_m, b.long_m) < _SHORT_M
    if way @ back > -(_SHORT_TURN if is_short else _TURN) or a.normal @ b.normal < 0.0:
        return None
    step = ends[other[0]].places[other[1]] - ends[one[0]].places[one[1]]
    gap = float(step @ way)
    longer = way if a.long_m >= b.long_m else back
    across = abs(float(longer[0] * step[1] - longer[1] * step[0]))
    if across > _JOIN_M + _APART_SHARE * max(gap, 0.0) or not _OVERLAP_M <= gap <= _OPENING_M:
        return None
    is_level = min(a.top_m, b.top_m) > max(a.low_m, b.low_m)
    is_alike = abs(a.lean - b.lean) <= _LEANS_M and abs(a.solid - b.solid) <= _SOLID_APART
    return gap if is_level and is_alike else None


def _is_open(
    faces: Sequence[FaceStations],
    ends: Sequence[_Ends],
    joint: _Joint,
    about: FaceSurroundings,
) -> bool:
    """Whether one could look through a gap: something is seen behind it below the top."""
    start = ends[joint.one[0]].places[joint.one[1]]
    end = ends[joint.other[0]].places[joint.other[1]]
    one, other = faces[joint.one[0]], faces[joint.other[0]]
    share = (np.arange(max(2, round(joint.gap_m / _LOOK_M))) + 0.5)[:, None]
    places = start + share / len(share) * (end - start)
    normal = (one.normal + other.normal) / 2
    top = min(one.top_m, other.top_m)
    level = int(np.clip((top - LOWEST_M) / SLAB_M, 1, SLABS - 1))
    below = np.uint32((1 << level) - 1) | GROUND_BIT
    seen = np.zeros(len(places), np.bool_)
    for back in _BACK_M:
        seen |= (about.slabs_at(places - back * normal) & below) > 0
    return bool(np.mean(seen) >= _OPEN_SHARE)


def _chains(count: int, joints: Sequence[_Joint]) -> list[list[tuple[int, bool]]]:
    """Faces in the order of their lines, and whether each is run through from its first end."""
    next_of = {}
    for joint in joints:
        next_of[joint.one], next_of[joint.other] = joint.other, joint.one
    met: set[int] = set()
    chains = []
    starts = [(face, end) for face in range(count) for end in (0, 1) if (face, end) not in next_of]
    for face, end in [*starts, *((face, 0) for face in range(count))]:
        if face in met:
            continue
        chain, at = [], (face, end)
        while at[0] not in met:
            met.add(at[0])
            chain.append((at[0], at[1] == 0))
            far = (at[0], 1 - at[1])
            if far not in next_of:
                break
            at = next_of[far]
        chains.append(chain)
    return chains


def _joined(pieces: Sequence[tuple[FaceStations, bool]]) -> WallLine:
    faces = [face for face, _ in pieces]
    stations = np.concatenate([face.line if ahead else face.line[::-1] for face, ahead in pieces])
    points = [face.points if ahead else face.points[::-1] for face, ahead in pieces]
    long = np.array([max(face.long_m, 0.1) for face in faces])
    share = long / long.sum()

    def mean(name: str) -> float:
        return float(share @ [getattr(face, name) for face in faces])

    face = WallFace(
        lean=mean("lean"),
        low_m=min(one.low_m for one in faces),
        top_m=mean("top_m"),
        noise_m=mean("noise_m"),
        solid=mean("solid"),
        flat=mean("flat"),
        near=mean("near"),
        filled=mean("filled"),
        is_ground_behind=mean("is_ground_behind"),
        is_open=mean("is_open"),
    )
    normal = np.array([one.normal for one in faces]).T @ share
    normal /= max(float(np.hypot(*normal)), 1e-9)
    seen = min(float(long.sum()), length_of(stations[[0, -1]]) + 1.0)
    return WallLine(_smoothed(stations), normal, face, seen, np.concatenate(points))


def _smoothed(stations: Floats) -> Floats:
    """A straight line, or a curved one, through stations in their order: (n, 3)."""
    plan = stations[:, :2]
    way = plan[-1] - plan[0]
    way = way / max(float(np.hypot(*way)), 1e-9)
    across = np.array([-way[1], way[0]])
    along, off = (plan - plan[0]) @ way, (plan - plan[0]) @ across
    order = np.argsort(along, kind="stable")
    along, off, high = along[order], off[order], stations[order, 2]
    share = along / max(float(np.abs(along).max()), 1e-6)
    curve = _robust_fit(share, off, 2) if along.size >= _TELLS_CURVE else np.zeros(3)
    straight = _robust_fit(share, off, 1)
    even = straight[0] + straight[1] * share
    is_curved = abs(curve[2]) / 4 > _CURVED_M or np.quantile(np.abs(off - even), 0.8) > _OFF_M
    off = _running_fit(along, off) if is_curved else even
    high = _running_fit(along, high)
    kept = _bends(along, off, _STRAIGHT_M) | _bends(along, high, _LEVEL_M)
    places = plan[0] + np.outer(along, way) + np.outer(off, across)
    return np.column_stack([places, high])[kept]


def _bends(along: Floats, values: Floats, within_m: float) -> Flags:
    """Stations that are needed for all to lie so near to the lines between them."""
    import shapely

    line = shapely.LineString(np.column_stack([along, values])).simplify(within_m)
    corners = shapely.get_coordinates(line)[:, 0]
    is_bend = np.isin(along, corners)
    # Stations of overlapping pieces may lie at the same place: one is enough.
    is_bend[1:] &= np.diff(along) > 0
    is_bend[[0, -1]] = True
    return is_bend


def _robust_fit(at: Floats, values: Floats, degree: int) -> Floats:
    """Coefficients, the constant first: least squares with the weights of Huber."""
    found = np.zeros(degree + 1)
    robust_fit_kernel(np.vander(at, degree + 1, increasing=True), values, _HUBER_M, found)
    return found


_RUN = 2
"""Stations to either side that straighten one."""


def _running_fit(along: Floats, values: Floats) -> Floats:
    """Each station on the straight line through those about it."""
    found = np.empty(len(along))
    running_fit_kernel(along, values, _RUN, _HUBER_M, found)
    return found


def _with_openings(
    lines: Sequence[WallLine],
    openings: Sequence[_Joint],
    place: dict[tuple[int, int], tuple[int, int]],
) -> list[WallLine]:
    """Lines that know the openings at their ends, numbered by runs."""
    widths = np.zeros((len(lines), 2))
    run = np.arange(len(lines))
    for joint in openings:
        sides = [place.get(one) for one in (joint.one, joint.other)]
        if sides[0] is None or sides[1] is None:
            continue
        for number, end in (sides[0], sides[1]):
            widths[number, end] = joint.gap_m
        first, second = run[sides[0][0]], run[sides[1][0]]
        run[run == max(first, second)] = min(first, second)
    return [
        replace(one, openings=(float(widths[k, 0]), float(widths[k, 1])), run=int(run[k]) + 1)
        for k, one in enumerate(lines)
    ]


def _strength(line: WallLine) -> float:
    high = min(line.face.top_m, HOUSE_M) - max(line.face.low_m, 0.0)
    return line.seen_m * max(high, 0.0) * line.face.solid


def _distinct(lines: Sequence[WallLine]) -> list[WallLine]:
    """Lines without what lies along stronger ones."""
    from scipy.spatial import cKDTree

    ordered = sorted(lines, key=lambda one: -_strength(one))
    if not ordered:
        return []
    sampled = [_sampled(one.line) for one in ordered]
    ways = np.concatenate([np.gradient(one[:, :2], axis=0) for one in sampled])
    ways /= np.maximum(np.hypot(*ways.T), 1e-9)[:, None]
    owner = np.repeat(np.arange(len(sampled)), [len(one) for one in sampled])
    places = np.concatenate(sampled)[:, :2]
    pairs = cKDTree(places).query_pairs(_BESIDE_M, output_type="ndarray")
    turn = np.abs((ways[pairs[:, 0]] * ways[pairs[:, 1]]).sum(axis=1))
    pairs = pairs[turn >= _PARALLEL]
    weaker = np.where(owner[pairs[:, 0]] > owner[pairs[:, 1]], pairs[:, 0], pairs[:, 1])
    is_taken = np.zeros(len(places), np.bool_)
    is_taken[weaker[owner[pairs[:, 0]] != owner[pairs[:, 1]]]] = True
    kept: list[WallLine] = []
    for number, line in enumerate(ordered):
        kept += _free_pieces(line, sampled[number], ~is_taken[owner == number])
    return kept


def _sampled(line: Floats) -> Floats:
    """(k, 3) places along a line, both ends among them."""
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T))]
    at = np.linspace(0.0, along[-1], max(2, round(along[-1] / _SAMPLE_M) + 1))
    return np.column_stack([np.interp(at, along, axis) for axis in line.T])


def _free_pieces(line: WallLine, places: Floats, is_free: Flags) -> Iterator[WallLine]:
    """The pieces of a line that nothing stronger lies along."""
    if is_free.all():
        if line.long_m >= _LEAST_M:
            yield line
        return
    edges = np.flatnonzero(np.diff(np.r_[0, is_free.astype(np.int64), 0]))
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line.line[:, :2], axis=0).T))]
    for first, end in edges.reshape(-1, 2).tolist():
        if (end - 1 - first) * _SAMPLE_M < _LEAST_M:
            continue
        low, high = along[-1] * np.array([first, end - 1]) / (len(places) - 1)
        inner = line.line[(along > low + 1e-6) & (along < high - 1e-6)]
        piece = np.concatenate([places[first : first + 1], inner, places[end - 1 : end]])
        share = (high - low) / max(along[-1], 1e-9)
        widths = (
            line.openings[0] if first == 0 else 0.0,
            line.openings[1] if end == len(places) else 0.0,
        )
        yield replace(line, line=piece, seen_m=line.seen_m * share, openings=widths)


def _with_corners(lines: Sequence[WallLine]) -> list[WallLine]:
    """Lines that end where they meet."""
    from scipy.spatial import cKDTree

    if not lines:
        return []
    shapes = [one.line.copy() for one in lines]
    ends = np.array([shape[[0, -1], :2] for shape in shapes]).reshape(-1, 2)
    met = []
    for a, b in sorted(cKDTree(ends).query_pairs(2 * _CORNER_M)):
        if a // 2 == b // 2:
            continue
        corner = _corner(lines[a // 2], a % 2, lines[b // 2], b % 2)
        if corner is not None:
            off = float(np.hypot(*(ends[a] - corner)) + np.hypot(*(ends[b] - corner)))
            met.append((off, a, b, corner))
    used: set[int] = set()
    for _, a, b, corner in sorted(met, key=lambda one: one[0]):
        if a in used or b in used:
            continue
        used |= {a, b}
        shapes[a // 2][-(a % 2), :2] = corner
        shapes[b // 2][-(b % 2), :2] = corner
    return [replace(one, line=shape) for one, shape in zip(lines, shapes, strict=True)]


def _corner(one: WallLine, end: int, other: WallLine, other_end: int) -> Floats | None:
    """Where two lines meet in plan; None where they don't, or end too far from there."""
    a, way = _tail(one.line, end)
    b, other_way = _tail(other.line, other_end)
    cross = float(way[0] * other_way[1] - way[1] * other_way[0])
    is_level = min(one.face.top_m, other.face.top_m) > max(one.face.low_m, other.face.low_m)
    if abs(cross) < _CORNER_SINE or not is_level:
        return None
    step = b - a
    corner = a + way * float(step[0] * other_way[1] - step[1] * other_way[0]) / cross
    far = max(float(np.hypot(*(corner - a))), float(np.hypot(*(corner - b))))
    return np.asarray(corner) if far <= _CORNER_M else None


def _tail(line: Floats, end: int) -> tuple[Floats, Floats]:
    """An end of a line, and the way of its last metre."""
    plan = line[:, :2] if end else line[::-1, :2]
    away = np.hypot(*(plan - plan[-1]).T)
    far = np.flatnonzero(away >= min(_SHORT_M, away[0]))
    start = plan[far[-1]] if far.size else plan[0]
    step = plan[-1] - start
    return plan[-1], step / max(float(np.hypot(*step)), 1e-9)

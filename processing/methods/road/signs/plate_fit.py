"""Plates laid on scan lines: which shapes of which sizes hang in a plane, and where."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor
from processing.methods.road.signs.fit_kernels import (
    ALONG_U,
    ALONG_V,
    CAP,
    LINE,
    LONG,
    SIGMA_M,
    SPACING,
    STARTS,
    U,
    V,
    clean_kernel,
    cost_of,
    explain_kernel,
    fit_kernel,
    overlap_kernel,
    search_kernel,
    stretch_kernel,
)
from processing.methods.road.signs.sign_shapes import (
    RECTANGLE,
    SignShape,
    outline_of,
    sharp_outline_of,
)

_COARSE = np.array([0.06, 0.03])
_FINE = np.array([0.02, 0.01, 0.005, 0.002, 0.001])
_STRETCH_COARSE = np.array([0.1, 0.04])
_STRETCH = np.array([0.02, 0.008, 0.003])
"""Steps of the search, m: a plate's rim lies between pulses centimetres apart, and its place
follows from all of them to millimetres."""

_OUTLYING, _OUTLYING_M = 0.05, 0.2
"""Share of what is drawn on a plane that may lie far out on either side, and how far: outlines are
begun within the rest, too."""

_RIM_M = 0.02
"""Beyond the outermost lines, where the rim of a whole rectangle is begun."""

_SEARCHED_LINES = 40
"""Longest lines that the coarse search looks at."""

_TRIED, _CLEAN, _RECTANGLES = 8, 4, 2
"""Outlines of standard plates that are fitted finely: those that explain most, and those that
explain best what they do explain: plates of a stack, or beside each other. Of rectangles as many of
either."""

_MOST_LINES = 120
"""Of a plane that outlines are laid on: more lie nearer to each other than a plate's rim is
known."""

_BESIDE = (4, 2, 1, 1)
"""Of those, how many others are looked for beside, for the first plate, the second and so on."""

_MOST_DOUBT = 0.4
"""What a plate costs over what it explains: plates cost a tenth as a rule, pieces of walls and
crowns half of it and more."""

_PLATE_COST = 10.0
"""That another plate has to be worth: about one line that is explained at both ends."""

_RECTANGLE_COST = 10.0
"""What a rectangle has to fit better than a standard plate: its two sides are chosen freely."""

_BELOW_COST = 2.0
"""The same of a rectangle right below another plate: what hangs there is one (標識令,
補助標識)."""

_SMALL_COST = 3.0
"""What plates of other than the usual size have to fit better (標識令: 拡大率, 縮小率 only where
speeds or streets ask for it)."""

_MOST_OVERLAP_M = 0.06
"""Of plates that hang beside each other in one plane: what their rims are uncertain by, and sharp
corners stand for round ones."""

_BELOW_M = (-0.03, 0.15)
_CENTRED_M = 0.06
"""How far below a plate another one belongs to it, and how far beside its middle: clamps of one
post hold them a few centimetres apart."""

_BOARD_HIGH = 1.2
"""A board below another plate over that plate's height: those of bus stops hold a timetable, plates
below signs are lower than the sign."""

_BELOW_WIDE_M, _BELOW_HIGH_M = (0.4, 0.6), 0.2
"""Usual widths and a height to begin with of what hangs below (標識令, 補助標識)."""

_BELOW_STEPS = np.array([0.04, 0.015, 0.005])

_SNAP_COST = 3.0
"""What a side may cost to be a usual one: a deviation of √3 standard deviations."""

_USUAL_M = 0.1
"""Sides of rectangles are whole decimetres (標識令: 40 and 60 cm below signs, guide signs by
letters of 10 cm)."""

_LEAST_PART_M, _LEVEL_M, _FEW_CROSS = 0.1, 0.01, 0.1
"""Of a stack of plates: the smallest part, and where it is cut: at the level that the fewest lines
cross, a tenth of those that cross the fullest one at most."""

_MOST_EMPTY = 60
"""Places without a plate that are looked at: all lines of a large plate have two each."""


class FittedPlate(NamedTuple):
    """An outline where it fits.

    Attributes
    ----------
    shape : SignShape
    pose : (3,) float64
        Middle of the outline's box, right and up (m), and roll (rad), on the plane.
    cost : float
        What the ends of the lines on it say against it.
    ends : int
        How many ends lie on it.
    pulses : float
        That met it.
    """

    shape: SignShape
    pose: Floats
    cost: float
    ends: int
    pulses: float


@dataclass(frozen=True)
class Fit:
    """Plates that explain the lines of a plane together.

    Attributes
    ----------
    plates : tuple of FittedPlate
        The one that was found first explains most.
    cost : float
        What is left to say against them.
    nothing : float
        What there was to explain.
    """

    plates: tuple[FittedPlate, ...]
    cost: float
    nothing: float


@dataclass(frozen=True, eq=False)
class _Tried:
    """A plate with what it costs, with what it leaves unexplained and without."""

    whole: float
    own: float
    plate: FittedPlate
    rest: Floats
    blocked: Floats


Hope = Callable[[FittedPlate, float], bool]
"""Whether a plate may be what is looked for if it and what hangs beside it explain this share of
what lies in its plane."""


class _Outlines(NamedTuple):
    """Shapes as the kernels take them, and what may be one of those that are looked for."""

    shapes: tuple[SignShape, ...]
    sizes: Floats
    corners: Floats
    counts: Integers
    with_rectangles: bool
    is_hopeful: Hope


def fit_plates(
    lines: Floats,
    empty: Floats,
    shapes: Sequence[SignShape],
    monitor: Monitor,
    *,
    with_rectangles: bool = True,
    is_hopeful: Hope = lambda _plate, _explained: True,
) -> Fit:
    """The plates that explain lines best.

    Parameters
    ----------
    lines, empty : (k, LINE), (m, LINE) float64
        Of the plane: on plates, and of turns that met nothing.
    shapes : sequence of SignShape
        What is looked for.
    with_rectangles : bool
        Whether rectangles of any size are, too.
    is_hopeful : callable
        Asked of the best plates that may lie in the plane. If none may be what is looked for,
        nothing is laid beside the best of them: of leaves and of parts of houses, mostly.

    Notes
    -----
    1. Each shape is moved from some starts to where the ends of the lines fit it; those that fit
       best are moved finely.
    2. What goes on beyond an outline is explained by further plates in the same way, for each of
       the best shapes; the set of plates that leaves the least unexplained wins.
    """
    outlines = _outlines(tuple(shapes), is_hopeful, with_rectangles=with_rectangles)
    step = -(-len(lines) // _MOST_LINES)
    return _solve(lines[::step], empty, outlines, (), monitor)


def _outlines(
    shapes: tuple[SignShape, ...], is_hopeful: Hope, *, with_rectangles: bool
) -> _Outlines:
    corners = [sharp_outline_of(shape) for shape in shapes]
    every = np.zeros((len(shapes), max((len(one) for one in corners), default=1), 2))
    for number, one in enumerate(corners):
        every[number, : len(one)] = one
    return _Outlines(
        shapes,
        np.array([(one.wide_m, one.high_m) for one in shapes]).reshape(-1, 2),
        every,
        np.array([len(one) for one in corners], np.int64),
        with_rectangles,
        is_hopeful,
    )


def _solve(
    lines: Floats,
    empty: Floats,
    outlines: _Outlines,
    above: tuple[FittedPlate, ...],
    monitor: Monitor,
) -> Fit:
    """The plates beside those that were found already."""
    monitor.check()
    unexplained = _unexplained(lines)
    best = Fit((), unexplained, unexplained)
    if len(above) == len(_BESIDE) or len(lines) < 2 or unexplained <= _PLATE_COST:
        return best
    tried: list[_Tried] = []
    fits = _best_fits(lines, empty, outlines)
    if outlines.with_rectangles:
        fits += [one for upper in above for one in _below(lines, empty, upper)]
    for shape, pose in fits:
        rest, blocked = np.empty((2 * len(lines), LINE)), np.empty((2 * len(lines), LINE))
        corners = outline_of(shape)
        cost, ends, pulses, left, free = explain_kernel(corners, lines, pose, rest, blocked)
        if not ends:
            continue
        plate = FittedPlate(shape, pose, cost, ends, pulses)
        if any(_overlap(plate, one) for one in above):
            continue
        own = (
            cost
            + _PLATE_COST
            + _prior(plate, above)
            + cost_of(corners, empty, pose, SIGMA_M, np.inf)
        )
        whole = own + _unexplained(rest[:left])
        tried.append(_Tried(whole, own, plate, rest[:left], blocked[:free]))
    promising = _promising(tried, unexplained, len(above))
    is_hopeful = bool(above) or any(
        outlines.is_hopeful(one.plate, 1.0 - one.own / unexplained) for one in promising
    )
    for one in promising:
        if one.whole < best.cost:
            best = Fit((one.plate,), one.whole, unexplained)
        if not is_hopeful or one.own + _PLATE_COST >= best.cost:
            continue
        step = max(1, len(one.blocked) // _MOST_EMPTY)
        nothing = np.concatenate([empty, one.blocked[::step]])
        further = _solve(one.rest, nothing, outlines, (*above, one.plate), monitor)
        if one.own + further.cost < best.cost:
            best = Fit((one.plate, *further.plates), one.own + further.cost, unexplained)
    return best


def _promising(tried: list[_Tried], unexplained: float, found: int) -> list[_Tried]:
    """Plates beside which others are looked for.

    They leave the least unexplained, or explain what they do explain best: of two plates side by
    side each does, and what holds both leaves less.
    """

    def doubt(one: _Tried) -> float:
        return one.own / max(unexplained - one.whole + one.own, 1e-9)

    likely = [one for one in tried if doubt(one) <= _MOST_DOUBT]
    chosen = sorted(likely, key=lambda one: one.whole)[: _BESIDE[found]]
    clean = sorted(likely, key=doubt)[: _BESIDE[found]]
    return chosen + [one for one in clean if one not in chosen]


def _prior(plate: FittedPlate, above: tuple[FittedPlate, ...]) -> float:
    """What speaks against a plate before its ends are looked at."""
    if plate.shape.shape == RECTANGLE:
        return _BELOW_COST if any(hangs_below(plate, one) for one in above) else _RECTANGLE_COST
    return 0.0 if plate.shape.is_usual else _SMALL_COST


def _overlap(plate: FittedPlate, other: FittedPlate) -> bool:
    """Whether two plates would lie in each other."""
    corners, others = sharp_outline_of(plate.shape), sharp_outline_of(other.shape)
    return bool(overlap_kernel(corners, plate.pose, others, other.pose) > _MOST_OVERLAP_M)


def hangs_below(plate: FittedPlate, upper: FittedPlate) -> bool:
    """Whether a rectangle that is no larger hangs right below another plate."""
    return _is_right_below(plate, upper) and plate.shape.high_m < upper.shape.high_m


def is_board_below(plate: FittedPlate, upper: FittedPlate) -> bool:
    """Whether a rectangle that is no wider but higher hangs right below another plate."""
    return _is_right_below(plate, upper) and plate.shape.high_m > _BOARD_HIGH * upper.shape.high_m


def _is_right_below(plate: FittedPlate, upper: FittedPlate) -> bool:
    gap = (upper.pose[1] - upper.shape.high_m / 2) - (plate.pose[1] + plate.shape.high_m / 2)
    return bool(
        plate.shape.shape == RECTANGLE
        and _BELOW_M[0] <= gap <= _BELOW_M[1]
        and abs(plate.pose[0] - upper.pose[0]) <= _CENTRED_M
        and plate.shape.wide_m <= upper.shape.wide_m + _CENTRED_M
    )


def _unexplained(lines: Floats) -> float:
    """What lines cost that no plate explains: two ends each, less for a pulse or two."""
    if not len(lines):
        return 0.0
    pulses = lines[:, LONG] / lines[:, SPACING]
    return float((2 * CAP * np.minimum(1.0, (pulses + 0.5) / 3.0)).sum())


def _best_fits(lines: Floats, empty: Floats, outlines: _Outlines) -> list[tuple[SignShape, Floats]]:
    """Shapes with their places, the best first."""
    box = _box_of(lines)
    every = np.concatenate([lines, empty])
    boxes = [box]
    inner = _inner_box_of(lines)
    if np.abs(inner - box).max() > _OUTLYING_M:
        boxes.append(inner)
    costs, poses = _searched(lines, empty, outlines, boxes)
    fine: list[tuple[float, SignShape, Floats]] = []
    cleans = np.empty_like(costs)
    clean_kernel(outlines.corners, outlines.counts, lines, poses, costs, cleans)
    first, clean = _best_starts(costs, _TRIED), _best_starts(cleans, _CLEAN)
    for which, start in first + [one for one in clean if one not in first]:
        if not np.isfinite(costs[which, start]):
            continue
        shape, pose = outlines.shapes[which], poses[which, start].copy()
        cost = fit_kernel(outline_of(shape), every, _FINE, SIGMA_M, pose)
        fine.append((cost, shape, pose))
    if outlines.with_rectangles:
        fine += _rectangles(lines, every, boxes)
    fine.sort(key=lambda one: one[0])
    found: list[tuple[SignShape, Floats]] = []
    places: list[tuple[float, float]] = []
    for _, shape, pose in fine:
        place = float(pose[0]), float(pose[1])
        near = [n for n, at in enumerate(places) if math.dist(place, at) <= SIGMA_M]
        if all(shape != found[n][0] for n in near):
            found.append((shape, pose))
            places.append(place)
    return found


def _best_starts(costs: Floats, count: int) -> list[tuple[int, int]]:
    """Shapes that cost least, each with its best start."""
    starts = costs.argmin(axis=1)
    shapes = np.argsort(costs.min(axis=1), kind="stable")[:count]
    return [(int(one), int(starts[one])) for one in shapes]


def _searched(
    lines: Floats, empty: Floats, outlines: _Outlines, boxes: Sequence[Floats]
) -> tuple[Floats, Floats]:
    """What each shape costs that is moved from each start, and where it lies then."""
    slack = 2 * (0.06 + _spacing_across(lines))
    is_small = (outlines.sizes <= boxes[0][1] - boxes[0][0] + slack).all(axis=1)
    longest = lines[np.argsort(-lines[:, LONG], kind="stable")[:_SEARCHED_LINES]]
    every = np.concatenate([longest, empty])
    counts = np.where(is_small, outlines.counts, 0)
    costs = np.empty((len(boxes), len(outlines.shapes), STARTS))
    poses = np.empty((len(boxes), len(outlines.shapes), STARTS, 3))
    for number, box in enumerate(boxes):
        search_kernel(outlines.corners, counts, every, box, _COARSE, costs[number], poses[number])
    return np.concatenate(list(costs), axis=1), np.concatenate(list(poses), axis=1)


def _spacing_across(lines: Floats) -> float:
    """About how far lines lie from each other, m."""
    middles = lines[:, [U, V]] + lines[:, [LONG]] / 2 * lines[:, [ALONG_U, ALONG_V]]
    extent = float(np.ptp(middles, axis=0).max())
    return min(0.35, 1.5 * extent / max(1, len(lines) - 1))


def _rectangles(
    lines: Floats, every: Floats, boxes: Sequence[Floats]
) -> list[tuple[float, SignShape, Floats]]:
    """The best rectangles that are stretched to fit, begun as the whole and as parts of it."""
    low, high = boxes[0]
    whole = high - low
    starts = [(one[0] - _RIM_M, one[1] + _RIM_M) for one in boxes]
    for axis, least in ((1, 0.3), (0, 0.8)):
        if whole[axis] > least:
            for share in (0.35, 0.65) if axis else (0.5,):
                cut = np.where(np.arange(2) == axis, low + share * whole, high)
                starts.append((low, cut))
                starts.append((np.where(np.arange(2) == axis, cut, low), high))
    coarse = []
    for first, last in starts:
        pose, sides = np.array([*(first + last) / 2, 0.0]), np.maximum(last - first, 0.08)
        cost = stretch_kernel(every, _STRETCH_COARSE, pose, sides, np.zeros(2))
        coarse.append((cost, pose, sides, _own_cost(lines, pose, sides)))
    coarse.sort(key=lambda one: one[0])
    clean = sorted(coarse, key=lambda one: one[3])[:_RECTANGLES]
    chosen = coarse[:_RECTANGLES]
    chosen += [one for one in clean if all(one is not other for other in chosen)]
    found = [_finely(every, pose, sides) for _, pose, sides, _ in chosen]
    empty = every[len(lines) :]
    for part in _parts_beside_gaps(lines):
        low, high = _box_of(part)
        own, pose = np.concatenate([part, empty]), np.array([*(low + high) / 2, 0.0])
        sides = np.maximum(high - low, 0.08)
        stretch_kernel(own, _STRETCH_COARSE, pose, sides, np.zeros(2))
        found.append(_finely(own, pose, sides))
    return found


def _finely(every: Floats, pose: Floats, sides: Floats) -> tuple[float, SignShape, Floats]:
    """A rectangle where it fits to the millimetre, with what it costs."""
    cost = stretch_kernel(every, _STRETCH, pose, sides, np.zeros(2))
    cost, pose, sides = _snapped(every, cost, pose, sides)
    return cost + _RECTANGLE_COST, SignShape(RECTANGLE, float(sides[0]), float(sides[1])), pose


def _parts_beside_gaps(lines: Floats) -> list[Floats]:
    """The lines on either side of strips that hardly any line crosses, level or upright.

    Plates of a stack are each laid on their own lines: beside those of the others a rectangle that
    holds the whole stack explains more.
    """
    starts = lines[:, [U, V]]
    ends = starts + lines[:, [LONG]] * lines[:, [ALONG_U, ALONG_V]]
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    found: list[Floats] = []
    for axis in range(2):
        first, last = float(low[:, axis].min()), float(high[:, axis].max())
        levels = np.arange(first + _LEAST_PART_M, last - _LEAST_PART_M, _LEVEL_M)
        crossed = np.searchsorted(np.sort(low[:, axis]), levels, "right")
        crossed -= np.searchsorted(np.sort(high[:, axis]), levels, "left")
        if not levels.size or crossed.min() > _FEW_CROSS * crossed.max():
            continue
        gap = np.flatnonzero(crossed == crossed.min())
        is_below = (low + high)[:, axis] / 2 < levels[gap[gap.size // 2]]
        if 2 <= is_below.sum() <= len(lines) - 2:
            found += [lines[is_below], lines[~is_below]]
    return found


def _box_of(lines: Floats) -> Floats:
    """(2, 2) lowest and highest place of their ends."""
    starts = lines[:, [U, V]]
    ends = np.concatenate([starts, starts + lines[:, [LONG]] * lines[:, [ALONG_U, ALONG_V]]])
    return np.array([ends.min(axis=0), ends.max(axis=0)])


def _inner_box_of(lines: Floats) -> Floats:
    """(2, 2) the same but for what little of the lines lies farthest out: of posts, mostly."""
    starts = lines[:, [U, V]]
    ends = np.concatenate([starts, starts + lines[:, [LONG]] * lines[:, [ALONG_U, ALONG_V]]])
    weights = np.tile(lines[:, LONG], 2)
    box = np.empty((2, 2))
    for axis in range(2):
        order = np.argsort(ends[:, axis], kind="stable")
        share = np.cumsum(weights[order]) / weights.sum()
        outer = np.searchsorted(share, (_OUTLYING, 1.0 - _OUTLYING))
        box[:, axis] = ends[order[outer], axis]
    return box


def _own_cost(lines: Floats, pose: Floats, sides: Floats) -> float:
    """What the ends on a rectangle say against it, each; much of one that holds hardly any."""
    shape = SignShape(RECTANGLE, float(sides[0]), float(sides[1]))
    rest, blocked = np.empty((2 * len(lines), LINE)), np.empty((2 * len(lines), LINE))
    cost, ends, *_ = explain_kernel(sharp_outline_of(shape), lines, pose, rest, blocked)
    return float((cost + CAP) / max(ends, 1))


def _below(lines: Floats, empty: Floats, upper: FittedPlate) -> list[tuple[SignShape, Floats]]:
    """Supplementary plates of the usual widths under the middle of another plate."""
    every = np.concatenate([lines, empty])
    bottom = upper.pose[1] - upper.shape.high_m / 2
    found = []
    for wide in _BELOW_WIDE_M:
        if wide > upper.shape.wide_m + _CENTRED_M:
            continue
        pose = np.array([upper.pose[0], bottom - _BELOW_HIGH_M / 2 - 0.03, upper.pose[2]])
        sides = np.array([wide, _BELOW_HIGH_M])
        stretch_kernel(every, _BELOW_STEPS, pose, sides, np.array([1.0, 0.0]))
        found.append((SignShape(RECTANGLE, float(sides[0]), float(sides[1])), pose))
    return found


def _snapped(
    every: Floats, cost: float, pose: Floats, sides: Floats
) -> tuple[float, Floats, Floats]:
    """The same with usual sides, where that costs little."""
    fixed = np.zeros(2)
    for axis in range(2):
        keep = fixed.copy()
        keep[axis] = 1.0
        best = cost + _SNAP_COST
        usual = round(float(sides[axis]) / _USUAL_M) * _USUAL_M
        start_pose, start_sides = pose, sides
        for side in (usual, usual - _USUAL_M, usual + _USUAL_M):
            if side < _USUAL_M / 2:
                continue
            place, other = start_pose.copy(), start_sides.copy()
            other[axis] = side
            changed = stretch_kernel(every, _STRETCH[1:], place, other, keep)
            if changed < best:
                best, pose, sides, fixed = changed, place, other, keep
        cost = best if fixed[axis] else cost
    return cost, pose, sides

"""Shafts: the straight round bodies among the columns beside a road, each with its foot."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor, PartMonitor
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.column_points import ColumnPoints, points_about
from processing.methods.road.objects.columns import ONE_M, FoundColumns, distinct_columns
from processing.methods.road.objects.drive_passes import passes_of
from processing.methods.road.objects.foot import foot_height, ground_beside_kernel
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.poles.shaft_kernels import (
    ARC,
    BESIDE_M,
    DEVIATION,
    EAST,
    INSIDE,
    LEAN_EAST,
    LEAST_ARC,
    LEAST_SLABS,
    LEVEL_M,
    LOW,
    MOST_INSIDE,
    NOISE,
    NORTH,
    POINTS,
    RADIUS,
    SHAFT_WIDTH,
    SLABS,
    TAPER,
    TOP,
    shafts_kernel,
)
from processing.methods.road.poles.surface_lines import ShaftLimits
from processing.recording.columns.ordering import chunk_ranges
from processing.recording.drive import Drive

ABOUT_M = 0.7
"""Points so near to a column may be of its shaft: half the thickest and what columns are off."""

_COLUMNS_AT_ONCE = 64
"""Between two moments at which the work can be stopped: a hundredth of a second."""

_OF_COLUMN = 2
"""Shafts of a column: a post and the trunk, wall or stay beside it."""

MOST_DIAMETER_M = 0.6
"""The feet of the thickest poles have 46 cm (JIS A 5373: 17 m), their sockets more."""

_LIMITS = ShaftLimits(
    least_m=0.01,
    most_m=MOST_DIAMETER_M / 2,
    steepest=0.25,
    low_m=0.15,
    high_m=3.0,
    gap_m=1.5,
    noise_m=0.015,
)
"""Radii from canes of banners on, leans to 14 degrees; first looked for between grass and most
crowns; hidden by plates and twigs for 1.5 m."""

_RAISED_LIMITS = _LIMITS._replace(low_m=1.8, high_m=6.6)
"""Of those whose lower part something before them hides: where their columns are looked for."""

_POST_LIMITS = _LIMITS._replace(most_m=0.15, high_m=1.3, gap_m=0.3)
"""Of posts in columns that show no other shaft: no bollard or delineator is thicker or higher
(視線誘導標設置基準). Leaves and rails hide what goes on above, and grass before a post has more
points than it has."""

_NEAR_M = 0.35
"""From the middle of a column to the points of such a post, a cell and its own half."""

_CURB_M = 0.15
"""What is seen about a column tells its ground where the coarse map is off by a curb and more: the
bottom of a gutter within its 0.8 m."""

LEAST_LONG_M = 0.4
"""The shortest delineators, 0.5 m, with a decimetre hidden."""

_CUT_M = ABOUT_M - BESIDE_M
"""Of a shaft whose surface lies farther from its column, what stands beside it was cut off, or half
of itself: hedges and walls beside a post draw its column to them."""

_HIDDEN_M = 1.5
"""Up to which height at least the lower part of a raised column's shaft is hidden: what shows lower
and stands nowhere free there has a trunk's stakes or leaves about it."""

_FEWEST_OF_TAPER = 10
"""Points of fewer a line of radii says nothing."""

_SAME_M = 0.1
"""Axes nearer than this are of one shaft that two columns showed."""


@dataclass(frozen=True)
class Shaft:
    """One shaft.

    Attributes
    ----------
    foot : (3,) float64
        Where its axis meets the ground, m about the plan's origin.
    lean : (2,) float64
        Metres that the axis moves to the east and north in a metre of height.
    radius_m, taper : float
        Radius at the foot, m; what it loses in a metre of height.
    deviation_m : float
        Standard deviation of the radius, m.
    noise_m : float
        How far its points lie off it.
    low_m, top_m : float
        Between which heights above the foot it was seen.
    told : (SHAFT_WIDTH,) float64
        All that the kernel told of it, about its column.
    drives, points : (n,) int64
        Its points, the lowest first: of which drive each is, and its number there.
    local : (n, 3) float64
        The same points, m about its foot.
    """

    foot: Floats
    lean: Floats
    radius_m: float
    taper: float
    deviation_m: float
    noise_m: float
    low_m: float
    top_m: float
    told: Floats
    drives: Integers
    points: Integers
    local: Floats

    def radius_at(self, height_m: float) -> float:
        """Radius at a height above the foot, m."""
        return self.radius_m - self.taper * height_m

    @property
    def taper_deviation(self) -> float:
        """Standard deviation of the taper by its points' noise; of half a round that of a whole.

        A line of radii over heights: noise over the spread of the heights and the root of their
        number.
        """
        heights = self.local[:, 2]
        if len(heights) < _FEWEST_OF_TAPER:
            return math.inf
        return 2 * self.noise_m / max(float(heights.std()) * math.sqrt(len(heights)), 1e-9)


def feet_of(shafts: Sequence[Shaft]) -> Floats:
    """(n, 2) where shafts stand, m about the plan's origin."""
    return np.array([one.foot[:2] for one in shafts]).reshape(-1, 2)


def find_shafts(
    drives: Sequence[Drive], plan: SparsePlan, columns: FoundColumns, monitor: Monitor
) -> list[Shaft]:
    """All shafts of a survey; many are trunks, posts of fences and edges of walls.

    Parameters
    ----------
    plan : SparsePlan
        With the tiles of all points.
    columns : FoundColumns
        What stands upright on it.
    """
    columns = distinct_columns(columns)
    gathered = points_about(drives, plan, columns.middles, ABOUT_M, PartMonitor(monitor, 0.0, 0.8))
    seen = _on_seen_ground(columns, gathered)
    is_off = np.abs(seen.ground - columns.ground) > _CURB_M
    columns = replace(columns, ground=np.where(is_off, seen.ground, columns.ground))
    passes = [_only(gathered, members) for members in passes_of(drives)]
    found = [shaft for one in passes for shaft in _of_pass(columns, one, _LIMITS, monitor)]
    is_bare = _are_bare(columns, found)
    bare = seen.chosen(is_bare)
    for one in passes:
        found += _of_pass(bare, _near(one, columns, is_bare), _POST_LIMITS, monitor)
    return _one_of_each(found)


def _are_bare(columns: FoundColumns, found: Sequence[Shaft]) -> Flags:
    """Which columns show no shaft."""
    from scipy.spatial import cKDTree

    if not found:
        return np.ones(len(columns), np.bool_)
    return np.asarray(cKDTree(feet_of(found)).query(columns.middles)[0] > ONE_M)


def _near(gathered: ColumnPoints, columns: FoundColumns, which: Flags) -> ColumnPoints:
    """The points near the middles of some columns."""
    is_near = np.zeros(len(gathered.points), np.bool_)
    near_kernel(gathered.local, gathered.starts, columns.middles, which, is_near)
    near = gathered.chosen(is_near)
    # The others have none, so that what is left lies side by side.
    return replace(near, starts=near.starts[np.append(which, True)])


@kernel
def near_kernel(
    points: Floats, starts: Integers, middles: Floats, which: Flags, is_near: Flags
) -> None:
    """Mark the points near the middles of some columns."""
    for column in np.flatnonzero(which):
        for point in range(starts[column], starts[column + 1]):
            east = points[point, 0] - middles[column, 0]
            north = points[point, 1] - middles[column, 1]
            is_near[point] = east * east + north * north < _NEAR_M * _NEAR_M


def _on_seen_ground(columns: FoundColumns, gathered: ColumnPoints) -> FoundColumns:
    """The same on the ground that was seen about each."""
    ground = np.empty(len(columns))
    ground_beside_kernel(gathered.local, gathered.starts, columns.middles, columns.ground, ground)
    return replace(columns, ground=ground)


def find_hidden_shafts(
    drives: Sequence[Drive],
    plan: SparsePlan,
    raised: FoundColumns,
    standing: Sequence[Shaft],
    monitor: Monitor,
) -> list[Shaft]:
    """Shafts of which something hides the lower part, but for those that are known.

    Parameters
    ----------
    raised : FoundColumns
        Where something stands upright of which nothing lower was seen.
    standing : sequence of Shaft
        The known ones.
    """
    from scipy.spatial import cKDTree

    if not len(raised):
        return []
    raised = distinct_columns(raised)
    gathered = points_about(drives, plan, raised.middles, ABOUT_M, monitor)
    found: list[Shaft] = []
    for members in passes_of(drives):
        found += _of_pass(raised, _only(gathered, members), _RAISED_LIMITS, monitor)
    found = [one for one in _one_of_each(found) if one.low_m >= _HIDDEN_M]
    if not found or not standing:
        return found
    away = np.asarray(cKDTree(feet_of(standing)).query(feet_of(found))[0])
    return [found[number] for number in np.flatnonzero(away > ONE_M).tolist()]


def with_whole_sides(
    shafts: Sequence[Shaft], around: ColumnPoints, monitor: Monitor
) -> list[Shaft]:
    """The same, those far from their column fitted again to what stands about themselves.

    Parameters
    ----------
    around : ColumnPoints
        Points about the shafts, `ABOUT_M` and farther.
    """

    def whole(number: int) -> Shaft:
        monitor.check()
        shaft = shafts[number]
        return _fitted_again(around, number, shaft) if _is_cut(shaft) else shaft

    return list(in_order(whole, range(len(shafts))))


def _is_cut(shaft: Shaft) -> bool:
    if shaft.low_m >= _HIDDEN_M:
        return False
    return bool(np.hypot(*shaft.told[EAST : NORTH + 1]) + shaft.radius_m > _CUT_M)


def _fitted_again(around: ColumnPoints, number: int, shaft: Shaft) -> Shaft:
    """The shaft on the same axis that all points about it tell; itself where they tell none."""
    part = around.of(number)
    local, drives = around.local[part], around.drives[part]
    near = np.hypot(*(local[:, :2] - shaft.foot[:2]).T) < ABOUT_M
    near &= np.isin(drives, np.unique(shaft.drives))
    about = ColumnPoints(
        np.array([0, np.count_nonzero(near)], np.int64),
        local[near],
        drives[near],
        around.points[part][near],
    )
    place = FoundColumns(shaft.foot[None, :2], shaft.foot[2:], np.zeros(1, np.uint32))
    told = np.zeros((1, _OF_COLUMN, SHAFT_WIDTH))
    shafts_kernel(about.local - shaft.foot, about.starts, _LIMITS, told)
    again = [_standing(place, about, 0, one) for one in told[0][_are_shafts(told)[0]]]
    off = [float(np.hypot(*(one.foot - shaft.foot)[:2])) for one in again]
    return again[int(np.argmin(off))] if off and min(off) < _SAME_M else shaft


def shafts_about(points: Floats) -> list[Floats]:
    """What the kernel tells of the shafts at one place, whether they are taken or not.

    Parameters
    ----------
    points : (n, 3) float64
        m about the place on the ground.

    Returns
    -------
    list of (SHAFT_WIDTH,) float64
    """
    told = np.zeros((1, _OF_COLUMN, SHAFT_WIDTH))
    shafts_kernel(points, np.array([0, len(points)], np.int64), _LIMITS, told)
    return [one for one in told[0] if one[RADIUS] > 0]


def _only(gathered: ColumnPoints, members: Sequence[int]) -> ColumnPoints:
    """The points of some drives."""
    is_in = np.isin(gathered.drives, members)
    return gathered if is_in.all() else gathered.chosen(is_in)


def _of_pass(
    columns: FoundColumns, gathered: ColumnPoints, limits: ShaftLimits, monitor: Monitor
) -> list[Shaft]:
    places = np.column_stack([columns.middles, columns.ground])
    told = np.zeros((len(columns), _OF_COLUMN, SHAFT_WIDTH))

    def measure(some: tuple[int, int]) -> None:
        monitor.check()
        starts = gathered.starts[some[0] : some[1] + 1]
        owner = np.repeat(np.arange(*some), np.diff(starts))
        about = gathered.local[starts[0] : starts[-1]] - places[owner]
        shafts_kernel(about, starts - starts[0], limits, told[some[0] : some[1]])

    for _ in in_order(measure, chunk_ranges(len(columns), _COLUMNS_AT_ONCE)):
        monitor.check()

    def standing(shaft: list[int]) -> Shaft:
        column, number = shaft
        return _standing(columns, gathered, column, told[column, number])

    return list(in_order(standing, np.argwhere(_are_shafts(told)).tolist()))


def _are_shafts(told: Floats) -> NDArray[np.bool_]:
    is_shaft = (told[..., RADIUS] > 0) & (told[..., TOP] - told[..., LOW] >= LEAST_LONG_M)
    is_shaft &= (told[..., SLABS] >= LEAST_SLABS) & (told[..., ARC] >= LEAST_ARC)
    return np.asarray(is_shaft & (told[..., INSIDE] <= MOST_INSIDE))


def _standing(columns: FoundColumns, gathered: ColumnPoints, column: int, told: Floats) -> Shaft:
    """A shaft with its foot on the ground and its points."""
    part = gathered.of(column)
    local = gathered.local[part]
    coarse = float(columns.ground[column])
    lean = told[LEAN_EAST : LEAN_EAST + 2]
    middle = columns.middles[column] + told[EAST : NORTH + 1] - LEVEL_M * lean
    height = foot_height(local, middle, coarse, float(told[RADIUS]))
    rise = height - coarse
    up = local[:, 2] - coarse - LEVEL_M
    off = local[:, :2] - columns.middles[column] - told[EAST : NORTH + 1] - up[:, None] * lean
    away = np.abs(np.hypot(off[:, 0], off[:, 1]) - told[RADIUS] + told[TAPER] * up)
    is_on = (away < max(0.008, 3 * told[NOISE])) & (up > -LEVEL_M + 0.05)
    is_on &= up <= told[TOP] - LEVEL_M
    lines = np.flatnonzero(is_on)
    lines = lines[np.argsort(up[lines], kind="stable")]
    foot = np.array([*(middle + lean * rise), height])
    return Shaft(
        foot=foot,
        lean=lean.copy(),
        radius_m=float(told[RADIUS] + told[TAPER] * (LEVEL_M - rise)),
        taper=float(told[TAPER]),
        deviation_m=float(told[DEVIATION]),
        noise_m=float(told[NOISE]),
        low_m=float(told[LOW] - rise),
        top_m=float(told[TOP] - rise),
        told=told.copy(),
        drives=gathered.drives[part][lines],
        points=gathered.points[part][lines],
        local=local[lines] - foot,
    )


def _one_of_each(found: Sequence[Shaft]) -> list[Shaft]:
    """Of shafts on one axis the one with the most points."""
    from scipy.spatial import cKDTree

    if not found:
        return []
    order = sorted(range(len(found)), key=lambda one: -found[one].told[POINTS])
    feet = feet_of([found[one] for one in order])
    leans = np.array([found[one].lean for one in order]).reshape(-1, 2)
    is_kept = np.zeros(len(order), np.bool_)
    tree, reach = cKDTree(feet), _SAME_M + 2 * _LIMITS.steepest * LEVEL_M
    for place, number in enumerate(order):
        level = min(found[number].top_m, LEVEL_M)
        near = np.array(tree.query_ball_point(feet[place], reach, return_sorted=True), np.int64)
        before = near[is_kept[near]]
        off = feet[place] - feet[before] + level * (leans[place] - leans[before])
        is_kept[place] = not (np.hypot(off[:, 0], off[:, 1]) < _SAME_M).any()
    return [found[order[place]] for place in np.flatnonzero(is_kept).tolist()]

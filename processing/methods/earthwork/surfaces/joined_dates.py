"""The ground of several dates put together: what one did not show is told by the others.

Of every cell three things are known of each date: its height where it was measured; what its own
surroundings let expect where it was not, and how surely; and of every two dates the change that is
expected there, and how surely. The heights that fit all of it best, each by its variance, keep
what was measured, take the shape of another date where this one was hidden, and change only as far
as the neighbourhood says.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.methods.earthwork.surfaces.filling import FARTHEST_M
from processing.methods.earthwork.surfaces.hidden_change import expected_change
from processing.methods.earthwork.surfaces.surfaces import (
    SideHeights,
    cells_of_hole,
    coarse_any,
    coarse_means,
    fine_heights,
    repeated_cells,
)

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

_MEASURED_M = 1e-4
"""Standard deviation that stands for a measured height: less than any other by far, so that it
stays; what it is truly off is stated elsewhere."""

_AT_ONCE = 1 << 16
"""Cells whose equations are solved at a time: some megabytes."""


@dataclass(frozen=True)
class JoinedDates:
    """The grounds of some dates, each filled in by all of them.

    Attributes
    ----------
    grounds : tuple of SideHeights
        In the order of the dates.
    change_spread : (rows, columns) float64
        Standard deviation of the change between the first two, m; 0 where both were measured.
    """

    grounds: tuple[SideHeights, ...]
    change_spread: Floats


def join_dates(
    dates: Sequence[SideHeights],
    counted: Sequence[Floats],
    is_wanted: Mask,
    size_m: float,
    monitor: Monitor,
) -> JoinedDates:
    """Fill what some dates did not show by all of them.

    Parameters
    ----------
    dates : sequence of SideHeights
        At least two, each filled in from its own surroundings.
    counted : sequence of (rows, columns) float64
        Mean height of the ground points in a cell of each date, m; NaN without a point.
    is_wanted : (rows, columns) bool
        Where ground is asked for; where any of the dates has some, all of them get one.
    size_m : float
        Side of a cell.
    """
    is_told = np.any([np.isfinite(date.heights) for date in dates], axis=0)
    is_shown = np.all([date.is_measured for date in dates], axis=0)
    cells = np.flatnonzero(is_wanted & is_told & ~is_shown)
    own = np.stack([date.heights.ravel()[cells] for date in dates], axis=1)
    is_measured = np.stack([date.is_measured.ravel()[cells] for date in dates], axis=1)
    spread = np.stack([date.spread.ravel()[cells] for date in dates], axis=1)
    is_known = np.isfinite(own)
    sure = np.where(is_known, 1 / np.square(np.maximum(spread, _MEASURED_M)), 0.0)
    own = np.where(is_known, own, 0.0)
    changes: dict[tuple[int, int], tuple[Floats, Floats]] = {}
    for one, other in combinations(range(len(dates)), 2):
        monitor.check()
        mean, variance = _change_at(counted[one], counted[other], is_wanted, size_m)
        changes[one, other] = mean.ravel()[cells], variance.ravel()[cells]
    change_spread = np.zeros(is_wanted.size)
    for start in range(0, len(cells), _AT_ONCE):
        monitor.check()
        part = slice(start, start + _AT_ONCE)
        some = {pair: (mean[part], var[part]) for pair, (mean, var) in changes.items()}
        found, inverse = _best_heights(own[part], sure[part], some)
        own[part] = np.where(is_measured[part], own[part], found)
        spread[part] = np.where(is_measured[part], 0.0, np.sqrt(np.einsum("nii->ni", inverse)))
        variance = inverse[:, 0, 0] + inverse[:, 1, 1] - 2 * inverse[:, 0, 1]
        is_seen = is_measured[part, :2].all(axis=1)
        change_spread[cells[part]] = np.where(is_seen, 0.0, np.sqrt(np.maximum(variance, 0.0)))
    grounds = tuple(
        replace(
            date,
            heights=_with_values(date.heights, cells, heights),
            spread=_with_values(date.spread, cells, deviations),
        )
        for date, heights, deviations in zip(dates, own.T, spread.T, strict=True)
    )
    return JoinedDates(grounds, change_spread.reshape(is_wanted.shape))


def reached_ground(date: SideHeights, is_shown: Mask, size_m: float) -> Mask:
    """Where a date has ground, or another measured it no farther from that than holes reach.

    Parameters
    ----------
    is_shown : (rows, columns) bool
        As :func:`shown_by_others` says.
    """
    from scipy.ndimage import distance_transform_edt

    has_ground: Mask = np.isfinite(date.heights)
    if has_ground.all() or not has_ground.any():
        return has_ground
    is_near = np.asarray(distance_transform_edt(~has_ground)) * size_m <= FARTHEST_M
    reached: Mask = has_ground | (is_shown & is_near)
    return reached


def shown_by_others(dates: Sequence[SideHeights], number: int) -> Mask:
    """Where any date but one measured the ground: (rows, columns) bool."""
    found: Mask = np.any([one.is_measured for at, one in enumerate(dates) if at != number], axis=0)
    return found


def _with_values(values: Floats, cells: NDArray[np.int64], told: Floats) -> Floats:
    """A copy with other values in some cells."""
    copy = values.copy()
    copy.ravel()[cells] = told
    return copy


def _change_at(
    before: Floats, after: Floats, is_wanted: Mask, size_m: float
) -> tuple[Floats, Floats]:
    """Expected change of every wanted cell and its variance.

    Told by cells that both dates measured: on a slope, means over different parts of a larger cell
    differ without any change.
    """
    times = cells_of_hole(size_m)
    change = coarse_means(after - before, times)
    field = expected_change(change, coarse_any(is_wanted, times), times * size_m)
    shape = (is_wanted.shape[0], is_wanted.shape[1])
    return fine_heights(field.mean, times, shape), repeated_cells(field.variance, times, shape)


def _best_heights(
    own: Floats, sure: Floats, changes: dict[tuple[int, int], tuple[Floats, Floats]]
) -> tuple[Floats, Floats]:
    """Heights of all dates by weighted least squares: (n, k), and their covariances: (n, k, k).

    Every two dates speak of a change, but with ``k`` dates only ``k - 1`` changes are independent:
    each pair counts ``2 / k``.
    """
    count, dates = own.shape
    form = np.zeros((count, dates, dates))
    right = sure * own
    form[:, range(dates), range(dates)] = sure
    for (one, other), (mean, variance) in changes.items():
        weight = 2.0 / dates / np.maximum(variance, _MEASURED_M**2)
        form[:, one, one] += weight
        form[:, other, other] += weight
        form[:, one, other] -= weight
        form[:, other, one] -= weight
        right[:, one] -= weight * mean
        right[:, other] += weight * mean
    inverse: Floats = np.linalg.inv(form).astype(np.float64, copy=False)
    heights: Floats = np.einsum("nij,nj->ni", inverse, right)
    return heights, inverse

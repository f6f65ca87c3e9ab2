"""Cut and fill from a map of change, told apart from the noise of both measurements.

Summing what is positive and what is negative counts noise twice: ground that didn't change seems
to be cut here and filled there. So whether a cell was cut or filled is asked of its neighbours,
whose noise is not its own, and by how much of the cell itself. What set-ups of a scanner are off
is the same for neighbours: where the change of a square metre is less than its standard error,
nothing is the better estimate of it, and nothing is counted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.earthwork.maps.change_grid import ChangeGrid

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

_NEIGHBOURS_M = 0.25
"""To each side; by trial, few enough cells to follow an edge of the work, and at the usual mesh
eight neighbours, whose mean has a third of a cell's noise."""

_CERTAIN_M = 0.5
"""To each side of a cell, the square over which a change is told from none: a metre wide, as the
bucket of an excavator. With half as much again, volumes of development sites were as good."""

_ALIKE_M = 0.5
"""Side of squares that have errors of their own: within them, beams of one set-up meet the same
ground at the same angle. By judgement; cells of the usual mesh counted singly would make six times
as many of it."""

_STABLE_M = 0.05
"""Change below which ground may be untouched, so that its scatter tells what set-ups are off: half
of the thinnest layer that is worked, 10 cm."""

_SIGMA_PER_MEDIAN = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""


@dataclass(frozen=True)
class ChangeSums:
    """Cut and fill over some cells, m³; neither is negative but for what noise leaves."""

    cut_m3: float
    fill_m3: float


def is_filled(change: ChangeGrid) -> Mask:
    """Whether a cell counts as filled rather than cut: (rows, columns) bool.

    Told by the mean change of the cells around it, without its own, a quarter of a metre to each
    side. Where a cell is larger than that, or has no neighbours, its own change tells.
    """
    reach = round(_NEIGHBOURS_M / change.grid.size_m)
    own = change.change_m.astype(np.float64)
    if reach == 0:
        return np.asarray(own > 0)
    known = np.isfinite(own)
    values = np.where(known, own, 0.0)
    sums = _window_sums(values, reach) - values
    counts = _window_sums(known.astype(np.float64), reach) - known
    filled: Mask = np.where(counts > 0, sums > 0, own > 0)
    return filled


def is_certain(change: ChangeGrid) -> Mask:
    """Whether the change about a cell is larger than its standard error: (rows, columns) bool.

    The error has two parts: that of a mean of cells which scatter, and that which all of them
    share, as the means over untouched ground scatter.

    References
    ----------
    Lane, Westaway and Hicks 2003, Estimation of erosion and deposition volumes: changes below what
    can be told are left out. Theirs is a confidence of 95 %; at one standard error what is lost of
    small changes weighs as much as what is gained of noise.
    """
    own = change.change_m.astype(np.float64)
    known = np.isfinite(own)
    values = np.where(known, own, 0.0)
    reach = max(1, round(_CERTAIN_M / change.grid.size_m))
    counts = np.maximum(_window_sums(known.astype(np.float64), reach), 1.0)
    means = _window_sums(values, reach) / counts
    squares = _window_sums(np.square(values), reach) / counts
    scatter = np.maximum(squares - np.square(means), 0.0)
    independent = np.maximum(counts * (change.grid.size_m / _ALIKE_M) ** 2, 1.0)
    stable = means[known & change.is_measured & (np.abs(means) < _STABLE_M)]
    shared_m = 0.0
    if stable.size:
        shared_m = _SIGMA_PER_MEDIAN * float(np.median(np.abs(stable - np.median(stable))))
    certain: Mask = np.square(means) > shared_m**2 + scatter / independent
    return certain


def change_sums(change: ChangeGrid, filled: Mask, counted: Mask) -> ChangeSums:
    """Sum change over cells, each by the share of it that lies inside.

    Parameters
    ----------
    filled : (rows, columns) bool
        As :func:`is_filled` says.
    counted : (rows, columns) bool
        Which cells to sum.
    """
    volumes = change.change_m.astype(np.float64) * change.inside * change.grid.size_m**2
    known = counted & np.isfinite(volumes)
    return ChangeSums(
        cut_m3=-float(volumes[known & ~filled].sum()),
        fill_m3=float(volumes[known & filled].sum()),
    )


def _window_sums(values: Floats, reach: int) -> Floats:
    """Sums over the cells up to ``reach`` to each side, beyond the edge as nothing."""
    for axis in (0, 1):
        sums = np.cumsum(np.pad(values, _to_sides(axis, reach + 1, reach)), axis=axis)
        width = 2 * reach + 1
        high = np.take(sums, np.arange(width, sums.shape[axis]), axis=axis)
        low = np.take(sums, np.arange(sums.shape[axis] - width), axis=axis)
        values = high - low
    return values


def _to_sides(axis: int, before: int, after: int) -> tuple[tuple[int, int], tuple[int, int]]:
    sides = (before, after), (0, 0)
    return sides if axis == 0 else (sides[1], sides[0])

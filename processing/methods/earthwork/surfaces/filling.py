"""Ground between what was measured: a thin plate under slight tension over holes of any shape."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

if TYPE_CHECKING:
    from scipy.sparse import csr_array

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

FARTHEST_M = 10.0
"""Beyond the last points lies what a disc of this radius covers that holds none, unless points
surround it: behind machines and banks of 3 to 5 m a tripod's beams come down again within twice
that. Of sites of development seeds, a radius of 5 m left out 7 % of what was moved on one; 10 m
left out nothing that was moved on any."""

_NEAR_M, _LEAST_SHARE = 1.0, 0.2
"""To each side of a cell with points, within which at least this share of cells has some where
ground was measured: scan lines a metre apart, as at the far end of a site, fill two cells of
five."""

_TENSION = 0.02
"""Weight of slope against bending, per cell squared: bending decides up to some seven cells, 3.5 m
of hole. By trial, just enough to keep a plate from swinging out beyond rough rims."""

_SWEEPS = 24
"""Rounds in which gaps of a few cells take the mean of what is beside them; by trial, more change
nothing that is measured."""

_RIM_CELLS = 3
"""Cells around a hole that are taken along: bending looks two cells far, and one for corners."""

_TWIST = 2.0
"""Weight of the mixed derivative in the energy of a thin plate: it stands in it twice."""


def measured_extent(is_known: Mask, size_m: float) -> Mask:
    """Cells with ground, between such cells, or surrounded by them: (rows, columns) bool, a copy.

    A few points alone are strays more often than ground, and say nothing of how far it reaches.

    Parameters
    ----------
    is_known : (rows, columns) bool
        Cells with points; row = north, column = east.
    size_m : float
        Side of a cell.

    References
    ----------
    Serra 1982, Image Analysis and Mathematical Morphology: the closing by a disc.
    """
    from scipy.ndimage import binary_fill_holes, distance_transform_edt, uniform_filter

    reach = FARTHEST_M / size_m
    near = 2 * max(1, round(_NEAR_M / size_m)) + 1
    shares = uniform_filter(is_known.astype(np.float32), near, mode="constant")
    is_ground = is_known & (shares >= _LEAST_SHARE)
    if not is_ground.any():
        return is_ground
    beside = math.ceil(reach) + 1
    padded = np.pad(is_ground, beside)
    is_near: Mask = np.asarray(distance_transform_edt(~padded) <= reach, np.bool_)
    closed = np.asarray(distance_transform_edt(is_near) > reach, np.bool_)
    extent: Mask = binary_fill_holes(closed[beside:-beside, beside:-beside] | is_ground)
    return extent


def fill_smoothly(heights: Floats, is_known: Mask, is_wanted: Mask) -> Floats:
    """Heights with holes filled by the smoothest surface that meets what is known.

    It goes on with the slopes at the rim, as graded ground does; the tension keeps it from
    swinging out where a rim is rough.

    Parameters
    ----------
    heights : (rows, columns) float64
        What it holds where ``is_known`` is false doesn't matter.
    is_wanted : (rows, columns) bool
        Where holes are to be filled; others stay NaN.

    Returns
    -------
    (rows, columns) float64
        A copy.

    References
    ----------
    Briggs 1974, minimum curvature; Smith and Wessel 1990, continuous curvature splines in tension.
    """
    from scipy.sparse.linalg import spsolve

    filled = np.where(is_known, heights, np.nan)
    holes = is_wanted & ~is_known
    if not holes.any() or not is_known.any():
        return filled
    near = holes.copy()
    for _ in range(_RIM_CELLS):
        near = _grown(near)
    used = near & (is_known | is_wanted)
    rows, columns = _window(used)
    numbers = np.full(used.shape, -1, np.int64)
    numbers[used] = np.arange(int(used.sum()))
    roughness = _roughness(numbers[rows, columns], int(used.sum()))
    unknown = ~is_known[used]
    known_heights = np.where(is_known, heights, 0.0)[used][~unknown]
    right = -(roughness[unknown][:, ~unknown] @ known_heights)
    matrix = roughness[unknown][:, unknown].tocsc()
    filled[used & ~is_known] = spsolve(matrix, right)
    return filled


def _window(used: Mask) -> tuple[slice, slice]:
    rows, columns = (np.flatnonzero(used.any(axis=axis)) for axis in (1, 0))
    return slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)


def _grown(mask: Mask) -> Mask:
    grown = mask.copy()
    grown[1:] |= mask[:-1]
    grown[:-1] |= mask[1:]
    grown[:, 1:] |= mask[:, :-1]
    grown[:, :-1] |= mask[:, 1:]
    return grown


def _roughness(numbers: NDArray[np.int64], count: int) -> csr_array:
    """The quadratic form that is minimised, over the numbered cells."""
    from scipy.sparse import csr_array

    form = csr_array((count, count))
    across, down = numbers, numbers.T
    for cells in (across, down):
        form = form + _squared((cells[:, :-2], cells[:, 1:-1], cells[:, 2:]), (1, -2, 1), count)
        form = form + _TENSION * _squared((cells[:, :-1], cells[:, 1:]), (-1, 1), count)
    corners = (across[:-1, :-1], across[:-1, 1:], across[1:, :-1], across[1:, 1:])
    return csr_array(form + _TWIST * _squared(corners, (1, -1, -1, 1), count))


def _squared(
    cells: tuple[NDArray[np.int64], ...], weights: tuple[int, ...], count: int
) -> csr_array:
    """The sum of squares of a difference, wherever all of its cells are numbered."""
    from scipy.sparse import csr_array

    stacked = np.stack([one.ravel() for one in cells], axis=1)
    stacked = stacked[(stacked >= 0).all(axis=1)]
    rows = np.repeat(np.arange(len(stacked)), stacked.shape[1])
    values = np.tile(np.array(weights, np.float64), len(stacked))
    difference = csr_array((values, (rows, stacked.ravel())), shape=(len(stacked), count))
    return csr_array(difference.T @ difference)


def relax_heights(heights: Floats, is_known: Mask) -> None:
    """Fit filled cells to the measured ones beside them, in place: gaps of a few cells.

    Parameters
    ----------
    heights : (rows, columns) float64
        Filled roughly where ``is_known`` is false; NaN where there is no surface.
    """
    _relax_kernel(heights, is_known, _SWEEPS)


@kernel
def _relax_kernel(heights: Floats, is_known: Mask, sweeps: int) -> None:
    rows, columns = heights.shape
    for sweep in range(sweeps):
        for step in range(rows):
            row = step if sweep % 2 == 0 else rows - 1 - step
            for column in range(columns):
                if is_known[row, column] or np.isnan(heights[row, column]):
                    continue
                total, count = 0.0, 0
                if row > 0 and not np.isnan(heights[row - 1, column]):
                    total += heights[row - 1, column]
                    count += 1
                if row + 1 < rows and not np.isnan(heights[row + 1, column]):
                    total += heights[row + 1, column]
                    count += 1
                if column > 0 and not np.isnan(heights[row, column - 1]):
                    total += heights[row, column - 1]
                    count += 1
                if column + 1 < columns and not np.isnan(heights[row, column + 1]):
                    total += heights[row, column + 1]
                    count += 1
                if count > 0:
                    heights[row, column] = total / count


def warm_up() -> None:
    """Compile the kernel of this file."""
    _relax_kernel(np.zeros((2, 2)), np.zeros((2, 2), np.bool_), 1)

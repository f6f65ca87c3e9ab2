"""Islands of measured cells over hidden ground, and which of them are no ground.

Behind a crest or a machine a scanner shows nothing of the ground for metres, but now and then a
roof, the top of a hedge, or points that came by way of a puddle or a sheet of steel. They hang
together with each other and not with the ground about, so nothing beside them tells them from a
piece of ground; and the whole hole would be filled in from them. Another date tells: where it
measured the ground, and the changes about the hole let expect its change, an island far from what
that makes is of something else.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.methods.earthwork.surfaces.ground_cells import ABOUT_M, LEVEL_M, STEEP
from processing.methods.earthwork.surfaces.surfaces import SideHeights

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Labels = NDArray[np.int32]

_LARGEST_M2 = 100.0
"""Area of measured cells up to which a part of the ground is asked about: what stands on sites and
has a flat top, a hut or three containers side by side, covers less."""

_DEVIATIONS = 5.0
"""Standard deviations off what is expected, from which an island is of something else. On 22 sites
of development seeds (2401 to 2414, 2601 to 2608) ground lay up to 4 off, strays 5 to 100."""

_SEEN_SHARE = 0.5
"""Of an island's cells, that another date has to show: the shape of hidden ground is not known well
enough to hold measured points against it."""

_SOLID_SHARE = 0.5
"""Of the cells within ``ABOUT_M`` of an island's own, that belong to it in the mean where a surface
is seen: .65 on a roof of 16 m² some 25 m from the scanner; of strays on the development sites, a
few of many beams, .13 at most."""


def loose_islands(heights: Floats, size_m: float) -> Labels:
    """Number the small parts of measured ground that hang together with no other.

    Parameters
    ----------
    heights : (rows, columns) float64
        m; NaN where nothing was measured.

    Returns
    -------
    (rows, columns) int32
        From 1 on; 0 for ground in large parts, and where nothing was measured.
    """
    labels = np.zeros(heights.shape, np.int32)
    numbers = np.flatnonzero(np.isfinite(heights))
    stack = np.empty(numbers.size, np.int64)
    reach = max(1, round(ABOUT_M / size_m))
    count = _parts_kernel(numbers, heights, (reach, size_m), stack, labels)
    cells = np.bincount(labels.ravel(), minlength=count + 1)
    is_loose = cells * size_m**2 < _LARGEST_M2
    is_loose[0] = False
    if count and is_loose[1:].all():
        # A small site as a whole is no island.
        is_loose[1 + int(np.argmax(cells[1:]))] = False
    numbered = np.where(is_loose, np.cumsum(is_loose), 0).astype(np.int32)
    return numbered[labels]


def contradicted(
    heights: Floats, labels: Labels, expected: Sequence[SideHeights], number: int, size_m: float
) -> Mask:
    """Cells of islands that lie far from what other dates and the changes about let expect.

    The ground may be as another date shows it, or have changed as the surroundings did, or lie
    between: a change ends somewhere.

    Parameters
    ----------
    heights : (rows, columns) float64
        As a date measured them, m.
    labels : (rows, columns) int32
        Its islands, as :func:`loose_islands` numbers them.
    expected : sequence of SideHeights
        What each date would be without its islands.
    number : int
        Which of them the date is.
    """
    stray = np.zeros(int(labels.max(initial=0)) + 1, np.bool_)
    lowest, highest, is_shown = _expected_range(expected, number)
    above = np.maximum(heights - highest, 0.0) - np.maximum(lowest - heights, 0.0)
    solid = _solidity(labels, size_m)
    cells = np.flatnonzero(labels)
    cells = cells[np.argsort(labels.ravel()[cells], kind="stable")]
    borders = np.flatnonzero(np.diff(labels.ravel()[cells])) + 1
    for part in np.split(cells, borders) if cells.size else ():
        if is_shown.ravel()[part].mean() < _SEEN_SHARE:
            continue
        away_m = float(np.median(above.ravel()[part]))
        spread_m = float(np.median(expected[number].spread.ravel()[part]))
        # A pit with upright walls is seen as a surface; nothing that is mirrored is.
        is_pit = away_m < 0 and solid.ravel()[part].mean() >= _SOLID_SHARE
        # NaN, where nothing is expected, is never more.
        is_far = abs(away_m) > _DEVIATIONS * np.hypot(spread_m, LEVEL_M)
        stray[labels.ravel()[part[0]]] = is_far and not is_pit
    found: Mask = stray[labels]
    return found


def _expected_range(expected: Sequence[SideHeights], number: int) -> tuple[Floats, Floats, Mask]:
    """Lowest and highest that a date's ground may be, and where another date measured it."""
    lowest, highest = expected[number].heights.copy(), expected[number].heights.copy()
    is_shown = np.zeros(lowest.shape, np.bool_)
    for at, other in enumerate(expected):
        if at == number:
            continue
        is_shown |= other.is_measured
        told = np.where(other.is_measured, other.heights, np.nan)
        # Where it was not measured the expected height stays.
        lowest, highest = np.fmin(lowest, told), np.fmax(highest, told)
    return lowest, highest, is_shown


def _solidity(labels: Labels, size_m: float) -> Floats:
    """Of the cells within ``ABOUT_M`` of each, the share that belong to islands."""
    from scipy.ndimage import uniform_filter

    width = 2 * max(1, round(ABOUT_M / size_m)) + 1
    share: Floats = uniform_filter((labels > 0).astype(np.float64), width, mode="constant")
    return share


@kernel
def _parts_kernel(
    cells: NDArray[np.int64],
    heights: Floats,
    window: tuple[int, float],
    stack: NDArray[np.int64],
    labels: Labels,
) -> int:
    """Number the parts whose cells lie near and level enough to be of the same ground.

    ``labels`` is zero at first; returns how many parts there are.
    """
    reach, size_m = window
    rows, columns = labels.shape
    count = 0
    for first in cells:
        if labels[first // columns, first % columns] > 0:
            continue
        count += 1
        labels[first // columns, first % columns] = count
        stack[0] = first
        held = 1
        while held:
            held -= 1
            row, column = stack[held] // columns, stack[held] % columns
            for at in range(max(0, row - reach), min(rows, row + reach + 1)):
                for beside in range(max(0, column - reach), min(columns, column + reach + 1)):
                    away = np.hypot(at - row, beside - column)
                    if labels[at, beside] > 0 or away > reach:
                        continue
                    # NaN, where nothing was measured, fails.
                    apart_m = abs(heights[at, beside] - heights[row, column])
                    if apart_m <= LEVEL_M + STEEP * size_m * away:
                        labels[at, beside] = count
                        stack[held] = at * columns + beside
                        held += 1
    return count


def warm_up() -> None:
    """Compile the kernel of this file."""
    loose_islands(np.zeros((2, 2)), 1.0)

"""Loops over the pixels of a point-cloud image; all work on pulses, none on coordinates."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.kernels import kernel
from processing.recording.columns.counted_classes import NOISE_CODES, ClassColumns

_FIRST_ROW, _STEP, _FIRST_COLUMN, _END_COLUMN, _WIDTH = range(5)
"""Of a window: first row, step of rows, first column, end of columns, width of the image."""

_LINEAR_STEPS = 4
"""Pulses looked through one by one before the search halves what is left: the next point mostly is
one of them."""

_LOW_NOISE, _HIGH_NOISE = NOISE_CODES
_NONE = -1
"""No point."""


class PixelLayout(NamedTuple):
    """The arrays from which the pixel of a point follows.

    Point p of row r has the column ``(2 pulses[p] − origins[r]) × per_span div spans[r]``; see
    :class:`processing.image.rows.rows_of_kind.RowPlan`.
    """

    pulses: Integers
    row_starts: Integers
    origins: Integers
    spans: Integers
    per_span: int


@kernel
def first_at(pulses: Integers | NDArray[np.int32], start: int, stop: int, pulse: int) -> int:
    """The first of the points ``start … stop − 1`` whose pulse isn't less; else ``stop``."""
    low, high = start, stop
    while low < high:
        middle = (low + high) // 2
        if pulses[middle] < pulse:
            low = middle + 1
        else:
            high = middle
    return low


@kernel
def first_at_column(layout: PixelLayout, row: int, column: int) -> int:
    """The first point of a row at or right of a column; else the row's end."""
    pulse = _pulse_of_column(layout, row, column)
    return first_at(layout.pulses, layout.row_starts[row], layout.row_starts[row + 1], pulse)


@kernel
def shown_point(layout: PixelLayout, row: int, start: int, end: int) -> int:
    """Which point of a pixel is shown: the one nearest the pixel's centre, of equals the first."""
    if layout.per_span == 1:
        return start
    origin, span = layout.origins[row], layout.spans[row]
    best, best_distance = start, span
    for point in range(start, end):
        rest = (2 * layout.pulses[point] - origin) * layout.per_span % span
        distance = abs(2 * rest - span)
        if distance < best_distance:
            best, best_distance = point, distance
    return best


@kernel
def raster_kernel(layout: PixelLayout, window: Integers, raster: Integers) -> bool:
    """Fill a raster with the point shown in every pixel, −1 where there is none.

    ``window``: first row, step, first column, end of columns, width of the image. False, and
    half a raster, where columns fall within a row or lie outside of the image.
    """
    step, first_column = window[_STEP], window[_FIRST_COLUMN]
    for i in range(raster.shape[0]):
        row = window[_FIRST_ROW] + i * step
        stop = layout.row_starts[row + 1]
        raster[i, :] = -1
        point, least = first_at_column(layout, row, first_column), first_column
        while point < stop:
            column = _column(layout, row, point)
            if column < least or column >= window[_WIDTH]:
                return False
            if column >= window[_END_COLUMN]:
                break
            least = column
            end = point + 1
            while end < stop and _column(layout, row, end) == column:
                end += 1
            j = (column - first_column) // step
            raster[i, j] = shown_point(layout, row, point, end)
            point = end
            if step > 1:
                point = _skip_to(layout, row, end, first_column + (j + 1) * step)
    return True


@kernel
def noiseless_raster_kernel(
    layout: PixelLayout, classes: ClassColumns, window: Integers, raster: Integers
) -> bool:
    """As :func:`raster_kernel`, but points of noise are not there."""
    step, first_column = window[_STEP], window[_FIRST_COLUMN]
    for i in range(raster.shape[0]):
        row = window[_FIRST_ROW] + i * step
        stop = layout.row_starts[row + 1]
        raster[i, :] = -1
        point, least = first_at_column(layout, row, first_column), first_column
        while point < stop:
            column = _column(layout, row, point)
            if column < least or column >= window[_WIDTH]:
                return False
            if column >= window[_END_COLUMN]:
                break
            least = column
            end = point + 1
            while end < stop and _column(layout, row, end) == column:
                end += 1
            shown = _shown_good_point(layout, classes, row, point, end)
            point = end
            if shown >= 0:
                j = (column - first_column) // step
                raster[i, j] = shown
                if step > 1:
                    point = _skip_to(layout, row, end, first_column + (j + 1) * step)
    return True


@kernel
def columns_kernel(layout: PixelLayout, first: Integers, columns: NDArray[np.int32]) -> bool:
    """Columns of consecutive points; ``first``: the first point, its row, width of the image.

    False, and only some columns, where they fall within a row or lie outside of the image.
    """
    point, row, least = first[0], first[1], 0
    for i in range(columns.size):
        while point + i >= layout.row_starts[row + 1]:
            row += 1
            least = 0
        column = _column(layout, row, point + i)
        if column < least or column >= first[2]:
            return False
        columns[i] = least = column
    return True


@kernel
def stretches_kernel(layout: PixelLayout, windows: Integers, stretches: Integers) -> bool:
    """The points of windows, row by row: (rows of all windows, 2) first and end.

    ``windows``: first and end row, first and end column. False where an end comes before its
    first, as it does only where pulses fall.
    """
    line = 0
    for k in range(windows.shape[0]):
        for row in range(windows[k, 0], windows[k, 1]):
            stretches[line, 0] = first_at_column(layout, row, windows[k, 2])
            stretches[line, 1] = first_at_column(layout, row, windows[k, 3])
            if stretches[line, 1] < stretches[line, 0]:
                return False
            line += 1
    return True


@kernel
def _shown_good_point(
    layout: PixelLayout, classes: ClassColumns, row: int, start: int, end: int
) -> int:
    """The point of a pixel nearest its centre that is no noise, of equals the first; else −1."""
    origin, span = layout.origins[row], layout.spans[row]
    best, best_distance = _NONE, span + 1
    for point in range(start, end):
        if _is_noise(classes, point):
            continue
        if layout.per_span == 1:
            return point
        rest = (2 * layout.pulses[point] - origin) * layout.per_span % span
        distance = abs(2 * rest - span)
        if distance < best_distance:
            best, best_distance = point, distance
    return int(best)


@kernel
def _is_noise(classes: ClassColumns, point: int) -> bool:
    code = 0
    if classes.labels.size > 0:
        code = int(classes.labels[point])
    if code == 0 and classes.delivered.size > 0:
        code = int(classes.delivered[point])
    return code in (_LOW_NOISE, _HIGH_NOISE)


@kernel
def _column(layout: PixelLayout, row: int, point: int) -> int:
    doubled = 2 * layout.pulses[point] - layout.origins[row]
    if layout.per_span == 1:
        return int(doubled >> 1)
    return int(doubled * layout.per_span // layout.spans[row])


@kernel
def _pulse_of_column(layout: PixelLayout, row: int, column: int) -> int:
    """The first pulse whose column is at least this one."""
    least = column * layout.spans[row] + layout.origins[row] * layout.per_span
    return int(-(-least // (2 * layout.per_span)))


@kernel
def _skip_to(layout: PixelLayout, row: int, point: int, column: int) -> int:
    """The first point at or right of a column, none of those before ``point``."""
    pulse, stop = _pulse_of_column(layout, row, column), layout.row_starts[row + 1]
    limit = min(stop, point + _LINEAR_STEPS)
    while point < limit:
        if layout.pulses[point] >= pulse:
            return point
        point += 1
    return first_at(layout.pulses, point, stop, pulse)

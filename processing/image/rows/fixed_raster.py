"""FixedRaster: rows of different widths as an ordinary image for networks (Takahashi 2022, 3.6)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.image.rows.pixel_rows import PixelRows


@dataclass(frozen=True)
class FixedRaster:
    """A stretch of rows cut or padded to the most frequent row width.

    Attributes
    ----------
    points : (rows, width) int64
        Point shown, −1 where empty.
    first_point : int
        The rows' first point in the recording.
    row_of_point, column_of_point : (n,) int64
        For every point of the rows, the pixel of the raster that speaks for it: its own; for
        points beyond the width the nearest filled one of the row, column −1 where there is none.
    overflow : (k,) int64
        Points of the recording beyond the width.
    """

    points: NDArray[np.int64]
    first_point: int
    row_of_point: NDArray[np.int64]
    column_of_point: NDArray[np.int64]
    overflow: NDArray[np.int64]

    def values_of_points(self, values: NDArray[Any], missing: Any) -> NDArray[Any]:
        """Results given per pixel, handed on to every point.

        Parameters
        ----------
        values : (rows, width) or (rows, width, k) array
            Any dtype: a network's classes or scores.
        missing : scalar
            For points of rows without any pixel inside the width.

        Returns
        -------
        (n,) or (n, k) array
        """
        spread = values[self.row_of_point, np.maximum(self.column_of_point, 0)]
        spread[self.column_of_point < 0] = missing
        return spread


def fixed_raster_of(image: PixelRows, rows: range) -> FixedRaster:
    """The raster of `mode_width` columns of a chunk of rows."""
    width = min(image.mode_width, image.width)
    points = image.raster(rows, range(width))
    start, stop = int(image.row_starts[rows.start]), int(image.row_starts[rows.stop])
    columns = image.columns_of(start, stop).astype(np.int64)
    counts = np.diff(image.row_starts[rows.start : rows.stop + 1])
    row_of_point = np.repeat(np.arange(len(rows)), counts)
    is_filled = points >= 0
    last_filled = np.where(is_filled.any(axis=1), width - 1 - is_filled[:, ::-1].argmax(axis=1), -1)
    beyond = columns >= width
    columns[beyond] = last_filled[row_of_point[beyond]]
    return FixedRaster(points, start, row_of_point, columns, start + np.flatnonzero(beyond))

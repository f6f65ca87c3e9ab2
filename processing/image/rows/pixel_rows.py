"""PixelRows: what tiles and rasters ask of a point-cloud image; they need not know more of it."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.recording.columns.counted_classes import ClassColumns
from processing.recording.kinds import ImageKind


class PixelRows(Protocol):
    """Rows of pixels over the points of a recording.

    Attributes
    ----------
    kind : ImageKind
    rows, width : int
        Size of the image.
    drive_count : int
        Number of points.
    row_starts : (rows + 1,) int64
        Row r holds the points ``row_starts[r] … row_starts[r + 1] − 1`` of the recording.
    """

    kind: ImageKind
    rows: int
    width: int
    drive_count: int
    row_starts: Integers

    @property
    def mode_width(self) -> int:
        """The most frequent row width."""

    def columns_of(self, start: int, stop: int) -> NDArray[np.int32]:
        """Columns of the points ``start … stop − 1``."""

    def points_in(self, rows: range, columns: range) -> Integers:
        """(n,) int64: all points of the pixels of a window, rising."""

    def raster(
        self,
        rows: range,
        columns: range,
        step: int = 1,
        *,
        without_noise: ClassColumns | None = None,
    ) -> Integers:
        """The points shown in a window, −1 for empty pixels."""

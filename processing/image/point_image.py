"""PointCloudImage: the recording as a picture in which every pixel is a measured point.

Nothing the size of the recording is held: rows say where points begin, the pulse column says in
which pixel a point is, and rasters are made for the stretch that is asked for.
"""

from __future__ import annotations

from functools import cached_property
from typing import Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.image.rows.fixed_raster import FixedRaster, fixed_raster_of
from processing.image.rows.grid import PixelGrid
from processing.image.rows.image_rows import forget_rows, image_rows
from processing.image.rows.point_image_kernels import (
    PixelLayout,
    columns_kernel,
    first_at_column,
    noiseless_raster_kernel,
    raster_kernel,
    shown_point,
    stretches_kernel,
)
from processing.image.rows.rows_of_kind import RevolutionSource
from processing.image.tiles.tiles import TilePyramid
from processing.recording.columns.coordinates import Coordinates
from processing.recording.columns.counted_classes import ClassColumns
from processing.recording.columns.damaged_pulses import damaged_pulses
from processing.recording.columns.quantisation import Quantisation
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind

_MOST_ROWS_ASIDE = 8
"""Rows of a top view above and below in which the nearest filled cell is looked for."""

_Number = TypeVar("_Number", bound=np.generic)


class PointCloudImage:
    """One kind of image over one recording; pixel to points and point to pixel, both exact.

    Parameters
    ----------
    kind : ImageKind
    pulses : (n,) int64
        The column ``pulse``: not decreasing; for a top view or a scan the cell of every point.
    folding : Revolutions or int
        The recording's revolutions; for a top view or a scan the number of cells per row.
    coordinates : Coordinates, optional
        Where the points are; without them there is no pyramid.

    Attributes
    ----------
    rows, width : int
        Size of the image. Rows of the trajectory-based reversible kind differ in width; the
        image is as wide as its widest row.
    mode_width : int
        The most frequent width of a row.
    drive_count : int
        Number of points; every one is in exactly one pixel.
    row_starts : (rows + 1,) int64
        Row r holds the points ``row_starts[r] … row_starts[r + 1] − 1`` of the recording.
    segments : (rows,) int32
        Stretches between stops. No row is empty but inside a gap of at most 1.0 s.
    row_times : (rows,) float64
        Time of the left edge, s; NaN for a top view and a scan.
    row_widths : (rows,) int64
        Columns of each row.
    layout : PixelLayout
        The arrays from which kernels compute the pixel of a point.
    """

    def __init__(
        self,
        kind: ImageKind,
        pulses: Integers,
        folding: RevolutionSource | int,
        *,
        coordinates: Coordinates | None = None,
    ) -> None:
        self.kind = kind
        self._pulses = _read_only(pulses)
        self._folder = None if coordinates is None else coordinates.folder
        found = image_rows(kind, self._pulses, folding, self._folder)
        if isinstance(folding, int):
            self.row_times = np.full(found.origins.size, np.nan)
        else:
            self.row_times = _times_of(found.origins / 2, folding)
        self.layout = PixelLayout(
            pulses=self._pulses,
            row_starts=_read_only(found.row_starts),
            origins=_read_only(found.origins),
            spans=_read_only(found.spans),
            per_span=found.per_span,
        )
        self.row_starts = self.layout.row_starts
        self.segments = found.segments
        self.row_widths = found.widths
        self.rows = int(found.origins.size)
        self.width = int(found.widths.max(initial=0))
        self.drive_count = int(self._pulses.size)
        self._coordinates = coordinates

    @classmethod
    def of_drive(cls, drive: Drive, kind: ImageKind) -> Self:
        """The image of a drive that has what the kind needs."""
        revolutions = drive.revolutions
        folding = drive.info.cells_per_row if revolutions is None else revolutions
        return cls(kind, drive.columns["pulse"], folding, coordinates=drive.coordinates)

    @property
    def mode_width(self) -> int:
        """The most frequent row width; the width of a raster for networks (Takahashi 2022, 3.6)."""
        return int(np.bincount(self.row_widths).argmax()) if self.rows else 0

    @property
    def split_rows(self) -> Integers:
        """(k,) int64: the first row after each stop."""
        return np.flatnonzero(np.diff(self.segments)) + 1

    @cached_property
    def pyramid(self) -> TilePyramid:
        """The tiles of the image.

        Raises
        ------
        ValueError
            The image was made without coordinates.
        """
        if self._coordinates is None:
            message = "an image without coordinates has no pyramid"
            raise ValueError(message)
        return TilePyramid(self, self._coordinates)

    def columns_of(self, start: int, stop: int) -> NDArray[np.int32]:
        """Columns of the points ``start … stop − 1``: inside the image, not falling in a row.

        Raises
        ------
        BadFile
            The pulses are damaged; so say all methods that look at them.
        """
        columns = np.empty(max(0, stop - start), np.int32)
        if columns.size:
            row = int(np.searchsorted(self.row_starts, start, side="right")) - 1
            first = np.array([start, row, self.width])
            self._refuse_damage(columns_kernel(self.layout, first, columns))
        return columns

    def points_at(self, row: int, column: int) -> Integers:
        """All points of a pixel, the shown one first; empty where there are none.

        Returns
        -------
        (k,) int64
        """
        if not (0 <= row < self.rows and 0 <= column < self.width):
            return np.empty(0, np.int64)
        start, end = (first_at_column(self.layout, row, edge) for edge in (column, column + 1))
        if start == end:
            return np.empty(0, np.int64)
        points = np.arange(start, end)
        shown = shown_point(self.layout, row, start, end)
        return np.concatenate([points[points == shown], points[points != shown]])

    def pixel_of(self, points: Integers) -> tuple[Integers, NDArray[np.int32]]:
        """Row and column of points.

        Parameters
        ----------
        points : (k,) int64
            In any order, each a point of the recording.

        Returns
        -------
        rows : (k,) int64
        columns : (k,) int32
        """
        points = np.asarray(points, dtype=np.int64)
        if points.size and not (points.min() >= 0 and points.max() < self.drive_count):
            message = "a point that the recording doesn't have"
            raise IndexError(message)
        rows = np.searchsorted(self.row_starts, points, side="right").astype(np.int64) - 1
        layout = self.layout
        doubled = 2 * layout.pulses[points] - layout.origins[rows]
        columns = doubled * layout.per_span // layout.spans[rows]
        self._refuse_damage(bool(((columns >= 0) & (columns < self.width)).all()))
        return rows, columns.astype(np.int32)

    def nearest_filled(
        self,
        row: int,
        column: int,
        within_px: int = 3,
        *,
        without_noise: ClassColumns | None = None,
    ) -> int:
        """The point shown at a pixel, or nearest to it in the row; −1 where all is empty.

        Cells of a top view are as near in the rows above and below, of which a few are looked at.
        See :meth:`raster` for ``without_noise``.
        """
        if not 0 <= row < self.rows:
            return -1
        aside = min(within_px, _MOST_ROWS_ASIDE) if self.kind is ImageKind.TOP_VIEW else 0
        rows = range(max(0, row - aside), min(self.rows, row + aside + 1))
        columns = range(max(0, column - within_px), min(self.width, column + within_px + 1))
        if not len(columns):
            return -1
        shown = self.raster(rows, columns, without_noise=without_noise)
        filled_rows, filled = np.nonzero(shown >= 0)
        if not filled.size:
            return -1
        away = (filled_rows + rows.start - row) ** 2 + (filled + columns.start - column) ** 2
        nearest = away.argmin()
        return int(shown[filled_rows[nearest], filled[nearest]])

    def raster(
        self,
        rows: range,
        columns: range,
        step: int = 1,
        *,
        without_noise: ClassColumns | None = None,
    ) -> Integers:
        """The points shown in a window.

        Parameters
        ----------
        rows, columns : range
            Consecutive, inside the image.
        step : int
            Every so many rows; and of so many columns the first filled one.
        without_noise : ClassColumns, optional
            The classes by which points of noise are left out: their pixels show the next point
            that is none, or are empty.

        Returns
        -------
        (ceil(len(rows) / step), ceil(len(columns) / step)) int64
            −1 for empty pixels.
        """
        height, width = -(-len(rows) // step), -(-len(columns) // step)
        raster = np.empty((height, width), np.int64)
        if raster.size:
            self._check_window(rows, columns)
            window = np.array([rows.start, step, columns.start, columns.stop, self.width])
            if without_noise is None:
                is_whole = raster_kernel(self.layout, window, raster)
            else:
                is_whole = noiseless_raster_kernel(self.layout, without_noise, window, raster)
            self._refuse_damage(is_whole)
        return raster

    def stretches_in(self, windows: Integers) -> Integers:
        """The points of windows, row by row.

        Parameters
        ----------
        windows : (k, 4) int64
            First and end row, first and end column, inside the image.

        Returns
        -------
        (rows of all windows, 2) int64
            First point and the one behind the last.
        """
        stretches = np.empty((int((windows[:, 1] - windows[:, 0]).sum()), 2), np.int64)
        self._refuse_damage(stretches_kernel(self.layout, windows, stretches))
        return stretches

    def points_in(self, rows: range, columns: range) -> Integers:
        """(n,) int64: all points of the pixels of a window, rising; shown or not."""
        self._check_window(rows, columns)
        stretches = self.stretches_in(
            np.array([[rows.start, rows.stop, columns.start, columns.stop]])
        )
        counts = stretches[:, 1] - stretches[:, 0]
        before = np.cumsum(counts) - counts
        points: Integers = np.arange(int(counts.sum())) + np.repeat(
            stretches[:, 0] - before, counts
        )
        return points

    def grid(self, rows: range) -> tuple[PixelGrid, slice]:
        """The pixels of a chunk of rows for tools, and the points they hold.

        In the fixed-width kinds the shown point of a pixel need not be its first.
        """
        start, stop = int(self.row_starts[rows.start]), int(self.row_starts[rows.stop])
        grid = PixelGrid(
            row_starts=self.row_starts[rows.start : rows.stop + 1] - start,
            columns=self.columns_of(start, stop),
            segments=self.segments[rows.start : rows.stop],
            width=self.width,
            is_regular=self.kind is not ImageKind.TOP_VIEW,
        )
        return grid, slice(start, stop)

    def fixed_raster(self, rows: range) -> FixedRaster:
        """The raster of `mode_width` columns for networks, and the points that it leaves out."""
        return fixed_raster_of(self, rows)

    def _refuse_damage(self, is_sound: bool) -> None:  # noqa: FBT001 - what a kernel says
        """Refuse pulses that don't fit the rows; kept rows may be to blame, so they go."""
        if not is_sound:
            forget_rows(self.kind, self._folder)
            raise damaged_pulses(self._folder)

    def _check_window(self, rows: range, columns: range) -> None:
        inside = rows.start >= 0 and rows.stop <= self.rows
        if not (inside and columns.start >= 0 and columns.stop <= self.width):
            message = f"rows {rows}, columns {columns} of {self.rows} × {self.width}"
            raise IndexError(message)


def warm_up() -> None:
    """Compile the kernels."""
    quantisation = Quantisation((1.0, 1.0, 1.0), (0.0, 0.0, 0.0))
    coordinates = Coordinates({"xyz": np.zeros((4, 3), np.int32)}, quantisation)
    image = PointCloudImage(ImageKind.TOP_VIEW, np.array([0, 1, 1, 5]), 4, coordinates=coordinates)
    image.raster(range(2), range(4))
    codes = _read_only(np.zeros(4, np.uint8))
    image.raster(range(2), range(4), without_noise=ClassColumns(codes, codes))
    image.points_at(0, 1)
    image.columns_of(0, 4)
    image.points_in(range(2), range(4))
    image.pyramid.prepare()


def _read_only(values: NDArray[_Number]) -> NDArray[_Number]:
    # Kernels are compiled for read-only arrays, which is what mapped columns are.
    view = np.asarray(values).view(np.ndarray)
    view.flags.writeable = False
    return view


def _times_of(pulses: NDArray[np.float64], revolutions: RevolutionSource) -> NDArray[np.float64]:
    """Times of pulses by the fold before each."""
    folds = np.searchsorted(revolutions.fold_pulses, pulses, side="right") - 1
    folds = np.clip(folds, 0, revolutions.fold_pulses.size - 1)
    since = pulses - revolutions.fold_pulses[folds]
    times: NDArray[np.float64] = (
        revolutions.reference_times[folds] + since / revolutions.pulse_rate_hz
    )
    return times

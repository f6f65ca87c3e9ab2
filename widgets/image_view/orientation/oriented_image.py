"""Picture: a point-cloud image as it is laid before the eye, not mirrored, the street across.

Picture coordinates count pixels of the image, u to the right and v downwards, whichever way the
image's own rows and columns run.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.image.images_of_drives import image_of
from processing.image.point_image import PointCloudImage
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.image_view.orientation.drive_orientation import DriveOrientation, orientation_of
from widgets.shared.image_orientation import ImageOrientation
from widgets.shared.map_source import MapSource
from widgets.shared.view_settings import ViewSettings


@dataclass(frozen=True)
class Span:
    """A rectangle in picture coordinates."""

    left: float
    top: float
    right: float
    bottom: float


@dataclass(frozen=True, eq=False)
class OrientedImage:
    """One drive's image of one kind, with its orientation; equal to nothing but itself.

    Attributes
    ----------
    rows_go_right : bool
        Rows from left to right, sweeps of a scan too; a top view has them from top to bottom,
        north up.
    is_flipped : bool
        Columns run against v: the left side of the drive is up, as is the sky in a scan.
    """

    drive: Drive
    image: PointCloudImage
    orientation: DriveOrientation
    rows_go_right: bool
    is_flipped: bool

    @staticmethod
    def of(drive: Drive, kind: ImageKind) -> OrientedImage:
        """Lay out an image.

        Raises
        ------
        Unsuitable
            The drive has no image of this kind.
        """
        image = image_of(drive, kind)
        orientation = orientation_of(drive, image)
        is_top = kind is ImageKind.TOP_VIEW
        return OrientedImage(
            drive, image, orientation, not is_top, not is_top and orientation.left_columns_are_high
        )

    @staticmethod
    def chosen(source: MapSource, settings: ViewSettings) -> OrientedImage | None:
        """The picture that is to be shown; None when its drive isn't there.

        Raises
        ------
        Unsuitable
            The drive has no image of that kind.
        """
        drives = {drive.id: drive for drive in source.drives()}
        drive = drives.get(settings.drive_id)
        return None if drive is None else OrientedImage.of(drive, settings.image_kind)

    @property
    def follows_path(self) -> bool:
        """Whether it shows a drive from end to end: no view from above, no standing scanner."""
        return self.rows_go_right and self.image.kind.follows_path

    def turned(self, wanted: ImageOrientation) -> ImageOrientation:
        """How it is turned where this is wanted.

        A top view has north up in any case; a scan is seen from where the scanner stood.
        """
        if self.follows_path:
            return wanted
        return ImageOrientation(is_reversed_along=self.orientation.rows_go_left)

    @property
    def size(self) -> tuple[int, int]:
        """Extent in u and in v."""
        image = self.image
        return (image.rows, image.width) if self.rows_go_right else (image.width, image.rows)

    @property
    def stretch(self) -> float:
        """How much longer a step in u is on the ground than one in v."""
        return self.orientation.stretch

    def positions(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Floats:
        """(n, 2) picture coordinates of the centres of pixels."""
        along = rows + 0.5
        across = (self.image.width - columns - 0.5) if self.is_flipped else columns + 0.5
        return np.column_stack([along, across] if self.rows_go_right else [across, along])

    def pixel_at(self, u: float, v: float) -> tuple[int, int]:
        """Row and column at a place; outside the image they are outside its range."""
        along, across = (u, v) if self.rows_go_right else (v, u)
        across = self.image.width - across if self.is_flipped else across
        column = np.ceil(across) - 1 if self.is_flipped else np.floor(across)
        return int(np.floor(along)), int(column)

    def plan_position(self, u: float, v: float) -> tuple[float, float]:
        """Easting and northing of about the middle of the row at a place, m."""
        row = min(max(self.pixel_at(u, v)[0], 0), max(self.image.rows - 1, 0))
        starts = self.image.row_starts
        middle = (int(starts[row]) + int(starts[min(row + 1, self.image.rows)])) // 2
        point = min(middle, max(self.drive.count - 1, 0))
        easting, northing, _ = self.drive.xyz(np.array([point]))[0].tolist()
        return easting, northing

    def rows_columns(self, span: Span) -> tuple[range, range]:
        """The rows and columns that a rectangle touches, inside the image."""
        first = self.pixel_at(span.left, span.top)
        last = self.pixel_at(span.right, span.bottom)
        ends = [sorted(pair) for pair in zip(first, last, strict=True)]
        limits = (self.image.rows, self.image.width)
        rows, columns = (
            range(max(low, 0), max(min(high + 1, limit), 0))
            for (low, high), limit in zip(ends, limits, strict=True)
        )
        return rows, columns

    def span_of(self, row: int, column: int, rows: int, columns: int) -> Span:
        """The rectangle of so many rows and columns from a first row and column."""
        across = self.image.width - column - columns if self.is_flipped else column
        if self.rows_go_right:
            return Span(row, across, row + rows, across + columns)
        return Span(across, row, across + columns, row + rows)

    def laid(self, pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Turn (rows, columns, …) values into (v, u, …): a view."""
        turned = pixels.swapaxes(0, 1) if self.rows_go_right else pixels
        return turned[::-1] if self.is_flipped else turned

"""PlanRaster: measured points from above, the highest one below a ceiling in each pixel.

A street seen from above is hidden by its trees and wires. With a ceiling a few metres above the
road what stands below them shows, and every pixel still knows the point it is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel

CEILING_PX = 16
"""Side of the squares of pixels that have one ceiling: heights of ground change little over it on
the screen, and asking for each pixel would take 256 times as long."""

NO_POINT = -1
"""Of a pixel without a point."""

_HALF_PX, _HALF_DIAGONAL_PX = 0.5, 0.75
"""Of a pixel: half its side, and half its diagonal (0.71) rounded up."""

_OPAQUE = 255
"""Alpha of a filled pixel, 8 bits."""


@dataclass(frozen=True)
class PlanFrame:
    """The part of the plan that a raster shows, north up.

    Attributes
    ----------
    west, north : float
        Easting of the left edge, northing of the upper edge; m, project CRS.
    px_per_m : float
    width, height : int
        px.
    """

    west: float
    north: float
    px_per_m: float
    width: int
    height: int

    @property
    def east(self) -> float:
        """Easting of the right edge, m."""
        return self.west + self.width / self.px_per_m

    @property
    def south(self) -> float:
        """Northing of the lower edge, m."""
        return self.north - self.height / self.px_per_m

    def holds(self, other: PlanFrame) -> bool:
        """Whether another frame lies wholly in this one."""
        return (
            self.west <= other.west
            and self.east >= other.east
            and self.south <= other.south
            and self.north >= other.north
        )


@dataclass(frozen=True, eq=False)
class PlanSnapshot:
    """What a raster shows at a time; nothing in it changes any more.

    Attributes
    ----------
    pixels : (height, width, 4) uint8
        Blue, green, red and 255; all 0 where there is no point.
    points : (height, width) int64
        The point's index in its drive; −1 where there is none.
    drives : (height, width) uint8
        Number of the drive among those that were added.
    """

    frame: PlanFrame
    pixels: NDArray[np.uint8]
    points: NDArray[np.int64]
    drives: NDArray[np.uint8]

    def point_at(self, easting: float, northing: float, reach_m: float) -> tuple[int, int] | None:
        """Drive's number and point shown nearest to a place; None where none is in reach."""
        frame = self.frame
        x = (easting - frame.west) * frame.px_per_m
        y = (frame.north - northing) * frame.px_per_m
        reach = max(reach_m * frame.px_per_m, _HALF_PX)
        columns = _within(x, reach, frame.width)
        rows = _within(y, reach, frame.height)
        window = self.points[rows, columns]
        if not window.size:
            return None
        down = np.arange(rows.start, rows.stop) + 0.5 - y
        right = np.arange(columns.start, columns.stop) + 0.5 - x
        away = np.where(window == NO_POINT, np.inf, np.hypot(down[:, None], right[None, :]))
        best = int(away.argmin())
        # A pixel is there as soon as the place lies in it.
        if away.flat[best] > reach + _HALF_DIAGONAL_PX:
            return None
        return int(self.drives[rows, columns].flat[best]), int(window.flat[best])


class PlanRaster:
    """Takes points in any order and keeps the highest one of each pixel below its ceiling.

    Parameters
    ----------
    frame : PlanFrame
    origin : (3,) float64
        What the points' places are about; m, project CRS.
    ceilings : (rows, columns) float64 or None
        Highest height shown in each square of :data:`CEILING_PX` pixels, m; None: no limit.
    """

    def __init__(
        self, frame: PlanFrame, origin: Floats, ceilings: NDArray[np.float64] | None = None
    ) -> None:
        self.frame = frame
        shape = frame.height, frame.width
        squares = ceiling_shape(frame)
        if ceilings is None:
            ceilings = np.full(squares, np.inf)
        if ceilings.shape != squares:
            message = f"{squares} ceilings are needed, not {ceilings.shape}"
            raise ValueError(message)
        self._ceilings = (ceilings - origin[2]).astype(np.float32)
        self._corner = np.array([frame.west - origin[0], frame.north - origin[1], frame.px_per_m])
        self._heights = np.full(shape, -np.inf, dtype=np.float32)
        self._points = np.full(shape, NO_POINT, dtype=np.int64)
        self._drives = np.zeros(shape, dtype=np.uint8)
        self._pixels = np.zeros((*shape, 4), dtype=np.uint8)

    def add(
        self,
        drive: int,
        points: NDArray[np.int64],
        local_xyz: NDArray[np.float32],
        colours: NDArray[np.uint8],
        *,
        size_px: int = 1,
    ) -> None:
        """Put points where they are the highest.

        Parameters
        ----------
        drive : int
            Number of the drive they belong to, below 256.
        points : (n,) int64
        local_xyz : (n, 3) float32
            m from the origin.
        colours : (n, 3) uint8
            Red, green, blue.
        size_px : int
            Side of the square that a point covers.
        """
        raster_kernel(
            points,
            local_xyz,
            colours,
            drive,
            size_px,
            self._corner,
            self._ceilings,
            self._heights,
            self._points,
            self._drives,
            self._pixels,
        )

    def picture(self) -> PlanSnapshot:
        """What it shows now, as a copy."""
        return PlanSnapshot(
            self.frame, self._pixels.copy(), self._points.copy(), self._drives.copy()
        )


def ceiling_shape(frame: PlanFrame) -> tuple[int, int]:
    """Rows and columns of the squares that have one ceiling."""
    return -(-frame.height // CEILING_PX), -(-frame.width // CEILING_PX)


def square_middles(frame: PlanFrame) -> Floats:
    """(rows, columns, 2) float64: easting and northing of the squares' middles, m."""
    rows, columns = ceiling_shape(frame)
    side_m = CEILING_PX / frame.px_per_m
    east = frame.west + (np.arange(columns) + 0.5) * side_m
    north = frame.north - (np.arange(rows) + 0.5) * side_m
    return np.stack(np.broadcast_arrays(east[None, :], north[:, None]), axis=-1)


def warm_up() -> None:
    """Compile the kernel."""
    raster = PlanRaster(PlanFrame(0.0, 1.0, 1.0, 1, 1), np.zeros(3))
    position = np.full((1, 3), 0.5, dtype=np.float32)
    raster.add(0, np.zeros(1, np.int64), position, np.zeros((1, 3), np.uint8))


def _within(middle: float, reach: float, size: int) -> slice:
    low, high = int(np.floor(middle - reach)), int(np.floor(middle + reach)) + 1
    return slice(min(max(low, 0), size), min(max(high, 0), size))


@kernel
def raster_kernel(
    points: NDArray[np.int64],
    local_xyz: NDArray[np.float32],
    colours: NDArray[np.uint8],
    drive: int,
    size_px: int,
    corner: NDArray[np.float64],
    ceilings: NDArray[np.float32],
    heights: NDArray[np.float32],
    shown: NDArray[np.int64],
    drives: NDArray[np.uint8],
    pixels: NDArray[np.uint8],
) -> None:
    """Put each point where it is higher than what is there and not above the ceiling.

    Parameters
    ----------
    corner : (3,) float64
        Easting and northing of the upper left corner from the origin (m), pixels per metre.
    heights, shown, drives, pixels : (h, w), the last one with 4 values
        What is kept of each pixel.
    """
    rows, columns = shown.shape
    before = (size_px - 1) / 2
    for index in range(points.size):
        x = (local_xyz[index, 0] - corner[0]) * corner[2]
        y = (corner[1] - local_xyz[index, 1]) * corner[2]
        left, top = int(np.floor(x - before)), int(np.floor(y - before))
        if left >= columns or top >= rows or left + size_px <= 0 or top + size_px <= 0:
            continue
        middle_row = min(max(int(np.floor(y)), 0), rows - 1) // CEILING_PX
        middle_column = min(max(int(np.floor(x)), 0), columns - 1) // CEILING_PX
        height = local_xyz[index, 2]
        if height > ceilings[middle_row, middle_column]:
            continue
        for row in range(max(top, 0), min(top + size_px, rows)):
            for column in range(max(left, 0), min(left + size_px, columns)):
                if height > heights[row, column]:
                    heights[row, column] = height
                    shown[row, column] = points[index]
                    drives[row, column] = drive
                    pixels[row, column, 0] = colours[index, 2]
                    pixels[row, column, 1] = colours[index, 1]
                    pixels[row, column, 2] = colours[index, 0]
                    pixels[row, column, 3] = _OPAQUE

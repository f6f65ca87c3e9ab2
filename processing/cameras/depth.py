"""DepthPicture: how far away what an image shows is, from the measured points around it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.cameras.depth_kernels import Discs, HidingTolerance, front_kernel, hidden_kernel
from processing.cameras.surroundings import ImageSurroundings, SizedPoints
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.choice import pixels_per_radian
from processing.recording.camera_images.image_list import CameraImage

if TYPE_CHECKING:  # a drive knows its cameras, so importing it here would be a circle
    from processing.recording.drive import Drive

REACH_M = 60.0
"""Points farther from an image are left out: neither they nor their pixels are dense enough there.
By trial; no measurement is recorded."""

TOLERANCE_M = 0.2
"""What lies this much behind a surface is hidden by it: what scatters on leaves and grass, and the
error of the orientation. By trial; no measurement is recorded."""

TOLERANCE_SHARE = 0.01
"""Share of the range that comes to it: cells and gaps grow with the range."""

_CELLS_ACROSS = 200
"""Cells of the grid across an image: a cell is some 4 pixels of 800, about as far as points are
apart. By trial; no measurement is recorded."""

_LEAST_CELL_PX = 2.0
"""Cells are no smaller, whatever the image: nobody marks better."""

_DISC = 0.7
"""Radius of the disc that a point stands for, in distances to its neighbours: half a diagonal
(0.71), so that discs of a raster leave no hole."""

_LEAST_SLOPE = 0.02
"""Cosine between line of sight and normal below which a disc is seen on edge, 89°: its plane is met
anywhere."""

_FARTHER, _FARTHER_M = 1.1, 1.0
"""A picture reaches so much farther than what is asked of it: the far end of tilted surfaces."""

_CLICK_M = 0.15
"""What lies so little behind the front-most is the same surface for a click: as hits in 3D
(`ray_hits`), somewhat more. By trial; no measurement is recorded."""


@dataclass(frozen=True)
class SeenPoint:
    """A measured point that an image shows.

    Attributes
    ----------
    drive : str
        Id of its drive.
    point : int
        Its index there.
    xyz : tuple of float
        m, project CRS.
    off_px : float
        How far from the asked place it is shown.
    range_m : float
        From the perspective centre.
    """

    drive: str
    point: int
    xyz: tuple[float, float, float]
    off_px: float
    range_m: float


class DepthPicture:
    """The surfaces that one image shows, as a coarse grid of distances.

    Parameters
    ----------
    image : CameraImage
    drives : sequence of Drive
    reach_m : float
        Points farther away are left out.
    check : callable, optional
        Called between tiles while the picture is made; raises to stop.

    Attributes
    ----------
    cell_px : float
        Side of a cell, pixels of the image.
    front_m : (h, w) float32
        Distance of the nearest surface in each cell; infinite where nothing was measured.

    Notes
    -----
    Steps: the tiles of all drives that the camera may look at are read, each at the level at
    which its points are about as dense as the cells; every point is a disc that faces as its
    neighbours lie, so large that surfaces are closed; the nearest one wins. Single points
    without neighbours, noise and what is classified as moving hide nothing.
    """

    def __init__(
        self,
        image: CameraImage,
        drives: Sequence[Drive],
        *,
        reach_m: float = REACH_M,
        check: Callable[[], None] | None = None,
    ) -> None:
        self.camera = Camera(image)
        self.cell_px = max(_LEAST_CELL_PX, image.width_px / _CELLS_ACROSS)
        shape = (
            int(np.ceil(image.height_px / self.cell_px)),
            int(np.ceil(image.width_px / self.cell_px)),
        )
        self.front_m = np.full(shape, np.inf, np.float32)
        self._number = np.full(shape, -1, np.int32)
        rows, columns = np.indices(shape)
        middles = (np.column_stack([columns.ravel(), rows.ravel()]) + 0.5) * self.cell_px
        self._rays = self.camera.rays_of(middles).reshape(*shape, 3)
        self._surroundings = ImageSurroundings(self.camera, drives, reach_m)
        self._per_radian = pixels_per_radian(image)
        self._points: list[NDArray[np.int64]] = []
        self._drives: list[int] = []
        self._starts = [0]
        for drive, points in self._surroundings.seen(self.cell_px, check):
            self._add(drive, points)

    @property
    def is_empty(self) -> bool:
        """Whether nothing was measured in the image."""
        return not np.isfinite(self.front_m).any()

    def hides(self, xyz: ArrayLike) -> NDArray[np.bool_]:
        """Which places lie behind a surface, as this image sees them.

        Parameters
        ----------
        xyz : (n, 3) float64
            m, project CRS.

        Returns
        -------
        (n,) bool
            False for places outside the image.
        """
        positions = np.asarray(xyz, dtype=np.float64).reshape(-1, 3)
        return self.hides_at(self.camera.pixels_of(positions), self.camera.distances_to(positions))

    def hides_at(
        self,
        pixels: NDArray[np.float64],
        ranges: NDArray[np.float64],
        tolerance_m: float = TOLERANCE_M,
    ) -> NDArray[np.bool_]:
        """The same for places given by (n, 2) pixels and (n,) distances, m."""
        hidden = np.zeros(ranges.size, np.bool_)
        tolerance = HidingTolerance(tolerance_m, TOLERANCE_SHARE)
        hidden_kernel(self._cells(pixels), ranges, self.front_m, tolerance, hidden)
        return hidden

    def quick_point_at(self, pixel: tuple[float, float]) -> SeenPoint | None:
        """The front point of a pixel's cell: near enough for a mouse that moves."""
        column, row = self._cells(np.array([pixel]))[0]
        number = int(self._number[row, column]) if column >= 0 else -1
        if number < 0:
            return None
        part = int(np.searchsorted(self._starts, number, side="right")) - 1
        drive = self._drives[part]
        return self._seen_point(drive, int(self._points[part][number - self._starts[part]]), pixel)

    def point_at(self, pixel: tuple[float, float], within_px: float = 8.0) -> SeenPoint | None:
        """The measured point that a pixel shows.

        Parameters
        ----------
        pixel : (float, float)
            Column and row.
        within_px : float
            Farther from the pixel no point is taken, but where they are sparser than that.

        Returns
        -------
        SeenPoint or None
            Of the surface that the line of sight meets first the point nearest to it; where it
            meets none, the point shown nearest to the pixel, with nothing in front of it.

        Notes
        -----
        All measured points near the line are looked at, not only those of the grid. A point is
        met when the line passes through its disc.
        """
        ray = self.camera.rays_of(np.array([pixel]))[0]
        best: tuple[float, int, int] | None = None
        parts = [
            (drive, near)
            for drive, points in self._surroundings.along(
                ray, self._farthest(pixel), within_px / self._per_radian
            )
            if (near := _near_ray(points, ray, within_px / self._per_radian)) is not None
        ]
        first = min((part.first_met for _, part in parts), default=np.inf)
        if not np.isfinite(first):
            # Between surfaces: the nearest one aside, if it isn't behind another there.
            first = self._nearest_aside([part for _, part in parts])
        for drive, part in parts:
            found = part.nearest_at(first)
            if found is not None and (best is None or found[0] < best[0]):
                best = (found[0], drive, found[1])
        return None if best is None else self._seen_point(best[1], best[2], pixel)

    def _add(self, drive: int, points: SizedPoints) -> None:
        kept = points.has_company
        away, sizes = points.away[kept], points.sizes[kept].astype(np.float64)
        if not sizes.size:
            return
        pixels = self.camera.pixels_of(away + np.array(self.camera.image.xyz))
        is_far = (away * away).sum(axis=1) > self._surroundings.reach_m**2
        pixels[is_far] = np.nan
        number = np.full(self.front_m.shape, -1, np.int32)
        front_kernel(
            pixels / self.cell_px,
            Discs(away, points.normals[kept].astype(np.float64), sizes * _DISC),
            self._per_radian / self.cell_px,
            self._rays,
            self.front_m,
            number,
        )
        taken = number >= 0
        self._number[taken] = number[taken] + self._starts[-1]
        self._points.append(points.points[kept])
        self._drives.append(drive)
        self._starts.append(self._starts[-1] + sizes.size)

    def _cells(self, pixels: NDArray[np.float64]) -> NDArray[np.int64]:
        """(n, 2) column and row of cells; −1 outside the image."""
        inside = self.camera.shows(pixels)
        cells = np.floor(np.where(inside[:, None], pixels, 0.0) / self.cell_px).astype(np.int64)
        cells[~inside] = -1
        return cells

    def _farthest(self, pixel: tuple[float, float]) -> float:
        """How far a click at a pixel may reach: a little beyond the surfaces around it."""
        column, row = self._cells(np.array([pixel]))[0]
        if column < 0:
            return self._surroundings.reach_m
        around = self.front_m[max(0, row - 1) : row + 2, max(0, column - 1) : column + 2]
        farthest = float(around.max())
        return min(self._surroundings.reach_m, farthest * _FARTHER + _FARTHER_M)

    def _nearest_aside(self, parts: list[_NearRay]) -> float:
        nearest = min(
            (part for part in parts if part.aside.size),
            key=lambda part: float(part.angles.min()),
            default=None,
        )
        if nearest is None:
            return float("inf")
        return float(nearest.ranges[int(nearest.angles.argmin())])

    def _seen_point(self, drive: int, point: int, pixel: tuple[float, float]) -> SeenPoint:
        own = self._surroundings.drives[drive]
        xyz = own.xyz(np.array([point]))
        off = float(np.linalg.norm(self.camera.pixels_of(xyz)[0] - pixel))
        easting, northing, height = xyz[0].tolist()
        distance = float(self.camera.distances_to(xyz)[0])
        return SeenPoint(own.id, point, (easting, northing, height), off, distance)


@dataclass(frozen=True)
class _NearRay:
    """Points near a line of sight, (k,) each.

    Ranges along the line and distances aside, m; where the line meets the point's disc,
    infinite where it doesn't.
    """

    points: NDArray[np.int64]
    ranges: NDArray[np.float64]
    aside: NDArray[np.float64]
    sizes: NDArray[np.float32]
    met: NDArray[np.float64]

    @property
    def angles(self) -> NDArray[np.float64]:
        return np.asarray(self.aside / self.ranges)

    @property
    def first_met(self) -> float:
        """Where the line meets a surface first; infinite where it meets none."""
        return float(np.min(self.met, initial=np.inf))

    def nearest_at(self, first: float) -> tuple[float, int] | None:
        """The point nearest to the line among those about so far away: angle and index."""
        slack = np.maximum(_CLICK_M, 2.0 * self.sizes)
        there = np.flatnonzero(np.abs(self.ranges - first) <= slack)
        if not there.size:
            return None
        angles = self.angles[there]
        best = int(angles.argmin())
        return float(angles[best]), int(self.points[there[best]])


def _near_ray(points: SizedPoints, ray: NDArray[np.float64], aside_rad: float) -> _NearRay | None:
    ranges = points.away @ ray
    square = (points.away * points.away).sum(axis=1) - ranges * ranges
    # Where points are sparse, the ones that stand for the surface there may be farther aside.
    reach = np.maximum(ranges * aside_rad, points.sizes * _DISC)
    near = np.flatnonzero((ranges > 0) & (square <= reach * reach))
    if not near.size:
        return None
    away, sizes, normals = points.away[near], points.sizes[near], points.normals[near]
    facing, slope = (away * normals).sum(axis=1), normals @ ray
    has_normal = np.abs(slope) > _LEAST_SLOPE
    met = np.where(has_normal, facing / np.where(has_normal, slope, 1.0), ranges[near])
    off = np.linalg.norm(met[:, None] * ray - away, axis=1)
    met = np.where((off <= sizes * _DISC) & (met > 0), met, np.inf)
    aside = np.sqrt(np.maximum(square[near], 0.0))
    return _NearRay(points.points[near], ranges[near], aside, sizes, met)

"""The measured points around a camera, as dense as a picture needs them, with their sizes."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.cameras.depth_kernels import ALONE_M, sizes_kernel
from processing.image.images_of_drives import image_of
from processing.image.tiles.tiles import TileKey, TilePyramid
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.choice import pixels_per_radian
from processing.recording.columns.counted_classes import class_columns

if TYPE_CHECKING:  # a drive knows its cameras, so importing it here would be a circle
    from processing.recording.drive import Drive

OWN_BODY_M = 1.5
"""Points nearer to a camera than this are the vehicle's own body, or its dirt."""

_SURFACE_M = 0.3
"""Neighbours of a raster farther apart are of other surfaces, but where points are sparser than
that: half of it. By trial; no measurement is recorded."""

_NOT_THERE = (7, 18, 64)
"""Classes that hide nothing: noise, and what moved between measurement and image."""

_KEPT_TILES = 48
"""Tiles that are kept: those about an image and the next."""


@dataclass(frozen=True)
class SizedPoints:
    """Points of one drive.

    Attributes
    ----------
    points : (n,) int64
        Their indices in the drive.
    away : (n, 3) float64
        From the perspective centre, project axes, m.
    sizes : (n,) float32
        How large a piece of surface each stands for, m; `ALONE_M` where it has no neighbours.
    normals : (n, 3) float32
        Which way it faces, either way round; zero where that isn't known.
    """

    points: NDArray[np.int64]
    away: NDArray[np.float64]
    sizes: NDArray[np.float32]
    normals: NDArray[np.float32]

    @property
    def has_company(self) -> NDArray[np.bool_]:
        """Which points are part of a surface."""
        return np.asarray(self.sizes > ALONE_M)


class ImageSurroundings:
    """What was measured around one camera image.

    Parameters
    ----------
    camera : Camera
    drives : sequence of Drive
        All that may have measured something there.
    reach_m : float
        Points farther away are left out.
    """

    def __init__(self, camera: Camera, drives: Sequence[Drive], reach_m: float) -> None:
        self.camera = camera
        self.drives = tuple(drive for drive in drives if drive.count)
        self.reach_m = reach_m
        self._centre = np.array(camera.image.xyz)
        self._cone = _cone_of(camera)
        self._kept: OrderedDict[tuple[int, TileKey], SizedPoints] = OrderedDict()
        self._lock = threading.Lock()

    def seen(
        self, cell_px: float, check: Callable[[], None] | None = None
    ) -> Iterator[tuple[int, SizedPoints]]:
        """The points that the camera looks at, thinned where they are denser than cells.

        Parameters
        ----------
        cell_px : float
            Side of a cell, pixels of the image.
        check : callable, optional
            Called between tiles; raises to stop.

        Yields
        ------
        (number of the drive, SizedPoints)
        """
        cell_rad = cell_px / pixels_per_radian(self.camera.image)
        for number in range(len(self.drives)):
            for key in self._tiles(number, cell_rad):
                if check is not None:
                    check()
                yield number, self._points_of(number, key)

    def along(
        self, ray: NDArray[np.float64], reach_m: float, aside_rad: float
    ) -> Iterator[tuple[int, SizedPoints]]:
        """All measured points of the tiles that a line of sight passes.

        Parameters
        ----------
        ray : (3,) float64
            Unit vector, project axes.
        reach_m : float
            How far along the ray.
        aside_rad : float
            How far aside, as an angle.
        """
        for number, pyramid in enumerate(self._pyramids()):
            waiting = [pyramid.top]
            while waiting:
                key = waiting.pop()
                bounds = pyramid.bounds(key)
                if bounds is None or not _is_passed(bounds - self._centre, ray, reach_m, aside_rad):
                    continue
                if key.level:
                    waiting.extend(pyramid.children(key))
                else:
                    yield number, self._kept_points(number, key)

    def _pyramids(self) -> Iterator[TilePyramid]:
        return (image_of(drive, drive.image_kinds[-1]).pyramid for drive in self.drives)

    def _tiles(self, number: int, cell_rad: float) -> Iterator[TileKey]:
        drive = self.drives[number]
        pyramid = image_of(drive, drive.image_kinds[-1]).pyramid
        waiting = [pyramid.top]
        while waiting:
            key = waiting.pop()
            bounds = pyramid.bounds(key)
            if bounds is None:
                continue
            box = bounds - self._centre
            nearest = float(np.linalg.norm(np.maximum(0, np.maximum(box[0], -box[1]))))
            if nearest > self.reach_m or not self._looks_at(box):
                continue
            is_fine = pyramid.spacing_m(key) <= cell_rad * max(nearest, OWN_BODY_M)
            if key.level == 0 or is_fine:
                yield key
            else:
                waiting.extend(pyramid.children(key))

    def _looks_at(self, box: NDArray[np.float64]) -> bool:
        """Whether a box about the camera may be in the picture."""
        axis, opening = self._cone
        middle, radius = box.mean(axis=0), float(np.linalg.norm(box[1] - box[0])) / 2
        distance = float(np.linalg.norm(middle))
        if distance <= radius or opening >= np.pi:
            return True
        off = np.arccos(np.clip(middle @ axis / distance, -1.0, 1.0))
        return bool(off <= opening + np.arcsin(radius / distance))

    def _kept_points(self, number: int, key: TileKey) -> SizedPoints:
        with self._lock:
            found = self._kept.get((number, key))
            if found is not None:
                self._kept.move_to_end((number, key))
                return found
        found = self._points_of(number, key)
        with self._lock:
            self._kept[number, key] = found
            while len(self._kept) > _KEPT_TILES:
                self._kept.popitem(last=False)
        return found

    def _points_of(self, number: int, key: TileKey) -> SizedPoints:
        drive = self.drives[number]
        pyramid = image_of(drive, drive.image_kinds[-1]).pyramid
        raster = pyramid.points(key)
        is_filled = raster >= 0
        points = raster[is_filled]
        xyz = np.zeros((*raster.shape, 3))
        xyz[is_filled] = drive.xyz(points) - self._centre
        limit = max(_SURFACE_M, 2 * pyramid.spacing_m(key))
        sizes = np.zeros(raster.shape, np.float32)
        normals = np.zeros((*raster.shape, 3), np.float32)
        sizes_kernel(xyz, is_filled, limit, sizes, normals)
        away = xyz[is_filled]
        is_there = (away * away).sum(axis=1) >= OWN_BODY_M**2
        is_there &= ~np.isin(class_columns(drive.columns).codes_of(points), _NOT_THERE)
        return SizedPoints(
            points[is_there],
            away[is_there],
            sizes[is_filled][is_there],
            normals[is_filled][is_there],
        )


def _cone_of(camera: Camera) -> tuple[NDArray[np.float64], float]:
    """The middle direction of an image and the angle from it to its farthest corner, rad."""
    image = camera.image
    if image.projection == "equirectangular":
        return np.array([1.0, 0.0, 0.0]), np.pi
    corners = [(c, r) for c in (0, image.width_px) for r in (0, image.height_px)]
    middle = camera.rays_of([[image.width_px / 2, image.height_px / 2]])[0]
    cosine = float((camera.rays_of(corners) @ middle).min())
    return middle, float(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _is_passed(
    box: NDArray[np.float64], ray: NDArray[np.float64], reach_m: float, aside_rad: float
) -> bool:
    """Whether a ray from the origin comes within the angle of a box, before its reach."""
    farthest = float(np.linalg.norm(np.maximum(np.abs(box[0]), np.abs(box[1]))))
    pad = min(farthest, reach_m) * aside_rad
    low, high = box[0] - pad, box[1] + pad
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = low / ray, high / ray
    enter, leave = np.fmin(one, other), np.fmax(one, other)
    level = ray == 0
    if (level & ((low > 0) | (high < 0))).any():
        return False
    first = float(np.max(enter[~level], initial=0.0))
    last = float(np.min(leave[~level], initial=reach_m))
    return first <= last

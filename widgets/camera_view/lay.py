"""CameraLay: how project space lies in a camera image, distortion and panoramas included."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.cameras.camera import Camera
from processing.cameras.choice import pixels_per_radian
from processing.cameras.depth import DepthPicture
from processing.cameras.image_list import CameraImage
from processing.project.feature import Position
from widgets.mouse_tools.mouse_tool import Ray

Floats = NDArray[np.float64]

REACH_M = 80.0
"""Farther away features are drawn faintly."""

_NEAREST_M = 0.1
_WIDEST = 8.0
_PIECES = 24
_USUAL_RANGE_M = 10.0


class CameraLay:
    """One image as a plane; units are its pixels, whose middles are at whole numbers.

    Parameters
    ----------
    image : CameraImage
    depth : DepthPicture or None
        Tells what is hidden; None: nothing is known to be.
    """

    def __init__(self, image: CameraImage, depth: DepthPicture | None) -> None:
        self.image = image
        self.camera = Camera(image)
        self.depth = depth

    def to_plane(self, xyz: Floats) -> Floats:
        """(n, 2) columns and rows; NaN behind the camera."""
        return self.camera.pixels_of(np.asarray(xyz, dtype=np.float64).reshape(-1, 3))

    def lines_on_plane(self, xyz: Floats, ends: NDArray[np.int64]) -> list[Floats]:
        """Segments as lines, bent as the lens bends them; NaN places where they are broken."""
        if not len(ends):
            return []
        away = np.asarray(xyz, dtype=np.float64) - np.array(self.image.xyz)
        if self.image.projection == "equirectangular":
            return self._around(away[ends])
        seen = away @ self.camera.rotation.T
        return self._ahead(seen[ends])

    def ray(self, place: tuple[float, float]) -> Ray | None:
        """The line of sight of a pixel."""
        east, north, up = self.camera.rays_of(np.array([place]))[0].tolist()
        return Ray(self.image.xyz, (east, north, up))

    def reach_m(self, place: tuple[float, float], reach: float, at: Position | None) -> float:
        """What pixels measure at a measured point; where there is none, at a usual distance."""
        del place
        distance = _USUAL_RANGE_M
        if at is not None:
            distance = float(self.camera.distances_to(np.array([at]))[0])
        return reach * distance / pixels_per_radian(self.image)

    def is_near(self, xyz: Floats) -> NDArray[np.bool_]:
        """Which places are within reach and not behind a surface."""
        places = np.asarray(xyz, dtype=np.float64).reshape(-1, 3)
        near = self.camera.distances_to(places) <= REACH_M
        if self.depth is not None:
            near &= ~self.depth.hides(places)
        return np.asarray(near)

    def _ahead(self, seen: Floats) -> list[Floats]:
        """Lines of (m, 2, 3) ends in camera axes: cut off before the camera and far aside."""
        start, way = seen[:, 0], seen[:, 1] - seen[:, 0]
        first, last = np.zeros(len(seen)), np.ones(len(seen))
        # Each plane: a place is inside where its distance is positive.
        planes = np.array(
            [[0, 0, -1, -_NEAREST_M]]
            + [[side * x, side * y, -_WIDEST, 0] for x, y in ((1, 0), (0, 1)) for side in (1, -1)],
            dtype=np.float64,
        )
        for plane in planes:
            at, step = start @ plane[:3] + plane[3], way @ plane[:3]
            with np.errstate(divide="ignore", invalid="ignore"):
                crossing = -at / step
            first = np.where(step > 0, np.fmax(first, crossing), first)
            last = np.where(step < 0, np.fmin(last, crossing), last)
            last = np.where((step == 0) & (at <= 0), -1.0, last)
        is_there = first < last
        ends = start[:, None] + np.stack([first, last], axis=1)[:, :, None] * way[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            flat = ends[:, :, :2] / -ends[:, :, 2:]
        if any(self.image.distortion):
            share = np.linspace(0.0, 1.0, _PIECES + 1)[None, :, None]
            flat = flat[:, :1] + share * (flat[:, 1:] - flat[:, :1])
        return self._projected(flat, is_there)

    def _projected(self, flat: Floats, is_there: NDArray[np.bool_]) -> list[Floats]:
        """Pixels of (m, k, 2) places on the plane one metre before the camera."""
        count, steps = flat.shape[:2]
        ahead = np.concatenate([flat, np.full((count, steps, 1), -1.0)], axis=2)
        xyz = ahead.reshape(-1, 3) @ self.camera.rotation + np.array(self.image.xyz)
        pixels = self.camera.pixels_of(xyz).reshape(count, steps, 2)
        return [
            line if is_drawn else np.empty((0, 2))
            for line, is_drawn in zip(pixels, is_there, strict=True)
        ]

    def _around(self, ends: Floats) -> list[Floats]:
        """Lines of (m, 2, 3) ends about a panorama's centre, broken at its seam."""
        share = np.linspace(0.0, 1.0, 2 * _PIECES + 1)[None, :, None]
        unit = ends / np.maximum(np.linalg.norm(ends, axis=2, keepdims=True), 1e-9)
        places = unit[:, :1] + share * (unit[:, 1:] - unit[:, :1])
        pixels = self.camera.pixels_of(places.reshape(-1, 3) + np.array(self.image.xyz))
        lines = pixels.reshape(len(ends), -1, 2)
        return [_broken(line, self.image.width_px / 2) for line in lines]


def _broken(line: Floats, most_px: float) -> Floats:
    """A line with a NaN place wherever it jumps from one edge to the other."""
    jumps = np.flatnonzero(np.abs(np.diff(line[:, 0])) > most_px) + 1
    return np.insert(line, jumps, np.nan, axis=0)

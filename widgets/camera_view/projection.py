"""CameraProjection: how project space lies in a camera image, distortion and panoramas included."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.cameras.depth import DepthPicture
from processing.core.arrays import Floats
from processing.map.feature import Position
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.choice import pixels_per_radian
from processing.recording.camera_images.image_list import CameraImage
from widgets.mouse_tools.mouse_tool import Ray
from widgets.plane_view.line_pieces import clip_pieces

REACH_M = 80.0
"""Farther away features are drawn faintly."""

_NEAREST_M = 0.1
_WIDEST = 8.0
_PIECES = 24
_USUAL_RANGE_M = 10.0


class CameraProjection:
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
        self._low = np.array([-0.5, -0.5])
        self._high = self._low + np.array([image.width_px, image.height_px])

    def to_plane(self, xyz: Floats) -> Floats:
        """(n, 2) columns and rows; NaN outside the image."""
        pixels = self.camera.pixels_of(np.asarray(xyz, dtype=np.float64).reshape(-1, 3))
        inside = np.asarray(((pixels >= self._low) & (pixels <= self._high)).all(axis=1))
        pixels[~inside] = np.nan
        return pixels

    def lines_on_plane(self, xyz: Floats, ends: NDArray[np.int64]) -> list[Floats]:
        """Segments as lines, bent as the lens bends them, cut off at the image's edges.

        NaN places stand where a line is broken.
        """
        if not len(ends):
            return []
        away = np.asarray(xyz, dtype=np.float64) - np.array(self.image.xyz)
        if self.image.projection == "equirectangular":
            return self._cut(self._around(away[ends]))
        seen = away @ self.camera.rotation.T
        return self._cut(self._ahead(seen[ends]))

    def ray(self, position: tuple[float, float]) -> Ray | None:
        """The line of sight of a pixel."""
        east, north, up = self.camera.rays_of(np.array([position]))[0].tolist()
        return Ray(self.image.xyz, (east, north, up))

    def reach_m(self, position: tuple[float, float], reach: float, at: Position | None) -> float:
        """What pixels measure at a measured point; where there is none, at a usual distance."""
        del position
        distance = _USUAL_RANGE_M
        if at is not None:
            distance = float(self.camera.distances_to(np.array([at]))[0])
        return reach * distance / pixels_per_radian(self.image)

    def is_near(self, xyz: Floats) -> NDArray[np.bool_]:
        """Which places are within reach and not behind a surface."""
        positions = np.asarray(xyz, dtype=np.float64).reshape(-1, 3)
        near = self.camera.distances_to(positions) <= REACH_M
        if self.depth is not None:
            near &= ~self.depth.hides(positions)
        return np.asarray(near)

    def _cut(self, lines: Floats) -> list[Floats]:
        """What of (m, k, 2) lines lies in the image; NaN between pieces that don't meet."""
        count, steps = lines.shape[:2]
        pieces = np.stack([lines[:, :-1], lines[:, 1:]], axis=2).reshape(-1, 2, 2)
        cut, numbers, _ = clip_pieces(pieces, self._low, self._high)
        owners = numbers // (steps - 1)
        firsts = np.searchsorted(owners, np.arange(count + 1))
        return [_join_pieces(cut[firsts[i] : firsts[i + 1]]) for i in range(count)]

    def _ahead(self, seen: Floats) -> Floats:
        """Lines of (m, 2, 3) ends in camera axes, none before the camera or far aside: NaN."""
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
        flat[~is_there] = np.nan
        return self._project_pieces(flat)

    def _project_pieces(self, flat: Floats) -> Floats:
        """Pixels of (m, k, 2) places on the plane one metre before the camera."""
        ahead = np.concatenate([flat, np.full((*flat.shape[:2], 1), -1.0)], axis=2)
        xyz = ahead.reshape(-1, 3) @ self.camera.rotation + np.array(self.image.xyz)
        return self.camera.pixels_of(xyz).reshape(flat.shape)

    def _around(self, ends: Floats) -> Floats:
        """Lines of (m, 2, 3) ends about a panorama's centre, NaN where they jump at its seam."""
        share = np.linspace(0.0, 1.0, 2 * _PIECES + 1)[None, :, None]
        unit = ends / np.maximum(np.linalg.norm(ends, axis=2, keepdims=True), 1e-9)
        positions = unit[:, :1] + share * (unit[:, 1:] - unit[:, :1])
        pixels = self.camera.pixels_of(positions.reshape(-1, 3) + np.array(self.image.xyz))
        lines = pixels.reshape(len(ends), -1, 2)
        jumps = np.abs(np.diff(lines[:, :, 0], axis=1)) > self.image.width_px / 2
        lines[:, 1:][jumps] = np.nan
        return lines


def _join_pieces(pieces: Floats) -> Floats:
    """(k, 2, 2) pieces as one line, with NaN where one doesn't begin where the last ended."""
    if not len(pieces):
        return np.empty((0, 2))
    broken = np.flatnonzero((pieces[1:, 0] != pieces[:-1, 1]).any(axis=1))
    line = np.vstack([pieces[:, 0], pieces[-1:, 1]])
    if not broken.size:
        return line
    ends = np.stack([pieces[broken, 1], np.full((broken.size, 2), np.nan)], axis=1)
    return np.insert(line, np.repeat(broken + 1, 2), ends.reshape(-1, 2), axis=0)

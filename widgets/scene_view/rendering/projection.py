"""SceneProjection: places to pixels and pixels to rays, for picking, hits and the overlay."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from widgets.scene_view.rendering.camera import SceneCamera

NEAR_M = 0.05
"""What is nearer to the camera's plane than this isn't seen in perspective."""

_FARTHEST_MIDDLE = 4.0
_LEAST_DISTANCE_M = 10.0


@dataclass(frozen=True)
class SceneProjection:
    """A camera and the size of its picture.

    Attributes
    ----------
    width_px, height_px : int
        Of the widget, in Qt's pixels.
    """

    camera: SceneCamera
    width_px: int
    height_px: int

    @cached_property
    def focal_px(self) -> float:
        """Pixels per metre, one metre in front of a camera with perspective."""
        return self.height_px / 2 / math.tan(math.radians(self.camera.angle_deg) / 2)

    @cached_property
    def point_px(self) -> float:
        """Pixels per metre where VTK's divisor is one: there is none without perspective."""
        is_parallel = self.camera.is_parallel
        return self.focal_px / self.camera.distance_m if is_parallel else self.focal_px

    def in_view(self, local_xyz: NDArray[np.floating]) -> Floats:
        """(n, 3): metres to the right, upwards and in front of the camera."""
        offset = np.asarray(local_xyz, dtype=np.float64) - np.array(self.camera.position)
        seen: Floats = offset @ self._axes.T
        return seen

    def to_screen(self, local_xyz: NDArray[np.floating]) -> tuple[Floats, Floats]:
        """Pixels of places.

        Parameters
        ----------
        local_xyz : (n, 3)
            Metres from the view's origin.

        Returns
        -------
        pixels : (n, 2) float64
            To the right and downwards from the upper left corner; NaN behind the camera. Without
            perspective what is behind it is seen as well.
        depth : (n,) float64
            Metres in front of the camera.
        """
        return self.on_screen(self.in_view(local_xyz))

    def on_screen(self, seen: Floats) -> tuple[Floats, Floats]:
        """Pixels and depths of what :meth:`in_view` gave."""
        depth = seen[:, 2]
        if self.camera.is_parallel:
            scale: Floats = np.full(depth.shape, self.point_px)
        else:
            scale = self.focal_px / np.where(depth > NEAR_M, depth, np.nan)
        x = self.width_px / 2 + seen[:, 0] * scale
        y = self.height_px / 2 - seen[:, 1] * scale
        return np.column_stack([x, y]), depth

    def segments_on_screen(self, local_xyz: Floats, ends: NDArray[np.int64]) -> Floats:
        """Segments between places, cut off in front of the camera.

        Parameters
        ----------
        local_xyz : (n, 3) float64
        ends : (m, 2) int64
            Indices of the places at both ends.

        Returns
        -------
        (m, 2, 2) float64
            Pixels of both ends; NaN for a segment that lies wholly behind the camera.
        """
        seen = self.in_view(local_xyz)[ends]
        if self.camera.is_parallel:
            return np.stack([self.on_screen(seen[:, end])[0] for end in (0, 1)], axis=1)
        depth = seen[:, :, 2]
        near = 2 * NEAR_M
        first, second = seen[:, 0], seen[:, 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            share = ((near - depth[:, 0]) / (depth[:, 1] - depth[:, 0]))[:, None]
            crossing = first + share * (second - first)
        behind = depth < near
        first = np.where((behind[:, 0] & ~behind[:, 1])[:, None], crossing, first)
        second = np.where((behind[:, 1] & ~behind[:, 0])[:, None], crossing, second)
        return np.stack([self.on_screen(first)[0], self.on_screen(second)[0]], axis=1)

    def ray(self, x: float, y: float) -> Floats:
        """(3,): direction through a pixel, so long that it reaches one metre in front."""
        right, up, forward = self._axes
        if self.camera.is_parallel:
            return np.array(forward)
        across = (x - self.width_px / 2) / self.focal_px
        upwards = (self.height_px / 2 - y) / self.focal_px
        direction: Floats = forward + right * across + up * upwards
        return direction

    def eye(self, x: float, y: float) -> Floats:
        """(3,): from where a pixel is seen, metres from the origin; depths count from there."""
        position = np.array(self.camera.position)
        if not self.camera.is_parallel:
            return position
        right, up, _ = self._axes
        across, upwards = x - self.width_px / 2, self.height_px / 2 - y
        eye: Floats = position + (right * across + up * upwards) / self.point_px
        return eye

    def position_at(self, x: float, y: float, depth_m: float) -> Floats:
        """(3,): the place under a pixel so far in front of the camera, from the origin."""
        position: Floats = self.eye(x, y) + self.ray(x, y) * depth_m
        return position

    @cached_property
    def matrix(self) -> Floats:
        """(3, 4) float64: from metres about the origin, and 1, to x·w, y·w and w.

        w is the depth, or 1 without perspective.
        """
        right, up, forward = self._axes
        middle_x, middle_y, scale = self.width_px / 2, self.height_px / 2, self.point_px
        position = np.array(self.camera.position)
        if self.camera.is_parallel:
            rows = np.stack([scale * right, -scale * up, np.zeros(3)])
            return np.column_stack([rows, [middle_x, middle_y, 1.0] - rows @ position])
        rows = np.stack(
            [middle_x * forward + scale * right, middle_y * forward - scale * up, forward]
        )
        return np.column_stack([rows, -rows @ position])

    @cached_property
    def matrix_with_depth(self) -> Floats:
        """(4, 4) float64: the rows of :attr:`matrix`, and one that gives the depth, m."""
        forward = self._axes[2]
        return np.vstack([self.matrix, [*forward, -float(forward @ self.camera.position)]])

    def metres_per_px(self, depth_m: float) -> float:
        """Size of a pixel at a depth."""
        return 1 / self.point_px if self.camera.is_parallel else depth_m / self.focal_px

    def is_in_middle(self, local: Floats) -> bool:
        """Whether a place, (3,) metres from the origin, is about where one looks, and not far."""
        pixels, depth = self.to_screen(local[None])
        x, y = pixels[0]
        inside = abs(x / self.width_px - 0.5) <= 1 / 6
        inside &= abs(y / self.height_px - 0.5) <= 1 / 6
        farthest = _FARTHEST_MIDDLE * max(self.camera.distance_m, _LEAST_DISTANCE_M)
        return bool(inside and (self.camera.is_parallel or depth[0] <= farthest))

    @cached_property
    def _axes(self) -> Floats:
        return self.camera.axes

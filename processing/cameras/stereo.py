"""A place from two images, where nothing was measured; its error; and epipolar lines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.choice import pixels_per_radian

PIXEL_ERROR_PX = 1.0
"""How well a person marks a pixel, one sigma."""

LEAST_ANGLE_DEG = 1.0
"""Rays that cross at a smaller angle say nothing about the distance."""

_MOST_ERRORS_APART = 10.0
"""Rays that pass each other at more than so many standard deviations show two things, or an image
is oriented wrongly. By trial; no measurement is recorded."""

_EPIPOLAR_STEPS = 96
"""Places along a ray that are drawn in another image, evenly in the inverse distance: a smooth
curve on any screen."""

_NEAREST_M, _FARTHEST_M = 1.0, 300.0
"""From the vehicle's own body to what no point shows any more."""


@dataclass(frozen=True)
class StereoPosition:
    """Where two lines of sight meet.

    Attributes
    ----------
    xyz : (3,) float64
        m, project CRS: nearest to both rays, each weighed by its distance.
    covariance : (3, 3) float64
        m², from the pixels' error.
    error_m : float
        One sigma of the position, in space: the root of the covariance's trace.
    gap_m : float
        How far the rays pass each other.
    angle_deg : float
        At which they cross.
    """

    xyz: NDArray[np.float64]
    covariance: NDArray[np.float64]
    error_m: float
    gap_m: float
    angle_deg: float


def stereo_position(
    one: tuple[Camera, ArrayLike],
    other: tuple[Camera, ArrayLike],
    *,
    pixel_error_px: float = PIXEL_ERROR_PX,
) -> StereoPosition:
    """The place that two pixels of two images show.

    Parameters
    ----------
    one, other : (Camera, (2,) float64)
        An image, and column and row in it.

    Raises
    ------
    Unsuitable
        The rays are nearly parallel, meet behind a camera, or pass each other by far more than
        the pixels' error explains: they show different things.

    Notes
    -----
    Each ray's error is that of its direction: pixel error / pixels per radian · distance, in both
    directions across the ray. With P = I − d dᵀ the normal equations are Σ P / s² x = Σ P / s² C,
    s from the distances of the unweighted solution; the covariance is the inverse.
    """
    cameras = (one[0], other[0])
    centres = np.array([camera.image.xyz for camera in cameras])
    pairs = (one, other)
    rays = np.vstack([camera.rays_of(np.atleast_2d(np.asarray(p))) for camera, p in pairs])
    angle = float(np.degrees(np.arccos(np.clip(rays[0] @ rays[1], -1.0, 1.0))))
    if min(angle, 180.0 - angle) < LEAST_ANGLE_DEG:
        raise _make_refusal(_PARALLEL, cameras)
    # About the first centre: coordinates of millions of metres squared would cost digits.
    base = centres - centres[0]
    across = np.eye(3) - rays[:, :, None] * rays[:, None, :]
    first = _solve_position(across, base, np.ones(2))
    distances = ((first - base) * rays).sum(axis=1)
    if (distances <= 0).any():
        raise _make_refusal(_DIVERGING, cameras)
    per_radian = np.array([pixels_per_radian(camera.image) for camera in cameras])
    sigma = pixel_error_px / per_radian * distances
    position = _solve_position(across, base, 1 / sigma**2)
    covariance = np.linalg.inv((across / (sigma**2)[:, None, None]).sum(axis=0))
    normal = np.cross(rays[0], rays[1])
    gap = float(abs((base[1] - base[0]) @ normal) / np.linalg.norm(normal))
    if gap > _MOST_ERRORS_APART * float(np.hypot(*sigma)):
        raise _make_refusal(_APART.filled(gap=gap), cameras)
    error = float(np.sqrt(np.trace(covariance)))
    return StereoPosition(position + centres[0], covariance, error, gap, angle)


def epipolar_line(
    camera: Camera,
    pixel: ArrayLike,
    other: Camera,
    *,
    nearest_m: float = _NEAREST_M,
    farthest_m: float = _FARTHEST_M,
) -> NDArray[np.float64]:
    """Where a pixel's line of sight runs in another image.

    Returns
    -------
    (n, 2) float64
        Columns and rows from near to far, curved where the lens is; NaN where the other image
        doesn't look. Places may lie outside the image.
    """
    ray = camera.rays_of(np.atleast_2d(np.asarray(pixel, dtype=np.float64)))[0]
    distances = 1 / np.linspace(1 / nearest_m, 1 / farthest_m, _EPIPOLAR_STEPS)
    return other.pixels_of(np.array(camera.image.xyz) + distances[:, None] * ray)


def _solve_position(
    across: NDArray[np.float64], base: NDArray[np.float64], weights: NDArray[np.float64]
) -> NDArray[np.float64]:
    normal = (across * weights[:, None, None]).sum(axis=0)
    right = (np.einsum("kij,kj->ki", across, base) * weights[:, None]).sum(axis=0)
    return np.asarray(np.linalg.solve(normal, right), dtype=np.float64)


_PARALLEL = Text(
    "The two lines of sight are nearly parallel, so the distance can't be measured.",
    "2本の視線がほぼ平行なため、距離を求められません。",
)
_DIVERGING = Text(
    "The two lines of sight don't meet in front of the cameras.",
    "2本の視線がカメラの前方で交わりません。",
)
_APART = Text(
    "The two lines of sight pass each other by {gap:.2f} m: they show different things.",
    "2本の視線が {gap:.2f} m 離れています。別のものを指しています。",
)


def _make_refusal(what: Text, cameras: tuple[Camera, Camera]) -> Unsuitable:
    return Unsuitable(
        what,
        Text.same(" + ".join(camera.image.path.name for camera in cameras)),
        Text(
            "Mark the same thing in an image taken farther away from the first one.",
            "最初の画像と撮影位置がもっと離れた画像で、同じものを指定してください。",
        ),
    )

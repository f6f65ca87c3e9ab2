"""Colours of points from camera images, quickly for the screen: the best image of each point.

What hides a point from the camera isn't considered here; :mod:`processing.cameras.seen_colours`
does that.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UserError
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.choice import pixels_per_radian
from processing.recording.camera_images.image_list import CameraImage, ImageList
from processing.recording.camera_images.image_pixels import ImagePixels, read_pixels

WITHIN_S = 6.0
"""Images taken up to this long before or after a point was measured may show it: later the vehicle
has passed by 60 m and more at 40 km/h."""

_MOST_IMAGES = 24
"""Images that are asked for each group of points: those nearest in time. By trial; no measurement
is recorded."""

_BIN_S = 4.0
"""Points are grouped by this time, so that their images are chosen once."""

_READ_PIXELS = 1_500_000
"""Larger images are read reduced: a colour needs no more."""

_KEPT_IMAGES = 16
"""Images that are kept, 4.5 MB each."""


@dataclass(frozen=True)
class SeenColours:
    """Colours of points, where a camera saw them.

    Attributes
    ----------
    colours : (n, 3) uint8
        Zero where not seen.
    is_seen : (n,) bool
    """

    colours: NDArray[np.uint8]
    is_seen: NDArray[np.bool_]


def colours_from_images(
    xyz: NDArray[np.float64], time: NDArray[np.float64], images: ImageList
) -> SeenColours:
    """Colours of points from the images of their drive.

    Of the images taken near a point's time the one is used that sees it from nearby and near its
    middle: the smallest distance divided by the cosine of the angle to the camera's axis.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, project CRS.
    time : (n,) float64
        s, on the images' clock; points without a time (NaN) are looked for in all images.
    """
    colours = np.zeros((xyz.shape[0], 3), np.uint8)
    is_seen = np.zeros(xyz.shape[0], np.bool_)
    for points, middle_s in _by_time(time):
        candidates = _images_near(images, middle_s, xyz[points].mean(axis=0))
        best, best_pixels = _best_images(xyz[points], candidates)
        for number in np.unique(best[best >= 0]):
            pixels = _read(candidates[number])
            if pixels is None:
                continue
            chosen = np.flatnonzero(best == number)
            colours[points[chosen]] = pixels.colours_at(best_pixels[chosen])
            is_seen[points[chosen]] = True
    return SeenColours(colours, is_seen)


def penalties(
    camera: Camera, xyz: NDArray[np.float64], distances: NDArray[np.float64]
) -> NDArray[np.float64]:
    """How badly an image shows places: small for many pixels a metre and near the axis.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, project CRS.
    distances : (n,) float64
        From the perspective centre, m.
    """
    footprint = distances / pixels_per_radian(camera.image)
    if camera.image.projection == "equirectangular":
        return footprint
    # The axis is −z of the camera: the last row of its rotation, turned round.
    depth = (xyz - np.array(camera.image.xyz)) @ -camera.rotation[2]
    return np.asarray(footprint * distances / np.maximum(depth, 1e-6))


def _by_time(time: NDArray[np.float64]) -> Iterator[tuple[NDArray[np.int64], float]]:
    """Points measured within a few seconds of each other, and their middle time."""
    if not time.size:
        return
    bins = np.floor(np.where(np.isnan(time), -1.0, time) / _BIN_S).astype(np.int64)
    order = np.argsort(bins, kind="stable")
    for points in np.split(order, np.flatnonzero(np.diff(bins[order])) + 1):
        yield points, float(time[points].mean())


def _images_near(
    images: ImageList, middle_s: float, middle: NDArray[np.float64]
) -> list[CameraImage]:
    near = list(images)
    if not np.isnan(middle_s):
        near = [one for one in near if abs(one.time_s - middle_s) <= WITHIN_S + _BIN_S / 2]
    near.sort(key=lambda one: float(np.linalg.norm(np.array(one.xyz) - middle)))
    return near[:_MOST_IMAGES]


def _best_images(
    xyz: NDArray[np.float64], candidates: list[CameraImage]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Number of the best candidate of each point (−1: none), and the pixel in it."""
    best = np.full(xyz.shape[0], -1)
    best_pixels = np.zeros((xyz.shape[0], 2))
    best_score = np.full(xyz.shape[0], np.inf)
    for number, image in enumerate(candidates):
        camera = Camera(image)
        pixels = camera.pixels_of(xyz)
        score = penalties(camera, xyz, camera.distances_to(xyz))
        is_better = camera.shows(pixels) & (score < best_score)
        best[is_better], best_score[is_better] = number, score[is_better]
        best_pixels[is_better] = pixels[is_better]
    return best, best_pixels


@lru_cache(maxsize=_KEPT_IMAGES)
def _read(image: CameraImage) -> ImagePixels | None:
    """An image; None if unreadable: files stay where they were delivered and may be missing."""
    try:
        return read_pixels(image, _READ_PIXELS)
    except UserError:
        return None

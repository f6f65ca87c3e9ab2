"""Colours of points from camera images: for each point the best image that looks at it.

What hides a point from the camera isn't considered.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.cameras.camera import Camera
from processing.cameras.image_list import CameraImage, ImageList

WITHIN_S = 6.0
"""Images taken up to this long before or after a point was measured may show it."""

_MOST_IMAGES = 24
_BIN_S = 4.0
_READ_PIXELS = 1_500_000
_KEPT_IMAGES = 16


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
            pixels = _read(candidates[number].path, _reduction(candidates[number]))
            if pixels is None:
                continue
            chosen = np.flatnonzero(best == number)
            colours[points[chosen]] = _picked(pixels, candidates[number], best_pixels[chosen])
            is_seen[points[chosen]] = True
    return SeenColours(colours, is_seen)


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
        score = camera.distances_to(xyz)
        if image.projection == "perspective":
            # The axis is −z of the camera: the last row of its rotation, turned round.
            depth = (xyz - np.array(image.xyz)) @ -camera.rotation[2]
            score = score * score / np.maximum(depth, 1e-6)
        is_better = camera.shows(pixels) & (score < best_score)
        best[is_better], best_score[is_better] = number, score[is_better]
        best_pixels[is_better] = pixels[is_better]
    return best, best_pixels


def _picked(
    pixels: NDArray[np.uint8], image: CameraImage, places: NDArray[np.float64]
) -> NDArray[np.uint8]:
    """Colours at places given in pixels of the whole image."""
    height, width = pixels.shape[:2]
    columns = (places[:, 0] * (width / image.width_px)).astype(np.int64)
    rows = (places[:, 1] * (height / image.height_px)).astype(np.int64)
    rows, columns = np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)
    return np.asarray(pixels[rows, columns])


def _reduction(image: CameraImage) -> int:
    """By how much an image may be made smaller and still be fine enough for points: 1, 2, 4, 8."""
    reduction = 1
    while reduction < 8 and image.width_px * image.height_px > _READ_PIXELS * reduction**2:
        reduction *= 2
    return reduction


@lru_cache(maxsize=_KEPT_IMAGES)
def _read(path: Path, reduction: int) -> NDArray[np.uint8] | None:
    """An image, (h, w, 3) red green blue; None if unreadable.

    Image files stay where they were delivered and may be missing on this machine.
    """
    import cv2

    flags = {
        1: cv2.IMREAD_COLOR,
        2: cv2.IMREAD_REDUCED_COLOR_2,
        4: cv2.IMREAD_REDUCED_COLOR_4,
        8: cv2.IMREAD_REDUCED_COLOR_8,
    }
    try:
        # Not cv2.imread: it can't open names outside the system's code page on Windows.
        content = np.fromfile(path, np.uint8)
    except OSError:
        return None
    pixels = cv2.imdecode(content, flags[reduction]) if content.size else None
    return None if pixels is None else np.ascontiguousarray(pixels[:, :, ::-1])

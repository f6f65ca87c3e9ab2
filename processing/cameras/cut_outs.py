"""Pictures of flat things, cut out of the camera images that show them best."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.cameras.depth import DepthPicture
from processing.core.errors import UserError
from processing.core.monitor import Monitor
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.choice import ImageFinder
from processing.recording.camera_images.image_list import CameraImage
from processing.recording.camera_images.image_pixels import ImagePixels, read_pixels

if TYPE_CHECKING:  # a drive knows its cameras, so importing it here would be a circle
    from processing.recording.drive import Drive

_MARGIN = 0.3
"""Of a face's larger side, shown around it: its rim, and what it hangs on."""

_LEAST_PX = 16.0
"""Across the smaller side: of fewer pixels nobody tells one symbol from another."""

_STEEPEST = np.cos(np.radians(75.0))
"""Faces are seen under no smaller angle: a quarter of their width is left."""

_TRIED = 4
"""Images, the ones that show a face largest first, that are asked whether something hides it."""

_HIDDEN = 0.5
"""Share of a face's corners and middle that must be hidden so that another image is taken."""

_BEHIND_M = 1.0
"""How far beyond a face points are looked at: what is farther away hides nothing of it."""


@dataclass(frozen=True)
class Face:
    """A flat thing that looks one way.

    Attributes
    ----------
    outline : (n, 3) float64
        Its corners, m, project CRS.
    normal : (3,) float64
        Where it looks, a unit vector.
    """

    outline: NDArray[np.float64]
    normal: NDArray[np.float64]


@dataclass(frozen=True)
class CutOuts:
    """What camera images show of some faces.

    Attributes
    ----------
    pictures : tuple of (h, w, 3) uint8 or None
        Red, green, blue, in the order of the faces; None where no image shows one.
    insides : tuple of (n, 3) uint8 or None
        The pixels of each face alone, without what is around it.
    unread : int
        Images that would have been cut but can't be read.
    """

    pictures: tuple[NDArray[np.uint8] | None, ...]
    insides: tuple[NDArray[np.uint8] | None, ...] = ()
    unread: int = 0


def cut_outs(faces: Sequence[Face], drives: Sequence[Drive], monitor: Monitor) -> CutOuts:
    """The picture of each face in the image that shows it largest and unhidden, from before it.

    Parameters
    ----------
    faces : sequence of Face
    drives : sequence of Drive
        Of one survey: their images, and their points, which may hide faces.

    Notes
    -----
    1. Of all images within 50 m before a face, those are taken that show the whole of it.
    2. The one that shows most pixels of it, and in which measured points don't hide it, is cut
       out along the image's own rows and columns.
    """
    listed = {image.path: image for drive in drives for image in drive.images or ()}
    finder = ImageFinder(listed.values())
    chosen: dict[int, list[int]] = {}
    depths: dict[int, DepthPicture] = {}
    for number, face in enumerate(faces):
        monitor.check()
        image = _best_image(face, finder, drives, depths)
        if image is not None:
            chosen.setdefault(image, []).append(number)
        monitor.report(0.8 * (number + 1) / len(faces))
    pictures: list[NDArray[np.uint8] | None] = [None] * len(faces)
    insides: list[NDArray[np.uint8] | None] = [None] * len(faces)
    unread = 0
    for image, numbers in chosen.items():
        monitor.check()
        try:
            pixels = read_pixels(finder.images[image])
        except UserError:  # the image is gone or damaged: told by their number
            unread += 1
            continue
        for number in numbers:
            picture, inside = _cut(pixels, finder.cameras[image], faces[number])
            pictures[number], insides[number] = picture, inside
    return CutOuts(tuple(pictures), tuple(insides), unread)


def _best_image(
    face: Face, finder: ImageFinder, drives: Sequence[Drive], depths: dict[int, DepthPicture]
) -> int | None:
    """Number of the image to cut a face from."""
    middle = face.outline.mean(axis=0)
    sized: list[tuple[float, int, float]] = []
    for sighting in finder.seeing(middle):
        image = sighting.image
        towards = (np.array(image.xyz) - middle) / sighting.distance_m
        pixels = finder.cameras[sighting.number].pixels_of(face.outline)
        if towards @ face.normal >= _STEEPEST and _is_whole(pixels, image):
            sized.append((_area(pixels), sighting.number, sighting.distance_m))
    sized.sort(reverse=True)
    asked = np.vstack([face.outline, middle])
    for _, number, distance_m in sized[:_TRIED]:
        if number not in depths:
            reach = distance_m + _BEHIND_M
            depths[number] = DepthPicture(finder.images[number], drives, reach_m=reach)
        if depths[number].hides(asked).mean() < _HIDDEN:
            return number
    return None


def _is_whole(pixels: NDArray[np.float64], image: CameraImage) -> bool:
    """Whether an image shows all of a face, large enough."""
    if not np.isfinite(pixels).all():
        return False
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    # A face on the seam of a panorama would reach round it.
    is_one = high[0] - low[0] < image.width_px / 2
    is_in = (low >= 0).all() and (high < (image.width_px, image.height_px)).all()
    return bool(is_one and is_in and (high - low).min() >= _LEAST_PX)


def _area(pixels: NDArray[np.float64]) -> float:
    ahead = np.roll(pixels, -1, axis=0)
    return abs(float((pixels[:, 0] * ahead[:, 1] - ahead[:, 0] * pixels[:, 1]).sum())) / 2


def _cut(
    image: ImagePixels, camera: Camera, face: Face
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """A face with its surroundings, and the pixels of the face alone."""
    places = camera.pixels_of(face.outline) / np.array(image.scale)
    low, high = places.min(axis=0), places.max(axis=0)
    margin = _MARGIN * float((high - low).max())
    height, width = image.pixels.shape[:2]
    first = np.clip(np.floor(low - margin), 0, None).astype(np.int64)
    last = np.minimum(np.ceil(high + margin).astype(np.int64) + 1, (width, height))
    picture = image.pixels[first[1] : last[1], first[0] : last[0]].copy()
    rows, columns = np.indices(picture.shape[:2])
    outline = shapely.Polygon(places - first)
    return picture, picture[shapely.contains_xy(outline, columns + 0.5, rows + 0.5)]

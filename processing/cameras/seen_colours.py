"""Colours of points from the images that really see them, a stretch of points at a time."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.cameras.depth import TOLERANCE_M, DepthPicture
from processing.core.errors import MissingInput, UserError
from processing.core.text import Text
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.choice import ImageFinder
from processing.recording.camera_images.colouring import SeenColours, penalties
from processing.recording.camera_images.image_list import ImageList
from processing.recording.camera_images.image_pixels import read_pixels

if TYPE_CHECKING:  # a drive knows its cameras, so importing it here would be a circle
    from processing.recording.drive import Drive

_READ_PIXELS = 12_000_000
"""Larger images are read reduced: colours of points need no more than a pixel each, 36 MB."""

_KEPT_DEPTHS = 32
"""Depth pictures that are kept, of some MB each: images along some hundred metres."""

_AT_ONCE = 250_000
"""Points coloured at a time: short enough for a cancel to be felt at once."""


class PointColouring:
    """Colours points from images, with regard to what hides them.

    Parameters
    ----------
    images : ImageList
    drives : sequence of Drive
        Whose points may hide others; none: nothing hides anything.
    reach_m : float
        From farther away no colour is taken.

    Attributes
    ----------
    unreadable : dict of str to UserError
        What was wrong with images that were left out, by path.
    """

    def __init__(self, images: ImageList, drives: Sequence[Drive], reach_m: float) -> None:
        self._choice = ImageFinder(images)
        self._drives = tuple(drives)
        self._reach_m = reach_m
        self._depths: OrderedDict[int, DepthPicture] = OrderedDict()
        self._used = 0
        self.unreadable: dict[str, UserError] = {}

    def colours_of(self, xyz: NDArray[np.float64], check: Callable[[], None]) -> SeenColours:
        """The colour of each point in the best image that sees it.

        Parameters
        ----------
        xyz : (n, 3) float64
            m, project CRS; points of one stretch of the drive, so that few images are near.
        check : callable
            Called often; raises to stop.

        Raises
        ------
        MissingInput
            Not one of the images asked for so far can be read.
        """
        found = SeenColours(np.zeros((xyz.shape[0], 3), np.uint8), np.zeros(xyz.shape[0], np.bool_))
        if not xyz.size:
            return found
        best = np.full(xyz.shape[0], np.inf)
        low, high = np.nanmin(xyz, axis=0), np.nanmax(xyz, axis=0)
        around = self._reach_m + float(np.linalg.norm(high - low)) / 2
        for number in self._choice.around((low + high) / 2, around):
            check()
            self._look(number, xyz, best, found, check)
        return found

    def _look(
        self,
        number: int,
        xyz: NDArray[np.float64],
        best: NDArray[np.float64],
        found: SeenColours,
        check: Callable[[], None],
    ) -> None:
        """Take the colours of one image for the points that it shows better than others do."""
        camera = self._choice.cameras[number]
        if str(camera.image.path) in self.unreadable:
            return
        parts = []
        for start in range(0, xyz.shape[0], _AT_ONCE):
            check()
            part = self._better(camera, xyz, best, slice(start, start + _AT_ONCE))
            if part[0].size:
                parts.append(part)
        if not parts:
            return
        try:
            pixels = read_pixels(camera.image, _READ_PIXELS)
        except UserError as error:
            self._leave_out(camera, error)
            return
        self._used += 1
        depth = self._depth(number, check) if self._drives else None
        for points, positions, ranges, scores in parts:
            check()
            if depth is not None:
                open_ = ~depth.hides_at(positions, ranges, TOLERANCE_M)
                points, positions, scores = points[open_], positions[open_], scores[open_]
            best[points] = scores
            found.colours[points] = pixels.colours_at(positions)
            found.is_seen[points] = True

    def _better(
        self, camera: Camera, xyz: NDArray[np.float64], best: NDArray[np.float64], part: slice
    ) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Points of a part that an image might show better: indices, pixels, ranges, penalties."""
        ranges = camera.distances_to(xyz[part])
        near = np.flatnonzero(ranges <= self._reach_m)
        positions = xyz[part][near]
        scores = penalties(camera, positions, ranges[near])
        kept = scores < best[part][near]
        near, positions, scores = near[kept], positions[kept], scores[kept]
        pixels = camera.pixels_of(positions)
        shown = camera.shows(pixels)
        near = near[shown]
        return near + part.start, pixels[shown], ranges[near], scores[shown]

    def _depth(self, number: int, check: Callable[[], None]) -> DepthPicture:
        if number not in self._depths:
            image = self._choice.images[number]
            self._depths[number] = DepthPicture(
                image, self._drives, reach_m=self._reach_m, check=check
            )
            while len(self._depths) > _KEPT_DEPTHS:
                self._depths.popitem(last=False)
        self._depths.move_to_end(number)
        return self._depths[number]

    def _leave_out(self, camera: Camera, error: UserError) -> None:
        self.unreadable[str(camera.image.path)] = error
        if self._used or len(self.unreadable) < len(self._choice.images):
            return
        raise MissingInput(
            Text(
                "None of the {count} camera images can be read.",
                "{count} 枚のカメラ画像を1枚も読み込めません。",
            ).filled(count=len(self.unreadable)),
            error.where,
            error.remedy,
        ) from error

"""StereoMeasurement: a place from two clicks in two images, where no point was measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.cameras.stereo import StereoPosition, epipolar_line, stereo_position
from processing.core.errors import Unsuitable
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.choice import ImageFinder

StereoPixel = tuple[float, float]

_USUAL_RANGE_M = 12.0
_MARGIN_PX = 400.0


@dataclass(frozen=True)
class MarkedPixel:
    """The first click: an image and a pixel of it."""

    number: int
    pixel: StereoPixel


class StereoMeasurement:
    """Remembers the first click and says what the second one gives.

    Attributes
    ----------
    marked : MarkedPixel or None
        What was clicked first.
    """

    def __init__(self) -> None:
        self.marked: MarkedPixel | None = None

    def drop(self) -> None:
        """Forget the first click."""
        self.marked = None

    def mark(self, number: int, pixel: StereoPixel) -> None:
        """Take the first click."""
        self.marked = MarkedPixel(number, pixel)

    def partner(self, choice: ImageFinder, near: NDArray[np.float64] | None) -> int | None:
        """The image in which the second click tells the place best; None where none does.

        Parameters
        ----------
        near : (3,) float64 or None
            What was measured about there, m, project CRS; None: a usual distance is taken.
        """
        if self.marked is None:
            return None
        camera = choice.cameras[self.marked.number]
        if near is None:
            ray = camera.rays_of(np.array([self.marked.pixel]))[0]
            near = np.array(camera.image.xyz) + _USUAL_RANGE_M * ray
        best: tuple[float, int] | None = None
        for sighting in choice.seeing(near):
            if sighting.number == self.marked.number:
                continue
            try:
                other = choice.cameras[sighting.number]
                own = camera.pixels_of(near[None, :])[0]
                error = stereo_position((camera, own), (other, sighting.pixel)).error_m
            except Unsuitable:
                continue
            if best is None or error < best[0]:
                best = error, sighting.number
        return None if best is None else best[1]

    def line_in(self, choice: ImageFinder, number: int) -> NDArray[np.float64] | None:
        """(n, 2) the first click's line of sight in another image; None without or in its own."""
        if self.marked is None or number == self.marked.number:
            return None
        other = choice.cameras[number]
        line = epipolar_line(choice.cameras[self.marked.number], self.marked.pixel, other)
        size = np.array([other.image.width_px, other.image.height_px])
        inside = ((line > -_MARGIN_PX) & (line < size + _MARGIN_PX)).all(axis=1)
        line[~inside] = np.nan
        return line

    def position(
        self, choice: ImageFinder, number: int, pixel: StereoPixel
    ) -> StereoPosition | None:
        """What the second click gives; None before the first one.

        Raises
        ------
        Unsuitable
            The two lines of sight tell no place.
        """
        if self.marked is None:
            return None
        one: Camera = choice.cameras[self.marked.number]
        return stereo_position((one, self.marked.pixel), (choice.cameras[number], pixel))

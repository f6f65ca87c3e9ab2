"""Where signs are said to be by pixels of camera images: marked by a person or by a detector.

Takahashi 2022, 8.4: initial positions are measured in two images of the vehicle's cameras; one
image is enough where its line of sight meets something that was measured.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations

from processing.cameras.depth import DepthPicture
from processing.cameras.stereo import StereoPosition, stereo_position
from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.methods.road.signs.initial_positions import InitialPosition, SignPixel
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.image_list import CameraImage
from processing.recording.drive import Drive


@dataclass(frozen=True)
class SightedPositions:
    """What pixels show.

    Attributes
    ----------
    positions : tuple of InitialPosition
        With the line of the first pixel of each sign.
    unknown : tuple of int
        Lines that name an image which the drives don't have.
    unmet : tuple of int
        Lines whose line of sight meets nothing, neither measured points nor another one.
    """

    positions: tuple[InitialPosition, ...]
    unknown: tuple[int, ...]
    unmet: tuple[int, ...]


def sighted_positions(
    pixels: Sequence[SignPixel], drives: Sequence[Drive], monitor: Monitor
) -> SightedPositions:
    """The places that pixels show: where two lines of sight cross, or meet measured points.

    Images are known by their file name, whatever folder they lie in.
    """
    images = {one.path.name.casefold(): one for drive in drives for one in drive.images or ()}
    pictures = _Pictures(drives)
    positions: list[InitialPosition] = []
    unknown, unmet = [], []
    for group in _by_sign(pixels):
        monitor.check()
        seen = [(one, images.get(one.image.casefold())) for one in group]
        unknown += [one.line for one, image in seen if image is None]
        known = [(one, image) for one, image in seen if image is not None]
        if not known:
            continue
        xyz = _crossing(known) or pictures.met(known)
        if xyz is None:
            unmet += [one.line for one, _ in known]
            continue
        shape = next((one.shape for one in group if one.shape), "")
        size_m = next((one.size_m for one in group if not math.isnan(one.size_m)), math.nan)
        positions.append(InitialPosition(group[0].line, *xyz, shape, size_m))
    return SightedPositions(tuple(positions), tuple(unknown), tuple(unmet))


_Sighting = tuple[SignPixel, CameraImage]
_Place = tuple[float, float, float]


def _by_sign(pixels: Iterable[SignPixel]) -> list[list[SignPixel]]:
    """Pixels of one sign together; what has no name is a sign of its own."""
    groups: dict[object, list[SignPixel]] = {}
    for one in pixels:
        groups.setdefault(one.sign or one.line, []).append(one)
    return list(groups.values())


def _crossing(known: Sequence[_Sighting]) -> _Place | None:
    """Where the two lines of sight cross that tell it best."""
    best: StereoPosition | None = None
    for (one, first), (other, second) in combinations(known, 2):
        try:
            found = stereo_position(
                (Camera(first), (one.column_px, one.row_px)),
                (Camera(second), (other.column_px, other.row_px)),
            )
        except Unsuitable:  # other pairs, or points that were measured, may tell it
            continue
        if best is None or found.error_m < best.error_m:
            best = found
    return None if best is None else _place(best.xyz.tolist())


class _Pictures:
    """What images show of the measured points, each looked at once."""

    def __init__(self, drives: Sequence[Drive]) -> None:
        self._drives = drives
        self._depths: dict[str, DepthPicture] = {}

    def met(self, known: Sequence[_Sighting]) -> _Place | None:
        """The measured point that the first line of sight meets which meets one."""
        for one, image in known:
            depth = self._depths.get(one.image)
            if depth is None:
                depth = self._depths[one.image] = DepthPicture(image, self._drives)
            seen = depth.point_at((one.column_px, one.row_px))
            if seen is not None:
                return seen.xyz
        return None


def _place(xyz: list[float]) -> _Place:
    east, north, up = xyz
    return east, north, up

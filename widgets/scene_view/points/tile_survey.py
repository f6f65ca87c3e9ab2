"""TileSurvey: where the tiles of many and long drives are, found out bit by bit."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UserError
from processing.image.images_of_drives import image_of
from processing.image.search.tile_choice import Camera3D
from processing.image.tiles.tiles import TilePyramid
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind

DriveImage = tuple[Drive, ImageKind]

_AT_ONCE_S = 0.25
_PORTION_POINTS = 400_000


class TileSurvey:
    """Opens the tiles of drives and makes their places exact, near the camera first.

    It belongs to one thread; what can be chosen from is there after :meth:`use`.
    """

    def __init__(self) -> None:
        self._drives: tuple[DriveImage, ...] = ()
        self._pyramids: dict[DriveImage, TilePyramid | None] = {}
        self._eye = np.zeros(3)

    @property
    def opened(self) -> list[tuple[tuple[str, ImageKind], TilePyramid]]:
        """Drive id, kind and tiles of the drives that can be shown by now."""
        found = ((drive, kind, self._pyramids.get((drive, kind))) for drive, kind in self._drives)
        return [((drive.id, kind), tiles) for drive, kind, tiles in found if tiles is not None]

    @property
    def has_opened_all(self) -> bool:
        """Whether no drive is left out of :attr:`opened` that could be shown."""
        return len(self._pyramids) == len(self._drives)

    @property
    def is_finished(self) -> bool:
        """Whether all is known exactly."""
        return self.has_opened_all and all(tiles.is_ready for _, tiles in self.opened)

    def use(self, drives: Sequence[DriveImage], camera: Camera3D) -> None:
        """Survey these drives; opens as many as can be opened in a moment, at least one."""
        self._eye = np.array(camera.origin) + np.array(camera.position)
        if self._drives != tuple(drives):
            self._drives = tuple(drives)
            self._pyramids = {
                drive: tiles for drive, tiles in self._pyramids.items() if drive in self._drives
            }
        self._open_some()

    def go_on(self) -> bool:
        """Find out a little more; says whether something was finished by that."""
        if not self.has_opened_all:
            return self._open_some()
        waiting = [one for one in self._by_distance() if not self._is_known(one)]
        tiles = self._pyramids[waiting[0]] if waiting else None
        return tiles is None or tiles.extend(self._eye, _PORTION_POINTS)

    def close(self) -> None:
        """Keep what was found out."""
        for _, tiles in self.opened:
            tiles.keep()

    def _open_some(self) -> bool:
        began_at, has_opened = time.monotonic(), False
        for one in self._by_distance():
            if one in self._pyramids:
                continue
            if has_opened and time.monotonic() - began_at > _AT_ONCE_S:
                break
            self._pyramids[one] = _open_pyramid(*one)
            has_opened = True
        return has_opened

    def _is_known(self, one: DriveImage) -> bool:
        tiles = self._pyramids[one]
        return tiles is None or tiles.is_ready

    def _by_distance(self) -> list[DriveImage]:
        return sorted(self._drives, key=lambda one: _distance_m(one[0], self._eye))


def _open_pyramid(drive: Drive, kind: ImageKind) -> TilePyramid | None:
    try:
        pyramid = image_of(drive, kind).pyramid
        pyramid.sketch()
    except UserError:
        return None  # the image view says why; here the drive's points are just not there
    return pyramid


def _distance_m(drive: Drive, position: NDArray[np.float64]) -> float:
    low, high = np.array(drive.info.lowest), np.array(drive.info.highest)
    return float(np.linalg.norm(np.maximum(0.0, np.maximum(low - position, position - high))))

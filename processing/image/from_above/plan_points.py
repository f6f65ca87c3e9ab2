"""Which measured point one sees from above at a place, among all points of the recordings."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.image.images_of_drives import image_of
from processing.image.tiles.tile_kernels import COUNT, HIGHEST, LOWEST
from processing.image.tiles.tiles import TileKey
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind

_MOST_REMEMBERED = 48
"""Tiles whose points are kept: more than a view shows at a time."""

_SURFACE_M = 0.1
"""What lies no deeper below the highest point, m, is the same surface, which scatters. As in
`ray_hits`."""


@dataclass(frozen=True)
class PointQuery:
    """Where a point is looked for.

    Attributes
    ----------
    easting, northing : float
        m, project CRS.
    close_m : float
        As far from there one sees what is highest.
    reach_m : float
        As far the nearest point counts when nothing is close.
    ceiling_m : float
        Height above which points are hidden; infinite without a limit.
    """

    easting: float
    northing: float
    close_m: float
    reach_m: float
    ceiling_m: float = np.inf


@dataclass(frozen=True)
class _TilePoints:
    points: Integers
    xyz: Floats


class PlanPoints:
    """Looks points up in the finest tiles; remembers those it read last.

    Parameters
    ----------
    drives : sequence of (Drive, ImageKind)
        With the image whose tiles are searched.
    hides_noise : bool
        Points whose class is noise are not found.
    """

    def __init__(
        self, drives: Sequence[tuple[Drive, ImageKind]], *, hides_noise: bool = False
    ) -> None:
        self._drives = tuple(drives)
        self._hides_noise = hides_noise
        self._read: OrderedDict[tuple[int, TileKey], _TilePoints] = OrderedDict()

    def point_at(self, sought: PointQuery) -> tuple[Drive, int] | None:
        """The drive and the point that is seen; None where nothing is in reach."""
        found: list[tuple[Drive, Integers, Floats, Floats]] = []
        for number, key in self._tiles_at(sought):
            tile = self._points_of(number, key)
            away = np.hypot(tile.xyz[:, 0] - sought.easting, tile.xyz[:, 1] - sought.northing)
            near = np.flatnonzero((away <= sought.reach_m) & (tile.xyz[:, 2] <= sought.ceiling_m))
            if near.size:
                drive = self._drives[number][0]
                found.append((drive, tile.points[near], away[near], tile.xyz[near, 2]))
        if not found:
            return None
        away = np.concatenate([one[2] for one in found])
        heights = np.concatenate([one[3] for one in found])
        best = _find_seen_point(away, heights, sought.close_m)
        for drive, points, *_ in found:
            if best < points.size:
                return drive, int(points[best])
            best -= points.size
        return None

    def _tiles_at(self, sought: PointQuery) -> Iterator[tuple[int, TileKey]]:
        position = np.array([sought.easting, sought.northing])
        for number, (drive, kind) in enumerate(self._drives):
            pyramid = image_of(drive, kind).pyramid
            if not pyramid.is_ready:  # reading its table would take too long for a click
                continue
            rows, columns = pyramid.shape(0)
            table = pyramid.table[: rows * columns]
            low, high = table[:, LOWEST][:, :2], table[:, HIGHEST][:, :2]
            is_there = (low <= position + sought.reach_m) & (high >= position - sought.reach_m)
            lowest = table[:, LOWEST][:, 2]
            holds = is_there.all(axis=1) & (table[:, COUNT] > 0) & (lowest <= sought.ceiling_m)
            for tile in np.flatnonzero(holds).tolist():
                yield number, TileKey(0, *divmod(tile, columns))

    def _points_of(self, number: int, key: TileKey) -> _TilePoints:
        there = self._read.pop((number, key), None)
        if there is None:
            drive, kind = self._drives[number]
            classes = class_columns(drive.columns) if self._hides_noise else None
            points = image_of(drive, kind).pyramid.points(key, without_noise=classes).ravel()
            points = points[points >= 0]
            there = _TilePoints(points, drive.xyz(points))
        self._read[number, key] = there
        while len(self._read) > _MOST_REMEMBERED:
            self._read.popitem(last=False)
        return there


def _find_seen_point(away: Floats, heights: Floats, close_m: float) -> int:
    """Of the highest surface that is close the nearest point, or else simply the nearest."""
    close = np.flatnonzero(away <= close_m)
    if not close.size:
        return int(away.argmin())
    surface = close[heights[close] >= heights[close].max() - _SURFACE_M]
    return int(surface[away[surface].argmin()])

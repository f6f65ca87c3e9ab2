"""PlanTiles: tiles of points as they come from the cache, with their places remembered."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UserError
from processing.image.attributes.tile_cache import TileCache, TilePixels, TileRequest
from processing.image.images_of_drives import image_of
from processing.recording.drive import Drive

_KEPT_POINTS = 5_000_000


class OutdatedRequest(Exception):
    """Another wish has come, or the view goes away."""


@dataclass(frozen=True, eq=False)
class WantedTile:
    """A tile as it is to be shown.

    Attributes
    ----------
    number : int
        Of the drive among those of the request.
    """

    number: int
    drive: Drive
    request: TileRequest


@dataclass(frozen=True, eq=False)
class TilePoints:
    """The points of a tile.

    Attributes
    ----------
    number : int
        Of the drive among those of the request.
    points : (n,) int64
    local_xyz : (n, 3) float32
        m from the origin.
    colours : (n, 3) uint8
    spacing_m : float
        Mean distance of neighbours.
    """

    number: int
    points: NDArray[np.int64]
    local_xyz: NDArray[np.float32]
    colours: NDArray[np.uint8]
    spacing_m: float


@dataclass(frozen=True, eq=False)
class _Placed:
    points: NDArray[np.int64]
    local_xyz: NDArray[np.float32]


class PlanTiles:
    """Gets tiles for one worker.

    Parameters
    ----------
    tiles : TileCache
    changed : threading.Condition
        Told when a tile has come; what `is_outdated` says is changed under it.
    is_outdated : callable
        Whether the worker has something else to do.
    """

    def __init__(
        self, tiles: TileCache, changed: threading.Condition, is_outdated: Callable[[], bool]
    ) -> None:
        self._tiles = tiles
        self._changed = changed
        self._is_outdated = is_outdated
        self._arrived: dict[TileRequest, TilePixels | None] = {}
        self._positions: OrderedDict[TileRequest, _Placed] = OrderedDict()
        self._kept_points = 0

    def forget(self) -> None:
        """The drives or the origin are others."""
        self._positions.clear()
        self._kept_points = 0

    def close(self) -> None:
        """Ask for nothing any more."""
        self._tiles.keep_only(self._on_tiles_done, ())

    def get(
        self, wanted: list[WantedTile], origin: NDArray[np.float64], *, is_patient: bool
    ) -> Iterator[TilePoints]:
        """Tiles as they come; those that are there already first.

        Parameters
        ----------
        origin : (3,) float64
            m, project CRS.
        is_patient : bool
            Give the tiles that are there even when the request is outdated: while the wheel turns,
            something is shown all the same.

        Raises
        ------
        OutdatedRequest
        """
        lacking = []
        for tile in wanted:
            pixels = self._tiles.get(tile.request)
            if pixels is None:
                lacking.append(tile)
                continue
            if not is_patient:
                self._give_way()
            yield self._points_of(tile, pixels, origin)
        self._ask_for(lacking)
        waited = {tile.request: tile for tile in lacking}
        while waited:
            self._drop_refused(waited)
            for request, pixels in self._next_arrived(waited).items():
                arrived = waited.pop(request, None)
                if arrived is not None and pixels is not None:
                    yield self._points_of(arrived, pixels, origin)

    def _ask_for(self, lacking: list[WantedTile]) -> None:
        with self._changed:
            self._arrived.clear()
        self._tiles.keep_only(self._on_tiles_done, {tile.request for tile in lacking})
        # The cache serves the newest request first, and coarse tiles are to come first.
        for tile in reversed(lacking):
            self._tiles.request(tile.request, self._on_tiles_done, self._on_tiles_refused)

    def _drop_refused(self, waited: dict[TileRequest, WantedTile]) -> None:
        """None of a drive's tiles come once it was refused."""
        drives = {(request.drive_id, request.attribute) for request in waited}
        refused = {one for one in drives if self._tiles.refusal(*one) is not None}
        for request in [one for one in waited if (one.drive_id, one.attribute) in refused]:
            del waited[request]

    def _next_arrived(
        self, waited: dict[TileRequest, WantedTile]
    ) -> dict[TileRequest, TilePixels | None]:
        with self._changed:
            while waited and not self._arrived and not self._is_outdated():
                self._changed.wait()
            arrived, self._arrived = self._arrived, {}
        self._give_way()
        return arrived

    def _give_way(self) -> None:
        with self._changed:
            if self._is_outdated():
                raise OutdatedRequest

    def _points_of(
        self, tile: WantedTile, pixels: TilePixels, origin: NDArray[np.float64]
    ) -> TilePoints:
        points = pixels.points.ravel()
        is_filled = points >= 0
        points = points[is_filled]
        key = replace(tile.request, attribute="", low_percent=0.0, high_percent=0.0)
        placed = self._positions.pop(key, None)
        # Where noise is hidden, a label changes which points there are.
        if placed is not None and not np.array_equal(placed.points, points):
            self._kept_points -= len(placed.points)
            placed = None
        if placed is None:
            placed = _Placed(points, tile.drive.local_xyz(points, origin))
            self._kept_points += len(points)
        self._positions[key] = placed
        while self._kept_points > _KEPT_POINTS and len(self._positions) > 1:
            _, dropped = self._positions.popitem(last=False)
            self._kept_points -= len(dropped.points)
        spacing_m = image_of(tile.drive, tile.request.kind).pyramid.spacing_m(tile.request.key)
        colours = pixels.colours.reshape(-1, 3)[is_filled]
        return TilePoints(tile.number, points, placed.local_xyz, colours, spacing_m)

    def _on_tiles_done(self, request: TileRequest, pixels: TilePixels) -> None:
        if not self._tiles.is_current(request, pixels):
            self._tiles.request(request, self._on_tiles_done, self._on_tiles_refused)
            return
        with self._changed:
            self._arrived[request] = pixels
            self._changed.notify_all()

    def _on_tiles_refused(self, request: TileRequest, error: UserError) -> None:  # noqa: ARG002
        with self._changed:
            self._arrived[request] = None
            self._changed.notify_all()

"""PlanFeed: makes pictures of the points from above beside the window's thread."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QObject, Signal

from processing.core.arrays import Floats
from processing.core.errors import UserError
from processing.image.attributes.tile_cache import TileCache, TileRequest
from processing.image.from_above.plan_ground import ceilings_above, ground_along
from processing.image.from_above.plan_raster import (
    PlanFrame,
    PlanRaster,
    PlanSnapshot,
    square_middles,
)
from processing.image.images_of_drives import image_of
from processing.image.search.tile_choice import Camera3D, tiles_in_view
from processing.image.tiles.tiles import TileKey, TilePyramid
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.map_view.plan_tiles import OutdatedRequest, PlanTiles, TilePoints, WantedTile
from widgets.shared.view_settings import PointStyle

_FIRST_BUDGET, _FULL_BUDGET = 300_000, 3_000_000
_OVERVIEW_BUDGET, _OVERVIEW_PX = 1_000_000, 1_200
_EYE_M = 20_000.0
_TOLD_S = 0.15
_MOST_GROWN = 2.0


@dataclass(frozen=True)
class PlanRequest:
    """What the view wants to see.

    Attributes
    ----------
    everything : PlanFrame
        The whole recording, at any scale.
    drives : tuple of (Drive, ImageKind)
        With the kind of image whose tiles are drawn.
    origin : (3,) float64
        The document's local origin, m, project CRS.
    age : int
        Raised with every change of drives; told back.
    look : PointStyle
    size_px : int
        Side of the square that a point covers, pixels of the frame.
    limit_m : float or None
        Points higher above the road are hidden.
    """

    frame: PlanFrame
    everything: PlanFrame
    drives: tuple[tuple[Drive, ImageKind], ...]
    origin: Floats
    age: int
    look: PointStyle
    size_px: int
    limit_m: float | None

    @property
    def manner(self) -> tuple[object, ...]:
        """What the same pictures of the whole recording come from."""
        return self.age, self.look, self.size_px, self.limit_m, self.everything


@dataclass(frozen=True, eq=False)
class ShownPlan:
    """A picture for a request.

    Attributes
    ----------
    is_sharp : bool
        Nothing finer will come.
    is_overview : bool
        It is of the whole recording, whatever was wished.
    ground : (m, 3) float64
        Places of the road, m, project CRS; may be empty.
    """

    request: PlanRequest
    picture: PlanSnapshot
    ground: Floats
    is_sharp: bool
    is_overview: bool = False

    def ceiling_at(self, easting: float, northing: float) -> float:
        """The height above which points are hidden at a place, m; infinite without a limit."""
        if self.request.limit_m is None or not len(self.ground):
            return np.inf
        position = np.array([easting, northing])
        return float(ceilings_above(self.ground, position, self.request.limit_m))


class PlanFeed(QObject):
    """Works out requests one after the other; the newest is the one that counts.

    Signals
    -------
    pictured(shown: ShownPlan)
        Sent from another thread, so received through the window's event queue.
    """

    pictured = Signal(object)

    def __init__(self, tiles: TileCache) -> None:
        super().__init__()
        self._changed = threading.Condition()
        self._next: PlanRequest | None = None
        self._is_closed = False
        self._tiles = PlanTiles(tiles, self._changed, self._is_outdated)
        self._ground: tuple[int, Floats] = -1, np.empty((0, 3))
        self._overview: tuple[object, ...] = ()
        self._worker = threading.Thread(target=self._work, name="plan pictures", daemon=True)
        self._worker.start()

    def request(self, request: PlanRequest) -> None:
        """Ask for what is to be seen now; replaces what was asked for and isn't finished."""
        with self._changed:
            self._next = request
            self._changed.notify_all()

    def close(self) -> None:
        """Stop the worker and wait for it; nothing is told afterwards."""
        with self._changed:
            self._is_closed = True
            self._next = None
            self._changed.notify_all()
        self._worker.join()
        self._tiles.close()

    def _work(self) -> None:
        while True:
            with self._changed:
                while self._next is None and not self._is_closed:
                    self._changed.wait()
                if self._is_closed or self._next is None:
                    return
                request, self._next = self._next, None
            try:
                self._fulfil(request)
            except OutdatedRequest:
                continue

    def _is_outdated(self) -> bool:
        return self._is_closed or self._next is not None

    def _fulfil(self, request: PlanRequest) -> None:
        pyramids = self._prepare_tiles(request)
        raster = self._raster(request, request.frame)
        added: set[tuple[int, TileKey]] = set()
        for budget in (_FIRST_BUDGET, _FULL_BUDGET):
            is_first = budget == _FIRST_BUDGET
            chosen = _choose_tiles(pyramids, _camera(request.frame, request), budget)
            lacking = [_make_wanted(request, *tile) for tile in chosen if tile not in added]
            told_at = time.monotonic()
            for tile in self._tiles.get(lacking, request.origin, is_patient=is_first):
                _add(raster, request, tile)
                if time.monotonic() - told_at > _TOLD_S:
                    self._report(
                        ShownPlan(request, raster.picture(), self._ground[1], is_sharp=False)
                    )
                    told_at = time.monotonic()
            added.update(chosen)
            self._report(
                ShownPlan(request, raster.picture(), self._ground[1], is_sharp=not is_first)
            )
        self._make_overview(request, pyramids)
        self._make_exact(request, [pyramid for _, pyramid in pyramids if not pyramid.is_ready])

    def _make_exact(self, request: PlanRequest, sketched: list[TilePyramid]) -> None:
        """Work out where tiles are that was only sketched, and show what is changed by that."""
        frame = request.frame
        middle = (frame.west + frame.east) / 2, (frame.south + frame.north) / 2
        for pyramid in sketched:
            while not pyramid.extend(np.array([*middle, request.origin[2]])):
                if self._is_outdated():
                    return
        if sketched:
            self._overview = ()
            self._fulfil(request)

    def _make_overview(self, request: PlanRequest, pyramids: list[tuple[int, TilePyramid]]) -> None:
        """What is shown where a push or a zoom is ahead of the pictures."""
        if request.manner == self._overview:
            return
        raster = self._raster(request, request.everything)
        chosen = _choose_tiles(pyramids, _camera(request.everything, request), _OVERVIEW_BUDGET)
        wanted = [_make_wanted(request, *tile) for tile in chosen]
        for tile in self._tiles.get(wanted, request.origin, is_patient=False):
            _add(raster, request, tile)
        picture = raster.picture()
        self._report(ShownPlan(request, picture, self._ground[1], is_sharp=True, is_overview=True))
        self._overview = request.manner

    def _prepare_tiles(self, request: PlanRequest) -> list[tuple[int, TilePyramid]]:
        """Drives' numbers and the tiles of those that can be shown."""
        pyramids = []
        for number, (drive, kind) in enumerate(request.drives):
            try:
                pyramid = image_of(drive, kind).pyramid
                pyramid.sketch()
            except UserError:
                continue  # the image view says why; here the drive's points are just not there
            pyramids.append((number, pyramid))
        return pyramids

    def _raster(self, request: PlanRequest, frame: PlanFrame) -> PlanRaster:
        ground = self._ground_of(request)
        if request.limit_m is None or not len(ground):
            return PlanRaster(frame, request.origin)
        ceilings = ceilings_above(ground, square_middles(frame), request.limit_m)
        return PlanRaster(frame, request.origin, ceilings)

    def _ground_of(self, request: PlanRequest) -> Floats:
        age, ground = self._ground
        if age != request.age:
            found = []
            for drive, _ in request.drives:
                try:
                    found.append(ground_along(drive))
                except UserError:
                    continue  # the image view says why; there is no limit then
            ground = np.concatenate([np.empty((0, 3)), *found])
            self._ground = request.age, ground
            self._tiles.forget()
        return ground

    def _report(self, shown: ShownPlan) -> None:
        if not self._is_closed:
            self.pictured.emit(shown)


def whole_frame(low: Floats, high: Floats) -> PlanFrame:
    """A frame of everything between two places, (2,) easting and northing, m."""
    size = np.maximum(high - low, 1.0)
    px_per_m = _OVERVIEW_PX / float(size.max())
    width, height = np.maximum(np.ceil(size * px_per_m), 1).astype(int).tolist()
    return PlanFrame(float(low[0]), float(high[1]), px_per_m, width, height)


def _camera(frame: PlanFrame, request: PlanRequest) -> Camera3D:
    """Looking straight down; points that cover several pixels need not lie so close."""
    origin = request.origin.tolist()
    east, north = (frame.west + frame.east) / 2, (frame.south + frame.north) / 2
    gap_px = max(1.0, request.size_px / 2)
    return Camera3D(
        origin=(origin[0], origin[1], origin[2]),
        position=(east - origin[0], north - origin[1], _EYE_M),
        direction=(0.0, 0.0, -1.0),
        up=(0.0, 1.0, 0.0),
        width_px=max(1, round(frame.width / gap_px)),
        height_px=max(1, round(frame.height / gap_px)),
        parallel_height_m=frame.north - frame.south,
    )


def _choose_tiles(
    pyramids: list[tuple[int, TilePyramid]], camera: Camera3D, budget_points: int
) -> list[tuple[int, TileKey]]:
    """Drives' numbers and tiles, coarse ones first."""
    found = tiles_in_view([pyramid for _, pyramid in pyramids], camera, budget_points)
    return [(pyramids[index][0], key) for index, key in found]


def _make_wanted(request: PlanRequest, number: int, key: TileKey) -> WantedTile:
    drive, kind = request.drives[number]
    look = request.look
    ends = look.low_percent, look.high_percent
    tile_request = TileRequest(
        drive.id, kind, key, look.attribute, *ends, hides_noise=look.hides_noise
    )
    return WantedTile(number, drive, tile_request)


def _add(raster: PlanRaster, request: PlanRequest, tile: TilePoints) -> None:
    # Where points lie wider apart than their size, larger ones close the surface.
    gap_px = round(tile.spacing_m * raster.frame.px_per_m)
    size_px = min(max(gap_px, request.size_px), round(_MOST_GROWN * request.size_px))
    raster.add(tile.number, tile.points, tile.local_xyz, tile.colours, size_px=size_px)

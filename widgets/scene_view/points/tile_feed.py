"""TileFeed: chooses tiles and gets their points beside the window's thread."""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from processing.core.errors import UserError
from processing.image.attributes.attributes import colours, most_telling_attribute
from processing.image.attributes.tile_cache import TileCache, TilePixels, TileRequest
from processing.image.images_of_drives import image_of
from processing.image.search.tile_choice import Camera3D, tiles_in_view
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.scene_view.points.tile_survey import TileSurvey
from widgets.scene_view.rendering.scene_tile import SceneTile, TileAppearance, TileId
from widgets.shared.view_settings import PointStyle

_TOGETHER_S = 0.15
"""Tiles that were coloured within this time are told together, since each telling is a frame."""

_SURVEYED_S = 0.5
_PAUSE_S = 0.05


@dataclass(frozen=True)
class SceneRequest:
    """What the view wants to see.

    Attributes
    ----------
    drives : tuple of (Drive, ImageKind)
        With the kind of image whose tiles are drawn.
    origin : (3,) float64
        The view's local origin, m, project CRS.
    age : int
        Raised with every change of drives and origin; told back with the tiles.
    showing : TileAppearance
    budget_points : int
    is_still : bool
        Whether the camera rests; told back with the choice.
    kept : frozenset of TileId
        Tiles outside the choice that are to show the same.
    there : mapping of TileId to SceneTile
        What the view has.
    known : frozenset of (TileId, TileAppearance)
        What each of them shows.
    """

    drives: tuple[tuple[Drive, ImageKind], ...]
    origin: NDArray[np.float64]
    age: int
    camera: Camera3D
    showing: TileAppearance
    budget_points: int
    is_still: bool
    kept: frozenset[TileId]
    there: Mapping[TileId, SceneTile]
    known: frozenset[tuple[TileId, TileAppearance]]


@dataclass(frozen=True)
class TileSelection:
    """The tiles to draw for a request.

    Attributes
    ----------
    is_final : bool
        Whether the places of these tiles are known exactly, so that the choice stays.
    """

    request: SceneRequest
    tiles: tuple[TileId, ...]
    is_final: bool


class TileFeed(QObject):
    """Works out requests one after the other; the newest is the one that counts.

    It has no parent: a loader may be telling it of a tile while the view goes away.

    Signals
    -------
    chosen(choice: Choice), arrived(tiles: tuple[SceneTile, ...])
    surveyed()
        More is known of where tiles are: another choice may be better.

        Sent from other threads, so received through the window's event queue.
    """

    chosen = Signal(object)
    arrived = Signal(object)
    surveyed = Signal()

    def __init__(self, tiles: TileCache) -> None:
        super().__init__()
        self._tiles = tiles
        self._changed = threading.Condition()
        self._next: SceneRequest | None = None
        self._current: SceneRequest | None = None
        self._is_closed = False
        self._survey = TileSurvey()
        self._told_at = 0.0
        self._worker = threading.Thread(target=self._work, name="scene tiles", daemon=True)
        self._worker.start()

    def request(self, request: SceneRequest) -> None:
        """Ask for what is to be seen now; replaces what was asked for and isn't begun."""
        with self._changed:
            self._next = request
            self._changed.notify()

    def close(self) -> None:
        """Stop the worker and wait for it; nothing is told afterwards."""
        with self._changed:
            self._is_closed = True
            self._next = None
            self._changed.notify()
        self._worker.join()
        self._survey.close()
        self._tiles.keep_only(self._on_tiles_done, ())

    def _work(self) -> None:
        while True:
            with self._changed:
                while self._next is None and not self._is_closed and self._survey.is_finished:
                    self._changed.wait()
                if self._next is None and self._current is not None and not self._current.is_still:
                    self._changed.wait(_PAUSE_S)  # who moves needs the time for frames
                if self._is_closed:
                    return
                request, self._next = self._next, None
                self._current = request or self._current
            if request is not None:
                self._survey.use(request.drives, request.camera)
                self._fulfil(request)
            elif self._survey.go_on() or time.monotonic() - self._told_at > _SURVEYED_S:
                self._told_at = time.monotonic()
                self._emit_surveyed()

    def _fulfil(self, request: SceneRequest) -> None:
        surveyed = self._survey.opened
        pyramids = [pyramid for _, pyramid in surveyed]
        found = tiles_in_view(
            pyramids, request.camera, request.budget_points, clip=request.showing.clip, has_all=True
        )
        chosen = tuple(TileId(*surveyed[number][0], key) for number, key in found)
        is_final = self._survey.has_opened_all and all(
            pyramids[number].is_exact(key) for number, key in found
        )
        self._emit_chosen(TileSelection(request, chosen, is_final))
        wanted = [*chosen, *sorted(request.kept - set(chosen), key=lambda tile: tile.key.rank)]
        lacking = [tile for tile in wanted if (tile, request.showing) not in request.known]
        # Those whose points stay need only other colours.
        staying = _with_their_points(request)
        self._show_anew([request.there[tile] for tile in lacking if tile in staying], request)
        look = request.showing.look
        requests = [_request_of(tile, look) for tile in lacking if tile not in staying]
        self._tiles.keep_only(self._on_tiles_done, set(requests))
        # The cache serves the newest request first, and coarse tiles are to come first.
        for tile_request in reversed(requests):
            if self._is_outdated(request):
                return
            self._tiles.request(tile_request, self._on_tiles_done)

    def _show_anew(self, tiles: Sequence[SceneTile], request: SceneRequest) -> None:
        """Clip and colour tiles that are there: their points need not be looked up again."""
        drives = {drive.id: drive for drive, _ in request.drives}
        known, done, began_at = dict(request.known), [], time.monotonic()
        for tile in tiles:
            drive = drives.get(tile.id.drive_id)
            if drive is None or self._is_outdated(request):
                break
            shown = tile
            if known.get(tile.id) != replace(request.showing, clip=tile.clip):
                try:
                    shown = _colour_tile(tile, drive, request.showing.look)
                except UserError:
                    continue  # the image view says why; the points keep the colours they have
            done.append(
                replace(shown, age=request.age).clipped(request.showing.clip, request.origin)
            )
            if time.monotonic() - began_at > _TOGETHER_S:
                self._emit_arrived(done)
                done, began_at = [], time.monotonic()
        self._emit_arrived(done)

    def _emit_arrived(self, tiles: Sequence[SceneTile]) -> None:
        if tiles and not self._is_closed:
            self.arrived.emit(tuple(tiles))

    def _emit_surveyed(self) -> None:
        if not self._is_closed:
            self.surveyed.emit()

    def _is_outdated(self, request: SceneRequest) -> bool:
        with self._changed:
            return self._is_closed or (
                self._next is not None and self._next.showing != request.showing
            )

    def _emit_chosen(self, choice: TileSelection) -> None:
        if not self._is_closed:
            self.chosen.emit(choice)

    def _on_tiles_done(self, tile_request: TileRequest, pixels: TilePixels) -> None:
        request = self._current
        if self._is_closed or request is None:
            return
        drive = next(
            (drive for drive, _ in request.drives if drive.id == tile_request.drive_id), None
        )
        if drive is None:
            return
        if not self._tiles.is_current(tile_request, pixels):  # for the request that was read before
            self._tiles.request(tile_request, self._on_tiles_done)
            return
        points = pixels.points.ravel()
        is_filled = points >= 0
        filled = points[is_filled]
        tile = SceneTile(
            request=tile_request,
            points=filled,
            local_xyz=drive.local_xyz(filled, request.origin),
            colours=pixels.colours.reshape(-1, 3)[is_filled],
            spacing_m=image_of(drive, tile_request.kind).pyramid.spacing_m(tile_request.key),
            age=request.age,
        )
        self._emit_arrived((tile.clipped(request.showing.clip, request.origin),))


def _with_their_points(request: SceneRequest) -> frozenset[TileId]:
    """The tiles that are there with the points that are wished for, whatever their colours.

    Where noise is hidden, tiles of which nothing is known any more may hold others.
    """
    hides_noise, known = request.showing.look.hides_noise, {tile for tile, _ in request.known}
    return frozenset(
        tile
        for tile, there in request.there.items()
        if there.request.hides_noise is hides_noise and (tile in known or not hides_noise)
    )


def _colour_tile(tile: SceneTile, drive: Drive, look: PointStyle) -> SceneTile:
    """The tile before it was clipped, in other colours."""
    whole = tile if tile.whole is None else tile.whole
    attribute = most_telling_attribute(drive, look.attribute)
    shown = colours(drive, whole.points, attribute, look.low_percent, look.high_percent)
    return replace(whole, request=_request_of(tile.id, look), colours=shown)


def _request_of(tile: TileId, look: PointStyle) -> TileRequest:
    ends = look.low_percent, look.high_percent
    return TileRequest(
        tile.drive_id, tile.kind, tile.key, look.attribute, *ends, hides_noise=look.hides_noise
    )

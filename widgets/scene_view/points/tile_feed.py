"""TileFeed: chooses tiles and gets their points beside the window's thread."""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from processing.errors import UserError
from processing.image.attributes import colours, telling_attribute
from processing.image.images_of_drives import image_of
from processing.image.kinds import ImageKind
from processing.image.tile_cache import TileCache, TilePixels, TileRequest
from processing.image.tile_choice import Camera3D, tiles_in_view
from processing.points.drive import Drive
from widgets.scene_view.points.scene_tile import SceneTile, Showing, TileId
from widgets.scene_view.points.tile_survey import TileSurvey
from widgets.shared.view_settings import PointLook

_TOGETHER_S = 0.15
"""Tiles that were coloured within this time are told together, since each telling is a frame."""

_SURVEYED_S = 0.5
_PAUSE_S = 0.05


@dataclass(frozen=True)
class Wish:
    """What the view wants to see.

    Attributes
    ----------
    drives : tuple of (Drive, ImageKind)
        With the kind of image whose tiles are drawn.
    origin : (3,) float64
        The view's local origin, m, project CRS.
    age : int
        Raised with every change of drives and origin; told back with the tiles.
    showing : Showing
    budget_points : int
    is_still : bool
        Whether the camera rests; told back with the choice.
    kept : frozenset of TileId
        Tiles outside the choice that are to show the same.
    there : mapping of TileId to SceneTile
        What the view has.
    known : frozenset of (TileId, Showing)
        What each of them shows.
    """

    drives: tuple[tuple[Drive, ImageKind], ...]
    origin: NDArray[np.float64]
    age: int
    camera: Camera3D
    showing: Showing
    budget_points: int
    is_still: bool
    kept: frozenset[TileId]
    there: Mapping[TileId, SceneTile]
    known: frozenset[tuple[TileId, Showing]]


@dataclass(frozen=True)
class Choice:
    """The tiles to draw for a wish.

    Attributes
    ----------
    is_final : bool
        Whether the places of these tiles are known exactly, so that the choice stays.
    """

    wish: Wish
    tiles: tuple[TileId, ...]
    is_final: bool


class TileFeed(QObject):
    """Works out wishes one after the other; the newest is the one that counts.

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
        self._next: Wish | None = None
        self._current: Wish | None = None
        self._is_closed = False
        self._survey = TileSurvey()
        self._told_at = 0.0
        self._worker = threading.Thread(target=self._work, name="scene tiles", daemon=True)
        self._worker.start()

    def wish(self, wish: Wish) -> None:
        """Ask for what is to be seen now; replaces what was asked for and isn't begun."""
        with self._changed:
            self._next = wish
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
                wish, self._next = self._next, None
                self._current = wish or self._current
            if wish is not None:
                self._survey.use(wish.drives, wish.camera)
                self._fulfil(wish)
            elif self._survey.go_on() or time.monotonic() - self._told_at > _SURVEYED_S:
                self._told_at = time.monotonic()
                self._emit_surveyed()

    def _fulfil(self, wish: Wish) -> None:
        surveyed = self._survey.opened
        pyramids = [pyramid for _, pyramid in surveyed]
        found = tiles_in_view(
            pyramids, wish.camera, wish.budget_points, clip=wish.showing.clip, has_all=True
        )
        chosen = tuple(TileId(*surveyed[number][0], key) for number, key in found)
        is_final = self._survey.has_opened_all and all(
            pyramids[number].is_exact(key) for number, key in found
        )
        self._emit_chosen(Choice(wish, chosen, is_final))
        wanted = [*chosen, *sorted(wish.kept - set(chosen), key=lambda tile: tile.key.rank)]
        lacking = [tile for tile in wanted if (tile, wish.showing) not in wish.known]
        # Those whose points stay need only other colours.
        staying = _with_their_points(wish)
        self._show_anew([wish.there[tile] for tile in lacking if tile in staying], wish)
        look = wish.showing.look
        requests = [_request_of(tile, look) for tile in lacking if tile not in staying]
        self._tiles.keep_only(self._on_tiles_done, set(requests))
        # The cache serves the newest request first, and coarse tiles are to come first.
        for request in reversed(requests):
            if self._is_outdated(wish):
                return
            self._tiles.request(request, self._on_tiles_done)

    def _show_anew(self, tiles: Sequence[SceneTile], wish: Wish) -> None:
        """Clip and colour tiles that are there: their points need not be looked up again."""
        drives = {drive.id: drive for drive, _ in wish.drives}
        known, done, began_at = dict(wish.known), [], time.monotonic()
        for tile in tiles:
            drive = drives.get(tile.id.drive_id)
            if drive is None or self._is_outdated(wish):
                break
            shown = tile
            if known.get(tile.id) != replace(wish.showing, clip=tile.clip):
                try:
                    shown = _coloured(tile, drive, wish.showing.look)
                except UserError:
                    continue  # the image view says why; the points keep the colours they have
            done.append(replace(shown, age=wish.age).clipped(wish.showing.clip, wish.origin))
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

    def _is_outdated(self, wish: Wish) -> bool:
        with self._changed:
            return self._is_closed or (
                self._next is not None and self._next.showing != wish.showing
            )

    def _emit_chosen(self, choice: Choice) -> None:
        if not self._is_closed:
            self.chosen.emit(choice)

    def _on_tiles_done(self, request: TileRequest, pixels: TilePixels) -> None:
        wish = self._current
        if self._is_closed or wish is None:
            return
        drive = next((drive for drive, _ in wish.drives if drive.id == request.drive_id), None)
        if drive is None:
            return
        if not self._tiles.is_current(request, pixels):  # for the wish that was read before
            self._tiles.request(request, self._on_tiles_done)
            return
        points = pixels.points.ravel()
        is_filled = points >= 0
        filled = points[is_filled]
        tile = SceneTile(
            request=request,
            points=filled,
            local_xyz=drive.local_xyz(filled, wish.origin),
            colours=pixels.colours.reshape(-1, 3)[is_filled],
            spacing_m=image_of(drive, request.kind).pyramid.spacing_m(request.key),
            age=wish.age,
        )
        self._emit_arrived((tile.clipped(wish.showing.clip, wish.origin),))


def _with_their_points(wish: Wish) -> frozenset[TileId]:
    """The tiles that are there with the points that are wished for, whatever their colours.

    Where noise is hidden, tiles of which nothing is known any more may hold others.
    """
    hides_noise, known = wish.showing.look.hides_noise, {tile for tile, _ in wish.known}
    return frozenset(
        tile
        for tile, there in wish.there.items()
        if there.request.hides_noise is hides_noise and (tile in known or not hides_noise)
    )


def _coloured(tile: SceneTile, drive: Drive, look: PointLook) -> SceneTile:
    """The tile before it was clipped, in other colours."""
    whole = tile if tile.whole is None else tile.whole
    attribute = telling_attribute(drive, look.attribute)
    shown = colours(drive, whole.points, attribute, look.low_percent, look.high_percent)
    return replace(whole, request=_request_of(tile.id, look), colours=shown)


def _request_of(tile: TileId, look: PointLook) -> TileRequest:
    ends = look.low_percent, look.high_percent
    return TileRequest(
        tile.drive_id, tile.kind, tile.key, look.attribute, *ends, hides_noise=look.hides_noise
    )

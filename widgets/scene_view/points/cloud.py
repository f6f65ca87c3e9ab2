"""PointCloudLayer: which points are in the scene, coarse while the camera moves, sharp at rest."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, QTimer, Signal

from processing.core.arrays import Floats
from processing.image.attributes.attributes import SHOWS_INTENSITY
from processing.image.attributes.tile_cache import TileCache
from processing.image.images_of_drives import image_of
from processing.image.search.clip import Clip
from processing.image.search.tile_choice import Camera3D
from processing.image.search.touched_tiles import TouchedTiles
from processing.image.tiles.tiles import TileKey
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.feature_drawing.feature_style import ACCENT
from widgets.scene_view.points.budget import FrameBudget
from widgets.scene_view.points.tile_feed import SceneRequest, TileFeed, TileSelection
from widgets.scene_view.rendering.scene_renderer import SceneRenderer
from widgets.scene_view.rendering.scene_tile import (
    DrawnTile,
    SceneTile,
    TileAppearance,
    TileId,
    shown_tiles,
)
from widgets.shared.view_settings import PointStyle

REST_MS = 200
_LEAST_MARK_MS, _FRAMES_BETWEEN_MARKS = 20, 3.0
_POINTS_PER_PORTION = 150_000
_LIFTED: Final = np.asarray(255 * (np.arange(256) / 255) ** 0.55, np.uint8)
"""Greys of intensity, as they are drawn: against the dark behind them asphalt would be black."""


class PointCloudLayer(QObject):
    """Keeps two sets of tiles: one small enough to move, one that is sharp.

    Parameters
    ----------
    scene_renderer : SceneRenderer
    tiles : TileCache

    Signals
    -------
    changed()
        Other points are in the scene, or the shading is another.
    settled()
        The camera rests, and all that it sees is in the scene in its sharpest form.
    """

    changed = Signal()
    settled = Signal()

    def __init__(
        self, scene_renderer: SceneRenderer, tiles: TileCache, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.budget = FrameBudget()
        self._scene_renderer = scene_renderer
        self._feed = TileFeed(tiles)
        self._feed.chosen.connect(self._on_feed_chosen)
        self._feed.arrived.connect(self._on_feed_arrived)
        self._feed.surveyed.connect(self._request)
        self._drives: tuple[tuple[Drive, ImageKind], ...] = ()
        self._origin: Floats = np.zeros(3)
        self._age = 0
        self._camera: Camera3D | None = None
        self._showing = TileAppearance(PointStyle())
        self._marked: dict[str, NDArray[np.int64]] = {}
        self._to_mark: dict[str, NDArray[np.int64]] = {}
        self._frame_s = 0.0
        self._chosen: dict[bool, frozenset[TileId]] = {False: frozenset(), True: frozenset()}
        self._shown: dict[TileId, TileAppearance] = {}
        self._arrived: list[SceneTile] = []
        self._is_moving = False
        self._is_shading_wanted = True
        self._was_changed = True
        self._is_chosen = False
        self._was_settled = False
        self._rest = QTimer(self, singleShot=True, interval=REST_MS)
        self._rest.timeout.connect(self._on_rest_timeout)
        self._portions = QTimer(self, singleShot=True, interval=0)
        self._portions.timeout.connect(self._on_portions_timeout)
        self._marks = QTimer(self, singleShot=True)
        self._marks.timeout.connect(self._on_marks_timeout)

    @property
    def drawn(self) -> tuple[DrawnTile, ...]:
        """The tiles that are drawn."""
        return self._scene_renderer.tiles.shown

    @property
    def is_shading_wanted(self) -> bool:
        """Whether eye-dome lighting is on, at least at rest."""
        return self._is_shading_wanted

    @property
    def is_settled(self) -> bool:
        """Whether the camera rests and all that it sees is there in its sharpest form."""
        there = self._shown
        return (
            not self._is_moving
            and self._is_chosen
            and not self._arrived
            and all(there.get(tile) == self._showing for tile in self._chosen[True])
        )

    def use(self, drives: Sequence[tuple[Drive, ImageKind]], origin: Floats) -> None:
        """Show these drives from now on, by the tiles of these images."""
        self._drives, self._origin = tuple(drives), origin
        self._age += 1
        self._arrived.clear()
        self._shown.clear()
        self._scene_renderer.tiles.keep_only(())
        self._chosen = {False: frozenset(), True: frozenset()}
        self._request_again()
        self._report()

    def look_from(self, camera: Camera3D) -> None:
        """The camera moved."""
        if camera == self._camera:
            return
        self._camera = camera
        if not self._is_moving:
            self._is_moving = True
            self._show()
        self._rest.start()
        self._request()

    def colour(self, look: PointStyle) -> None:
        """Show points in these colours; their size is the stage's matter."""
        self._show_as(replace(self._showing, look=_colours_only(look)))

    def clip_to(self, clip: Clip | None) -> None:
        """Show only points in this part of space; None: all."""
        self._show_as(replace(self._showing, clip=clip))

    def _show_as(self, showing: TileAppearance) -> None:
        if showing != self._showing:
            self._showing = showing
            # No frame now: it would hold up the worker that colours what is there.
            self._request_again()

    def mark(self, points: Mapping[str, NDArray[np.int64]]) -> None:
        """Mark chosen points: drive id to sorted indices; at once, or when frames allow."""
        self._to_mark = dict(points)
        if not self._marks.isActive():
            self._on_marks_timeout()

    def _on_marks_timeout(self) -> None:
        if self._to_mark is self._marked:
            return
        # While points are chosen by dragging, most of the time is left to what is dragged in.
        self._marks.start(max(_LEAST_MARK_MS, round(1e3 * _FRAMES_BETWEEN_MARKS * self._frame_s)))
        before, self._marked = self._marked, self._to_mark
        none = np.empty(0, np.int64)
        touched = {
            drive_id: self._find_touched_tiles(
                drive_id,
                np.setxor1d(
                    before.get(drive_id, none), self._marked.get(drive_id, none), assume_unique=True
                ),
            )
            for drive_id in {*before, *self._marked}
        }
        for tile in self._scene_renderer.tiles.tiles.values():
            if tile.id.key in touched.get(tile.id.drive_id, ()):
                self._scene_renderer.tiles.put(tile, self._colours_of(tile))
        self._report()

    def refresh(self, drive_id: str) -> None:
        """The drive's columns changed: get its colours again."""
        self._shown = {
            tile: shown for tile, shown in self._shown.items() if tile.drive_id != drive_id
        }
        self._request_again()

    def refresh_labels(self, drive_id: str, points: NDArray[np.int64]) -> None:
        """Labels of points changed: get the colours of the tiles that show them again."""
        if self._showing.look.follows_labels:
            touched = self._find_touched_tiles(drive_id, points)
            self._shown = {
                tile: shown
                for tile, shown in self._shown.items()
                if tile.drive_id != drive_id or tile.key not in touched
            }
            self._request_again()

    def set_shading(self, *, is_on: bool) -> None:
        """Turn eye-dome lighting on or off."""
        self._is_shading_wanted = is_on
        self._shade()
        self._report()

    def record_frame(self, seconds: float) -> None:
        """Learn from how long a frame took."""
        self._frame_s = seconds
        # A frame that has to hand new points to the graphics says nothing about the next ones.
        if self._was_changed:
            self._was_changed = False
            return
        points = self._scene_renderer.tiles.points_shown
        if self._is_moving:
            self.budget.record_moving(points, seconds)
        elif self.is_settled:
            self.budget.record_still(points, seconds)

    def close(self) -> None:
        """Stop choosing and loading; may be called again."""
        self._rest.stop()
        self._portions.stop()
        self._marks.stop()
        self._feed.close()

    def _find_touched_tiles(
        self, drive_id: str, points: NDArray[np.int64]
    ) -> TouchedTiles | tuple[TileKey, ...]:
        for drive, kind in self._drives:
            if drive.id == drive_id:
                return TouchedTiles(image_of(drive, kind), points)
        return ()

    def _request_again(self) -> None:
        self._is_chosen = False
        self._tell_if_settled()
        if self._is_moving:
            self._rest.start()
        self._request()

    def _request(self) -> None:
        if self._camera is None:
            return
        is_still = not self._is_moving
        budget = self.budget.still_points if is_still else self.budget.moving_points
        self._feed.request(
            SceneRequest(
                drives=self._drives,
                origin=self._origin,
                age=self._age,
                camera=self._camera,
                showing=self._showing,
                budget_points=budget,
                is_still=is_still,
                kept=self._chosen[not is_still] & self._scene_renderer.tiles.tiles.keys(),
                there=self._scene_renderer.tiles.tiles,
                known=frozenset(self._shown.items()),
            )
        )

    def _on_rest_timeout(self) -> None:
        self._is_moving = False
        self._is_chosen = False
        self._tell_if_settled()
        self._request()

    def _on_feed_chosen(self, choice: TileSelection) -> None:
        request = choice.request
        # A still picture chosen for a camera that has moved on is of no use.
        if request.age != self._age or request.is_still is self._is_moving:
            return
        self._chosen[request.is_still] = frozenset(choice.tiles)
        self._is_chosen = choice.is_final and request.camera == self._camera
        self._show()

    def _on_feed_arrived(self, tiles: tuple[SceneTile, ...]) -> None:
        self._arrived += tiles
        self._portions.start()

    def _on_portions_timeout(self) -> None:
        wanted = self._chosen[False] | self._chosen[True]
        there = self._scene_renderer.tiles.tiles
        drawn = {one.tile.id for one in self.drawn}
        points, is_new = 0, False
        while self._arrived and points < _POINTS_PER_PORTION:
            tile = self._arrived.pop(0)
            if tile.age != self._age or tile.id not in wanted or tile.showing != self._showing:
                continue
            self._scene_renderer.tiles.put(tile, self._colours_of(tile))
            self._shown[tile.id] = tile.showing
            is_new |= tile.id in drawn
            # Colours alone cost the graphics little: what was seen changes at once.
            points += 0 if tile.id in there else tile.points.size
        if self._arrived:
            self._portions.start()
        self._show(is_new=is_new)

    def _show(self, *, is_new: bool = False) -> None:
        """Draw what is wanted and there; a frame costs too much to draw one without need."""
        actors = self._scene_renderer.tiles
        shown = shown_tiles(self._chosen[not self._is_moving], actors.tiles)
        is_new |= actors.show(shown)
        self._keep(shown | self._chosen[False] | self._chosen[True])
        is_new |= self._shade()
        if is_new:
            self._report()
        self._tell_if_settled()

    def _keep(self, tiles: Collection[TileId]) -> None:
        self._scene_renderer.tiles.keep_only(tiles)
        self._shown = {tile: shown for tile, shown in self._shown.items() if tile in tiles}

    def _shade(self) -> bool:
        has_time = not self._is_moving or self.budget.is_fast
        return self._scene_renderer.shade(is_on=self._is_shading_wanted and has_time)

    def _colours_of(self, tile: SceneTile) -> NDArray[np.uint8]:
        plain = tile.request.attribute in SHOWS_INTENSITY
        colours = _LIFTED[tile.colours] if plain else tile.colours
        marked = self._marked.get(tile.id.drive_id)
        if marked is None or not marked.size:
            return colours
        positions = np.minimum(np.searchsorted(marked, tile.points), marked.size - 1)
        colours = colours.copy()
        colours[marked[positions] == tile.points] = (ACCENT.red(), ACCENT.green(), ACCENT.blue())
        return colours

    def _report(self) -> None:
        self._was_changed = True
        self.changed.emit()

    def _tell_if_settled(self) -> None:
        was_settled, self._was_settled = self._was_settled, self.is_settled
        if self._was_settled and not was_settled:
            self.settled.emit()


def _colours_only(look: PointStyle) -> PointStyle:
    """The look without what the graphics do by themselves."""
    return replace(look, point_size_px=PointStyle().point_size_px)

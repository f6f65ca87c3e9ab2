"""SceneView: the drives and the map in three dimensions."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt, Signal
from PySide6.QtGui import QCloseEvent, QColor, QPainter, QPaintEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QWidget
from typing_extensions import override

from processing.core.arrays import Floats
from processing.core.text import Language
from processing.image.attributes.tile_cache import TileCache
from widgets.mouse_tools.menu_request import MenuRequest
from widgets.mouse_tools.mouse_tool import MouseTool
from widgets.scene_view.clipping import Clipping
from widgets.scene_view.hits import SceneHits
from widgets.scene_view.map.map_layer import MapLayer
from widgets.scene_view.mouse import SceneMouse
from widgets.scene_view.overlay import OverlayContent, SceneOverlay
from widgets.scene_view.points.point_finder import PointFinder
from widgets.scene_view.renderer_loader import RendererLoader
from widgets.scene_view.rendering import overviews
from widgets.scene_view.rendering.backdrop import BACKGROUND
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.rendering.projection import SceneProjection
from widgets.scene_view.rendering.scene_picture import ScenePicture
from widgets.scene_view.shown_drives import ShownDrives
from widgets.scene_view.view_menu import view_menu
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

if TYPE_CHECKING:  # importing these imports VTK, which is done after the view was shown
    from widgets.scene_view.points.cloud import PointCloudLayer
    from widgets.scene_view.rendering.scene_renderer import SceneRenderer


_FARTHEST_M = 40.0


class SceneView(QWidget):
    """Draws the drives' tiles as points and the map above them; every click is an exact point.

    The picture itself is made after the view was shown first, since it takes more than a second.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    tiles : TileCache

    Attributes
    ----------
    clipping : Clipping
        Which part of space is shown; what lies outside is neither drawn nor hit.

    Signals
    -------
    sharpened()
        The camera rests, and all points that it sees are in the picture.
    menu_requested(wish: MenuRequest)
        The right button with nothing under way.
    """

    sharpened = Signal()
    menu_requested = Signal(object)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        tiles: TileCache,
        parent: QWidget | None = None,
        *,
        language: Language = "en",
    ) -> None:
        super().__init__(parent)
        self._language: Language = language
        self._source = source
        self._shared = shared
        self._tiles = tiles
        self._scene_renderer: SceneRenderer | None = None
        self._cloud: PointCloudLayer | None = None
        self._is_closed = False
        self._drives = ShownDrives(source, shared.view_settings)
        self._cursor_before: PickedPosition | None = None
        self._cursor: PickedPosition | None = shared.cursor.position
        self._finder = PointFinder(shared.view_settings)
        self._hits = SceneHits(self._finder, SceneProjection(SceneCamera((0.0, 0.0, 10.0)), 1, 1))
        self._map = MapLayer(source, shared, self)
        self._map.outdated.connect(self._show_map)
        self._mouse = SceneMouse(self._hits, shared, self._drives.course_deg, self)
        self.clipping = Clipping(source, shared, self)
        self.clipping.changed.connect(self._clip)
        self._overlay = SceneOverlay(self)
        self._loader = RendererLoader()
        self._loader.ready.connect(self._on_loader_ready)
        self.setMinimumSize(160, 120)
        self._listen()
        self._on_map_drives_changed()

    def _listen(self) -> None:
        shared, hand = self._shared, self._mouse
        shared.cursor.moved.connect(self._on_cursor_moved)
        shared.selection.features_changed.connect(self._on_selection_features_changed)
        shared.selection.points_changed.connect(self._on_selection_points_changed)
        shared.map_changes.drives_changed.connect(self._on_map_drives_changed)
        shared.map_changes.drive_columns_changed.connect(self._on_map_drive_columns_changed)
        shared.map_changes.follow_labels(self._on_map_labels_changed)
        shared.view_settings.look_changed.connect(self._on_settings_look_changed)
        shared.view_settings.image_changed.connect(self._on_settings_image_changed)
        shared.view_settings.hidden_drives_changed.connect(self._on_settings_image_changed)
        for changed in (shared.sketch.changed, shared.snap.mark_changed, hand.acted):
            changed.connect(self._paint_overlay)
        hand.camera_moved.connect(self._on_mouse_camera_moved)
        hand.menu_requested.connect(self._on_mouse_menu_requested)
        hand.everything_requested.connect(self.show_everything)
        hand.selection_requested.connect(self.center_on_selection)

    # What others ask.

    @property
    def camera(self) -> SceneCamera:
        """From where it looks, metres from the document's origin."""
        return self._hits.projection.camera

    @property
    def picture(self) -> ScenePicture | None:
        """The widget that gets the mouse; None until the picture was made."""
        return None if self._scene_renderer is None else self._scene_renderer.widget

    @property
    def cloud(self) -> PointCloudLayer | None:
        """Which points are drawn; None until the picture was made."""
        return self._cloud

    @property
    def is_settled(self) -> bool:
        """Whether the camera rests and all points that it sees are there."""
        return self._cloud is not None and self._cloud.is_settled

    def set_mouse_tool(self, tool: MouseTool | None) -> None:
        """Tell this tool from now on what the mouse does; None: a click puts the cursor."""
        self._mouse.gesture.drop()
        self._mouse.gesture.tool = tool
        self._paint_overlay()

    def show_everything(self) -> None:
        """Look along the drive from its beginning; over clouds without trajectory, at all."""
        camera = self._drives.overview()
        if camera is not None:
            self.look_from(camera)

    def look_along_drive(self) -> None:
        """Look at what is in the middle from behind and above, along the drive."""
        camera = self._drives.along(self._looked_at())
        if camera is not None:
            self.look_from(camera)

    def look_from_above(self) -> None:
        """Look straight down on what is in the middle, north up, without perspective."""
        camera = self.camera.centred_on(self._looked_at())
        self.look_from(camera.from_above(max(camera.distance_m, 30.0)))

    def center_on(self, position: PickedPosition) -> None:
        """Put a place in the middle, seen from the same side."""
        distance_m = min(self.camera.distance_m, _FARTHEST_M)
        camera = self.camera.centred_on(self._local(position), distance_m)
        # A review moves the cursor there first, and the view followed it.
        if camera != self.camera:
            self.look_from(camera)

    def center_on_selection(self) -> None:
        """Put the chosen features in the middle, or the cursor when none is chosen."""
        positions = self._map.places_of(self._shared.selection.features)
        if positions is not None:
            self.look_from(overviews.holding(positions, self.camera))
        elif self._shared.cursor.position is not None:
            self.center_on(self._shared.cursor.position)

    def zoom_by(self, factor: float) -> None:
        """Zoom about what is in the middle."""
        self.look_from(self.camera.zoomed(self._looked_at(), factor))

    def position_of(self, position: PickedPosition) -> QPointF | None:
        """Where a place is in this widget; None when it is behind the camera."""
        pixels, _ = self._hits.projection.to_screen(self._local(position)[None])
        x, y = pixels[0].tolist()
        return QPointF(x, y) if np.isfinite(x) else None

    def look_from(self, camera: SceneCamera) -> None:
        """Look from here."""
        width, height = max(self.width(), 1), max(self.height(), 1)
        self._hits.projection = SceneProjection(camera, width, height)
        if self._scene_renderer is not None and self._cloud is not None:
            size_px = (
                round(width * self._scene_renderer.scale),
                round(height * self._scene_renderer.scale),
            )
            self._cloud.look_from(camera.for_tiles(self._drives.origin, *size_px))
            self._scene_renderer.look(camera)
            self._map.catch_up()
            self._scene_renderer.redraw()
            self._size_points()
        self._paint_overlay()

    def set_shading(self, *, is_on: bool) -> None:
        """Turn eye-dome lighting on or off."""
        if self._cloud is not None:
            self._cloud.set_shading(is_on=is_on)

    def set_perspective(self, *, is_on: bool) -> None:
        """Draw far things smaller than near ones, or as large."""
        self.look_from(replace(self.camera, is_parallel=not is_on))

    @override
    def close(self) -> bool:
        """Close the picture and stop loading; may be called again."""
        self._take_down()
        return super().close()

    # Events.

    @override
    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if self._scene_renderer is None and not self._is_closed:
            self._loader.start()

    @override
    def closeEvent(self, event: QCloseEvent) -> None:
        self._take_down()
        super().closeEvent(event)

    @override
    def resizeEvent(self, event: QResizeEvent) -> None:
        self._overlay.setGeometry(self.rect())
        if self._scene_renderer is not None:
            self._scene_renderer.widget.setGeometry(self.rect())
        self.look_from(self.camera)

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), QColor(BACKGROUND))

    # What others tell.

    def _on_loader_ready(self) -> None:
        if self._is_closed:
            return
        from widgets.scene_view.points.cloud import PointCloudLayer
        from widgets.scene_view.rendering.scene_renderer import SceneRenderer

        self._scene_renderer = SceneRenderer(self, self._on_scene_renderer_frame)
        self._cloud = PointCloudLayer(self._scene_renderer, self._tiles, self)
        picture = self._scene_renderer.widget
        picture.setGeometry(self.rect())
        picture.installEventFilter(self._mouse)
        self.setFocusProxy(picture)
        self._mouse.is_enabled = True
        self._cloud.changed.connect(self._on_cloud_changed)
        self._cloud.settled.connect(self.sharpened)
        self._cloud.use(self._drives.with_kinds, self._drives.origin)
        self._cloud.colour(self._shared.view_settings.look)
        self._clip()
        self._cloud.mark(self._shared.selection.points)
        picture.show()
        self._overlay.raise_()
        self._show_map()
        self.look_from(self.camera)

    def _on_scene_renderer_frame(self, seconds: float) -> None:
        if self._cloud is not None:
            self._cloud.record_frame(seconds)

    def _on_cloud_changed(self) -> None:
        if self._scene_renderer is None or self._cloud is None:
            return
        self._hits.drawn = self._cloud.drawn
        self._scene_renderer.look(self.camera)
        self._scene_renderer.redraw()
        self._paint_overlay()

    def _on_cursor_moved(self, position: PickedPosition) -> None:
        self._cursor_before, self._cursor = self._cursor, position
        # Who clicks in this view has the place under the mouse already.
        if not self._mouse.is_clicking and not self._hits.projection.is_in_middle(
            self._local(position)
        ):
            self.center_on(position)
        self._paint_overlay()

    def _on_selection_features_changed(self, ids: frozenset[str]) -> None:
        self._hits.selected = ids

    def _on_selection_points_changed(self) -> None:
        if self._cloud is not None:
            self._cloud.mark(self._shared.selection.points)

    def _on_map_drives_changed(self) -> None:
        self._cursor = self._cursor_before = None
        self._drives.read()
        self._map.read_all()
        self._use_drives()
        self.show_everything()
        self._paint_overlay()

    def _on_map_drive_columns_changed(self, drive_id: str) -> None:
        if self._cloud is not None:
            self._cloud.refresh(drive_id)

    def _on_map_labels_changed(self, drive_id: str, points: NDArray[np.int64]) -> None:
        if self._cloud is not None:
            self._cloud.refresh_labels(drive_id, points)

    def _on_settings_look_changed(self) -> None:
        if self._cloud is not None:
            self._cloud.colour(self._shared.view_settings.look)
            self._size_points()

    def _on_settings_image_changed(self) -> None:
        if self._drives.read():
            self._use_drives()

    def _on_mouse_camera_moved(self, camera: SceneCamera) -> None:
        self.look_from(self._drives.above_ground(camera))

    def _on_mouse_menu_requested(self, where: QPointF) -> None:
        is_shaded = self._cloud is not None and self._cloud.is_shading_wanted
        menu = view_menu(self, self, is_shading_wanted=is_shaded)
        hit = self._hits.exact_hit(where, Qt.KeyboardModifier.NoModifier)
        self.menu_requested.emit(MenuRequest(menu, self.mapToGlobal(where.toPoint()), hit))

    # What is done in more than one place.

    def _show_map(self) -> None:
        self._map.show(self._scene_renderer)
        self._hits.flat = self._map.flat
        if self._scene_renderer is not None:
            self._scene_renderer.redraw()

    def _clip(self) -> None:
        self._finder.clip_to(self.clipping.clip)
        self._map.clip_to(self.clipping.clip)
        if self._cloud is not None:
            self._cloud.clip_to(self.clipping.clip)

    def _size_points(self) -> None:
        if self._scene_renderer is not None:
            size_px = self._shared.view_settings.look.point_size_px
            self._scene_renderer.size_points(size_px, self._hits.projection.point_px)

    def _use_drives(self) -> None:
        drives = self._drives
        self._finder.use(drives.with_kinds, drives.origin)
        self._hits.drawn = ()
        self._hits.origin = drives.origin
        if self._cloud is not None:
            self._cloud.use(drives.with_kinds, drives.origin)

    def _looked_at(self) -> Floats:
        """What is in the middle of the picture; the cursor, where that is in it."""
        position = self._shared.cursor.position
        if position is not None and self._hits.projection.is_in_middle(self._local(position)):
            return self._local(position)
        return self._hits.position_under(QPointF(self.width() / 2, self.height() / 2))

    def _local(self, position: PickedPosition) -> Floats:
        return np.asarray(np.array(position.xyz) - self._drives.origin, np.float64)

    def _words(self) -> str:
        if not self._drives.with_kinds:
            return self.tr("Drives appear here in three dimensions once they are shown.")
        if self._scene_renderer is None:
            return self.tr("The 3D view is starting.")
        return "" if self._hits.drawn else self.tr("Points are being loaded.")

    def _paint_overlay(self) -> None:
        cursor, before = self._cursor, self._cursor_before
        content = OverlayContent(
            origin=self._drives.origin,
            catalogue=self._source.catalogue(),
            drawing=self._shared.sketch.drawing,
            cursor=None if cursor is None else self._local(cursor),
            cursor_before=None if before is None else self._local(before),
            outline=self._mouse.gesture.outline,
            snap=self._shared.snap.mark,
            language=self._language,
            words=self._words(),
        )
        self._overlay.show_content(self._hits.projection, content)

    def _take_down(self) -> None:
        if self._is_closed:
            return
        self._is_closed = True
        self._mouse.is_enabled = False
        self._loader.close()
        if self._cloud is not None:
            self._cloud.close()
        if self._scene_renderer is not None:
            self._scene_renderer.widget.removeEventFilter(self._mouse)
            self._scene_renderer.close()

"""ImageView: the 2D view in which every laser point is a pixel."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, Qt, Signal
from PySide6.QtGui import (
    QKeyEvent,
    QMouseEvent,
    QPaintEvent,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QWidget
from typing_extensions import override

from processing.core.errors import UserError
from processing.core.text import Language
from processing.image.attributes.tile_cache import TileCache
from widgets.feature_drawing.own_point_marks import OwnPointPlaces
from widgets.image_view.features.feature_overlay import FeatureOverlay
from widgets.image_view.features.feature_positions import FeaturePositions
from widgets.image_view.features.position_search import PositionSearch
from widgets.image_view.hit_finder import HitFinder
from widgets.image_view.margins import ImageMargins
from widgets.image_view.orientation.navigation import beginning, viewport_on, zoom_by_wheel
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.image_view.orientation.viewport import Viewport
from widgets.image_view.scene_painter import Overlays, ScenePainter
from widgets.image_view.shown_cursor import ShownCursor
from widgets.image_view.tile_images import TileImages
from widgets.image_view.view_menu import view_menu
from widgets.mouse_tools.gesture import Gesture
from widgets.mouse_tools.menu_request import MenuRequest
from widgets.mouse_tools.mouse_tool import MouseTool
from widgets.plane_view.navigation import Navigation
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_MANY_FEATURES = 1_000
_MARGIN_PX = 24.0


class ImageView(QWidget):
    """Paints a drive's point-cloud image with the map on it; every pixel is an exact coordinate.

    The street runs from left to right, the left side of the drive up, unless the settings' lay
    turns or mirrors it.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    tiles : TileCache
    language : Language
        Of names that come from below Qt: kinds of image, attributes, refusals.

    Signals
    -------
    open_requested, import_requested
        The buttons of the empty view.
    sharpened
        The last tile that was missing in the window has come and is painted.
    features_placed
        Every vertex of another drive has found its point of this one, or none.
    menu_requested(wish: MenuRequest)
        The right button with nothing under way.
    looked()
        Another part of the picture is shown, or another size of it.
    """

    open_requested = Signal()
    import_requested = Signal()
    sharpened = Signal()
    features_placed = Signal()
    menu_requested = Signal(object)
    looked = Signal()

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
        self._source = source
        self._shared = shared
        self._picture: OrientedImage | None = None
        self._refusal: UserError | None = None
        self._is_sharp = False
        self._viewport = Viewport()
        self._images = TileImages(tiles)
        self._images.setParent(self)
        self._positions = FeaturePositions(source)
        chosen = OwnPointPlaces(source, shared)
        self._overlay = FeatureOverlay(self._positions, shared.view_settings, chosen)
        self._hits = HitFinder(self._overlay, shared.snap, shared.view_settings)
        self._gesture = Gesture(self._hits, shared.cursor)
        self._navigation = Navigation()
        self._cursor = ShownCursor()
        self._scene = ScenePainter(self, self._images, self._overlay, language)
        self._edges = ImageMargins(self, tiles)
        self._search = PositionSearch(self._positions, self._plan_middle, self)
        self._search.found.connect(self.update)
        self._search.ended.connect(self.features_placed)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(160, 120)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self._edges.empty.open_requested.connect(self.open_requested)
        self._edges.empty.import_requested.connect(self.import_requested)
        self._edges.minimap.position_chosen.connect(self._on_minimap_position_chosen)
        self._images.changed.connect(self.update)
        self._listen()
        self._positions.read_all()
        self._on_settings_image_changed()

    def _listen(self) -> None:
        shared = self._shared
        shared.cursor.moved.connect(self._on_cursor_moved)
        shared.selection.features_changed.connect(self._on_selection_features_changed)
        shared.selection.points_changed.connect(self._tint)
        shared.map_changes.features_changed.connect(self._on_map_features_changed)
        shared.map_changes.drives_changed.connect(self._on_map_drives_changed)
        shared.map_changes.drive_columns_changed.connect(self._on_map_drive_columns_changed)
        shared.map_changes.follow_labels(self._on_map_labels_changed)
        shared.view_settings.look_changed.connect(self._on_settings_look_changed)
        shared.view_settings.image_changed.connect(self._on_settings_image_changed)
        shared.view_settings.image_orientation_changed.connect(
            self._on_settings_image_orientation_changed
        )
        shared.view_settings.shown_features_changed.connect(self.update)
        shared.sketch.changed.connect(self.update)
        shared.snap.mark_changed.connect(self.update)
        shared.snap.modes_changed.connect(self._show_mouse)

    # What others ask.

    @property
    def viewport(self) -> Viewport:
        """What is shown, and how large."""
        return self._viewport

    @property
    def picture(self) -> OrientedImage | None:
        """What is shown; None while the view is empty."""
        return self._picture

    def set_mouse_tool(self, tool: MouseTool | None) -> None:
        """Tell this tool from now on what the mouse does; None: a click puts the cursor."""
        self._gesture.drop()
        self._gesture.tool = tool
        self.update()

    def look_through(self, viewport: Viewport) -> None:
        """Show this part of the picture, as large."""
        self._look_through(viewport)

    def show_everything(self) -> None:
        """Show the whole drive."""
        if self._picture is not None:
            self._look_through(self._viewport.with_everything(self._picture.stretch))

    def show_one_to_one(self) -> None:
        """Show one pixel of the image on one of the screen."""
        self._look_through(self._viewport.one_to_one())

    def zoom_by(self, factor: float) -> None:
        """Zoom about the middle."""
        viewport = self._viewport
        self._look_through(viewport.zoomed(factor, *viewport.middle))

    def center_on(self, position: PickedPosition) -> None:
        """Put a place in the middle; without effect when no point of the drive is near it."""
        found = None if self._picture is None else self._cursor.find(self._picture, position)
        if found is not None:
            self._look_through(self._viewport.centred_on(*found))

    def center_on_selection(self) -> None:
        """Put the chosen features in the middle, or the cursor when none is chosen."""
        span = self._positions.span_of(self._shared.selection.features)
        if span is not None:
            self._look_through(self._viewport.holding(span))
        elif self._shared.cursor.position is not None:
            self.center_on(self._shared.cursor.position)

    def position_of(self, position: PickedPosition) -> QPointF | None:
        """Where a place is in this widget; None when no point of the drive is near it."""
        found = None if self._picture is None else self._cursor.find(self._picture, position)
        return None if found is None else QPointF(*self._viewport.position_of(*found))

    # Events.

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        overlays = Overlays.of(
            self._shared,
            self._source.catalogue(),
            cursor=self._cursor,
            outline=self._gesture.outline,
            refusal=self._refusal,
        )
        was_sharp = self._is_sharp
        self._is_sharp = self._scene.paint(self._picture, self._viewport, overlays)
        if self._is_sharp and not was_sharp:
            self.sharpened.emit()

    @override
    def resizeEvent(self, event: QResizeEvent) -> None:
        was_sized = self._viewport.width > 1
        viewport = self._edges.lay_out(self._viewport)
        self._look_through(viewport if was_sized else beginning(self._picture, viewport))

    @override
    def wheelEvent(self, event: QWheelEvent) -> None:
        if self._picture is not None:
            self._look_through(zoom_by_wheel(self._viewport, event))
            self._hover(event.position())
        event.accept()

    @override
    def mousePressEvent(self, event: QMouseEvent) -> None:
        position = event.position()
        if self._picture is None:
            return
        if self._navigation.starts_with(event.button()):
            self._navigation.begin(position)
            self.setCursor(Qt.CursorShape.ClosedHandCursor)
        elif event.button() == Qt.MouseButton.LeftButton:
            self._gesture.press(position, event.modifiers())
        elif event.button() == Qt.MouseButton.RightButton and self._gesture.is_busy:
            self._gesture.complete()
        elif event.button() == Qt.MouseButton.RightButton:
            self._ask_for_menu(event)

    @override
    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        position = event.position()
        if self._picture is None:
            return
        if self._navigation.is_panning:
            self._look_through(self._navigation.dragged(self._viewport, position))
            return
        self._hover(position)
        had_outline = self._gesture.outline is not None
        self._gesture.move(position, event.modifiers())
        if had_outline or self._gesture.outline is not None:
            self.update()

    @override
    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._navigation.is_panning:
            self._navigation.end()
            self._show_mouse()
        elif self._picture is not None and event.button() == Qt.MouseButton.LeftButton:
            self._gesture.release(event.position(), event.modifiers())
            self.update()

    @override
    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._gesture.complete()

    @override
    def leaveEvent(self, event: QEvent) -> None:
        self._shared.cursor.hover_over(None)

    @override
    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = event.key()
        moved = None if self._picture is None else self._navigation.keyed(self._viewport, key)
        if moved is not None:
            self._look_through(moved)
        elif key == Qt.Key.Key_Space:
            self._navigation.is_space_down = True
            self._show_mouse()
        elif key == Qt.Key.Key_Home:
            self.show_everything()
        elif key == Qt.Key.Key_F:
            self.center_on_selection()
        elif self._gesture.key(key):
            self.update()
        else:
            super().keyPressEvent(event)

    @override
    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Space and not event.isAutoRepeat():
            self._navigation.is_space_down = False
            self._show_mouse()
        else:
            super().keyReleaseEvent(event)

    # What others tell.

    def _on_cursor_moved(self, position: PickedPosition) -> None:
        found = self._cursor.move_to(self._picture, position)
        if found is not None and not self._viewport.shows(*found, _MARGIN_PX):
            self._look_through(self._viewport.centred_on(*found))
        self.update()

    def _on_selection_features_changed(self, ids: frozenset[str]) -> None:
        self._overlay.selected = ids
        self.update()

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        if len(ids) > _MANY_FEATURES:
            self._positions.read_all()
        else:
            self._positions.read(ids)
        self._search.go_on()
        self.update()

    def _on_map_drives_changed(self) -> None:
        self._positions.read_all()
        self._on_settings_image_changed()

    def _on_map_drive_columns_changed(self, drive: str) -> None:
        if self._picture is not None and self._picture.drive.id == drive:
            self._images.make_anew()
            self._edges.minimap.make_anew()
            self.update()

    def _on_map_labels_changed(self, drive: str, points: NDArray[np.int64]) -> None:
        self._images.show_labels(drive, points)
        self._edges.minimap.show_labels(drive, points)

    def _on_settings_look_changed(self) -> None:
        look = self._shared.view_settings.look
        self._images.show(self._picture, look)
        self._edges.minimap.show_picture(self._picture, look)
        self.update()

    def _on_settings_image_changed(self) -> None:
        before = self._picture
        self._refusal = None
        try:
            self._picture = OrientedImage.chosen(self._source, self._shared.view_settings)
        except UserError as error:  # told where the picture would be
            self._picture, self._refusal = None, error
        picture, look = self._picture, self._shared.view_settings.look
        self._images.show(picture, look)
        self._edges.show_picture(picture, look, is_refused=self._refusal is not None)
        self._positions.show(picture)
        self._tint()
        self._cursor.move_to(picture, self._shared.cursor.position)
        self._cursor.forget_trail()
        self._show_mouse()
        self._lay_out()
        self._hits.picture = picture
        if picture is not None:
            self._look_through(viewport_on(picture, before, self._viewport))
        self._search.go_on()
        self.update()

    def _on_settings_image_orientation_changed(self) -> None:
        self._lay_out()
        self._look_through(self._viewport)

    def _on_minimap_position_chosen(self, u: float) -> None:
        self._look_through(self._viewport.centred_on(u, self._viewport.centre[1]))

    # What is done in more than one place.

    def _ask_for_menu(self, event: QMouseEvent) -> None:
        menu = view_menu(self, self, self._shared.view_settings)
        hit = self._hits.exact_hit(event.position(), event.modifiers())
        self.menu_requested.emit(MenuRequest(menu, event.globalPosition().toPoint(), hit))

    def _lay_out(self) -> None:
        """Turn the picture as it is wanted, and give it what the edges leave."""
        wanted = self._shared.view_settings.image_orientation
        orientation = wanted if self._picture is None else self._picture.turned(wanted)
        self._viewport = self._hits.viewport = self._viewport.laid(orientation)
        if self._viewport.width > 1:  # shown before
            self._viewport = self._hits.viewport = self._edges.lay_out(self._viewport)

    def _look_through(self, viewport: Viewport) -> None:
        self._viewport = self._hits.viewport = viewport
        self._edges.show_part(self._picture, viewport)
        self.looked.emit()
        self.update()

    def _hover(self, position: QPointF) -> None:
        self._shared.cursor.hover_over(self._hits.position_under(position))

    def _tint(self) -> None:
        picture, chosen = self._picture, self._shared.selection.points
        if picture is not None:
            self._images.tint(chosen.get(picture.drive.id, np.empty(0, np.int64)))
            self.update()

    def _plan_middle(self) -> tuple[float, float] | None:
        picture = self._picture
        return None if picture is None else picture.plan_position(*self._viewport.centre)

    def _show_mouse(self) -> None:
        shape = self._navigation.mouse_shape(self._shared.snap.modes)
        self.setCursor(shape if self._picture is not None else Qt.CursorShape.ArrowCursor)

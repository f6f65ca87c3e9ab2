"""PlaneView: what the section, the camera view and the map from above have in common."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QCoreApplication, QEvent, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import (
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPolygonF,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QMenu, QWidget
from typing_extensions import override

from processing.core.text import Language
from widgets.feature_drawing.feature_style import colour_of_kind
from widgets.feature_drawing.own_point_marks import OwnPointPlaces, paint_own_points
from widgets.feature_drawing.screen_marks import paint_outline
from widgets.mouse_tools.menu_request import MenuRequest
from widgets.mouse_tools.mouse_tool import MouseTool
from widgets.plane_view.feature_hits import EnclosedPoints, PlaneHits
from widgets.plane_view.live_painter import LiveContent, LivePainter, paint_words, spot_of
from widgets.plane_view.mouse import PlaneMouse
from widgets.plane_view.projected_map import ProjectedMap
from widgets.plane_view.projection import PlanePoint, PlaneProjection
from widgets.plane_view.still_picture import BACKGROUND, StillPicture
from widgets.plane_view.viewport import PlaneViewport
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_MIDDLE_PART = 0.6
_ALONG_PER_NOTCH = 0.12  # of the window's width


class PlaneView(QWidget):
    """Shows the map on a plane and gives the mouse to the tool in the hand.

    A subclass says how space lies on the plane (:meth:`projection`), paints the ground below the
    map and what frames it, and finds the measured point at a place of the plane.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language
        Of names that come from below Qt.

    Signals
    -------
    sharpened
        The ground is as sharp as it will be; emitted by the subclass.
    menu_requested(wish: MenuRequest)
        The right button with nothing under way.
    viewport_changed
        Another part of the plane is shown, or as large as before no more.
    """

    sharpened = Signal()
    menu_requested = Signal(object)
    viewport_changed = Signal()

    FILLED = 0.9
    """How much of the window all there is may fill."""

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        parent: QWidget | None = None,
        *,
        language: Language = "en",
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._shared = shared
        self._language: Language = language
        self._viewport = PlaneViewport()
        self._is_placed = self._is_whole = False
        self._cursor: PickedPosition | None = shared.cursor.position
        self._cursor_before: PickedPosition | None = None
        self._map = ProjectedMap(source, shared)
        self._map.read_all()
        self._hits = PlaneHits(self)
        self._hits.selected = shared.selection.features
        self._mouse = PlaneMouse(self, self._hits, shared)
        self._chosen = OwnPointPlaces(source, shared)
        self._still = StillPicture()
        self._live = LivePainter()
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(160, 120)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self._listen()

    def _listen(self) -> None:
        shared = self._shared
        shared.cursor.moved.connect(self._on_cursor_moved)
        shared.selection.features_changed.connect(self._on_selection_features_changed)
        shared.map_changes.features_changed.connect(self._on_map_features_changed)
        shared.map_changes.drives_changed.connect(self._on_map_drives_changed)
        shared.view_settings.shown_features_changed.connect(self._on_settings_shown_changed)
        shared.sketch.changed.connect(self.update)
        shared.snap.mark_changed.connect(self.update)
        shared.snap.modes_changed.connect(self._show_mouse)

    # What a subclass fills.

    def projection(self) -> PlaneProjection | None:
        """How space lies on the plane; the same object until it changes. None: nothing to show."""
        return None

    def words(self) -> str:
        """One line that stands where the picture would be."""
        return ""

    def extent(self) -> QRectF | None:
        """All there is to see, on the plane."""
        return None

    def reach_box(self) -> NDArray[np.float64] | None:
        """(2, 3) lowest and highest place that can be in the picture, m; None: anywhere.

        Features wholly outside it aren't projected at all.
        """
        return None

    def paint_ground(self, painter: QPainter, viewport: PlaneViewport) -> None:
        """Paint points or a photo, below the map; kept until :meth:`set_ground_stale`."""

    def paint_frame(self, painter: QPainter, viewport: PlaneViewport) -> None:
        """Paint scale, rulers and titles, above the map; called for every picture."""

    def position_at(
        self,
        position: PlanePoint,  # noqa: ARG002 - for subclasses
        reach: float,  # noqa: ARG002
        *,
        exact: bool,  # noqa: ARG002
    ) -> PickedPosition | None:
        """The measured point at a place of the plane.

        Parameters
        ----------
        reach : float
            How far from the place a point may be, units of the plane.
        exact : bool
            Among all measured points, for a click; otherwise among those that are drawn.
        """
        return None

    def points_inside(self, outline: QPolygonF) -> Mapping[str, NDArray[np.int64]]:  # noqa: ARG002
        """The measured points in an outline in the widget: drive id to points, sorted."""
        return {}

    def finder_inside(self, outline: QPolygonF) -> Callable[[], EnclosedPoints] | None:  # noqa: ARG002
        """What looks up all of them, in any thread; None where they are all drawn."""
        return None

    def on_cursor_moved(self, position: PickedPosition) -> None:
        """The shared cursor was moved elsewhere than in this view."""
        spot = self._on_plane(position)
        if spot is not None and not self._viewport.shows(*spot, _MIDDLE_PART):
            self.set_viewport(self._viewport.centred_on(*spot))

    def on_drives_changed(self) -> None:
        """Drives were added, or a project opened or closed; all is painted anew afterwards."""

    def move_along(self, notches: float) -> None:
        """The wheel with Shift: along the drive, or to the side where there is none."""
        self.set_viewport(
            self._viewport.panned(notches * _ALONG_PER_NOTCH * self._viewport.width, 0.0)
        )

    def view_menu(self) -> QMenu:
        """What the view itself offers to the right button; it goes when it was closed."""
        menu = QMenu(self)
        menu.addAction(
            QCoreApplication.translate("PlaneView", "Show everything"), self.show_everything
        )
        menu.addAction(
            QCoreApplication.translate("PlaneView", "Centre on the selection"),
            self.center_on_selection,
        )
        menu.aboutToHide.connect(menu.deleteLater)
        return menu

    # What others ask.

    @property
    def viewport(self) -> PlaneViewport:
        """Which part of the plane is shown, and how large."""
        return self._viewport

    def set_viewport(self, viewport: PlaneViewport) -> None:
        """Show this part of the plane, as large."""
        self._is_placed, self._is_whole = True, False
        self._look_through(viewport)

    def set_mouse_tool(self, tool: MouseTool | None) -> None:
        """Tell this tool from now on what the mouse does; None: a click puts the cursor."""
        self._mouse.gesture.drop()
        self._mouse.gesture.tool = tool
        self.update()

    def set_ground_stale(self) -> None:
        """Paint ground and map anew: another lay, other points, other colours."""
        self._still.drop_ground()
        self._show_mouse()
        self._place_first()
        self.update()

    def show_everything(self) -> None:
        """Show all there is, in windows of other sizes too until the user looks elsewhere."""
        extent = self.extent()
        if extent is not None:
            self.set_viewport(self._viewport.filled_by(extent, self.FILLED))
            self._is_whole = True

    def center_on(self, position: PickedPosition) -> None:
        """Put a place in the middle; without effect where it isn't shown."""
        spot = self._on_plane(position)
        if spot is not None:
            self.set_viewport(self._viewport.centred_on(*spot))

    def center_on_selection(self) -> None:
        """Put the chosen features in the middle, or the cursor when none is chosen."""
        projection = self.projection()
        if projection is None:
            return
        chosen = [self._map.get(projection, id_) for id_ in sorted(self._shared.selection.features)]
        bounds = [one.bounds for one in chosen if one is not None and one.bounds is not None]
        if bounds:
            left, top = np.min([one[:2] for one in bounds], axis=0).tolist()
            right, bottom = np.max([one[2:] for one in bounds], axis=0).tolist()
            self.set_viewport(self._viewport.holding(left, top, right, bottom))
        elif self._shared.cursor.position is not None:
            self.center_on(self._shared.cursor.position)

    def zoom_by(self, factor: float) -> None:
        """Zoom about the middle."""
        viewport = self._viewport
        self.set_viewport(viewport.zoomed(factor, *viewport.middle))

    def position_of(self, position: PickedPosition) -> QPointF | None:
        """Where a place is in this widget; None where it isn't shown."""
        projection = self.projection()
        spot = None if projection is None else spot_of(projection, self._viewport, position.xyz)
        return None if spot is None else QPointF(*spot)

    # Events.

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        projection = self.projection()
        with QPainter(self) as painter:
            if projection is None:
                painter.fillRect(self.rect(), BACKGROUND)
                paint_words(painter, QRectF(self.rect()), self.words())
                return
            self._refresh()
            catalogue = self._source.catalogue()
            if self._hits.features is not None:
                self._still.paint(
                    painter,
                    self,
                    self._hits.features,
                    self._viewport,
                    catalogue=catalogue,
                    selected=self._shared.selection.features,
                )
            self._paint_own_points(painter, projection)
            self.paint_frame(painter, self._viewport)
            content = LiveContent(
                catalogue=catalogue,
                drawing=self._shared.sketch.drawing,
                cursor=self._cursor,
                cursor_before=self._cursor_before,
                snap=self._shared.snap.mark,
                language=self._language,
            )
            self._live.paint(painter, projection, self._viewport, content)
            outline = self._mouse.gesture.outline
            if outline is not None:
                paint_outline(painter, outline)

    def _paint_own_points(self, painter: QPainter, projection: PlaneProjection) -> None:
        """The points that chosen features consist of, where they are shown."""
        catalogue = self._source.catalogue()
        for feature in self._chosen.features():
            spots = self._viewport.to_screen(projection.to_plane(self._chosen.xyz(feature)))
            paint_own_points(painter, spots, colour_of_kind(catalogue, feature.kind))

    @override
    def resizeEvent(self, event: QResizeEvent) -> None:
        self._look_through(self._viewport.sized(self.width(), self.height()))
        if self._is_whole:
            self.show_everything()
        self._place_first()

    @override
    def wheelEvent(self, event: QWheelEvent) -> None:
        event.accept()
        if self.projection() is not None:
            self._mouse.turn_wheel(event)

    @override
    def mousePressEvent(self, event: QMouseEvent) -> None:
        if self._is_ready and self._mouse.press(event):
            hit = self._hits.exact_hit(event.position(), event.modifiers())
            where = event.globalPosition().toPoint()
            self.menu_requested.emit(MenuRequest(self.view_menu(), where, hit))

    @override
    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._is_ready:
            self._mouse.move(event)

    @override
    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._is_ready:
            self._mouse.release(event)

    @override
    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._mouse.gesture.complete()
        else:
            self.mousePressEvent(event)

    @override
    def leaveEvent(self, event: QEvent) -> None:
        self._shared.cursor.hover_over(None)

    @override
    def keyPressEvent(self, event: QKeyEvent) -> None:
        if self.projection() is None or not self._mouse.press_key(event):
            super().keyPressEvent(event)

    @override
    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        if not self._mouse.release_key(event):
            super().keyReleaseEvent(event)

    # What others tell.

    def _on_cursor_moved(self, position: PickedPosition) -> None:
        self._cursor_before, self._cursor = self._cursor, position
        # Who clicks in this view has the place under the mouse already.
        if not self._mouse.is_clicking:
            self.on_cursor_moved(position)
        self.update()

    def _on_selection_features_changed(self, ids: frozenset[str]) -> None:
        self._hits.selected = ids
        self.update()

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        self._map.read(ids)
        self.update()

    def _on_map_drives_changed(self) -> None:
        self._cursor = self._shared.cursor.position
        self._cursor_before = None
        self._map.read_all()
        self._is_placed = False
        self.on_drives_changed()
        self.set_ground_stale()

    def _on_settings_shown_changed(self) -> None:
        self._map.show_others()
        self.update()

    # What is done in more than one place.

    @property
    def _is_ready(self) -> bool:
        """Whether the mouse meets anything; what it meets is what will be painted."""
        self._refresh()
        return self._hits.projection is not None

    def _refresh(self) -> None:
        """Take over lay and features as they are now."""
        projection = self.projection()
        self._hits.projection = projection
        self._hits.features = (
            None if projection is None else self._map.drawn(projection, self.reach_box())
        )

    def _look_through(self, viewport: PlaneViewport) -> None:
        if viewport != self._viewport:
            self._viewport = self._hits.viewport = viewport
            self.update()
            self.viewport_changed.emit()

    def _place_first(self) -> None:
        if not self._is_placed and self._viewport.width > 1 and self.projection() is not None:
            self.show_everything()

    def _on_plane(self, position: PickedPosition) -> PlanePoint | None:
        projection = self.projection()
        if projection is None:
            return None
        x, y = projection.to_plane(np.array([position.xyz]))[0].tolist()
        return (x, y) if np.isfinite([x, y]).all() else None

    def _show_mouse(self) -> None:
        if self.projection() is None:
            self.setCursor(Qt.CursorShape.ArrowCursor)
        else:
            self._mouse.show_mouse()

"""SectionPane: the picture of one section, drawn in like any view."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QCloseEvent, QMouseEvent, QPainter, QPolygonF, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QMenu, QWidget
from typing_extensions import override

from processing.core.text import Language, Text
from processing.map.feature import Vertex
from processing.recording.drive import Drive
from processing.section.cut import Cut
from widgets.feature_drawing.screen_marks import paint_note
from widgets.plane_view.projection import PlanePoint
from widgets.plane_view.view import PlaneView
from widgets.plane_view.viewport import PlaneViewport
from widgets.section_view.lines import SectionLines
from widgets.section_view.picture.diagnostic_marks import DiagnosticMarks
from widgets.section_view.picture.feed import SectionFeed, SectionPicture, SectionRequest
from widgets.section_view.picture.frame import BOTTOM_PX, LEFT_PX, paint_frame
from widgets.section_view.picture.ground import GroundPainter, ground_y
from widgets.section_view.picture.ground_layers import GroundLayers
from widgets.section_view.picture.marks import (
    NamedMark,
    SectionMarks,
    mark_under,
    marks_of,
    paint_marks,
)
from widgets.section_view.picture.point_search import measured_point, points_within, shown_point
from widgets.section_view.picture.projection import SectionProjection
from widgets.section_view.picture.section_position import SectionPosition
from widgets.section_view.picture.section_waveforms import paint_waveforms
from widgets.section_view.picture.settings import SectionSettings
from widgets.section_view.picture.titles import frame_words
from widgets.section_view.view_menu import add_settings
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Note

_START_HALF_M = 8.0
_START_BELOW_M, _START_ABOVE_M = 1.5, 3.5
_GROUND_SHARE = 0.7
"""The ground lies so far down in the window: what stands on it is seen."""

_EDGE_PX = 24.0
"""What is nearer to the upper or lower edge is hardly seen; the title stands there as well."""

_MORE_PX = 1.0
"""Points of a section are so much larger than in 3D, where they overlap."""


class SectionPane(PlaneView):
    """Shows one standing; the picture before stays until the points of the new one are there.

    Attributes
    ----------
    is_pinned : bool
        Whether it is one of two windows; said in its title.
    is_mouse_here, is_clicking : bool
        Whether the mouse is over it, and whether a click in it is being told to the tool.

    Signals
    -------
    settings_chosen(settings: SectionSettings)
        Wished in the menu.
    """

    settings_chosen = Signal(object)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        lines: SectionLines,
        parent: QWidget | None = None,
        *,
        language: Language = "en",
    ) -> None:
        super().__init__(source, shared, parent, language=language)
        self._lines = lines
        self._standing: SectionPosition | None = None
        self._asked: SectionRequest | None = None
        self._picture: SectionPicture | None = None
        self._projection: SectionProjection | None = None
        self._framed, self._ground_y = "", 0.0
        self._marks: SectionMarks | None = None
        self._named: NamedMark | None = None
        self._held: tuple[str, Vertex] | None = None
        self._settings = SectionSettings()
        self._is_closed = False
        self._points = GroundPainter()
        self._ground = GroundLayers(shared.volume, self, language)
        self._diagnostics = DiagnosticMarks(language)
        self._parameters: Mapping[str, object] = {}
        self.is_pinned = self.is_mouse_here = self.is_clicking = False
        self._feed = SectionFeed()
        self._feed.arrived.connect(self._on_feed_arrived)
        shared.view_settings.look_changed.connect(self._ask)
        shared.view_settings.hidden_drives_changed.connect(self._ask)
        shared.map_changes.drive_columns_changed.connect(self._on_map_drive_columns_changed)
        shared.map_changes.follow_labels(self._on_map_labels_changed)

    # What others ask.

    @property
    def standing(self) -> SectionPosition | None:
        """Where the section stands; its picture may still be on its way."""
        return self._standing

    @property
    def cut(self) -> Cut | None:
        """The cut that is painted."""
        return None if self._projection is None else self._projection.cut

    @property
    def picture(self) -> SectionPicture | None:
        """What is painted; None before the first points came."""
        return self._picture

    @property
    def marks(self) -> SectionMarks | None:
        """What of the map crosses the slab; None without a picture."""
        self._refresh()
        features, cut = self._hits.features, self.cut
        if features is None or cut is None:
            return None
        if self._marks is None or self._marks.features is not features:
            self._marks = marks_of(features, cut)
        return self._marks

    def show_standing(self, standing: SectionPosition | None) -> None:
        """Cut here from now on; None: nowhere."""
        self._standing = standing
        if standing is None:
            self._picture = self._projection = None
            self._framed, self._marks = "", None
            self.set_ground_stale()
        else:
            self._ask()
        self.update()

    def use_settings(self, settings: SectionSettings) -> None:
        """Colour points and draw heights like this; the ground stays where it is in the window."""
        before, self._settings = self._settings, settings
        viewport = self.viewport
        if viewport.exaggeration != settings.exaggeration:
            ground = np.array([[0.0, self._ground_y]])
            drawn = replace(viewport, exaggeration=settings.exaggeration)
            moved = viewport.to_screen(ground) - drawn.to_screen(ground)
            self.set_viewport(drawn.panned(0.0, float(moved[0, 1])))
        if before.wanted != settings.wanted:
            self._ask()

    def use_tool_parameters(self, parameters: Mapping[str, object]) -> None:
        """As in the view."""
        self._parameters = dict(parameters)
        if self._settings.shows_diagnostics:
            self._ask()

    @override
    def close(self) -> bool:
        """Stop looking for points; may be called again."""
        self._take_down()
        return super().close()

    @override
    def closeEvent(self, event: QCloseEvent) -> None:
        self._take_down()
        super().closeEvent(event)

    # What a plane view asks.

    @override
    def projection(self) -> SectionProjection | None:
        return self._projection

    @override
    def words(self) -> str:
        if not any(drive.count for drive in self._source.drives()):
            return self.tr("The section appears here once a recording is open.")
        if self._standing is not None:
            return self.tr("Points are being looked for.")
        if self._lines.has_own:
            return self.tr("Click a place in another view to cut there.")
        return self.tr("This recording has no trajectory: select a drawn line to cut across it.")

    @override
    def extent(self) -> QRectF | None:
        picture, projection = self.picture, self.projection()
        if picture is None or projection is None or not len(picture.section):
            return None
        positions = projection.on_plane(picture.section)
        low, high = np.percentile(positions, [0.2, 99.8], axis=0)
        (left, top), (right, bottom) = low.tolist(), high.tolist()
        # The rulers stand on the picture: what they would hide is left free.
        left -= (right - left) * LEFT_PX / max(self.width() - LEFT_PX, 1.0)
        bottom += (bottom - top) * BOTTOM_PX / max(self.height() - BOTTOM_PX, 1.0)
        return QRectF(QPointF(left, top), QPointF(right, bottom))

    @override
    def paint_ground(self, painter: QPainter, viewport: PlaneViewport) -> None:
        if self._picture is not None:
            size_px = self._shared.view_settings.look.point_size_px + _MORE_PX
            self._points.paint(painter, self._picture, viewport, size_px)

    @override
    def paint_frame(self, painter: QPainter, viewport: PlaneViewport) -> None:
        picture, marks, catalogue = self._picture, self.marks, self._source.catalogue()
        if picture is None or marks is None:
            return
        selected = self._shared.selection.features
        self._ground.paint(painter, viewport, picture)
        projection = SectionProjection(picture.request.cut)
        paint_waveforms(painter, picture.waveforms, projection, viewport)
        self._diagnostics.paint(painter, picture, viewport)
        paint_marks(painter, marks, viewport, catalogue, selected)
        words = frame_words(
            self._source,
            picture.request.standing,
            self._language,
            exaggeration=viewport.exaggeration,
            is_pinned=self.is_pinned,
            is_empty=not picture.points.size,
        )
        paint_frame(painter, viewport, picture.request.cut, words)
        self._ground.paint_legend(painter, viewport, picture)
        self._diagnostics.paint_words(painter, picture, viewport)
        named = self._named
        if named is not None:
            x, y = viewport.to_screen(np.array([named.position]))[0].tolist()
            name = Text.same(named.kind)
            if named.kind in catalogue:
                name = catalogue[named.kind].name
            note = Note((0.0, 0.0, 0.0), name.in_language(self._language))
            paint_note(painter, (x, y), note)

    @override
    def position_at(
        self, position: PlanePoint, reach: float, *, exact: bool
    ) -> PickedPosition | None:
        picture, projection = self._picture, self._projection
        if picture is None or projection is None:
            return None
        at = np.array([position[0], projection.height_of(position[1])])
        ellipse = np.array([reach, reach / self.viewport.exaggeration])
        found = (measured_point if exact else shown_point)(picture, at, ellipse)
        drawing, held = self._shared.sketch.drawing, self._held
        if found is not None or drawing is None or held is None or drawing.replaces != held[0]:
            return found
        # Where nothing was measured a vertex that is dragged keeps what the section doesn't show.
        _, _, away = projection.cut.to_section([held[1].xyz])[0].tolist()
        easting, northing, height = projection.cut.to_space([[*at, away]])[0].tolist()
        return PickedPosition((easting, northing, height), is_occluded=True)

    @override
    def points_inside(self, outline: QPolygonF) -> Mapping[str, NDArray[np.int64]]:
        picture = self._picture
        return {} if picture is None else points_within(picture, self.viewport, outline)

    @override
    def reach_box(self) -> NDArray[np.float64] | None:
        cut = self.cut
        if cut is None:
            return None
        # Half as long again: the plane goes on beyond the slab's ends.
        corners = replace(cut, half_length_m=1.5 * cut.half_length_m).outline
        low, high = corners.min(axis=0), corners.max(axis=0)
        return np.array([[*low, -np.inf], [*high, np.inf]])

    @override
    def on_cursor_moved(self, position: PickedPosition) -> None:
        """Stay: the section itself moves to the cursor."""
        self.update()

    @override
    def view_menu(self) -> QMenu:
        menu = super().view_menu()
        add_settings(menu, self._settings, self.settings_chosen.emit)
        return menu

    # Events.

    @override
    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._ask()

    @override
    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self._picture is not None and not self._framed:
            self._look_at_position(self._picture)

    @override
    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self.is_mouse_here = True
        super().mouseMoveEvent(event)
        marks = self.marks
        named = None if marks is None else mark_under(marks, self.viewport, event.position())
        if named != self._named:
            self._named = named
            self.update()
        self._hover(event.position())

    @override
    def mousePressEvent(self, event: QMouseEvent) -> None:
        self.is_mouse_here = self.is_clicking = True
        self._held = self._held_by(event)
        super().mousePressEvent(event)
        self.is_clicking = False

    @override
    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self.is_clicking = True
        super().mouseReleaseEvent(event)
        self.is_clicking = False

    @override
    def leaveEvent(self, event: QEvent) -> None:
        super().leaveEvent(event)
        self.is_mouse_here = False
        self._named = None
        self._hover(None)
        self.update()

    # What others tell.

    def _on_feed_arrived(self, picture: SectionPicture) -> None:
        # What was asked for and passed meanwhile is shown all the same: the newest comes last.
        if self._is_closed or self._standing is None or picture.request.drives != self._drives():
            return
        self._picture = picture
        if self._projection is None or self._projection.cut != picture.request.cut:
            self._projection = SectionProjection(picture.request.cut)
        self._look_at_position(picture)
        self.set_ground_stale()
        self.update()
        if picture.is_final and picture.request is self._asked:
            self.sharpened.emit()

    def _on_map_drive_columns_changed(self, drive_id: str) -> None:
        if any(drive.id == drive_id for drive in self._source.drives()):
            self._ask()

    def _on_map_labels_changed(self, drive_id: str, _points: object) -> None:
        # A run of “ground” gives labels, and another ground with them.
        if self._shared.view_settings.look.follows_labels or self._settings.shows_ground:
            self._on_map_drive_columns_changed(drive_id)

    # What is done in more than one place.

    def _ask(self) -> None:
        if self._standing is None or self._is_closed or not self.isVisible():
            return  # what is hidden is looked for when it is shown
        standing, look = self._standing, self._shared.view_settings.look
        request = SectionRequest(
            standing, standing.cut, self._drives(), look, self._settings, self._asked_first()
        )
        self._asked = request
        self._feed.request(request)

    def _asked_first(self) -> Mapping[str, object]:
        """The tools' parameters, of those first that found what is chosen."""
        chosen = map(self._source.feature, sorted(self._shared.selection.features))
        tools = {one.provenance.tool for one in chosen if one is not None}
        ids = sorted(self._parameters, key=lambda id_: id_ not in tools)
        return {id_: self._parameters[id_] for id_ in ids}

    def _hover(self, mouse: QPointF | None) -> None:
        if self._diagnostics.hover(self._picture, self.viewport, mouse):
            self.update()

    def _drives(self) -> tuple[Drive, ...]:
        hidden = self._shared.view_settings.hidden_drives
        drives = self._source.drives()
        return tuple(drive for drive in drives if drive.count and drive.id not in hidden)

    def _look_at_position(self, picture: SectionPicture) -> None:
        """Begin on the ground at each new line; afterwards move only as far as needed."""
        if self.viewport.width <= 1:  # never shown yet: it is looked at when it is
            return
        standing, line = picture.request.standing, picture.request.standing.line
        framed = f"{line.feature}/{line.drive}/{standing.is_along}"
        viewport, projection = self.viewport, SectionProjection(picture.request.cut)
        if framed != self._framed:
            y = self._ground_y = ground_y(projection, picture)
            sides = y - _START_ABOVE_M, _START_HALF_M, y + _START_BELOW_M
            scaled = viewport if self._framed else viewport.fitted(-_START_HALF_M, *sides)
            scaled = max(viewport, scaled, key=lambda one: one.scale)  # a review may be near
            below = (_GROUND_SHARE - 0.5) * viewport.height / scaled.scale_y
            self.set_viewport(scaled.centred_on(0.0, y - below))
            self._framed = framed
        if standing.through is not None:
            position = projection.to_plane(np.array([standing.through]))
            x, y = self.viewport.to_screen(position)[0].tolist()
            is_across = LEFT_PX <= x <= self.width()
            inside = is_across and _EDGE_PX <= y <= self.height() - BOTTOM_PX - _EDGE_PX
            if np.isfinite(x) and not inside:
                self.set_viewport(self.viewport.centred_on(*position[0].tolist()))

    def _held_by(self, event: QMouseEvent) -> tuple[str, Vertex] | None:
        """The vertex that a press takes hold of, with its feature's id."""
        if event.button() != Qt.MouseButton.LeftButton or self._projection is None:
            return None
        self._refresh()
        hit = self._hits.quick_hit(event.position(), event.modifiers())
        feature = self._source.feature(hit.feature) if hit.vertex >= 0 else None
        return None if feature is None else (feature.id, feature.vertices[hit.vertex])

    def _take_down(self) -> None:
        if not self._is_closed:
            self._is_closed = True
            self._feed.close()

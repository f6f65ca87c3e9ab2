"""SectionView: a cut through the recording, stepped, followed live, or held as two windows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from PySide6.QtCore import QPointF, Qt, Signal
from PySide6.QtGui import QCloseEvent, QKeyEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget
from typing_extensions import override

from processing.core.text import Language, Text
from processing.image.search.nearest import nearest_point
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Feature, Status
from processing.recording.drive import Drive
from processing.section.cut import Cut
from processing.section.points_in_cut import ground_near
from processing.section.profile import DrawnLine, SectionProfile, profile_of
from widgets.mouse_tools.mouse_tool import MouseTool
from widgets.section_view.bar import SectionBar
from widgets.section_view.lines import SectionLines
from widgets.section_view.live import LiveLine
from widgets.section_view.pane import SectionPane
from widgets.section_view.panes import SectionPanes
from widgets.section_view.picture.point_search import can_search, position_of
from widgets.section_view.picture.section_position import SectionPosition
from widgets.section_view.picture.settings import SectionSettings
from widgets.section_view.picture.titles import line_title
from widgets.section_view.pinned import PinnedSections
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_SAME_M = 0.1

_UNKNOWN_LAYER, _UNKNOWN_ACI = "0", 7

NO_LINE = Text(
    "Select a line first: the section then stands on it.",
    "先に線を選択してください。選択した線の位置で断面を表示します。",
)

_MANY = 10


class SectionView(QWidget):
    """Shows the slab through the shared cursor, across the trajectory or a drawn line.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language

    Signals
    -------
    sharpened()
        The points of the section that is asked for are painted.
    menu_requested(wish: MenuRequest)
        The right button with nothing under way.
    cut_changed(cut: Cut | None)
        Where the slab is now; pinned: the one across.
    settings_changed(settings: SectionSettings)
        Set by hand, worth remembering.
    pinned_changed(is_pinned: bool)
    reported(text: Text)
        A line for the status bar.
    profile_export_requested(), template_requested()
        The buttons of the bar; :meth:`profile_request` gives what is to be exported.
    """

    sharpened = Signal()
    menu_requested = Signal(object)
    cut_changed = Signal(object)
    settings_changed = Signal(object)
    pinned_changed = Signal(bool)
    reported = Signal(object)
    profile_export_requested = Signal()
    template_requested = Signal()

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
        self._settings = SectionSettings()
        self._followed = ""
        self._standing: SectionPosition | None = None
        self._pinned: PinnedSections | None = None
        self._told_cut: Cut | None = None
        self._is_stepping = False
        self._lines = SectionLines(source, shared, self)
        self._bar = SectionBar(self)
        self._panes = SectionPanes(source, shared, self._lines, language, self)
        self._live = LiveLine(shared.cursor, self._lines, self)
        self._live.found.connect(self._on_live_found)
        self._lay_out()
        self._listen()
        self._restart()

    def _lay_out(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self._bar)
        layout.addWidget(self._panes, 1)
        self.setFocusProxy(self._panes.all[0])

    def _listen(self) -> None:
        shared, bar = self._shared, self._bar
        shared.cursor.moved.connect(self._on_cursor_moved)
        shared.selection.features_changed.connect(self._on_selection_features_changed)
        shared.map_changes.features_changed.connect(self._on_map_features_changed)
        shared.map_changes.drives_changed.connect(self._restart)
        bar.settings_chosen.connect(self._on_settings_chosen)
        bar.line_wanted.connect(self._on_bar_line_wanted)
        bar.pin_toggled.connect(self.set_pinned)
        bar.profile_export_requested.connect(self.profile_export_requested)
        bar.template_requested.connect(self.template_requested)
        self._panes.all[0].sharpened.connect(self.sharpened)
        for pane in self._panes.all:
            pane.menu_requested.connect(self.menu_requested)
            pane.settings_chosen.connect(self._on_settings_chosen)

    # What others ask.

    @property
    def settings(self) -> SectionSettings:
        """How sections are cut and shown."""
        return self._settings

    @property
    def standing(self) -> SectionPosition | None:
        """Where the section stands; pinned: the one across."""
        return self._standing if self._pinned is None else self._pinned.across

    @property
    def cut(self) -> Cut | None:
        """The slab; None where there is none."""
        standing = self.standing
        return None if standing is None else standing.cut

    @property
    def panes(self) -> tuple[SectionPane, ...]:
        """The pictures that are shown: one, or two while pinned."""
        return self._panes.shown

    @property
    def is_pinned(self) -> bool:
        """Whether a place is held as two windows."""
        return self._pinned is not None

    @property
    def followed(self) -> str:
        """Id of the drawn line that sections stand on; empty for the trajectory."""
        return self._followed

    def use_settings(self, settings: SectionSettings) -> None:
        """Cut and show sections like this from now on."""
        if settings == self._settings:
            return
        self._settings = settings
        self._live.is_on = settings.is_live
        self._bar.show_settings(settings)
        self._panes.use_settings(settings)
        if self._standing is not None:
            self._stand(self._standing)

    def use_tool_parameters(self, parameters: Mapping[str, object]) -> None:
        """Show what tools look at with these parameters, by their ids."""
        self._panes.use_tool_parameters(parameters)

    def follow(self, line: str) -> None:
        """Stand on a drawn line from now on, or on the trajectory (empty).

        Parameters
        ----------
        line : str
            Id of a line or an area; one without length is refused with a sentence.
        """
        if line and self._lines.drawn(line) is None:
            self.reported.emit(NO_LINE)
            line = self._followed
        self._followed = line
        standing = self._through(self._shared.cursor.position)
        if standing is not None:
            self._stand(standing)

    def step(self, count: int) -> None:
        """Go so many steps along the line; the shared cursor, and so every view, goes with it."""
        before = self.standing
        if before is None:
            return
        after = before.stepped(count * self._settings.step_m)
        if after.station_m == before.station_m:
            return
        self._stand(after)
        self._is_stepping = True
        try:
            self._shared.cursor.move_to(position_of_step(after, self._source.drives()))
        finally:
            self._is_stepping = False

    def set_pinned(self, is_pinned: bool) -> None:  # noqa: FBT001 - a slot of a checked action
        """Hold this place as two windows, across and along, or release it."""
        if is_pinned == self.is_pinned or (is_pinned and self._standing is None):
            self._bar.show_pinned(is_pinned=self.is_pinned)
            return
        self._live.stop()
        if self._standing is not None:
            self._pinned = PinnedSections.at(self._standing) if is_pinned else None
            self._stand(self._standing)
        self.pinned_changed.emit(is_pinned)

    def show_position(self, position: PickedPosition, *, asks_lines: bool = True) -> None:
        """Cut through a place.

        Parameters
        ----------
        asks_lines : bool
            Across the line under it, where there is one, else across what is followed; False: a
            sign below a wire is no place of the wire.
        """
        self._live.stop()
        line = self._lines.under(position) if asks_lines else None
        standing = line or self._through(position)
        if standing is not None:
            self._stand(standing)

    def center_on(self, position: PickedPosition) -> None:
        """The same as :meth:`show_position`: a section goes to where it is asked for."""
        self.show_position(position)

    def center_on_selection(self) -> None:
        """Cut through the middle of the chosen features, or through the cursor."""
        for id_ in sorted(self._shared.selection.features):
            feature = self._source.feature(id_)
            if feature is not None:
                vertex = feature.vertices[len(feature.vertices) // 2]
                self.show_position(PickedPosition(vertex.xyz, vertex.measured, vertex.is_occluded))
                return
        if self._shared.cursor.position is not None:
            self.show_position(self._shared.cursor.position)

    def show_everything(self) -> None:
        """Show all points of the slab."""
        for pane in self.panes:
            pane.show_everything()

    def zoom_by(self, factor: float) -> None:
        """Zoom about the middle."""
        for pane in self.panes:
            pane.zoom_by(factor)

    def position_of(self, position: PickedPosition) -> QPointF | None:
        """Where a place is in this widget; None outside the slab."""
        pane = self._panes.all[0]
        spot = pane.position_of(position)
        return None if spot is None else QPointF(pane.mapTo(self, spot))

    def set_mouse_tool(self, tool: MouseTool | None) -> None:
        """Tell this tool from now on what the mouse does; None: a click puts the cursor."""
        self._panes.set_mouse_tool(tool)

    def profile_request(self) -> Callable[[], SectionProfile] | None:
        """What makes the profile of the section that is shown, in any thread; None without one."""
        standing = self.standing
        if standing is None:
            return None
        hidden = self._shared.view_settings.hidden_drives
        cut = standing.cut
        drives = tuple(drive for drive in self._source.drives() if drive.id not in hidden)
        near = self._lines.near(cut.middle, cut.half_length_m)
        lines = drawn_lines(near, self._source.catalogue())
        title, station_m = line_title(self._source, standing), standing.station_m
        return lambda: profile_of(cut, drives, lines, station_m=station_m, title=title)

    @override
    def close(self) -> bool:
        """Stop looking for points; may be called again."""
        self._take_down()
        return super().close()

    @override
    def closeEvent(self, event: QCloseEvent) -> None:
        self._take_down()
        super().closeEvent(event)

    @override
    def keyPressEvent(self, event: QKeyEvent) -> None:
        steps = {Qt.Key.Key_Q: -1, Qt.Key.Key_W: 1}.get(Qt.Key(event.key()), 0)
        if steps:
            is_far = event.modifiers() & Qt.KeyboardModifier.ShiftModifier
            self.step(steps * (_MANY if is_far else 1))
        else:
            super().keyPressEvent(event)

    # What others tell.

    def _on_cursor_moved(self, position: PickedPosition) -> None:
        if self._is_stepping or self._pinned is not None or self._panes.are_clicked_at(position):
            return
        self._live.stop()
        standing = self._lines.under(position) if self._settings.is_live else None
        standing = standing or self._through(position)
        if standing is not None:
            self._stand(standing)

    def _on_live_found(self, standing: SectionPosition) -> None:
        is_own = any(pane.is_mouse_here for pane in self.panes)
        if not is_own and self._pinned is None:
            self._stand(standing)

    def _on_selection_features_changed(self, ids: frozenset[str]) -> None:
        standing = self._standing
        is_driven = standing is not None and not standing.line.is_axis and not self._followed
        if is_driven or self._followed in ids:
            return
        lines = [id_ for id_ in ids if self._lines.drawn(id_) is not None]
        if len(lines) == 1:
            self.follow(lines[0])

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        standing = self._standing
        if self._followed in ids and self._lines.drawn(self._followed) is None:
            self._followed = ""
        if standing is None or standing.line.feature not in ids:
            return
        line = self._lines.drawn(standing.line.feature)
        if line is not None:
            self._stand(replace(standing, line=line))
        else:
            self._release()
            self._stand(self._through(self._shared.cursor.position) or self._lines.start())

    def _on_settings_chosen(self, settings: SectionSettings) -> None:
        self.use_settings(settings)
        self.settings_changed.emit(settings)

    def _on_bar_line_wanted(self, is_drawn: bool) -> None:  # noqa: FBT001 - a slot
        line = self._lines.in_background() if is_drawn else ""
        if is_drawn and not line:
            self.reported.emit(NO_LINE)
            self._show_line(self._standing)
        else:
            self.follow(line)

    # What is done in more than one place.

    def _restart(self) -> None:
        """Begin anew on other drives: at the cursor, or near the beginning of the drive."""
        self._live.stop()
        self._release()
        self._followed = ""
        self._panes.show_one(None)
        self._stand(self._through(self._shared.cursor.position) or self._lines.start())

    def _through(self, position: PickedPosition | None) -> SectionPosition | None:
        """Where the section across what is followed goes through a place."""
        line = self._lines.drawn(self._followed) if self._followed else None
        if line is None:
            return None if position is None else self._lines.across_trajectory(position)
        if position is None:
            return SectionPosition(line, line.stations.length_m / 2)
        return self._lines.standing_at(line, position)

    def _stand(self, standing: SectionPosition | None) -> None:
        """Show the section that stands here, as the settings want it."""
        settings = self._settings
        if standing is not None:
            standing = replace(standing, width_m=settings.width_m, is_along=settings.is_along)
        self._standing = standing
        if self._pinned is not None and standing is not None:
            self._pinned = PinnedSections.at(standing)
        if self._pinned is None:
            self._panes.show_one(standing)
        else:
            self._panes.show_two(self._pinned)
        self._bar.show_pinned(is_pinned=self.is_pinned)
        self._show_line(standing)
        if self.cut != self._told_cut:
            self._told_cut = self.cut
            self.cut_changed.emit(self._told_cut)

    def _show_line(self, standing: SectionPosition | None) -> None:
        is_drawn = standing is not None and bool(standing.line.feature)
        self._bar.show_line(is_drawn=is_drawn, has_axis=self._lines.axis is not None)

    def _release(self) -> None:
        if self._pinned is not None:
            self._pinned = None
            self.pinned_changed.emit(self.is_pinned)

    def _take_down(self) -> None:
        self._live.stop()
        self._panes.take_down()


def drawn_lines(features: Iterable[Feature], catalogue: Catalogue) -> tuple[DrawnLine, ...]:
    """The features that nobody rejected, by the layer and the colour of their kind."""
    return tuple(
        _line_of(feature, catalogue)
        for feature in features
        if feature.status is not Status.REJECTED
    )


def _line_of(feature: Feature, catalogue: Catalogue) -> DrawnLine:
    name, layer, aci = Text.same(feature.kind), _UNKNOWN_LAYER, _UNKNOWN_ACI
    if feature.kind in catalogue:
        kind = catalogue[feature.kind]
        name, layer, aci = kind.name, kind.layer, kind.aci
    positions = np.array([vertex.xyz for vertex in feature.vertices])
    return DrawnLine(name, layer, aci, positions, is_closed=feature.geometry is Geometry.AREA)


def position_of_step(standing: SectionPosition, drives: Sequence[Drive]) -> PickedPosition:
    """The line's own place, or the measured point that stands for it.

    Below a trajectory it is a point of the ground; on a drawn line one within a decimetre. Drives
    whose tiles aren't there yet are not waited for.
    """
    cut = standing.turned(is_along=False).cut
    own = sorted(drives, key=lambda drive: drive.id != standing.line.drive)
    for drive in own:
        if not can_search(drive):
            continue
        if standing.line.feature:
            point = nearest_point(drive, np.array(cut.middle), _SAME_M)
        else:
            point = ground_near(drive, replace(cut, width_m=min(cut.width_m, 1.0)))
        if point >= 0:
            return position_of(drive, point)
    return PickedPosition(cut.middle)

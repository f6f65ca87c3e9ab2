"""Wiring of the hand: toolbox, drawing bar, snapping and the menus of the views."""

from __future__ import annotations

from PySide6.QtCore import QObject, Qt, QTimer
from PySide6.QtGui import QAction, QCursor, QKeySequence
from PySide6.QtWidgets import QMenu

from app.drawing.draw_actions import NUMBER_KEYS, kind_title
from app.window.window_parts import WindowParts
from processing.map.catalogue import FeatureKind, Geometry
from widgets.feature_drawing.swatch import swatch_of
from widgets.mouse_tools.drawing.draw_parallel import DrawParallel
from widgets.mouse_tools.drawing.measure import MeasureTool
from widgets.mouse_tools.gesture import REACH_PX
from widgets.mouse_tools.menu_request import MenuRequest
from widgets.parts.command_palette import CommandPalette, NamedAction
from widgets.parts.literal_text import literal
from widgets.shared.cursor import PickedPosition
from widgets.shared.mouse_shape import drawing_cursor
from widgets.shared.snap_state import SnapMode

_OF_LINES = (
    ("tool-edit", "tool-parallel", "continue-line"),
    ("join", "reverse", "simplify"),
)
_OF_ANY = (
    ("copy", "cut", "paste", "delete"),
    ("status-accepted", "status-rejected", "select-kind"),
)
_OF_NONE = (("paste",),)
_ALWAYS = (("plane-level", "plane-fitted", "plane-off"),)


def connect_drawing(parts: WindowParts) -> None:
    """Connect what draws; again for new widgets."""
    wiring = _DrawingWiring(parts)
    toolbox, bar, snap = parts.toolbox, parts.drawing_bar, parts.document.shared.snap
    toolbox.tool_chosen.connect(bar.show_tool)
    toolbox.tool_chosen.connect(parts.status_line.clearMessage)
    toolbox.kind_chosen.connect(bar.show_kind)
    bar.kind_wanted.connect(wiring.on_bar_kind_wanted)
    bar.snaps_wanted.connect(wiring.on_bar_snaps_wanted)
    bar.entered.connect(wiring.on_bar_entered)
    for parallel in toolbox.tools_of(DrawParallel):
        bar.distance_set.connect(parallel.fix_distance)
        bar.rise_set.connect(parallel.set_rise)
    for measure in toolbox.tools_of(MeasureTool):
        measure.measured.connect(bar.show_measures)
    snap.modes_changed.connect(wiring.on_snap_modes_changed)
    parts.document.shared.sketch.changed.connect(wiring.on_sketch_changed)
    for view in parts.views:
        view.menu_requested.connect(wiring.on_view_menu_requested)
    parts.document.opened.connect(wiring.on_document_opened)
    parts.document.opened.connect(wiring.give_keys_to_the_image)
    parts.document.closed.connect(parts.status_line.clearMessage)
    parts.document.catalogue_changed.connect(wiring.on_document_opened)
    parts.document.catalogue_changed.connect(parts.layers_panel.read_catalogue)
    wiring.keep_tab_to_views()
    bar.show_kind(toolbox.kind)
    bar.show_tool(toolbox.name)


class _DrawingWiring(QObject):
    """What has to be translated between the hand and the window."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts
        self._vertices = 0
        # Views are drawn anew for the first and the last vertex that come in one round of events.
        self._has_more = False
        self._round = QTimer(self, singleShot=True, interval=0)
        self._round.timeout.connect(self._on_round_over)

    def on_sketch_changed(self) -> None:
        """Let section, camera and the other views follow each vertex of what is drawn anew."""
        shared = self._parts.document.shared
        drawing = shared.sketch.drawing
        vertices = () if drawing is None or drawing.replaces else drawing.vertices
        has_grown = len(vertices) > self._vertices
        self._vertices = len(vertices)
        if has_grown and self._round.isActive():
            self._has_more = True
        elif has_grown:
            self._round.start()
            self._move_cursor()

    def _on_round_over(self) -> None:
        if self._has_more:
            self._has_more = False
            self._move_cursor()

    def _move_cursor(self) -> None:
        shared = self._parts.document.shared
        drawing = shared.sketch.drawing
        if drawing is not None and drawing.vertices:
            last = drawing.vertices[-1]
            position = PickedPosition(last.xyz, last.measured, is_occluded=last.is_occluded)
            shared.cursor.move_to(position)

    def keep_tab_to_views(self) -> None:
        """Tab changes the kind over the views only: in forms it goes from field to field."""
        cycle = self._parts.window.actions_by_id["cycle-kind"]
        cycle.setShortcutContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
        self._parts.window.removeAction(cycle)
        for view in self._parts.views:
            view.addAction(cycle)

    def on_document_opened(self) -> None:
        toolbox, catalogue = self._parts.toolbox, self._parts.document.catalogue()
        kind = toolbox.kind
        if kind is not None and (kind.id not in catalogue or catalogue[kind.id] != kind):
            toolbox.forget_kinds()
            self._parts.drawing_bar.show_kind(None)
        actions = self._parts.window.actions_by_id
        for key in NUMBER_KEYS:
            title = kind_title(self._parts, key)
            actions[f"kind-key-{key}"].setText(literal(title.in_language(self._parts.language)))

    def give_keys_to_the_image(self) -> None:
        """Keys that draw and judge work in what was just opened, without a click into a view."""
        self._parts.image_view.setFocus()

    def on_bar_kind_wanted(self) -> None:
        show_kind_palette(self._parts)

    def on_bar_entered(self) -> None:
        self._parts.toolbox.complete()
        self._parts.image_view.setFocus()

    def on_bar_snaps_wanted(self) -> None:
        menu = QMenu(self._parts.drawing_bar)
        actions = self._parts.window.actions_by_id
        for mode in SnapMode:
            menu.addAction(actions[f"snap-{mode.value}"])
        menu.addSeparator()
        for name in ("plane-level", "plane-fitted", "plane-off"):
            menu.addAction(actions[name])
        menu.aboutToHide.connect(menu.deleteLater)
        menu.popup(QCursor.pos())

    def on_snap_modes_changed(self) -> None:
        actions, modes = self._parts.window.actions_by_id, self._parts.document.shared.snap.modes
        for mode in SnapMode:
            actions[f"snap-{mode.value}"].setChecked(mode in modes)
        picture = self._parts.scene_view.picture
        if picture is not None:
            picture.setCursor(drawing_cursor(modes, REACH_PX))

    def on_view_menu_requested(self, request: MenuRequest) -> None:
        document = self._parts.document
        feature = document.feature(request.hit.feature) if request.hit.feature else None
        selection = document.shared.selection
        if feature is not None and feature.id not in selection.features:
            selection.choose_features(frozenset({feature.id}))
        chosen = [document.feature(id_) for id_ in selection.features]
        has_lines = any(one is not None and one.geometry is Geometry.LINE for one in chosen)
        groups = (
            *(_OF_LINES if has_lines else ()),
            *(_OF_ANY if chosen else _OF_NONE),
            *_ALWAYS,
        )
        if request.hit.position is not None:
            document.shared.cursor.move_to(request.hit.position)
        own = request.menu.actions()
        actions = self._parts.window.actions_by_id
        for group in groups:
            request.menu.insertActions(own[0], [actions[name] for name in group])
            request.menu.insertSeparator(own[0])
        request.menu.popup(request.where)


def show_kind_palette(parts: WindowParts) -> None:
    """Let the user choose what to draw by typing a part of its name in either language."""
    recent = [kind.id for kind in parts.toolbox.recent_kinds]
    kinds = named_kinds(parts)
    palette = CommandPalette(kinds, parts.language, parts.window.centralWidget(), used=recent)
    for one in kinds:
        one.action.setParent(palette)  # a hundred actions that would stay behind each time
    palette.setWindowTitle(parts.window.tr("What to draw"))
    palette.show()


def named_kinds(parts: WindowParts) -> list[NamedAction]:
    """All kinds as actions that choose them."""
    return [_name_action(parts, kind) for kind in parts.document.catalogue()]


def _name_action(parts: WindowParts, kind: FeatureKind) -> NamedAction:
    action = QAction(literal(kind.name.in_language(parts.language)), parts.window.centralWidget())
    action.setIcon(swatch_of(kind.colour))
    action.setShortcut(QKeySequence(kind.key))
    action.triggered.connect(lambda: parts.toolbox.choose_kind(kind))
    return NamedAction(f"kind-{kind.id}", kind.name, action)

"""Draw actions: the tool in the hand, what it draws, what it snaps to."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.classes.label_actions import choose_class, label_actions
from app.drawing.map_edits import MapEdits
from app.drawing.tool_entries import SNAP_HINTS, TOOL_ENTRIES, ToolEntry
from app.drawing.working_planes import level_plane, plane_of_points
from app.window.action import Action, grouped, map_action
from app.window.window_parts import WindowParts
from processing.core.text import Text
from widgets.mouse_tools.drawing.measure import MeasureTool
from widgets.shared.snap_state import SNAP_NAMES, SnapMode

_draw = partial(map_action, menu="draw")
_plane = partial(map_action, menu="draw/plane")
_widths = partial(map_action, menu="draw/widths")
_DRAWING, _CHANGING, _MEASURING = "point", "edit", "measure"
"""Tools with which a group of the menu begins."""

NUMBER_KEYS = ("1", "2", "3", "4", "5", "6", "7", "8", "9", "0")


def draw_actions(parts: WindowParts) -> tuple[Action, ...]:
    """The draw menu: tools, the drawing at hand, kinds, snapping, the working plane."""
    return grouped(
        *_tool_groups(parts),
        _at_hand_actions(parts),
        _kind_actions(parts),
        (*_snap_actions(parts), *_plane_actions(parts), *label_actions(parts)),
    )


def _tool_groups(parts: WindowParts) -> tuple[list[Action], ...]:
    """Those that choose, draw, change, measure and paint."""
    groups: list[list[Action]] = [[]]
    for entry in TOOL_ENTRIES:
        if entry.name in (_DRAWING, _CHANGING, _MEASURING):
            groups.append([])
        groups[-1].append(_tool_action(parts, entry))
    return tuple(groups)


def _tool_action(parts: WindowParts, entry: ToolEntry) -> Action:
    def choose() -> None:
        parts.toolbox.choose(entry.name)

    return Action(
        f"tool-{entry.name}",
        entry.text,
        choose,
        entry.menu,
        (entry.key,) if entry.key else (),
        entry.icon,
        entry.toolbar,
        is_checkable=True,
        group="tool",
        hint=entry.hint,
        needs_project=True,
        is_checked=parts.toolbox.name == entry.name,
    )


def _at_hand_actions(parts: WindowParts) -> tuple[Action, ...]:
    toolbox, document = parts.toolbox, parts.document

    def keep() -> None:
        tool = toolbox.tool
        if isinstance(tool, MeasureTool):
            tool.keep()

    def go_on() -> None:
        chosen = [document.feature(id_) for id_ in document.shared.selection.features]
        toolbox.continue_line([feature for feature in chosen if feature is not None])

    return (
        _draw(
            "close-drawing",
            Text("Close the drawing", "作図を閉じる"),
            toolbox.close_drawing,
            "C",
            Text(
                "Leads the line or area back to its first vertex.", "最初の頂点に戻して閉じます。"
            ),
        ),
        _draw(
            "continue-line",
            Text("Continue the chosen line", "選択した線の続きを描く"),
            go_on,
            "Shift+C",
            Text("Goes on at the end nearest to the cursor.", "カーソルに近い端から続けます。"),
        ),
        _widths(
            "measure-width",
            Text("Width between two chosen lines", "選択した2本の線の幅"),
            MapEdits(document).report_width,
            "Ctrl+Shift+W",
            Text(
                "Least, mean and greatest width in plan, square to the first line.",
                "1本目の線に直角に測った、平面上の最小・平均・最大幅を表示します。",
            ),
        ),
        _widths(
            "keep-width",
            Text("Keep the width between two chosen lines", "選択した2本の線の幅を保存"),
            MapEdits(document).keep_width,
            "",
            Text(
                "As a measurement across them, with the mean width.",
                "平均幅を持つ計測線として保存します。",
            ),
        ),
        _widths(
            "keep-measurement",
            Text("Keep the measurement as a feature", "計測結果を地物として保存"),
            keep,
            "K",
            Text("With its numbers as attributes.", "計測値を属性として保存します。"),
        ),
    )


def _kind_actions(parts: WindowParts) -> tuple[Action, ...]:
    toolbox, document = parts.toolbox, parts.document

    def drawing(key: str) -> Callable[[], None]:
        def choose() -> None:
            kind = document.catalogue().of_key(key)
            if not choose_class(parts, key) and kind is not None:
                toolbox.choose_kind(kind)

        return choose

    return (
        _draw(
            "choose-kind",
            Text("Choose what to draw…", "作図する種別を選ぶ…"),
            parts.drawing_bar.choose_kind,
            "Ctrl+K",
            Text("All kinds of the catalogue by name.", "カタログの全種別から名前で選びます。"),
        ),
        _draw(
            "cycle-kind",
            Text("The kind drawn before", "前に描いた種別"),
            toolbox.cycle_kind,
            "Tab",
            Text("Goes round the kinds drawn last.", "最近使った種別を順に切り替えます。"),
        ),
        *(
            _draw(
                f"kind-key-{key}",
                kind_title(parts, key),
                drawing(key),
                key,
                menu="draw/kinds",
            )
            for key in NUMBER_KEYS
        ),
    )


def kind_title(parts: WindowParts, key: str) -> Text:
    """What a number key draws in the project's catalogue."""
    kind = parts.document.catalogue().of_key(key)
    if kind is None:
        return Text("Draw: (no kind has this key)", "作図:（このキーの種別なし）")
    return Text("Draw: {name}", "作図: {name}").filled(name=kind.name)


def _snap_actions(parts: WindowParts) -> tuple[Action, ...]:
    snap = parts.document.shared.snap

    def turning(mode: SnapMode) -> Callable[[], None]:
        def turn() -> None:
            snap.turn(mode, is_on=mode not in snap.modes)

        return turn

    return tuple(
        Action(
            f"snap-{mode.value}",
            Text("Snap to: {name}", "スナップ: {name}").filled(name=SNAP_NAMES[mode]),
            turning(mode),
            "draw/snap",
            (f"Alt+{number}",),
            is_checkable=True,
            is_checked=mode in snap.modes,
            needs_project=True,
            hint=SNAP_HINTS[mode],
        )
        for number, mode in enumerate(SnapMode, start=1)
    )


def _plane_actions(parts: WindowParts) -> tuple[Action, ...]:
    document = parts.document
    snap = document.shared.snap

    def level() -> None:
        plane = level_plane(document.shared)
        if plane is None:
            parts.status_line.show_message(NO_CURSOR)
        else:
            snap.work_on(plane)

    def fitted() -> None:
        plane = plane_of_points(document, document.shared)
        if plane is None:
            parts.status_line.show_message(NO_PLANE)
        else:
            snap.work_on(plane)

    def off() -> None:
        snap.work_on(None)

    return (
        _plane(
            "plane-level",
            Text("Work on a level plane at the cursor", "カーソル高の水平面で作図"),
            level,
            "H",
            Text(
                "Clicks land on it where points mislead, and are marked as without a point.",
                "点群が当てにならない所で、クリック位置を平面上に置きます（点なしの頂点として記録）。",
            ),
        ),
        _plane(
            "plane-fitted",
            Text("Work on a plane through the chosen points", "選択した点を通る平面で作図"),
            fitted,
            "Shift+H",
            Text(
                "Through the points chosen, or those within a metre of the cursor.",
                "選択した点（なければカーソルから1 m以内の点）に当てはめた平面を使います。",
            ),
        ),
        _plane(
            "plane-off",
            Text("Work on the measured points again", "計測点での作図に戻す"),
            off,
            "Ctrl+H",
        ),
    )


NO_CURSOR = Text(
    "Click a point first: the plane lies at its height.",
    "先に点をクリックしてください。その高さの水平面になります。",
)
NO_PLANE = Text(
    "Choose at least three points that are not in one line, or put the cursor on a surface.",
    "一直線上にない3点以上を選択するか、面の上にカーソルを置いてください。",
)

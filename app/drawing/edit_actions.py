"""Edit actions: steps back and forth, the clipboard, the selection, edits of what is chosen."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.drawing.map_edits import MapEdits
from app.window.action import NOTHING, Action, grouped, map_action
from app.window.window_parts import WindowParts
from processing.core.text import Text
from processing.map.feature import Feature, Status

_edit = partial(map_action, menu="edit")
_select = partial(map_action, menu="edit/select")
_lines = partial(map_action, menu="edit/lines")

TOLERANCES_CM = (1, 2, 5, 10)
"""What a vertex may be off the line and still go; the first is a good point's accuracy."""

_STATUSES = (
    (Status.ACCEPTED, Text("Accept", "採用"), "Ctrl+Return"),
    (Status.REJECTED, Text("Reject", "却下"), "Ctrl+Backspace"),
    (Status.CANDIDATE, Text("Make a candidate", "候補に戻す"), ""),
)


def edit_actions(parts: WindowParts) -> tuple[Action, ...]:
    """The edit menu, from top to bottom."""
    edits = MapEdits(parts.document)
    return grouped(
        _steps(parts),
        _clipboard(edits),
        (*_selections(parts, edits), *_line_edits(edits), *_statuses(edits)),
        (_numbering(edits), _widths(edits), _centre_lines(edits)),
    )


def _numbering(edits: MapEdits) -> Action:
    return _edit(
        "number-along-routes",
        Text("Number along the route", "路線に沿って番号・測点を記入"),
        edits.number_along_routes,
        "",
        Text(
            "Fills in number, route, station and side of what ledgers list; from the road's"
            " centre line. What is written stays.",
            "道路中心線をもとに、台帳の地物の整理番号・路線名・測点・左右を記入します。"
            "記入済みの値は変わりません。",
        ),
    )


def _widths(edits: MapEdits) -> Action:
    return _edit(
        "draw-widths",
        Text("Width lines along the route", "路線に沿って幅員線を作図"),
        edits.draw_widths,
        "",
        Text(
            "Draws the widths of carriageway and footways across the road, each 20 m and where"
            " they change by 0.5 m; lines drawn so before are replaced.",
            "20 mごとと、幅員が0.5 m以上変わる位置で、車道・歩道の幅員線を作図します。"
            "以前に自動作図した線は置き換えます。",
        ),
    )


def _centre_lines(edits: MapEdits) -> Action:
    return _edit(
        "draw-centre-lines",
        Text("Centre lines between the edges", "両側の縁の中間に道路中心線を作図"),
        edits.draw_centre_lines,
        "",
        Text(
            "Draws the road's centre line midway between accepted curbs, footways or road edges"
            " along the way that was driven; lines drawn so before are replaced.",
            "走行軌跡に沿って、採用済みの縁石・歩道・道路縁の中間に道路中心線を作図します。"
            "以前に自動作図した線は置き換えます。",
        ),
    )


def _steps(parts: WindowParts) -> tuple[Action, ...]:
    document, toolbox = parts.document, parts.toolbox

    def undo() -> None:
        # While something is drawn, its last vertex is the last step.
        if not toolbox.step_back():
            document.undo()

    return (
        Action(
            "undo",
            Text("Undo", "元に戻す"),
            undo,
            "edit",
            ("Ctrl+Z",),
            "mdi6.undo",
            2,
            hint=Text(
                "Without end, also after a restart; while drawing, the last vertex.",
                "再起動後も含めて何回でも戻せます。作図中は最後の頂点を戻します。",
            ),
            needs_project=True,
            why_disabled=Text("There is nothing to undo.", "元に戻す操作がありません。"),
        ),
        Action(
            "redo",
            Text("Redo", "やり直す"),
            document.redo,
            "edit",
            ("Ctrl+Y", "Ctrl+Shift+Z"),
            "mdi6.redo",
            2,
            needs_project=True,
            why_disabled=Text("Nothing was undone.", "やり直す操作がありません。"),
        ),
    )


def _clipboard(edits: MapEdits) -> tuple[Action, ...]:
    return (
        _edit(
            "copy",
            Text("Copy", "コピー"),
            edits.copy,
            "Ctrl+C",
            Text(
                "For this or another project, in any plane system.",
                "別の座標系のプロジェクトにも貼り付けられます。",
            ),
        ),
        _edit("cut", Text("Cut", "切り取り"), edits.cut, "Ctrl+X"),
        _edit(
            "paste",
            Text("Paste", "貼り付け"),
            edits.paste,
            "Ctrl+V",
            Text(
                "Features copied in any project, or GeoJSON; transformed where needed.",
                "他のプロジェクトでコピーした地物やGeoJSONを、必要なら座標変換して貼り付けます。",
            ),
        ),
        _edit(
            "delete",
            Text("Delete the selected features", "選択した地物を削除"),
            edits.delete,
        ),
    )


def _selections(parts: WindowParts, edits: MapEdits) -> tuple[Action, ...]:
    def same_kind(one: Feature, other: Feature) -> bool:
        return one.kind == other.kind

    def same_status(one: Feature, other: Feature) -> bool:
        return one.status is other.status

    def same_attributes(one: Feature, other: Feature) -> bool:
        return one.kind == other.kind and dict(one.attributes) == dict(other.attributes)

    def like(alike: Callable[[Feature, Feature], bool]) -> Callable[[], None]:
        return lambda: edits.select_like(alike)

    return (
        _select("select-all", Text("All features", "すべての地物"), edits.select_all, "Ctrl+A"),
        _select(
            "select-none",
            Text("Nothing", "選択を解除"),
            parts.document.shared.selection.clear,
            "Ctrl+Shift+A",
        ),
        _select(
            "select-kind",
            Text("All of the same kind", "同じ種別をすべて選択"),
            like(same_kind),
            "Ctrl+Shift+K",
        ),
        _select(
            "select-status",
            Text("All of the same status", "同じ状態をすべて選択"),
            like(same_status),
        ),
        _select(
            "select-attributes",
            Text("All with the same attributes", "同じ属性をすべて選択"),
            like(same_attributes),
        ),
        _select(
            "select-occluded",
            Text("With vertices without a measured point", "計測点のない頂点を持つ地物"),
            edits.select_occluded,
            "",
            Text(
                "Their heights come from neighbours; they are shown hollow.",
                "高さを周囲から補った頂点です。白抜きで表示されます。",
            ),
        ),
    )


def _line_edits(edits: MapEdits) -> tuple[Action, ...]:
    return (
        _lines(
            "join",
            Text("Join", "結合"),
            edits.join,
            "J",
            Text(
                "Makes one line of several, at their nearest ends.",
                "近い端どうしをつないで1本にします。",
            ),
        ),
        _lines("reverse", Text("Reverse", "向きを反転"), edits.reverse, "Shift+V"),
        _lines("close-lines", Text("Close", "閉じる"), edits.close),
        _lines("open-lines", Text("Open", "開く"), edits.open),
        *(_simplifying(edits, tolerance_cm) for tolerance_cm in TOLERANCES_CM),
    )


def _simplifying(edits: MapEdits, tolerance_cm: int) -> Action:
    def simplify() -> None:
        edits.simplify(tolerance_cm / 100)

    text = Text("Simplify to {cm} cm", "単純化（許容値 {cm} cm）").filled(cm=tolerance_cm)
    hint = Text(
        "Takes out vertices that lie less than {cm} cm off the line between others.",
        "前後を結ぶ線から{cm} cm以内の頂点を取り除きます。",
    ).filled(cm=tolerance_cm)
    is_first = tolerance_cm == TOLERANCES_CM[0]
    key = "Ctrl+M" if is_first else ""
    id_ = "simplify" if is_first else f"simplify-{tolerance_cm}"
    return _lines(id_, text, simplify, key, hint)


def _statuses(edits: MapEdits) -> tuple[Action, ...]:
    def setting(status: Status, name: Text) -> Callable[[], None]:
        return lambda: edits.set_status(status, name)

    return tuple(
        map_action(
            f"status-{status.value}",
            name,
            setting(status, name),
            key,
            NOTHING,
            menu="edit/status",
        )
        for status, name, key in _STATUSES
    )

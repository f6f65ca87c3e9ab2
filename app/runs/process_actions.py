"""Process actions: road tools run by one click, each tool's form, and the end of running jobs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from app.classes.class_learning import ClassLearning
from app.window.action import Action, grouped
from app.window.window_parts import WindowParts
from processing.core.text import Text
from processing.operations.learn import LEARN
from processing.tools.listed.registry import TOOLS, extractors, tools_of_drives
from processing.tools.tool import ToolButton
from processing.tools.volume import VOLUME

_TOOLBAR = 5
_HINT = Text("{explanation} {way}", "{explanation}{way}")
_FORM = Text("{name}…", "{name}…")
_WAY = Text(
    "Runs as the form in Processing stands; what is found goes to the review.",
    "処理パネルの設定で実行し、結果は確認パネルに候補として並びます。",
)


def one_click_buttons() -> Mapping[str, ToolButton]:
    """The buttons of the tools that have one, by the tools' ids."""
    return {tool.id: tool.button for tool in TOOLS.values() if tool.button is not None}


_FIRST = ("curbs", "gutters", "trees", "signs", "poles", "wires")
"""What stands in the menu itself and in the toolbar, where the drive and its image are chosen, too;
what else one click finds is a menu further, with its key."""

FIND_ALL = "run-extractors"
"""Id of the action that runs all of them that find things."""


def run_action_of(tool: str) -> str:
    """Id of the action that runs a tool by one click."""
    return f"run-{tool}"


def process_actions(parts: WindowParts) -> tuple[Action, ...]:
    """The process menu, from top to bottom."""
    shown = tools_of_drives()

    def running(tool: str, button: ToolButton) -> Action:
        def run() -> None:
            parts.processing_panel.run_tool(tool)

        return Action(
            run_action_of(tool),
            button.text,
            run,
            "process" if tool in _FIRST else "process/map",
            (button.key,),
            button.icon,
            toolbar=_TOOLBAR if tool in _FIRST else 0,
            hint=_HINT.filled(explanation=TOOLS[tool].explanation, way=_WAY),
            needs_project=True,
        )

    def showing(tool: str) -> Action:
        def show() -> None:
            parts.window.show_panel("processing")
            parts.processing_panel.show_tool(tool)

        # What one click runs stands there by that name; its form is one menu further.
        return Action(
            f"process-{tool}",
            _FORM.filled(name=shown[tool].name),
            show,
            "process" if shown[tool].button is None else "process/settings",
            hint=shown[tool].explanation,
            needs_project=True,
        )

    def cancel_all() -> None:
        for status in parts.jobs.statuses:
            parts.jobs.cancel(status.id)

    cancel = Action(
        "cancel-jobs", Text("Cancel all jobs", "すべてのジョブを中止"), cancel_all, "process"
    )
    one_click = [running(tool, button) for tool, button in one_click_buttons().items()]
    settings = [showing(tool) for tool in one_click_buttons()]
    others = [showing(tool) for tool in shown if tool not in one_click_buttons()]
    return grouped(
        (_find_all_action(parts), *one_click, *settings),
        (*others, _learning_action(parts)),
        _volume_actions(parts),
        (cancel,),
    )


def _find_all_action(parts: WindowParts) -> Action:
    """All extractors, queued one after another; those that can't run are passed over."""

    def find_all() -> None:
        for tool in extractors():
            parts.processing_panel.run_tool(tool)

    return Action(
        FIND_ALL,
        Text("Find all", "すべて抽出"),
        find_all,
        "process",
        ("Ctrl+F10",),
        "mdi6.auto-fix",
        toolbar=_TOOLBAR,
        hint=_HINT.filled(
            explanation=Text(
                "Looks for everything that can be found along a street, one kind after another.",
                "道路沿いで抽出できる地物を、種類ごとに順に抽出します。",
            ),
            way=_WAY,
        ),
        needs_project=True,
    )


def _learning_action(parts: WindowParts) -> Action:
    """What was painted becomes a model of classes."""
    return Action(
        "learn-classes",
        LEARN,
        parts.of(ClassLearning).learn,
        "process",
        hint=Text(
            "Makes a model for “Classes” of the labels that were painted by hand in this project, "
            "and says how much it helps.",
            "このプロジェクトで手動で塗ったラベルから「点群の分類」のモデルを学習し、"
            "改善の程度を示します。",
        ),
        needs_project=True,
    )


def _volume_actions(parts: WindowParts) -> tuple[Action, ...]:
    """Earth between two grounds: the panel that computes it, and its map."""

    def show_volume() -> None:
        parts.window.show_panel("volume")

    def toggle_heat_map() -> None:
        volume = parts.document.shared.volume
        volume.use_look(replace(volume.look, is_shown=not volume.look.is_shown))

    volume = Action(
        "volume",
        Text("Volume…", "土量計算…"),
        show_volume,
        "process",
        ("Ctrl+F9",),
        hint=VOLUME.explanation,
        needs_project=True,
    )
    heat_map = Action(
        "heat-map",
        Text("Heat map of the volume", "土量のヒートマップ"),
        toggle_heat_map,
        "process",
        ("Ctrl+Shift+F9",),
        hint=Text(
            "Shows the difference of heights in the map, in 3D and in the section, or hides it.",
            "標高差を地図・3D・断面に表示、または非表示にします。",
        ),
        is_checkable=True,
        is_checked=parts.document.shared.volume.look.is_shown,
        needs_project=True,
    )
    return volume, heat_map

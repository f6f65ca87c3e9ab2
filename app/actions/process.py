"""Process actions: each tool's form, and the end of running jobs."""

from __future__ import annotations

from app.actions.action import Action
from app.window_parts import WindowParts
from processing.text import Text
from processing.tools.registry import TOOLS


def process_actions(parts: WindowParts) -> tuple[Action, ...]:
    """The process menu, from top to bottom."""

    def showing(tool: str) -> Action:
        def show() -> None:
            parts.processing_panel.show_tool(tool)

        return Action(
            f"process-{tool}",
            TOOLS[tool].name,
            show,
            "process",
            hint=TOOLS[tool].explanation,
            needs_project=True,
        )

    def cancel_all() -> None:
        for status in parts.jobs.statuses:
            parts.jobs.cancel(status.id)

    cancel = Action(
        "cancel-jobs", Text("Cancel all jobs", "すべてのジョブを中止"), cancel_all, "process"
    )
    return (*(showing(tool) for tool in TOOLS), cancel)

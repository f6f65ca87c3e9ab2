"""What runs are called: the tool, when it was run, and what became of its candidates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import QDateTime, QLocale

from processing.core.parameters import parameters_of
from processing.core.text import Language, Text
from processing.map.renewal.map_comparison import COMPARISON, COMPARISON_NAME
from processing.project.store.runs import Run
from processing.tools.listed.registry import TOOLS
from widgets.panels.feature_tally import RunOfTool, RunTally
from widgets.panels.feature_words import words_of_value

_LONGEST = 40
_MOMENT = Text("d MMM HH:mm", "M月d日 HH:mm")
_NAMED = Text("{tool}, {moment}", "{tool} {moment}")
_SHORT = Text(
    "{candidates} left  ✓ {accepted}  ✗ {rejected}", "残り{candidates}  ✓ {accepted}  ✗ {rejected}"
)
_COUNTS = Text(
    "{candidates} candidates · {accepted} accepted · {rejected} rejected",
    "候補{candidates} · 採用{accepted} · 却下{rejected}",
)


def name_of_tool(tool: str, language: Language) -> str:
    """A tool's name; its id where the program no longer has it."""
    if tool == COMPARISON:
        return COMPARISON_NAME.in_language(language)
    return TOOLS[tool].name.in_language(language) if tool in TOOLS else tool


def name_of_run(origin: RunOfTool, runs: Mapping[str, Run], language: Language) -> str:
    """The tool and, where the project knows it, the moment in local time."""
    tool = name_of_tool(origin.tool, language)
    run = runs.get(origin.run)
    if run is None:
        return tool
    started = QDateTime.fromSecsSinceEpoch(int(run.started.timestamp()))
    moment = QLocale(language).toString(started, _MOMENT.in_language(language))
    return _NAMED.filled(tool=tool, moment=moment).in_language(language)


def counts_of_run(tally: RunTally, language: Language, *, is_short: bool = False) -> str:
    """What was decided, in words or, where there is little room, in signs."""
    text = _SHORT if is_short else _COUNTS
    return text.filled(
        candidates=f"{tally.candidates:,}",
        accepted=f"{tally.accepted:,}",
        rejected=f"{tally.rejected:,}",
    ).in_language(language)


def facts_of_run(run: Run, drive_names: Sequence[str], language: Language) -> list[str]:
    """Lines for a tooltip: the drives, the tool's version, and the parameters with units."""
    lines = [*drive_names, f"{run.tool} {run.version}"]
    declared = {}
    if run.tool in TOOLS:
        declared = {one.id: one for one in parameters_of(TOOLS[run.tool].parameters)}
    for id_, value in run.parameters.items():
        parameter = declared.get(id_)
        name = id_ if parameter is None else parameter.name.in_language(language)
        unit = "" if parameter is None else parameter.unit
        words = words_of_value(value, None, language)
        if len(words) > _LONGEST:
            words = f"{words[:_LONGEST]}…"
        lines.append(f"{name}: {words} {unit}".rstrip())
    return lines

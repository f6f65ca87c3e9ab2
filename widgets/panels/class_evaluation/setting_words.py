"""Settings of a tool in words: what was chosen, and what is not as usual."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QDateTime, QLocale

from processing.core.parameters import Parameter, ParameterValue, parameters_of
from processing.core.text import Language, Text
from processing.project.evaluation.truth_store import Truth
from processing.project.store.runs import Run
from processing.tools.listed.registry import TOOLS

_MOMENT = Text("d MMM HH:mm", "M月d日 HH:mm")
_NAMED_TRUTH = Text("{name}, {moment}", "{name}（{moment}）")


def parameter_of(tool: str, id_: str) -> Parameter | None:
    """The declaration of a parameter; None where the program no longer has it."""
    if tool not in TOOLS:
        return None
    return next((one for one in parameters_of(TOOLS[tool].parameters) if one.id == id_), None)


def parameter_name(tool: str, id_: str, language: Language) -> str:
    """What a parameter is called, with its unit."""
    parameter = parameter_of(tool, id_)
    if parameter is None:
        return id_
    unit = f" [{parameter.unit}]" if parameter.unit else ""
    return parameter.name.in_language(language) + unit


def value_words(tool: str, id_: str, value: object, language: Language) -> str:
    """A value as people read it: the name of a choice, a number without idle zeros."""
    parameter = parameter_of(tool, id_)
    if parameter is not None:
        for choice in parameter.choices:
            if choice.value == value:
                return choice.name.in_language(language)
    if isinstance(value, bool):
        return "✓" if value else "–"
    return f"{value:g}" if isinstance(value, float) else str(value)


def settings_words(
    tool: str, values: Mapping[str, ParameterValue | None], language: Language
) -> str:
    """All choices, and the other values that are not the default: ``Radius (ROR), 0.3 m``."""
    words = []
    for id_, value in values.items():
        parameter = parameter_of(tool, id_)
        if parameter is None or value is None:
            continue
        if parameter.kind == "choice":
            words.append(value_words(tool, id_, value, language))
        elif value != parameter.default:
            reported = value_words(tool, id_, value, language)
            name = parameter.name.in_language(language)
            words.append(f"{name} {reported} {parameter.unit}".rstrip())
    return ", ".join(words)


def moment_of(run: Run, language: Language) -> str:
    """When a run began, in local time."""
    return _moment(run.started.timestamp(), language)


def name_of_truth(truth: Truth, language: Language) -> str:
    """What a truth is called, and when it was made."""
    moment = _moment(truth.made.timestamp(), language)
    return _NAMED_TRUTH.filled(name=truth.name, moment=moment).in_language(language)


def _moment(seconds: float, language: Language) -> str:
    started = QDateTime.fromSecsSinceEpoch(int(seconds))
    return QLocale(language).toString(started, _MOMENT.in_language(language))

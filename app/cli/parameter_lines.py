"""Declared parameters as lines of help: how each is written, its unit, limits, default, name."""

from __future__ import annotations

from processing.core.parameters import parameters_of
from processing.core.text import Language


def parameter_lines(parameters: type[object], language: Language) -> list[str]:
    """One line for each field of a parameter class."""
    lines = []
    for parameter in parameters_of(parameters):
        limits = f" ({parameter.low:.10g} … {parameter.high:.10g})" if parameter.high else ""
        words = " | ".join(option.value for option in parameter.choices)
        unit = f" {parameter.unit}" if parameter.unit else ""
        name = parameter.name.in_language(language)
        lines.append(f"  --set {parameter.id}={parameter.default}{unit}{limits} {words} {name}")
    return lines

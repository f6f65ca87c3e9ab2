"""``zuka tools``: every processing tool, its inputs, outputs and parameters."""

from __future__ import annotations

import argparse

from app.cli.output import print_json, print_lines
from app.cli.parameter_lines import parameter_lines
from app.settings.language import system_language
from processing.core.parameters import Parameter, parameters_of
from processing.tools.listed.registry import every_tool
from processing.tools.running.runner import any_tool
from processing.tools.tool import Comparison, NewPoints, NewPointsTogether, SurveyCorrection, Tool


def command(arguments: argparse.Namespace) -> int:
    """List all tools, or one."""
    chosen = [any_tool(arguments.name)] if arguments.name else list(every_tool().values())
    if arguments.json:
        described = [_describe_tool(tool) for tool in chosen]
        print_json(described[0] if arguments.name else described)
    else:
        for tool in chosen:
            print_lines(*_lines(tool))
    return 0


def _describe_tool(tool: Tool) -> dict[str, object]:
    return {
        "id": tool.id,
        "version": tool.version,
        "name": {"en": tool.name.en, "ja": tool.name.ja},
        "explanation": {"en": tool.explanation.en, "ja": tool.explanation.ja},
        "needs": tool.needs.value,
        "gives": _gives(tool),
        "outputs": [
            {"name": column.name, "type": column.dtype, "values": column.width}
            for column in tool.outputs
        ],
        "makes": list(tool.makes),
        "parameters": [_parameter(parameter) for parameter in parameters_of(tool.parameters)],
    }


def _gives(tool: Tool) -> str:
    if isinstance(tool.method, Comparison):
        return "volumes"
    if isinstance(tool.method, NewPoints | NewPointsTogether):
        return "points"
    if isinstance(tool.method, SurveyCorrection):
        return "corrections"
    return "candidates" if tool.gives_candidates else "columns"


def _parameter(parameter: Parameter) -> dict[str, object]:
    has_limits = parameter.kind in ("number", "count")
    return {
        "id": parameter.id,
        "kind": parameter.kind,
        "unit": parameter.unit,
        "default": parameter.default,
        "low": parameter.low if has_limits else None,
        "high": parameter.high if has_limits else None,
        "choices": [option.value for option in parameter.choices],
        "name": {"en": parameter.name.en, "ja": parameter.name.ja},
        "explanation": {"en": parameter.explanation.en, "ja": parameter.explanation.ja},
    }


def _lines(tool: Tool) -> list[str]:
    language = system_language()
    outputs = ", ".join(column.name for column in tool.outputs) or _gives(tool)
    lines = [
        f"{tool.id}  {tool.name.in_language(language)}",
        f"  {tool.explanation.in_language(language)}",
        f"  {tool.needs.value} -> {outputs}",
    ]
    return [*lines, *parameter_lines(tool.parameters, language)]

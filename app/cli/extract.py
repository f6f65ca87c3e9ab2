"""``zuka extract``: every tool that finds things, on a project or on delivered files."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.cli.opened import inputs_of, terminal_monitor
from app.cli.output import print_lines
from app.cli.set_option import settings_of_words
from app.cli.terminal import BAD_INPUT, DONE, say
from app.settings.language import system_language
from processing.core.errors import OutOfRange
from processing.core.text import Text
from processing.operations.extraction import ExtractOperation, Extractor, extract
from processing.tools.listed.registry import extractors


def command(arguments: argparse.Namespace) -> int:
    """Run all extractors; write their results to a folder, or store them in the project."""
    outcome = extract(operation_of(arguments), terminal_monitor())
    language = system_language()
    print_lines(*(words.in_language(language) for words in outcome.words))
    for error in outcome.refused.values():
        say(error.line(language))
    return BAD_INPUT if outcome.has_failed else DONE


def operation_of(arguments: argparse.Namespace) -> ExtractOperation:
    """The operation that a command's arguments ask for.

    Raises
    ------
    MissingInput, OutOfRange
        They name no input, or a setting of no tool that is to run.
    """
    named = [word.strip() for word in arguments.tools.split(",") if word.strip()]
    settings = settings_of_words(arguments.set)
    chosen = named or list(extractors())
    found = tuple(Extractor(tool, _settings_of(tool, settings)) for tool in chosen)
    for name in settings:
        if name.partition(".")[0] not in chosen or "." not in name:
            raise OutOfRange(
                Text(
                    "This is a setting of no tool that runs.",
                    "実行するツールの設定ではありません。",
                ),
                Text.same(f"--set {name}"),
                Text(
                    "Write --set TOOL.NAME=VALUE, for instance curbs.lowest_m=0.02.",
                    "--set ツール.名前=値 の形で指定してください（例: curbs.lowest_m=0.02）。",
                ),
            )
    output: Path | None = arguments.out
    return ExtractOperation(inputs_of(arguments), found, output, arguments.accept_above)


def _settings_of(tool: str, settings: dict[str, str]) -> dict[str, str]:
    start = f"{tool}."
    return {
        name.removeprefix(start): value
        for name, value in settings.items()
        if name.startswith(start)
    }

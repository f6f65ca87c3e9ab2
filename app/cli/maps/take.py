"""``zuka map``: a map that was delivered before becomes part of a project, or is compared."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines, print_notes
from app.settings.language import system_language
from processing.core.text import Text
from processing.map.renewal.map_comparison import ComparisonLimits
from processing.operations.map_steps import (
    CompareMapOperation,
    TakeMapOperation,
    compare_map,
    take_map,
)


def command(arguments: argparse.Namespace) -> int:
    """Take a map in or compare it, and say what was left out."""
    first, *notes = _done(arguments)
    print_notes(*(words.in_language(system_language()) for words in notes))
    print_lines(first.in_language(system_language()))
    return 0


def _done(arguments: argparse.Namespace) -> tuple[Text, ...]:
    whole = arguments.project, arguments.file, arguments.crs, arguments.kind
    if not arguments.compare:
        return take_map(TakeMapOperation(*whole), terminal_monitor()).words
    usual = ComparisonLimits()
    limits = ComparisonLimits(
        usual.tolerance_m if arguments.tolerance is None else arguments.tolerance,
        usual.search_m if arguments.search is None else arguments.search,
    )
    return compare_map(CompareMapOperation(*whole, limits), terminal_monitor()).words

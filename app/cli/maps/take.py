"""``zuka map``: a map that was delivered before becomes features of a project."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines, print_notes
from app.settings.language import system_language
from processing.operations.map_steps import TakeMapOperation, take_map


def command(arguments: argparse.Namespace) -> int:
    """Take a map in, and say what was left out."""
    operation = TakeMapOperation(arguments.project, arguments.file, arguments.crs, arguments.kind)
    first, *notes = take_map(operation, terminal_monitor()).words
    print_notes(*(words.in_language(system_language()) for words in notes))
    print_lines(first.in_language(system_language()))
    return 0

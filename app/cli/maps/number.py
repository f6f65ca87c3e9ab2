"""``zuka number``: a project's ledgers numbered along its routes."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines
from app.settings.language import system_language
from processing.operations.map_steps import NumberOperation, number_features


def command(arguments: argparse.Namespace) -> int:
    """Fill in what ledgers don't say yet, and say for how many features."""
    numbered = number_features(NumberOperation(arguments.project), terminal_monitor())
    print_lines(*(words.in_language(system_language()) for words in numbered.words))
    return 0

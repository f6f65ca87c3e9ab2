"""``zuka macro``: what a project was put through, written as steps that can be done again."""

from __future__ import annotations

import argparse

from app.cli.output import print_lines
from app.settings.language import system_language
from processing.core.text import Text
from processing.operations.batch.macro import record_macro

_WRITTEN = Text("{path}: {count} steps", "{path}: {count}手順")


def command(arguments: argparse.Namespace) -> int:
    """Write a project's runs as a macro."""
    count = record_macro(arguments.project, arguments.output)
    words = _WRITTEN.filled(path=str(arguments.output), count=str(count))
    print_lines(words.in_language(system_language()))
    return 0

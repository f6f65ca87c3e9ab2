"""``zuka run register``: drives set on each other, into a folder."""

from __future__ import annotations

import argparse

from app.cli.opened import check_inputs, inputs_of, terminal_monitor
from app.cli.output import print_lines
from app.cli.set_option import settings_of_words
from app.settings.language import system_language
from processing.operations.register import RegisterOperation, register


def command(arguments: argparse.Namespace) -> int:
    """Register the drives of the input and write corrected points with a report."""
    check_inputs(arguments)
    operation = RegisterOperation(
        inputs_of(arguments), arguments.output, settings_of_words(arguments.set)
    )
    done = register(operation, terminal_monitor())
    print_lines(*(words.in_language(system_language()) for words in done.words))
    return 0

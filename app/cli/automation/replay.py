"""``zuka replay``: the steps of a macro or a job, done to a project that is there already."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines
from app.settings.language import system_language
from processing.operations.batch.macro import ReplayOperation, replay


def command(arguments: argparse.Namespace) -> int:
    """Do a macro's steps; each is a step that the window can undo."""
    words = replay(ReplayOperation(arguments.macro, arguments.project), terminal_monitor())
    print_lines(*(one.in_language(system_language()) for one in words))
    return 0

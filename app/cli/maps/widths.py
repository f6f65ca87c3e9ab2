"""``zuka widths``: how wide a project's roads are, drawn across them."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines
from app.settings.language import system_language
from processing.map.routes.route import PITCH_M
from processing.operations.map_steps import WidthOperation, draw_widths


def command(arguments: argparse.Namespace) -> int:
    """Draw width lines along the routes, and say how many."""
    pitch = PITCH_M if arguments.pitch is None else arguments.pitch
    drawn = draw_widths(WidthOperation(arguments.project, pitch), terminal_monitor())
    print_lines(*(words.in_language(system_language()) for words in drawn.words))
    return 0

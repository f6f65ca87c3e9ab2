"""``zuka demo``: the main job on the sample street, by a person or by itself."""

from __future__ import annotations

import argparse

from app.cli.window_request import WindowRequest


def command(arguments: argparse.Namespace) -> WindowRequest:
    """Ask for the window with the sample street, or for the whole job done by itself."""
    return WindowRequest(demo=True, headless_out=arguments.out if arguments.headless else None)

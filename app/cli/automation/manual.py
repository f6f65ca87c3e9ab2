"""``zuka manual``: the manual as a site, with a page for each tool."""

from __future__ import annotations

import argparse

from app.cli.output import print_lines
from app.help.manual_site import write_manual_site


def command(arguments: argparse.Namespace) -> int:
    """Write the manual to a folder."""
    print_lines(*(str(path) for path in write_manual_site(arguments.out)))
    return 0

"""Lines that a long command writes while it works."""

from __future__ import annotations

import sys


def say(line: str) -> None:
    """Write a line to standard output at once, so that it is seen while the work goes on."""
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()

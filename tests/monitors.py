"""Somebody who waits for work, and cancels it."""

from __future__ import annotations

from processing.core.errors import Cancelled
from processing.core.monitor import SilentMonitor
from processing.core.text import Text


class CancelledAfter(SilentMonitor):
    """Lets so many checks pass, and cancels at each that follows."""

    def __init__(self, checks: int = 0) -> None:
        self.left = checks

    def report(self, fraction: float, text: Text | None = None) -> None:
        assert 0 <= fraction <= 1

    def check(self) -> None:
        self.left -= 1
        if self.left < 0:
            raise Cancelled

"""How long work says how far it is, and how it learns that it should stop."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable
from itertools import accumulate, pairwise
from typing import Protocol, TextIO

from processing.core.text import Language, Text


class Monitor(Protocol):
    """What a long computation talks to.

    ``report`` may be called as often as is convenient; ``check`` must be called at least every
    100 ms of work and raises :class:`processing.core.errors.Cancelled` when the user wants to stop.
    """

    def report(self, fraction: float, text: Text | None = None) -> None:
        """Say how far the work is, 0 to 1, and what it is doing."""

    def check(self) -> None:
        """Raise ``Cancelled`` if the user asked to stop."""


class SilentMonitor:
    """Listens to nothing and never stops the work."""

    def report(self, fraction: float, text: Text | None = None) -> None:
        """Take note of nothing."""

    def check(self) -> None:
        """Go on."""


class PartMonitor:
    """A stretch of a larger job: 0 to 1 here is ``start`` to ``end`` there."""

    def __init__(self, whole: Monitor, start: float, end: float) -> None:
        self._whole = whole
        self._start = start
        self._end = end

    def report(self, fraction: float, text: Text | None = None) -> None:
        """Pass the fraction on, scaled into the part."""
        self._whole.report((1 - fraction) * self._start + fraction * self._end, text)

    def check(self) -> None:
        """Ask the whole job."""
        self._whole.check()


def parts_of(whole: Monitor, sizes: Iterable[float]) -> tuple[PartMonitor, ...]:
    """Stretches of a job that follow each other, each as long as its size among all says."""
    ends = list(accumulate(sizes, initial=0.0))
    total = ends[-1] or 1.0
    return tuple(PartMonitor(whole, low / total, high / total) for low, high in pairwise(ends))


class TerminalMonitor:
    """Writes progress to a stream: in place on a terminal, a line each 10 % elsewhere."""

    def __init__(self, stream: TextIO | None = None, language: Language = "en") -> None:
        self._stream = sys.stderr if stream is None else stream
        self._language = language
        self._in_place = self._stream.isatty()
        self._text = Text("", "")
        self._last_percent = -1
        self._last_time = 0.0

    def report(self, fraction: float, text: Text | None = None) -> None:
        """Show the fraction when it moved by enough to be worth a line."""
        percent = int(max(0.0, min(1.0, fraction)) * 100)
        changed = text is not None and text != self._text
        if text is not None:
            self._text = text
        step = 1 if self._in_place else 10
        now = time.monotonic()
        if not changed and (percent < self._last_percent + step or now < self._last_time + 0.1):
            return
        self._last_percent, self._last_time = percent, now
        words = f"{percent:3d} % {self._text.in_language(self._language)}"
        end = "\r" if self._in_place and percent < 100 else "\n"
        self._stream.write(f"{words:<78}{end}" if self._in_place else words + end)
        self._stream.flush()

    def check(self) -> None:
        """Go on: a terminal stops by its own signal, which the command line turns to a cancel."""

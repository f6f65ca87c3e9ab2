"""WatchedRun: a module of the program in a process of its own, and what memory it takes."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass

from processing.laboratory.bench.memory_watch import MemorySample, MemoryWatch

_GIB = 1024**3


@dataclass(frozen=True)
class WatchedRun:
    """A process that has ended.

    Attributes
    ----------
    status : int
        0 when it went well.
    lines : tuple of str
        What it said.
    complaints : str
        What it said on the other stream.
    memory : MemoryWatch
    """

    status: int
    lines: tuple[str, ...]
    complaints: str
    memory: MemoryWatch

    @property
    def moments(self) -> dict[str, float]:
        """When it said what, where each line is a word and a moment on the clock of all."""
        return {word: float(at) for word, at in (line.split() for line in self.lines)}

    def over_baseline(
        self, baseline_s: float, begin_s: float, end_s: float
    ) -> tuple[float | None, float | None]:
        """GiB of the peak between two moments over what was held at another one.

        Returns
        -------
        tuple
            Resident, and anonymous; None where the system doesn't tell.
        """
        held, peak = self.memory.at(baseline_s), self.memory.peak(begin_s, end_s)
        if held is None or peak is None:
            return None, None
        return _more(peak, held)


def run_watched(module: str, arguments: Sequence[str]) -> WatchedRun:
    """Run a module until it ends, with its memory watched from outside."""
    with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as complaints:
        process = subprocess.Popen(  # noqa: S603 - our own modules
            [sys.executable, "-m", module, *arguments],
            stdout=subprocess.PIPE,
            stderr=complaints,
            text=True,
        )
        with process, MemoryWatch(process.pid) as memory:
            said, _ = process.communicate()
        complaints.seek(0)
        reported = complaints.read()
    return WatchedRun(process.returncode, tuple(said.splitlines()), reported, memory)


def _more(peak: MemorySample, held: MemorySample) -> tuple[float, float]:
    return (peak.resident - held.resident) / _GIB, (peak.anonymous - held.anonymous) / _GIB

"""MemoryWatch: what a process and those that it started hold in memory, seen from outside."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import Self

from processing.core.process_memory import memory_of_tree

_EVERY_S = 0.02


@dataclass(frozen=True)
class MemorySample:
    """What was held at a moment.

    Attributes
    ----------
    at_s : float
        On the clock of :func:`time.monotonic`, which all processes share.
    resident, anonymous : int
        Bytes; anonymous ones belong to no file, so that the system can't take them back.
    """

    at_s: float
    resident: int
    anonymous: int


class MemoryWatch:
    """Samples the memory of a process tree until it is left; for Linux, empty elsewhere.

    Parameters
    ----------
    process : int
        Its number; it may end while it is watched.
    """

    def __init__(self, process: int) -> None:
        self._process = process
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._watch, name="memory watch", daemon=True)
        self.samples: list[MemorySample] = []

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._is_over.set()
        self._thread.join()

    def at(self, moment_s: float) -> MemorySample | None:
        """The last sample until then; None where there is none."""
        before = [one for one in self.samples if one.at_s <= moment_s]
        return before[-1] if before else None

    def peak(self, begin_s: float, end_s: float) -> MemorySample | None:
        """The most of each between two moments, at the time of the most resident bytes."""
        within = [one for one in self.samples if begin_s <= one.at_s <= end_s]
        last = self.at(end_s)
        if last is None:
            return None
        within = within or [last]
        most = max(within, key=lambda one: one.resident)
        return MemorySample(most.at_s, most.resident, max(one.anonymous for one in within))

    def _watch(self) -> None:
        while not self._is_over.wait(_EVERY_S):
            held = memory_of_tree(self._process)
            if held[0]:
                self.samples.append(MemorySample(time.monotonic(), *held))

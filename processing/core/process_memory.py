"""What processes hold in memory, seen from outside; told on Linux only, zeros elsewhere."""

from __future__ import annotations

import os
import threading
from pathlib import Path

_PROC = Path("/proc")
_EVERY_S = 0.05


class MemoryPeak:
    """The most memory, of no file, that this process and those it started hold.

    It is looked at some twenty times a second, by a thread of its own that ends with the process.
    """

    def __init__(self) -> None:
        self._most = 0
        threading.Thread(target=self._watch, name="memory peak", daemon=True).start()

    def taken(self) -> int:
        """Bytes since it was asked last; 0 where the system doesn't tell."""
        most, self._most = self._most, 0
        return max(most, memory_of_tree(os.getpid())[1])

    def _watch(self) -> None:
        while not threading.Event().wait(_EVERY_S):
            self._most = max(self._most, memory_of_tree(os.getpid())[1])


def memory_of_tree(process: int) -> tuple[int, int]:
    """Resident and anonymous bytes of a process and all that it started; zeros when it is gone."""
    resident, anonymous = _memory_of(process)
    for child in children_of(process):
        more = memory_of_tree(child)
        resident, anonymous = resident + more[0], anonymous + more[1]
    return resident, anonymous


def _memory_of(process: int) -> tuple[int, int]:
    try:
        lines = (_PROC / str(process) / "status").read_text().splitlines()
    except OSError:  # it has ended, or the system tells such things otherwise
        return 0, 0
    sizes = {line.split(":")[0]: line.split()[1] for line in lines if line.endswith(" kB")}
    kibibytes = [int(sizes.get(name, 0)) for name in ("VmRSS", "RssAnon", "RssShmem")]
    return 1024 * kibibytes[0], 1024 * (kibibytes[1] + kibibytes[2])


def children_of(process: int) -> list[int]:
    """The processes that a process started and that are not gone; none where it isn't told."""
    tasks = _PROC / str(process) / "task"
    children: list[int] = []
    try:
        for task in os.listdir(tasks):  # noqa: PTH208 - many times a second
            children += map(int, (tasks / task / "children").read_text().split())
    except OSError:  # as above
        return children
    return children

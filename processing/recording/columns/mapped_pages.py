"""MappedPages: what maps of columns hold of a machine's memory, kept within bounds.

The pages of a map that were read stay in the process until the system needs memory. They cost
nothing, but they hide what a program needs, and a machine that is short of memory becomes slow
before it takes them back.
"""

from __future__ import annotations

import mmap
import threading
import time
import weakref
from pathlib import Path

LIMIT_BYTES = 256 * 2**20
"""Maps hold no more than about this: less than views read in a second."""

_ROUNDS = 2
"""While hundreds of megabytes are given back, kernels read on: what they took meanwhile goes in a
second round at once, or it would count as the program's own and the limit would creep upwards."""

_LOOKED_AT_EVERY_S = 0.02
_LOOKED_AGAIN_AFTER_S, _LOOKED_AGAIN_AT_LEAST_S = 0.03, 0.25
"""While what is held changes, and at most while it doesn't: a program at rest is to be at rest."""

_STATM = Path("/proc/self/statm")
_FILE_PAGES = 2


class MappedPages:
    """Gives back the pages of maps once they have grown by so much; thread-safe.

    A page that is read again comes back from the system's own cache; arrays over the maps stay as
    they are. Where the system doesn't tell what a process holds, or takes pages back by itself,
    this does nothing.

    Parameters
    ----------
    limit_bytes : int
        What maps may hold together.
    """

    def __init__(self, *, limit_bytes: int = LIMIT_BYTES) -> None:
        self._limit_bytes = limit_bytes
        self._lock = threading.Lock()
        self._maps: weakref.WeakSet[mmap.mmap] = weakref.WeakSet()
        self._held_before = 0
        self._look_at = 0.0
        self._can_give_back = _STATM.is_file() and hasattr(mmap, "MADV_DONTNEED")

    def add(self, mapped: mmap.mmap) -> None:
        """Watch a map that is only read."""
        with self._lock:
            is_first = not self._maps
            if is_first:
                self._held_before = self._held_bytes()
            self._maps.add(mapped)
        if is_first and self._can_give_back:
            _WATCH.begin(self)

    @property
    def has_maps(self) -> bool:
        """Whether any map is left."""
        with self._lock:
            return bool(self._maps)

    def look(self) -> None:
        """Give pages back if there are too many; to be called whenever maps are used."""
        now = time.monotonic()
        if now < self._look_at or not self._can_give_back:
            return
        with self._lock:
            self._look_at = now + _LOOKED_AT_EVERY_S
            held = self._held_bytes()
            # What libraries map meanwhile counts too: then pages go a little early.
            self._held_before = min(self._held_before, held)
            if held - self._held_before > self._limit_bytes:
                self._held_before = min(self._give_back() for _ in range(_ROUNDS))

    def _give_back(self) -> int:
        """Give all pages back; what the process holds of files then."""
        for mapped in self._maps:
            mapped.madvise(mmap.MADV_DONTNEED)
        return self._held_bytes()

    def _held_bytes(self) -> int:
        """Pages of files that the process holds."""
        if not self._can_give_back:
            return 0
        return _held_bytes()


def _held_bytes() -> int:
    return int(_STATM.read_text().split()[_FILE_PAGES]) * mmap.PAGESIZE


class _Watch:
    """Looks every now and then, for as long as there are maps.

    A kernel may go through gigabytes of a map between two times that it is asked for. One thread
    looks for all: what is held is the process's.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._watched: weakref.WeakSet[MappedPages] = weakref.WeakSet()
        self._is_running = False

    def begin(self, pages: MappedPages) -> None:
        """Look after these too."""
        with self._lock:
            self._watched.add(pages)
            if self._is_running:
                return
            self._is_running = True
        threading.Thread(target=self._run, name="mapped pages", daemon=True).start()

    def _run(self) -> None:
        pause, seconds, held = threading.Event(), _LOOKED_AGAIN_AFTER_S, 0
        while True:
            pause.wait(seconds)
            if not self._look():
                return
            before, held = held, _held_bytes()
            seconds = (
                min(2 * seconds, _LOOKED_AGAIN_AT_LEAST_S)
                if held == before
                else _LOOKED_AGAIN_AFTER_S
            )

    def _look(self) -> bool:
        """Look once; tells whether there is anything left to look after."""
        with self._lock:
            left = [pages for pages in self._watched if pages.has_maps]
            self._is_running = bool(left)
        for pages in left:
            pages.look()
        return bool(left)


_WATCH = _Watch()

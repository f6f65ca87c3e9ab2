"""Preparation: what attributes show is found in the background, a drive after the other."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable

from PySide6.QtCore import QObject

from app.jobs.jobs import JobQueue
from processing.recording.drive import Drive
from processing.tools.normals import NORMALS
from processing.tools.segments import SEGMENTS
from processing.tools.tool import Tool

_AT_ONCE = 2


class Preparation(QObject):
    """Runs tools unasked, so that switching to what they find is quick.

    A project may have thousands of drives: only the next few wait in the queue of jobs.

    Parameters
    ----------
    start : callable
        Starts a tool on a drive and gives the job's id.
    jobs : JobQueue
    """

    def __init__(
        self, start: Callable[[Tool, Drive], str], jobs: JobQueue, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._start = start
        self._waiting: deque[tuple[Tool, Drive]] = deque()
        self._running: set[str] = set()
        for ended in (jobs.finished, jobs.failed, jobs.cancelled):
            ended.connect(self._on_jobs_ended)

    def begin(self, drives: Iterable[Drive]) -> None:
        """Prepare these drives, and those no longer that were waiting."""
        self._waiting = deque((tool, drive) for drive in drives for tool in (NORMALS, SEGMENTS))
        self._go_on()

    def give_up(self) -> None:
        """The drives are gone; what runs is not waited for."""
        self._waiting.clear()
        self._running.clear()

    def _go_on(self) -> None:
        while self._waiting and len(self._running) < _AT_ONCE:
            tool, drive = self._waiting.popleft()
            if not all(drive.columns.has(column.name) for column in tool.outputs):
                self._running.add(self._start(tool, drive))

    def _on_jobs_ended(self, job: str) -> None:
        if job in self._running:
            self._running.discard(job)
            self._go_on()

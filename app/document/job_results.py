"""JobResultApplier: what jobs give is taken over by the project they were started for, or not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QObject, Signal

from app.jobs.jobs import JobLane, JobQueue
from processing.core.errors import UserError
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.project.project import Project


def _nothing() -> None:
    """What to do where nothing is to be done."""


@dataclass(frozen=True)
class _Adoption:
    project: Project
    take: Callable[[Any], None]  # each job's own result type
    otherwise: Callable[[], None]


class JobResultApplier(QObject):
    """Starts jobs for the open project and hands over what they give, on the window's thread.

    Signals
    -------
    refused(error: UserError)
        A job failed, or what it gave can't be taken over.
    """

    refused = Signal(object)

    def __init__(self, jobs: JobQueue, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._jobs = jobs
        self._waiting: dict[str, _Adoption] = {}
        self._of_project: list[str] = []
        self._taken = ""
        jobs.finished.connect(self._on_jobs_finished)
        jobs.failed.connect(self._on_jobs_failed)
        jobs.cancelled.connect(self._on_jobs_cancelled)

    def start(
        self,
        project: Project,
        title: Text,
        work: Callable[[Monitor], object],
        take: Callable[[Any], None],
        *,
        lane: JobLane = JobLane.ASKED,
        otherwise: Callable[[], None] = _nothing,
    ) -> str:
        """Queue a job; gives its id.

        Parameters
        ----------
        take : callable
            Gets what the work gave, if the project is still open then.
        otherwise : callable
            Called instead when the job failed or was cancelled, or when taking over failed.
        """
        job = self._jobs.start(title, work, lane=lane)
        self._waiting[job] = _Adoption(project, take, otherwise)
        if lane is not JobLane.INTERACTIVE:  # these are on no list
            self._of_project.append(job)
        return job

    def start_at_hand(
        self, project: Project, work: Callable[[], object], take: Callable[[object | None], None]
    ) -> None:
        """Queue a moment's work for the tool in the hand; it gets None where that failed."""

        def watched(_monitor: Monitor) -> object:
            return work()

        drawing, lane = Text("Drawing", "作図"), JobLane.INTERACTIVE
        self.start(project, drawing, watched, take, lane=lane, otherwise=lambda: take(None))

    def give_up(self) -> None:
        """The project is closed: jobs are interrupted, what they give is dropped."""
        for job in self._waiting:
            self._jobs.interrupt(job)
        self._waiting.clear()
        for job in self._of_project:
            self._jobs.forget(job)
        self._of_project.clear()

    def note_result(self, result: Text) -> None:
        """What is said while a job's result is taken over is what the job made."""
        if self._taken:
            self._jobs.note_result(self._taken, result)

    def _on_jobs_finished(self, job: str, result: object) -> None:
        adoption = self._waiting.pop(job, None)
        if adoption is None:
            return
        self._taken = job
        try:
            adoption.take(result)
        except UserError as error:
            adoption.otherwise()
            self.refused.emit(error)
        finally:
            self._taken = ""

    def _on_jobs_failed(self, job: str, error: UserError) -> None:
        adoption = self._waiting.pop(job, None)
        if adoption is not None:
            # Why it failed stays on the list, also where its new project goes with it.
            if job in self._of_project:
                self._of_project.remove(job)
            adoption.otherwise()
            self.refused.emit(error)

    def _on_jobs_cancelled(self, job: str) -> None:
        adoption = self._waiting.pop(job, None)
        if adoption is not None:
            adoption.otherwise()

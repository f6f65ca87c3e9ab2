"""ClassLearning: a job that learns from what was painted, and the step that keeps its model."""

from __future__ import annotations

from PySide6.QtCore import QObject

from app.document.document import Document
from app.document.job_results import JobResultApplier
from app.jobs.jobs import JobQueue
from processing.core.monitor import Monitor
from processing.operations.learn import LEARN, LearntModel, learn, store_model


class ClassLearning(QObject):
    """Learns from corrections in the open project.

    Parameters
    ----------
    document : Document
    jobs : JobQueue
    """

    def __init__(self, document: Document, jobs: JobQueue, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._job_results = JobResultApplier(jobs, self)
        self._job_results.refused.connect(document.refused)
        document.about_to_close.connect(self._job_results.give_up)

    def learn(self) -> str:
        """Learn in the background from what was painted on all drives; gives the job's id."""
        project = self._document.project
        if project is None:
            return ""
        drives, into = self._document.drives(), project.temporary_folder()

        def work(monitor: Monitor) -> LearntModel:
            return learn(drives, into, monitor)

        return self._job_results.start(project, LEARN, work, self._take)

    def _take(self, learnt: LearntModel) -> None:
        if self._document.do_step(lambda project: store_model(project, learnt)):
            self._document.reported.emit(learnt.summary)

"""ProjectChecking: the open project is checked in a job, and repaired while it is closed."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject
from PySide6.QtGui import QAction

from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.operations.check import CheckOperation, check
from processing.project.checking.findings import CheckReport
from widgets.dialogs.project_check import ProjectCheckForm

_CHECKING = Text("Check of {name}", "{name} の検査")
_REPAIRING = Text("Repair of {name}", "{name} の修復")


class ProjectChecking(QObject):
    """What the file menu does about damage; and what is said when a damaged project is opened.

    Parameters
    ----------
    parts : WindowParts
    """

    def __init__(self, parts: WindowParts) -> None:
        # A repair that runs goes on through a change of language, as the document does.
        super().__init__(parts.document)
        self._parts = parts
        self._jobs: dict[str, CheckOperation] = {}
        self._check = QAction(self)
        self._check.triggered.connect(self.choose)
        parts.jobs.finished.connect(self._on_jobs_finished)
        parts.jobs.failed.connect(self._on_jobs_failed)
        parts.jobs.cancelled.connect(self._on_jobs_cancelled)
        parts.document.opened.connect(self._on_document_opened)

    def choose(self) -> None:
        """Check the open project; what is found is shown."""
        project = self._parts.document.project
        if project is not None:
            self._start(CheckOperation(project.folder))

    def repair(self, folder: Path) -> None:
        """Close a project, have it repaired, and open it again."""
        document = self._parts.document
        if document.project is not None and document.project.folder == folder:
            document.close()
        self._start(CheckOperation(folder, repair=True))

    def _start(self, operation: CheckOperation) -> None:
        def work(monitor: Monitor) -> CheckReport:
            return check(operation, monitor)

        words = _REPAIRING if operation.repair else _CHECKING
        title = words.filled(name=operation.project.stem)
        self._jobs[self._parts.jobs.start(title, work)] = operation

    def _on_jobs_finished(self, job: str, result: object) -> None:
        operation = self._jobs.pop(job, None)
        if operation is None or not isinstance(result, CheckReport):
            return
        self._open_again(operation)
        parts = self._parts
        form = ProjectCheckForm(result, operation.project.stem, parts.language, parts.window)
        form.repair_requested.connect(lambda: self.repair(operation.project))
        form.show()

    def _on_jobs_failed(self, job: str, error: UserError) -> None:
        operation = self._jobs.pop(job, None)
        if operation is not None:
            self._open_again(operation)
            self._parts.message_bar.show_error(error)

    def _on_jobs_cancelled(self, job: str) -> None:
        operation = self._jobs.pop(job, None)
        if operation is not None:
            self._open_again(operation)

    def _open_again(self, operation: CheckOperation) -> None:
        document = self._parts.document
        if operation.repair and document.project is None:
            document.open(operation.project)

    def _on_document_opened(self) -> None:
        project = self._parts.document.project
        for error in () if project is None else tuple(project.damaged_drives.values())[:1]:
            self._check.setText(self.tr("Check project"))
            self._parts.message_bar.show_error(error, self._check)

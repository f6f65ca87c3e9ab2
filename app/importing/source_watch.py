"""SourceWatch: looks for delivered files in a thread of its own, since shares may hang."""

from __future__ import annotations

import threading
from contextlib import suppress
from pathlib import Path

from PySide6.QtCore import QObject, Qt, QTimer, Signal

from app.document.document import Document
from processing.core.errors import BadFile, Cancelled, MissingInput, UserError
from processing.project.project import Project
from processing.project.sources.source_survey import FileProblem, SourceSurvey, SurveyResult


class SourceWatch(QObject):
    """Knows which delivered files and camera images are missing or are others now.

    It looks when a project is opened, when drives are added, and when something was refused for
    want of a file; never unasked. A file system that doesn't answer holds up nobody.

    Parameters
    ----------
    document : Document

    Signals
    -------
    looked()
        What is missing is known anew.
    chosen(folder: Path)
        The user says that files are there; `looked` follows.
    moved()
        Files are elsewhere than it seemed; their drives know it by now.
    """

    looked = Signal()
    chosen = Signal(object)
    moved = Signal()

    _answered = Signal(int, object)

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._lock = threading.Lock()
        self._asked = 0
        self._soon = QTimer(self, singleShot=True, interval=0)
        self._soon.timeout.connect(self.look)
        self._answered.connect(self._on_thread_answered, Qt.ConnectionType.QueuedConnection)
        document.about_to_close.connect(self._give_up)
        document.refused.connect(self._on_document_refused)
        document.shared.map_changes.drives_changed.connect(self._soon.start)

    @property
    def troubles(self) -> tuple[FileProblem, ...]:
        """What wasn't there, or was another file, when it was looked for last."""
        project = self._document.project
        return () if project is None else project.sources.troubles

    def look(self) -> None:
        """Look for all files where they should be."""
        self._look(None)

    def look_in(self, folder: Path) -> None:
        """Look for all files; in this folder they are said to be."""
        self.chosen.emit(folder)
        self._look(folder)

    def _look(self, chosen: Path | None) -> None:
        project = self._document.project
        if project is None:
            return
        survey = project.sources.survey(project.drives, chosen)
        asked = self._give_up()
        thread = threading.Thread(
            target=self._ask, args=(asked, survey), name="delivered files", daemon=True
        )
        thread.start()

    def _give_up(self) -> int:
        """What was asked so far isn't wanted any longer; gives the number of the next question."""
        self._soon.stop()
        with self._lock:
            self._asked += 1
            return self._asked

    def _ask(self, asked: int, survey: SourceSurvey) -> None:
        def check() -> None:
            if asked != self._asked:
                raise Cancelled

        try:
            result = survey.look(check)
        except Cancelled:
            return
        # Who gives up has the lock first, and may be gone together with this object afterwards.
        with self._lock:
            if asked == self._asked:
                self._answered.emit(asked, result)

    def _on_thread_answered(self, asked: int, result: SurveyResult) -> None:
        project = self._document.project
        if project is None or asked != self._asked:
            return
        if self._take_result(project, result):
            for drive in project.drives:
                if drive.noted_images is not None:
                    self._document.tiles.drop(drive.id)
            self.moved.emit()
        self.looked.emit()

    def _on_document_refused(self, error: UserError) -> None:
        if isinstance(error, MissingInput | BadFile):
            self._soon.start()

    @staticmethod
    def _take_result(project: Project, result: SurveyResult) -> bool:
        before = [drive.delivered_files for drive in project.drives]
        images = [drive.delivered_images for drive in project.drives]
        # On a full disk the next opening looks again; what was found is used all the same.
        with suppress(UserError):
            project.sources.take(result, project.drives)
        return before != [drive.delivered_files for drive in project.drives] or any(
            one is not drive.delivered_images
            for one, drive in zip(images, project.drives, strict=True)
        )

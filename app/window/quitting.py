"""Quitting: the window asks before it closes in the middle of work that was asked for."""

from __future__ import annotations

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QMessageBox

from app.window.window_parts import WindowParts

_MOST_NAMES = 5


class Quitting(QObject):
    """Asks beside the window, so that the work goes on until there is an answer."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window)
        self._parts = parts
        self._question: QMessageBox | None = None

    def may_close(self) -> bool:
        """Whether nothing speaks against closing now; asks where something does."""
        at_work = self._parts.jobs.asked_at_work
        if not at_work:
            return True
        if self._question is None:
            titles = [one.title.in_language(self._parts.language) for one in at_work]
            self._question = self._ask(titles)
        self._question.show()
        self._question.raise_()
        return False

    def _ask(self, titles: list[str]) -> QMessageBox:
        question = QMessageBox(self._parts.window)
        question.setIcon(QMessageBox.Icon.Question)
        question.setWindowTitle(self.tr("Quit"))
        question.setText(self.tr("%n job(s) are not finished.", "", len(titles)))
        names = "\n".join(titles[:_MOST_NAMES])
        after = self.tr("Imports can go on the next time; other jobs are given up.")
        question.setInformativeText(f"{names}\n\n{after}")
        stay = question.addButton(self.tr("Wait"), QMessageBox.ButtonRole.RejectRole)
        leave = question.addButton(self.tr("Quit now"), QMessageBox.ButtonRole.AcceptRole)
        question.setDefaultButton(stay)
        question.setEscapeButton(stay)
        leave.clicked.connect(self._parts.window.close_at_once)
        question.finished.connect(self._on_question_finished)
        return question

    def _on_question_finished(self) -> None:
        if self._question is not None:
            self._question.deleteLater()
            self._question = None

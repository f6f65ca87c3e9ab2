"""JobsPanel: what runs in the background, how far it is, and what went wrong."""

from __future__ import annotations

from PySide6.QtCore import QLocale, Qt, Signal
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QLabel,
    QScrollArea,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from processing.core.text import Language
from widgets.parts.elided_label import ElidedLabel
from widgets.parts.job_view import JobView, time_left
from widgets.parts.progress_bar import ProgressBar

_STEPS = 1000
_MOST_ENDED = 50


class JobsPanel(QWidget):
    """The jobs of this session, the newest first.

    Parameters
    ----------
    language : Language
        By which numbers are written.

    Signals
    -------
    cancel_requested(id: str)
    """

    cancel_requested = Signal(str)

    def __init__(self, language: Language, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._locale = QLocale(language)
        self._jobs: dict[str, _JobRow] = {}
        self._empty = QLabel(self.tr("Jobs appear here while they run."), self)
        self._empty.setWordWrap(True)
        self._empty.setEnabled(False)
        inside = QWidget(self)
        self._rows = QVBoxLayout(inside)
        self._rows.setContentsMargins(8, 8, 8, 8)
        self._rows.setSpacing(4)
        self._rows.addWidget(self._empty)
        self._rows.addStretch(1)
        scroll = QScrollArea(self)
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setWidget(inside)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(scroll)

    def show_job(self, job: JobView) -> None:
        """Show a job as it is now."""
        row = self._jobs.get(job.id)
        if row is None:
            row = _JobRow(self._locale, self)
            row.cancel_clicked.connect(self.cancel_requested)
            self._jobs[job.id] = row
            self._rows.insertWidget(0, row)
            self._empty.hide()
        row.show_job(job)
        self._forget_oldest()

    def forget_job(self, id_: str) -> None:
        """Take a job off the list."""
        row = self._jobs.pop(id_, None)
        if row is not None:
            self._rows.removeWidget(row)
            row.deleteLater()
        self._empty.setVisible(not self._jobs)

    def shown(self) -> tuple[JobView, ...]:
        """The jobs in the list, oldest first."""
        return tuple(row.job for row in self._jobs.values() if row.job is not None)

    def _forget_oldest(self) -> None:
        ended = [job.id for job in self.shown() if job.is_over]
        for id_ in ended[: max(0, len(ended) - _MOST_ENDED)]:
            self.forget_job(id_)


class _JobRow(QFrame):
    """Title, progress with what is left, and the button that cancels."""

    cancel_clicked = Signal(str)

    def __init__(self, locale: QLocale, parent: QWidget) -> None:
        super().__init__(parent)
        self._locale = locale
        self.job: JobView | None = None
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self._title = ElidedLabel(self)
        self._state = QLabel(self)
        self._bar = ProgressBar(self)
        self._bar.setRange(0, _STEPS)
        self._bar.setTextVisible(False)
        self._bar.setFixedHeight(8)
        self._words = QLabel(self)
        self._words.setWordWrap(True)
        self._words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._cancel = QToolButton(self)
        self._cancel.setText("✕")
        self._cancel.setAutoRaise(True)
        self._cancel.setToolTip(self.tr("Cancel this job"))
        self._cancel.clicked.connect(self._on_cancel_clicked)
        layout = QGridLayout(self)
        layout.setContentsMargins(8, 4, 4, 4)
        layout.setSpacing(4)
        layout.addWidget(self._title, 0, 0)
        layout.addWidget(self._state, 0, 1, Qt.AlignmentFlag.AlignRight)
        layout.addWidget(self._cancel, 0, 2)
        layout.addWidget(self._bar, 1, 0, 1, 3)
        layout.addWidget(self._words, 2, 0, 1, 3)
        layout.setColumnStretch(0, 1)

    def show_job(self, job: JobView) -> None:
        self.job = job
        self._title.setText(job.title)
        self._state.setText(self._state_words(job))
        self._bar.show_value(round(job.fraction * _STEPS))
        self._bar.setVisible(not job.is_over)
        self._cancel.setVisible(not job.is_over)
        words = "\n".join(job.error.split(" | ")) if job.error else job.text
        self._words.setText(job.result if job.is_over and not job.error else words)
        began = self.tr("Began at {time}").format(time=job.started) if job.started else ""
        self.setToolTip("\n".join(line for line in (job.title, began) if line))
        self._words.setVisible(bool(self._words.text()))

    def _state_words(self, job: JobView) -> str:
        if job.state == "running":
            left = time_left(job.seconds_left)
            percent = f"{self._locale.toString(int(job.fraction * 100))} %"
            both = self.tr("{percent}, {left} left").format(percent=percent, left=left)
            return both if left else percent
        state = {
            "waiting": self.tr("waiting"),
            "finished": self.tr("done"),
            "failed": self.tr("failed"),
            "cancelled": self.tr("cancelled"),
        }[job.state]
        if not (job.is_over and job.started):
            return state
        # The time of day at which it began, and how long it took.
        return f"{job.started} · {time_left(job.seconds)} · {state}"

    def _on_cancel_clicked(self) -> None:
        if self.job is not None:
            self.cancel_clicked.emit(self.job.id)

"""StatusLine: where the mouse is, in which reference system, what was just done, what runs."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QFont
from PySide6.QtWidgets import QLabel, QStatusBar, QToolButton, QWidget

from processing.core.text import Language, Text
from processing.methods.earthwork.maps.change_reading import ChangeReading
from widgets.parts.change_words import change_words
from widgets.parts.job_view import JobView, time_left
from widgets.parts.number_field import coordinate
from widgets.parts.progress_bar import ProgressBar
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_MESSAGE_MS = 12_000
_STEPS = 1000


class StatusLine(QStatusBar):
    """The window's last line.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language

    Signals
    -------
    cancel_requested(job: str)
        The button beside the job that runs.
    """

    cancel_requested = Signal(str)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._cursor = shared.cursor
        self._language = language
        self._job: JobView | None = None
        self._progress = ProgressBar(self)
        self._progress.setRange(0, _STEPS)
        self._progress.setTextVisible(False)
        self._progress.setFixedSize(88, 8)
        self._job_words = QLabel(self)
        self._cancel = QToolButton(self)
        self._cancel.setText("✕")
        self._cancel.setToolTip(self.tr("Cancel this job"))
        self._cancel.setAutoRaise(True)
        self._cancel.setFixedSize(20, 20)
        self._cancel.clicked.connect(self._on_cancel_clicked)
        self._change = QLabel(self)
        self._change.setFont(_digits_of(self))
        self._position = QLabel(self)
        self._position.setFont(_digits_of(self))
        self._position.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._crs = QLabel(self)
        self.addPermanentWidget(self._progress)
        self.addPermanentWidget(self._job_words)
        self.addPermanentWidget(self._cancel)
        self.addPermanentWidget(self._change)
        self.addPermanentWidget(self._position)
        self.addPermanentWidget(self._crs)
        shared.cursor.moved.connect(self._on_cursor_changed)
        shared.cursor.hovered.connect(self._on_cursor_changed)
        shared.map_changes.drives_changed.connect(self._on_drives_changed)
        shared.volume.hovered.connect(self._on_volume_hovered)
        self.show_job(None)
        self._on_drives_changed()

    @property
    def position_text(self) -> str:
        """The coordinates that are shown; empty where there are none."""
        return self._position.text()

    @property
    def change_text(self) -> str:
        """What the map of change says under the mouse; empty where it says nothing."""
        return self._change.text()

    @property
    def job_text(self) -> str:
        """What is said of the job that runs; empty when none does."""
        return self._job_words.text()

    def show_message(self, text: Text) -> None:
        """Say something for a while."""
        self.showMessage(text.in_language(self._language), _MESSAGE_MS)

    def show_job(self, job: JobView | None) -> None:
        """Show how far the job is; None when none runs."""
        self._job = job
        self._progress.setVisible(job is not None)
        self._job_words.setVisible(job is not None)
        self._cancel.setVisible(job is not None)
        if job is None:
            self._job_words.clear()
            return
        self._progress.show_value(round(job.fraction * _STEPS))
        left = time_left(job.seconds_left)
        words = (
            self.tr("{title} {percent} %, {left} left") if left else self.tr("{title} {percent} %")
        )
        self._job_words.setText(
            words.format(title=job.title, percent=int(job.fraction * 100), left=left)
        )
        self._job_words.setToolTip(job.text)

    def _on_cancel_clicked(self) -> None:
        if self._job is not None:
            self.cancel_requested.emit(self._job.id)

    def _on_cursor_changed(self) -> None:
        position: PickedPosition | None = self._cursor.hover or self._cursor.position
        if position is None:
            self._position.clear()
            return
        easting, northing, height = (coordinate(value) for value in position.xyz)
        self._position.setText(f"E {easting}  N {northing}  H {height}")

    def _on_volume_hovered(self, reading: ChangeReading | None) -> None:
        words = "" if reading is None else change_words(reading).in_language(self._language)
        self._change.setText(f"Δ {words}" if words else "")

    def _on_drives_changed(self) -> None:
        has_drives = bool(self._source.drives())
        unknown = self.tr("reference system unknown") if has_drives else ""
        self._crs.setText(self._source.crs() or unknown)
        self._on_cursor_changed()


def _digits_of(widget: QWidget) -> QFont:
    """A font whose digits are equally wide, so that numbers don't tremble."""
    font = widget.font()
    font.setFeature(QFont.Tag("tnum"), 1)
    return font

"""LabelTally: how many points have which class, counted while the window has nothing to do."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, QTimer, Signal

from processing.core.errors import UserError
from processing.labels.label_column import CODES
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive
from widgets.shared.map_changes import MapChanges
from widgets.shared.map_source import MapSource

_POINTS_AT_ONCE = 1_000_000
_LABELS, _CLASSES = range(2)

_Counts = NDArray[np.int64]


class LabelTally(QObject):
    """Counts the labels of all drives and the classes that count, in pieces that hold nothing up.

    It rests until :meth:`go_on`.

    Signals
    -------
    changed()
        All is counted, and something is another number.
    """

    changed = Signal()

    def __init__(
        self, source: MapSource, map_changes: MapChanges, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._counts: dict[str, _Counts] = {}
        self._reported = _nothing()
        self._waiting: list[str] = []
        self._position = 0
        self._sum = _nothing()
        self._is_resting = True
        self._next = QTimer(self, singleShot=True, interval=0)
        self._next.timeout.connect(self._on_next_timeout)
        map_changes.labels_changed.connect(self._on_map_labels_changed)
        map_changes.drives_changed.connect(self._on_map_drives_changed)
        self._on_map_drives_changed()

    @property
    def by_code(self) -> _Counts:
        """(256,) points with each label, as counted last; a copy."""
        return np.array(self._reported[_LABELS])

    @property
    def by_class(self) -> _Counts:
        """(256,) points of each class, a label before what was delivered; a copy."""
        return np.array(self._reported[_CLASSES])

    @property
    def is_counting(self) -> bool:
        """Whether a drive is being counted."""
        return bool(self._waiting) and not self._is_resting

    def go_on(self) -> None:
        """Somebody sees the numbers: count what isn't counted."""
        self._is_resting = False
        self._next.start()

    def rest(self) -> None:
        """Nobody sees the numbers."""
        self._is_resting = True
        self._next.stop()

    def _on_map_drives_changed(self) -> None:
        self._counts.clear()
        self._waiting = [drive.id for drive in self._source.drives()]
        self._begin()

    def _on_map_labels_changed(self, drive_id: str, _points: object) -> None:
        # A drive that is half counted is counted from its start.
        self._waiting = [drive_id, *(one for one in self._waiting if one != drive_id)]
        self._begin()

    def _begin(self) -> None:
        self._position, self._sum = 0, _nothing()
        if not self._is_resting:
            self._next.start()

    def _on_next_timeout(self) -> None:
        drive = next((d for d in self._source.drives() if d.id in self._waiting[:1]), None)
        if drive is not None and self._position < drive.count:
            self._count(drive)
            self._position += _POINTS_AT_ONCE
            self._next.start()
            return
        if drive is not None:
            self._counts[drive.id] = self._sum
        self._waiting = self._waiting[1:]
        if self._waiting:
            self._begin()
        else:
            self._report()

    def _count(self, drive: Drive) -> None:
        """Count a piece, or all at once where there is nothing to count."""
        part = slice(self._position, self._position + _POINTS_AT_ONCE)
        try:
            columns = class_columns(drive.columns)
        except UserError:  # who paints on it is told
            self._position = drive.count
            return
        labels, delivered = columns.labels[part], columns.delivered[part]
        if not (labels.size or delivered.size):
            self._position = drive.count
            return
        codes = np.where(labels > 0, labels, delivered) if labels.size == delivered.size else labels
        self._sum[_LABELS] += np.bincount(labels, minlength=CODES)
        self._sum[_CLASSES] += np.bincount(codes if labels.size else delivered, minlength=CODES)

    def _report(self) -> None:
        counted = sum(self._counts.values(), _nothing())
        if not np.array_equal(counted, self._reported):
            self._reported = counted
            self.changed.emit()


def _nothing() -> _Counts:
    return np.zeros((2, CODES), np.int64)

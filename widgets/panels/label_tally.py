"""LabelTally: how many points have which label, counted while the window has nothing to do."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, QTimer, Signal

from processing.errors import UserError
from processing.labels.label_column import CODES, LABEL
from widgets.shared.map_changes import MapChanges
from widgets.shared.map_source import MapSource

_POINTS_AT_ONCE = 1_000_000


class LabelTally(QObject):
    """Counts the labels of all drives, in pieces that hold nothing up.

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
        self._counts: dict[str, NDArray[np.int64]] = {}
        self._told = np.zeros(CODES, np.int64)
        self._waiting: list[str] = []
        self._place = 0
        self._sum = np.zeros(CODES, np.int64)
        self._next = QTimer(self, singleShot=True, interval=0)
        self._next.timeout.connect(self._on_next_timeout)
        map_changes.labels_changed.connect(self._on_map_labels_changed)
        map_changes.drives_changed.connect(self._on_map_drives_changed)
        self._on_map_drives_changed()

    @property
    def by_code(self) -> NDArray[np.int64]:
        """(256,) points with each label, as counted last; a copy."""
        return self._told.copy()

    @property
    def is_counting(self) -> bool:
        """Whether a drive is being counted."""
        return bool(self._waiting)

    def _on_map_drives_changed(self) -> None:
        self._counts.clear()
        self._waiting = [drive.id for drive in self._source.drives()]
        self._begin()

    def _on_map_labels_changed(self, drive_id: str, _points: object) -> None:
        # A drive that is half counted is counted from its start.
        self._waiting = [drive_id, *(one for one in self._waiting if one != drive_id)]
        self._begin()

    def _begin(self) -> None:
        self._place, self._sum = 0, np.zeros(CODES, np.int64)
        self._next.start()

    def _on_next_timeout(self) -> None:
        drive = next((d for d in self._source.drives() if d.id in self._waiting[:1]), None)
        if drive is not None and drive.columns.has(LABEL) and self._place < drive.count:
            try:
                labels = drive.columns[LABEL][self._place : self._place + _POINTS_AT_ONCE]
            except UserError:
                labels = np.empty(0, np.uint8)  # who paints on it is told
                self._place = drive.count
            self._sum += np.bincount(labels, minlength=CODES)
            self._place += _POINTS_AT_ONCE
            self._next.start()
            return
        if drive is not None:
            self._counts[drive.id] = self._sum
        self._waiting = self._waiting[1:]
        if self._waiting:
            self._begin()
        else:
            self._tell()

    def _tell(self) -> None:
        counted = sum(self._counts.values(), np.zeros(CODES, np.int64))
        if not np.array_equal(counted, self._told):
            self._told = counted
            self.changed.emit()

"""Selection: the features and the points that are chosen, the same in all views."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal


class Selection(QObject):
    """Chosen features by id, chosen points by drive.

    Setting what is already set emits nothing.
    """

    features_changed = Signal(object)  # frozenset[str]
    points_changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._features: frozenset[str] = frozenset()
        self._points: dict[str, NDArray[np.int64]] = {}

    @property
    def features(self) -> frozenset[str]:
        """Ids of the chosen features."""
        return self._features

    @property
    def points(self) -> dict[str, NDArray[np.int64]]:
        """Chosen points: drive id to sorted point indices; a copy of the mapping."""
        return dict(self._points)

    def choose_features(self, ids: frozenset[str]) -> None:
        """Choose exactly these features."""
        if ids != self._features:
            self._features = ids
            self.features_changed.emit(ids)

    def choose_points(self, points: dict[str, NDArray[np.int64]]) -> None:
        """Choose exactly these points; sorted here."""
        chosen = {drive: np.unique(indices) for drive, indices in points.items() if indices.size}
        if chosen or self._points:
            self._points = chosen
            self.points_changed.emit()

    def clear(self) -> None:
        """Choose nothing."""
        self.choose_features(frozenset())
        self.choose_points({})

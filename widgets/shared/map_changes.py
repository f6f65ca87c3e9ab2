"""MapChanges: tells views which features, drives and settings of the document changed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal


class MapChanges(QObject):
    """Facts about the open project, told by the document after they happened."""

    features_changed = Signal(object)  # tuple[str, ...]: ids added, replaced or removed
    candidates_found = Signal(str, str)  # ids of a tool and of its run: its candidates are there
    drives_changed = Signal()  # drives added, or a project opened or closed
    drive_columns_changed = Signal(str)  # drive id: a tool's result columns are there, or gone
    volumes_changed = Signal()  # a volume is kept now, or gone
    labels_changed = Signal(
        str, object
    )  # drive id; (n,) int64: points with other labels, none: many
    error_maps_changed = Signal(
        str, object
    )  # drive id; (n,) int64: points that are judged anew, where the picture shows it

    def follow_labels(self, show: Callable[[str, NDArray[np.int64]], None]) -> None:
        """Have a view show points whose labels changed, or what is thought of these."""
        self.labels_changed.connect(show)
        self.error_maps_changed.connect(show)

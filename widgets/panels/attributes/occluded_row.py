"""OccludedRow: how many vertices have no measured point, and the way from one to the next."""

from __future__ import annotations

from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QSizePolicy, QWidget

from processing.map.feature import Feature, Vertex
from widgets.shared.cursor import Cursor, PickedPosition


class OccludedRow(QWidget):
    """A line and a button.

    Parameters
    ----------
    cursor : Cursor
        Moved from one occluded vertex to the next, after the last to the first.
    """

    def __init__(self, cursor: Cursor, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._cursor = cursor
        self._occluded: tuple[tuple[str, int, Vertex], ...] = ()
        self._last: tuple[str, int] | None = None
        self.label = QLabel(self)
        self.label.setWordWrap(True)
        self.button = QPushButton(self.tr("Next"), self)
        self.button.setToolTip(
            self.tr("Move the cursor to the next vertex without a measured point")
        )
        self.button.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.button.clicked.connect(self._on_button_clicked)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(8)
        layout.addWidget(self.label, 1)
        layout.addWidget(self.button)

    @property
    def count(self) -> int:
        """How many vertices have no measured point."""
        return len(self._occluded)

    def show_features(self, features: tuple[Feature, ...]) -> None:
        """Count the vertices of these features."""
        self._occluded = tuple(
            (feature.id, number, vertex)
            for feature in features
            for number, vertex in enumerate(feature.vertices)
            if vertex.is_occluded
        )
        total = sum(len(feature.vertices) for feature in features)
        self.label.setText(
            self.tr("{count} of {total} vertices without a measured point").format(
                count=f"{len(self._occluded):,}", total=f"{total:,}"
            )
        )

    def _on_button_clicked(self) -> None:
        # By place in the list, not by the cursor: two vertices may have the same coordinate.
        keys = [(id_, number) for id_, number, _ in self._occluded]
        start = keys.index(self._last) + 1 if self._last in keys else 0
        id_, number, vertex = self._occluded[start % len(keys)]
        self._last = (id_, number)
        self._cursor.move_to(PickedPosition(vertex.xyz, vertex.measured))

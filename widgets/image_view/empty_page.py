"""EmptyPage: what the image view says while no drive is shown."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget


class EmptyPage(QWidget):
    """One line, and the buttons that bring a recording."""

    open_requested = Signal()
    import_requested = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        line = QLabel(
            self.tr("A recording is shown here as an image: every pixel is a laser point."), self
        )
        line.setAlignment(Qt.AlignmentFlag.AlignCenter)
        line.setWordWrap(True)
        line.setStyleSheet("color: #c9d1d9")
        import_button = QPushButton(self.tr("Import a delivery…"), self)
        open_button = QPushButton(self.tr("Open a project…"), self)
        import_button.clicked.connect(self._on_import_clicked)
        open_button.clicked.connect(self._on_open_clicked)
        buttons = QHBoxLayout()
        buttons.setSpacing(8)
        buttons.addStretch(1)
        buttons.addWidget(import_button)
        buttons.addWidget(open_button)
        buttons.addStretch(1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(24, 24, 24, 24)
        layout.setSpacing(12)
        layout.addStretch(1)
        layout.addWidget(line)
        layout.addLayout(buttons)
        layout.addStretch(1)

    def _on_import_clicked(self) -> None:
        self.import_requested.emit()

    def _on_open_clicked(self) -> None:
        self.open_requested.emit()

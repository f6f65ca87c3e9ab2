"""OpeningPage: what a view says while no recording is open, and the buttons that bring one."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget


class OpeningPage(QWidget):
    """One line, and the buttons that bring a recording.

    Parameters
    ----------
    words : str
        What would be here.
    """

    open_requested = Signal()
    import_requested = Signal()

    def __init__(self, words: str, parent: QWidget) -> None:
        super().__init__(parent)
        line = QLabel(words, self)
        line.setAlignment(Qt.AlignmentFlag.AlignCenter)
        line.setWordWrap(True)
        line.setStyleSheet("color: #c9d1d9")
        translate = QCoreApplication.translate
        import_button = QPushButton(translate("EmptyPage", "Import a delivery…"), self)
        open_button = QPushButton(translate("EmptyPage", "Open a project…"), self)
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

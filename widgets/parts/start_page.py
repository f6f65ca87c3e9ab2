"""StartPage: what the window shows while nothing is open."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

_WIDTH = 560
_PATH = Qt.ItemDataRole.UserRole


class StartPage(QWidget):
    """Recent projects, and the three ways to begin.

    Signals
    -------
    open_requested, import_requested, demo_requested
        The buttons.
    recent_chosen(folder: Path)
        A project of the list.
    """

    open_requested = Signal()
    import_requested = Signal()
    demo_requested = Signal()
    recent_chosen = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        column = QWidget(self)
        column.setMaximumWidth(_WIDTH)
        layout = QVBoxLayout(column)
        layout.setSpacing(12)
        layout.addWidget(self._title())
        layout.addLayout(self._buttons())
        self._heading = QLabel(self.tr("Recent projects"), self)
        self._list = QListWidget(self)
        self._list.setAlternatingRowColors(True)
        self._list.itemActivated.connect(self._on_list_item_chosen)
        self._list.itemClicked.connect(self._on_list_item_chosen)
        layout.addWidget(self._heading)
        layout.addWidget(self._list, 1)
        hint = QLabel(
            self.tr(
                "Or drop files here: a project folder, or point clouds with their trajectory "
                "and list of images."
            ),
            self,
        )
        hint.setWordWrap(True)
        hint.setEnabled(False)
        layout.addWidget(hint)
        whole = QHBoxLayout(self)
        whole.setContentsMargins(24, 24, 24, 24)
        whole.addStretch(1)
        whole.addWidget(column, 4)
        whole.addStretch(1)
        self.show_recent(())

    def show_recent(self, folders: Iterable[Path]) -> None:
        """List these projects, the newest first."""
        self._list.clear()
        for folder in folders:
            item = QListWidgetItem(f"{folder.stem}\n{folder.parent}")
            item.setData(_PATH, str(folder))
            item.setToolTip(str(folder))
            self._list.addItem(item)
        has_some = self._list.count() > 0
        self._heading.setText(
            self.tr("Recent projects") if has_some else self.tr("No project was opened yet.")
        )
        self._list.setVisible(has_some)

    def _title(self) -> QLabel:
        title = QLabel(self.tr("Zuka"), self)
        font = title.font()
        font.setPixelSize(28)
        title.setFont(font)
        return title

    def _buttons(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(8)
        wishes = (
            (self.tr("Import a delivery…"), self.import_requested),
            (self.tr("Open a project…"), self.open_requested),
            (self.tr("Demo street"), self.demo_requested),
        )
        for words, wish in wishes:
            button = QPushButton(words, self)
            button.clicked.connect(_without_argument(wish.emit))
            row.addWidget(button)
        row.addStretch(1)
        return row

    def _on_list_item_chosen(self, item: QListWidgetItem) -> None:
        self.recent_chosen.emit(Path(str(item.data(_PATH))))


def _without_argument(emit: Callable[[], None]) -> Callable[[], None]:
    """Qt sends whether the button is checked; the signals don't tell it."""

    def called() -> None:
        emit()

    return called

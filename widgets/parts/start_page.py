"""StartPage: what the window shows while nothing is open."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from PySide6.QtCore import QDate, QEvent, QObject, Qt, Signal
from PySide6.QtGui import QAction, QKeyEvent, QShowEvent
from PySide6.QtWidgets import (
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QToolButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from processing.core.text import Language
from widgets.parts.recent_project import RecentProject

_WIDTH = 760
_NAME, _FOLDER, _OPENED, _REMOVE = range(4)
_PROJECT = Qt.ItemDataRole.UserRole


class StartPage(QWidget):
    """Recent projects, and the ways to begin.

    Parameters
    ----------
    language : Language
        By which dates are written.

    Signals
    -------
    open_requested, import_requested, demo_requested, simulation_requested
        The buttons.
    recent_chosen(folder: Path)
        A project of the list.
    forget_requested(folder: Path)
        A project is to be taken off the list.
    """

    open_requested = Signal()
    import_requested = Signal()
    demo_requested = Signal()
    simulation_requested = Signal()
    recent_chosen = Signal(object)
    forget_requested = Signal(object)

    def __init__(self, language: Language = "en", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._date_format = "yyyy/MM/dd" if language == "ja" else "yyyy-MM-dd"
        self._shown: tuple[RecentProject, ...] = ()
        column = QWidget(self)
        column.setMaximumWidth(_WIDTH)
        layout = QVBoxLayout(column)
        layout.setSpacing(12)
        layout.addWidget(self._title())
        layout.addLayout(self._buttons())
        self._heading = QLabel(self.tr("Recent projects"), self)
        self._list = self._recent_list()
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
        hint.setForegroundRole(self.palette().ColorRole.PlaceholderText)
        layout.addWidget(hint)
        layout.addStretch(0)
        whole = QHBoxLayout(self)
        whole.setContentsMargins(24, 24, 24, 24)
        whole.addStretch(1)
        whole.addWidget(column, 4)
        whole.addStretch(1)
        self.show_recent(())

    def show_recent(self, projects: Iterable[RecentProject]) -> None:
        """List these projects, the newest first."""
        self._shown = tuple(projects)
        self._list.clear()
        for project in self._shown:
            self._add(project)
        is_empty = not self._shown
        self._heading.setText(
            self.tr("No project was opened yet.") if is_empty else self.tr("Recent projects")
        )
        self._list.setVisible(not is_empty)
        there = [position for position, one in enumerate(self._shown) if not one.is_missing]
        first = self._list.topLevelItem(there[0] if there else 0)
        if first is not None:
            self._list.setCurrentItem(first)

    @override
    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        (self._list if self._list.topLevelItemCount() else self._first_button).setFocus()

    @override
    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and self._shown:
            self.show_recent(self._shown)  # in the greys of the other theme

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            item = self._list.currentItem()
            if event.key() == Qt.Key.Key_Delete and item is not None:
                self._forget(item)
                return True
        return super().eventFilter(watched, event)

    def _recent_list(self) -> QTreeWidget:
        recent = QTreeWidget(self)
        recent.setColumnCount(4)
        recent.setHeaderHidden(True)
        recent.setRootIsDecorated(False)
        recent.setUniformRowHeights(True)
        recent.setAllColumnsShowFocus(True)
        recent.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        header = recent.header()
        header.setStretchLastSection(False)
        header.setMinimumSectionSize(1)
        for column in (_NAME, _OPENED, _REMOVE):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(_FOLDER, QHeaderView.ResizeMode.Stretch)
        remove = QAction(self.tr("Remove from the list"), recent)
        remove.triggered.connect(self._on_remove_triggered)
        recent.addAction(remove)
        recent.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)
        recent.itemActivated.connect(self._on_list_item_chosen)
        recent.itemClicked.connect(self._on_list_item_chosen)
        recent.installEventFilter(self)
        return recent

    def _add(self, project: RecentProject) -> None:
        opened_at = project.opened_at
        day = None if opened_at is None else opened_at.date()
        opened = "" if day is None else QDate(*day.timetuple()[:3]).toString(self._date_format)
        item = QTreeWidgetItem(
            self._list,
            [
                project.folder.stem,
                str(project.folder.parent),
                self.tr("not found") if project.is_missing else opened,
            ],
        )
        item.setData(_NAME, _PROJECT, project)
        for column in range(4):
            item.setToolTip(column, str(project.folder))
            if project.is_missing or column in (_FOLDER, _OPENED):
                item.setForeground(column, self.palette().placeholderText())
        if project.is_missing:
            remove = QToolButton(self._list)
            remove.setText(self.tr("Remove from the list"))
            remove.setAutoRaise(True)
            remove.clicked.connect(_without_argument(lambda: self._forget(item)))
            self._list.setItemWidget(item, _REMOVE, remove)

    def _title(self) -> QLabel:
        title = QLabel(self.tr("Zuka"), self)
        font = title.font()
        font.setPixelSize(28)
        title.setFont(font)
        return title

    def _buttons(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(8)
        choices = (
            (self.tr("Import a delivery…"), self.import_requested),
            (self.tr("Open a project…"), self.open_requested),
            (self.tr("Sample street"), self.demo_requested),
            (self.tr("Simulate a recording…"), self.simulation_requested),
        )
        buttons = []
        for words, request in choices:
            button = QPushButton(words, self)
            button.setAutoDefault(True)  # Enter presses it, as Space does
            button.clicked.connect(_without_argument(request.emit))
            row.addWidget(button)
            buttons.append(button)
        self._first_button = buttons[0]
        row.addStretch(1)
        return row

    def _forget(self, item: QTreeWidgetItem) -> None:
        project: RecentProject = item.data(_NAME, _PROJECT)
        self.forget_requested.emit(project.folder)

    def _on_remove_triggered(self) -> None:
        item = self._list.currentItem()
        if item is not None:
            self._forget(item)

    def _on_list_item_chosen(self, item: QTreeWidgetItem) -> None:
        project: RecentProject = item.data(_NAME, _PROJECT)
        if not project.is_missing:
            self.recent_chosen.emit(Path(project.folder))


def _without_argument(emit: Callable[[], None]) -> Callable[[], None]:
    """Qt sends whether the button is checked; the signals don't tell it."""

    def called() -> None:
        emit()

    return called

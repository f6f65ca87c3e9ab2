"""ProjectDrives: the drives as items of the project's tree, shown or hidden by check boxes."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QEvent, QObject, QSignalBlocker, Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QMenu, QStyle, QTreeWidget, QTreeWidgetItem
from typing_extensions import override

from processing.core.text import Language
from processing.project.drive_description import brief_facts
from processing.recording.drive import Drive
from widgets.shared.map_source import MapSource
from widgets.shared.view_settings import ViewSettings

DRIVE = Qt.ItemDataRole.UserRole
"""Where an item keeps the id of its drive."""

_CHECKED, _UNCHECKED = Qt.CheckState.Checked, Qt.CheckState.Unchecked


class ProjectDrives(QObject):
    """Lists the drives; what is unchecked is left out of the views that show all drives.

    Parameters
    ----------
    source : MapSource
    settings : ViewSettings
    tree : QTreeWidget
        Its owner too.
    language : Language

    Signals
    -------
    drive_chosen(id: str)
        It is to be shown in the image.
    beside_requested(id: str)
        It is to be shown in an image beside the others.
    find_requested()
        The user knows where missing files are.
    trajectory_requested(id: str), images_requested(id: str)
        Files are to be chosen for a drive that the project has already.
    properties_requested(id: str)
        All that is known of a drive is to be shown, and mended.
    removal_requested(id: str)
    """

    drive_chosen = Signal(str)
    beside_requested = Signal(str)
    find_requested = Signal()
    trajectory_requested = Signal(str)
    images_requested = Signal(str)
    properties_requested = Signal(str)
    removal_requested = Signal(str)

    def __init__(
        self, source: MapSource, settings: ViewSettings, tree: QTreeWidget, language: Language
    ) -> None:
        super().__init__(tree)
        self._source = source
        self._settings = settings
        self._tree = tree
        self._language = language
        self._items: dict[str, QTreeWidgetItem] = {}
        self._troubles: Mapping[str, tuple[str, ...]] = {}
        self._was_checked = False
        # A click on the folder's box checks them all, one after the other.
        self._when_checked = QTimer(self, singleShot=True, interval=0)
        self._when_checked.timeout.connect(self._hide_unchecked)
        tree.itemChanged.connect(self._on_tree_item_changed)
        tree.itemPressed.connect(self._on_tree_item_pressed)
        tree.itemClicked.connect(self._on_tree_item_clicked)
        tree.itemActivated.connect(self._choose)
        tree.installEventFilter(self)
        settings.hidden_drives_changed.connect(self._show_checks)
        settings.image_changed.connect(self.mark_shown)

    def add_to(self, folder: QTreeWidgetItem) -> None:
        """Make an item for each drive."""
        boxed = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsUserCheckable
        self._items = {}
        with QSignalBlocker(self._tree):
            folder.setFlags(boxed | Qt.ItemFlag.ItemIsAutoTristate)
            for drive in self._source.drives():
                item = QTreeWidgetItem(folder, [drive.info.name])
                item.setFlags(boxed | Qt.ItemFlag.ItemIsSelectable)
                item.setData(0, DRIVE, drive.id)
                self._items[drive.id] = item
        self._show_checks()
        self.show_troubles(self._troubles)

    def forget(self) -> None:
        """The items are gone."""
        self._items = {}
        self._when_checked.stop()

    def show_troubles(self, troubles: Mapping[str, tuple[str, ...]]) -> None:
        """Mark drives whose delivered files are missing or others; what is said, by drive."""
        self._troubles = dict(troubles)
        warning = self._tree.style().standardIcon(QStyle.StandardPixmap.SP_MessageBoxWarning)
        with QSignalBlocker(self._tree):
            for drive in self._source.drives():
                item = self._items.get(drive.id)
                if item is not None:
                    words = self._troubles.get(drive.id, ())
                    item.setIcon(0, warning if words else type(warning)())
                    item.setToolTip(0, "\n".join((*words, *self._facts(drive))))
        self._tree.viewport().update()

    def mark_shown(self) -> None:
        """Make the drive bold that the image shows."""
        shown = self._settings.drive_id
        with QSignalBlocker(self._tree):
            for id_, item in self._items.items():
                font = item.font(0)
                if font.bold() is not (id_ == shown):
                    font.setBold(id_ == shown)
                    item.setFont(0, font)
            if shown in self._items:
                self._tree.setCurrentItem(self._items[shown])
        self._tree.viewport().update()

    def menu_of(self, id_: str) -> QMenu:
        """What can be done with a drive."""
        menu = QMenu(self._tree)
        hidden = self._settings.hidden_drives
        menu.addAction(self.tr("Show in the image"), lambda: self.drive_chosen.emit(id_))
        menu.addAction(self.tr("Show beside the image"), lambda: self.beside_requested.emit(id_))
        menu.addSeparator()
        words = (
            self.tr("Show in 3D, map and section")
            if id_ in hidden
            else self.tr("Hide in 3D, map and section")
        )
        menu.addAction(words, lambda: self._settings.hide_drives(hidden ^ {id_}))
        others = frozenset(self._items) - {id_}
        only = menu.addAction(
            self.tr("Show only this drive there"), lambda: self._settings.hide_drives(others)
        )
        only.setEnabled(bool(others))
        every = menu.addAction(
            self.tr("Show all drives there"), lambda: self._settings.hide_drives(frozenset())
        )
        every.setEnabled(bool(hidden))
        if self._troubles:
            menu.addSeparator()
            menu.addAction(self.tr("Find delivered files…"), self.find_requested.emit)
        menu.addSeparator()
        has_trajectory = self._source.drive(id_).trajectory is not None
        menu.addAction(
            self.tr("Replace the trajectory…") if has_trajectory else self.tr("Add a trajectory…"),
            lambda: self.trajectory_requested.emit(id_),
        )
        menu.addAction(self.tr("Add camera images…"), lambda: self.images_requested.emit(id_))
        menu.addSeparator()
        properties = menu.addAction(
            self.tr("Properties…"), lambda: self.properties_requested.emit(id_)
        )
        properties.setShortcut("Alt+Return")
        properties.setShortcutVisibleInContextMenu(True)
        remove = menu.addAction(
            self.tr("Remove from the project"), lambda: self.removal_requested.emit(id_)
        )
        remove.setShortcut(Qt.Key.Key_Delete)
        remove.setShortcutVisibleInContextMenu(True)
        menu.aboutToHide.connect(menu.deleteLater)
        return menu

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Delete removes the drive that is chosen, Alt+Enter shows its properties."""
        item = self._tree.currentItem()
        id_ = "" if item is None else str(item.data(0, DRIVE) or "")
        if not id_ or not isinstance(event, QKeyEvent):
            return super().eventFilter(watched, event)
        is_enter = event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
        asks = is_enter and event.modifiers() & Qt.KeyboardModifier.AltModifier
        if not asks and event.key() != Qt.Key.Key_Delete:
            return super().eventFilter(watched, event)
        if event.type() == QEvent.Type.ShortcutOverride:
            event.accept()
            return True
        if event.type() == QEvent.Type.KeyPress:
            (self.properties_requested if asks else self.removal_requested).emit(id_)
            return True
        return super().eventFilter(watched, event)

    # What the tree tells.

    def _on_tree_item_pressed(self) -> None:
        self._was_checked = False

    def _on_tree_item_changed(self) -> None:
        self._was_checked = True
        self._when_checked.start()

    def _on_tree_item_clicked(self, item: QTreeWidgetItem) -> None:
        # A click on the box is meant for the box only.
        if not self._was_checked:
            self._choose(item)

    def _choose(self, item: QTreeWidgetItem) -> None:
        id_ = item.data(0, DRIVE)
        if id_ and id_ != self._settings.drive_id:
            self.drive_chosen.emit(str(id_))

    # What is done in more than one place.

    def _hide_unchecked(self) -> None:
        unchecked = {id_ for id_, item in self._items.items() if item.checkState(0) is _UNCHECKED}
        self._settings.hide_drives(frozenset(unchecked))

    def _show_checks(self) -> None:
        hidden = self._settings.hidden_drives
        with QSignalBlocker(self._tree):
            for id_, item in self._items.items():
                item.setCheckState(0, _UNCHECKED if id_ in hidden else _CHECKED)
        self._tree.viewport().update()

    def _facts(self, drive: Drive) -> tuple[str, ...]:
        shown = ((name.in_language(self._language), value) for name, value in brief_facts(drive))
        told = (f"{name}: {value.in_language(self._language)}" for name, value in shown)
        return (drive.info.name, *told)

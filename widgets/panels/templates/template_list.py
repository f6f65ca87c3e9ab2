"""TemplateList: the templates of a project by name, and what can be done with them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QFileDialog,
    QHBoxLayout,
    QListWidget,
    QListWidgetItem,
    QMenu,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from processing.core.errors import UserError
from processing.methods.templates.profile_template import ProfileTemplate
from processing.project.template_store import ENDING, TemplateStore, export_template

TemplateStoreSource = Callable[[], TemplateStore | None]
"""The templates of the open project; None when none is open."""

_ROWS_SHOWN = 4


class TemplateList(QWidget):
    """Names that can be chosen, changed by F2 or a double click, and removed by Delete.

    Parameters
    ----------
    shelf : callable
        Asked each time: another project may be open.

    Signals
    -------
    chosen(template: ProfileTemplate | None)
        Another template is looked at, or this one was changed.
    draw_requested()
        The button for a new one.
    refused(error: UserError)
        Something can't be stored or read; everything is as it was.
    """

    chosen = Signal(object)
    draw_requested = Signal()
    refused = Signal(object)

    def __init__(self, shelf: TemplateStoreSource, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._shelf = shelf
        self._list = QListWidget(self)
        self._list.setUniformItemSizes(True)
        height = self._list.fontMetrics().height() + 8
        self._list.setMinimumHeight(2 * height)
        self._list.setMaximumHeight(_ROWS_SHOWN * height)
        self._new = QPushButton(self.tr("Draw new"), self)
        self._new.setToolTip(self.tr("Draw the wanted profile in the section"))
        self._more = QPushButton(self.tr("Manage"), self)
        self._more.setMenu(self._make_menu())
        for button in (self._new, self._more):
            button.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        buttons = QHBoxLayout()
        buttons.setSpacing(4)
        buttons.addWidget(self._new, 1)
        buttons.addWidget(self._more, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        layout.addWidget(self._list)
        layout.addLayout(buttons)
        self._new.clicked.connect(self.draw_requested)
        self._list.currentItemChanged.connect(self._on_list_current_item_changed)
        self._list.itemChanged.connect(self._on_list_item_changed)
        self.refresh()

    @property
    def current(self) -> ProfileTemplate | None:
        """The template that is chosen; None when there is none."""
        item = self._list.currentItem()
        store = self._shelf()
        return None if item is None or store is None else store.get(_name_of(item))

    @property
    def names(self) -> tuple[str, ...]:
        """The names in the list."""
        return tuple(self._list.item(row).text() for row in range(self._list.count()))

    def refresh(self, choose: str = "") -> None:
        """Read the project's templates anew and choose one; without a name the one before."""
        item = self._list.currentItem()
        wanted = choose or ("" if item is None else _name_of(item))
        store = self._shelf()
        try:
            templates = () if store is None else store.all()
        except UserError as error:
            templates = ()
            self.refused.emit(error)
        with QSignalBlocker(self._list):
            self._list.clear()
            for template in templates:
                one = QListWidgetItem(template.name, self._list)
                one.setData(Qt.ItemDataRole.UserRole, template.name)
                one.setFlags(one.flags() | Qt.ItemFlag.ItemIsEditable)
            names = [template.name for template in templates]
            self._list.setCurrentRow(names.index(wanted) if wanted in names else len(names) - 1)
        for part in (self._new, self._more):
            part.setEnabled(store is not None)
        self.chosen.emit(self.current)

    def add(self, template: ProfileTemplate) -> None:
        """Keep a new template, under a name that is free, and choose it."""
        self._store(lambda store: _add_template(store, template))

    def replace(self, template: ProfileTemplate) -> None:
        """Keep a changed template under its name."""
        self._store(lambda store: _put(store, template))

    def import_file(self, path: Path) -> None:
        """Take in a template from a file and choose it."""
        self._store(lambda store: store.import_file(path).name)

    def export_to(self, path: Path) -> None:
        """Write the chosen template as a file for other projects."""
        template = self.current
        if template is None:
            return
        try:
            export_template(template, path)
        except UserError as error:
            self.refused.emit(error)

    def rename(self, name: str) -> None:
        """Give the chosen template another name."""
        template = self.current
        if template is not None:
            self._store(lambda store: _rename_template(store, template.name, name))

    def remove(self) -> None:
        """Forget the chosen template."""
        template = self.current
        if template is not None:
            self._store(lambda store: _remove_template(store, template.name))

    def _make_menu(self) -> QMenu:
        menu = QMenu(self)
        menu.addAction(self.tr("Rename"), self._on_rename)
        menu.addAction(self.tr("Delete"), self.remove)
        menu.addSeparator()
        menu.addAction(self.tr("Import…"), self._on_import)
        menu.addAction(self.tr("Export…"), self._on_export)
        menu.aboutToShow.connect(self._on_menu_about_to_show)
        return menu

    def _store(self, act: Callable[[TemplateStore], str]) -> None:
        """Do something with the project's templates and choose the one it names."""
        store = self._shelf()
        if store is None:
            return
        choose = ""
        try:
            choose = act(store)
        except UserError as error:
            self.refused.emit(error)
        self.refresh(choose)

    def _on_list_current_item_changed(self) -> None:
        self.chosen.emit(self.current)

    def _on_list_item_changed(self, item: QListWidgetItem) -> None:
        before = _name_of(item)
        if item.text() != before:
            self._store(lambda store: _rename_template(store, before, item.text()))

    def _on_menu_about_to_show(self) -> None:
        is_there = self._list.currentItem() is not None
        for action in self._more.menu().actions():
            action.setEnabled(is_there or action.text() == self.tr("Import…"))

    def _on_rename(self) -> None:
        item = self._list.currentItem()
        if item is not None:
            self._list.editItem(item)

    def _on_import(self) -> None:
        path, _ = QFileDialog.getOpenFileName(
            self, self.tr("Import a template"), "", self.tr("Templates (*.json)")
        )
        if path:
            self.import_file(Path(path))

    def _on_export(self) -> None:
        template = self.current
        if template is None:
            return
        path, _ = QFileDialog.getSaveFileName(
            self, self.tr("Export the template"), template.name, self.tr("Templates (*.json)")
        )
        if path:
            chosen = Path(path)
            self.export_to(chosen if chosen.suffix else chosen.with_suffix(ENDING))


def _name_of(item: QListWidgetItem) -> str:
    return str(item.data(Qt.ItemDataRole.UserRole))


def _add_template(store: TemplateStore, template: ProfileTemplate) -> str:
    named = replace(template, name=store.free_name(template.name))
    store.put(named)
    return named.name


def _put(store: TemplateStore, template: ProfileTemplate) -> str:
    store.put(template)
    return template.name


def _rename_template(store: TemplateStore, before: str, name: str) -> str:
    store.rename(before, name)
    return name.strip()


def _remove_template(store: TemplateStore, name: str) -> str:
    store.remove(name)
    return ""

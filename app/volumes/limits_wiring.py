"""Wiring of as-built limits: the box in the panel of volumes, and what the project keeps of it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QObject
from PySide6.QtWidgets import QFileDialog

from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.methods.earthwork.as_built.limits_file import BUNDLED
from processing.project.work_store import WorkStore

_UNKNOWN = "?"
_WROTE = Text("Wrote {path}.", "{path} を書き出しました。")


def connect_limits(parts: WindowParts) -> None:
    """Connect the box of limits with the document; again for a new one."""
    wiring = _LimitsWiring(parts)
    box = parts.volume_panel.limits
    box.work_type_chosen.connect(wiring.on_box_work_type_chosen)
    box.table_wanted.connect(wiring.on_box_table_wanted)
    box.bundled_wanted.connect(wiring.on_box_bundled_wanted)
    box.copy_wanted.connect(wiring.on_box_copy_wanted)
    parts.document.opened.connect(wiring.show_table)
    wiring.show_table()


class _LimitsWiring(QObject):
    """What the box asks for is stored at once, and shown as it is stored."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts

    def show_table(self) -> None:
        """Show the table that counts in the open project."""
        project = self._parts.document.project
        if project is None:
            return
        box = self._parts.volume_panel.limits
        try:
            limits = WorkStore(project.settings).limits()
        except UserError as error:
            box.show_table((), "", _UNKNOWN)  # another table can be chosen
            self._parts.document.refused.emit(error)
            return
        work_types = tuple((one.id, one.name) for one in limits.table.work_types)
        box.show_table(work_types, limits.shown_work_type, limits.file_name)

    def on_box_work_type_chosen(self, id_: str) -> None:
        self._keep(lambda store: store.choose_work_type(id_))

    def on_box_bundled_wanted(self) -> None:
        self._keep(lambda store: store.drop_limits())

    def on_box_table_wanted(self) -> None:
        project = self._parts.document.project
        if project is None:
            return
        chosen, _ = QFileDialog.getOpenFileName(
            self._parts.window,
            QCoreApplication.translate("LimitsWiring", "Table of limits"),
            str(project.folder.parent),
            FORMATS.filter_read(Content.LIMITS).in_language(self._parts.language),
        )
        if chosen:
            self._keep(lambda store: store.adopt_limits(Path(chosen)))

    def on_box_copy_wanted(self) -> None:
        project = self._parts.document.project
        if project is None:
            return
        chosen, _ = QFileDialog.getSaveFileName(
            self._parts.window,
            QCoreApplication.translate("LimitsWiring", "Write the table of limits"),
            str(project.folder.parent / Path(BUNDLED).name),
            FORMATS.filter_written(Content.LIMITS).in_language(self._parts.language),
        )
        if not chosen:
            return
        delivered = [file for drive in project.drives for file in drive.delivered_files]
        try:
            WorkStore(project.settings).write_limits(Path(chosen), never=delivered)
        except UserError as error:
            self._parts.document.refused.emit(error)
            return
        self._parts.document.reported.emit(_WROTE.filled(path=Path(chosen).name))

    def _keep(self, change: Callable[[WorkStore], None]) -> None:
        """Store a change; the box shows what counts, whether it could be stored or not."""
        project = self._parts.document.project
        if project is None:
            return
        try:
            change(WorkStore(project.settings))
        except UserError as error:
            self._parts.document.refused.emit(error)
        self.show_table()

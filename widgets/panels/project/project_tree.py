"""ProjectTree: the drives of the project, their images, and the runs of tools."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtWidgets import (
    QLabel,
    QStackedWidget,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from processing.core.text import Language
from processing.recording.drive import Drive
from widgets.panels.project.project_drives import DRIVE, ProjectDrives
from widgets.panels.project.project_runs import RUN, ProjectRuns
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState


class ProjectTree(QWidget):
    """What the project holds; a click on a drive shows it, drives and runs have menus.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language

    Signals
    -------
    drive_chosen(id: str)
    beside_requested(id: str)
        A drive is to be shown in an image beside the others.
    find_requested()
        The user knows where missing files are.
    trajectory_requested(id: str), images_requested(id: str), removal_requested(id: str)
        Files are to be added to a drive, or it is to leave the project.
    properties_requested(id: str)
    review_requested(run: str)
        The candidates of a run are to be judged.
    comparison_requested(run: str)
        A run is to be held against another one of its tool.
    change_requested(label: Text, change: Change)
    """

    drive_chosen = Signal(str)
    beside_requested = Signal(str)
    find_requested = Signal()
    trajectory_requested = Signal(str)
    images_requested = Signal(str)
    properties_requested = Signal(str)
    removal_requested = Signal(str)
    review_requested = Signal(str)
    comparison_requested = Signal(str)
    change_requested = Signal(object, object)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._tree = QTreeWidget(self)
        self._tree.setHeaderHidden(True)
        self._tree.setIndentation(12)
        self._tree.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self._tree.customContextMenuRequested.connect(self._on_tree_menu_requested)
        self._drives = ProjectDrives(source, shared.view_settings, self._tree, language)
        self._drives.drive_chosen.connect(self.drive_chosen)
        self._drives.beside_requested.connect(self.beside_requested)
        self._drives.find_requested.connect(self.find_requested)
        self._drives.trajectory_requested.connect(self.trajectory_requested)
        self._drives.images_requested.connect(self.images_requested)
        self._drives.properties_requested.connect(self.properties_requested)
        self._drives.removal_requested.connect(self.removal_requested)
        self._runs = ProjectRuns(source, shared.view_settings, self._tree, language)
        self._runs.review_requested.connect(self.review_requested)
        self._runs.comparison_requested.connect(self.comparison_requested)
        self._runs.change_requested.connect(self.change_requested)
        empty = QLabel(self.tr("Drives appear here once a project is open."), self)
        empty.setWordWrap(True)
        empty.setEnabled(False)
        empty.setAlignment(Qt.AlignmentFlag.AlignTop)
        empty.setContentsMargins(8, 8, 8, 8)
        self._pages = QStackedWidget(self)
        self._pages.addWidget(empty)
        self._pages.addWidget(self._tree)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._pages)
        shared.map_changes.drives_changed.connect(self.refresh)
        shared.map_changes.features_changed.connect(self._on_map_features_changed)
        self.refresh()

    def refresh(self) -> None:
        """Read the project again."""
        self._runs.read_all()
        self._show()

    def show_troubles(self, troubles: Mapping[str, tuple[str, ...]]) -> None:
        """Mark drives whose delivered files are missing or others; what is said, by drive."""
        self._drives.show_troubles(troubles)

    def _show(self) -> None:
        self._runs.forget()
        self._drives.forget()
        self._tree.clear()
        drives = self._source.drives()
        self._drives.add_to(self._folder(self.tr("Drives")))
        self._add_images(drives)
        if not self._runs.is_empty:
            self._runs.add_to(self._folder(self.tr("Runs")))
        self._tree.expandAll()
        self._pages.setCurrentIndex(1 if drives else 0)
        self._drives.mark_shown()

    def _add_images(self, drives: tuple[Drive, ...]) -> None:
        with_images = [drive for drive in drives if drive.images is not None and len(drive.images)]
        if not with_images:
            return
        folder = self._folder(self.tr("Camera images"))
        for drive in with_images:
            count = 0 if drive.images is None else len(drive.images)
            words = self.tr("{name}: %n image(s)", "", count).format(name=drive.info.name)
            QTreeWidgetItem(folder, [words])

    def _folder(self, title: str) -> QTreeWidgetItem:
        folder = QTreeWidgetItem(self._tree, [title])
        folder.setFlags(Qt.ItemFlag.ItemIsEnabled)
        return folder

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        if self._runs.took(ids):
            self._show()

    def _on_tree_menu_requested(self, spot: QPoint) -> None:
        item = self._tree.itemAt(spot)
        if item is None:
            return
        run, drive = item.data(0, RUN), item.data(0, DRIVE)
        menu = self._runs.menu_of(str(run)) if run else None
        if drive:
            menu = self._drives.menu_of(str(drive))
        if menu is not None:
            menu.popup(self._tree.viewport().mapToGlobal(spot))

"""ProjectTree: the drives of the project, their images, and the runs of tools."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QLabel,
    QStackedWidget,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from processing.points.drive import Drive
from processing.text import Language
from widgets.panels.project_runs import RUN, ProjectRuns
from widgets.panels.tree_items import children_of
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_DRIVE = Qt.ItemDataRole.UserRole


class ProjectTree(QWidget):
    """What the project holds; a click on a drive shows it, a run has a menu.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language

    Signals
    -------
    drive_chosen(id: str)
    review_requested(run: str)
        The candidates of a run are to be judged.
    change_requested(label: Text, change: Change)
    """

    drive_chosen = Signal(str)
    review_requested = Signal(str)
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
        self._settings = shared.view_settings
        self._language = language
        self._tree = QTreeWidget(self)
        self._tree.setHeaderHidden(True)
        self._tree.setIndentation(12)
        self._tree.itemClicked.connect(self._on_tree_item_chosen)
        self._tree.itemActivated.connect(self._on_tree_item_chosen)
        self._tree.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self._tree.customContextMenuRequested.connect(self._on_tree_menu_requested)
        self._runs = ProjectRuns(source, shared.view_settings, self._tree, language)
        self._runs.review_requested.connect(self.review_requested)
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
        self._settings.image_changed.connect(self._mark_shown)
        self.refresh()

    def refresh(self) -> None:
        """Read the project again."""
        self._runs.read_all()
        self._show()

    def _show(self) -> None:
        self._runs.forget()
        self._tree.clear()
        drives = self._source.drives()
        folder = self._folder(self.tr("Drives"))
        for drive in drives:
            item = QTreeWidgetItem(folder, [drive.info.name])
            item.setData(0, _DRIVE, drive.id)
            item.setToolTip(0, self._facts(drive))
        self._add_images(drives)
        if not self._runs.is_empty:
            self._runs.add_to(self._folder(self.tr("Runs")))
        self._tree.expandAll()
        self._pages.setCurrentIndex(1 if drives else 0)
        self._mark_shown()

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

    def _facts(self, drive: Drive) -> str:
        info = drive.info
        low, high = info.lowest, info.highest
        size = " × ".join(f"{b - a:,.1f}" for a, b in zip(low, high, strict=True))
        facts = [
            info.name,
            self.tr("{count} points").format(count=f"{info.count:,}"),
            self.tr("{size} m").format(size=size),
            info.crs or self.tr("reference system unknown"),
            self._rows_words(drive),
            *(source.path for source in info.sources),
        ]
        return "\n".join(facts)

    def _rows_words(self, drive: Drive) -> str:
        if drive.turns is None:
            reason = drive.info.rows_reason.spoken(self._language)
            return self.tr("No turns of a scanner: {reason}").format(reason=reason)
        return self.tr("{rate} turns per second, {pulses} pulses per turn").format(
            rate=f"{drive.turns.turn_rate_hz:.1f}", pulses=f"{drive.turns.pulses_per_turn:.0f}"
        )

    def _mark_shown(self) -> None:
        shown = self._settings.drive_id
        with QSignalBlocker(self._tree):
            for item in children_of(children_of(self._tree)[0]):
                is_shown = bool(shown) and item.data(0, _DRIVE) == shown
                font = item.font(0)
                font.setBold(is_shown)
                item.setFont(0, font)
                if is_shown:
                    self._tree.setCurrentItem(item)

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        if self._runs.took(ids):
            self._show()

    def _on_tree_menu_requested(self, spot: QPoint) -> None:
        item = self._tree.itemAt(spot)
        run = None if item is None else item.data(0, RUN)
        menu = self._runs.menu_of(str(run)) if run else None
        if menu is not None:
            menu.popup(self._tree.viewport().mapToGlobal(spot))

    def _on_tree_item_chosen(self, item: QTreeWidgetItem) -> None:
        drive_id = item.data(0, _DRIVE)
        if drive_id and drive_id != self._settings.drive_id:
            self.drive_chosen.emit(str(drive_id))

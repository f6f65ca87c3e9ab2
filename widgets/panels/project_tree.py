"""ProjectTree: the drives of the project, their images, and the runs of tools."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Qt, Signal
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
from processing.tools.registry import TOOLS
from widgets.panels.feature_tally import FeatureTally
from widgets.panels.tree_items import children_of
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_DRIVE = Qt.ItemDataRole.UserRole


class ProjectTree(QWidget):
    """What the project holds; a click on a drive shows it.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language

    Signals
    -------
    drive_chosen(id: str)
    """

    drive_chosen = Signal(str)

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
        self._tally = FeatureTally(source)
        self.refresh()

    def refresh(self) -> None:
        """Read the project again."""
        self._tally.read_all()
        self._show()

    def _show(self) -> None:
        self._tree.clear()
        drives = self._source.drives()
        folder = self._folder(self.tr("Drives"))
        for drive in drives:
            item = QTreeWidgetItem(folder, [drive.info.name])
            item.setData(0, _DRIVE, drive.id)
            item.setToolTip(0, self._facts(drive))
        self._add_images(drives)
        self._add_runs()
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

    def _add_runs(self) -> None:
        runs = self._tally.by_run
        if not runs:
            return
        folder = self._folder(self.tr("Runs"))
        for run, count in runs.items():
            name = TOOLS[run.tool].name.spoken(self._language) if run.tool in TOOLS else run.tool
            words = self.tr("{name}: %n feature(s)", "", count).format(name=name)
            item = QTreeWidgetItem(folder, [words])
            item.setToolTip(0, run.run)

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
        before = self._tally.by_run
        self._tally.read(ids)
        if self._tally.by_run != before:
            self._show()

    def _on_tree_item_chosen(self, item: QTreeWidgetItem) -> None:
        drive_id = item.data(0, _DRIVE)
        if drive_id and drive_id != self._settings.drive_id:
            self.drive_chosen.emit(str(drive_id))

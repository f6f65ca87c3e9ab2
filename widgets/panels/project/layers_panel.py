"""LayersPanel: the kinds of features, how many there are, which are shown and which is drawn."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QHeaderView,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from processing.core.text import Language
from processing.map.catalogue import FeatureKind
from widgets.feature_drawing.swatch import swatch_of
from widgets.panels.feature_tally import FeatureTally
from widgets.panels.tree_items import children_of
from widgets.parts.search_field import SearchField
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_KIND = Qt.ItemDataRole.UserRole
_NAME, _COUNT, _KEY, _SHOWN = range(4)
_LEAST_COLUMN_PX = 16


class LayersPanel(QWidget):
    """Kinds that are on the map first, then all others of the catalogue.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language

    Signals
    -------
    kind_chosen(id: str)
        Draw features of this kind.
    """

    kind_chosen = Signal(str)

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
        self._tally = FeatureTally(source)
        self._marked = ""
        self._list = QTreeWidget(self)
        self._search = SearchField(self._list, self)
        self._search.setPlaceholderText(self.tr("Search for a kind"))
        self._list.setColumnCount(4)
        self._list.setHeaderHidden(True)
        self._list.setIndentation(8)
        self._list.setRootIsDecorated(False)
        self._list.setUniformRowHeights(True)
        self._list.header().setStretchLastSection(False)
        self._list.header().setSectionResizeMode(_NAME, QHeaderView.ResizeMode.Stretch)
        self._list.header().setMinimumSectionSize(_LEAST_COLUMN_PX)
        for column in (_COUNT, _KEY, _SHOWN):
            self._list.header().setSectionResizeMode(
                column, QHeaderView.ResizeMode.ResizeToContents
            )
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 8)
        layout.setSpacing(4)
        layout.addWidget(self._search)
        layout.addWidget(self._list, 1)
        self._search.textChanged.connect(self._filter)
        self._list.itemChanged.connect(self._on_list_item_changed)
        self._list.itemClicked.connect(self._on_list_item_clicked)
        shared.map_changes.features_changed.connect(self._on_map_features_changed)
        shared.map_changes.drives_changed.connect(self._on_map_drives_changed)
        self._settings.hidden_kinds_changed.connect(self._on_settings_hidden_kinds_changed)
        self._on_map_drives_changed()

    def read_catalogue(self) -> None:
        """Show the kinds of another catalogue."""
        self._on_map_drives_changed()

    def mark_kind(self, kind: FeatureKind) -> None:
        """Show which kind is drawn now."""
        self._marked = kind.id
        with QSignalBlocker(self._list):
            self._mark()

    def _show(self) -> None:
        counts = self._tally.by_kind
        catalogue = self._source.catalogue()
        on_map = [kind for kind in catalogue.kinds if counts[kind.id]]
        others = [kind for kind in catalogue.kinds if not counts[kind.id]]
        with QSignalBlocker(self._list):
            self._list.clear()
            for title, kinds in (
                (self.tr("On the map"), on_map),
                (self.tr("All other kinds") if on_map else self.tr("All kinds"), others),
            ):
                if kinds:
                    group = QTreeWidgetItem(self._list, [title])
                    group.setFlags(Qt.ItemFlag.ItemIsEnabled)
                    group.setFirstColumnSpanned(True)
                    for kind in kinds:
                        self._add(group, kind, counts[kind.id])
            self._list.expandAll()
            self._mark()
        self._filter(self._search.text())

    def _add(self, group: QTreeWidgetItem, kind: FeatureKind, count: int) -> None:
        name = kind.name.in_language(self._language)
        item = QTreeWidgetItem(group, [name, f"{count:,}" if count else "", kind.key])
        item.setData(_NAME, _KIND, kind.id)
        item.setIcon(_NAME, swatch_of(kind.colour))
        item.setTextAlignment(_COUNT, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        item.setTextAlignment(_KEY, Qt.AlignmentFlag.AlignCenter)
        item.setForeground(_KEY, self.palette().placeholderText())
        other = kind.name.en if self._language == "ja" else kind.name.ja
        item.setToolTip(_NAME, "\n".join(part for part in (name, other, kind.layer) if part))
        item.setToolTip(_KEY, self.tr("Key that chooses this kind") if kind.key else "")
        item.setToolTip(_SHOWN, self.tr("Whether features of this kind are shown"))
        if count:
            item.setCheckState(_SHOWN, self._check_state(kind.id))

    def _items(self) -> list[QTreeWidgetItem]:
        return [item for group in children_of(self._list) for item in children_of(group)]

    def _mark(self) -> None:
        for item in self._items():
            is_marked = item.data(_NAME, _KIND) == self._marked
            font = item.font(_NAME)
            font.setBold(is_marked)
            item.setFont(_NAME, font)
            if is_marked:
                self._list.setCurrentItem(item)

    def _filter(self, words: str) -> None:
        wanted = words.lower().split()
        catalogue = self._source.catalogue()
        for item in self._items():
            kind = catalogue[str(item.data(_NAME, _KIND))]
            names = f"{kind.name.en} {kind.name.ja} {kind.id} {kind.layer}".lower()
            item.setHidden(not all(word in names for word in wanted))
        for group in children_of(self._list):
            group.setHidden(all(item.isHidden() for item in children_of(group)))

    def _on_list_item_changed(self, item: QTreeWidgetItem, column: int) -> None:
        if column != _SHOWN:
            return
        kind = str(item.data(_NAME, _KIND))
        is_shown = item.checkState(_SHOWN) == Qt.CheckState.Checked
        hidden = self._settings.hidden_kinds
        self._settings.hide_kinds(hidden - {kind} if is_shown else hidden | {kind})

    def _on_list_item_clicked(self, item: QTreeWidgetItem, column: int) -> None:
        kind = item.data(_NAME, _KIND)
        # A click on the check box changes what is shown, not what is drawn.
        if kind is not None and column != _SHOWN:
            self.kind_chosen.emit(str(kind))

    def _on_settings_hidden_kinds_changed(self) -> None:
        counts = self._tally.by_kind
        with QSignalBlocker(self._list):
            for item in self._items():
                kind = str(item.data(_NAME, _KIND))
                if counts[kind]:
                    item.setCheckState(_SHOWN, self._check_state(kind))

    def _check_state(self, kind: str) -> Qt.CheckState:
        is_hidden = kind in self._settings.hidden_kinds
        return Qt.CheckState.Unchecked if is_hidden else Qt.CheckState.Checked

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        before = self._tally.by_kind
        self._tally.read(ids)
        if self._tally.by_kind != before:
            self._show()

    def _on_map_drives_changed(self) -> None:
        self._tally.read_all()
        self._show()

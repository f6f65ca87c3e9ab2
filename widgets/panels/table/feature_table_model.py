"""FeatureTableModel: the rows and columns of the feature table, as Qt asks for them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from PySide6.QtCore import (
    QAbstractTableModel,
    QItemSelectionRange,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    Qt,
)
from PySide6.QtGui import QIcon, QPalette
from typing_extensions import override

from processing.core.text import Language
from processing.map.feature import Feature, Status
from processing.map.feature_query import FeatureQuery
from widgets.feature_drawing.feature_style import colour_of_kind
from widgets.feature_drawing.swatch import swatch_of
from widgets.panels.table.feature_columns import KIND, FeatureColumn, FeatureColumns
from widgets.panels.table.feature_rows import FeatureRows
from widgets.shared.map_source import MapSource

MOST_SINGLE_CHANGES = 100
"""With more features changed at once, all rows are laid anew: that takes less time."""

_ROLE = Qt.ItemDataRole
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
_NOWHERE = QModelIndex()


class FeatureTableModel(QAbstractTableModel):
    """One row for each feature that the query finds; cells are written when they are looked at.

    As long as all rows are of one kind, its attributes are columns too.

    Parameters
    ----------
    source : MapSource
    language : Language
    """

    def __init__(
        self, source: MapSource, language: Language, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._language = language
        self._catalogue = source.catalogue()
        self._made = FeatureColumns(self._catalogue, language)
        self._columns = self._made.of_all()
        self._kind_of_columns = ""
        self._sorted_by = ""
        self._is_descending = False
        self._swatches: dict[str, QIcon] = {}
        self.rows = FeatureRows(self._catalogue)

    @property
    def columns(self) -> tuple[FeatureColumn, ...]:
        """The columns, from left to right as they are numbered."""
        return self._columns

    @property
    def sorted_by(self) -> tuple[int, Qt.SortOrder]:
        """The number of the column by which rows are sorted, −1 for none, and the direction."""
        order = Qt.SortOrder.DescendingOrder if self._is_descending else Qt.SortOrder.AscendingOrder
        return self._column_of(self._sorted_by), order

    def rows_between(self, top: int, bottom: int) -> QItemSelectionRange:
        """The cells of the rows ``top`` to ``bottom``, both counted."""
        last = len(self._columns) - 1
        return QItemSelectionRange(self.createIndex(top, 0), self.createIndex(bottom, last))

    def read_all(self) -> None:
        """Read all features again."""
        self.beginResetModel()
        catalogue = self._source.catalogue()
        if catalogue is not self._catalogue:
            self._catalogue = catalogue
            self._made = FeatureColumns(catalogue, self._language)
            self._columns = self._made.of_all()
            self._kind_of_columns = ""
            self._swatches.clear()
            self._sort_rows()
        self.rows.read(self._source.features(), catalogue)
        self._fit_columns()
        self.endResetModel()

    def read(self, ids: Sequence[str]) -> None:
        """Read some features again: changed, new, or no more."""
        changed = [(id_, self._source.feature(id_)) for id_ in dict.fromkeys(ids)]
        if len(changed) > MOST_SINGLE_CHANGES:
            self.beginResetModel()
            self.rows.change_many(changed)
            self._fit_columns()
            self.endResetModel()
            return
        for id_, feature in changed:
            self._change(id_, feature)
        if self._kind_of_columns != self._common_kind():
            self.beginResetModel()
            self._fit_columns()
            self.endResetModel()

    def find(self, query: FeatureQuery) -> None:
        """Show what another query finds."""
        if query == self.rows.query:
            return
        self.beginResetModel()
        self.rows.find(query)
        self._fit_columns()
        self.endResetModel()

    def _change(self, id_: str, feature: Feature | None) -> None:
        rows = self.rows
        row = rows.row_of(id_)
        if feature is not None and row >= 0 and rows.keeps_position(feature):
            rows.replace(feature)
            self.dataChanged.emit(self.index(row, 0), self.index(row, len(self._columns) - 1))
            return
        if row >= 0:
            self.beginRemoveRows(_NOWHERE, row, row)
        rows.remove(id_)
        if row >= 0:
            self.endRemoveRows()
        if feature is None:
            return
        row = rows.row_for(feature)
        if row >= 0:
            self.beginInsertRows(_NOWHERE, row, row)
        rows.insert(feature)
        if row >= 0:
            self.endInsertRows()

    def _common_kind(self) -> str:
        """The kind of all rows; empty when they are of several, or the catalogue lacks it."""
        kinds = self.rows.shown_kinds
        kind = next(iter(kinds)) if len(kinds) == 1 else ""
        return kind if kind in self._catalogue else ""

    def _fit_columns(self) -> None:
        kind = self._common_kind()
        if kind == self._kind_of_columns:
            return
        self._kind_of_columns = kind
        self._columns = self._made.of_kind(self._catalogue[kind]) if kind else self._made.of_all()
        self._sort_rows()

    def _sort_rows(self) -> None:
        column = self._column_of(self._sorted_by)
        if column < 0:
            self._sorted_by = ""
        self.rows.sort(
            self._columns[column].key if column >= 0 else None, descending=self._is_descending
        )

    def _column_of(self, id_: str) -> int:
        return next((i for i, column in enumerate(self._columns) if column.id == id_), -1)

    @override
    def rowCount(self, parent: QModelIndex | QPersistentModelIndex = _NOWHERE) -> int:
        return 0 if parent.isValid() else len(self.rows)

    @override
    def columnCount(self, parent: QModelIndex | QPersistentModelIndex = _NOWHERE) -> int:
        return 0 if parent.isValid() else len(self._columns)

    @override
    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        self.beginResetModel()
        self._sorted_by = self._columns[column].id if 0 <= column < len(self._columns) else ""
        self._is_descending = bool(self._sorted_by) and order == Qt.SortOrder.DescendingOrder
        self._sort_rows()
        self.endResetModel()

    @override
    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = _ROLE.DisplayRole
    ) -> object:
        if orientation != Qt.Orientation.Horizontal or not 0 <= section < len(self._columns):
            return None
        column = self._columns[section]
        if role == _ROLE.DisplayRole:
            return column.title
        if role == _ROLE.ToolTipRole:
            return column.tip
        if role == _ROLE.TextAlignmentRole:
            left = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
            return _RIGHT if column.is_number else left
        return None

    @override
    def data(
        self, index: QModelIndex | QPersistentModelIndex, role: int = _ROLE.DisplayRole
    ) -> object:
        if not index.isValid() or index.row() >= len(self.rows):
            return None
        column = self._columns[index.column()]
        if role == _ROLE.TextAlignmentRole:
            return _RIGHT if column.is_number else None
        if role not in (_ROLE.DisplayRole, _ROLE.DecorationRole, _ROLE.ForegroundRole):
            return None
        feature = self.rows.at(index.row())
        if role == _ROLE.DisplayRole:
            return column.text(feature)
        if role == _ROLE.DecorationRole:
            return self._swatch(feature.kind) if column.id == KIND else None
        is_rejected = feature.status is Status.REJECTED
        return QPalette().brush(QPalette.ColorRole.PlaceholderText) if is_rejected else None

    def _swatch(self, kind: str) -> QIcon:
        if kind not in self._swatches:
            self._swatches[kind] = swatch_of(colour_of_kind(self._catalogue, kind))
        return self._swatches[kind]


def ids_of(features: Iterable[Feature]) -> frozenset[str]:
    """The ids of features."""
    return frozenset(feature.id for feature in features)

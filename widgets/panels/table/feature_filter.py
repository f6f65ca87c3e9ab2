"""FeatureFilter: the line above the feature table in which a rule is said."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QLocale, QSignalBlocker, Qt, Signal
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QCompleter,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from processing.core.text import Language, Text
from processing.map.catalogue import AttributeField, Catalogue
from processing.map.feature import Status
from processing.map.feature_query import AttributeCondition, FeatureQuery, ValueComparison
from widgets.feature_drawing.feature_style import colour_of_kind
from widgets.feature_drawing.swatch import swatch_of
from widgets.panels.feature_words import STATUS_NAMES, name_of_kind

_COMPARISONS = {
    ValueComparison.EQUAL: Text.same("="),
    ValueComparison.NOT_EQUAL: Text.same("≠"),
    ValueComparison.LESS: Text.same("<"),
    ValueComparison.GREATER: Text.same(">"),
    ValueComparison.CONTAINS: Text("contains", "を含む"),
    ValueComparison.EMPTY: Text("is empty", "が空欄"),
}
_LEAST_LETTERS = 9


class FeatureFilter(QWidget):
    """Words, kind, status, occluded vertices, one attribute; and a button that selects.

    Parameters
    ----------
    language : Language

    Signals
    -------
    query_changed(query: FeatureQuery)
        Another rule was said.
    select_requested(adds: bool)
        Select what is shown; with Shift in addition to what is selected.
    """

    query_changed = Signal(object)
    select_requested = Signal(bool)

    def __init__(self, language: Language, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._language = language
        self._query = FeatureQuery()
        self._kinds: tuple[str, ...] = ()
        self._catalogue: Catalogue | None = None
        self._fields: dict[str, tuple[AttributeField, ...]] = {}
        self._words = QLineEdit(self)
        self._words.setPlaceholderText(self.tr("Search"))
        self._words.setToolTip(
            self.tr("Words in kinds, layers, attributes; the beginning of an id")
        )
        self._words.setClearButtonEnabled(True)
        self._kind = _box(self.tr("Kind of the features"))
        self._status = _short_box(self.tr("Status of the features"))
        self._occluded = QCheckBox(self.tr("Occluded"), self)
        self._occluded.setToolTip(
            self.tr("Only features that have vertices without a measured point")
        )
        self._attribute = _box(self.tr("Attribute that is compared"))
        self._comparison = _short_box(self.tr("How the attribute is compared"))
        self._value = QLineEdit(self)
        self._value.setPlaceholderText(self.tr("Value"))
        self._select = QPushButton(self.tr("Select shown"), self)
        self._select.setToolTip(self.tr("Select the features of all rows; with Shift in addition"))
        self._count = QLabel(self)
        self._name_parts()
        self._lay_out()
        self._fill()
        self._connect()

    @property
    def query(self) -> FeatureQuery:
        """The rule as it stands."""
        return self._query

    def offer(self, kinds: Iterable[str], catalogue: Catalogue) -> None:
        """Offer the kinds that are on the map and their attributes; what was chosen stays so."""
        present = set(kinds)
        known = [kind.id for kind in catalogue if kind.id in present]
        listed = (*known, *sorted(present.difference(known)))
        if listed == self._kinds and catalogue is self._catalogue:
            return
        self._kinds, self._catalogue = listed, catalogue
        with QSignalBlocker(self._kind):
            chosen = self._kind.currentData()
            self._kind.clear()
            self._kind.addItem(self.tr("All kinds"), "")
            for kind in listed:
                icon = swatch_of(colour_of_kind(catalogue, kind))
                self._kind.addItem(icon, name_of_kind(catalogue, kind, self._language), kind)
            self._kind.setCurrentIndex(max(self._kind.findData(chosen), 0))
        self._fields = {
            kind: catalogue[kind].attributes if kind in catalogue else () for kind in listed
        }
        self._offer_attributes()
        self._report()

    def show_count(self, shown: int, total: int) -> None:
        """Say how many rows there are, and of how many features."""
        locale = QLocale(self._language)
        counts = locale.toString(shown), locale.toString(total)
        self._count.setText(counts[0] if shown == total else " / ".join(counts))
        self._count.setToolTip(
            self.tr("{shown} of {total} features shown").format(shown=counts[0], total=counts[1])
        )
        self._select.setEnabled(shown > 0)

    def _name_parts(self) -> None:
        for name, part in (
            ("words", self._words),
            ("kind", self._kind),
            ("status", self._status),
            ("occluded", self._occluded),
            ("attribute", self._attribute),
            ("comparison", self._comparison),
            ("value", self._value),
            ("select", self._select),
            ("count", self._count),
        ):
            part.setObjectName(name)

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        row.setSpacing(4)
        row.addWidget(self._words, 3)
        row.addWidget(self._kind, 2)
        row.addWidget(self._status)
        row.addWidget(self._occluded)
        row.addWidget(self._attribute, 2)
        row.addWidget(self._comparison)
        row.addWidget(self._value, 1)
        row.addWidget(self._select)
        row.addWidget(self._count)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(4, 4, 4, 4)
        layout.addLayout(row)

    def _fill(self) -> None:
        self._kind.addItem(self.tr("All kinds"), "")
        self._status.addItem(self.tr("Any status"), None)
        for status, name in STATUS_NAMES.items():
            self._status.addItem(name.in_language(self._language), status.value)
        for comparison, name in _COMPARISONS.items():
            self._comparison.addItem(name.in_language(self._language), comparison.value)
        self._offer_attributes()

    def _connect(self) -> None:
        self._words.textChanged.connect(self._report)
        self._kind.currentIndexChanged.connect(self._on_kind_changed)
        self._status.currentIndexChanged.connect(self._report)
        self._occluded.toggled.connect(self._report)
        self._attribute.currentIndexChanged.connect(self._on_condition_changed)
        self._comparison.currentIndexChanged.connect(self._on_condition_changed)
        self._value.textChanged.connect(self._report)
        self._select.clicked.connect(self._on_select_clicked)

    def _offer_attributes(self) -> None:
        """The attributes of the chosen kind, or of all kinds on the map."""
        kind = str(self._kind.currentData())
        fields = [
            field for id_ in self._kinds if kind in ("", id_) for field in self._fields.get(id_, ())
        ]
        names: dict[str, list[str]] = {}
        for field in fields:
            written = names.setdefault(field.id, [])
            name = field.name.in_language(self._language)
            if name not in written:
                written.append(name)
        with QSignalBlocker(self._attribute):
            chosen = self._attribute.currentData()
            self._attribute.clear()
            self._attribute.addItem(self.tr("Any attribute"), "")
            for id_, written in names.items():
                self._attribute.addItem(" / ".join(written), id_)
            self._attribute.setCurrentIndex(max(self._attribute.findData(chosen), 0))
        self._attribute.setEnabled(bool(names))
        self._suit_value()

    def _suit_value(self) -> None:
        """A value is asked for where one is compared; of a choice, its names are offered."""
        id_ = str(self._attribute.currentData())
        needs_value = self._comparison.currentData() != ValueComparison.EMPTY.value
        self._comparison.setEnabled(bool(id_))
        self._value.setEnabled(bool(id_) and needs_value)
        names = dict.fromkeys(
            field.name_of_choice(choice).in_language(self._language)
            for fields in self._fields.values()
            for field in fields
            if field.id == id_
            for choice in field.choices
        )
        completer = QCompleter(list(names), self._value)
        completer.setCaseSensitivity(Qt.CaseSensitivity.CaseInsensitive)
        self._value.setCompleter(completer)

    def _conditions(self) -> tuple[AttributeCondition, ...]:
        id_ = str(self._attribute.currentData())
        comparison = ValueComparison(self._comparison.currentData())
        value = self._value.text().strip()
        if not id_ or (comparison is not ValueComparison.EMPTY and not value):
            return ()
        return (
            AttributeCondition(
                id_, comparison, "" if comparison is ValueComparison.EMPTY else value
            ),
        )

    def _report(self) -> None:
        kind, status = self._kind.currentData(), self._status.currentData()
        query = FeatureQuery(
            text=self._words.text().strip(),
            kinds=frozenset((kind,) if kind else ()),
            statuses=frozenset((Status(status),) if status else ()),
            has_occluded=self._occluded.isChecked(),
            conditions=self._conditions(),
        )
        if query != self._query:
            self._query = query
            self.query_changed.emit(query)

    def _on_kind_changed(self) -> None:
        self._offer_attributes()
        self._report()

    def _on_condition_changed(self) -> None:
        self._suit_value()
        self._report()

    def _on_select_clicked(self) -> None:
        shift = Qt.KeyboardModifier.ShiftModifier
        self.select_requested.emit(bool(QGuiApplication.keyboardModifiers() & shift))


def _box(tip: str) -> QComboBox:
    box = QComboBox()
    box.setToolTip(tip)
    box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    box.setMinimumContentsLength(_LEAST_LETTERS)
    box.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
    box.setMaxVisibleItems(20)
    return box


def _short_box(tip: str) -> QComboBox:
    """A list whose longest entry is short enough to be always seen whole."""
    box = QComboBox()
    box.setToolTip(tip)
    box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
    box.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
    return box

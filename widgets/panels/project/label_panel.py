"""LabelPanel: the classes that points have and can be given, and what the brush does with them."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import (
    QComboBox,
    QFormLayout,
    QHeaderView,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from processing.core.text import Language
from processing.labels.rules import PaintOver, PaintRule
from processing.recording.columns.classes import class_key, point_classes
from widgets.feature_drawing.swatch import swatch_of
from widgets.mouse_tools.painting.paint_tool import class_name
from widgets.panels.project.label_tally import LabelTally
from widgets.panels.tree_items import children_of
from widgets.parts.number_field import NumberField
from widgets.shared.label_palette import LEAST_RADIUS_M, MOST_RADIUS_M
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_CODE = Qt.ItemDataRole.UserRole
_NAME, _COUNT, _KEY = range(3)
_UNKNOWN_COLOUR = "#606060"
_LEAST_COLUMN_PX = 16
_LEAST_HIGH_PX = 40


class LabelPanel(QWidget):
    """A class is put on the brush by a click; numbers say how many points have it.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
        ``shared.labels`` is what the panel shows and changes.
    language : Language
    """

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._palette = shared.labels
        self._settings = shared.view_settings
        self._language: Language = language
        self.tally = LabelTally(source, shared.map_changes, self)
        self._list = QTreeWidget(self)
        self._list.setColumnCount(3)
        self._list.setHeaderHidden(True)
        self._list.setRootIsDecorated(False)
        self._list.setIndentation(8)
        self._list.setUniformRowHeights(True)
        self._list.setMinimumHeight(_LEAST_HIGH_PX)
        header = self._list.header()
        header.setStretchLastSection(False)
        header.setMinimumSectionSize(_LEAST_COLUMN_PX)
        header.setSectionResizeMode(_NAME, QHeaderView.ResizeMode.Stretch)
        for column in (_COUNT, _KEY):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        self._over = QComboBox(self)
        self._radius = NumberField(LEAST_RADIUS_M, MOST_RADIUS_M, unit="m", decimals=2, parent=self)
        self._show_labels = QPushButton(self.tr("Show the labels"), self)
        self._lay_out()
        self._fill_over()
        self._show_classes()
        self._show_radius()
        self._list.itemClicked.connect(self._on_list_item_clicked)
        self._list.itemActivated.connect(self._on_list_item_clicked)
        self._over.activated.connect(self._on_over_activated)
        self._radius.valueChanged.connect(self._palette.set_radius)
        self._show_labels.clicked.connect(self._on_show_labels_clicked)
        self._palette.rule_changed.connect(self._on_palette_rule_changed)
        self._palette.radius_changed.connect(self._show_radius)
        self._settings.look_changed.connect(self._on_settings_look_changed)
        self.tally.changed.connect(self._show_classes)
        self._on_settings_look_changed()

    def _lay_out(self) -> None:
        form = QFormLayout()
        form.setContentsMargins(0, 0, 0, 0)
        form.setSpacing(4)
        form.addRow(self.tr("Brush radius"), self._radius)
        form.addRow(self.tr("Paint over"), self._over)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 8)
        layout.setSpacing(4)
        layout.addWidget(self._list, 1)
        layout.addLayout(form)
        layout.addWidget(self._show_labels)
        self._radius.setToolTip(self.tr("In space; the keys [ and ] change it too."))
        self._over.setToolTip(self.tr("Other points stay as they are, whatever is dragged over."))

    def _fill_over(self) -> None:
        """What may be painted over: everything, nothing labelled, or one class only."""
        self._over.addItem(self.tr("All points"), (PaintOver.EVERYTHING, 0))
        self._over.addItem(self.tr("Points without a label"), (PaintOver.UNLABELLED, 0))
        self._over.insertSeparator(2)
        for one in point_classes():
            if one.code:
                words = self.tr("Only {name}").format(name=one.name.in_language(self._language))
                rule = (PaintOver.ONE_CLASS, one.code)
                self._over.addItem(swatch_of(one.colour), words, rule)
        self._over.setMinimumContentsLength(8)
        self._over.setSizeAdjustPolicy(
            QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        )

    def _show_classes(self) -> None:
        counts, labelled = self.tally.by_class, self.tally.by_code
        known = {one.code: one.colour for one in point_classes()}
        # What another table's classes are called is not known, but they are there.
        codes = sorted({*known, *counts.nonzero()[0].tolist()} - {0})
        with QSignalBlocker(self._list):
            self._list.clear()
            self._add(0, "", self.tr("No label (erase)"), (0, 0))
            for code in codes:
                name = class_name(code).in_language(self._language)
                both = int(counts[code]), int(labelled[code])
                self._add(code, known.get(code, _UNKNOWN_COLOUR), name, both)
        self._mark()

    def _add(self, code: int, colour: str, name: str, counts: tuple[int, int]) -> None:
        """A class with the number of its points, and of those that have it by a label."""
        count, labelled = counts
        key = class_key(code)
        item = QTreeWidgetItem(self._list, [name, f"{count:,}" if count else "", key])
        item.setData(_NAME, _CODE, code)
        item.setIcon(_NAME, swatch_of(colour or "#00000000"))
        item.setTextAlignment(_COUNT, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        item.setTextAlignment(_KEY, Qt.AlignmentFlag.AlignCenter)
        item.setForeground(_KEY, self.palette().placeholderText())
        if code:
            other = class_name(code).in_language("en" if self._language == "ja" else "ja")
            item.setToolTip(_NAME, f"{name}\n{other}\n{code}")
        if count:
            words = self.tr("Points of this class: {labelled} by labels, {delivered} as delivered")
            item.setToolTip(
                _COUNT, words.format(labelled=f"{labelled:,}", delivered=f"{count - labelled:,}")
            )
        if key:
            item.setToolTip(_KEY, self.tr("Key that takes this class, with a paint tool in hand"))

    def _mark(self) -> None:
        with QSignalBlocker(self._list):
            for item in children_of(self._list):
                is_chosen = item.data(_NAME, _CODE) == self._palette.rule.code
                font = item.font(_NAME)
                font.setBold(is_chosen)
                item.setFont(_NAME, font)
                if is_chosen:
                    self._list.setCurrentItem(item)

    @override
    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.tally.go_on()

    @override
    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self.tally.rest()

    def _show_radius(self) -> None:
        with QSignalBlocker(self._radius):
            self._radius.setValue(self._palette.radius_m)

    def _on_list_item_clicked(self, item: QTreeWidgetItem) -> None:
        self._palette.choose(int(item.data(_NAME, _CODE)))

    def _on_over_activated(self, row: int) -> None:
        over, only = self._over.itemData(row)
        self._palette.paint_over(PaintOver(over), only)

    def _on_palette_rule_changed(self, rule: PaintRule) -> None:
        self._mark()
        for row in range(self._over.count()):
            if self._over.itemData(row) == (rule.over, rule.only):
                self._over.setCurrentIndex(row)

    def _on_show_labels_clicked(self) -> None:
        self._settings.change_look(attribute="label")

    def _on_settings_look_changed(self) -> None:
        self._show_labels.setEnabled(self._settings.look.attribute != "label")

"""CandidateCard: what is known of the candidate that is judged, readable at a glance."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPalette
from PySide6.QtWidgets import (
    QFormLayout,
    QFrame,
    QHBoxLayout,
    QLabel,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from processing.core.text import Language
from processing.map.catalogue import Catalogue
from processing.map.feature import AttributeValue, Feature
from processing.map.measured_fields import field_of
from processing.project.photos import FIELD as PHOTO
from widgets.feature_drawing.feature_style import colour_of_kind
from widgets.feature_drawing.swatch import SWATCH_PX, swatch_of
from widgets.panels.attributes.photo_row import PhotoRow
from widgets.panels.feature_words import (
    name_of_kind,
    name_of_origin,
    name_of_status,
    words_of_value,
)
from widgets.panels.geometry_facts import facts_of
from widgets.parts.elided_label import ElidedLabel

_MOST_ROWS = 20

_PHOTO_PX = 120
"""Of a picture's longer side: on a screen of 768 rows the first facts are seen below it."""

_WIDEST_TITLE_PX = 124
"""Longer names are written in two lines, so that the value beside them, a coordinate of seven
digits, is seen whole in a narrow panel."""


def _without_photo(feature: Feature) -> dict[str, AttributeValue]:
    """The attributes but for the name of the picture's file, which says nothing beside it."""
    return {id_: value for id_, value in feature.attributes.items() if id_ != PHOTO}


class ConfidenceBar(QWidget):
    """A number from 0 to 1 as a bar with its digits beside it."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._value = 0.0
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    @property
    def value(self) -> float:
        """What it shows."""
        return self._value

    def show_value(self, value: float) -> None:
        """Show a confidence."""
        self._value = min(max(value, 0.0), 1.0)
        self.setToolTip(self.tr("Confidence: how sure the tool is of it, 0 to 1"))
        self.update()

    @override
    def sizeHint(self) -> QSize:
        return QSize(120, self.fontMetrics().height())

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        digits = f"{self._value:.2f}"
        room = self.fontMetrics().horizontalAdvance("0.00") + 8
        with QPainter(self) as painter:
            bar = QRectF(0, (self.height() - 8) / 2, max(self.width() - room, 8), 8)
            painter.fillRect(bar, self.palette().color(QPalette.ColorRole.Midlight))
            bar.setWidth(bar.width() * self._value)
            painter.fillRect(bar, self.palette().color(QPalette.ColorRole.Highlight))
            painter.setPen(self.palette().color(QPalette.ColorRole.WindowText))
            flags = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
            painter.drawText(self.rect(), int(flags), digits)


class CandidateCard(QFrame):
    """Kind, place in the queue, confidence, size, attributes and origin of one feature."""

    def __init__(self, language: Language, parent: QWidget) -> None:
        super().__init__(parent)
        self._language = language
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self._swatch = QLabel(self)
        self._kind = ElidedLabel(self)
        font = self._kind.font()
        font.setBold(True)
        self._kind.setFont(font)
        self._position = QLabel(self)
        self._status = QLabel(self)
        self._status.hide()
        self.confidence = ConfidenceBar(self)
        self._photo = PhotoRow(self, side_px=_PHOTO_PX)
        self._photo.hide()
        top = QHBoxLayout()
        top.setSpacing(8)
        top.addWidget(self._swatch)
        top.addWidget(self._kind, 1)
        top.addWidget(self._position)
        self._rows = QFormLayout()
        self._rows.setContentsMargins(0, 0, 0, 0)
        self._rows.setHorizontalSpacing(8)
        self._rows.setVerticalSpacing(2)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 8)
        layout.setSpacing(4)
        layout.addLayout(top)
        layout.addWidget(self._status)
        layout.addWidget(self.confidence)
        layout.addWidget(self._photo)
        layout.addLayout(self._rows)

    def lines(self) -> tuple[str, ...]:
        """All that is written, from top to bottom."""
        rows = (
            f"{self._text(row, QFormLayout.ItemRole.LabelRole)}: "
            f"{self._text(row, QFormLayout.ItemRole.FieldRole)}"
            for row in range(self._rows.rowCount())
        )
        status = () if self._status.isHidden() else (self._status.text(),)
        return (self._kind.text(), self._position.text(), *status, *rows)

    def show_feature(
        self,
        feature: Feature,
        catalogue: Catalogue,
        position: int,
        total: int,
        *,
        photo: Path | None = None,
    ) -> None:
        """Show a feature, which has this place among all, and the file of its picture."""
        colour = colour_of_kind(catalogue, feature.kind)
        self._swatch.setPixmap(swatch_of(colour).pixmap(SWATCH_PX, SWATCH_PX))
        self._kind.setText(name_of_kind(catalogue, feature.kind, self._language))
        self._position.setText(f"{position:,} / {total:,}")
        self._show_status(feature)
        self.confidence.show_value(feature.provenance.confidence)
        is_seen = self._photo.show_photo(photo)
        self._photo.setVisible(is_seen)
        while self._rows.rowCount():
            self._rows.removeRow(0)
        told = replace(feature, attributes=_without_photo(feature)) if is_seen else feature
        for name, words in self._facts(told, catalogue)[:_MOST_ROWS]:
            self._add_row(name, words)

    def _show_status(self, feature: Feature) -> None:
        is_decided = feature.status.value != "candidate"
        self._status.setVisible(is_decided)
        if is_decided:
            status = name_of_status(feature, self._language)
            self._status.setText(self.tr("Decided: {status}").format(status=status))

    def _facts(self, feature: Feature, catalogue: Catalogue) -> list[tuple[str, str]]:
        facts = []
        for id_, value in feature.attributes.items():
            field = field_of(catalogue, feature.kind, id_)
            words = words_of_value(value, field, self._language)
            if words:
                name = id_ if field is None else field.name.in_language(self._language)
                unit = "" if field is None else field.unit
                facts.append((name, f"{words} {unit}".rstrip()))
        for title, words in facts_of(feature, self._language):
            facts.append((title.in_language(self._language), words))
        facts.append((self.tr("Found by"), name_of_origin(feature, self._language)))
        return facts

    def _add_row(self, name: str, words: str) -> None:
        title = QLabel(name, self)
        title.setForegroundRole(QPalette.ColorRole.PlaceholderText)
        title.setWordWrap(True)
        width = title.fontMetrics().horizontalAdvance(name) + 2
        title.setFixedWidth(min(width, _WIDEST_TITLE_PX))
        value = ElidedLabel(self)
        value.setText(words)
        self._rows.addRow(title, value)

    def _text(self, row: int, role: QFormLayout.ItemRole) -> str:
        item = self._rows.itemAt(row, role)
        widget = None if item is None else item.widget()
        return widget.text() if isinstance(widget, QLabel) else ""

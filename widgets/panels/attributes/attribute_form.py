"""AttributeForm: the fields of the chosen features, made once for those that have the same."""

from __future__ import annotations

from collections import Counter

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QComboBox, QFormLayout, QLabel, QSizePolicy, QWidget

from processing.core.text import Language
from processing.map.catalogue import AttributeField, Catalogue
from processing.map.feature import AttributeValue, Feature, Status
from processing.map.measured_fields import field_of
from processing.map.sign_numbers import FIELD as NUMBER_FIELD
from widgets.feature_drawing.swatch import swatch_of
from widgets.panels.attributes.attribute_field import (
    AttributeEditor,
    MixedValue,
    QuietBox,
    ShownValue,
)
from widgets.panels.attributes.occluded_row import OccludedRow
from widgets.panels.attributes.photo_row import PhotoRow
from widgets.panels.attributes.shared_values import common_fields, common_value
from widgets.panels.attributes.sign_numbers import SignNumberMenu
from widgets.panels.attributes.sign_plates import plate_picture
from widgets.panels.attributes.sign_points import picture_of_sign
from widgets.panels.feature_changes import kinds_for
from widgets.panels.feature_words import STATUS_NAMES, name_of_kind, words_of_value
from widgets.panels.geometry_facts import facts_of
from widgets.shared.cursor import Cursor
from widgets.shared.map_source import MapSource

_MOST_KINDS_LISTED = 5
_WIDEST_LABEL_PX = 96


class AttributeForm(QWidget):
    """Kind, status, common attributes and vertices of features; of one also what else is known.

    Parameters
    ----------
    features : tuple of Feature
        At least one.
    source : MapSource
    language : Language
    cursor : Cursor
        Moved to vertices without a measured point.

    Signals
    -------
    attribute_edited(id: str, value: AttributeValue)
    status_chosen(status: Status)
    kind_chosen(id: str)
        The user wants this for all of the features.
    """

    attribute_edited = Signal(str, object)
    status_chosen = Signal(object)
    kind_chosen = Signal(str)

    def __init__(
        self,
        features: tuple[Feature, ...],
        source: MapSource,
        language: Language,
        cursor: Cursor,
    ) -> None:
        super().__init__()
        self._features = features
        self._source = source
        self._catalogue = catalogue = source.catalogue()
        self._language = language
        self._fields = common_fields(features, catalogue)
        self._editors: dict[str, AttributeEditor] = {}
        self._fact_labels: list[QLabel] = []
        self._confidence = QLabel()
        self._form = QFormLayout(self)
        self._form.setContentsMargins(8, 8, 8, 8)
        self._form.setVerticalSpacing(4)
        self._form.setHorizontalSpacing(8)
        self._form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.DontWrapRows)
        self._form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        if len(features) > 1:
            self._add_count()
        self._kind = self._add_kind()
        self._status = self._add_status()
        self._fill_boxes()
        self._add_row(self.tr("Confidence"), self._confidence)
        self._photo = PhotoRow(self)
        self._form.addRow(self._photo)
        self._add_fields()
        if len(features) == 1:
            self._add_facts(features[0])
        self._occluded = OccludedRow(cursor, self)
        self._form.addRow(self._occluded)
        self.show_values()

    @property
    def features(self) -> tuple[Feature, ...]:
        """The features as they are shown."""
        return self._features

    def lines(self) -> tuple[str, ...]:
        """All that is written but in lines for typing, from top to bottom."""
        shown = self.findChildren(QWidget)
        return tuple(
            one.text() if isinstance(one, QLabel) else one.currentText()
            for one in shown
            if isinstance(one, QLabel | QComboBox) and one.isVisibleTo(self)
        )

    def take_over(self, features: tuple[Feature, ...], catalogue: Catalogue) -> bool:
        """Show others in place; says whether it could.

        Who types keeps the field, and the next candidate of a review, which mostly has the same
        fields, is shown without a new form.
        """
        if catalogue is not self._catalogue:
            return False
        if self._frame_of(features) != self._frame_of(self._features):
            return False
        self._features = features
        self.show_values()
        return True

    def finish(self) -> None:
        """Tell of what is typed but not yet confirmed."""
        for editor in tuple(self._editors.values()):
            editor.finish()

    def _frame_of(self, features: tuple[Feature, ...]) -> tuple[object, ...]:
        """All that is shown of features but for values of fields and facts."""
        kinds = Counter((feature.kind, feature.geometry) for feature in features)
        if len(features) != 1:
            return (kinds,)
        (one,) = features
        return kinds, len(one.vertices) == 0, bool(one.own_points), self._others(one)

    def _others(self, feature: Feature) -> dict[str, AttributeValue]:
        known = {field.id for field in self._fields}
        return {id_: value for id_, value in feature.attributes.items() if id_ not in known}

    def _add_count(self) -> None:
        label = QLabel(self.tr("%n feature(s)", "", len(self._features)))
        font = label.font()
        font.setBold(True)
        label.setFont(font)
        self._form.addRow(label)
        kinds = Counter(feature.kind for feature in self._features)
        if len(kinds) > 1:
            names = [
                f"{name_of_kind(self._catalogue, kind, self._language)}: {count:,}"
                for kind, count in kinds.most_common(_MOST_KINDS_LISTED)
            ]
            listed = "\n".join((*names, "…") if len(kinds) > len(names) else names)
            self._form.addRow(_wrap_words(listed))

    def _add_kind(self) -> QuietBox:
        """Over the whole width, as a heading: names of kinds are long."""
        box = QuietBox(self)
        box.setObjectName("kind")
        box.setToolTip(self.tr("Kind"))
        box.setAccessibleName(self.tr("Kind"))
        self._form.addRow(box)
        return box

    def _add_status(self) -> QuietBox:
        box = QuietBox(self)
        box.setObjectName("status")
        self._add_row(self.tr("Status"), box)
        return box

    def _add_row(self, title: str, widget: QWidget) -> None:
        label = QLabel(title)
        label.setWordWrap(True)
        width = label.fontMetrics().horizontalAdvance(title) + 2
        label.setFixedWidth(min(width, _WIDEST_LABEL_PX))
        label.setBuddy(widget)
        self._form.addRow(label, widget)

    def _fill_boxes(self) -> None:
        self._kind.setPlaceholderText(self.tr("(several kinds)"))
        for kind in kinds_for(self._features, self._catalogue):
            name = kind.name.in_language(self._language)
            self._kind.addItem(swatch_of(kind.colour), name, kind.id)
        self._kind.setEnabled(self._kind.count() > 0)
        self._kind.activated.connect(self._on_kind_activated)
        self._status.setPlaceholderText(self.tr("(several values)"))
        for status, words in STATUS_NAMES.items():
            self._status.addItem(words.in_language(self._language), status.value)
        self._status.activated.connect(self._on_status_activated)

    def _add_fields(self) -> None:
        for field in self._fields:
            value = self._value_of(field.id)
            editor = AttributeEditor(field, value, self._language)
            editor.edited.connect(self.attribute_edited)
            if field.id == NUMBER_FIELD:
                self._offer_numbers(editor)
            self._add_row(self._title_of(field, field.id), editor.widget)
            self._editors[field.id] = editor
        if len(self._features) == 1:
            # Attributes that the kind doesn't list: shown, and not to be changed.
            for id_, value in self._others(self._features[0]).items():
                known = field_of(self._catalogue, self._features[0].kind, id_)
                words = words_of_value(value, known, self._language)
                self._add_row(self._title_of(known, id_), _wrap_words(words))

    def _title_of(self, field: AttributeField | None, id_: str) -> str:
        if field is None:
            return id_
        name = field.name.in_language(self._language)
        return f"{name} ({field.unit})" if field.unit else name

    def _offer_numbers(self, editor: AttributeEditor) -> None:
        """Legal numbers of signs are chosen among the plates of that shape, with their pictures."""

        def ask() -> None:
            photo = picture_of_sign(self._features, self._source)
            menu = SignNumberMenu(self._features, self._language, editor.widget, photo=photo)
            menu.number_chosen.connect(editor.take)
            menu.aboutToHide.connect(menu.deleteLater)
            # Beside the field: below it a long list would cover the picture of the sign.
            menu.popup(editor.widget.mapToGlobal(editor.widget.rect().topRight()))

        words = self.tr("Choose the sign's number by the shape of its plate (Alt+Down)")
        editor.offer(words, plate_picture("diamond", "yellow"), ask)

    def _add_facts(self, feature: Feature) -> None:
        for title, words in facts_of(feature, self._language):
            label = QLabel(words)
            self._fact_labels.append(label)
            self._add_row(title.in_language(self._language), label)

    def show_values(self) -> None:
        """Show what is stored, in place of what was typed or chosen."""
        features = self._features
        for id_, editor in self._editors.items():
            editor.show_value(self._value_of(id_))
        self._choose_kind()
        status = common_value(features, lambda one: one.status)
        self._status.setCurrentIndex(
            self._status.findData(status.value) if isinstance(status, Status) else -1
        )
        is_candidate = len(features) == 1 and features[0].status is Status.CANDIDATE
        self._form.setRowVisible(self._confidence, is_candidate)
        self._confidence.setText(
            f"{features[0].provenance.confidence * 100:.0f} %" if is_candidate else ""
        )
        if len(features) == 1:
            facts = facts_of(features[0], self._language)
            for label, (_, words) in zip(self._fact_labels, facts, strict=True):
                label.setText(words)
        photo = self._source.photo(features[0]) if len(features) == 1 else None
        self._form.setRowVisible(self._photo, self._photo.show_photo(photo))
        self._occluded.show_features(features)
        self._form.setRowVisible(self._occluded, self._occluded.count > 0)

    def _value_of(self, id_: str) -> ShownValue:
        return common_value(self._features, lambda one: one.attributes.get(id_))

    def _choose_kind(self) -> None:
        kind = common_value(self._features, lambda one: one.kind)
        if kind is None or isinstance(kind, MixedValue):
            self._kind.setCurrentIndex(-1)
            return
        if self._kind.findData(kind) < 0:
            # A kind that the catalogue doesn't know: shown by its id.
            self._kind.addItem(kind, kind)
        self._kind.setCurrentIndex(self._kind.findData(kind))

    def _on_kind_activated(self) -> None:
        self.kind_chosen.emit(str(self._kind.currentData()))

    def _on_status_activated(self) -> None:
        self.status_chosen.emit(Status(self._status.currentData()))


def _wrap_words(words: str) -> QLabel:
    label = QLabel(words)
    label.setWordWrap(True)
    label.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
    return label

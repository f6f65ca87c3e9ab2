"""AttributePanel: what the chosen features say about themselves."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QFormLayout,
    QFrame,
    QLabel,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from processing.project.change import Change, Replacement
from processing.project.feature import AttributeValue, Feature, Status
from processing.text import Language, Text
from widgets.panels.attribute_field import AttributeEditor
from widgets.panels.geometry_facts import facts_of
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_STATUS = {
    Status.CANDIDATE: Text("Candidate", "候補"),
    Status.ACCEPTED: Text("Accepted", "承認済み"),
    Status.REJECTED: Text("Rejected", "却下"),
}
_EDIT = Text("Change {name}", "「{name}」の変更")


class AttributePanel(QWidget):
    """A form for one chosen feature; for several, what they have in common.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language

    Signals
    -------
    change_requested(label: Text, change: Change)
        An attribute was edited.
    """

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
        self._selection = shared.selection
        self._language = language
        self._shown: tuple[Feature, ...] | None = None
        self._editors: dict[str, AttributeEditor] = {}
        self._fact_labels: list[QLabel] = []
        self._page = QWidget()
        self._scroll = QScrollArea(self)
        self._scroll.setWidgetResizable(True)
        self._scroll.setFrameShape(QFrame.Shape.NoFrame)
        self._scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._scroll)
        shared.selection.features_changed.connect(self._show)
        shared.map_changes.features_changed.connect(self._on_map_features_changed)
        shared.map_changes.drives_changed.connect(self._show)
        self._show()

    def field(self, id_: str) -> QWidget | None:
        """The widget in which an attribute is typed; None when there is none."""
        return self._page.findChild(QWidget, id_)

    def lines(self) -> tuple[str, ...]:
        """All that is written, from top to bottom."""
        labels = self._page.findChildren(QLabel)
        return tuple(label.text() for label in labels)

    def _show(self) -> None:
        chosen = [self._source.feature(id_) for id_ in sorted(self._selection.features)]
        features = tuple(feature for feature in chosen if feature is not None)
        before, self._shown = self._shown, features
        if features == before or self._update(before, features):
            return
        self._editors.clear()
        self._fact_labels.clear()
        page = QWidget()
        form = QFormLayout(page)
        form.setContentsMargins(8, 8, 8, 8)
        form.setVerticalSpacing(4)
        form.setHorizontalSpacing(8)
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        if not features:
            self._add_empty(form)
        elif len(features) == 1:
            self._add_one(form, features[0])
        else:
            self._add_several(form, features)
        # The old form may be in the middle of telling of an edit, so it goes a little later.
        old = self._scroll.takeWidget()
        if old is not None:
            old.deleteLater()
        self._page = page
        self._scroll.setWidget(page)

    def _update(self, before: tuple[Feature, ...] | None, features: tuple[Feature, ...]) -> bool:
        """Take over new values in place, so that who types keeps the field; says whether it did."""
        if before is None or len(before) != 1 or len(features) != 1:
            return False
        (feature,) = features
        if self._frame_of(before[0]) != self._frame_of(feature):
            return False
        for id_, editor in self._editors.items():
            editor.show_value(feature.attributes.get(id_))
        for label, (_, words) in zip(self._fact_labels, facts_of(feature), strict=True):
            label.setText(words)
        return True

    def _frame_of(self, feature: Feature) -> tuple[object, ...]:
        """All that is shown of a feature but for values of fields and facts."""
        others = {id_: v for id_, v in feature.attributes.items() if id_ not in self._editors}
        confidence = feature.provenance.confidence
        return (feature.id, feature.kind, feature.geometry, feature.status, confidence, others)

    def _add_empty(self, form: QFormLayout) -> None:
        words = QLabel(self.tr("Choose a feature to see what is known about it."))
        words.setWordWrap(True)
        words.setEnabled(False)
        form.addRow(words)

    def _add_one(self, form: QFormLayout, feature: Feature) -> None:
        kinds = {kind.id: kind for kind in self._source.catalogue().kinds}
        kind = kinds.get(feature.kind)
        name = feature.kind if kind is None else kind.name.spoken(self._language)
        form.addRow(self._bold(name))
        form.addRow(self.tr("Status"), QLabel(_STATUS[feature.status].spoken(self._language)))
        if feature.status is Status.CANDIDATE:
            confidence = f"{feature.provenance.confidence * 100:.0f} %"
            form.addRow(self.tr("Confidence"), QLabel(confidence))
        for field in kind.attributes if kind is not None else ():
            editor = AttributeEditor(field, feature.attributes.get(field.id), self._language)
            editor.edited.connect(self._on_editor_edited)
            form.addRow(field.name.spoken(self._language), editor.widget)
            self._editors[field.id] = editor
        self._add_others(form, feature, {f.id for f in kind.attributes} if kind else set())
        for title, words in facts_of(feature):
            label = QLabel(words)
            self._fact_labels.append(label)
            form.addRow(title.spoken(self._language), label)

    def _add_others(self, form: QFormLayout, feature: Feature, known: set[str]) -> None:
        """Attributes that the catalogue doesn't know: shown as they are."""
        for id_, value in feature.attributes.items():
            if id_ not in known:
                form.addRow(id_, QLabel("" if value is None else str(value)))

    def _add_several(self, form: QFormLayout, features: tuple[Feature, ...]) -> None:
        form.addRow(self._bold(self.tr("%n feature(s)", "", len(features))))
        catalogue = self._source.catalogue()
        kinds = {feature.kind for feature in features}
        names = sorted(
            catalogue[kind].name.spoken(self._language) if kind in catalogue else kind
            for kind in kinds
        )
        words = QLabel("\n".join(names))
        words.setWordWrap(True)
        form.addRow(self.tr("Kind"), words)

    def _bold(self, text: str) -> QLabel:
        label = QLabel(text)
        label.setWordWrap(True)
        font = label.font()
        font.setBold(True)
        label.setFont(font)
        return label

    def _on_editor_edited(self, id_: str, value: AttributeValue) -> None:
        feature = self._source.feature(self._shown[0].id) if self._shown else None
        if feature is None or feature.attributes.get(id_) == value:
            return
        attributes = {**feature.attributes, id_: value}
        if value is None:
            del attributes[id_]
        field = self._source.catalogue()[feature.kind].attribute(id_)
        name = Text.same(id_) if field is None else field.name
        change = Change(replaced=(Replacement(feature, replace(feature, attributes=attributes)),))
        self.change_requested.emit(_EDIT.filled(name=name), change)

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        if self._selection.features.intersection(ids):
            self._show()

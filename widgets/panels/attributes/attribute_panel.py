"""AttributePanel: what the chosen features say about themselves, changed for all at once."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QFrame, QLabel, QScrollArea, QVBoxLayout, QWidget
from typing_extensions import override

from processing.core.text import Language, Text
from processing.map.change import Change
from processing.map.feature import AttributeValue, Feature, Status
from widgets.panels.attributes.attribute_form import AttributeForm
from widgets.panels.attributes.sign_numbers import implied_kind, implied_values
from widgets.panels.feature_changes import attribute_change, kind_change, status_change
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState


class AttributePanel(QWidget):
    """A form for the chosen features: what all have in common can be changed for all.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language

    Signals
    -------
    change_requested(label: Text, change: Change)
        An attribute, the status or the kind was edited: one step for all chosen features.
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
        self._cursor = shared.cursor
        self._language = language
        self._form: AttributeForm | None = None
        self._is_stale = False
        self._scroll = QScrollArea(self)
        self._scroll.setWidgetResizable(True)
        self._scroll.setFrameShape(QFrame.Shape.NoFrame)
        self._scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._scroll)
        shared.selection.features_changed.connect(self._on_selection_features_changed)
        shared.map_changes.features_changed.connect(self._on_map_features_changed)
        shared.map_changes.drives_changed.connect(self._on_map_drives_changed)
        self._show(())

    @override
    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if self._is_stale:
            self._show_chosen()

    def field(self, id_: str) -> QWidget | None:
        """The widget of an attribute, of ``kind`` or ``status``; None when there is none."""
        return None if self._form is None else self._form.findChild(QWidget, id_)

    def lines(self) -> tuple[str, ...]:
        """All that is written, from top to bottom."""
        if self._form is not None:
            return self._form.lines()
        empty = self._scroll.widget()
        return (empty.text(),) if isinstance(empty, QLabel) else ()

    def _selected_features(self) -> tuple[Feature, ...]:
        return self._find_features(sorted(self._selection.features))

    def _find_features(self, ids: Iterable[str]) -> tuple[Feature, ...]:
        """The features of these ids that are still there."""
        features = map(self._source.feature, ids)
        return tuple(feature for feature in features if feature is not None)

    def _show(self, features: tuple[Feature, ...]) -> None:
        form, catalogue = self._form, self._source.catalogue()
        if form is not None and form.features == features:
            return
        if form is not None and features and form.take_over(features, catalogue):
            return
        focus = self._scroll.focusWidget()
        name = "" if focus is None else focus.objectName()
        self._form = self._new_form(features) if features else None
        # The old form may be in the middle of telling of an edit, so it goes a little later.
        old = self._scroll.takeWidget()
        if old is not None:
            old.deleteLater()
        self._scroll.setWidget(self._form or self._empty_page())
        field = self.field(name) if name else None
        if field is not None and focus is not None and focus.hasFocus():
            field.setFocus()

    def _new_form(self, features: tuple[Feature, ...]) -> AttributeForm:
        form = AttributeForm(features, self._source, self._language, self._cursor)
        form.attribute_edited.connect(self._on_form_attribute_edited)
        form.status_chosen.connect(self._on_form_status_chosen)
        form.kind_chosen.connect(self._on_form_kind_chosen)
        return form

    def _empty_page(self) -> QLabel:
        words = QLabel(self.tr("Choose a feature to see what is known about it."))
        words.setWordWrap(True)
        words.setEnabled(False)
        words.setContentsMargins(8, 8, 8, 8)
        words.setAlignment(Qt.AlignmentFlag.AlignTop)
        return words

    def _show_chosen(self) -> None:
        """Show what is chosen; behind another panel not before it can be seen."""
        self._is_stale = not self.isVisible()
        self._show(() if self._is_stale else self._selected_features())

    def _shown_now(self) -> tuple[Feature, ...]:
        """The features that the form is for, as they are now."""
        return (
            () if self._form is None else self._find_features(one.id for one in self._form.features)
        )

    def _ask_for(self, label: Text, change: Change) -> None:
        if not change.is_empty:
            self.change_requested.emit(label, change)
        if self._form is not None:
            # The change may have been refused.
            self._form.show_values()

    def _on_form_attribute_edited(self, id_: str, value: AttributeValue) -> None:
        features = self._shown_now()
        if not features:
            return
        catalogue, kind = self._source.catalogue(), features[0].kind
        field = catalogue[kind].attribute(id_) if kind in catalogue else None
        name = Text.same(id_) if field is None else field.name
        label, change = attribute_change(
            features,
            id_,
            name,
            value,
            implied=implied_values(features, catalogue, id_, value),
            implied_kind=implied_kind(features, catalogue, id_, value),
        )
        self._ask_for(label, change)

    def _on_form_status_chosen(self, status: Status) -> None:
        self._ask_for(*status_change(self._shown_now(), status))

    def _on_form_kind_chosen(self, kind: str) -> None:
        catalogue = self._source.catalogue()
        if kind in catalogue:
            self._ask_for(*kind_change(self._shown_now(), catalogue[kind]))

    def _on_selection_features_changed(self) -> None:
        # What was typed is meant for those that were chosen until now.
        if self._form is not None:
            self._form.finish()
        self._show_chosen()

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        if self._selection.features.intersection(ids):
            self._show_chosen()

    def _on_map_drives_changed(self) -> None:
        self._show_chosen()

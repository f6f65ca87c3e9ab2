"""FeatureMenu: what can be done with the features of the chosen rows."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QMenu, QWidget

from processing.core.text import Language
from processing.map.catalogue import Catalogue
from processing.map.feature import Feature, Status
from widgets.feature_drawing.swatch import swatch_of
from widgets.mouse_tools.removal import removal_of
from widgets.panels.feature_changes import kind_change, kinds_for, status_change
from widgets.parts.literal_text import literal


class FeatureMenu(QMenu):
    """The context menu of rows.

    Parameters
    ----------
    features : tuple of Feature
        Those of the chosen rows; at least one.
    catalogue : Catalogue
    language : Language

    Signals
    -------
    change_requested(label: Text, change: Change)
    centre_requested
        Go to the current row's feature.
    kinds_requested(ids: frozenset[str])
        Choose all features of these kinds.
    """

    change_requested = Signal(object, object)
    centre_requested = Signal()
    kinds_requested = Signal(object)

    def __init__(
        self,
        features: tuple[Feature, ...],
        catalogue: Catalogue,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._features = features
        self._catalogue = catalogue
        self._language = language
        there = self.addAction(_with_key(self.tr("Go there"), Qt.Key.Key_Return))
        there.triggered.connect(self.centre_requested)
        self.addAction(self.tr("Select all of this kind"), self._on_all_of_kind)
        self.addSeparator()
        for words, status in (
            (self.tr("Accept"), Status.ACCEPTED),
            (self.tr("Reject"), Status.REJECTED),
            (self.tr("Make a candidate"), Status.CANDIDATE),
        ):
            action = self.addAction(words, partial(self._on_status, status))
            action.setEnabled(any(one.status is not status for one in features))
        self.addSeparator()
        self._add_kinds()
        self.addSeparator()
        delete = self.addAction(_with_key(self.tr("Delete"), Qt.Key.Key_Delete))
        delete.triggered.connect(self._on_delete)

    def _add_kinds(self) -> None:
        kinds = kinds_for(self._features, self._catalogue)
        menu = self.addMenu(self.tr("Change kind to"))
        menu.setEnabled(bool(kinds))
        menu.setStyleSheet("QMenu { menu-scrollable: 1; }")
        now = {feature.kind for feature in self._features}
        for kind in kinds:
            name = kind.name.in_language(self._language)
            action = menu.addAction(swatch_of(kind.colour), literal(name))
            action.setData(kind.id)
            action.setEnabled(now != {kind.id})
            action.triggered.connect(partial(self._on_kind, kind.id))

    def _on_all_of_kind(self) -> None:
        self.kinds_requested.emit(frozenset(feature.kind for feature in self._features))

    def _on_status(self, status: Status) -> None:
        self.change_requested.emit(*status_change(self._features, status))

    def _on_kind(self, kind: str) -> None:
        self.change_requested.emit(*kind_change(self._features, self._catalogue[kind]))

    def _on_delete(self) -> None:
        self.change_requested.emit(*removal_of(self._features))


def _with_key(words: str, key: Qt.Key) -> str:
    """The key is shown, not bound: it is the table that listens to it."""
    return f"{words}\t{QKeySequence(key).toString(QKeySequence.SequenceFormat.NativeText)}"

"""TruthBar: the truths of a project, how one is made, and how one is removed."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QLabel,
    QMenu,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QWidget,
)

from processing.core.text import Language
from processing.project.evaluation.truth_making import CheckedPoints
from processing.project.evaluation.truth_store import Truth
from widgets.panels.class_evaluation.setting_words import name_of_truth


class TruthBar(QWidget):
    """One line: which truth judges, and what can be done with truths.

    Parameters
    ----------
    language : Language

    Signals
    -------
    truth_chosen(truth: str)
        Its id; empty when there is none.
    making_requested(checked: Checked)
        The classes as they stand now are to be a truth.
    loading_requested, removal_requested(truth: str)
        One is to be taken from a file; one is to be forgotten.
    """

    truth_chosen = Signal(str)
    making_requested = Signal(object)
    loading_requested = Signal()
    removal_requested = Signal(str)

    def __init__(self, language: Language, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._language: Language = language
        self._truths: tuple[Truth, ...] = ()
        self._choice = QComboBox(self)
        self._choice.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._choice.setMinimumContentsLength(12)
        self._choice.setToolTip(self.tr("What points really are, as somebody said"))
        self._points = QLabel(self)
        self._points.setEnabled(False)
        self._make = QPushButton(self.tr("New truth"), self)
        self._make.setMenu(self._new_menu())
        self._remove = QToolButton(self)
        self._remove.setText("✕")
        self._remove.setToolTip(self.tr("Forget this truth"))
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(8)
        layout.addWidget(QLabel(self.tr("Truth"), self))
        layout.addWidget(self._choice, 1)
        layout.addWidget(self._points)
        layout.addWidget(self._make)
        layout.addWidget(self._remove)
        self._choice.activated.connect(self._on_choice_activated)
        self._remove.clicked.connect(self._on_remove_clicked)
        self.show_truths(())

    @property
    def truth(self) -> str:
        """Id of the truth that judges; empty when there is none."""
        return str(self._choice.currentData() or "")

    @property
    def truths(self) -> tuple[Truth, ...]:
        """All that can be chosen."""
        return self._truths

    def show_truths(self, truths: Sequence[Truth]) -> None:
        """Offer these, the newest one first; the chosen one stays if it is still there."""
        chosen = self.truth
        self._truths = tuple(truths)
        with QSignalBlocker(self._choice):
            self._choice.clear()
            for one in reversed(self._truths):
                self._choice.addItem(name_of_truth(one, self._language), one.id)
            if not self._truths:
                self._choice.addItem(self.tr("None yet"), "")
            self._choice.setCurrentIndex(max(0, self._choice.findData(chosen)))
        self._choice.setEnabled(bool(self._truths))
        self._remove.setEnabled(bool(self._truths))
        self._show_points()
        if self.truth != chosen:
            self.truth_chosen.emit(self.truth)

    def choose(self, truth: str) -> None:
        """Let a truth judge, as if it had been clicked."""
        position = self._choice.findData(truth)
        if position >= 0 and truth != self.truth:
            self._choice.setCurrentIndex(position)
            self._on_choice_activated()

    def _new_menu(self) -> QMenu:
        menu = QMenu(self)
        menu.setToolTipsVisible(True)
        for checked, words, tip in (
            (
                CheckedPoints.WHOLE,
                self.tr("All points as they stand now"),
                self.tr("You have checked all that was recorded together: every class is right"),
            ),
            (
                CheckedPoints.CLIP,
                self.tr("The part shown in 3D as it stands now"),
                self.tr("You have checked what the 3D view is clipped to"),
            ),
            (
                CheckedPoints.PAINTED,
                self.tr("Points painted by hand, no others"),
                self.tr("Labels that a run gave don't count unless you painted over them"),
            ),
        ):
            action = menu.addAction(words)
            action.setToolTip(tip)
            action.triggered.connect(
                lambda _=False, checked=checked: self.making_requested.emit(checked)
            )
        menu.addSeparator()
        menu.addAction(self.tr("From a file…"), self.loading_requested.emit)
        return menu

    def _show_points(self) -> None:
        truth = next((one for one in self._truths if one.id == self.truth), None)
        words = "" if truth is None else self.tr("{count} points").format(count=f"{truth.points:,}")
        self._points.setText(words)

    def _on_choice_activated(self) -> None:
        self._show_points()
        self.truth_chosen.emit(self.truth)

    def _on_remove_clicked(self) -> None:
        if self.truth:
            self.removal_requested.emit(self.truth)

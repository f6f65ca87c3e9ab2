"""ReviewPanel: the candidates that wait for a decision, one at a time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from processing.core.text import Language
from processing.map.feature import Feature
from processing.project.review.review_state import ReviewProgress, ReviewState
from widgets.panels.feature_tally import FeatureTally
from widgets.panels.review.candidate_card import CandidateCard
from widgets.panels.review.run_chooser import RunChooser
from widgets.parts.job_view import time_left
from widgets.parts.number_field import NumberField
from widgets.parts.share_bar import ShareBar
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_LEAST_HIGH_PX = 40
"""Two lines of the candidate: all panels above each other fit a screen of 768 pixels."""

_NATIVE = QKeySequence.SequenceFormat.NativeText
_LEAST = 0.9
_BIG_PX = 24
_NUMBER_PX = 72
_BESIDE_PX = 12
_ENTER = (Qt.Key.Key_Return, Qt.Key.Key_Enter)
_EMPTY, _WAITING, _REVIEW = range(3)


@dataclass(frozen=True)
class ReviewKeys:
    """The keys that judge while a review is open and nothing is being drawn."""

    accept: tuple[str, ...] = ("Enter", "Return")
    reject: tuple[str, ...] = ("Delete",)
    accept_line: tuple[str, ...] = ("Shift+Return",)
    reject_line: tuple[str, ...] = ("Shift+Delete",)
    edit: tuple[str, ...] = ("E",)
    next: tuple[str, ...] = ("N",)
    back: tuple[str, ...] = ("B",)


class ReviewPanel(QWidget):
    """Chooses runs, shows the candidate that is judged, and says how many are left.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    language : Language

    Signals
    -------
    open_requested(runs: tuple[str, ...], order: ReviewOrder)
        Judge the candidates of these runs; none: end the review.
    order_requested(order: ReviewOrder)
    accept_requested, reject_requested, edit_requested, next_requested, back_requested
        What is to be done with the candidate that is shown.
    accept_line_requested, reject_line_requested
        The same with all undecided ones of its line.
    accept_from_requested(least: float)
        Accept all undecided ones of at least this confidence.
    processing_requested
        There is nothing to judge; show the tools that find something.
    evaluation_requested
        All is judged; show how good the runs were.
    """

    open_requested = Signal(object, object)
    order_requested = Signal(object)
    accept_requested = Signal()
    reject_requested = Signal()
    accept_line_requested = Signal()
    reject_line_requested = Signal()
    edit_requested = Signal()
    next_requested = Signal()
    back_requested = Signal()
    accept_from_requested = Signal(float)
    processing_requested = Signal()
    evaluation_requested = Signal()

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
        self._progress = ReviewProgress(ReviewState())
        self._count_from: Callable[[float], int] = _none
        self._make_parts()
        self._pages = QStackedWidget(self)
        self._pages.addWidget(self._empty_page())
        self._pages.addWidget(self._waiting_page())
        self._pages.addWidget(self._review_page())
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._pages)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        shared.map_changes.features_changed.connect(self._on_map_features_changed)
        shared.map_changes.drives_changed.connect(self._on_map_drives_changed)
        self._settings.shows_rejected_changed.connect(self._on_settings_shows_rejected_changed)
        self._on_map_drives_changed()

    @staticmethod
    def keys() -> ReviewKeys:
        """The keys that the buttons name; whoever holds the window makes them work."""
        return ReviewKeys()

    def ask_count_from(self, count: Callable[[float], int]) -> None:
        """Ask this how many undecided candidates have at least a confidence."""
        self._count_from = count
        self._show_count()

    def show_review(
        self, progress: ReviewProgress, feature: Feature | None, line_count: int = 0
    ) -> None:
        """Show how far the review is, the candidate that is judged now, and how long its line."""
        self._progress = progress
        self._show_page()
        if not progress.state.is_open:
            return
        self._show_runs()
        left = time_left(progress.seconds_left) if progress.left else ""
        count = self.tr("%n left", "", progress.left)
        self._left.setText(f"{count} · {left}" if left else count)
        self._bar.show_share((progress.total - progress.left) / max(progress.total, 1))
        self._facts.setText(self._facts_words(progress))
        self._card.setVisible(feature is not None)
        self._done.setVisible(feature is None)
        if feature is not None:
            catalogue = self._source.catalogue()
            self._card.show_feature(
                feature,
                catalogue,
                progress.position,
                progress.total,
                photo=self._source.photo(feature),
            )
        for button in (self._accept, self._reject, self._edit, self._next):
            button.setEnabled(feature is not None)
        self._show_line(line_count)
        self._show_count()

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Enter ends what is typed into the number; it must not judge the candidate."""
        is_enter = isinstance(event, QKeyEvent) and event.key() in _ENTER
        if watched is self._least and is_enter:
            if event.type() is QEvent.Type.ShortcutOverride:
                event.accept()
                return True
            if event.type() is QEvent.Type.KeyPress:
                self._least.interpretText()
                self.setFocus()
                return True
        return super().eventFilter(watched, event)

    def _make_parts(self) -> None:
        self._chooser = RunChooser(self._source, self._language, self)
        self._chooser.runs_chosen.connect(self._on_chooser_runs_chosen)
        self._chooser.order_chosen.connect(self.order_requested)
        self._left = QLabel(self)
        font = self._left.font()
        font.setPixelSize(_BIG_PX)
        self._left.setFont(font)
        self._bar = ShareBar(self)
        self._facts = QLabel(self)
        self._facts.setWordWrap(True)
        self._card = CandidateCard(self._language, self)
        self._done = QWidget(self)
        self._fill_done()
        keys = self.keys()
        self._accept = self._button(self.tr("Accept"), keys.accept[:1], self.accept_requested.emit)
        self._reject = self._button(self.tr("Reject"), keys.reject, self.reject_requested.emit)
        self._accept_line = self._button("", (), self.accept_line_requested.emit)
        self._reject_line = self._button("", (), self.reject_line_requested.emit)
        self._edit = self._button(self.tr("Edit"), keys.edit, self.edit_requested.emit)
        self._next = self._button(self.tr("Next"), keys.next, self.next_requested.emit)
        self._back = self._button(self.tr("Back"), keys.back, self.back_requested.emit)
        self._least = NumberField(0.0, 1.0, decimals=2, parent=self)
        self._least.setSingleStep(0.05)
        self._least.setPrefix("≥ ")
        self._least.setToolTip(self.tr("The confidence from which all candidates are accepted"))
        self._least.setMinimumWidth(_NUMBER_PX)
        self._least.setValue(_LEAST)
        self._least.valueChanged.connect(self._show_count)
        self._least.installEventFilter(self)
        self._accept_all = QPushButton(self)
        self._accept_all.clicked.connect(lambda: self.accept_from_requested.emit(self.least))
        self._rejected = QCheckBox(self.tr("Show rejected features"), self)
        self._rejected.toggled.connect(self._settings.set_shows_rejected)
        self._rejected.setChecked(self._settings.shows_rejected)
        self._end = QPushButton(self.tr("End the review"), self)
        self._end.clicked.connect(lambda: self.open_requested.emit((), self._chooser.order))

    def _fill_done(self) -> None:
        """What stands in the place of the card when nothing is left."""
        words = _words(self.tr("All candidates are decided."), self._done)
        evaluation = QPushButton(self.tr("See how good the runs were"), self._done)
        evaluation.clicked.connect(self.evaluation_requested)
        layout = QVBoxLayout(self._done)
        layout.setContentsMargins(0, 8, 0, 8)
        layout.addWidget(words)
        layout.addWidget(evaluation)

    @property
    def least(self) -> float:
        """The confidence from which all would be accepted."""
        return self._least.value()

    def _button(self, words: str, keys: tuple[str, ...], slot: Callable[[], None]) -> QPushButton:
        native = [QKeySequence(key).toString(_NATIVE) for key in keys]
        button = QPushButton(f"{words}  ({native[0]})" if native else words, self)
        # The keys belong to the queue: a button in focus would take Enter for itself.
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        button.clicked.connect(slot)
        # Three stand beside each other: no wider than their words.
        button.setMinimumWidth(button.fontMetrics().horizontalAdvance(button.text()) + _BESIDE_PX)
        button.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        return button

    def _empty_page(self) -> QWidget:
        words = _words(
            self.tr("Candidates that a tool has found are judged here, one key for each."), self
        )
        button = QPushButton(self.tr("Find something with a tool"), self)
        button.clicked.connect(self.processing_requested)
        return _page(words, button)

    def _waiting_page(self) -> QWidget:
        self._waiting = _words("", self)
        self._start = QPushButton(self.tr("Start the review"), self)
        self._start.clicked.connect(self._on_start_clicked)
        return _page(self._waiting, self._start)

    def _review_page(self) -> QWidget:
        judging = QGridLayout()
        judging.setSpacing(4)
        judging.addWidget(self._accept, 0, 0, 1, 3)
        judging.addWidget(self._reject, 0, 3, 1, 3)
        for column, button in enumerate((self._edit, self._back, self._next)):
            judging.addWidget(button, 1, 2 * column, 1, 2)
        judging.addWidget(self._accept_line, 2, 0, 1, 3)
        judging.addWidget(self._reject_line, 2, 3, 1, 3)
        many = QHBoxLayout()
        many.setSpacing(4)
        many.addWidget(self._least)
        many.addWidget(self._accept_all, 1)
        undo = QLabel(self.tr("Ctrl+Z takes decisions back."), self)
        undo.setEnabled(False)
        undo.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        page = QWidget(self)
        layout = QVBoxLayout(page)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(8)
        for one in (self._card, self._done, self._facts):
            layout.addWidget(one)
        layout.addLayout(many)
        for one in (self._chooser, self._rejected, undo):
            layout.addWidget(one)
        layout.addStretch(1)
        layout.addWidget(self._end)
        scroll = QScrollArea(self)
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setWidget(page)
        room = scroll.verticalScrollBar().sizeHint().width()
        scroll.setMinimumWidth(page.minimumSizeHint().width() + room)
        scroll.setMinimumHeight(_LEAST_HIGH_PX)
        whole = QWidget(self)
        around = QVBoxLayout(whole)
        around.setContentsMargins(8, 8, 8, 8)
        around.setSpacing(8)
        around.addWidget(self._left)
        around.addWidget(self._bar)
        around.addWidget(scroll, 1)
        # Below what scrolls: buttons stay under the mouse, whatever is said of the candidate.
        around.addLayout(judging)
        return whole

    def _facts_words(self, progress: ReviewProgress) -> str:
        words = self.tr("{accepted} accepted · {rejected} rejected").format(
            accepted=f"{progress.accepted:,}", rejected=f"{progress.rejected:,}"
        )
        pace = progress.decisions_per_minute
        if pace is None:
            return words
        return f"{words} · " + self.tr("{count} a minute").format(count=f"{pace:.0f}")

    def _show_page(self) -> None:
        tallies = self._tally.by_run.values()
        waiting = sum(tally.candidates for tally in tallies)
        self._waiting.setText(self.tr("%n candidate(s) wait for a decision.", "", waiting))
        page = _REVIEW if self._progress.state.is_open else (_WAITING if waiting else _EMPTY)
        if page != self._pages.currentIndex():
            focus = QApplication.focusWidget()
            has_focus = focus is not None and self.isAncestorOf(focus)
            self._pages.setCurrentIndex(page)
            if has_focus:
                # A field that came into focus by chance would take the keys that judge.
                self.setFocus()

    def _show_runs(self) -> None:
        state = self._progress.state
        self._chooser.show_runs(self._tally.by_run, state.runs, state.order)

    def _show_line(self, count: int) -> None:
        keys = self.keys()
        for button, words, key in (
            (self._accept_line, self.tr("Accept line: %n", "", count), keys.accept_line[0]),
            (self._reject_line, self.tr("Reject line: %n", "", count), keys.reject_line[0]),
        ):
            button.setText(words)
            button.setToolTip(f"{words} ({QKeySequence(key).toString(_NATIVE)})")
            button.setVisible(count > 1)

    def _show_count(self) -> None:
        count = self._count_from(self.least) if self._progress.state.is_open else 0
        self._accept_all.setText(self.tr("Accept %n", "", count))
        self._accept_all.setEnabled(count > 0)

    def _on_start_clicked(self) -> None:
        undecided = (run.run for run, tally in self._tally.by_run.items() if tally.candidates)
        self.open_requested.emit(tuple(undecided), self._chooser.order)

    def _on_chooser_runs_chosen(self, runs: tuple[str, ...]) -> None:
        self.open_requested.emit(runs, self._chooser.order)

    def _on_settings_shows_rejected_changed(self) -> None:
        self._rejected.setChecked(self._settings.shows_rejected)

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        self._tally.read(ids)
        self._show_runs()
        self._show_page()

    def _on_map_drives_changed(self) -> None:
        self._tally.read_all()
        self._show_runs()
        self._show_page()


def _none(_least: float) -> int:
    """No candidates while nobody was told where to ask."""
    return 0


def _words(text: str, parent: QWidget) -> QLabel:
    words = QLabel(text, parent)
    words.setWordWrap(True)
    words.setEnabled(False)
    return words


def _page(*parts: QWidget) -> QWidget:
    page = QWidget()
    layout = QVBoxLayout(page)
    layout.setContentsMargins(8, 8, 8, 8)
    layout.setSpacing(8)
    for part in parts:
        layout.addWidget(part)
    layout.addStretch(1)
    return page

"""Review: the candidates of runs, judged one after the other by one key each."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import islice

from PySide6.QtCore import QObject, Signal

from app.document.document import Document
from app.review.review_queue import ReviewQueue
from processing.core.errors import UserError
from processing.core.text import Text
from processing.map.change import Change
from processing.map.feature import Feature, Status
from processing.map.feature_middle import middle_of
from processing.project.review.decisions import (
    FeatureLines,
    accept_unseen,
    change_status,
    label_of_line,
    label_of_many,
    label_of_one,
)
from processing.project.review.review_order import review_order
from processing.project.review.review_state import (
    ReviewOrder,
    ReviewProgress,
    ReviewState,
    read_review_state,
    write_review_state,
)
from widgets.shared.cursor import PickedPosition

_PREPARED = 3
_GONE = Text(
    "{count} features of the review are gone; {left} candidates are left.",
    "確認中の地物{count}件がなくなりました。残りの候補は{left}件です。",
)
_DONE = Text("All candidates of the review are decided.", "確認対象の候補はすべて判定済みです。")


class Review(QObject):
    """The queue of the open project.

    Its decisions are ordinary changes of the map, so undo takes them back and brings the queue
    back to where it was; its own place is kept with the project.

    Parameters
    ----------
    document : Document
    clock : callable
        Seconds that never run backwards.

    Signals
    -------
    shown(feature: Feature, place: Place)
        Every view shall have this place in the middle. Selection and cursor are there already.
    coming(places: tuple[Place, ...])
        Those that are probably shown next, the next one first.
    changed
        The progress, the candidate shown, or whether there is a review at all.
    edit_requested(feature: Feature)
        The operator wants to correct what is shown.
    """

    shown = Signal(object, object)
    coming = Signal(object)
    changed = Signal()
    edit_requested = Signal(object)

    def __init__(
        self,
        document: Document,
        parent: QObject | None = None,
        *,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(parent)
        self._document = document
        self._clock = clock
        self._state = ReviewState()
        self._queue = ReviewQueue()
        self._lines = FeatureLines()
        self._trail: list[str] = []
        self._shown_at = 0.0
        self._is_deciding = False
        self._is_opening = False
        document.opened.connect(self._on_document_opened)
        document.closed.connect(self._on_document_closed)
        document.shared.map_changes.features_changed.connect(self._on_map_features_changed)

    @property
    def is_open(self) -> bool:
        """Whether a review is going on: its keys judge then."""
        return self._state.is_open

    @property
    def current(self) -> Feature | None:
        """The candidate that is shown; None when there is none."""
        return self._document.feature(self._state.feature) if self._state.feature else None

    @property
    def progress(self) -> ReviewProgress:
        """How far the review is."""
        return ReviewProgress(
            self._state,
            accepted=self._queue.count(Status.ACCEPTED),
            rejected=self._queue.count(Status.REJECTED),
            left=self._queue.count(Status.CANDIDATE),
            position=self._queue.position(self._state.feature),
        )

    @property
    def is_outrun(self) -> bool:
        """Whether nothing is left to judge, or a run of the queue has given way to another one."""
        known = {one.provenance.run for one in self._document.features()}
        return not self.progress.left or not known.issuperset(self._state.runs)

    def open(self, runs: Iterable[str], order: ReviewOrder) -> None:
        """Begin to judge the candidates of some runs; none: end the review."""
        if self._document.project is None:
            return
        self._begin(ReviewState(tuple(dict.fromkeys(runs)), order))

    def add(self, run: str) -> None:
        """Go on with what is shown, and judge the candidates of this run too."""
        if run not in self._state.runs:
            self._begin(replace(self._state, runs=(*self._state.runs, run)))

    def close(self) -> None:
        """End the review; what was decided stays."""
        self.open((), self._state.order)

    def put_in_order(self, order: ReviewOrder) -> None:
        """Go on in another order, with what comes first in it."""
        if order is not self._state.order:
            self._begin(replace(self._state, order=order, feature=""))

    def accept(self) -> bool:
        """Agree to what is shown and go on; says whether it could."""
        return self._decide(Status.ACCEPTED)

    def reject(self) -> bool:
        """Refuse what is shown and go on; it is kept to judge the tool by."""
        return self._decide(Status.REJECTED)

    @property
    def line_count(self) -> int:
        """How many undecided candidates belong to the line of what is shown."""
        return len(self._line())

    def accept_line(self) -> bool:
        """Agree to all undecided candidates of the line of what is shown, in one step."""
        return self._decide_line(Status.ACCEPTED)

    def reject_line(self) -> bool:
        """Refuse them all."""
        return self._decide_line(Status.REJECTED)

    def edit(self) -> None:
        """Let the operator correct what is shown; it is still to be judged."""
        feature = self.current
        if feature is not None:
            self.edit_requested.emit(feature)

    def next(self) -> None:
        """Leave what is shown undecided for now and go on."""
        self._go_to(next(self._queue.undecided(after=self._state.feature), ""))

    def back(self) -> None:
        """Go to what was shown before, judged or not."""
        while self._trail:
            id_ = self._trail.pop()
            if id_ in self._queue and id_ != self._state.feature:
                self._go_to(id_, leaves_trail=False)
                return
        before = self._queue.before(self._state.feature)
        if before:
            self._go_to(before, leaves_trail=False)

    def count_from(self, least: float) -> int:
        """How many undecided candidates have at least this confidence."""
        return self._queue.count_from(least)

    def accept_from(self, least: float) -> bool:
        """Agree to all undecided candidates of at least this confidence, in one step."""
        found = map(self._document.feature, self._queue.undecided_from(least))
        features = [feature for feature in found if feature is not None]
        if not features:
            return False
        label = label_of_many(len(features), least)
        if not self._apply_change(label, accept_unseen(features)):
            return False
        if self._queue.status(self._state.feature) is Status.CANDIDATE:
            self.changed.emit()
        else:
            self._go_on()
        return True

    def _decide(self, status: Status) -> bool:
        feature = self.current
        if feature is None:
            return False
        if feature.status is not status or feature.provenance.unseen:
            seconds = self._clock() - self._shown_at
            label = label_of_one(self._document.catalogue(), feature, status)
            if not self._apply_change(label, change_status((feature,), status)):
                return False
            self._state = self._state.decided(seconds)
        self._go_on()
        return True

    def _line(self) -> list[str]:
        """The undecided candidates that a tool gave as one line with what is shown."""
        beside = self._lines.beside(self._state.feature)
        return [id_ for id_ in beside if self._queue.status(id_) is Status.CANDIDATE]

    def _decide_line(self, status: Status) -> bool:
        shown, found = self.current, map(self._document.feature, self._line())
        features = [feature for feature in found if feature is not None]
        if shown is None or not features:
            return False
        label = label_of_line(self._document.catalogue(), shown, len(features), status)
        if not self._apply_change(label, change_status(features, status)):
            return False
        self._go_on()
        return True

    def _apply_change(self, label: Text, change: Change) -> bool:
        self._is_deciding = True
        try:
            return self._document.apply(label, change)
        finally:
            self._is_deciding = False

    def _begin(self, state: ReviewState) -> None:
        self._trail.clear()
        self._state = state
        self._queue = self._queue_of(state)
        known = state.feature in self._queue
        is_left = known and self._queue.status(state.feature) is Status.CANDIDATE
        self._show(state.feature if is_left else next(self._queue.undecided(state.feature), ""))

    def _queue_of(self, state: ReviewState) -> ReviewQueue:
        if not state.is_open:
            self._lines = FeatureLines()
            return ReviewQueue()
        runs = set(state.runs)
        members = {one.id: one for one in self._document.features() if one.provenance.run in runs}
        self._lines = FeatureLines(members.values())
        ids = review_order(members.values(), state.order, self._document.drives())
        return ReviewQueue(
            ids,
            [members[id_].status for id_ in ids],
            [members[id_].provenance.confidence for id_ in ids],
        )

    def _go_on(self) -> None:
        """Show the next undecided candidate behind this one; tell when that was the last."""
        id_ = next(self._queue.undecided(after=self._state.feature), "")
        self._go_to(id_)
        if not id_:
            self._document.reported.emit(_DONE)

    def _go_to(self, id_: str, *, leaves_trail: bool = True) -> None:
        if leaves_trail and self._state.feature and id_ != self._state.feature:
            self._trail.append(self._state.feature)
        self._show(id_)

    def _show(self, id_: str) -> None:
        self._state = replace(self._state, feature=id_)
        self._remember()
        feature = self.current
        if feature is not None:
            position = _position_of(feature)
            self._document.shared.selection.choose_features(frozenset({id_}))
            self._document.shared.cursor.move_to(position)
            self._shown_at = self._clock()
            self.shown.emit(feature, position)
            self.coming.emit(self._coming_positions(id_))
        self.changed.emit()

    def _coming_positions(self, id_: str) -> tuple[PickedPosition, ...]:
        ids = islice(self._queue.undecided(after=id_), _PREPARED)
        found = (self._document.feature(one) for one in ids if one != id_)
        return tuple(_position_of(one) for one in found if one is not None)

    def _remember(self) -> None:
        project = self._document.project
        if project is None:
            return
        try:
            write_review_state(project.settings, self._state)
        except UserError as error:
            self._document.refused.emit(error)

    def _on_document_opened(self) -> None:
        # The views have nothing to show yet: the document tells of its features at the end.
        self._is_opening = True

    def _on_document_closed(self) -> None:
        self._state, self._queue = ReviewState(), ReviewQueue()
        self._trail.clear()
        self._is_opening = False
        self.changed.emit()

    def _resume(self) -> None:
        """Go on where the project's review was left."""
        self._is_opening = False
        project = self._document.project
        if project is None:
            return
        try:
            state = read_review_state(project.settings)
        except UserError as error:
            self._document.refused.emit(error)
            return
        if state.is_open:
            self._begin(state)
        else:
            self.changed.emit()

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        """Follow what became of the queue's features: by its own keys, by undo, by anyone."""
        if self._is_opening:
            self._resume()
        elif self._state.is_open:
            self._follow(ids)

    def _follow(self, ids: tuple[str, ...]) -> None:
        features = {id_: self._document.feature(id_) for id_ in ids}
        gone = {id_ for id_, one in features.items() if one is None and id_ in self._queue}
        if gone:
            self._join_runs_in_place_of_gone(features.values())
        runs = set(self._state.runs)
        new = [
            one.id
            for one in features.values()
            if one is not None and one.provenance.run in runs and one.id not in self._queue
        ]
        changed = self._took_statuses(features.values())
        if gone or new:
            self._go_on_with_others(gone, new)
        elif self._is_deciding:
            return
        elif any(self._queue.status(id_) is Status.CANDIDATE for id_ in changed):
            self._go_to(self._first_undecided(changed), leaves_trail=False)
        elif self._state.feature in changed:
            self._go_on()
        elif changed or self._state.feature in features:
            self.changed.emit()

    def _join_runs_in_place_of_gone(self, features: Iterable[Feature | None]) -> None:
        """What came in the step that took candidates away is judged instead: a tool ran again."""
        came = [
            one.provenance.run
            for one in features
            if one is not None and one.provenance.run and one.status is Status.CANDIDATE
        ]
        runs = tuple(dict.fromkeys((*self._state.runs, *came)))
        self._state = replace(self._state, runs=runs)

    def _took_statuses(self, features: Iterable[Feature | None]) -> list[str]:
        """Note what features are now; gives those that were something else."""
        changed = []
        for feature in features:
            known = None if feature is None else self._queue.status(feature.id)
            if feature is not None and known is not None and known is not feature.status:
                self._queue.took(feature.id, feature.status)
                changed.append(feature.id)
        return changed

    def _first_undecided(self, ids: Iterable[str]) -> str:
        found = [id_ for id_ in ids if self._queue.status(id_) is Status.CANDIDATE]
        return min(found, key=self._queue.position, default="")

    def _go_on_with_others(self, gone: set[str], new: list[str]) -> None:
        """Features came or went: a run was undone, deleted or done again, a line was cut."""
        current = self._state.feature
        behind = (id_ for id_ in self._queue.undecided(current) if id_ not in gone)
        following = next(behind, "")
        self._queue = self._queue_of(self._state) if new else self._queue.without(gone)
        if gone and not new:
            left = self._queue.count(Status.CANDIDATE)
            reported = _GONE.filled(count=f"{len(gone):,}", left=f"{left:,}")
            self._document.reported.emit(reported)
        if current in gone or not current:
            self._state = replace(self._state, feature="")
            self._go_to(self._first_undecided(new) or following)
        else:
            self.changed.emit()


def _position_of(feature: Feature) -> PickedPosition:
    middle = middle_of(feature)
    return PickedPosition(middle.xyz, middle.measured, middle.is_occluded)

"""The queue of candidates: judged one by one, taken back, left and taken up again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication

from app.document.document import Document
from app.jobs.jobs import JobQueue
from app.review.review import Review
from processing.core.text import Text
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, Status
from processing.project.results.found_features import FoundFeatures
from processing.project.review.review_state import ReviewOrder, ReviewState
from processing.tools.tool import CandidateResult
from tests.processing.project.candidates import found as candidates_of
from tests.processing.project.candidates import found_lines, line
from widgets.shared.cursor import PickedPosition

LABEL = Text("Edit", "編集")
COUNT = 50


@dataclass
class ReviewSession:
    """An operator's desk: an open project, its review, and what was said and shown."""

    folder: Path
    document: Document
    review: Review
    now_s: list[float]
    shown: list[tuple[str, PickedPosition]] = field(default_factory=list)
    reported: list[str] = field(default_factory=list)

    def store(self, found: FoundFeatures) -> str:
        assert self.document.store_run(found)
        return found.run.id

    def current(self) -> Feature:
        assert self.review.current is not None
        return self.review.current

    def status(self, id_: str) -> Status:
        feature = self.document.feature(id_)
        assert feature is not None
        return feature.status

    def take(self, seconds: float) -> None:
        self.now_s[0] += seconds


@pytest.fixture
def desk(qapp: QApplication, tmp_path: Path) -> Iterator[ReviewSession]:
    jobs = JobQueue()
    document = Document(jobs)
    now_s = [100.0]
    review = Review(document, clock=lambda: now_s[0])
    made = ReviewSession(tmp_path / "p.zuka", document, review, now_s)
    review.shown.connect(lambda feature, position: made.shown.append((feature.id, position)))
    document.reported.connect(lambda text: made.reported.append(text.en))
    assert document.create(made.folder, "EPSG:6677")
    yield made
    jobs.close()
    document.close()
    document.tiles.close()


@pytest.fixture
def found(desk: ReviewSession) -> FoundFeatures:
    """Fifty candidates on the map, under review, the least certain one shown."""
    made = found_lines(COUNT)
    desk.store(made)
    desk.review.open((made.run.id,), ReviewOrder.CONFIDENCE)
    return made


def by_confidence(found: FoundFeatures) -> list[str]:
    return [one.id for one in sorted(found.change.added, key=lambda one: one.provenance.confidence)]


def test_fifty_candidates_are_judged_from_the_least_certain_to_the_last(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    for number in range(COUNT):
        desk.take(1.5)
        assert desk.review.reject() if number % 5 == 0 else desk.review.accept()
    assert [id_ for id_, _ in desk.shown] == by_confidence(found)
    progress = desk.review.progress
    assert (progress.accepted, progress.rejected, progress.left) == (40, 10, 0)
    assert progress.state.decisions == COUNT
    assert progress.state.total_s == 75.0
    assert desk.review.current is None
    assert desk.reported[-1] == "All candidates of the review are decided."
    assert not desk.review.accept()


def test_what_is_shown_is_chosen_and_under_the_cursor(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    coming: list[tuple[PickedPosition, ...]] = []
    desk.review.coming.connect(coming.append)
    desk.review.accept()
    feature = desk.current()
    _, position = desk.shown[-1]
    assert desk.document.shared.cursor.position == position
    assert desk.document.shared.selection.features == {feature.id}
    assert position.xyz == feature.vertices[1].xyz
    assert position.measured == feature.vertices[1].measured
    desk.review.accept()
    assert desk.shown[-1][1] == coming[-2][0]
    assert len(coming[-1]) == 3


def test_undo_brings_the_queue_back_to_what_was_judged(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    first, second, third = by_confidence(found)[:3]
    desk.review.accept()
    desk.review.reject()
    assert desk.current().id == third
    assert desk.document.undo_stack.undo_label == Text(
        "Reject Curb, lower edge", "「縁石下端」を却下"
    )
    desk.document.undo()
    assert desk.current().id == second
    desk.document.undo()
    assert desk.current().id == first
    assert desk.status(first) is Status.CANDIDATE
    desk.document.redo()
    assert desk.current().id == second
    assert desk.review.progress.left == COUNT - 1


def test_all_from_a_confidence_up_are_accepted_in_one_step(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    sure = {one.id for one in found.change.added if one.provenance.confidence >= 0.9}
    assert len(sure) == desk.review.count_from(0.9) == 5
    assert desk.review.accept_from(0.9)
    assert {one.id for one in desk.document.features() if one.status is Status.ACCEPTED} == sure
    assert desk.current().id == by_confidence(found)[0]
    assert "Accept 5 candidates" in str(desk.document.undo_stack.undo_label)
    accepted = [one for one in desk.document.features() if one.status is Status.ACCEPTED]
    assert all(one.provenance.unseen for one in accepted)
    desk.document.undo()
    assert desk.review.progress.left == COUNT
    assert desk.review.count_from(0.9) == 5
    assert not desk.review.accept_from(1.1)


def test_next_leaves_a_candidate_for_later_and_back_returns_to_it(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    first, second, third = by_confidence(found)[:3]
    desk.review.next()
    desk.review.accept()
    assert desk.current().id == third
    desk.review.back()
    assert desk.current().id == second
    assert desk.current().status is Status.ACCEPTED
    desk.review.reject()  # another opinion
    assert desk.status(second) is Status.REJECTED
    assert desk.current().id == third
    desk.review.back()
    desk.review.back()
    assert desk.current().id == first
    desk.review.back()
    assert desk.current().id == first


def test_those_left_for_later_come_again_at_the_end(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    first = desk.current().id
    desk.review.next()
    for _ in range(COUNT - 1):
        desk.review.accept()
    assert desk.current().id == first
    desk.review.next()
    assert desk.current().id == first


def test_agreeing_again_to_what_was_accepted_only_goes_on(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    desk.review.accept()
    desk.review.back()
    label = desk.document.undo_stack.undo_label
    desk.review.accept()
    assert desk.document.undo_stack.undo_label == label
    assert desk.review.progress.accepted == 1
    assert desk.review.progress.state.decisions == 1


def test_a_review_goes_on_after_a_restart_where_it_was_left(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    desk.review.put_in_order(ReviewOrder.STREET)
    for _ in range(20):
        desk.take(2.0)
        desk.review.accept()
    desk.review.next()
    left, progress = desk.current().id, desk.review.progress
    desk.document.close()
    assert not desk.review.is_open
    assert desk.review.current is None
    desk.shown.clear()
    assert desk.document.open(desk.folder)
    assert desk.review.progress == progress
    assert desk.current().id == left
    assert [id_ for id_, _ in desk.shown] == [left]


def test_along_the_street_is_the_order_of_measuring(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    with_drive_gone = [one.id for one in found.change.added]
    desk.review.put_in_order(ReviewOrder.STREET)
    seen = []
    while desk.review.current is not None:
        seen.append(desk.current().id)
        desk.review.accept()
    assert seen == with_drive_gone


def test_a_candidate_that_is_corrected_stays_until_it_is_judged(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    wished: list[Feature] = []
    desk.review.edit_requested.connect(wished.append)
    desk.review.edit()
    before = desk.current()
    assert wished == [before]
    after = before.with_vertices(before.vertices[:2])
    desk.document.apply(LABEL, Change(replaced=(Replacement(before, after),)))
    assert desk.current() == after
    desk.review.accept()
    assert desk.document.feature(before.id) == replace(after, status=Status.ACCEPTED)


def test_an_edit_elsewhere_does_not_move_the_queue(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    desk.review.accept()
    desk.review.back()
    decided = desk.current().id
    other = desk.document.feature(by_confidence(found)[-1])
    assert other is not None
    turned = other.with_vertices(other.vertices[::-1])
    desk.document.apply(LABEL, Change(replaced=(Replacement(other, turned),)))
    assert desk.current().id == decided


def test_a_candidate_judged_in_the_attribute_panel_is_done_with(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    feature = desk.current()
    accepted = replace(feature, status=Status.ACCEPTED)
    desk.document.apply(LABEL, Change(replaced=(Replacement(feature, accepted),)))
    assert desk.current().id == by_confidence(found)[1]
    assert desk.review.progress.accepted == 1


def test_a_run_taken_back_while_its_queue_is_open_empties_it_and_says_so(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    desk.document.undo()
    assert desk.review.current is None
    assert desk.review.progress.total == 0
    assert "50 features of the review are gone; 0 candidates are left." in desk.reported
    assert not desk.review.reject()
    desk.document.redo()
    assert desk.current().id == by_confidence(found)[0]
    assert desk.review.progress.left == COUNT


def test_of_two_runs_one_can_be_deleted_and_the_other_goes_on(desk: ReviewSession) -> None:
    first, second = found_lines(10), found_lines(10, seed=2, drive="right")
    runs = (desk.store(first), desk.store(second))
    desk.review.open(runs, ReviewOrder.CONFIDENCE)
    assert desk.review.progress.total == 20
    desk.review.accept()
    gone = tuple(
        one
        for one in desk.document.features()
        if one.provenance.run == runs[0] and one.status is Status.CANDIDATE
    )
    desk.document.apply(LABEL, Change(removed=gone))
    assert desk.current().provenance.run == runs[1] or desk.current() not in gone
    assert desk.review.progress.left == 20 - 1 - len(gone)
    assert desk.reported[-1].startswith(f"{len(gone)} features of the review are gone")
    while desk.review.current is not None:
        desk.review.accept()
    assert desk.review.progress.left == 0


def test_the_queue_goes_on_with_what_a_second_run_put_in_the_place_of_the_undecided(
    desk: ReviewSession,
) -> None:
    apart = CandidateResult(
        tuple(line(3 * position, position / COUNT) for position in range(COUNT))
    )
    first, again = candidates_of(apart), candidates_of(apart)
    desk.store(first)
    desk.review.open((first.run.id,), ReviewOrder.CONFIDENCE)
    desk.review.accept()
    desk.review.reject()
    desk.store(again)
    progress = desk.review.progress
    assert (progress.accepted, progress.rejected, progress.left) == (1, 1, COUNT - 2)
    assert desk.current().provenance.run == again.run.id
    assert desk.reported[-1] == (
        "Curbs: 48 candidates; 48 earlier undecided ones were replaced: "
        "48 found again, 0 new, 0 gone, 2 places had been decided"
    )
    desk.document.undo()
    assert desk.review.progress.left == COUNT - 2
    assert desk.current().provenance.run == first.run.id
    desk.document.redo()
    assert desk.current().provenance.run == again.run.id
    assert desk.review.progress.left == COUNT - 2


def test_a_queue_of_a_second_run_goes_back_to_the_first_by_undo(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    again = found_lines(COUNT, seed=2)
    desk.review.close()
    desk.store(again)
    desk.review.open((again.run.id,), ReviewOrder.CONFIDENCE)
    desk.document.undo()
    assert desk.current().id == by_confidence(found)[0]
    assert desk.review.progress.left == COUNT


def test_the_pieces_of_a_cut_candidate_are_judged_next(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    whole = desk.current()
    pieces = (
        replace(whole, id="a", vertices=whole.vertices[:2]),
        replace(whole, id="b", vertices=whole.vertices[1:]),
    )
    desk.document.apply(LABEL, Change(added=pieces, removed=(whole,)))
    assert desk.current().id in {"a", "b"}
    assert desk.review.progress.total == COUNT + 1
    assert not any("gone" in words for words in desk.reported)


def test_a_candidate_of_a_drive_that_is_gone_is_shown_at_its_coordinates(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    assert desk.document.drives() == ()
    _, position = desk.shown[-1]
    assert position.xyz == desk.current().vertices[1].xyz


def test_a_review_that_is_ended_judges_nothing_and_stays_ended(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    desk.review.close()
    assert not desk.review.is_open
    assert not desk.review.accept()
    assert desk.review.progress.total == 0
    desk.document.close()
    desk.document.open(desk.folder)
    assert not desk.review.is_open


def test_a_damaged_state_is_told_once_and_the_project_opens(
    desk: ReviewSession, found: FoundFeatures
) -> None:
    project = desk.document.project
    assert project is not None
    project.settings.put("review", {"runs": 3})
    desk.document.close()
    refused = []
    desk.document.refused.connect(lambda error: refused.append(error.remedy.en))
    assert desk.document.open(desk.folder)
    assert refused == ["Start the review again; all decisions are kept."]
    assert desk.review.progress.state == ReviewState()
    desk.review.open((found.run.id,), ReviewOrder.CONFIDENCE)
    assert desk.review.progress.left == COUNT


def test_nothing_is_under_review_while_no_project_is_open(desk: ReviewSession) -> None:
    desk.document.close()
    desk.review.open(("run",), ReviewOrder.CONFIDENCE)
    assert not desk.review.is_open
    desk.review.next()
    desk.review.back()
    desk.review.edit()
    assert desk.review.current is None


def test_a_run_that_found_nothing_is_remembered_and_told(desk: ReviewSession) -> None:
    nothing = found_lines(0)
    assert not desk.document.store_run(nothing)
    assert desk.reported[-1] == "Curbs: nothing found"
    assert [run.id for run in desk.document.runs()] == [nothing.run.id]
    assert desk.document.undo_stack.undo_label is None

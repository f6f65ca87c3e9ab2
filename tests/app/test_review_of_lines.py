"""A row of lids, or both edges of a curb, is judged by one key and taken back as one step."""

from __future__ import annotations

from dataclasses import replace

import pytest

from processing.map.feature import Status
from processing.project.review.review_state import ReviewOrder
from processing.tools.tool import CandidateResult
from tests.app.review.test_review import ReviewSession, desk
from tests.processing.project.candidates import found, line

__all__ = ["desk"]


def store(desk: ReviewSession, *lines: int | None, drive: str = "left") -> str:
    """Candidates along the street, each of the line that is given, less sure one by one."""
    made = [line(at, 0.9 - at / 100) for at in range(len(lines))]
    numbered = [
        replace(one, attributes={} if number is None else {"run": number})
        for one, number in zip(made, lines, strict=True)
    ]
    return desk.store(found(CandidateResult(tuple(numbered)), drive=drive))


def statuses(desk: ReviewSession) -> str:
    """A letter for each candidate along the street: accepted, rejected, undecided."""
    letters = {Status.ACCEPTED: "a", Status.REJECTED: "r", Status.CANDIDATE: "."}
    features = sorted(desk.document.features(), key=lambda one: one.vertices[0].xyz[0])
    return "".join(letters[one.status] for one in features)


def test_all_that_is_undecided_of_a_line_is_accepted_in_one_step(desk: ReviewSession) -> None:
    run = store(desk, 1, 1, 2, 1, 2, None)
    desk.review.open([run], ReviewOrder.STREET)
    assert desk.review.line_count == 3
    desk.review.reject()
    assert desk.review.line_count == 2
    assert desk.review.accept_line()
    assert statuses(desk) == "ra.a.."
    # On with what is left behind it.
    assert desk.current().attributes["run"] == 2
    assert desk.document.undo_stack.undo_label is not None
    assert desk.document.undo_stack.undo_label.en == "Accept Curb, lower edge: 2 of one line"
    desk.document.undo()
    assert statuses(desk) == "r....."
    assert desk.review.line_count == 2


def test_a_line_that_is_none_is_rejected_and_what_follows_is_shown(desk: ReviewSession) -> None:
    run = store(desk, 1, 1, 2, 1)
    desk.review.open([run], ReviewOrder.STREET)
    assert desk.review.reject_line()
    assert statuses(desk) == "rr.r"
    assert desk.review.line_count == 1
    assert desk.review.accept_line()
    assert statuses(desk) == "rrar"
    assert desk.reported[-1] == "All candidates of the review are decided."
    assert not desk.review.accept_line()


def test_lines_of_another_run_with_the_same_number_are_others(desk: ReviewSession) -> None:
    first, second = store(desk, 1, 1), store(desk, 1, 1, drive="right")
    desk.review.open([first, second], ReviewOrder.CONFIDENCE)
    assert desk.review.line_count == 2
    desk.review.accept_line()
    by_run = {one.provenance.run: one.status for one in desk.document.features()}
    assert sorted(status.value for status in by_run.values()) == ["accepted", "candidate"]


@pytest.mark.parametrize("number", [None, 7])
def test_what_is_of_no_line_or_alone_is_no_line(desk: ReviewSession, number: int | None) -> None:
    run = store(desk, number, 1, 1)
    desk.review.open([run], ReviewOrder.STREET)
    assert desk.review.line_count == (0 if number is None else 1)
    assert desk.review.accept_line() is (number is not None)


def test_a_run_that_comes_while_another_is_judged_joins_it(desk: ReviewSession) -> None:
    desk.review.open([store(desk, 1, 1)], ReviewOrder.STREET)
    shown = desk.current()
    later = store(desk, 1, 1, 1, drive="right")
    desk.review.add(later)
    assert desk.current() == shown
    assert desk.review.progress.total == 5
    desk.review.add(later)
    assert desk.review.progress.total == 5

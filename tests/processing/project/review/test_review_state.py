"""Where a review stands is remembered with the project, and told in numbers."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from processing.core.errors import BadFile
from processing.project.project import Project
from processing.project.review.review_state import (
    ReviewOrder,
    ReviewProgress,
    ReviewState,
    read_review_state,
    write_review_state,
)
from tests.processing.project.drawn import new_project

STATE = ReviewState(("run-1", "run-2"), ReviewOrder.STREET, "f7", 12, 30.5, (2.0, 3.25, 1.0))


def test_a_project_remembers_its_review(tmp_path: Path) -> None:
    folder = new_project(tmp_path / "p.zuka")
    with closing(Project.open(folder)) as project:
        assert read_review_state(project.settings) == ReviewState()
        write_review_state(project.settings, STATE)
    with closing(Project.open(folder)) as project:
        assert read_review_state(project.settings) == STATE


@pytest.mark.parametrize(
    "stored",
    [
        "text",
        {"runs": "run-1"},
        {"runs": [1], "order": "street", "feature": "", "decisions": 0, "total_s": 0, "last_s": []},
        {"runs": [], "order": "size", "feature": "", "decisions": 0, "total_s": 0, "last_s": []},
        {
            "runs": [],
            "order": "street",
            "feature": "",
            "decisions": 0,
            "total_s": 0,
            "last_s": [""],
        },
    ],
)
def test_a_damaged_state_is_refused_with_what_to_do(tmp_path: Path, stored: object) -> None:
    with closing(Project.open(new_project(tmp_path / "p.zuka"))) as project:
        project.settings.put("review", stored)
        with pytest.raises(BadFile) as refusal:
            read_review_state(project.settings)
    assert "Start the review again" in refusal.value.remedy.en


def test_the_pace_is_the_median_of_the_last_decisions() -> None:
    state = ReviewState(("r",))
    for seconds in (1.0, 2.0):
        state = state.decided(seconds)
    assert state.seconds_per_decision is None
    state = state.decided(30.0)
    assert state.seconds_per_decision == 2.0
    progress = ReviewProgress(state, accepted=2, rejected=1, left=10)
    assert progress.seconds_left == 20.0
    assert progress.decisions_per_minute == 30.0
    assert progress.total == 13


def test_a_break_is_no_work_and_old_times_are_forgotten() -> None:
    state = ReviewState(("r",)).decided(3600.0)
    assert state.total_s == 120.0
    for _ in range(60):
        state = state.decided(1.5)
    assert state.decisions == 61
    assert set(state.last_s) == {1.5}

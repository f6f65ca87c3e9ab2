"""A tool that runs again replaces what nobody decided on, and is silent about what somebody did."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, Status, Vertex, new_feature_id
from processing.operations.runs.repeated_runs import are_known, runs_before, with_earlier_decisions
from processing.operations.runs.run_comparison import compare_runs, keep_run, runs_to_compare
from processing.project.project import Project
from processing.project.results.found_features import FoundFeatures
from processing.tools.tool import CandidateResult
from tests.processing.project.candidates import found, line
from tests.processing.project.drawn import new_project

LABEL = Text("Edit", "編集")
APART = (0, 10, 20, 30)


@pytest.fixture
def project(tmp_path: Path) -> Iterator[Project]:
    made = Project.open(new_project(tmp_path / "p.zuka"))
    yield made
    made.close()


def lines(
    *positions: int, drives: tuple[str, ...] = ("left",), tool: str = "finder"
) -> FoundFeatures:
    """A run that finds lines of 2 m at these metres of the street."""
    made = found(
        CandidateResult(tuple(line(position, 0.5) for position in positions)), drive=drives[0]
    )
    return replace(made, run=replace(made.run, drives=drives, tool=tool))


def store(project: Project, made: FoundFeatures) -> FoundFeatures:
    """Put a run into the project as the window does."""
    new = with_earlier_decisions(made, project)
    if new.change.is_empty:
        project.runs.add(new.run)
    else:
        project.features.apply(new.run.summary, new.change, run=new.run)
    return new


def at(project: Project, position: int) -> Feature:
    """The feature that begins at this metre."""
    (only,) = (one for one in project.features.all() if one.vertices[0].xyz[0] == position)
    return only


def change(project: Project, before: Feature, after: Feature) -> None:
    project.features.apply(LABEL, Change(replaced=(Replacement(before, after),)))


def decide(project: Project, position: int, status: Status) -> Feature:
    feature = at(project, position)
    after = replace(feature, status=status)
    change(project, feature, after)
    return after


def positions(project: Project) -> list[float]:
    return sorted(one.vertices[0].xyz[0] for one in project.features.all())


def test_a_second_run_takes_the_place_of_what_was_undecided(project: Project) -> None:
    first = store(project, lines(*APART))
    second = store(project, lines(*APART))
    assert {one.provenance.run for one in project.features.all()} == {second.run.id}
    assert len(project.features) == len(APART)
    told = (
        "Curbs: 4 candidates; 4 earlier undecided ones were replaced: 4 found again, 0 new, 0 gone"
    )
    told_ja = "縁石: 候補4件（以前の未判定候補4件を置き換え: 同じ位置4件・新規0件・消失0件）"
    assert second.run.summary == Text(told, told_ja)
    assert project.history.undo_label == second.run.summary
    project.features.undo()
    assert {one.id for one in project.features.all()} == {one.id for one in first.change.added}


def test_what_was_decided_stays_and_is_not_proposed_again(project: Project) -> None:
    store(project, lines(*APART))
    kept = (
        decide(project, 0, Status.ACCEPTED),
        decide(project, 10, Status.REJECTED),
    )
    second = store(project, lines(*APART, 40))
    assert positions(project) == [0, 10, 20, 30, 40]
    assert {one.id for one in project.features.all()} >= {one.id for one in kept}
    assert second.run.summary.en == (
        "Curbs: 3 candidates; 2 earlier undecided ones were replaced: "
        "2 found again, 1 new, 0 gone, 2 places had been decided"
    )


def test_what_was_deleted_is_no_decision_and_is_proposed_again(project: Project) -> None:
    store(project, lines(0, 10))
    project.features.apply(LABEL, Change(removed=(at(project, 0),)))
    store(project, lines(0, 10))
    assert positions(project) == [0, 10]


def test_a_candidate_that_was_moved_by_hand_is_known_where_it_was_and_where_it_is(
    project: Project,
) -> None:
    store(project, lines(0, 10))
    before = at(project, 0)
    moved = before.with_vertices(
        tuple(Vertex((x, y + 3.0, z)) for x, y, z in (one.xyz for one in before.vertices))
    )
    change(project, before, moved)
    second = store(project, lines(0))
    assert [one.id for one in project.features.all()] == [before.id]
    assert second.run.summary.en == (
        "Curbs: nothing new; 1 earlier undecided one was replaced: "
        "0 found again, 0 new, 1 gone, 1 place had been decided"
    )
    third = store(project, lines(0))
    assert third.change.is_empty
    assert [run.id for run in project.runs.all()][-1] == third.run.id


def test_a_piece_that_was_cut_from_a_candidate_is_not_thrown_away(project: Project) -> None:
    store(project, lines(0))
    whole = at(project, 0)
    piece = replace(whole, id=new_feature_id(), vertices=whole.vertices[:2])
    project.features.apply(LABEL, Change(added=(piece,), removed=(whole,)))
    store(project, lines(10))
    assert piece.id in {one.id for one in project.features.all()}


def test_runs_of_other_tools_and_on_other_drives_are_left_alone(project: Project) -> None:
    store(project, lines(20, drives=("left", "right")))
    store(project, lines(0, tool="other"))
    store(project, lines(10, drives=("right",)))
    assert store(project, lines(0, 10, 20)).run.summary.en == "Curbs: 3 candidates"
    assert positions(project) == [0, 0, 10, 10, 20, 20]


def test_a_run_on_more_drives_replaces_that_on_fewer(project: Project) -> None:
    store(project, lines(0, drives=("left",)))
    store(project, lines(10, drives=("right",)))
    store(project, lines(20, drives=("right", "left", "middle")))
    assert positions(project) == [20]


def test_runs_that_looked_for_something_else_keep_their_candidates(project: Project) -> None:
    store(project, lines(0))
    made = lines(10)
    made = replace(made, tool=replace(made.tool, sought=("radius_m",)))
    other = replace(made, run=replace(made.run, parameters={"radius_m": 0.7}))
    store(project, other)
    assert positions(project) == [0, 10]
    store(project, lines(20))
    assert positions(project) == [20]


def feature(geometry: Geometry, *xyz: tuple[float, float, float], kind: str = "k") -> Feature:
    return Feature(new_feature_id(), kind, geometry, tuple(Vertex(one) for one in xyz))


def point(x: float, y: float, z: float, kind: str = "k") -> Feature:
    return feature(Geometry.POINT, (x, y, z), kind=kind)


def straight(start: float, end: float, y: float = 0.0, z: float = 0.0) -> Feature:
    return feature(Geometry.LINE, (start, y, z), (end, y, z))


def square(x: float, side: float = 1.0, z: float = 0.0) -> Feature:
    corners = ((x, 0.0), (x + side, 0.0), (x + side, side), (x, side))
    return feature(Geometry.AREA, *((a, b, z) for a, b in corners))


def upright(x: float, y: float = 0.0) -> Feature:
    """A wall of 1 m, which has no area in plan."""
    return feature(Geometry.AREA, (x, y, 0.0), (x + 1, y, 0.0), (x + 1, y, 1.0), (x, y, 1.0))


@pytest.mark.parametrize(
    ("new", "decided", "is_known"),
    [
        (point(0, 0, 0), point(0.3, 0, 0.3), True),
        (point(0, 0, 0), point(0.6, 0, 0), False),
        (point(0, 0, 0), point(0, 0, 0.7), False),  # the other plate of a post
        (point(0, 0, 0), point(0, 0, 0, "other"), False),
        (point(0, 0, 0, "mirror"), point(0.1, 0, 0, "pole"), True),  # found as a pole once
        (point(0, 0, 0, "pole"), point(0.1, 0, 0, "mirror"), True),
        (point(0, 0, 0, "sign"), point(0.1, 0, 0, "pole"), False),
        (straight(0, 10), straight(0, 10, 0.1), True),
        (straight(0, 10), straight(0, 10, 0.3), False),
        (straight(0, 10), straight(0, 10, 0.0, 0.4), False),  # the wire above
        (straight(0, 10), straight(4, 30), True),
        (straight(0, 10), straight(6, 30), False),
        (square(0), square(0.3), True),
        (square(0), square(0.6), False),
        (square(0), square(1.0), False),  # the next lid
        (square(0), square(-5, 10), True),
        (square(0), square(0, z=5.0), False),  # on the bridge
        (upright(0), upright(0.1), True),
        (upright(0), upright(0, 1.0), False),
        (point(0, 0, 0), straight(0, 1), False),
    ],
)
def test_the_same_is_what_may_be_one_thing_at_one_place(
    new: Feature, decided: Feature, is_known: bool
) -> None:
    assert are_known([new], [decided]) == [is_known]


def test_a_line_is_known_when_several_decided_ones_cover_it_together() -> None:
    decided = [straight(0, 3), straight(5, 9)]
    assert are_known([straight(0, 10), straight(20, 30)], decided) == [True, False]


def test_nothing_is_known_where_nothing_was_decided() -> None:
    assert are_known([point(0, 0, 0), square(0)], []) == [False, False]
    assert are_known([], [point(0, 0, 0)]) == []


def test_ten_thousand_candidates_are_told_from_ten_thousand_decided() -> None:
    xs = np.arange(10_000) * 2.0
    new, decided = ([square(float(x) + off) for x in xs] for off in (0.1, 0.0))
    assert are_known(new, decided[::2]) == [n % 2 == 0 for n in range(len(xs))]


def test_a_run_is_not_asked_for_what_was_decided_before_it(project: Project) -> None:
    first = store(project, lines(0)).run
    elsewhere = store(project, lines(0, drives=("right",))).run
    second = store(project, lines(10, drives=("left", "middle"))).run
    runs = project.runs.all()
    assert runs_before(second, runs) == (first,)
    assert runs_before(first, runs) == runs_before(elsewhere, runs) == ()


def test_a_second_run_tells_what_it_found_again_what_is_new_and_what_is_gone(
    project: Project,
) -> None:
    store(project, lines(0, 10, 20))
    second = store(project, lines(0, 10, 50, 60))
    assert "2 found again, 2 new, 1 gone" in second.run.summary.en


def test_two_runs_are_held_against_each_other_whatever_became_of_their_candidates(
    project: Project,
) -> None:
    first = store(project, lines(0, 10, 20)).run
    second = store(project, lines(0, 10, 50, 60)).run
    assert [run.id for run in runs_to_compare(project, second.id)] == [second.id, first.id]
    former, latter = compare_runs(project, first, second)
    assert former.in_both == (True, True, False)
    assert latter.in_both == (True, True, False, False)


def test_the_former_run_is_kept_and_the_latter_comes_back_as_one_step_each(
    project: Project,
) -> None:
    first = store(project, lines(0, 10, 20)).run
    second = store(project, lines(0, 10, 50)).run
    project.features.apply(LABEL, keep_run(project, first))
    assert positions(project) == [0, 10, 20]
    assert {one.provenance.run for one in project.features.all()} == {first.id}
    project.features.undo()
    assert {one.provenance.run for one in project.features.all()} == {second.id}
    project.features.redo()
    project.features.apply(LABEL, keep_run(project, second))
    assert positions(project) == [0, 10, 50]


def test_what_was_decided_meanwhile_stays_when_another_run_is_kept(project: Project) -> None:
    first = store(project, lines(0, 10, 20)).run
    store(project, lines(0, 10, 50))
    kept = decide(project, 10, Status.ACCEPTED)
    decide(project, 50, Status.REJECTED)
    project.features.apply(LABEL, keep_run(project, first))
    assert positions(project) == [0, 10, 20, 50]
    assert at(project, 10) == kept
    assert keep_run(project, first).is_empty

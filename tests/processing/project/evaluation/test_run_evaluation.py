"""Precision, recall and corrections of runs whose truth is known."""

from __future__ import annotations

import csv
import math
from dataclasses import replace
from pathlib import Path

import pytest

from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Position, Status, Vertex
from processing.project.evaluation.evaluation_table import write_evaluation
from processing.project.evaluation.run_evaluation import evaluate_runs
from processing.recording.drive import Drive
from tests.processing.image.recordings import small_drive
from tests.processing.project.candidates import found_lines


@pytest.fixture
def drive(tmp_path: Path) -> Drive:
    return small_drive(tmp_path / "d")[0]


def by_hand(id: str, *positions: Position, kind: str = "curb_lower") -> Feature:
    return Feature(id, kind, Geometry.LINE, tuple(map(Vertex, positions)))


def within(drive: Drive) -> tuple[Position, Position]:
    """A line of 3 m that begins in the middle of the drive."""
    low, high = drive.info.lowest, drive.info.highest
    x, y, z = ((a + b) / 2 for a, b in zip(low, high, strict=True))
    return (x, y, z), (x, y, z + 3.0)


def moved(feature: Feature, by_m: float) -> Feature:
    return feature.with_vertices(
        tuple(replace(v, xyz=(v.xyz[0], v.xyz[1], v.xyz[2] + by_m)) for v in feature.vertices)
    )


def test_a_run_is_evaluated_by_what_was_decided_and_drawn(drive: Drive) -> None:
    made = found_lines(20, drive=drive.id)
    originals = {one.id: one for one in made.change.added}
    judged = [
        replace(one, status=Status.ACCEPTED if n < 12 else Status.REJECTED)
        for n, one in enumerate(made.change.added[:16])
    ]
    judged[0] = moved(judged[0], 0.10)
    judged[1] = moved(judged[1], 0.20)
    judged[2] = replace(judged[2], attributes={"height_m": 0.2})
    judged[15] = moved(judged[15], 1.0)  # moved, then rejected all the same
    drawn = [
        by_hand("missed", *within(drive)),
        by_hand("elsewhere", (1e6, 1e6, 0.0), (1e6, 1e6, 1.0)),
        by_hand("other kind", *within(drive), kind="gutter_open"),
        replace(by_hand("refused", *within(drive)), status=Status.REJECTED),
    ]
    features = [*judged, *made.change.added[16:], *drawn]
    (found,) = evaluate_runs(features, [made.run], [drive], originals)
    assert (found.undecided, found.accepted, found.rejected) == (4, 12, 4)
    assert found.precision.value == 12 / 16
    assert found.drawn == 1
    assert found.recall.value == 12 / 13
    assert found.recall_by_length.value == pytest.approx(24 / 27)
    assert found.corrected == 3
    assert found.shift_m == pytest.approx(0.15)
    assert sum(one.accepted.of for one in found.reliability.bins) == 16
    assert found.is_whole_tool


def test_what_was_accepted_for_its_confidence_is_found_but_says_nothing_of_precision(
    drive: Drive,
) -> None:
    made = found_lines(10, drive=drive.id)
    originals = {one.id: one for one in made.change.added}
    lines = made.change.added
    judged = [
        *(one.with_status(Status.ACCEPTED, unseen=True) for one in lines[:6]),
        *(one.with_status(Status.ACCEPTED) for one in lines[6:8]),
        *(one.with_status(Status.REJECTED) for one in lines[8:]),
        by_hand("missed", *within(drive)),
        by_hand("missed too", *within(drive)),
    ]
    (found,) = evaluate_runs(judged, [made.run], [drive], originals)
    assert (found.undecided, found.accepted, found.rejected) == (6, 2, 2)
    assert found.precision.value == 0.5
    assert found.recall.value == 8 / 10
    assert sum(one.accepted.of for one in found.reliability.bins) == 4


def test_several_runs_of_a_tool_are_evaluated_together_and_one_by_one(drive: Drive) -> None:
    first, second = found_lines(4, drive=drive.id), found_lines(6, seed=2, drive=drive.id)
    features = [
        *(replace(one, status=Status.ACCEPTED) for one in first.change.added),
        *(replace(one, status=Status.REJECTED) for one in second.change.added),
    ]
    whole, one, other = evaluate_runs(features, [first.run, second.run], [drive], {})
    assert whole.runs == (first.run.id, second.run.id)
    assert whole.is_whole_tool
    assert (whole.precision.value, one.precision.value, other.precision.value) == (0.4, 1.0, 0.0)
    assert not one.is_whole_tool


def test_what_was_drawn_is_asked_of_all_drives_together_only_once(drive: Drive) -> None:
    runs = [found_lines(2, drive=drive.id), found_lines(2, seed=3, drive=drive.id)]
    features = [
        *(replace(one, status=Status.ACCEPTED) for run in runs for one in run.change.added),
        by_hand("missed", *within(drive)),
    ]
    whole, *_ = evaluate_runs(features, [run.run for run in runs], [drive], {})
    assert whole.recall.value == 4 / 5


def test_a_run_whose_candidates_are_gone_is_not_listed(drive: Drive) -> None:
    assert evaluate_runs([], [found_lines(3).run], [drive], {}) == ()


def test_a_run_that_nobody_has_judged_has_no_precision(drive: Drive) -> None:
    made = found_lines(3)
    (found,) = evaluate_runs(made.change.added, [made.run], [drive], {})
    assert math.isnan(found.precision.value)
    assert math.isnan(found.reliability.calibration_error)


def test_the_table_has_every_number_and_blanks_where_there_is_none(
    drive: Drive, tmp_path: Path
) -> None:
    made = found_lines(4)
    features = [
        *(replace(one, status=Status.ACCEPTED) for one in made.change.added[:3]),
        replace(made.change.added[3], status=Status.REJECTED),
    ]
    path = tmp_path / "評価.csv"
    write_evaluation(path, evaluate_runs(features, [made.run], [drive], {}))
    with path.open(encoding="utf-8-sig", newline="") as file:
        (row,) = csv.DictReader(file)
    assert row["tool"] == "finder"
    assert float(row["precision"]) == 0.75
    assert float(row["precision_low"]) < 0.75 < float(row["precision_high"])
    assert row["mean_shift_m"] == ""
    assert sum(int(row[f"decided_{n / 10:g}"]) for n in range(10)) == 4


def test_a_table_without_runs_is_a_table(tmp_path: Path) -> None:
    write_evaluation(tmp_path / "a.csv", ())
    assert (tmp_path / "a.csv").read_text("utf-8-sig").strip() == "tool"

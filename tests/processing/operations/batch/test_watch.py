"""A delivery is worked on once it is whole, and only then."""

from __future__ import annotations

from pathlib import Path

import pytest

from processing.core.errors import Cancelled
from processing.core.monitor import SilentMonitor
from processing.operations.batch.batch import BatchOperation, BatchOutcome
from processing.operations.batch.job import read_job
from processing.operations.batch.watch import Arrivals, watch
from tests.processing.operations.batch.job_files import HEAD, IMPORT, deliver, write_job


def arrivals_of(folder: Path, settings: str) -> Arrivals:
    return Arrivals(read_job(write_job(folder, settings + HEAD + IMPORT)))


def names(arrivals: Arrivals, now_s: float) -> list[str]:
    return [one.name for one in arrivals.whole(now_s)]


def test_a_delivery_is_whole_when_nothing_of_it_has_changed_for_a_while(tmp_path: Path) -> None:
    arrivals = arrivals_of(tmp_path, "settled_s = 60.0\n")
    assert names(arrivals, 0.0) == []
    deliver(tmp_path, ["a"])
    assert names(arrivals, 10.0) == []
    assert names(arrivals, 69.0) == []
    (tmp_path / "drives" / "a" / "path.csv").write_text("time_s", encoding="utf-8")
    assert names(arrivals, 71.0) == []
    assert names(arrivals, 130.0) == []
    assert names(arrivals, 131.0) == ["a"]


def test_an_empty_folder_is_no_delivery_yet(tmp_path: Path) -> None:
    arrivals = arrivals_of(tmp_path, "settled_s = 1.0\n")
    (tmp_path / "drives" / "a").mkdir(parents=True)
    assert names(arrivals, 0.0) == names(arrivals, 9.0) == []


def test_a_marker_says_that_a_delivery_is_whole(tmp_path: Path) -> None:
    arrivals = arrivals_of(tmp_path, 'marker = "DONE"\n')
    deliver(tmp_path, ["a", "b"])
    assert names(arrivals, 0.0) == names(arrivals, 999.0) == []
    (tmp_path / "drives" / "b" / "DONE").touch()
    assert names(arrivals, 1_000.0) == ["b"]


def test_what_has_arrived_is_worked_on_and_told_once(tmp_path: Path) -> None:
    deliver(tmp_path, ["a", "b"])
    (tmp_path / "drives" / "b" / "DONE").touch()
    path = write_job(tmp_path, 'marker = "DONE"\n' + HEAD + IMPORT)
    told: list[BatchOutcome] = []

    class UntilTold(SilentMonitor):
        def check(self) -> None:
            if told:
                raise Cancelled

    with pytest.raises(Cancelled):
        watch(BatchOperation(path), UntilTold(), told.append)
    (outcome,) = told
    assert [(row.state.name, row.standing) for row in outcome.rows] == [("b", "done")]
    assert not (tmp_path / "out" / "a").exists()

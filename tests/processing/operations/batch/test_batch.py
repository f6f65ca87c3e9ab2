"""Jobs done by processes of their own, here and on a cluster: watched, killed, and gone on with."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from distributed import LocalCluster
from filelock import FileLock

from processing.core.errors import Cancelled, InUse, MissingInput
from processing.core.monitor import SilentMonitor
from processing.core.process_memory import children_of
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.operations.batch.batch import BatchOperation, BatchOutcome, run_batch
from processing.operations.batch.job_page import PAGE, STATUS
from processing.operations.batch.unit_state import read_progress
from tests.processing.operations.batch.job_files import (
    EXPORT,
    HEAD,
    IMPORT,
    NOISE,
    deliver,
    write_job,
)


class AtWork(SilentMonitor):
    """Does something once the first drive is at work."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.has_acted = False

    def check(self) -> None:
        if not self.has_acted and read_progress(self._folder).fraction > 0.0:
            self.has_acted = True
            self.act()

    def act(self) -> None:
        raise Cancelled


class Killing(AtWork):
    """Kills the process that works on the drive."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        self._before = set(children_of(os.getpid()))

    def act(self) -> None:
        for child in set(children_of(os.getpid())) - self._before:
            os.kill(child, signal.SIGKILL)


def standings(outcome: BatchOutcome) -> dict[str, str]:
    return {row.state.name: row.standing for row in outcome.rows}


def noise_of(folder: Path) -> dict[str, bytes]:
    return {path.parent.name: path.read_bytes() for path in sorted(folder.glob("*/noise.las"))}


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, BatchOutcome]:
    """A job of three drives, one of them damaged, done here; and what came of it."""
    folder = tmp_path_factory.mktemp("street")
    deliver(folder, ["a", "b", "北 1"])
    (folder / "drives" / "b" / "cloud.las").write_bytes(b"LASF and no more")
    path = write_job(folder, HEAD + IMPORT + NOISE)
    return path, run_batch(BatchOperation(path), SilentMonitor())


@pytest.fixture(scope="module")
def cluster() -> Iterator[LocalCluster]:
    """A scheduler with a worker, in this process."""
    with LocalCluster(
        n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
    ) as made:
        yield made


def test_a_drive_that_fails_fails_alone_and_is_told_by_name(
    street: tuple[Path, BatchOutcome],
) -> None:
    path, outcome = street
    assert standings(outcome) == {"a": "done", "b": "failed", "北 1": "done"}
    (error,) = outcome.errors
    assert error.where.en.startswith("b: ")
    assert "cloud.las" in error.where.en
    assert not outcome.has_defect
    status = json.loads((path.parent / "out" / STATUS).read_text(encoding="utf-8"))
    assert [one["state"] for one in status["drives"]] == ["done", "failed", "done"]
    assert status["drives"][0]["peak_memory_bytes"] > 0
    page = (path.parent / "out" / PAGE).read_text(encoding="utf-8")
    assert "北 1" in page
    assert "refresh" not in page


def test_the_index_map_shows_where_drives_lie_and_how_they_stand(
    street: tuple[Path, BatchOutcome],
) -> None:
    path, _ = street
    text = (path.parent / "out" / "index_map.geojson").read_text(encoding="utf-8")
    features = json.loads(text)["features"]
    assert [one["properties"]["delivery"] for one in features] == ["a", "北 1"]
    assert features[1]["properties"]["points"] == 302
    assert features[1]["properties"]["project"] == "北 1/北 1.zuka"
    assert "EPSG:6677" in read_mapped(path.parent / "out" / "index_map.gpkg").crs


def test_the_next_run_does_only_what_is_left(street: tuple[Path, BatchOutcome]) -> None:
    path, _ = street
    before = {one: one.stat().st_mtime_ns for one in path.parent.glob("out/*/state.json")}
    again = run_batch(BatchOperation(path), SilentMonitor())
    after = {one: one.stat().st_mtime_ns for one in path.parent.glob("out/*/state.json")}
    assert standings(again)["b"] == "failed"
    assert {one.parent.name for one in after if after[one] != before[one]} == {"b"}


def test_a_process_that_is_killed_is_started_again(tmp_path: Path) -> None:
    deliver(tmp_path, ["a"])
    monitor = Killing(tmp_path / "out" / "a")
    outcome = run_batch(BatchOperation(write_job(tmp_path)), monitor)
    assert monitor.has_acted
    assert standings(outcome) == {"a": "done"}


def test_a_stopped_job_leaves_no_process_and_goes_on_later(tmp_path: Path) -> None:
    deliver(tmp_path, ["a", "b"])
    operation = BatchOperation(write_job(tmp_path))
    before = set(children_of(os.getpid()))  # other tests' pools keep helpers of their own
    with pytest.raises(Cancelled):
        run_batch(operation, AtWork(tmp_path / "out" / "a"))
    assert set(children_of(os.getpid())) <= before
    status = json.loads((tmp_path / "out" / STATUS).read_text(encoding="utf-8"))
    # On a busy machine a drive may be done before the job hears of its beginning.
    assert {one["state"] for one in status["drives"]} <= {"stopped", "done"}
    assert standings(run_batch(operation, SilentMonitor())) == {"a": "done", "b": "done"}


def test_a_drive_that_takes_too_much_memory_is_ended_and_told(tmp_path: Path) -> None:
    deliver(tmp_path, ["a"])
    path = write_job(tmp_path, "memory_gib = 0.001\n" + HEAD + IMPORT)
    outcome = run_batch(BatchOperation(path), SilentMonitor())
    (error,) = outcome.errors
    assert "more memory" in error.what.en
    path.write_text(HEAD + IMPORT, encoding="utf-8")
    assert standings(run_batch(BatchOperation(path), SilentMonitor())) == {"a": "done"}


def test_a_job_that_is_being_done_is_not_begun_twice(tmp_path: Path) -> None:
    deliver(tmp_path, ["a"])
    path = write_job(tmp_path)
    (tmp_path / "out").mkdir()
    with (
        FileLock(tmp_path / "out" / ".batch-lock"),
        pytest.raises(InUse, match="being done already"),
    ):
        run_batch(BatchOperation(path), SilentMonitor())


def test_a_cluster_gives_the_same_to_the_byte(
    street: tuple[Path, BatchOutcome], cluster: LocalCluster, tmp_path: Path
) -> None:
    path, _ = street
    text = path.read_text(encoding="utf-8").replace('"out"', f'"{tmp_path.as_posix()}"')
    (path.parent / "cluster.toml").write_text(text, encoding="utf-8")
    operation = BatchOperation(path.parent / "cluster.toml", cluster.scheduler_address)
    outcome = run_batch(operation, SilentMonitor())
    assert standings(outcome) == {"a": "done", "b": "failed", "北 1": "done"}
    assert noise_of(tmp_path) == noise_of(path.parent / "out")
    assert len(noise_of(tmp_path)) == 2


def test_a_scheduler_that_does_not_answer_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from processing.operations.batch import cluster

    monkeypatch.setattr(cluster, "_TIMEOUT_S", 0.5)
    deliver(tmp_path, ["a"])
    path = write_job(tmp_path, HEAD + IMPORT + NOISE + EXPORT)
    with pytest.raises(MissingInput, match=r"tcp://127\.0\.0\.1:9"):
        run_batch(BatchOperation(path, "tcp://127.0.0.1:9"), SilentMonitor())

"""Values come back in the order of the delivered files, whatever order the recording has."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.core.monitor import SilentMonitor
from processing.core.owned_files import make_marked
from processing.core.scratch_folder import scratch_folder
from processing.project.results.delivered_order import DeliveredOrder, Values
from processing.recording.columns.columns import ColumnWriter
from processing.recording.columns.source_order import SourceRun
from processing.recording.drive import Drive
from processing.recording.drive_info import SourceFile, read_drive_info, write_drive_info
from tests.processing.image.recordings import small_drive


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return small_drive(tmp_path_factory.mktemp("made") / "d", 3)[0]


def delivered_as(drive: Drive, files: np.ndarray, indices: np.ndarray) -> Drive:
    """The same recording, its points delivered at these places, in runs if they are few."""
    starts = np.append(0, np.flatnonzero((np.diff(files) != 0) | (np.diff(indices) != 1)) + 1)
    runs: tuple[SourceRun, ...] = ()
    if starts.size < 100:
        runs = tuple(
            SourceRun(int(start), int(count), int(files[start]), int(indices[start]))
            for start, count in zip(starts, np.diff(np.append(starts, files.size)), strict=True)
        )
    else:
        with ColumnWriter(drive.folder) as writer:
            writer.append({"source_file": files, "source_index": indices})
    sources = tuple(
        SourceFile(f"/delivered/{number}.laz", 1, 1, "", int((files == number).sum()))
        for number in range(int(files.max()) + 1)
    )
    info = dataclasses.replace(read_drive_info(drive.folder), sources=sources, source_runs=runs)
    write_drive_info(drive.folder, info)
    return Drive(drive.folder)


def numbers_of(drive: Drive, start: int, stop: int) -> Values:
    numbers = np.arange(start, stop)
    return {"number": numbers.astype(np.int32), "pair": np.stack([numbers % 251, numbers % 7], 1)}


def assert_in_order(drive: Drive, files: np.ndarray, indices: np.ndarray, step: int) -> None:
    with scratch_folder(drive.folder.parent) as scratch:
        order = DeliveredOrder([drive], numbers_of, scratch, part_points=3_001)
        order.prepare(SilentMonitor())
        for number, source in enumerate(drive.info.sources):
            count = int(indices[files == number].max(initial=-1)) + 1
            wanted = np.zeros(count, np.int64)
            wanted[indices[files == number]] = np.flatnonzero(files == number)
            parts = [
                order.values(Path(source.path), start, min(start + step, count))
                for start in range(0, count, step)
            ]
            if parts:
                found = np.concatenate([part["number"] for part in parts])
                np.testing.assert_array_equal(found, wanted)
                pairs = np.concatenate([part["pair"] for part in parts])
                np.testing.assert_array_equal(pairs[:, 0], wanted % 251)
    assert not list(drive.folder.parent.glob(".zuka-*"))


@given(
    sizes=st.lists(st.integers(1, 9_000), min_size=1, max_size=4),
    shuffled=st.sampled_from(["not", "files", "near", "all"]),
    step=st.integers(700, 20_000),
    seed=st.integers(0, 99),
)
@settings(max_examples=25)
def test_any_order_is_restored(
    made: Drive,
    sizes: list[int],
    shuffled: str,
    step: int,
    seed: int,
) -> None:
    ends = np.minimum(np.cumsum(sizes), made.count)
    files = np.searchsorted(ends, np.arange(made.count), "right") % (len(sizes) + 1)
    indices = np.empty(made.count, np.int64)
    for number in range(int(files.max()) + 1):
        indices[files == number] = np.arange((files == number).sum())
    random = np.random.default_rng(seed)
    order = {
        "not": np.arange(made.count),
        "files": np.argsort(random.permutation(int(files.max()) + 1)[files], kind="stable"),
        "near": np.argsort(np.arange(made.count) + random.normal(0, 40, made.count)),
        "all": random.permutation(made.count),
    }[shuffled]
    files, indices = files[order], indices[order]
    drive = delivered_as(made, files, indices)
    assert bool(drive.info.source_runs) == (shuffled in ("not", "files"))
    assert_in_order(drive, files, indices, step)


def test_points_that_no_drive_has_are_zero(made: Drive) -> None:
    """A file may have points of a scanner whose drive isn't there any more."""
    for spread in (1, 3):
        indices = np.arange(made.count) * spread + 5
        drive = delivered_as(made, np.zeros(made.count, np.int64), indices)
        with scratch_folder(drive.folder.parent) as scratch:
            order = DeliveredOrder([drive], numbers_of, scratch)
            order.prepare(SilentMonitor())
            found = order.values(Path("/delivered/0.laz"), 0, 5 + 3 * spread)["number"]
        assert found[:5].tolist() == [0] * 5
        assert found[5::spread].tolist() == [0, 1, 2]
        assert not order.values(Path("/delivered/other.laz"), 0, 3)["number"].any()


def test_what_a_killed_program_left_goes_and_what_is_in_use_stays(tmp_path: Path) -> None:
    left = tmp_path / ".zuka-left"
    make_marked(left)
    with ColumnWriter(left) as writer:
        writer.append({"segment": np.arange(5)})
    with scratch_folder(tmp_path) as one:
        assert not left.exists()
        with scratch_folder(tmp_path) as other:
            assert one.is_dir()
            assert other != one
        assert one.is_dir()
    assert list(tmp_path.iterdir()) == []

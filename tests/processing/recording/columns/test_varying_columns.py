"""Each point has its own values, as many as it has, in whatever order and piece they are read."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from processing.core.errors import BadFile, MissingInput
from processing.core.monitor import SilentMonitor
from processing.project.importing import part_joining
from processing.recording.columns import ordering, varying_columns
from processing.recording.columns.columns import Columns, ColumnWriter
from processing.recording.columns.ordering import sort_points
from processing.recording.columns.replacing import (
    finish_replacing,
    new_columns,
    replace_columns,
)
from processing.recording.columns.varying_columns import (
    VaryingColumn,
    VaryingValues,
    VaryingWriter,
    starts_path,
    values_path,
    varying_names,
)
from processing.recording.drive import Drive
from processing.recording.drive_part import write_part
from tests.widgets.builders import imported_drive

NAME, TYPE = "waveform", "<u2"
Row = list[int]
ROWS = st.lists(st.lists(st.integers(0, 65535), max_size=5), max_size=40)


@contextmanager
def new_folder() -> Iterator[Path]:
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder)


def values_of(rows: list[Row]) -> VaryingValues:
    return VaryingValues.of([np.array(row, TYPE) for row in rows], TYPE)


def rows_of(found: VaryingValues) -> list[Row]:
    assert found.starts[0] == 0
    assert found.starts[-1] == found.values.size
    return [found[point].tolist() for point in range(found.count)]


def write(folder: Path, *parts: list[Row], first: int = 0) -> None:
    with VaryingWriter(folder, first) as writer:
        for part in parts:
            writer.append({NAME: values_of(part)})


def all_rows(folder: Path, count: int) -> list[Row]:
    return rows_of(VaryingColumn(folder, NAME, count).between(0, count))


@given(parts=st.lists(ROWS, min_size=1, max_size=5), data=st.data())
def test_what_is_appended_is_read_by_stretches_and_by_lists(
    parts: list[list[Row]], data: st.DataObject
) -> None:
    rows = [row for part in parts for row in part]
    with new_folder() as folder:
        write(folder, *parts)
        assert varying_names(folder) == (NAME,)
        column = Columns(folder, len(rows)).varying(NAME)
        start = data.draw(st.integers(0, len(rows)))
        stop = data.draw(st.integers(start, len(rows)))
        assert rows_of(column.between(start, stop)) == rows[start:stop]
        points = data.draw(st.lists(st.sampled_from(range(len(rows) or 1)), max_size=60))
        points = points if rows else []
        found = column.of(np.array(points, np.int64))
        assert rows_of(found) == [rows[point] for point in points]
        assert found.values.dtype == np.dtype(TYPE)


@given(rows=ROWS, at_once=st.integers(1, 12), data=st.data())
def test_pieces_are_no_larger_than_they_should_be(
    rows: list[Row], at_once: int, data: st.DataObject
) -> None:
    points = data.draw(st.permutations(range(len(rows))))
    with new_folder() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr(varying_columns, "VALUES_AT_ONCE", at_once)
        write(folder, rows)
        column = VaryingColumn(folder, NAME, len(rows))
        pieces = list(column.pieces(np.array(points, np.int64)))
        assert [row for one in pieces for row in rows_of(one)] == [rows[one] for one in points]
        assert all(one.count == 1 or one.values.size <= at_once for one in pieces)
        assert [one.count for one in column.pieces(slice(0, 0))] == [0]
        in_order = [row for one in column.pieces(slice(0, len(rows))) for row in rows_of(one)]
        assert in_order == rows


@given(rows=ROWS, more=ROWS, left=ROWS)
def test_a_killed_work_goes_on_from_the_points_that_count(
    rows: list[Row], more: list[Row], left: list[Row]
) -> None:
    with new_folder() as folder:
        write(folder, rows, left)
        write(folder, more, first=len(rows))
        assert all_rows(folder, len(rows) + len(more)) == rows + more
    with new_folder() as folder:
        # A column that only later points have: those before have no values.
        write(folder, more, first=len(rows))
        assert all_rows(folder, len(rows) + len(more)) == [[] for _ in rows] + more


@given(rows=ROWS, points_at_once=st.integers(1, 50), data=st.data())
def test_points_are_put_in_order_with_their_values(
    rows: list[Row], points_at_once: int, data: st.DataObject
) -> None:
    keys = data.draw(st.lists(st.integers(0, 9), min_size=len(rows), max_size=len(rows)))
    time = np.array(keys, np.float64)
    with new_folder() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr(ordering, "POINTS_AT_ONCE", max(4, points_at_once))
        patch.setattr(varying_columns, "VALUES_AT_ONCE", 7)
        with ColumnWriter(folder) as writer:
            writer.append({"time": time, "source_index": np.arange(time.size)})
        write(folder, rows)
        sort_points(
            folder,
            ("time", "source_index"),
            time.size,
            lambda columns: (columns["time"], np.zeros(columns["time"].size)),
            SilentMonitor(),
        )
        order = np.argsort(time, kind="stable")
        assert all_rows(folder, time.size) == [rows[point] for point in order]
        assert Columns(folder, time.size)["source_index"].tolist() == order.tolist()
        names = ["source_index.bin", "time.bin", f"{NAME}.bin", f"{NAME}.starts.bin"]
        assert sorted(path.name for path in folder.iterdir()) == names


def test_a_kill_while_replacing_leaves_the_old_column_or_the_new_one(tmp_path: Path) -> None:
    old: list[Row] = [[1, 2], [], [3]]
    new: list[Row] = [[], [9, 8, 7], [6]]
    write(tmp_path, old)
    write(new_columns(tmp_path), new)
    assert all_rows(tmp_path, 3) == old
    assert not finish_replacing(tmp_path)
    # Killed after one of the two files was moved.
    (tmp_path / "unfinished").rename(tmp_path / "whole")
    values_path(tmp_path / "whole", NAME).replace(values_path(tmp_path, NAME))
    assert finish_replacing(tmp_path)
    assert all_rows(tmp_path, 3) == new
    write(new_columns(tmp_path), old)
    replace_columns(tmp_path)
    assert all_rows(tmp_path, 3) == old


@given(
    rows=st.lists(st.lists(st.integers(0, 9), min_size=1, max_size=4), min_size=2, max_size=20),
    wrong=st.sampled_from([-1, 10**6, -(2**63), 2**63 - 1]),
    data=st.data(),
)
def test_damaged_starts_are_refused_where_they_are_used(
    rows: list[Row], wrong: int, data: st.DataObject
) -> None:
    with new_folder() as folder:
        write(folder, rows)
        at = data.draw(st.integers(0, len(rows)))
        starts = np.fromfile(starts_path(folder, NAME), "<i8")
        starts[at] = wrong
        starts.tofile(starts_path(folder, NAME))
        with pytest.raises(BadFile, match=r"starts\.bin"):
            all_rows(folder, len(rows))
        with pytest.raises(BadFile, match=r"starts\.bin"):
            VaryingColumn(folder, NAME, len(rows)).of(np.arange(len(rows)))


def test_starts_that_fall_are_refused(tmp_path: Path) -> None:
    write(tmp_path, [[1, 2], [3], [4, 5]])
    np.array([0, 3, 2, 5]).astype("<i8").tofile(starts_path(tmp_path, NAME))
    column = VaryingColumn(tmp_path, NAME, 3)
    assert rows_of(column.between(0, 1)) == [[1, 2, 3]]
    for read in (lambda: column.between(0, 3), lambda: column.of(np.array([1]))):
        with pytest.raises(BadFile, match="1"):
            read()


@pytest.mark.parametrize("cut", [0, 3, 8, 16])
def test_files_of_a_wrong_length_are_refused(tmp_path: Path, cut: int) -> None:
    write(tmp_path, [[1, 2], [3], [4, 5]])
    path = starts_path(tmp_path, NAME)
    path.write_bytes(path.read_bytes()[:cut])
    with pytest.raises(BadFile):
        VaryingColumn(tmp_path, NAME, 3)
    with pytest.raises(BadFile):
        VaryingWriter(tmp_path, 3).append({NAME: values_of([[1]])})
    write(tmp_path, [[1, 2], [3], [4, 5]])
    path = values_path(tmp_path, NAME)
    path.write_bytes(path.read_bytes()[:5])
    with pytest.raises(BadFile):
        VaryingColumn(tmp_path, NAME, 3)
    path.unlink()
    with pytest.raises(MissingInput):
        VaryingColumn(tmp_path, NAME, 3)


@pytest.mark.parametrize("has", [(True, True), (True, False), (False, True), (False, False)])
def test_parts_are_joined_whichever_of_them_has_values(
    tmp_path: Path, has: tuple[bool, bool]
) -> None:
    folders, rows = (tmp_path / "0", tmp_path / "1"), ([[1], [2, 3]], [[4, 5], [], [6]])
    for folder, part, is_there in zip(folders, rows, has, strict=True):
        folder.mkdir()
        if is_there:
            write(folder, part)
    for _ in range(2):  # killed before it was noted, it is done again
        part_joining._append_varying(folders[1], folders[0], (2, 3), SilentMonitor())
    if any(has):
        wanted = [
            row if is_there else []
            for part, is_there in zip(rows, has, strict=True)
            for row in part
        ]
        assert all_rows(folders[0], 5) == wanted
    else:
        assert varying_names(folders[0]) == ()


def test_a_part_of_a_drive_keeps_the_values_of_its_points(tmp_path: Path) -> None:
    drive = imported_drive(tmp_path / "street")
    random = np.random.default_rng(4)
    rows = [random.integers(0, 99, size).tolist() for size in random.integers(0, 4, drive.count)]
    write(drive.folder, rows)

    def every_third(start: int, stop: int) -> NDArray[np.bool_]:
        return np.asarray(np.arange(start, stop) % 3 == 0)

    part = write_part(
        Drive(drive.folder),
        every_third,
        tmp_path / "part",
        SilentMonitor(),
        beside=lambda _start, _stop: {},
    )
    assert part.columns.has_varying(NAME)
    assert rows_of(part.columns.varying(NAME).between(0, part.count)) == rows[::3]

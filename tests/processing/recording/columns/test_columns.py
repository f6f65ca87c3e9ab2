"""Columns hold what was appended, refuse damaged files and are replaced whole."""

import threading

import numpy as np
import pytest

from processing.core.errors import BadFile, MissingInput
from processing.recording.columns.columns import Columns, ColumnWriter, column_path


def _folder_with_points(tmp_path, count=7):
    with ColumnWriter(tmp_path) as writer:
        for start in range(0, count, 3):
            stop = min(start + 3, count)
            numbers = np.arange(start, stop)
            writer.append({"xyz": np.stack([numbers] * 3, axis=1), "time": numbers / 4.0})
    return Columns(tmp_path, count)


def test_what_was_appended_in_parts_is_read_as_one_column(tmp_path):
    columns = _folder_with_points(tmp_path)
    assert columns["xyz"].dtype == np.int32
    assert columns["xyz"][:, 2].tolist() == list(range(7))
    assert columns["time"].tolist() == [n / 4.0 for n in range(7)]


def test_a_column_shorter_than_the_drive_is_refused_with_its_file(tmp_path):
    columns = _folder_with_points(tmp_path)
    path = column_path(tmp_path, "time")
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(BadFile) as refusal:
        columns["time"]
    assert str(path) in refusal.value.line("en")


def test_a_missing_column_is_said_to_be_missing(tmp_path):
    columns = _folder_with_points(tmp_path)
    assert not columns.has("intensity")
    with pytest.raises(MissingInput):
        columns["intensity"]


def test_a_tools_column_replaces_an_older_one_and_maps_in_use_stay_valid(tmp_path):
    columns = _folder_with_points(tmp_path)
    columns.add("segment", np.arange(7))
    older = columns["segment"]
    columns.add("segment", np.arange(7)[::-1])
    assert older.tolist() == list(range(7))
    assert columns["segment"].tolist() == list(range(6, -1, -1))
    assert not list(tmp_path.glob("*.part"))


def test_a_column_of_no_points_is_empty(tmp_path):
    column_path(tmp_path, "xyz").write_bytes(b"")
    assert Columns(tmp_path, 0)["xyz"].shape == (0, 3)


def test_a_column_that_is_replaced_while_another_thread_reads_is_the_new_one_for_both(tmp_path):
    """A view that looks at labels at the moment of an undo must not keep the old ones."""
    columns = Columns(tmp_path, 8)
    columns.add("label", np.zeros(8, np.uint8))
    is_over = threading.Event()

    def look() -> None:
        while not is_over.is_set():
            columns["label"].sum()

    reader = threading.Thread(target=look)
    reader.start()
    try:
        for code in range(1, 200):
            columns.add("label", np.full(8, code, np.uint8))
            assert columns["label"].tolist() == [code] * 8
    finally:
        is_over.set()
        reader.join()

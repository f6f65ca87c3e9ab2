"""What is read of columns does not stay in the process for ever."""

from __future__ import annotations

import gc
import threading
from pathlib import Path

import numpy as np
import pytest

from processing.recording.columns import mapped_pages
from processing.recording.columns.columns import Columns, ColumnWriter
from processing.recording.columns.mapped_pages import MappedPages

MEGABYTE = 2**20
LIMIT = 4 * MEGABYTE
COUNT = 3 * MEGABYTE  # of eight bytes each


@pytest.fixture
def columns(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Columns:
    """A column of 24 MB; whoever asks for it is looked after at once."""
    monkeypatch.setattr(mapped_pages, "_LOOKED_AT_EVERY_S", 0.0)
    with ColumnWriter(tmp_path) as writer:
        writer.append({"time": np.arange(COUNT, dtype=np.float64)})
    return Columns(tmp_path, COUNT, MappedPages(limit_bytes=LIMIT))


def held_bytes(folder: Path) -> int:
    """What the process holds of files in a folder."""
    held, is_inside = 0, False
    for line in Path("/proc/self/smaps").read_text(encoding="utf-8").splitlines():
        words = line.split()
        if "-" in words[0]:
            is_inside = str(folder) in line
        elif is_inside and words[0] == "Rss:":
            held += 1024 * int(words[1])
    return held


def test_a_column_that_is_read_from_end_to_end_holds_little_memory(
    columns: Columns, tmp_path: Path
) -> None:
    most = 0
    for start in range(0, COUNT, MEGABYTE // 8):
        part = columns["time"][start : start + MEGABYTE // 8]
        assert part.sum() > 0
        most = max(most, held_bytes(tmp_path))
    assert MEGABYTE < most < LIMIT + 3 * MEGABYTE


def test_values_handed_out_stay_true_when_their_pages_are_given_back(columns: Columns) -> None:
    early = columns["time"][10:20]
    for start in range(0, COUNT, MEGABYTE // 8):
        columns["time"][start : start + MEGABYTE // 8].sum()
    np.testing.assert_array_equal(early, np.arange(10, 20))
    np.testing.assert_array_equal(columns["time"][-3:], [COUNT - 3, COUNT - 2, COUNT - 1])


def test_a_column_can_be_read_but_not_written(columns: Columns) -> None:
    with pytest.raises(ValueError, match="read-only"):
        columns["time"][0] = 1.0


def test_a_map_that_nobody_has_any_more_is_no_longer_watched(tmp_path: Path) -> None:
    with ColumnWriter(tmp_path) as writer:
        writer.append({"time": np.zeros(5)})
    pages = MappedPages()
    columns = Columns(tmp_path, 5, pages)
    assert columns["time"].size == 5
    with columns.replacing("time"):
        pass
    gc.collect()
    assert not len(pages._maps)


def watching() -> list[threading.Thread]:
    return [thread for thread in threading.enumerate() if thread.name == "mapped pages"]


def test_one_thread_watches_all_maps_and_ends_with_the_last(tmp_path: Path) -> None:
    gc.collect()
    for thread in watching():  # those of maps that went with tests before
        thread.join(timeout=5.0)
    others = bool(watching())  # of a project that a fixture holds
    with ColumnWriter(tmp_path) as writer:
        writer.append({"time": np.zeros(5)})
    many = [Columns(tmp_path, 5, MappedPages()) for _ in range(8)]
    assert all(columns["time"].size == 5 for columns in many)
    (thread,) = watching()
    many.clear()
    gc.collect()
    thread.join(timeout=0.0 if others else 5.0)
    assert thread.is_alive() == others

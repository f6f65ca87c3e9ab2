"""Points are sorted without holding them all, stably, column by column."""

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.recording.columns import ordering
from processing.recording.columns.columns import Columns, ColumnWriter


def _by_time(columns):
    return columns["time"], np.zeros(columns["time"].size)


@pytest.mark.parametrize("points_at_once", [64, 1_000, 10_000])
def test_sorting_by_buckets_gives_the_order_of_a_stable_sort(tmp_path, monkeypatch, points_at_once):
    monkeypatch.setattr(ordering, "POINTS_AT_ONCE", points_at_once)
    random = np.random.default_rng(5)
    time = np.round(random.uniform(0, 50, 5_000), 1)  # many equal times
    index = np.arange(time.size)
    with ColumnWriter(tmp_path) as writer:
        writer.append({"time": time, "source_index": index})
    ordering.sort_points(tmp_path, ("time", "source_index"), time.size, _by_time, SilentMonitor())
    order = np.argsort(time, kind="stable")
    columns = Columns(tmp_path, time.size)
    assert (columns["time"] == time[order]).all()
    assert (columns["source_index"] == order).all()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["source_index.bin", "time.bin"]

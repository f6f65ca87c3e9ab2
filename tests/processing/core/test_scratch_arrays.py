"""Arrays in files for the time of a run."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from processing.core.scratch_arrays import nameless_array, scratch_array


def test_an_array_without_a_name_is_zeros_and_leaves_nothing(tmp_path: Path) -> None:
    made = nameless_array(tmp_path, np.float64, (7, 3))
    assert made.shape == (7, 3)
    assert not made.any()
    made[:] = np.arange(21.0).reshape(7, 3)
    assert made[6, 2] == 20.0
    assert list(tmp_path.iterdir()) == []
    assert nameless_array(tmp_path, np.int64, (0,)).size == 0


def test_an_array_by_name_lives_in_its_file(tmp_path: Path) -> None:
    made = scratch_array(tmp_path / "numbers", np.int32, 5)
    made[:] = 3
    made.flush()
    assert np.fromfile(tmp_path / "numbers", np.int32).tolist() == [3] * 5

"""Trees kept as ONNX give what they gave before."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.methods.noise.combined import (
    FIRST_LOOK,
    FIRST_LOOK_IN_SPACE,
    IN_SPACE,
    MODELS,
    WITH_BEAMS,
)
from processing.methods.noise.tree_files import read_trees, write_trees
from processing.methods.noise.trees import Trees, log_odds
from resources import path_of


@pytest.fixture
def trees() -> Trees:
    """A tree that asks column 1, then column 200, and one that is a single leaf."""
    return Trees(
        np.array([1, -1, 200, -1, -1, -1], np.int32),
        np.array([0.5, -1.25, -300.0, 2.0, 4.0, 0.25]),
        np.array([1, 1, 3, 3, 4, 5], np.int32),
        np.array([2, 1, 4, 3, 4, 5], np.int32),
        np.array([0, 5], np.int32),
        -0.5,
    )


def rows_of(*pairs: tuple[float, float]) -> np.ndarray:
    rows = np.zeros((len(pairs), 201), np.float32)
    rows[:, [1, 200]] = pairs
    return rows


def test_a_row_goes_left_up_to_the_threshold_and_right_above(trees: Trees) -> None:
    rows = rows_of((0.5, 0.0), (0.6, -300.0), (0.6, -299.0))
    assert log_odds(trees, rows, SilentMonitor()).tolist() == [-1.5, 1.75, 3.75]


def test_trees_come_back_from_a_file_as_they_were(trees: Trees, tmp_path: Path) -> None:
    write_trees(trees, tmp_path / "trees.onnx", 201)
    again = read_trees(tmp_path / "trees.onnx")
    assert again.base == trees.base
    for name in ("features", "thresholds", "roots"):
        np.testing.assert_array_equal(getattr(again, name), getattr(trees, name))
    is_branch = trees.features >= 0
    np.testing.assert_array_equal(again.lefts[is_branch], trees.lefts[is_branch])
    np.testing.assert_array_equal(again.rights[is_branch], trees.rights[is_branch])


def test_other_programs_read_the_same_from_the_file(trees: Trees, tmp_path: Path) -> None:
    import onnxruntime

    write_trees(trees, tmp_path / "trees.onnx", 201)
    session = onnxruntime.InferenceSession(tmp_path / "trees.onnx")
    rows = rows_of((0.5, 0.0), (0.6, -300.0), (0.6, -299.0))
    labels, shares = session.run(None, {"features": rows})
    odds = log_odds(trees, rows, SilentMonitor())
    assert labels.tolist() == (odds > 0).astype(int).tolist()
    np.testing.assert_allclose(shares[:, 1], 1 / (1 + np.exp(-odds)), atol=1e-6)


@pytest.mark.parametrize("name", [FIRST_LOOK, FIRST_LOOK_IN_SPACE, *WITH_BEAMS, *IN_SPACE])
def test_delivered_models_are_small_and_whole(name: str) -> None:
    path = path_of(f"{MODELS}/{name}")
    trees = read_trees(path)
    assert path.stat().st_size < 300_000
    assert (trees.lefts < trees.features.size).all()
    assert (trees.rights < trees.features.size).all()
    assert np.isfinite(trees.thresholds).all()

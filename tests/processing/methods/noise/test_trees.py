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


@pytest.mark.parametrize("name", [FIRST_LOOK, *WITH_BEAMS])
def test_words_of_rows_give_the_sums_of_a_walk_row_by_row_to_the_last_bit(name: str) -> None:
    trees = read_trees(path_of(f"{MODELS}/{name}"))
    random = np.random.default_rng(3)
    columns = int(trees.features.max()) + 1
    rows = random.normal(0, 2, (2 * 64 + 7, columns)).astype(np.float32)  # and part of a word
    some = random.choice(np.flatnonzero(trees.features >= 0), len(rows))
    # As large as a threshold goes left, a little larger right.
    rows[np.arange(len(rows)), trees.features[some]] = trees.thresholds[some]
    rows[1::2] = np.nextafter(rows[1::2], np.float32(np.inf))
    rows[4] = np.nan
    rows[5, ::2], rows[6, ::2] = np.inf, -np.inf
    walked = [_walked(trees, row) for row in rows.astype(np.float64)]
    assert log_odds(trees, rows, SilentMonitor()).tolist() == walked


def test_rows_that_a_third_of_the_trees_finds_hopeless_are_asked_no_more() -> None:
    """Three trees of a leaf each: the last ones say much for the claim."""
    leaves = np.arange(3, dtype=np.int32)
    none = np.full(3, -1, np.int32)
    row = np.zeros((1, 1), np.float32)
    for first, sum_of_all in ((-5.0, -5.0), (-4.0, 8.0)):
        trees = Trees(none, np.array([first, 6.0, 6.0]), leaves, leaves, leaves, 0.0)
        assert log_odds(trees, row, SilentMonitor()).tolist() == [sum_of_all]


def _walked(trees: Trees, row: np.ndarray) -> float:
    """A row down each tree, until it is hopeless."""
    total = trees.base
    for number, root in enumerate(trees.roots.tolist()):
        if number == trees.roots.size // 3 and total < -4.0:
            break
        node = root
        while trees.features[node] >= 0:
            is_left = row[trees.features[node]] <= trees.thresholds[node]
            node = trees.lefts[node] if is_left else trees.rights[node]
        total += float(trees.thresholds[node])
    return total


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
    assert path.stat().st_size < 500_000
    assert (trees.lefts < trees.features.size).all()
    assert (trees.rights < trees.features.size).all()
    assert np.isfinite(trees.thresholds).all()

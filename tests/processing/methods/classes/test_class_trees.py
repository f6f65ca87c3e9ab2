"""Trees of several classes give the shares that other programs read from their file."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.methods.classes.class_models import AGAIN, ALONE, AVERAGED, MODELS
from processing.methods.classes.class_trees import class_shares
from processing.methods.noise.tree_files import (
    AveragedTrees,
    Forest,
    read_averaged_trees,
    read_forest,
    write_averaged_trees,
    write_forest,
)
from processing.methods.noise.trees import Trees
from processing.tools.classify import CLASSES
from resources import path_of


@pytest.fixture
def forest() -> Forest:
    """Three classes with a tree each: one asks column 0, one column 1, one is a leaf."""
    trees = Trees(
        np.array([0, -1, -1, 1, -1, -1, -1], np.int32),
        np.array([0.5, 2.0, -2.0, 0.25, 1.0, -1.0, 0.5]),
        np.array([1, 1, 2, 4, 4, 5, 6], np.int32),
        np.array([2, 1, 2, 5, 4, 5, 6], np.int32),
        np.array([0, 3, 6], np.int32),
        0.0,
    )
    bases = np.array([-0.5, 0.25, 0.0])
    return Forest(trees, np.array([0, 1, 2], np.int32), bases, np.array([2, 6, 67], np.uint8))


def test_a_share_is_the_softmax_of_the_sums(forest: Forest) -> None:
    shares = class_shares(forest, np.array([[0.0, 1.0], [1.0, 0.0]], np.float32), SilentMonitor())
    sums = np.array([[-0.5 + 2.0, 0.25 - 1.0, 0.5], [-0.5 - 2.0, 0.25 + 1.0, 0.5]])
    wanted = np.exp(sums) / np.exp(sums).sum(axis=1, keepdims=True)
    np.testing.assert_allclose(shares, wanted, rtol=1e-6)


def test_a_file_gives_the_forest_back(forest: Forest, tmp_path: Path) -> None:
    write_forest(forest, tmp_path / "forest.onnx", 2)
    again = read_forest(tmp_path / "forest.onnx")
    assert again.codes.tolist() == [2, 6, 67]
    assert again.class_of.tolist() == [0, 1, 2]
    np.testing.assert_array_equal(again.bases, forest.bases)
    rows = np.random.default_rng(1).random((50, 2)).astype(np.float32)
    monitor = SilentMonitor()
    np.testing.assert_array_equal(
        class_shares(again, rows, monitor), class_shares(forest, rows, monitor)
    )


@pytest.mark.parametrize(
    ("name", "read"),
    [(ALONE, read_forest), (AGAIN, read_forest), (AVERAGED, read_averaged_trees)],
)
def test_other_programs_read_the_shipped_models_alike(
    name: str, read: Callable[[Path], Forest | AveragedTrees]
) -> None:
    import onnxruntime

    path = path_of(f"{MODELS}/{name}")
    forest = read(path)
    assert set(forest.codes.tolist()) == {1, *CLASSES}
    session = onnxruntime.InferenceSession(path)
    columns = session.get_inputs()[0].shape[1]
    rows = np.random.default_rng(2).normal(0, 2, (200, columns)).astype(np.float32)
    labels, shares = session.run(None, {"features": rows})
    ours = class_shares(forest, rows, SilentMonitor())
    np.testing.assert_allclose(ours, shares, atol=1e-4)
    assert (forest.codes[ours.argmax(axis=1)] == labels).mean() > 0.98


@pytest.mark.parametrize("name", [ALONE, AGAIN])
def test_words_of_rows_give_the_shares_of_a_walk_row_by_row_to_the_last_bit(name: str) -> None:
    forest = read_forest(path_of(f"{MODELS}/{name}"))
    random = np.random.default_rng(3)
    columns = int(forest.trees.features.max()) + 1
    rows = random.normal(0, 2, (64 + 7, columns)).astype(np.float32)  # a word, and part of one
    inner = np.flatnonzero(forest.trees.features >= 0)
    some = random.choice(inner, len(rows))
    # As large as a threshold goes left.
    rows[np.arange(len(rows)), forest.trees.features[some]] = forest.trees.thresholds[some]
    rows[3, :] = np.nan
    rows[4, ::2], rows[5, ::2] = np.inf, -np.inf
    ours = class_shares(forest, rows, SilentMonitor())
    np.testing.assert_array_equal(ours, _walked_shares(forest, rows))


@pytest.fixture
def averaged() -> AveragedTrees:
    """A tree that asks twice, and one that is a leaf."""
    return AveragedTrees(
        np.array([0, -1, 1, -1, -1, -1], np.int32),
        np.array([0.5, 0, 2, 0, 0, 0], np.float32),
        np.array([2, 1, 4, 3, 4, 5], np.int32),
        np.array([-1, 0, -1, 1, 2, 3], np.int32),
        np.array([[1, 0], [0.5, 0.5], [0, 1], [0.25, 0.75]], np.float32),
        np.array([0, 5], np.int32),
        np.array([2, 6], np.uint8),
    )


def test_averaged_trees_say_the_mean_of_their_leaves(averaged: AveragedTrees) -> None:
    rows = np.array([[0.5, 9], [0.6, 2], [0.6, 3], [np.nan, 0]], np.float32)
    shares = class_shares(averaged, rows, SilentMonitor())
    expected = [[0.625, 0.375], [0.375, 0.625], [0.125, 0.875], [0.375, 0.625]]
    np.testing.assert_allclose(shares, expected)


def test_a_file_gives_averaged_trees_back(averaged: AveragedTrees, tmp_path: Path) -> None:
    write_averaged_trees(averaged, tmp_path / "averaged.onnx", 2)
    again = read_averaged_trees(tmp_path / "averaged.onnx")
    is_leaf = averaged.features < 0  # what a leaf has on its right means nothing
    for one, other in zip(averaged, again._replace(rights=averaged.rights), strict=True):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(again.rights[~is_leaf], averaged.rights[~is_leaf])


def test_nodes_may_stand_in_any_order() -> None:
    """The second tree's root is its last node, and a leaf on its left comes after the right."""
    trees = Trees(
        np.array([-1, -1, 0, -1, 1], np.int32),
        np.array([1.0, -1.0, 0.5, 3.0, 0.25]),
        np.array([0, 1, 1, 3, 2], np.int32),
        np.array([0, 1, 0, 3, 3], np.int32),
        np.array([4], np.int32),
        0.0,
    )
    forest = Forest(trees, np.zeros(1, np.int32), np.zeros(2), np.array([2, 6], np.uint8))
    rows = np.array([[0, 0], [1, 0], [0, 1], [np.nan, 0.25]], np.float32)
    ours = class_shares(forest, rows, SilentMonitor())
    np.testing.assert_array_equal(ours, _walked_shares(forest, rows))
    assert len(np.unique(ours[:, 0])) == 3


def test_no_rows_have_no_shares(forest: Forest) -> None:
    assert class_shares(forest, np.empty((0, 2), np.float32), SilentMonitor()).shape == (0, 3)


def _walked_shares(forest: Forest, rows: NDArray[np.float32]) -> NDArray[np.float32]:
    """Each row down each tree."""
    trees = forest.trees
    shares = np.empty((len(rows), forest.codes.size), np.float32)
    for number, row in enumerate(rows.astype(np.float64)):
        sums = forest.bases.copy()
        for root, which in zip(trees.roots.tolist(), forest.class_of.tolist(), strict=True):
            node = root
            while trees.features[node] >= 0:
                is_left = row[trees.features[node]] <= trees.thresholds[node]
                node = trees.lefts[node] if is_left else trees.rights[node]
            sums[which] += trees.thresholds[node]
        likely = [math.exp(one - sums.max()) for one in sums]
        total = 0.0
        for one in likely:
            total += one
        shares[number] = [one / total for one in likely]
    return shares

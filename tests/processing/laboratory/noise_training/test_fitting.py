"""Sums of trees that were learned apart, made one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.laboratory.noise_training.examples import Examples
from processing.laboratory.noise_training.fitting import TreesSize, fit_trees, mean_of_trees
from processing.methods.noise.tree_files import read_trees, write_trees
from processing.methods.noise.trees import Trees, log_odds

_COLUMNS = 4


@pytest.fixture(scope="module")
def rows() -> np.ndarray:
    return np.random.default_rng(5).normal(size=(3000, _COLUMNS)).astype(np.float32)


@pytest.fixture(scope="module")
def learned(rows: np.ndarray) -> list[Trees]:
    """Two sums of other sizes that were told other things."""
    weights = np.ones(len(rows))
    return [
        fit_trees(
            Examples(rows, rows[:, column] + rows[:, 3] > 0.2, weights),
            TreesSize(trees, 6, 0.2),
        )
        for column, trees in ((0, 9), (1, 4))
    ]


def _said(trees: Trees, rows: np.ndarray) -> np.ndarray:
    return log_odds(trees, rows, SilentMonitor())


def test_the_mean_says_the_mean_of_what_each_says(rows: np.ndarray, learned: list[Trees]) -> None:
    mean = mean_of_trees(learned)
    assert mean.roots.size == 13
    expected = np.mean([_said(one, rows) for one in learned], axis=0)
    np.testing.assert_allclose(_said(mean, rows), expected, atol=1e-5)


def test_the_mean_goes_into_a_file_and_comes_back(
    rows: np.ndarray, learned: list[Trees], tmp_path: Path
) -> None:
    mean = mean_of_trees(learned)
    write_trees(mean, tmp_path / "mean.onnx", _COLUMNS)
    np.testing.assert_allclose(
        _said(read_trees(tmp_path / "mean.onnx"), rows), _said(mean, rows), atol=1e-5
    )


def test_the_first_half_of_its_trees_holds_half_of_each(learned: list[Trees]) -> None:
    mean, first = mean_of_trees(learned), learned[0]
    ends = np.append(mean.roots, mean.features.size)
    sizes = np.diff(ends)
    of_first = np.diff(np.append(first.roots, first.features.size))
    assert sizes[0] == of_first[0]
    halves = [mean.thresholds[: ends[7]][mean.features[: ends[7]] < 0]]
    values = [one.thresholds[one.features < 0] / 2 for one in learned]
    shares = [np.isin(values[k].astype(np.float32), halves[0].astype(np.float32)) for k in (0, 1)]
    assert all(0.3 < share.mean() < 0.8 for share in shares)

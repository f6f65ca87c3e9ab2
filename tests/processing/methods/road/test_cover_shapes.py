"""Loops over the cells about a cover, against plain numpy and against all that they leave out."""

from __future__ import annotations

import math

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.methods.road.covers import shape_kernels
from processing.methods.road.covers.shape_kernels import gain_of, rows_kernel

CELL_M = 0.05
NOISE: Floats = np.array([0.03, 0.0008, 0.15])
HALF = 14


def cells_of_a_cover(seed: int) -> Floats:
    """A dark disc of 0.6 m in a road of cells, a tenth of which weren't seen."""
    rng = np.random.default_rng(seed)
    side = (np.arange(-HALF, HALF) + 0.5) * CELL_M
    x, y = (one.ravel() for one in np.meshgrid(side, side, indexing="ij"))
    cells = np.zeros((len(x), 9))
    cells[:, 0], cells[:, 1] = x, y
    cells[:, 2] = rng.normal(0.0, 0.03, len(x)) - 0.4 * (np.hypot(x - 0.05, y) < 0.3)
    cells[:, 3] = rng.normal(0.0, 0.001, len(x))
    cells[:, 5] = cells[:, 6] = rng.uniform(0.5, 1.5, len(x))
    return np.asarray(cells[rng.random(len(x)) > 0.1])


@pytest.mark.parametrize(
    "shape",
    [
        (0.05, 0.0, 0.3, 0.0, 0.0),
        (-0.31, 0.22, 0.125, 0.0, 0.0),
        (0.5, -0.4, 0.65, 0.0, 0.0),
        (0.02, 0.05, 0.45, 0.3, 0.4),
        (0.0, 0.0, 0.3, 0.3, math.pi / 4),
    ],
)
def test_cells_far_from_an_edge_change_nothing_of_its_gain(shape: tuple[float, ...]) -> None:
    cells, asked = cells_of_a_cover(1), np.array(shape)
    rows = np.empty((2 * HALF, 2 * HALF + 1), np.int64)
    rows_kernel(cells, CELL_M, rows)
    sums = np.zeros((8, 2, 7))
    shape_kernels._add_to_octants(cells, (0, len(cells)), asked, CELL_M, sums)
    assert gain_of(cells, rows, NOISE, CELL_M, asked) == shape_kernels._sure_of(sums, NOISE)


def test_rows_number_the_first_cell_at_each_column() -> None:
    cells = cells_of_a_cover(2)
    rows = np.empty((2 * HALF, 2 * HALF + 1), np.int64)
    rows_kernel(cells, CELL_M, rows)
    for row in range(2 * HALF):
        for column in range(2 * HALF + 1):
            before = (cells[:, 0] < (row - HALF) * CELL_M) | (
                (cells[:, 0] < (row + 1 - HALF) * CELL_M) & (cells[:, 1] < (column - HALF) * CELL_M)
            )
            assert rows[row, column] == before.sum()


@pytest.mark.parametrize("count", [1, 2, 3, 8, 21, 200, 781])
def test_medians_are_those_of_numpy(count: int) -> None:
    rng = np.random.default_rng(count)
    for values in (
        rng.normal(size=count),
        np.sort(rng.normal(size=count)),
        rng.integers(0, 4, count).astype(np.float64),
        np.zeros(count),
    ):
        expected = float(np.median(values))
        assert shape_kernels._median(values.copy()) == expected
        assert shape_kernels._median.py_func(values.copy()) == expected  # type: ignore[attr-defined]

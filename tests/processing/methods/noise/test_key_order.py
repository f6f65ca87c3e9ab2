"""Keys ordered by their digits, points in equal cells: as numpy's comparing and flooring give."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.methods.noise.neighbours.flat_cells import flat_cells
from processing.methods.noise.neighbours.key_order import counts_kernel, move_kernel, order_by_key

SILENT = SilentMonitor()


@pytest.mark.parametrize("count", [0, 1, 2, 1_000, 250_000])
@pytest.mark.parametrize("most", [1, 50, 2**40, 2**62])
def test_equal_keys_keep_their_order(count: int, most: int) -> None:
    keys = np.random.default_rng(count).integers(0, most, count)
    expected = np.argsort(keys, kind="stable")
    ordered, order = order_by_key(keys.copy(), SILENT)
    np.testing.assert_array_equal(order, expected)
    np.testing.assert_array_equal(ordered, keys[expected])


def test_the_kernels_do_the_same_uncompiled() -> None:
    keys, order = np.array([5, 3, 5, 0]), np.arange(4)
    counts, to = np.zeros(2048, np.int64), (np.zeros(4, np.int64), np.zeros(4, np.int64))
    counts_kernel.py_func(keys, 0, 0, 4, counts)  # type: ignore[attr-defined]
    assert counts[[0, 3, 5]].tolist() == [1, 1, 2]
    nexts = np.cumsum(counts) - counts
    move_kernel.py_func((keys, order), 0, 0, 4, nexts, to)  # type: ignore[attr-defined]
    assert to[0].tolist() == [0, 3, 5, 5]
    assert to[1].tolist() == [3, 1, 0, 2]


def test_cells_hold_the_points_between_their_sides() -> None:
    xyz = np.random.default_rng(2).random((5_000, 3)) * [40, 20, 6] + [-11e3, -35e3, 40]
    xyz[7] = np.nan
    cells = flat_cells(xyz, 0.5, SILENT)
    assert sorted(cells.order.tolist()) == [k for k in range(5_000) if k != 7]
    np.testing.assert_array_equal(cells.xyz, xyz[cells.order])
    sizes = np.diff(cells.starts)
    assert sizes.sum() == 4_999
    assert (np.diff(cells.keys) > 0).all()
    firsts = np.repeat(cells.xyz[cells.starts[:-1]], sizes, axis=0)
    assert np.abs(cells.xyz - firsts).max() < 0.5
    assert not cells.is_border.any()


def test_cells_above_each_other_follow_and_far_ones_are_told() -> None:
    xyz = np.array([[0.1, 0.1, 0.1], [0.1, 0.1, 1.1], [0.1, 1.1, 0.1], [1.1, 0.1, 0.1]])
    cells = flat_cells(xyz, 1.0, SILENT)
    assert (cells.keys - cells.keys[0]).tolist() == [0, 1, cells.across, cells.along]
    far = flat_cells(np.vstack([xyz, xyz, [[9e9, 0, 0]]]), 1.0, SILENT)
    assert far.is_border.tolist() == [False, False, False, False, True]


def test_a_cloud_without_points_has_no_cells() -> None:
    assert flat_cells(np.zeros((0, 3)), 1.0, SILENT).keys.size == 0
    assert flat_cells(np.full((3, 3), np.nan), 1.0, SILENT).keys.size == 0

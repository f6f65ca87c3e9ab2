"""The kernels of depth pictures, compiled and plain, against values worked out by hand."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from processing.cameras import depth_kernels
from processing.cameras.depth_kernels import ALONE_M

FORMS = [lambda kernel: kernel, lambda kernel: kernel.py_func]
Form = Callable[[Any], Any]


@pytest.mark.parametrize("form", FORMS, ids=["compiled", "plain"])
def test_sizes_are_the_larger_distance_to_neighbours_on_a_surface(
    form: Form, monkeypatch: pytest.MonkeyPatch
) -> None:
    if form is FORMS[1]:
        between = depth_kernels._size_between.py_func
        monkeypatch.setattr(depth_kernels, "_size_between", between)
    rows, columns = np.indices((4, 5)).astype(np.float64)
    xyz = np.stack([0.02 * columns, 0.10 * rows, 0 * rows], axis=2)
    is_filled = np.ones((4, 5), np.bool_)
    is_filled[0, :] = [True, False, False, False, False]
    xyz[0, 0] = 50.0
    sizes = np.zeros((4, 5), np.float32)
    normals = np.zeros((4, 5, 3), np.float32)
    form(depth_kernels.sizes_kernel)(xyz, is_filled, 0.3, sizes, normals)
    np.testing.assert_allclose(np.abs(normals[2, 1:4]), np.tile([0, 0, 1], (3, 1)), atol=1e-6)
    assert (normals[0] == 0).all()
    np.testing.assert_allclose(sizes[2, 1:4], 0.10)
    np.testing.assert_allclose(sizes[3, 1:4], 0.06)
    assert sizes[0, 0] == np.float32(ALONE_M)
    assert (sizes[0, 1:] == 0).all()


@pytest.mark.parametrize("form", FORMS, ids=["compiled", "plain"])
def test_the_nearest_point_covers_the_cells_it_reaches(form: Form) -> None:
    front = np.full((4, 4), np.inf, np.float32)
    number = np.full((4, 4), -1, np.int32)
    # Straight ahead along z, so that a cell's middle lies at its place minus two.
    rows, columns = np.indices((4, 4)) + 0.5
    rays = np.stack([columns - 2, rows - 2, np.full((4, 4), 20.0)], axis=2)
    rays /= np.linalg.norm(rays, axis=2, keepdims=True)
    positions = np.array([[1.5, 1.5], [1.6, 1.4], [np.nan, 0.0], [9.0, 9.0]])
    away = np.array([[-0.125, -0.125, 5.0], [0, 0, 3.0], [0, 0, 1.0], [0, 0, 1.0]])
    normals = np.array([[0, 0, 1.0], [0, 0, 0], [0, 0, 0], [0, 0, 0]])
    radii = np.array([0.3, 0.01, 0.3, 0.01])
    discs = depth_kernels.Discs(away, normals, radii)
    form(depth_kernels.front_kernel)(positions, discs, 20.0, rays, front, number)
    assert number.tolist() == [[-1, 0, -1, -1], [0, 1, 0, -1], [-1, 0, -1, -1], [-1] * 4]
    assert front[1, 1] == 3.0
    # The disc is flat: its cells are as far away as its plane is there.
    assert front[1, 0] == pytest.approx(5.0 / rays[1, 0, 2])


@pytest.mark.parametrize("form", FORMS, ids=["compiled", "plain"])
def test_a_slope_hides_nothing_of_itself_and_an_edge_what_is_behind(form: Form) -> None:
    slope = (1 / np.linspace(0.20, 0.10, 6)).astype(np.float32)
    front = np.tile(slope, (3, 1))
    front[:, :2] = 2.0
    cells = np.array([[4, 1], [4, 1], [0, 1], [0, 1], [-1, -1]])
    ranges = np.array([slope[4] * 1.05, slope[4] * 2, 2.1, 2.5, 99.0])
    hidden = np.zeros(5, np.bool_)
    tolerance = depth_kernels.HidingTolerance(0.2, 0.01)
    form(depth_kernels.hidden_kernel)(cells, ranges, front, tolerance, hidden)
    assert hidden.tolist() == [False, True, False, True, False]

"""Volumes of bodies whose volume is known."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.sites.heights import HeightGrid
from processing.laboratory.simulate.sites.volumes import cut_and_fill

WIDE = np.array([[0.0, 0.0], [12.0, 0.0], [12.0, 12.0], [0.0, 12.0]])


def grid_of(heights: np.ndarray, res: float = 0.125) -> HeightGrid:
    return HeightGrid(heights.astype(np.float32), res)


def frustum(bottom: float, top: float, high: float) -> np.ndarray:
    """A square frustum whose edges follow nodes and diagonals of a grid of 12 m."""
    x, y = np.meshgrid(np.arange(97) * 0.125, np.arange(97) * 0.125)
    away = np.maximum(np.abs(x - 6), np.abs(y - 6))
    return np.clip((bottom - away) / (bottom - top), 0, 1) * high


def test_a_frustum_on_a_plane_has_its_volume_to_the_last_digits() -> None:
    # Only two of its four ridges lie on the diagonals; halving the grid's triangles along the
    # others would change the body, so the truth is that of the prismatoid built from nodes.
    body = frustum(4.0, 2.0, 2.0)
    plain = grid_of(np.zeros_like(body))
    found = cut_and_fill(plain, grid_of(body), WIDE)
    z = body
    low, high, right, up = z[:-1, :-1], z[1:, 1:], z[:-1, 1:], z[1:, :-1]
    exact = float(((low + right + high) + (low + high + up)).sum() / 6 * 0.125**2)
    assert found.fill_m3.sum() == pytest.approx(exact, rel=1e-12)
    assert found.cut_m3.sum() == 0.0
    # The ridges across the diagonals lose a sliver in each cell, of known size.
    slivers = 2 * (2.0 / 0.125) * (0.125**2 / 6) * (0.125 * 2.0 / 2.0)
    high_m, wide, narrow = 2.0, 8.0**2, 4.0**2
    formula = high_m / 3 * (wide + narrow + np.sqrt(wide * narrow))
    assert found.fill_m3.sum() == pytest.approx(formula - slivers, rel=1e-9)


def test_the_same_body_taken_away_is_cut() -> None:
    body = frustum(4.0, 2.0, 2.0)
    plain = grid_of(np.zeros_like(body))
    filled, cut = cut_and_fill(plain, grid_of(body), WIDE), cut_and_fill(grid_of(body), plain, WIDE)
    assert cut.cut_m3.sum() == pytest.approx(filled.fill_m3.sum(), rel=1e-12)
    assert cut.fill_m3.sum() == 0.0


def test_a_tilted_difference_is_split_where_it_changes_sign() -> None:
    x, _ = np.meshgrid(np.arange(97) * 0.125, np.arange(97) * 0.125)
    # d = 0.25 (x - 5.0625): zero in the middle of cells.
    found = cut_and_fill(grid_of(np.zeros_like(x)), grid_of(0.25 * (x - 5.0625)), WIDE)
    assert found.cut_m3.sum() == pytest.approx(0.125 * 5.0625**2 * 12, rel=1e-9)
    assert found.fill_m3.sum() == pytest.approx(0.125 * (12 - 5.0625) ** 2 * 12, rel=1e-9)


@pytest.mark.parametrize("is_clockwise", [False, True])
def test_a_polygon_with_a_notch_clips_to_its_own_area(is_clockwise: bool) -> None:
    ring = np.array([[1.03, 1.1], [10.7, 0.4], [9.9, 11.2], [6.03, 5.07], [2.1, 9.3]])
    if is_clockwise:
        ring = ring[::-1]
    x, y = ring.T
    area = abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2
    flat = np.zeros((97, 97))
    found = cut_and_fill(grid_of(flat), grid_of(flat + 0.5), ring)
    assert found.area_m2.sum() == pytest.approx(area, rel=1e-10)
    assert found.fill_m3.sum() == pytest.approx(area / 2, rel=1e-10)


def test_blocks_hold_what_lies_in_them() -> None:
    flat = np.zeros((97, 97))
    found = cut_and_fill(grid_of(flat), grid_of(flat - 2.0), WIDE)
    assert found.block_m == 0.5
    assert np.allclose(found.cut_m3, 0.5)
    assert np.allclose(found.area_m2, 0.25)


def test_other_nodes_are_refused() -> None:
    with pytest.raises(ValueError, match="nodes"):
        cut_and_fill(grid_of(np.zeros((5, 5))), grid_of(np.zeros((5, 6))), WIDE)


def test_the_plain_kernel_gives_the_same() -> None:
    from processing.laboratory.simulate.sites.volumes import _relation_kernel

    square = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    for x, y, expected in ((2.0, 2.0, 1), (5.0, 2.0, -1), (0.05, 2.0, 0)):
        assert _relation_kernel.py_func(square, x, y, 0.1) == expected
        assert _relation_kernel(square, x, y, 0.1) == expected

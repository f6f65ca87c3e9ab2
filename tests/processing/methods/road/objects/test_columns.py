"""Columns: what stands free, by how densely it and what is beside it were measured."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.road.objects.columns import (
    _RING_STEPS,
    free_kernel,
    free_slabs,
    slabs_kernel,
)
from processing.methods.road.objects.ground_heights import GROUND_CELLS
from processing.methods.road.objects.sparse_plan import TILE

_MIDDLE, _BEGIN = TILE // 2, np.uint32(0b111111)
_LEVEL = np.zeros((TILE, TILE), np.float32)


def _filled(per_cell: int) -> np.ndarray[tuple[int, int], np.dtype[np.uint32]]:
    """A wall through the middle with so many points in each of six slabs of its cells."""
    slabs = np.zeros((TILE, TILE), np.uint32)
    if per_cell:
        slabs[:, _MIDDLE] = _BEGIN
    return slabs


def test_slabs_tell_single_points_from_several_and_many() -> None:
    local = np.array([[0.1, 0.1, 1.0]] + 2 * [[0.1, 0.1, 1.5]] + 3 * [[0.1, 0.1, 2.1]])
    table, ground = np.zeros((1, 1), np.int32), np.zeros(GROUND_CELLS**2, np.float32)
    for kernel in (slabs_kernel, slabs_kernel.py_func):  # type: ignore[attr-defined]
        one, several, many = np.zeros((3, TILE * TILE), np.uint32)
        kernel(local, np.zeros(len(local), np.bool_), table, ground, (one, several, many))
        assert [int(np.bitwise_count(each).sum()) for each in (one, several, many)] == [3, 2, 1]


@pytest.mark.parametrize("per_cell", [1, 3])
def test_a_wall_stands_nowhere_free_however_densely_it_was_measured(per_cell: int) -> None:
    wall = _filled(per_cell)
    many = wall if per_cell >= 3 else np.zeros_like(wall)
    free = free_slabs(wall, wall, _LEVEL) | free_slabs(many, many, _LEVEL)
    inner = free[_MIDDLE - 2 : _MIDDLE + 3, _MIDDLE - 2 : _MIDDLE + 3]
    assert not inner.any()


def test_single_points_of_noise_on_both_sides_hide_no_post() -> None:
    many = np.zeros((TILE, TILE), np.uint32)
    many[_MIDDLE, _MIDDLE] = _BEGIN
    noise = many.copy()
    noise[_MIDDLE, _MIDDLE - 3], noise[_MIDDLE, _MIDDLE + 3] = _BEGIN, _BEGIN
    assert free_slabs(noise, noise, _LEVEL)[_MIDDLE, _MIDDLE] == 0
    assert free_slabs(many, many, _LEVEL)[_MIDDLE, _MIDDLE] & _BEGIN == _BEGIN


def test_what_stands_beside_counts_at_its_own_height_where_the_coarse_ground_is_lower() -> None:
    """Beside the cells of a gutter the street seems to be filled up to half a metre."""
    ground = _LEVEL.copy()
    ground[: _MIDDLE - 2] = ground[_MIDDLE + 3 :] = -0.5
    slabs = np.where(ground < 0, np.uint32(0b11), np.uint32(0)).astype(np.uint32)
    slabs[_MIDDLE, _MIDDLE] = 0b111
    for kernel in (free_kernel, free_kernel.py_func):  # type: ignore[attr-defined]
        free = np.zeros_like(slabs)
        kernel(slabs, slabs, ground, _RING_STEPS, free)
        assert free[_MIDDLE, _MIDDLE] == 0b1110
    assert free_slabs(slabs, slabs, _LEVEL)[_MIDDLE, _MIDDLE] == 0b1000

"""How high points lie above ground that is level, sloped, or broken by a wall."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from processing.methods.noise.features.ground_heights import ground_below

_SIDE_M, _STEP_M, _CELL_M = 24.0, 0.1, 1.0
_MARGIN_M = 7.0  # medians of few cells lean at the border
_ALL_SURE = np.ones((int(_SIDE_M / _STEP_M)) ** 2, np.bool_)


def _positions() -> NDArray[np.float64]:
    line = np.arange(0, _SIDE_M, _STEP_M)[: int(_SIDE_M / _STEP_M)]
    return np.stack(np.meshgrid(line, line, indexing="ij"), -1).reshape(-1, 2)


@settings(max_examples=15, deadline=None)
@given(st.floats(-1.2, 1.2), st.floats(-1.2, 1.2))
def test_the_ground_of_a_bank_follows_it(along: float, across: float) -> None:
    xy = _positions()
    xyz = np.column_stack([xy, xy @ [along, across]])
    inner = (np.abs(xy - _SIDE_M / 2) < _SIDE_M / 2 - _MARGIN_M).all(axis=1)
    heights = ground_below(xyz, _ALL_SURE, _CELL_M).heights[inner]
    assert np.abs(heights).max() < 0.05


def test_a_point_over_a_bank_is_as_high_as_it_hangs() -> None:
    xy = _positions()
    xyz = np.column_stack([xy, xy[:, 0]])
    over = np.array([[10.3, 10.4, 12.3], [10.3, 10.4, 8.3]])
    is_sure = np.r_[_ALL_SURE, False, False]
    heights = ground_below(np.vstack([xyz, over]), is_sure, _CELL_M).heights[-2:]
    assert heights == pytest.approx([2.0, -2.0], abs=0.05)


def test_level_ground_does_not_lean_at_the_edge_of_a_roof() -> None:
    xy = _positions()
    is_roof = xy[:, 0] >= _SIDE_M / 2
    xyz = np.column_stack([xy, np.where(is_roof, 5.0, 0.0)])
    heights = ground_below(xyz, _ALL_SURE, _CELL_M).heights
    beyond = np.abs(xy[:, 0] - _SIDE_M / 2) > _CELL_M
    assert np.abs(heights[beyond]).max() < 0.01


def test_a_clod_stands_out_on_smooth_ground_and_not_on_rough() -> None:
    xy, clod = _positions(), np.array([[12.05, 12.05, 0.1]])
    standing_out = []
    for rough_m in (0.0, 0.1):
        bumps = rough_m * np.random.default_rng(1).normal(size=len(xy))
        xyz = np.vstack([np.column_stack([xy, bumps]), clod])
        ground = ground_below(xyz, np.append(_ALL_SURE, False), _CELL_M)
        _, roughness, relative, share = ground.features(np.array([len(xy)]))[0]
        assert 2.0**roughness == pytest.approx(0.005 + rough_m, abs=0.006)
        assert share > 0.99
        standing_out.append(relative)
    assert standing_out[0] > 10
    assert standing_out[1] < 2


def test_the_steepness_of_the_ground_is_told_and_how_much_lies_high_over_it() -> None:
    xy = _positions()
    crowns = xy[:, 1] > _SIDE_M / 2
    bank = np.column_stack([xy, 0.6 * xy[:, 0]])
    leaves = bank[crowns] + [0.0, 0.0, 4.0]
    xyz = np.vstack([bank, leaves])
    ground = ground_below(xyz, np.append(_ALL_SURE, np.zeros(len(leaves), np.bool_)), _CELL_M)
    middle = np.abs(xy[:, 0] - _SIDE_M / 2) < _CELL_M
    bare, covered = (np.flatnonzero(middle & (np.abs(xy[:, 1] - y) < _CELL_M)) for y in (7.0, 17.0))
    assert ground.features(bare)[:, 0] == pytest.approx(0.6, abs=0.02)
    assert ground.features(bare)[:, 3] == pytest.approx(1.0)
    assert ground.features(covered)[:, 3] == pytest.approx(0.5, abs=0.02)


def test_of_no_points_there_is_no_ground() -> None:
    assert ground_below(np.zeros((0, 3)), np.zeros(0, np.bool_), _CELL_M).heights.size == 0

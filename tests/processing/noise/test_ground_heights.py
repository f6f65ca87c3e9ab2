"""How high points lie above ground that is level, sloped, or broken by a wall."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from processing.noise.ground_heights import heights_above_ground

_SIDE_M, _STEP_M, _CELL_M = 24.0, 0.1, 1.0
_MARGIN_M = 7.0  # medians of few cells lean at the border
_ALL_SURE = np.ones((int(_SIDE_M / _STEP_M)) ** 2, np.bool_)


def _places() -> NDArray[np.float64]:
    line = np.arange(0, _SIDE_M, _STEP_M)[: int(_SIDE_M / _STEP_M)]
    return np.stack(np.meshgrid(line, line, indexing="ij"), -1).reshape(-1, 2)


@settings(max_examples=15, deadline=None)
@given(st.floats(-1.2, 1.2), st.floats(-1.2, 1.2))
def test_the_ground_of_a_bank_follows_it(along: float, across: float) -> None:
    xy = _places()
    xyz = np.column_stack([xy, xy @ [along, across]])
    inner = (np.abs(xy - _SIDE_M / 2) < _SIDE_M / 2 - _MARGIN_M).all(axis=1)
    heights = heights_above_ground(xyz, _ALL_SURE, _CELL_M)[inner]
    assert np.abs(heights).max() < 0.05


def test_a_point_over_a_bank_is_as_high_as_it_hangs() -> None:
    xy = _places()
    xyz = np.column_stack([xy, xy[:, 0]])
    over = np.array([[10.3, 10.4, 12.3], [10.3, 10.4, 8.3]])
    is_sure = np.r_[_ALL_SURE, False, False]
    heights = heights_above_ground(np.vstack([xyz, over]), is_sure, _CELL_M)[-2:]
    assert heights == pytest.approx([2.0, -2.0], abs=0.05)


def test_level_ground_does_not_lean_at_the_edge_of_a_roof() -> None:
    xy = _places()
    is_roof = xy[:, 0] >= _SIDE_M / 2
    xyz = np.column_stack([xy, np.where(is_roof, 5.0, 0.0)])
    heights = heights_above_ground(xyz, _ALL_SURE, _CELL_M)
    beyond = np.abs(xy[:, 0] - _SIDE_M / 2) > _CELL_M
    assert np.abs(heights[beyond]).max() < 0.01

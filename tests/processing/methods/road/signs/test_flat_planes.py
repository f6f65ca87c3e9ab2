"""The plane of some pieces of scan lines, against plain least squares."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.road.signs.link_kernels import PLANE_WIDTH, flat_kernel
from processing.methods.road.signs.piece_kernels import COUNT, FROM, PIECE, TO, VIEW
from processing.methods.road.signs.plate_groups import group_of


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_plane_is_that_of_least_squares_and_looks_at_the_scanner(side: float) -> None:
    random = np.random.default_rng(4)
    values = np.zeros((40, PIECE))
    values[:, FROM : FROM + 3] = random.normal(size=(40, 3)) * (1.0, 0.01, 1.0) + (50, 20, 8)
    values[:, TO : TO + 3] = values[:, FROM : FROM + 3] + (0.1, 0.0, 0.2)
    values[:, COUNT] = random.integers(2, 9, 40)
    values[:, VIEW : VIEW + 3] = (0.0, side, 0.0)
    members = np.arange(3, 40, 2)
    group = group_of(values, members)
    assert group is not None
    ends = np.concatenate([values[members, FROM : FROM + 3], values[members, TO : TO + 3]])
    weights = np.concatenate([values[members, COUNT]] * 2)
    middle = np.average(ends, axis=0, weights=weights)
    spread = np.cov((ends - middle).T, aweights=weights, ddof=0)
    normal = np.linalg.eigh(spread)[1][:, 0]
    assert group.middle == pytest.approx(middle)
    assert abs(float(group.normal @ normal)) == pytest.approx(1.0)
    assert group.normal[1] * side < 0
    assert group.noise_m**2 == pytest.approx(
        np.average(((ends - middle) @ normal) ** 2, weights=weights)
    )
    assert group.flat(ends).min(axis=0) == pytest.approx(group.low)
    assert group.flat(ends).max(axis=0) == pytest.approx(group.high)
    assert np.column_stack([group.right, group.up, group.normal]) @ np.array(
        [group.right, group.up, group.normal]
    ) == pytest.approx(np.eye(3), abs=1e-9)
    told = np.empty(PLANE_WIDTH)
    assert flat_kernel.py_func(values, members, told)  # type: ignore[attr-defined]
    assert told[:3] == pytest.approx(group.middle)


def test_what_lies_level_is_no_plate() -> None:
    values = np.zeros((6, PIECE))
    values[:, FROM : FROM + 2] = np.random.default_rng(5).normal(size=(6, 2))
    values[:, TO : TO + 3] = values[:, FROM : FROM + 3] + (0.1, 0.2, 0.0)
    values[:, COUNT] = 4.0
    assert group_of(values, np.arange(6)) is None

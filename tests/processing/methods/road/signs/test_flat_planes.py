"""The plane of some pieces of scan lines, against plain least squares."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.road.signs.link_kernels import (
    FLAT_M,
    PLANE_WIDTH,
    RIM_M,
    complete_kernel,
    flat_kernel,
)
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


@pytest.mark.parametrize("is_face", [False, True])
def test_what_lies_in_the_box_and_the_plane_of_a_plate_and_is_as_bright_is_of_it(
    is_face: bool,
) -> None:
    random = np.random.default_rng(6)
    values = np.zeros((120, PIECE))
    values[:, FROM : FROM + 3] = random.uniform(-1.0, 1.0, (120, 3)) * (1.0, 0.04, 1.0)
    values[:, TO : TO + 3] = values[:, FROM : FROM + 3] + (0.02, 0.0, 0.1)
    values[:, COUNT], values[:, VIEW + 1] = 5.0, 1.0
    values[:8, [FROM + 1, TO + 1]] = 0.0
    is_bright = np.arange(120) % 3 == 0
    is_bright[:8] = is_face
    group = group_of(values, np.arange(8))
    assert group is not None
    flat = [group.flat(values[:, side : side + 3]) for side in (FROM, TO)]
    off = [
        np.abs((values[:, side : side + 3] - group.middle) @ group.normal) for side in (FROM, TO)
    ]
    is_near = (np.maximum(*off) <= FLAT_M) & (np.minimum(*flat) >= group.low - RIM_M).all(axis=1)
    is_near &= (np.maximum(*flat) <= group.high + RIM_M).all(axis=1)
    expected = np.flatnonzero(is_near & (is_bright == is_face))
    expected = expected[expected >= 8]
    assert expected.size > 3
    for kernel in (complete_kernel, complete_kernel.py_func):  # type: ignore[attr-defined]
        chosen, is_own = np.empty(120, np.int64), np.zeros(120, np.bool_)
        near = np.arange(120)
        count = kernel(values, near, group.pieces, group.plane, is_bright, is_own, chosen)
        assert chosen[:count].tolist() == expected.tolist()
        assert not is_own.any()

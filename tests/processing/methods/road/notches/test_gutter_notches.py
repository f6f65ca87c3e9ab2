"""Notches on rows whose holes are known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.gutters.notches import notch_kernels
from processing.methods.road.gutters.notches.notch_kernels import FOUND, Limits, notches_kernel
from processing.methods.road.gutters.notches.notches import LOST, OPENING
from tests.processing.methods.road.notches.notch_rows import (
    DEEP_M,
    HOLE_LONG_M,
    HOLE_WIDE_M,
    HOLES_FROM_M,
    LID_M,
    NotchRows,
    is_hole,
)

Floats = NDArray[np.float64]


def nothing_open(along: Floats, across: Floats) -> NDArray[np.bool_]:
    """A plain road."""
    return np.zeros(np.broadcast(along, across).shape, np.bool_)


def found_in(rows: NotchRows, noise_m: float = 0.002) -> tuple[Floats, NDArray[np.int64]]:
    """What the kernel notes."""
    out = (np.empty((5_000, FOUND)), np.empty((5_000, 3), np.int64))
    limits = Limits(6.5, 1.5, noise_m, 0.02, 0.01, 0.10, 3.0)
    count = notches_kernel(rows.xyz, rows.pulse, rows.sweeps, limits, out)
    return out[0][:count], out[1][:count]


def off_the_holes(found: Floats) -> Floats:
    """How far notches lie from the middle of the joint line with holes, along the way, m."""
    along = found[:, 0]
    return np.asarray(np.abs(along - LID_M * np.round(along / LID_M)))


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"slope": 0.12},
        {"fall": 0.06, "slope": -0.08},
        {"noise_m": 0.001},
        {"lost_share": 0.05},
    ],
)
def test_holes_are_found_on_slopes_with_noise_and_lost_pulses(changes: dict[str, Any]) -> None:
    rows = NotchRows(is_hole, **changes)
    found, _ = found_in(rows, changes.get("noise_m", 0.002))
    deep = found[found[:, 3] > DEEP_M / 2]

    across = -deep[:, 1]
    reach = HOLE_LONG_M / 2 + 0.015
    assert (off_the_holes(deep) <= reach).all()
    low, high = HOLES_FROM_M[0], HOLES_FROM_M[1] + HOLE_WIDE_M
    assert ((across > low - 0.02) & (across < high + 0.02)).all()
    assert np.unique(np.round(deep[:, 0] / LID_M)).size >= 9
    # Where a pulse beside the hole is lost, no two differences are of consecutive pulses.
    is_thesis = (deep[:, 8].astype(np.int64) & OPENING) > 0
    assert is_thesis.mean() > 0.8


def test_the_place_of_a_hole_is_on_the_lid_and_not_below() -> None:
    found, _ = found_in(NotchRows(is_hole, slope=0.10))
    deep = found[found[:, 3] > DEEP_M / 2]

    assert np.abs(deep[:, 2] - 0.10 * deep[:, 0]).max() < 0.006
    assert np.median(np.abs(deep[:, 3] - DEEP_M)) < 0.01


def test_a_plain_road_has_no_openings() -> None:
    found, _ = found_in(NotchRows(nothing_open, fall=0.04, slope=0.05))

    assert not (found[:, 3] > 0.012).any()
    assert len(found) < 0.005 * 60 * 1_000


def test_a_missing_pulse_alone_is_noted_as_lost() -> None:
    rows = NotchRows(nothing_open, lost_share=0.01)
    found, _ = found_in(rows)
    pattern = found[:, 8].astype(np.int64)

    assert ((pattern & LOST) > 0).sum() > 100
    assert (found[(pattern & LOST) > 0, 7] >= 1).all()


def test_a_curb_is_no_opening() -> None:
    rows = NotchRows(nothing_open)
    is_walk = -rows.xyz[:, 1] > 3.0
    rows.xyz[is_walk, 2] += 0.15
    found, _ = found_in(rows)

    assert not (found[:, 3] > 0.012).any()


def test_holes_close_to_a_wall_are_found_on_both_sides() -> None:
    rows = NotchRows(lambda along, across: is_hole(along, np.abs(across)))
    last = HOLES_FROM_M[1] + HOLE_WIDE_M
    # Beyond the lid, not what was measured through its holes.
    is_wall = (np.abs(rows.xyz[:, 1]) > last + 0.035) & (rows.xyz[:, 2] > -DEEP_M / 2)
    rows.xyz[is_wall, 2] += 0.15
    found, between = found_in(rows)
    deep = found[(found[:, 3] > DEEP_M / 2) & (np.abs(found[:, 1]) > HOLES_FROM_M[1] - 0.02)]
    right, left = (deep[:, 1] < 0).sum(), (deep[:, 1] > 0).sum()
    assert min(left, right) >= 9
    assert max(left, right) < 1.5 * min(left, right)
    assert (between[:, 1] < between[:, 2]).all()


def test_grass_is_no_row_of_openings() -> None:
    rows = NotchRows(nothing_open)
    random = np.random.default_rng(1)
    is_grass = -rows.xyz[:, 1] > 3.0
    rows.xyz[is_grass, 2] += random.uniform(0.0, 0.15, int(is_grass.sum()))
    found, _ = found_in(rows)

    is_in = -found[:, 1] > 3.1
    assert (found[is_in, 3] > 0.012).sum() < 0.01 * is_grass.sum()


def test_the_line_of_the_kernel_is_that_of_least_squares() -> None:
    random = np.random.default_rng(2)
    along = np.sort(random.random(20))
    height = 0.3 * along + random.normal(0.0, 0.01, 20)
    taken = np.zeros((7, 21))
    for at in range(20):
        notch_kernels._take.py_func(taken, at, along[at], height[at])
    middle, level, slope, spread, rms, count = notch_kernels._line.py_func(taken, (2, 8), (11, 17))

    chosen = np.r_[2:8, 11:17]
    fit = np.polyfit(along[chosen], height[chosen], 1)
    rest = height[chosen] - np.polyval(fit, along[chosen])
    assert slope == pytest.approx(fit[0])
    assert level == pytest.approx(np.polyval(fit, middle))
    assert spread == pytest.approx(((along[chosen] - along[chosen].mean()) ** 2).sum())
    assert rms == pytest.approx(np.sqrt((rest**2).sum() / 10))
    assert count == 12

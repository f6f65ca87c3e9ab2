"""Rows of lids: laid at the size and spacing of their run, to where they were clicked."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.map.drafting.lid_rows import lid_in_gap, pattern_near, row_between

LENGTH_M, WIDTH_M, SPACING_M = 0.5, 0.36, 0.51


def lid(station_m: float, heading_rad: float = 0.4) -> np.ndarray:
    """A lid of a gutter that leads in a direction and rises by 2 %, leaning by 3 % across."""
    along = np.array([math.cos(heading_rad), math.sin(heading_rad), 0.02])
    across = np.array([-math.sin(heading_rad), math.cos(heading_rad), 0.03])
    along, across = along / np.linalg.norm(along), across / np.linalg.norm(across)
    middle = np.array([-12_000.0, -35_000.0, 40.0]) + station_m * along
    one, other = along * LENGTH_M / 2, across * WIDTH_M / 2
    return np.stack([middle - one - other, middle + one - other, middle + one + other,
                     middle - one + other])  # fmt: skip


def run(*numbers: int, heading_rad: float = 0.4) -> list[np.ndarray]:
    return [lid(SPACING_M * number, heading_rad) for number in numbers]


@given(st.floats(0.0, 6.28), st.sampled_from((0, 1, 2, 3)))
def test_the_pattern_is_that_of_the_run_whatever_its_direction(
    heading_rad: float, first: int
) -> None:
    lids = [np.roll(one, first, axis=0) for one in run(0, 1, 2, 5, heading_rad=heading_rad)]
    pattern = pattern_near(lids, lids[1].mean(axis=0))
    assert pattern is not None
    assert pattern.length_m == pytest.approx(LENGTH_M)
    assert pattern.width_m == pytest.approx(WIDTH_M)
    assert pattern.spacing_m == pytest.approx(SPACING_M)


def test_a_row_lies_where_the_lids_of_the_run_would_lie() -> None:
    pattern = pattern_near(run(0, 1, 2), lid(0.0).mean(axis=0))
    assert pattern is not None
    wanted = run(10, 11, 12, 13, 14)
    laid = row_between(pattern, wanted[0].mean(axis=0), wanted[-1].mean(axis=0))
    assert np.abs(np.array(laid) - np.array(wanted)).max() < 2e-3


def test_a_row_may_lead_against_the_run_and_still_leans_as_it_does() -> None:
    pattern = pattern_near(run(0, 1, 2), lid(0.0).mean(axis=0))
    assert pattern is not None
    wanted = run(14, 13, 12)
    laid = row_between(pattern, wanted[0].mean(axis=0), wanted[-1].mean(axis=0))
    for one, other in zip(laid, wanted, strict=True):
        far = np.linalg.norm(one[:, None] - other[None], axis=2).min(axis=1)
        assert far.max() < 2e-3


def test_a_row_that_is_no_multiple_of_the_spacing_is_even() -> None:
    pattern = pattern_near(run(0, 1, 2), lid(0.0).mean(axis=0))
    assert pattern is not None
    ends = lid(20.0).mean(axis=0), lid(20.0 + 4.3 * SPACING_M).mean(axis=0)
    middles = np.array([one.mean(axis=0) for one in row_between(pattern, *ends)])
    steps = np.linalg.norm(np.diff(middles, axis=0), axis=1)
    assert len(middles) == 5
    assert steps == pytest.approx(4.3 * SPACING_M / 4)
    assert middles[[0, -1]] == pytest.approx(np.array(ends))


@pytest.mark.parametrize("off_m", [-0.2, 0.0, 0.2])
def test_one_click_into_a_gap_gives_the_lid_that_is_missing(off_m: float) -> None:
    lids = run(0, 1, 2, 4, 5)
    place = lid(3 * SPACING_M + off_m).mean(axis=0)
    pattern = pattern_near(lids, place)
    assert pattern is not None
    found = lid_in_gap(pattern, lids, place)
    assert found is not None
    assert np.abs(found - lid(3 * SPACING_M)).max() < 2e-3


def test_behind_the_last_lid_and_in_a_longer_gap_there_is_no_single_one() -> None:
    lids = run(0, 1, 2, 7)
    for station in (4, 8):
        place = lid(station * SPACING_M).mean(axis=0)
        pattern = pattern_near(lids, place)
        assert pattern is not None
        assert lid_in_gap(pattern, lids, place) is None


def test_without_a_lid_there_is_no_pattern() -> None:
    assert pattern_near([], np.zeros(3)) is None

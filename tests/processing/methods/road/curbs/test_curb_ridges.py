"""Edging stones between a planting strip and a walk are found by their tops and shadows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.curbs.steps.curb_filters import (
    remove_inner_faces,
    remove_unlikely_runs,
    runs_of,
)
from processing.methods.road.curbs.steps.curb_ridges import ridges_of
from processing.methods.road.curbs.steps.curb_runs import StepRun
from processing.methods.road.curbs.steps.ridge_kernels import RidgeLimits, ridges_kernel
from processing.methods.road.curbs.steps.step_columns import (
    LOWER_HEIGHT,
    SIGN,
    STEP_COLUMNS,
    UPPER_ACROSS,
    UPPER_HEIGHT,
)
from tests.processing.methods.road.curbs.test_curb_runs import SETTINGS, SurfaceFunction, scanlines

_Floats = NDArray[np.float64]

SCANNER_M = 2.4


def seen(ground: SurfaceFunction) -> SurfaceFunction:
    """What a scanner above the way shows of a ground: NaN in the shadow of what stands nearer."""

    def shown(station: float, across: _Floats) -> _Floats:
        heights = ground(station, across)
        result = np.full_like(heights, np.nan)
        for side in (-1, 1):
            outwards = np.flatnonzero(side * across > 0)[::side]
            slopes = (heights[outwards] - SCANNER_M) / np.abs(across[outwards])
            highest = np.maximum.accumulate(slopes)
            result[outwards] = np.where(slopes >= highest - 1e-9, heights[outwards], np.nan)
        return result

    return shown


def strip(stone_m: float = 0.10, high_m: float = 0.12, front_m: float = 0.10) -> SurfaceFunction:
    """A curb, soil behind it and, at 4.5 m, an edging stone before the walk."""

    def ground(_station: float, across: _Floats) -> _Floats:
        heights = np.where(across > 3.0, 0.15, 0.0)
        is_stone = (across > 4.5 - stone_m) & (across < 4.5)
        heights = np.where(is_stone, 0.15 + high_m, heights)
        is_soil = (across > 3.2) & (across <= 4.5 - stone_m)
        return np.where(is_soil, 0.15 + high_m - front_m, heights)

    return seen(ground)


def found(surface: SurfaceFunction) -> tuple[StepRun, ...]:
    """The runs that are taken for curbs and look away from the way."""
    made = scanlines(surface)
    runs = remove_unlikely_runs(tuple(runs_of([made], 0, SETTINGS)), SETTINGS)
    return tuple(run for run in runs if run.rises < 0)


def test_the_far_edge_of_an_edging_stone_is_found_by_the_stones_shadow() -> None:
    made = scanlines(strip(), length_m=1.0)
    steps = ridges_of(made, SETTINGS).steps.table
    assert steps.shape[0] == made.stations_m.size
    assert (steps[:, SIGN] == -1).all()
    assert steps[:, UPPER_ACROSS] == pytest.approx(4.5, abs=0.03)
    assert steps[:, UPPER_HEIGHT] == pytest.approx(0.27, abs=0.01)
    assert steps[:, LOWER_HEIGHT] == pytest.approx(0.15, abs=0.015)


def test_an_edging_stone_is_one_run_along_its_far_edge() -> None:
    runs = [run for run in found(strip()) if abs(np.median(run.upper[:, 0]) - 4.5) < 0.05]
    assert runs
    longest = max(runs, key=lambda run: run.seen_m)
    assert longest.seen_m > 11.0
    assert np.abs(longest.upper[:, 0] - 4.5).max() < 0.03
    assert np.abs(longest.heights_m - 0.12).max() < 0.02


def test_of_an_edging_stone_the_face_towards_the_strip_is_left_out() -> None:
    runs = remove_unlikely_runs(
        tuple(runs_of([scanlines(strip())], 0, SETTINGS)), replace(SETTINGS, least_step_m=0.02)
    )
    fronts = [run for run in runs if run.rises > 0 and np.median(run.upper[:, 0]) > 4.0]
    kept = remove_inner_faces(runs, SETTINGS)
    assert fronts
    assert not [run for run in kept if any(run is front for front in fronts)]
    assert [run for run in kept if run.is_edging]
    assert [run for run in kept if np.median(run.upper[:, 0]) < 3.1]


def test_the_rear_of_a_kerb_stone_is_no_edging() -> None:
    def kerb(_station: float, across: _Floats) -> _Floats:
        return np.where((across > 3.0) & (across < 3.2), 0.15, np.where(across >= 3.2, 0.05, 0.0))

    assert ridges_of(scanlines(seen(kerb)), SETTINGS).fronts.size > 0
    assert found(seen(kerb)) == ()


@pytest.mark.parametrize(
    "surface",
    [
        strip(high_m=0.30, front_m=0.28),  # a wall
        strip(stone_m=0.5),  # no narrow stone
        strip(front_m=0.0),  # no front
    ],
)
def test_walls_wide_tops_and_tops_without_a_front_are_no_ridges(surface: SurfaceFunction) -> None:
    steps = ridges_of(scanlines(surface, length_m=1.0), SETTINGS).steps.table
    assert not (np.abs(steps[:, UPPER_ACROSS] - 4.5) < 0.1).any()


def test_the_kernel_and_its_plain_form_agree() -> None:
    made = scanlines(strip(), length_m=0.3)
    limits = RidgeLimits(0.03, 0.18, 0.36, 1.0, 3.5)
    lines = (made.across_m, made.height_m, made.starts)
    compiled = (np.zeros((9, STEP_COLUMNS)), np.zeros(9))
    plain = (np.zeros((9, STEP_COLUMNS)), np.zeros(9))
    count = ridges_kernel(*lines, limits, compiled)
    assert ridges_kernel.py_func(*lines, limits, plain) == count  # type: ignore[attr-defined]
    for one, other in zip(compiled, plain, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-9)

"""Curbs made of straight pieces on scanlines are found as runs; what is no curb isn't."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.image.scan_lines.scanlines import Scanlines
from processing.methods.road.curbs.steps.curb_chains import chains_of
from processing.methods.road.curbs.steps.curb_filters import (
    curb_indications_of,
    remove_unlikely_runs,
    runs_of,
)
from processing.methods.road.curbs.steps.curb_profile import StepSettings, steps_of
from processing.methods.road.curbs.steps.curb_runs import StepRun, run_of, spread_of

Floats = NDArray[np.float64]
SETTINGS = StepSettings()
SPACING_M = 0.1

SurfaceFunction = Callable[[float, Floats], Floats]


def scanlines(
    surface: SurfaceFunction, length_m: float = 12.0, noise_m: float = 0.004
) -> Scanlines:
    """Scanlines of a straight way to the north over a surface: height by station and across."""
    random = np.random.default_rng(8)
    stations = np.arange(0.0, length_m, SPACING_M)
    across = np.arange(-6.0, 6.0, 0.013)
    heights = [surface(station, across) for station in stations]
    seen = [np.isfinite(one) for one in heights]
    starts = np.cumsum([0, *(int(one.sum()) for one in seen)])
    height = np.concatenate([one[is_seen] for one, is_seen in zip(heights, seen, strict=True)])
    count = int(starts[-1])
    is_break = np.zeros(count, np.bool_)
    is_break[starts[:-1][np.diff(starts) > 0]] = True
    time = np.repeat(stations / 10.0, np.diff(starts))
    return Scanlines(
        number=0,
        stations_m=stations,
        positions=np.column_stack(
            [np.zeros_like(stations), stations, np.full_like(stations, 20.0)]
        ),
        rights=np.tile([1.0, 0.0], (stations.size, 1)),
        starts=starts.astype(np.int64),
        across_m=np.concatenate([across[is_seen] for is_seen in seen]),
        height_m=height + random.normal(0.0, noise_m, count),
        is_break=is_break,
        time_s=time,
        intensity=np.zeros(count, np.float32),
        point=np.arange(count),
    )


def curb(at: float, high: float, lean: float = 0.02) -> SurfaceFunction:
    """A curb on the right, its foot at a place."""
    return lambda _station, across: np.clip((across - at) / lean, 0.0, 1.0) * high


def found(surface: SurfaceFunction, noise_m: float = 0.004) -> tuple[StepRun, ...]:
    """The runs on a surface that are taken for curbs."""
    made = scanlines(surface, noise_m=noise_m)
    return remove_unlikely_runs(tuple(runs_of([made], 3, SETTINGS)), SETTINGS)


def test_a_curb_is_one_run_from_end_to_end_with_both_edges_where_they_are() -> None:
    (run,) = found(curb(3.0, 0.15))
    assert (run.drive, run.side, run.rises) == (3, 1, 1)
    assert run.stations_m.size >= 118
    assert np.abs(run.lower[:, 0] - 3.0).max() < 0.015
    assert np.abs(run.upper[:, 0] - 3.02).max() < 0.015
    assert np.abs(run.heights_m - 0.15).max() < 0.01
    assert run.is_seen.all()


def test_a_curb_on_the_left_and_the_far_edge_of_an_island_are_told_by_their_sides() -> None:
    def island(_station: float, across: Floats) -> Floats:
        return np.where((across > -4.0) & (across < -3.0), 0.15, 0.0)

    near, far = sorted(found(island), key=lambda run: -run.lower[0, 0])
    assert (near.side, near.rises) == (-1, 1)
    assert (far.side, far.rises) == (-1, -1)
    assert np.abs(near.upper[:, 0] + 3.0).max() < 0.03
    assert np.abs(far.upper[:, 0] + 4.0).max() < 0.03


def test_a_run_goes_on_behind_a_parked_car_and_says_where_it_was_not_seen() -> None:
    whole = curb(3.0, 0.15)

    def hidden(station: float, across: Floats) -> Floats:
        behind = (across > 2.0) & (4.0 < station < 8.0)
        return np.where(behind, np.nan, whole(station, across))

    (run,) = found(hidden)
    gap = (run.stations_m > 4.5) & (run.stations_m < 7.5)
    assert not run.is_seen[gap].any()
    assert run.is_seen[~((run.stations_m > 3.5) & (run.stations_m < 8.5))].all()
    assert np.abs(run.upper[:, 0] - 3.02).max() < 0.02


def test_a_dropped_curb_belongs_to_the_run_beside_it_and_keeps_its_height() -> None:
    def dropped(station: float, across: Floats) -> Floats:
        high = float(np.interp(station, [4.3, 5.0, 8.0, 8.7], [0.15, 0.02, 0.02, 0.15]))
        return curb(3.0, high)(station, across)

    (run,) = found(dropped, noise_m=0.003)
    middle = (run.stations_m > 5.6) & (run.stations_m < 7.4)
    assert abs(float(np.median(run.heights_m[middle])) - 0.02) < 0.008


def test_a_curb_across_the_way_is_a_run_from_left_to_right() -> None:
    def end(station: float, across: Floats) -> Floats:
        return np.where((across > 2.0) & (station > 6.0), 0.15, 0.0)

    runs = found(end)
    crossing = [run for run in runs if np.ptp(run.upper[:, 0]) > 2.0]
    assert len(crossing) == 1
    assert np.abs(crossing[0].upper[:, 1] - 6.05).max() < 0.1
    assert np.ptp(crossing[0].upper[:, 0]) > 3.5
    assert (crossing[0].rises > 0) == (crossing[0].side < 0)


def test_blades_that_hang_over_the_foot_do_not_hide_a_curb() -> None:
    def verge(_station: float, across: Floats) -> Floats:
        heights = np.where(across > 3.0, 0.15, 0.0)
        heights[np.searchsorted(across, [2.86, 2.95])] = 0.2
        return heights

    (run,) = found(verge)
    assert np.abs(run.lower[:, 0] - 3.0).max() < 0.1  # near enough to be measured
    assert np.median(run.foot_cover_m) > 0.03
    assert np.median(run.foot_roughness_m) < 0.01


def test_a_curb_behind_an_open_gutter_is_found() -> None:
    def gutter(_station: float, across: Floats) -> Floats:
        wall = np.interp(across, [2.87, 2.90], [-0.3, 0.0])
        is_hidden = (across > 2.60) & (across < 2.87)
        heights = np.where(across > 3.0, 0.15, np.where(across > 2.6, wall, 0.0))
        return np.where(is_hidden, np.nan, heights)

    runs = [run for run in found(gutter) if abs(np.median(run.lower[:, 0]) - 3.0) < 0.02]
    assert max(run.seen_m for run in runs) > 11.0
    assert all(np.median(run.foot_roughness_m) < 0.01 for run in runs)


def test_grass_beside_the_road_is_no_curb() -> None:
    random = np.random.default_rng(5)

    def grass(_station: float, across: Floats) -> Floats:
        return np.where(across > 3.0, random.uniform(0.0, 0.12, across.size), 0.0)

    assert found(grass) == ()


def test_a_ramp_and_a_kink_of_the_pavement_are_no_curbs() -> None:
    assert found(lambda _station, across: np.maximum(across - 3.0, 0.0) * 0.15) == ()


def test_the_foot_of_a_wall_is_no_curb() -> None:
    assert found(lambda _station, across: np.where(across > 3.0, 2.5, 0.0)) == ()


@pytest.mark.parametrize("fall", [0.0, 0.02])
def test_where_the_ground_falls_off_beside_the_road_is_no_curb(fall: float) -> None:
    def ditch(_station: float, across: Floats) -> Floats:
        return np.where((across > 3.0) & (across < 3.6), -0.4, 0.0) - fall * np.abs(across)

    assert all(run.rises > 0 for run in found(ditch))
    assert found(lambda _station, across: np.where(across > 3.0, -0.2, -fall * across)) == ()


def test_a_shoulder_that_falls_off_into_a_ditch_is_no_curb() -> None:
    def shoulder(_station: float, across: Floats) -> Floats:
        rise = 0.027 * np.clip((across - 1.5) / 1.0, 0.0, 1.0)
        return np.where(across > 3.0, -0.30, rise)

    assert found(shoulder) == ()


@pytest.mark.parametrize("is_fall_seen", [True, False])
def test_where_the_ground_comes_up_to_the_road_from_a_channel_is_no_curb(
    is_fall_seen: bool,
) -> None:
    def channel(_station: float, across: Floats) -> Floats:
        heights = np.where((across > 2.7) & (across < 3.0), -0.3, 0.0)
        is_hidden = (across > 2.7) & (across < 2.72 if is_fall_seen else across < 2.8)
        return np.where(is_hidden, np.nan, heights)

    assert not [run for run in found(channel) if run.rises > 0]


def test_what_the_ground_about_a_run_says_is_told_apart() -> None:
    def all_of(surface: SurfaceFunction) -> list[StepRun]:
        return [run for run in runs_of([scanlines(surface)], 3, SETTINGS) if run.seen_m > 5.0]

    (upright,) = all_of(curb(3.0, 0.15))
    assert curb_indications_of(upright) == (True, True)
    (bank,) = all_of(curb(3.0, 0.30, lean=0.28))
    assert curb_indications_of(bank) == (False, True)
    wall = all_of(lambda _, across: np.where((across > 2.7) & (across < 3.0), -0.3, 0.0))
    assert all(not curb_indications_of(run).is_of_road for run in wall)
    assert wall


def test_the_spread_alone_is_that_of_the_whole_run() -> None:
    steps = steps_of(scanlines(curb(3.0, 0.15)), SETTINGS)
    chain = max(chains_of(steps, SETTINGS), key=lambda one: one.rows.size)
    np.testing.assert_array_equal(spread_of(steps, chain), run_of(steps, chain, 0).spread_m)


def test_nothing_measured_gives_nothing() -> None:
    assert found(lambda _station, across: np.full(across.size, np.nan)) == ()

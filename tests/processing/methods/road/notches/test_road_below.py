"""The road below a vehicle, by rows of heads that look anywhere."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.road.gutters.notches.road_below import RowsOfBlock, road_below
from processing.recording.passes import Pass, passes_of_trajectory
from processing.recording.vehicle_path.trajectory import Trajectory

ROWS = 60


def way_east(height_m: float) -> Pass:
    """A straight drive along x on a road that rises 5 %."""
    times = np.arange(0.0, 6.0, 0.01)
    xyz = np.column_stack([8.0 * times, np.zeros_like(times), height_m + 0.4 * times])
    return passes_of_trajectory(Trajectory.from_positions(times, xyz))[0]


def rows_of(way: Pass, ahead_m: float, noise_m: float) -> RowsOfBlock:
    """Rows across the road that lie so far ahead of the vehicle, with a wall beside it."""
    random, across = np.random.default_rng(0), np.arange(-5.0, 5.0, 0.02)
    parts = []
    for row in range(ROWS):
        x = np.full(across.size, 10.0 + 0.1 * row + ahead_m)
        z = 0.05 * x + random.normal(0.0, noise_m, across.size) + np.where(across > 4.0, 1.0, 0.0)
        # Files are written in millimetres.
        parts.append(np.column_stack([x, across, np.round(z, 3)]) - way.origin)
    ends = across.size * np.arange(ROWS + 1)
    spans = np.column_stack([ends[:-1], ends[1:]])
    stations = 10.0 + 0.1 * np.arange(ROWS, dtype=np.float64)
    return RowsOfBlock(np.vstack(parts), np.arange(ends[-1]), spans, stations)


@pytest.mark.parametrize("height_m", [0.3, 1.6, 3.4])
@pytest.mark.parametrize("ahead_m", [-5.0, 0.0, 4.0])
def test_the_road_is_found_however_high_the_head_is_and_wherever_it_looks(
    height_m: float, ahead_m: float
) -> None:
    way = way_east(height_m)

    road = road_below(rows_of(way, ahead_m, 0.003), way)

    assert road is not None
    assert road.height_m == pytest.approx(height_m, abs=0.02)


@pytest.mark.parametrize("noise_m", [0.0012, 0.003, 0.0065])
def test_the_noise_is_measured_though_files_have_millimetres(noise_m: float) -> None:
    way = way_east(2.0)

    road = road_below(rows_of(way, -3.0, noise_m), way)

    assert road is not None
    assert road.noise_m == pytest.approx(noise_m, rel=0.1)


def test_rows_that_never_cross_the_vehicles_path_say_nothing() -> None:
    way = way_east(2.0)
    rows = rows_of(way, 0.0, 0.003)
    beside = RowsOfBlock(
        rows.xyz + np.array([0.0, 40.0, 0.0]), rows.pulse, rows.spans, rows.stations
    )

    assert road_below(beside, way) is None

"""The density in closed form is what beams that are sent one by one leave on road and wall."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.errors import OutOfRange
from processing.laboratory.simulate.scanning.beams import head_axes
from processing.laboratory.simulate.scanning.density import (
    DrivingSensor,
    density_map,
    road_density,
    survey_of,
    wall_density,
)
from processing.laboratory.simulate.scanning.sensors import SENSORS

MOBILE = [one.id for one in SENSORS.values() if one.kind == "mobile"]
DRIVEN_M = 40.0
FROM_M, TO_M = 12.0, 28.0
CELL_M = 1.0


def beams(survey: DrivingSensor, head: int) -> tuple[np.ndarray, np.ndarray]:
    """Origins and ways of all pulses of a straight drive along x."""
    one = survey.heads[head]
    first, second, _ = head_axes(one).T
    times = np.arange(0, DRIVEN_M / survey.speed_m_s, 1 / (survey.turns_per_s * survey.pulses))
    angles = 2 * np.pi * survey.turns_per_s * times
    directions = np.cos(angles)[:, None] * first + np.sin(angles)[:, None] * second
    origins = np.add(one.lever_m, (0.0, 0.0, survey.height_m))
    return origins + np.outer(times * survey.speed_m_s, [1.0, 0.0, 0.0]), directions


def met(survey: DrivingSensor, plane: int, at_m: float) -> np.ndarray:
    """Where all beams of all heads meet the plane on which a coordinate has a value."""
    found = []
    for head in range(len(survey.heads)):
        origins, directions = beams(survey, head)
        with np.errstate(divide="ignore", invalid="ignore"):
            ranges = (at_m - origins[:, plane]) / directions[:, plane]
        is_met = (ranges > 0) & (ranges <= survey.most_m)
        found.append(origins[is_met] + ranges[is_met, None] * directions[is_met])
    return np.concatenate(found)


def counted(positions: np.ndarray, other: int, edges: np.ndarray) -> np.ndarray:
    """Points per square metre between edges of another coordinate, in the middle of the drive."""
    inside = positions[(positions[:, 0] >= FROM_M) & (positions[:, 0] < TO_M)]
    numbers, _ = np.histogram(inside[:, other], edges)
    return numbers / (CELL_M * (TO_M - FROM_M))


@pytest.mark.parametrize("sensor", MOBILE)
def test_points_counted_on_a_flat_road_are_as_dense_as_is_told(sensor: str) -> None:
    survey = survey_of(SENSORS[sensor], 37.3, pulses=5000, turns_per_s=20.0)
    edges = np.arange(-8.0, 8.1, CELL_M)
    told = np.array([road_density(survey, np.linspace(low, low + 1, 21)).mean() for low in edges])
    found = counted(met(survey, 2, 0.0), 1, edges)
    np.testing.assert_allclose(found, told[:-1], rtol=0.05)


@pytest.mark.parametrize("side_m", [-6.0, 4.0])
@pytest.mark.parametrize("sensor", ["vq250", "zf9012"])
def test_points_counted_on_a_wall_are_as_dense_as_is_told(sensor: str, side_m: float) -> None:
    survey = survey_of(SENSORS[sensor], 18.0, pulses=4000, turns_per_s=20.0)
    edges = np.arange(0.0, 6.1, CELL_M)
    told = [wall_density(survey, side_m, np.linspace(low, low + 1, 21)).mean() for low in edges]
    found = counted(met(survey, 1, side_m), 2, edges)
    np.testing.assert_allclose(found, told[:-1], rtol=0.05)


def test_twice_the_speed_halves_the_density() -> None:
    slow, fast = (survey_of(SENSORS["vq250"], speed) for speed in (20.0, 40.0))
    np.testing.assert_allclose(road_density(slow, [0, 9]), 2 * road_density(fast, [0, 9]))
    assert fast.between_revolutions_m == pytest.approx(2 * slow.between_revolutions_m)


def test_two_heads_measure_both_sides_alike() -> None:
    found = density_map(survey_of(SENSORS["vq250"], 40.0))
    np.testing.assert_allclose(found.road, found.road[::-1])
    np.testing.assert_allclose(found.wall, found.wall[:, ::-1])
    assert np.isnan(found.wall[:, np.abs(found.across_m) < 1]).all()


def test_nothing_is_measured_out_of_reach() -> None:
    near = survey_of(SENSORS["vux1ha"], 40.0)
    assert road_density(near, 149.0) > 0
    assert road_density(near, 151.0) == 0


def test_a_vehicle_that_stands_has_no_density() -> None:
    with pytest.raises(OutOfRange, match="needs a speed"):
        survey_of(SENSORS["vq250"], 0.0)

"""Passes: the vehicle's path is smooth and measured in metres, whatever its records are like."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.recording.passes import Pass, passes_of_trajectory
from processing.recording.vehicle_path.trajectory import Trajectory

FAR = np.array([-11_000.0, -35_000.0, 40.0])


def driven(time: Floats, plan: Floats) -> Trajectory:
    """A trajectory through places in plan, (m, 2), about a far origin."""
    return Trajectory.from_positions(time, np.column_stack([plan, np.zeros(len(plan))]) + FAR)


def straight(rate_hz: float, *, speed: float = 10.0, length_m: float = 100.0) -> Trajectory:
    """Due north."""
    time = np.arange(0.0, length_m / speed + 1e-9, 1.0 / rate_hz)
    return driven(time, np.column_stack([np.zeros(time.size), speed * time]))


def only(trajectory: Trajectory) -> Pass:
    (one,) = passes_of_trajectory(trajectory)
    return one


@pytest.mark.parametrize("rate_hz", [1.0, 10.0, 200.0])
def test_stations_are_metres_from_the_first_record(rate_hz: float) -> None:
    vehicle_path = only(straight(rate_hz))
    assert vehicle_path.length_m == pytest.approx(100.0, abs=1e-6)
    np.testing.assert_allclose(
        vehicle_path.station_at([0.0, 2.5, 10.0]), [0.0, 25.0, 100.0], atol=1e-6
    )
    np.testing.assert_allclose(
        vehicle_path.positions_at([30.0])[0], FAR + np.array([0.0, 30.0, 0.0]), atol=1e-6
    )
    np.testing.assert_allclose(vehicle_path.rights_at([30.0])[0], [1.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(vehicle_path.time_at([25.0]), [2.5], atol=1e-6)


def test_places_beside_a_bend_have_the_station_of_the_radius_through_them() -> None:
    radius, speed, random = 15.0, 5.0, np.random.default_rng(3)
    time = np.arange(0.0, 6.0, 0.005)
    angle = speed * time / radius
    vehicle_path = only(
        driven(time, radius * np.column_stack([1.0 - np.cos(angle), np.sin(angle)]))
    )
    when = random.uniform(1.6, 4.4, 500)
    ahead = random.uniform(-0.3, 0.3, 500)
    across = random.uniform(-14.0, 10.0, 500)  # the centre lies at the right
    turned = speed * when / radius + ahead
    beside = radius - across
    east, north = radius - beside * np.cos(turned), beside * np.sin(turned)
    positions = FAR + np.column_stack([east, north, np.zeros(500)])
    station, found = vehicle_path.stations_of(positions, when)
    # Averaging along the way leads it a few centimetres inside of the bend.
    inside = radius - float(
        np.hypot(
            *((vehicle_path.positions_at([vehicle_path.length_m / 2]) - FAR)[0, :2] - [radius, 0.0])
        )
    )
    assert 0.0 < inside < 0.05
    np.testing.assert_allclose(found, across - inside, atol=2e-3)
    np.testing.assert_allclose(station / vehicle_path.length_m * angle[-1], turned, atol=1e-3)


def test_beyond_the_centre_of_a_bend_nothing_is_told() -> None:
    radius, time = 8.0, np.arange(0.0, 4.0, 0.005)
    angle = 4.0 * time / radius
    vehicle_path = only(
        driven(time, radius * np.column_stack([1.0 - np.cos(angle), np.sin(angle)]))
    )
    middle = vehicle_path.xyz_at([vehicle_path.length_m / 2] * 2, [3.0, 7.5])
    station, across = vehicle_path.stations_of(middle, np.full(2, 2.0))
    assert across[0] == pytest.approx(3.0, abs=1e-3)
    assert station[0] == pytest.approx(vehicle_path.length_m / 2, abs=1e-3)
    assert np.isnan([station[1], across[1]]).all()


def test_a_trembling_vehicle_drives_straight_and_stands_still() -> None:
    random = np.random.default_rng(5)
    time = np.arange(0.0, 40.0, 0.005)
    north = np.interp(time, [0.0, 5.0, 35.0, 40.0], [0.0, 40.0, 40.0, 80.0])
    plan = np.column_stack([np.zeros(time.size), north]) + random.normal(0, 0.02, (time.size, 2))
    vehicle_path = only(driven(time, plan))
    assert vehicle_path.length_m == pytest.approx(80.0, abs=0.2)
    stations = vehicle_path.station_at(np.linspace(0, 40, 999))
    assert (np.diff(stations) >= 0).all()
    assert vehicle_path.station_at([35.0])[0] - vehicle_path.station_at([5.0])[0] < 0.2
    turned = np.degrees(np.arctan2(*vehicle_path.directions_at(np.arange(1.0, 79.0, 0.1)).T))
    assert np.abs(turned).max() < 1.0


def test_a_way_back_is_a_pass_of_its_own() -> None:
    time = np.arange(0.0, 20.0, 0.01)
    north = np.interp(time, [0.0, 9.0, 11.0, 20.0], [0.0, 36.0, 36.0, 0.0])
    there, back = passes_of_trajectory(driven(time, np.column_stack([0.001 * time, north])))
    assert there.length_m == pytest.approx(36.0, abs=0.1)
    assert back.length_m == pytest.approx(36.0, abs=0.1)
    assert there.times[-1] == back.times[0]
    np.testing.assert_allclose(back.rights_at([9.0])[0], [-1.0, 0.0], atol=0.01)
    position = FAR + np.array([2.0, 10.0, 0.0])
    np.testing.assert_allclose(there.stations_of(position, [2.5]), [[10.0], [2.0]], atol=0.05)
    np.testing.assert_allclose(back.stations_of(position, [17.5]), [[26.0], [-2.0]], atol=0.05)


def test_a_place_beside_both_arms_of_a_turn_belongs_to_the_arm_of_its_time() -> None:
    arc = np.linspace(0.0, np.pi, 60)[1:]
    up = np.column_stack([np.zeros(100), np.linspace(0.0, 30.0, 100)])
    round_ = np.column_stack([6.0 - 6.0 * np.cos(arc), 30.0 + 6.0 * np.sin(arc)])
    down = np.column_stack([np.full(100, 12.0), np.linspace(30.0, 0.0, 101)[1:]])
    plan = np.concatenate([up, round_, down])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(plan, axis=0).T))])
    vehicle_path = only(driven(along / 4.0, plan))
    position = np.tile(FAR + np.array([6.0, 12.0, 0.0]), (2, 1))
    times = np.array([12.0, along[-1] - 12.0]) / 4.0
    station, across = vehicle_path.stations_of(position, times)
    np.testing.assert_allclose(station, [12.0, vehicle_path.length_m - 12.0], atol=0.2)
    np.testing.assert_allclose(across, [6.0, 6.0], atol=0.05)


def test_a_gap_in_the_trajectory_ends_a_pass_and_a_standing_vehicle_has_none() -> None:
    whole = straight(10.0)
    kept = (whole.time < 4.0) | (whole.time > 9.5)
    first, second = passes_of_trajectory(
        Trajectory.from_positions(whole.time[kept], whole.xyz[kept])
    )
    assert first.times[-1] < 4.0 < 9.5 < second.times[0]
    station, across = first.stations_of(FAR + np.array([1.0, 60.0, 0.0]), [6.0])
    assert np.isnan([station[0], across[0]]).all()
    time = np.arange(0.0, 60.0, 0.1)
    trembling = np.random.default_rng(1).normal(0, 0.03, (time.size, 2))
    assert passes_of_trajectory(driven(time, trembling)) == ()

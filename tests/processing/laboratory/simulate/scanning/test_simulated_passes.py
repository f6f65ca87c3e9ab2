"""How the vehicle drives: what the delivered trajectory says is how it was."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scanning.simulated_passes import Driving, SimulatedPass, pass_of
from processing.laboratory.simulate.street.styles import RURAL, URBAN
from processing.recording.vehicle_path.trajectory import Trajectory


def _pass(number: int = 0, length_m: float = 80.0, *, stops: bool = False) -> SimulatedPass:
    return pass_of(Street(5, URBAN, length_m), number, Driving(9.0, stops, 0.01))


def test_the_delivered_angles_turn_the_vehicle_as_it_truly_was() -> None:
    driven = _pass()
    delivered = Trajectory(driven.time_s, driven.positions, driven.angles_deg, has_attitude=True)
    assert np.abs(delivered.rotations_at(driven.time_s) - driven.rotations).max() < 1e-9


@pytest.mark.parametrize("number", [0, 1])
def test_the_vehicle_looks_where_it_drives(number: int) -> None:
    driven = _pass(number)
    steps = np.diff(driven.positions, axis=0)
    steps /= np.linalg.norm(steps, axis=1)[:, None]
    assert (np.einsum("ij,ij->i", steps, driven.rotations[1:, :, 0]) > 0.995).all()


def test_a_second_pass_comes_back_on_the_other_side() -> None:
    street = Street(5, URBAN, 80.0)
    there, back = (
        pass_of(street, number, Driving(9.0, stops=False, drift_m=0.0)) for number in (0, 1)
    )
    assert back.chainages[0] > back.chainages[-1]
    for driven, side in ((there, 1), (back, -1)):
        centre = street.alignment.at(driven.chainages, 0.0, driven.positions[:, 2])
        left = street.alignment.at(driven.chainages, 1.0, driven.positions[:, 2]) - centre
        beside = np.einsum("ij,ij->i", driven.positions - centre, left)
        assert (side * beside > 0.5).all()


def test_it_stands_still_where_it_waits() -> None:
    driven = _pass(stops=True)
    speed = np.linalg.norm(np.diff(driven.positions, axis=0), axis=1) * 200
    assert (speed < 0.3).sum() > 2 * 200


def test_a_longer_drive_begins_like_a_shorter_one() -> None:
    short, long = _pass(length_m=60.0), _pass(length_m=200.0)
    same = short.time_s.size - 400
    assert np.array_equal(short.positions[:same], long.positions[:same])


def test_errors_of_the_attitude_are_delivered_as_small_turns() -> None:
    street = Street(5, URBAN, 60.0)
    driven = pass_of(street, 0, Driving(9.0, stops=False, drift_m=0.0, attitude_deg=0.05))
    delivered = Trajectory(driven.time_s, driven.positions, driven.delivered_deg, has_attitude=True)
    axes = driven.rotations
    turned = axes + np.cross(np.einsum("nij,nj->ni", axes, driven.turned_rad)[:, None], axes.mT).mT
    assert np.abs(driven.turned_rad).max() > 2e-4
    assert np.abs(delivered.rotations_at(driven.time_s) - turned).max() < 5e-5


def test_the_error_of_the_trajectory_is_as_large_as_was_wished() -> None:
    street = Street(8, RURAL, 20_000.0)
    driven = pass_of(street, 0, Driving(10.0, stops=False, drift_m=0.02))
    assert driven.errors.std() == pytest.approx(0.02, rel=0.3)
    assert np.abs(np.diff(driven.errors, axis=0)).max() < 1e-4

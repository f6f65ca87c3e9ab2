"""Where the vehicle was and how it was turned, between the records of its trajectory."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import OutOfRange
from processing.recording.vehicle_path.trajectory import Trajectory, _mark_steps_kernel

_FORWARD, _LEFT, _UP = 0, 1, 2


def _standing(*angles: tuple[float, float, float], step_s: float = 1.0) -> Trajectory:
    """A vehicle at one place, with these rolls, pitches and headings."""
    count = len(angles)
    time = 100.0 + step_s * np.arange(count)
    return Trajectory(time, np.tile([10.0, 20.0, 30.0], (count, 1)), np.array(angles), True)


def _axes(roll: float, pitch: float, heading: float) -> NDArray[np.float64]:
    """Forward, left and up by plain trigonometry, as columns."""
    r, p, h = np.radians([roll, pitch, heading])
    forward = np.array([np.sin(h) * np.cos(p), np.cos(h) * np.cos(p), np.sin(p)])
    left = np.array([-np.cos(h), np.sin(h), 0.0])
    up = np.cross(forward, left)
    return np.column_stack(
        [forward, left * np.cos(r) + up * np.sin(r), up * np.cos(r) - left * np.sin(r)]
    )


@pytest.mark.parametrize(
    ("angles", "axis", "wanted"),
    [
        ((0, 0, 0), _FORWARD, (0, 1, 0)),
        ((0, 0, 90), _FORWARD, (1, 0, 0)),
        ((0, 0, 90), _LEFT, (0, 1, 0)),
        ((0, 90, 0), _FORWARD, (0, 0, 1)),
        ((90, 0, 0), _LEFT, (0, 0, 1)),
        ((90, 0, 0), _UP, (1, 0, 0)),
    ],
)
def test_heading_is_clockwise_pitch_lifts_the_nose_and_roll_lowers_the_right_side(
    angles: tuple[float, float, float], axis: int, wanted: tuple[float, float, float]
) -> None:
    rotation = _standing(angles, angles).rotations_at([100.5])[0]
    np.testing.assert_allclose(rotation[:, axis], wanted, atol=1e-12)


def test_rotations_at_the_records_are_those_of_the_angles() -> None:
    random = np.random.default_rng(0)
    angles = np.cumsum(random.normal(0, 20, (200, 3)), axis=0) % 360 - 180
    angles[:, 1] /= 2.5
    trajectory = _standing(*map(tuple, angles))
    found = trajectory.rotations_at(trajectory.time)
    np.testing.assert_allclose(found, [_axes(*row) for row in angles], atol=1e-12)


@pytest.mark.parametrize(("first", "second"), [(359.0, 1.0), (1.0, 359.0), (-1.0, 361.0)])
def test_a_heading_through_north_does_not_turn_around(first: float, second: float) -> None:
    trajectory = _standing((0, 0, first), (0, 0, second))
    forward = trajectory.rotations_at([100.5])[0][:, _FORWARD]
    np.testing.assert_allclose(forward, [0, 1, 0], atol=1e-12)


def test_positions_lie_on_the_line_between_records() -> None:
    time, xyz = np.array([0.0, 2.0, 3.0]), np.array([[0.0, 0, 0], [2, 4, 6], [2, 4, 7]])
    trajectory = Trajectory(time, xyz, np.zeros((3, 3)), True)
    found = trajectory.positions_at([0.0, 0.5, 2.5, 3.0])
    np.testing.assert_allclose(found, [[0, 0, 0], [0.5, 1, 1.5], [2, 4, 6.5], [2, 4, 7]])


def test_points_in_the_vehicle_are_turned_and_moved_back() -> None:
    random = np.random.default_rng(3)
    angles = random.uniform(-30, 30, (20, 3))
    trajectory = _standing(*map(tuple, angles))
    times, xyz = random.uniform(100, 119, 500), random.normal(0, 50, (500, 3))
    away = xyz - trajectory.positions_at(times)
    wanted = np.einsum("nji,nj->ni", trajectory.rotations_at(times), away)
    np.testing.assert_allclose(trajectory.to_vehicle(xyz, times), wanted, atol=1e-10)
    position = trajectory.to_vehicle([[10.0, 21.0, 30.5]], [100.0])
    np.testing.assert_allclose(np.linalg.norm(position), np.hypot(1.0, 0.5))


def test_times_outside_and_inside_long_gaps_are_not_covered() -> None:
    time = np.array([0.0, 1.0, 5.5, 20.0, 21.0])
    trajectory = Trajectory(time, np.zeros((5, 3)), np.zeros((5, 3)), True)
    asked = [-0.1, 0.0, 3.0, 5.5, 5.6, 19.9, 20.0, 21.0, 21.1, np.nan]
    wanted = [False, True, True, True, False, False, True, True, False, False]
    assert trajectory.covers(asked).tolist() == wanted
    for bad in (-0.1, 10.0, 21.1, np.nan):
        with pytest.raises(OutOfRange, match=r"0\.000 to 21\.000 s"):
            trajectory.positions_at([0.5, bad])
        with pytest.raises(OutOfRange):
            trajectory.rotations_at([0.5, bad])


def test_headings_come_from_the_motion_and_stay_at_a_stop() -> None:
    easting = np.concatenate([np.linspace(0, 10, 21), np.full(50, 10.0), np.linspace(10, 20, 21)])
    xyz = np.column_stack([easting, np.zeros(92), 0.1 * easting])
    xyz[21:71, :2] += np.random.default_rng(0).normal(0, 0.01, (50, 2))
    trajectory = Trajectory.from_positions(np.arange(92) * 0.1, xyz)
    roll, pitch, heading = trajectory.roll_pitch_heading_deg.T
    np.testing.assert_allclose(heading, 90.0, atol=3.0)
    np.testing.assert_allclose(pitch, np.degrees(np.arctan(0.1)), atol=0.5)
    assert not roll.any()
    assert not trajectory.has_attitude


def test_a_vehicle_that_never_moves_faces_north() -> None:
    trajectory = Trajectory.from_positions([0.0, 1.0, 2.0], np.zeros((3, 3)))
    assert not trajectory.roll_pitch_heading_deg.any()


@pytest.mark.parametrize("time", [[0.0], [0.0, 0.0], [1.0, 0.0], [0.0, np.nan]])
def test_times_that_do_not_rise_can_not_become_a_trajectory(time: list[float]) -> None:
    count = len(time)
    with pytest.raises(ValueError, match="trajectory"):
        Trajectory(np.array(time), np.zeros((count, 3)), np.zeros((count, 3)), True)


def test_the_kernel_marks_what_plain_python_marks() -> None:
    xyz = np.cumsum(np.random.default_rng(1).normal(0, 0.1, (300, 3)), axis=0)
    compiled, plain = np.zeros(300, dtype=np.bool_), np.zeros(300, dtype=np.bool_)
    _mark_steps_kernel(xyz, 0.25, compiled)
    _mark_steps_kernel.py_func(xyz, 0.25, plain)
    np.testing.assert_array_equal(compiled, plain)
    kept = xyz[plain, :2]
    assert (np.linalg.norm(np.diff(kept, axis=0), axis=1) >= 0.25).all()

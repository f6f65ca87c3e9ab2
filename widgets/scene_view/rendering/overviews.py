"""Where to look from at first: along the drive, from above, at everything, at a selection."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from itertools import product

import numpy as np

from processing.core.arrays import Floats
from processing.recording.drive import Drive
from widgets.scene_view.rendering.camera import SceneCamera

_BEHIND_M, _ABOVE_M = 14.0, 9.0
_START_M, _START_SHARE, _START_ABOVE_M, _AHEAD_M = 8.0, 0.2, 6.0, 22.0
"""At first: so far from the drive's beginning, at most that share of it, so high above the road,
looking so far ahead; points lie all around, and nothing between the eye and the road."""

_ROAD_BELOW_M = 2.0
"""The trajectory is that of the vehicle; its road lies about so much lower."""

_LOWEST_EYE_M = 0.3
_STREET_M = 20.0
"""So far beside the path the road says where the ground is."""

_LOOK_AHEAD_M = 8.0
_OBLIQUE_DEG = -35.0
_ROOM = 1.15
_LEAST_M = 2.0
_MOST_POSES = 20_000


def along_path(vehicle_path: Floats, near: Floats | None = None) -> SceneCamera:
    """Forwards from above the vehicle's path: at a place, or near the beginning of the drive.

    Parameters
    ----------
    vehicle_path : (m, 3) float64
        As :func:`path_of_drive` gives it.
    near : (3,) float64, optional
        The place to be seen from behind, metres from the origin; otherwise the drive's beginning.
    """
    at = _start_of(vehicle_path) if near is None else _nearest(vehicle_path, near)
    heading_deg = _heading_deg(vehicle_path, at)
    heading = math.radians(heading_deg)
    ahead = np.array([math.sin(heading), math.cos(heading), 0.0])
    road = vehicle_path[at] - [0.0, 0.0, _ROAD_BELOW_M]
    if near is None:
        target, position = road + ahead * _AHEAD_M, road + np.array([0.0, 0.0, _START_ABOVE_M])
    else:
        target, position = near, near - ahead * _BEHIND_M + [0.0, 0.0, _ABOVE_M]
    away = target - position
    pitch_deg = math.degrees(math.atan2(away[2], math.hypot(away[0], away[1])))
    return SceneCamera(
        position=(float(position[0]), float(position[1]), float(position[2])),
        heading_deg=heading_deg,
        pitch_deg=pitch_deg,
        distance_m=float(np.linalg.norm(away)),
    )


def above_ground(camera: SceneCamera, vehicle_path: Floats) -> SceneCamera:
    """The camera, lifted where it would be below the road beside the vehicle's path."""
    eye = np.array(camera.position)
    at = _nearest(vehicle_path, eye)
    lowest = float(vehicle_path[at, 2]) - _ROAD_BELOW_M + _LOWEST_EYE_M
    if eye[2] >= lowest or np.hypot(*(vehicle_path[at, :2] - eye[:2])) > _STREET_M:
        return camera
    return replace(camera, position=(camera.position[0], camera.position[1], lowest))


def course_deg(vehicle_path: Floats, near: Floats) -> float:
    """Direction of a way at a place, clockwise from grid north."""
    return _heading_deg(vehicle_path, _nearest(vehicle_path, near))


def holding(positions: Floats, camera: SceneCamera) -> SceneCamera:
    """All places in the picture, seen from the same side.

    Parameters
    ----------
    positions : (n, 3) float64
        Metres from the origin; n >= 1.
    """
    middle = (positions.min(axis=0) + positions.max(axis=0)) / 2
    right, up, forward = ((positions - middle) @ camera.axes.T).T
    slope = math.tan(math.radians(camera.angle_deg) / 2)
    # Views are at least as wide as they are high, as a rule.
    needed = np.maximum(np.maximum(np.abs(right), np.abs(up)), _LEAST_M) / slope - forward
    return camera.centred_on(middle, _ROOM * float(needed.max()))


def oblique(drives: Iterable[Drive], origin: Floats) -> SceneCamera | None:
    """Everything from the south, halfway from above; None when there are no drives."""
    boxes = [(drive.info.lowest, drive.info.highest) for drive in drives]
    if not boxes:
        return None
    corners = [corner for low, high in boxes for corner in product(*zip(low, high, strict=True))]
    view = SceneCamera((0.0, 0.0, 0.0), heading_deg=0.0, pitch_deg=_OBLIQUE_DEG)
    return holding(np.array(corners) - origin, view)


def path_of_drive(drive: Drive, origin: Floats) -> Floats | None:
    """Where the vehicle was while this drive's points were measured; None without a trajectory.

    Returns
    -------
    (m, 3) float64
        Metres from the origin. Of a long drive some poses are left out: the camera asks for every
        turn of the wheel.
    """
    trajectory = drive.trajectory
    if trajectory is None:
        return None
    low, high = np.array(drive.info.lowest), np.array(drive.info.highest)
    inside = ((trajectory.xyz >= low) & (trajectory.xyz <= high))[:, :2].all(axis=1)
    vehicle_path: Floats = (trajectory.xyz[inside] if inside.any() else trajectory.xyz) - origin
    return np.ascontiguousarray(vehicle_path[:: max(1, len(vehicle_path) // _MOST_POSES)])


def _nearest(vehicle_path: Floats, near: Floats) -> int:
    return int(np.hypot(*(vehicle_path[:, :2] - near[:2]).T).argmin())


def _start_of(vehicle_path: Floats) -> int:
    """Where the drive is well under way."""
    steps = np.hypot(*np.diff(vehicle_path[:, :2], axis=0).T)
    gone = np.concatenate([[0.0], np.cumsum(steps)])
    return int(np.searchsorted(gone, min(_START_M, _START_SHARE * gone[-1])))


def _heading_deg(vehicle_path: Floats, at: int) -> float:
    gone = np.hypot(*(vehicle_path[:, :2] - vehicle_path[at, :2]).T)
    ahead = np.flatnonzero(gone[at:] >= _LOOK_AHEAD_M)
    start, stop = at, at + int(ahead[0]) if ahead.size else len(vehicle_path) - 1
    if gone[stop] < _LOOK_AHEAD_M:  # the end is near: how it came here
        before = np.flatnonzero(gone[: at + 1] >= _LOOK_AHEAD_M)
        start = int(before[-1]) if before.size else 0
    step = vehicle_path[stop] - vehicle_path[start]
    return math.degrees(math.atan2(step[0], step[1])) % 360.0

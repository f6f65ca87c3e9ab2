"""Trajectories written: the program's own CSV, and SBET."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.formats.trajectories.sbet import bearings_of_north, record_type
from processing.formats.trajectories.trajectory_csv import OWN_COLUMNS
from processing.recording.vehicle_path.trajectory import Trajectory


def write_trajectory_csv(path: Path, trajectory: Trajectory) -> None:
    """Write a trajectory as a table in its own coordinates.

    Raises
    ------
    NoSpace, MissingInput
        The file can't be written.
    """
    table = np.column_stack([trajectory.time, trajectory.xyz, trajectory.roll_pitch_heading_deg])
    with report_as_user_error(path):
        np.savetxt(
            path,
            table,
            fmt=["%.6f", "%.5f", "%.5f", "%.5f", "%.6f", "%.6f", "%.6f"],
            delimiter=",",
            comments="",
            header=",".join(OWN_COLUMNS),
            encoding="utf-8",
        )


def write_sbet(path: Path, trajectory: Trajectory, crs: str) -> None:
    """Write a trajectory as an SBET of the datum of its projected system.

    The wander angle is 0. Velocities follow from the positions; accelerations and turning rates,
    which a trajectory of places and angles doesn't tell, are 0.

    Raises
    ------
    OutOfRange
        ``crs`` is unknown or not projected.
    NoSpace, MissingInput
        The file can't be written.
    """
    longitude, latitude, bearing = bearings_of_north(trajectory.xyz[:, :2], crs, path)
    angles = np.radians(trajectory.roll_pitch_heading_deg)
    records: NDArray[np.void] = np.zeros(trajectory.time.size, record_type())
    records["time"] = trajectory.time
    records["latitude"], records["longitude"] = np.radians(latitude), np.radians(longitude)
    records["height"] = trajectory.xyz[:, 2]
    records["roll"], records["pitch"] = angles[:, 0], angles[:, 1]
    heading = angles[:, 2] - bearing
    records["heading"] = np.arctan2(np.sin(heading), np.cos(heading))
    east, north, up = np.gradient(trajectory.xyz, trajectory.time, axis=0).T
    # From grid axes to those of true north, in which the wander frame lies when its angle is 0.
    records["vx"] = north * np.cos(bearing) + east * np.sin(bearing)
    records["vy"] = -north * np.sin(bearing) + east * np.cos(bearing)
    records["vz"] = -up
    with report_as_user_error(path):
        path.write_bytes(records.tobytes())

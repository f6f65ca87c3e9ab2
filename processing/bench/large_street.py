"""Large recordings for benchmarks: the sample street, driven on and on."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
from numpy.typing import NDArray

from processing.formats.trajectory_files import read_trajectory
from processing.points.trajectory import Trajectory
from resources import path_of

_TRAJECTORY_HEADER = "time_s,easting_m,northing_m,height_m,roll_deg,pitch_deg,heading_deg"


def write_large_street(folder: Path, points: int, scanner: str = "left") -> tuple[Path, Path]:
    """Write a recording of at least some millions of points, and its trajectory.

    The sample's points repeat, each time later by its duration and further by its length, so
    times, rows and pulses go on as in one long drive.

    Parameters
    ----------
    points : int
        Wanted number; the last repetition is cut.
    scanner : {"left", "right"}

    Returns
    -------
    tuple of Path
        The LAZ file and the trajectory CSV.
    """
    street = path_of("sample_street")
    trajectory = read_trajectory(street / "trajectory.csv", "")
    with laspy.open(street / f"{scanner}.laz") as reader:
        sample = reader.read()
    # A whole number of turns and pulses keeps the clock's rhythm across the seam.
    duration = np.ceil((float(sample.gps_time[-1]) - float(sample.gps_time[0])) * 100.0) / 100.0
    start, end = trajectory.positions_at([sample.gps_time[0], sample.gps_time[0] + duration])
    step = np.rint((end - start) / sample.header.scales).astype(np.int64)
    cloud_path = folder / f"{scanner}-{points}.laz"
    _write_points(cloud_path, sample, points, duration, step)
    path = folder / f"{scanner}-{points}.csv"
    repeats = -(-points // len(sample.points))
    shift = step * sample.header.scales
    table = _repeated(trajectory, float(sample.gps_time[0]), duration, shift, repeats)
    np.savetxt(
        path,
        table,
        delimiter=",",
        header=_TRAJECTORY_HEADER,
        comments="",
        fmt=["%.6f", "%.5f", "%.5f", "%.5f", "%.6f", "%.6f", "%.6f"],
    )
    return cloud_path, path


def _write_points(
    path: Path, sample: laspy.LasData, points: int, duration: float, step: NDArray[np.int64]
) -> None:
    left, number = points, 0
    with laspy.open(path, mode="w", header=sample.header) as writer:
        while left > 0:
            record = sample.points[: min(left, len(sample.points))].copy()
            record["gps_time"] = record["gps_time"] + number * duration
            for axis, name in enumerate("XYZ"):
                record[name] = record[name] + int(step[axis]) * number
            writer.write_points(record)
            left -= len(record)
            number += 1


def _repeated(
    trajectory: Trajectory,
    start: float,
    duration: float,
    shift: NDArray[np.float64],
    repeats: int,
) -> NDArray[np.float64]:
    """The way of the vehicle, before the first point, again and again, and a little beyond."""
    table = np.column_stack([trajectory.time, trajectory.xyz, trajectory.roll_pitch_heading_deg])
    inside = table[(trajectory.time >= start) & (trajectory.time < start + duration)]
    moved = np.concatenate([[duration], shift, np.zeros(3)])
    again = [inside + number * moved for number in range(repeats)]
    end = again[-1][-1] + np.array([0.1, 0, 0, 0, 0, 0, 0])
    return np.vstack([table[trajectory.time < start], *again, end])

"""Large recordings for benchmarks: the sample street, driven on and on."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np

from processing.formats.trajectory_files import read_trajectory
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
    repeats = -(-points // len(sample.points))
    with laspy.open(cloud_path, mode="w", header=sample.header) as writer:
        left = points
        for number in range(repeats):
            record = sample.points[: min(left, len(sample.points))].copy()
            record["gps_time"] = record["gps_time"] + number * duration
            for axis, name in enumerate("XYZ"):
                record[name] = record[name] + int(step[axis]) * number
            writer.write_points(record)
            left -= len(record)
    inside = (trajectory.time >= sample.gps_time[0]) & (
        trajectory.time < sample.gps_time[0] + duration
    )
    rows = []
    for number in range(repeats):
        table = np.column_stack(
            [
                trajectory.time[inside] + number * duration,
                trajectory.xyz[inside] + number * step * sample.header.scales,
                trajectory.roll_pitch_heading_deg[inside],
            ]
        )
        rows.append(table)
    before = trajectory.time < sample.gps_time[0]
    lead = [trajectory.time, trajectory.xyz, trajectory.roll_pitch_heading_deg]
    whole = np.vstack([np.column_stack([part[before] for part in lead]), *rows])
    tail = whole[-1].copy()
    tail[0] += 0.1
    path = folder / f"{scanner}-{points}.csv"
    np.savetxt(
        path,
        np.vstack([whole, tail]),
        delimiter=",",
        header=_TRAJECTORY_HEADER,
        comments="",
        fmt=["%.6f", "%.5f", "%.5f", "%.5f", "%.6f", "%.6f", "%.6f"],
    )
    return cloud_path, path

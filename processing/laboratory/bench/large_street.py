"""Large recordings for benchmarks: the sample street, driven on and on, or laid side by side."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

import laspy
import numpy as np
from numpy.typing import NDArray

from processing.formats.trajectories.trajectory_files import read_trajectory
from processing.recording.vehicle_path.trajectory import Trajectory
from resources import path_of

_TRAJECTORY_HEADER = "time_s,easting_m,northing_m,height_m,roll_deg,pitch_deg,heading_deg"
_TURNS_PER_S = 100.0


@dataclass(frozen=True)
class LongDelivery:
    """A delivery of one long drive.

    Attributes
    ----------
    clouds : tuple of Path
        LAZ files; those of a scanner follow each other in time.
    trajectory : Path
        CSV.
    """

    clouds: tuple[Path, ...]
    trajectory: Path


@dataclass(frozen=True)
class _Repetition:
    """How the sample goes on: each time later by its duration and further by its length.

    Attributes
    ----------
    start_s, duration_s : float
        A whole number of revolutions and pulses, which keeps the clock's rhythm across the seam.
    shift_m : (3,) float64
    """

    start_s: float
    duration_s: float
    shift_m: NDArray[np.float64]


def write_large_street(folder: Path, points: int, scanner: str = "left") -> tuple[Path, Path]:
    """Write a recording of one scanner in one file, and its trajectory.

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
    delivery = write_long_delivery(folder, points, scanners=(scanner,))
    return delivery.clouds[0], delivery.trajectory


def write_long_delivery(
    folder: Path, points: int, *, scanners: Sequence[str] = ("left", "right"), files: int = 1
) -> LongDelivery:
    """Write a drive as offices deliver it: several files for each scanner, one trajectory.

    The sample's points repeat, each time later by its duration and further by its length, so
    times, rows and pulses go on as in one long drive.

    Parameters
    ----------
    points : int
        Of all scanners together; each has its share.
    files : int
        For each scanner; fewer where the sample repeats less often.
    """
    street = path_of("sample_street")
    trajectory = read_trajectory(street / "trajectory.csv", "")
    samples = {name: laspy.read(street / f"{name}.laz") for name in scanners}
    repetition = _repetition_of(samples.values(), trajectory)
    share = -(-points // len(scanners))
    clouds = tuple(
        path
        for name, sample in samples.items()
        for path in _write_scanner(folder / f"{name}-{points}", sample, share, files, repetition)
    )
    longest = max(-(-share // len(sample.points)) for sample in samples.values())
    path = folder / f"{scanners[0]}-{points}.csv"
    _write_trajectory(path, trajectory, repetition, longest)
    return LongDelivery(clouds, path)


def _repetition_of(samples: Collection[laspy.LasData], trajectory: Trajectory) -> _Repetition:
    start = min(float(sample.gps_time[0]) for sample in samples)
    end = max(float(sample.gps_time[-1]) for sample in samples)
    duration = float(np.ceil((end - start) * _TURNS_PER_S) / _TURNS_PER_S)
    begin, stop = trajectory.positions_at(np.array([start, start + duration]))
    return _Repetition(start, duration, stop - begin)


def _write_scanner(
    stem: Path, sample: laspy.LasData, points: int, files: int, repetition: _Repetition
) -> list[Path]:
    """Whole repetitions for each file; the last one is cut."""
    steps = np.rint(repetition.shift_m / sample.header.scales).astype(np.int64).tolist()
    repeats = -(-points // len(sample.points))
    files = min(files, repeats)
    ends = [-(-repeats * (number + 1) // files) for number in range(files)]
    paths = []
    begin = 0
    for number, end in enumerate(ends):
        name = f"{stem.name}.laz" if files == 1 else f"{stem.name}_{number + 1:02d}.laz"
        paths.append(stem.with_name(name))
        with laspy.open(paths[-1], mode="w", header=sample.header) as writer:
            for again in range(begin, end):
                left = points - again * len(sample.points)
                record = sample.points[: min(left, len(sample.points))].copy()
                record["gps_time"] = record["gps_time"] + again * repetition.duration_s
                for axis, step in zip("XYZ", steps, strict=True):
                    record[axis] = record[axis] + step * again
                writer.write_points(record)
        begin = end
    return paths


def _write_trajectory(
    path: Path, trajectory: Trajectory, repetition: _Repetition, repeats: int
) -> None:
    """The vehicle's path, before the first point, again and again, and a little beyond."""
    table = np.column_stack([trajectory.time, trajectory.xyz, trajectory.roll_pitch_heading_deg])
    start, duration = repetition.start_s, repetition.duration_s
    inside = table[(trajectory.time >= start) & (trajectory.time < start + duration)]
    moved = np.concatenate([[duration], repetition.shift_m, np.zeros(3)])
    again = [inside + number * moved for number in range(repeats)]
    end = again[-1][-1] + np.array([0.1, 0, 0, 0, 0, 0, 0])
    np.savetxt(
        path,
        np.vstack([table[trajectory.time < start], *again, end]),
        delimiter=",",
        header=_TRAJECTORY_HEADER,
        comments="",
        fmt=["%.6f", "%.5f", "%.5f", "%.5f", "%.6f", "%.6f", "%.6f"],
    )

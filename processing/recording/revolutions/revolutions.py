"""Revolutions: rows and pulse numbers found in a recording as it is delivered.

Files hold points in time order and neither row nor pulse. Rows come from the angle of each point
seen from the scanner, columns from the clock of the laser.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.recording.columns.point_source import (
    PointColumns,
    PointSource,
    RecordedPoints,
    samples_of,
)
from processing.recording.revolutions.origins import trajectory_from_origins
from processing.recording.revolutions.periodicity import trajectory_from_points
from processing.recording.revolutions.pulse_clock import PulseClock, estimate_clock
from processing.recording.revolutions.pulse_store import ArrayPulses, FolderPulses
from processing.recording.revolutions.row_finding import FoundRows, find_rows
from processing.recording.revolutions.scan_angle import (
    MirrorRotation,
    find_delivered_spin,
    find_seen_spin,
)
from processing.recording.revolutions.vehicle_frame import Poses
from processing.recording.vehicle_path.trajectory import Trajectory

__all__ = [
    "NoRevolutions",
    "PointColumns",
    "RecordedPoints",
    "Revolutions",
    "find_revolutions",
    "trajectory_from_origins",
]

_LEAST_POINTS = 500
"""With fewer points nothing repeats. By trial; no measurement is recorded."""

_CLOCK_SAMPLES, _CLOCK_SAMPLE_POINTS = 4, 20_000
"""Pieces of a recording from which the pulse interval follows, and points of each."""

_TOO_FEW = Text(
    "There are too few points to find revolutions in them.",
    "点数が少なすぎるため、回転を推定できません。",
)
_NO_CLOCK = Text(
    "The times of the points have no common pulse interval: points were thinned or merged, or the "
    "times have too few digits.",
    "点の時刻に共通のパルス間隔がありません（点の間引きや統合、時刻の桁不足が考えられます）。",
)
_NO_ORDER = Text(
    "The points are not in the order of their times.",
    "点が時刻の順に並んでいません。",
)
_NO_SPIN = Text(
    "The points don't come from a mirror that turns steadily between 40 and 300 times a second.",
    "毎秒40～300回転で一定に回転するミラーによる計測ではありません。",
)


@dataclass(frozen=True)
class Revolutions:
    """Rows of a recording.

    Attributes
    ----------
    method : {"trajectory", "origins", "scan-angle", "periodicity"}
        What the angle of the mirror was taken from.
    revolution_rate_hz, pulse_rate_hz, pulses_per_revolution : float
        Medians.
    reference_times : (R + 1,) float64
        s; when each row begins, below the vehicle; the last one ends the last row.
    fold_pulses : (R + 1,) int64
        First pulse of each row; the last one ends the last row.
    segments : (R,) int32
        Number of the stretch between stops of more than 1.0 s.
    row_ends : (R,) int64
        First pulse after each row: ``fold_pulses[k + 1]``, at a stop the end of its own revolution.
    coherence : float
        0..1: how well the angle follows the clock.
    """

    method: str
    revolution_rate_hz: float
    pulse_rate_hz: float
    pulses_per_revolution: float
    reference_times: NDArray[np.float64]
    fold_pulses: NDArray[np.int64]
    segments: NDArray[np.int32]
    row_ends: NDArray[np.int64]
    coherence: float


@dataclass(frozen=True)
class NoRevolutions:
    """Why a recording has no rows, in one sentence."""

    reason: Text


@overload
def find_revolutions(
    points: PointColumns, trajectory: Trajectory | None, monitor: Monitor
) -> tuple[Revolutions, NDArray[np.int64]] | NoRevolutions: ...


@overload
def find_revolutions(
    points: RecordedPoints, trajectory: Trajectory | None, monitor: Monitor
) -> Revolutions | NoRevolutions: ...


def find_revolutions(
    points: PointColumns | RecordedPoints, trajectory: Trajectory | None, monitor: Monitor
) -> tuple[Revolutions, NDArray[np.int64]] | Revolutions | NoRevolutions:
    """Rows and pulses of one scanner's recording, of whichever type.

    Parameters
    ----------
    points : PointColumns or RecordedPoints
        In time order. The pulses of recorded points are written to their folder as a column.
    trajectory : Trajectory or None
        Of any point of the vehicle, on the clock and in the frame of the points.

    Returns
    -------
    Revolutions and (n,) int64, Revolutions, or NoRevolutions
        With the pulse of each point in the first form.

    Notes
    -----
    1. The pulse interval is the common step of the times.
    2. The mirror's angle comes from scanner origins if points have them, else from the trajectory,
       else from delivered scan angles, else from a path of the scanner found in the points.
    3. Its phase is followed through the drive, pulses are numbered by the clock.
    4. Rows begin where the scan line crosses the trajectory below the vehicle; what is missing or
       doubtful is taken from the phase.
    """
    monitor.check()
    if points.count < _LEAST_POINTS:
        return NoRevolutions(_TOO_FEW)
    samples = list(samples_of(points, _CLOCK_SAMPLES, _CLOCK_SAMPLE_POINTS))
    if any((np.diff(sample.time) < 0).any() for sample in samples):
        return NoRevolutions(_NO_ORDER)
    clock = estimate_clock(samples)
    if clock is None:
        return NoRevolutions(_NO_CLOCK)
    monitor.check()
    found = _spin_of(points, trajectory, monitor)
    if found is None:
        return NoRevolutions(_NO_SPIN)
    monitor.report(0.2)
    method, mirror_rotation = found
    if isinstance(points, RecordedPoints):
        with FolderPulses(points.folder) as written:
            return _revolutions_of(
                method, clock, find_rows(points, clock, mirror_rotation, written, monitor)
            )
    kept = ArrayPulses(points.count)
    rows = find_rows(points, clock, mirror_rotation, kept, monitor)
    return _revolutions_of(method, clock, rows), kept.pulses


def _spin_of(
    points: PointSource, trajectory: Trajectory | None, monitor: Monitor
) -> tuple[str, MirrorRotation] | None:
    if points.has_origins:
        vehicle_path = trajectory_from_origins(points)
        mirror_rotation = find_seen_spin(points, Poses.of(vehicle_path))
        if mirror_rotation is not None:
            return "origins", mirror_rotation
    if trajectory is not None:
        mirror_rotation = find_seen_spin(points, Poses.of(trajectory))
        if mirror_rotation is not None:
            return "trajectory", mirror_rotation
    if points.has_scan_angles:
        mirror_rotation = find_delivered_spin(points)
        if mirror_rotation is not None:
            return "scan-angle", mirror_rotation
    monitor.check()
    way_found = trajectory_from_points(points, monitor)
    if way_found is not None:
        mirror_rotation = find_seen_spin(points, Poses.of(way_found))
        if mirror_rotation is not None:
            return "periodicity", mirror_rotation
    return None


def _revolutions_of(method: str, clock: PulseClock, rows: FoundRows) -> Revolutions:
    return Revolutions(
        method=method,
        revolution_rate_hz=rows.revolution_rate_hz,
        pulse_rate_hz=1.0 / rows.interval_s,
        pulses_per_revolution=1.0 / (rows.interval_s * rows.revolution_rate_hz),
        reference_times=rows.reference_times,
        fold_pulses=rows.fold_pulses,
        segments=rows.segments,
        row_ends=rows.row_ends,
        coherence=min(rows.coherence, clock.coherence, 1.0),
    )

"""Reference times T_k: when each revolution passes below the vehicle, where its row begins."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.recording.columns.point_source import PointColumns
from processing.recording.revolutions.vehicle_frame import Poses

SEARCHED_SHARE = 0.2
"""Share of a revolution before and after the prediction in which the crossing is looked for."""

_LONG_CHORD_PULSES = 20
"""A crossing between two points so many pulses apart is interpolated over a gap."""

_CLOSE_REVOLUTIONS = 0.01
"""By so much it may miss the prediction there: what a gap hides. By trial; no measurement is
recorded."""

_FAR_REVOLUTIONS = 0.04
"""The same where points are next to each other: the ground may be uneven. By trial; no measurement
is recorded."""

_LEAST_MISS_REVOLUTIONS = 0.003
"""Crossings usually miss by no less: a degree."""

_MISSES = 6.0
"""A crossing that misses by more than so many times the median (four standard deviations of normal
noise) is of something else."""

_MEDIAN_OVER = 31
"""Revolutions of a running median: of uneven ground and things below. By trial; no measurement is
recorded."""

_LEAST_SHARE = 0.1
"""Share of revolutions whose crossing must be found; else predictions are taken. By trial; no
measurement is recorded."""


def find_crossings(
    points: PointColumns,
    pulses: NDArray[np.int64],
    poses: Poses,
    predicted: Floats,
    *,
    period_s: float,
    below_m: float,
) -> tuple[Floats, NDArray[np.int64]]:
    """Where scan line and trajectory cross in plan, below the scanner.

    Parameters
    ----------
    points : PointColumns
        A stretch that holds the revolutions asked for.
    pulses : (n,) int64
    predicted : (k,) float64
        Rough times of the crossings, s.
    period_s : float
        Of a revolution.
    below_m : float
        Points lower than this, from the trajectory upwards, are below the scanner.

    Returns
    -------
    crossed : (k,) float64
        Time of the crossing, s; NaN without one.
    chord : (k,) int64
        Pulses between the two points that it lies between.

    References
    ----------
    Takahashi 2022, eq. (3-1), (3-2): the sign of the offset to the side of the trajectory changes
    between two points; the crossing divides their time as it divides their offsets.
    """
    crossed = np.full(predicted.size, np.nan)
    chord = np.zeros(predicted.size, dtype=np.int64)
    forward = poses.rotation[:, :2, 0]
    length = np.maximum(np.hypot(forward[:, 0], forward[:, 1]), 1e-9)
    left = np.column_stack([-forward[:, 1] / length, forward[:, 0] / length])
    _crossings_kernel(
        np.ascontiguousarray(points.xyz),
        np.array([points.scale, points.offset]),
        np.ascontiguousarray(points.time),
        pulses,
        poses.time,
        poses.xyz,
        left,
        predicted,
        np.array([SEARCHED_SHARE * period_s, below_m]),
        crossed,
        chord,
    )
    return crossed, chord


def repair_reference_times(
    predicted: Floats, crossed: Floats, chord: NDArray[np.int64], period_s: float
) -> Floats:
    """Reference times from predictions and crossings, all revolutions included.

    Parameters
    ----------
    predicted, crossed : (k,) float64
        s; NaN where no crossing was found.
    chord : (k,) int64

    Returns
    -------
    (k,) float64
        s, rising.

    Notes
    -----
    Crossings are compared with the prediction shifted by the running median of their differences.
    One that differs by much more than they usually do, by 1 % of a revolution across a long chord
    or by 4 % at most, does not count; then the prediction does, as it does where no crossing was
    found: the road is hidden, wet, or not in the recording.
    """
    shift = (crossed - predicted) / period_s
    found = np.flatnonzero(np.isfinite(shift))
    if found.size < max(1.0, _LEAST_SHARE * predicted.size):
        return predicted.copy()
    usual = np.interp(np.arange(predicted.size), found, _running_median(shift[found]))
    miss = np.abs(shift - usual)
    usual_miss = max(_LEAST_MISS_REVOLUTIONS, _MISSES * float(np.median(miss[found])))
    allowed = np.where(chord > _LONG_CHORD_PULSES, _CLOSE_REVOLUTIONS, _FAR_REVOLUTIONS)
    allowed = np.minimum(allowed, usual_miss)
    good = np.isfinite(shift) & (miss <= allowed)
    times: Floats = predicted + period_s * np.where(good, shift, usual)
    return times


def _running_median(values: Floats) -> Floats:
    width = min(_MEDIAN_OVER, values.size - (values.size + 1) % 2)
    padded = np.pad(values, width // 2, mode="reflect" if values.size > 1 else "edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, width)
    median: Floats = np.median(windows, axis=1)
    return median


@kernel
def _crossings_kernel(
    xyz: NDArray[np.int32],
    scale_offset: Floats,
    time: Floats,
    pulses: NDArray[np.int64],
    pose_time: Floats,
    pose_xyz: Floats,
    left: Floats,
    predicted: Floats,
    limits: Floats,
    crossed: Floats,
    chord: NDArray[np.int64],
) -> None:
    count = time.shape[0]
    last = pose_time.shape[0] - 2
    half, below = limits[0], limits[1]
    for k in range(predicted.shape[0]):
        start = np.searchsorted(time, predicted[k] - half)
        j = min(max(np.searchsorted(pose_time, predicted[k] - half) - 1, 0), last)
        before = -1
        offset_before = 0.0
        nearest = half
        for i in range(start, count):
            if time[i] > predicted[k] + half or time[i] > pose_time[last + 1]:
                break
            if time[i] < pose_time[0]:
                continue
            while j < last and pose_time[j + 1] < time[i]:
                j += 1
            share = (time[i] - pose_time[j]) / (pose_time[j + 1] - pose_time[j])
            up = xyz[i, 2] * scale_offset[0, 2] + scale_offset[1, 2] - pose_xyz[j, 2]
            if up - share * (pose_xyz[j + 1, 2] - pose_xyz[j, 2]) > below:
                continue
            offset = 0.0
            for axis in range(2):
                position = xyz[i, axis] * scale_offset[0, axis] + scale_offset[1, axis]
                step = pose_xyz[j + 1, axis] - pose_xyz[j, axis]
                turn = left[j, axis] + share * (left[j + 1, axis] - left[j, axis])
                offset += (position - pose_xyz[j, axis] - share * step) * turn
            if before >= 0 and (offset_before < 0) != (offset < 0):
                a, b = abs(offset_before), abs(offset)
                at = (b * time[before] + a * time[i]) / (a + b)
                if abs(at - predicted[k]) < nearest:
                    nearest = abs(at - predicted[k])
                    crossed[k] = at
                    chord[k] = pulses[i] - pulses[before]
            before, offset_before = i, offset


def warm_up() -> None:
    """Compile the kernel."""
    _crossings_kernel(
        np.zeros((2, 3), dtype=np.int32),
        np.zeros((2, 3)),
        np.zeros(2),
        np.zeros(2, dtype=np.int64),
        np.array([0.0, 1.0, 2.0]),
        np.zeros((3, 3)),
        np.zeros((3, 2)),
        np.zeros(1),
        np.zeros(2),
        np.zeros(1),
        np.zeros(1, dtype=np.int64),
    )

"""Trajectory: where the vehicle was, and how it was turned, at any time of a drive."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.core.errors import OutOfRange
from processing.core.kernels import kernel
from processing.core.text import Text

LONGEST_GAP_S = 5.0
"""Between two records further apart than this, nothing is known of the vehicle."""

_CLOCK_TOLERANCE_S = 1e-6
"""Times outside a trajectory by no more are on its ends: rounding."""

_STEP_FOR_HEADING_M = 0.25
"""A heading follows from a movement of so much, more than a position scatters. By trial; no
measurement is recorded."""


@dataclass(frozen=True)
class Trajectory:
    """Positions and attitudes of the vehicle's reference point.

    Attributes
    ----------
    time : (m,) float64
        Seconds, rising strictly; m >= 2.
    xyz : (m, 3) float64
        Easting, northing, height, m, project CRS.
    roll_pitch_heading_deg : (m, 3) float64
        Roll: right side down positive; pitch: nose up positive; heading: clockwise from grid
        north.
    has_attitude : bool
        False: heading and pitch were taken from the motion, and roll is 0.

    Notes
    -----
    Positions are linear between records; attitudes follow the shorter arc between the two
    records' unit quaternions (normalised linear interpolation), so 359° to 1° passes through 0°.
    Records more than ``LONGEST_GAP_S`` apart are the ends of a gap: times inside are not covered.
    """

    time: NDArray[np.float64]
    xyz: NDArray[np.float64]
    roll_pitch_heading_deg: NDArray[np.float64]
    has_attitude: bool

    def __post_init__(self) -> None:
        count = self.time.shape[0]
        shapes = (self.time.shape, self.xyz.shape, self.roll_pitch_heading_deg.shape)
        if count < 2 or shapes != ((count,), (count, 3), (count, 3)):
            message = f"a trajectory can't have arrays of shapes {shapes}"
            raise ValueError(message)
        if not (np.diff(self.time) > 0).all():
            message = "the times of a trajectory must rise strictly"
            raise ValueError(message)

    @staticmethod
    def from_positions(time: ArrayLike, xyz: ArrayLike) -> Trajectory:
        """A trajectory of positions alone: heading and pitch from the motion, roll 0.

        Parameters
        ----------
        time : (m,) float64
            Rising strictly.
        xyz : (m, 3) float64

        Notes
        -----
        Directions come from records at least 0.25 m apart, so that a vehicle at rest keeps its
        heading. One that never moves as far faces north.
        """
        times = np.asarray(time, dtype=np.float64)
        positions = np.asarray(xyz, dtype=np.float64)
        kept = np.zeros(times.size, dtype=np.bool_)
        _mark_steps_kernel(positions, _STEP_FOR_HEADING_M, kept)
        vertices = np.flatnonzero(kept)
        angles = np.zeros((times.size, 3))
        if vertices.size >= 2:
            direction = np.gradient(positions[vertices], axis=0)
            east, north, up = (np.interp(times, times[vertices], d) for d in direction.T)
            angles[:, 1] = np.degrees(np.arctan2(up, np.hypot(east, north)))
            angles[:, 2] = np.degrees(np.arctan2(east, north)) % 360.0
        return Trajectory(times, positions, angles, has_attitude=False)

    def covers(self, time: ArrayLike) -> NDArray[np.bool_]:
        """Whether the vehicle's place is known at these times.

        Parameters
        ----------
        time : (n,) or scalar float64

        Returns
        -------
        (n,) bool
            False before the first and after the last record, inside gaps of more than
            ``LONGEST_GAP_S``, and for NaN.
        """
        times = np.asarray(time, dtype=np.float64)
        first, last = self.time[0] - _CLOCK_TOLERANCE_S, self.time[-1] + _CLOCK_TOLERANCE_S
        inside = np.asarray((times >= first) & (times <= last))
        for start, end in self._gaps:
            inside &= ~((times > start) & (times < end))
        return inside

    def positions_at(self, time: ArrayLike) -> NDArray[np.float64]:
        """Where the reference point was.

        Parameters
        ----------
        time : (n,) float64

        Returns
        -------
        (n, 3) float64
            Project CRS, m.

        Raises
        ------
        OutOfRange
            For a time that is not covered.
        """
        times = self._check_times(time)
        return np.column_stack([np.interp(times, self._clock, axis) for axis in self._axes])

    def rotations_at(self, time: ArrayLike) -> NDArray[np.float64]:
        """How the vehicle was turned.

        Parameters
        ----------
        time : (n,) float64

        Returns
        -------
        (n, 3, 3) float64
            Columns are the vehicle's forward, left and up axes in project axes.

        Raises
        ------
        OutOfRange
            For a time that is not covered.
        """
        w, x, y, z = self._quaternions_at(self._check_times(time))
        rotations = np.empty((w.size, 3, 3))
        rotations[:, 0, 0] = 1 - 2 * (y * y + z * z)
        rotations[:, 0, 1] = 2 * (x * y - w * z)
        rotations[:, 0, 2] = 2 * (x * z + w * y)
        rotations[:, 1, 0] = 2 * (x * y + w * z)
        rotations[:, 1, 1] = 1 - 2 * (x * x + z * z)
        rotations[:, 1, 2] = 2 * (y * z - w * x)
        rotations[:, 2, 0] = 2 * (x * z - w * y)
        rotations[:, 2, 1] = 2 * (y * z + w * x)
        rotations[:, 2, 2] = 1 - 2 * (x * x + y * y)
        return rotations

    def to_vehicle(self, xyz: ArrayLike, time: ArrayLike) -> NDArray[np.float64]:
        """Points as seen from the vehicle.

        Parameters
        ----------
        xyz : (n, 3) float64
            Project CRS, m.
        time : (n,) float64
            When each was measured.

        Returns
        -------
        (n, 3) float64
            Forward, left and up of the reference point, m.

        Raises
        ------
        OutOfRange
            For a time that is not covered.
        """
        times = self._check_times(time)
        x, y, z = (
            axis - np.interp(times, self._clock, own)
            for axis, own in zip(np.asarray(xyz, dtype=np.float64).T, self._axes, strict=True)
        )
        w, i, j, k = self._quaternions_at(times)
        # v' = v + 2 q × (q × v + w v) with the inverse turn's vector part, -(i, j, k).
        a, b, c = k * y - j * z + w * x, i * z - k * x + w * y, j * x - i * y + w * z
        return np.column_stack(
            [x + 2 * (k * b - j * c), y + 2 * (i * c - k * a), z + 2 * (j * a - i * b)]
        )

    @cached_property
    def _clock(self) -> NDArray[np.float64]:
        """The times in one piece, as `_axes`: interpolation copies what isn't, at every call."""
        return np.ascontiguousarray(self.time)

    @cached_property
    def _axes(self) -> tuple[NDArray[np.float64], ...]:
        """Easting, northing and height, each in one piece."""
        return tuple(np.ascontiguousarray(axis) for axis in self.xyz.T)

    @cached_property
    def _gaps(self) -> list[tuple[float, float]]:
        before = np.flatnonzero(np.diff(self.time) > LONGEST_GAP_S)
        return [(float(self.time[i]), float(self.time[i + 1])) for i in before]

    @cached_property
    def _quaternions(self) -> NDArray[np.float64]:
        """(4, m) w, x, y, z; neighbours in the same half of the sphere."""
        half = np.radians(self.roll_pitch_heading_deg) / 2
        roll, pitch = half[:, 0], -half[:, 1]
        # Heading runs clockwise from north, the rotation anticlockwise from east.
        yaw = np.pi / 4 - half[:, 2]
        cr, sr, cp, sp = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch)
        cy, sy = np.cos(yaw), np.sin(yaw)
        q = np.stack(
            [
                cr * cp * cy + sr * sp * sy,
                sr * cp * cy - cr * sp * sy,
                cr * sp * cy + sr * cp * sy,
                cr * cp * sy - sr * sp * cy,
            ]
        )
        turned = np.where(np.sum(q[:, 1:] * q[:, :-1], axis=0) < 0, -1.0, 1.0)
        q[:, 1:] *= np.cumprod(turned)
        return q

    def _quaternions_at(self, times: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
        w, x, y, z = (np.interp(times, self._clock, axis) for axis in self._quaternions)
        length = np.sqrt(w * w + x * x + y * y + z * z)
        return w / length, x / length, y / length, z / length

    def _check_times(self, time: ArrayLike) -> NDArray[np.float64]:
        times = np.atleast_1d(np.asarray(time, dtype=np.float64))
        covered = self.covers(times)
        if covered.all():
            return times
        outside = float(times[np.argmin(covered)])
        raise OutOfRange(
            Text(
                "The trajectory says nothing about the time {time:.3f} s.",
                "時刻 {time:.3f} 秒は走行軌跡に含まれていません。",
            ).filled(time=outside),
            Text(
                "The trajectory covers {first:.3f} to {last:.3f} s with {gaps} gaps",
                "走行軌跡の範囲 {first:.3f}～{last:.3f} 秒（欠落 {gaps} か所）",
            ).filled(first=self.time[0], last=self.time[-1], gaps=len(self._gaps)),
            Text(
                "Add the trajectory of the whole drive, or check that both clocks are the same.",
                "走行全体の走行軌跡を追加するか、時計の種類が一致しているか確認してください。",
            ),
        )


@kernel
def _mark_steps_kernel(xyz: NDArray[np.float64], step_m: float, kept: NDArray[np.bool_]) -> None:
    """Mark the first record and each that is ``step_m`` away from the one marked before."""
    if xyz.shape[0] == 0:
        return
    kept[0] = True
    last = 0
    for i in range(1, xyz.shape[0]):
        east = xyz[i, 0] - xyz[last, 0]
        north = xyz[i, 1] - xyz[last, 1]
        if east * east + north * north >= step_m * step_m:
            kept[i] = True
            last = i

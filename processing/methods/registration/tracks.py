"""Tracks: the ways along which drives were recorded, and the knots at which they are corrected.

Heads on one vehicle share its trajectory, and so its errors; each has a boresight and a lever arm
of its own. A correction of the trajectory is linear between knots in time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.recording.drive import Drive
from processing.recording.vehicle_path.trajectory import Trajectory

UNKNOWNS = 6
"""Of a knot: shifts east, north, up, m; turns about forward, left, up, rad. Of a head: turns about
the vehicle's axes, rad, and shifts along them, m."""

KNOT_S = 1.0
"""Between knots: what a good inertial system drifts by within it is below a millimetre, and a
street driven for an hour still has few of them."""

_SAME_M = 1e-3
"""Trajectories of two heads are one where they tell the same places, as delivered, to rounding."""


@dataclass(frozen=True, eq=False)
class Track:
    """One trajectory, shared by the drives of all heads that were carried along it.

    Attributes
    ----------
    trajectory : Trajectory
    knots : (k,) float64
        Times, s, rising; at least two.
    drives : tuple of int
        Those recorded along it, among the drives of the survey.
    """

    trajectory: Trajectory
    knots: Floats
    drives: tuple[int, ...]

    def places(self, times: Floats) -> tuple[Floats, Floats]:
        """Where the vehicle was and how it was turned: (n, 3) m and (n, 3, 3).

        Times outside the trajectory, or in its gaps, are told by the nearest record.
        """
        known = self.trajectory.time
        nearest = np.clip(times, known[0], known[-1])
        is_known = self.trajectory.covers(nearest)
        if not is_known.all():
            after = np.clip(np.searchsorted(known, nearest), 1, known.size - 1)
            is_before = nearest - known[after - 1] < known[after] - nearest
            at = known[np.where(is_before, after - 1, after)]
            nearest = np.where(is_known, nearest, at)
        return self.trajectory.positions_at(nearest), self.trajectory.rotations_at(nearest)

    def spans(self, times: Floats) -> tuple[Integers, Floats]:
        """The knot before each time, and how much of the knot behind it counts, 0 to 1."""
        before = np.clip(np.searchsorted(self.knots, times, side="right") - 1, 0, None)
        before = np.minimum(before, self.knots.size - 2)
        share = (times - self.knots[before]) / (self.knots[before + 1] - self.knots[before])
        return before.astype(np.int64), np.clip(share, 0.0, 1.0)


def tracks_of(drives: Sequence[Drive]) -> tuple[Track, ...]:
    """The tracks of drives, in the order of the first drive of each.

    Raises
    ------
    Unsuitable
        A drive has no trajectory.
    """
    parts: list[tuple[Trajectory, list[int]]] = []
    for number, drive in enumerate(drives):
        trajectory = _trajectory_of(drive)
        for known, members in parts:
            if _are_one(known, trajectory):
                members.append(number)
                break
        else:
            parts.append((trajectory, [number]))
    return tuple(
        Track(trajectory, _knots([drives[one] for one in members], trajectory), tuple(members))
        for trajectory, members in parts
    )


def _trajectory_of(drive: Drive) -> Trajectory:
    trajectory = drive.trajectory
    if trajectory is None:
        raise Unsuitable(
            Text(
                "A drive without a trajectory can't be registered.",
                "走行軌跡のない走行データは位置合わせできません。",
            ),
            Text.same(drive.info.name),
            Text(
                "Add its trajectory with --trajectory, or leave the drive out.",
                "--trajectory で走行軌跡を追加するか、この走行データを外してください。",
            ),
        )
    return trajectory


def _are_one(one: Trajectory, other: Trajectory) -> bool:
    first, last = max(one.time[0], other.time[0]), min(one.time[-1], other.time[-1])
    if first >= last:
        return False
    inside = other.time[(other.time >= first) & (other.time <= last)]
    some = inside[:: max(1, inside.size // 200)]
    some = some[one.covers(some) & other.covers(some)]
    if not some.size:
        return False
    apart = one.positions_at(some) - other.positions_at(some)
    return bool(np.abs(apart).max() < _SAME_M)


def _knots(drives: Sequence[Drive], trajectory: Trajectory) -> Floats:
    """Even knots over all times of points and of the trajectory."""
    spans = [(trajectory.time[0], trajectory.time[-1])]
    for drive in drives:
        times = drive.columns["time"]
        if drive.count:
            ends = np.asarray([times[0], times[-1]], np.float64)
            ends = ends[np.isfinite(ends)]
            if ends.size:
                spans.append((ends.min(), ends.max()))
    low, high = min(one[0] for one in spans), max(one[1] for one in spans)
    steps = max(1, int(np.ceil((high - low) / KNOT_S)))
    knots: Floats = np.linspace(low, low + max(high - low, KNOT_S), steps + 1)
    return knots

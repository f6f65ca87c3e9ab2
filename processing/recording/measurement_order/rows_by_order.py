"""Rows of a recording without any time, from the order of its points.

A file often keeps the order in which its points were measured where their times are lost. A beam
that turns draws profile after profile, each in a plane, and goes forward by whole pulses: so the
planes, the place that the beams come from and the pulses follow from the points themselves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Text
from processing.recording.columns.ordering import chunk_ranges, read_chunk
from processing.recording.columns.point_source import RecordedPoints
from processing.recording.drive_info import BY_ORDER
from processing.recording.measurement_order.order_judgement import (
    REFUSED,
    TOO_FEW,
    TOO_MANY,
    UNCONFIRMED,
    longest_stretch,
)
from processing.recording.measurement_order.order_stretches import WINDOW_POINTS
from processing.recording.measurement_order.profile_joining import (
    place_in_profiles,
    profiles_of,
    straighten_planes,
)
from processing.recording.measurement_order.sweep_kernels import pulses_kernel
from processing.recording.measurement_order.sweep_path import SweepPath, follow_sweeps, turns_of
from processing.recording.revolutions.revolutions import Revolutions
from processing.recording.vehicle_path.trajectory import Trajectory

NOMINAL_RATE_HZ = 100.0
"""Turns a second of the axis that stands in for time. It orders rows and makes the vehicle go at
about a vehicle's speed, between the 40 and 300 turns a second of scanners; no time, speed or rate
may be told from it."""

_LEAST_CONFIRMED = 0.5
"""Share of points whose rows must be confirmed by the order: most of them."""

_WHOLE = 0.99
"""Share of the points from which a stretch is the whole recording: the rest are odd ones."""

_LEAST_TURNS = 10
"""With fewer rows there is no way along which they follow."""

_STRAIGHTENED = 2
"""Times that planes are straightened by what was placed in them; a third changes nothing."""

_MOST_POINTS = 100_000_000
"""All are held in memory."""

_SPARE_TURNS = 50.0
"""Turns between knots of the trajectory: half a second of the axis, which bridges every gap."""

_FOUND = Text(
    "The points have no times; the rows come from the order of the points, which confirms "
    "{share} % of them. Times, speeds and rates stay unknown.",
    "点に時刻がないため、点の並び順から行を推定しました（全点の {share} % を並び順で確認）。"
    "時刻・速度・回転数は不明です。",
)
_JOINED = Text(
    "The points have no times and come object after object; the rows come from the longest stretch "
    "in order of measurement and from the planes of its profiles, and the order confirms "
    "{share} % of the points. Times, speeds and rates stay unknown.",
    "点に時刻がなく、対象物ごとに並んでいるため、計測順に並ぶ最長区間とその断面の平面から行を"
    "推定しました（全点の {share} % を並び順で確認）。時刻・速度・回転数は不明です。",
)


@dataclass(frozen=True)
class OrderedRows:
    """Rows that were found from the order.

    Attributes
    ----------
    revolutions : Revolutions
        On the axis of `NOMINAL_RATE_HZ`.
    trajectory : Trajectory
        Of the centre of the beams, on the same axis.
    pulses : (n,) int64
        Of each point, in the order of the points; it may go back where things were joined.
    confirmed : float
        0..1: share of points whose row the order confirms.
    reported : Text
        Where the rows come from, and how sure that is, in one sentence.
    """

    revolutions: Revolutions
    trajectory: Trajectory
    pulses: NDArray[np.int64]
    confirmed: float
    reported: Text

    def times_of(self, pulses: NDArray[np.int64]) -> Floats:
        """(n,) what stands in for the times of pulses; no times."""
        return np.asarray(pulses / self.revolutions.pulse_rate_hz)


@dataclass(frozen=True)
class NoOrder:
    """Why the order of the points tells no rows, in one sentence."""

    reason: Text


@dataclass(frozen=True)
class _Turns:
    """Turn and range of every point, and the centres of the beams at some turns, m.

    Points of the stretch are in order of measurement.
    """

    turns: Floats
    ranges: Floats
    centre_turns: Floats
    centres: Floats
    confirmed: float
    reported: Text
    stretch: slice


def find_rows_by_order(points: RecordedPoints, monitor: Monitor) -> OrderedRows | NoOrder:
    """Rows of a recording from the order of its points, if that is the order of measurement.

    Parameters
    ----------
    points : RecordedPoints
        As delivered; times are not looked at.

    Returns
    -------
    OrderedRows or NoOrder

    Raises
    ------
    Cancelled

    Notes
    -----
    1. The order is cut where it jumps along the way; the longest stretch is looked at.
    2. There, steps must stay in the planes of profiles, and go forward by whole pulses seen from
       a place near the road that moves.
    3. The place is followed along the stretch; the turns of the beam are counted about it, each
       from straight down.
    4. Points elsewhere in the order get the profile in whose plane they lie; how many of them
       keep their profile from point to point says how sure that is.
    """
    if not WINDOW_POINTS <= points.count <= _MOST_POINTS:
        why = TOO_FEW if points.count < WINDOW_POINTS else TOO_MANY
        return NoOrder(REFUSED.filled(why=why))
    xyz, origin, quantum_m = _read_metres(points)
    monitor.check()
    judged = longest_stretch(xyz, quantum_m)
    if isinstance(judged, Text):
        return NoOrder(REFUSED.filled(why=judged))
    start, stop, first = judged
    monitor.report(0.1)
    per_turn = round(2 * np.pi / first.step_rad)
    followed = PartMonitor(monitor, 0.1, 0.7)
    path, share = follow_sweeps(
        xyz[start:stop], quantum_m, replace(first, step_rad=2 * np.pi / per_turn), followed
    )
    if stop - start >= _WHOLE * points.count:
        found: _Turns | None = _turns_of_all(replace(path, at=path.at + start), xyz, share)
    else:
        found = _joined_turns(path, xyz, (start, stop), share, PartMonitor(monitor, 0.7, 1.0))
    if found is None or found.confirmed < _LEAST_CONFIRMED:
        return NoOrder(REFUSED.filled(why=UNCONFIRMED))
    if np.ptp(found.turns) < _LEAST_TURNS:
        return NoOrder(REFUSED.filled(why=TOO_FEW))
    return _rows_of(found, per_turn, origin)


def _read_metres(points: RecordedPoints) -> tuple[Floats, Floats, float]:
    """(n, 3) metres about an origin, the origin, and what coordinates are rounded to, m."""
    scale, offset = np.array(points.scale), np.array(points.offset)
    first = read_chunk(points.folder, "xyz", 0, 1).astype(np.int64)
    xyz = np.empty((points.count, 3))
    quantum = np.zeros(3, np.int64)
    for start, stop in chunk_ranges(points.count):
        integers = read_chunk(points.folder, "xyz", start, stop).astype(np.int64) - first
        quantum = np.gcd(quantum, np.gcd.reduce(integers, axis=0))
        xyz[start:stop] = integers * scale
    return xyz, first[0] * scale + offset, float(np.max(quantum * scale))


def _turns_of_all(path: SweepPath, xyz: Floats, share: float) -> _Turns:
    """Turns of a recording that is one stretch."""
    turns, ranges = turns_of(path, xyz)
    at = np.clip(path.at, 0, len(turns) - 1).astype(np.int64)
    return _Turns(turns, ranges, turns[at], path.centres, share, _FOUND, slice(0, len(turns)))


def _joined_turns(
    path: SweepPath, xyz: Floats, stretch: tuple[int, int], share: float, monitor: Monitor
) -> _Turns | None:
    """Turns of a stretch and of what lies in the planes of its profiles; None without profiles."""
    part = slice(*stretch)
    profiles = profiles_of(path, xyz[part])
    if profiles is None:
        return None
    for _ in range(_STRAIGHTENED):
        rows, _, _ = place_in_profiles(profiles, xyz, monitor)
        profiles = straighten_planes(profiles, xyz, rows)
    rows, turns, ranges = place_in_profiles(profiles, xyz, monitor)
    own, ranges[part] = turns_of(path, xyz[part], profiles.begins)
    first = np.floor(own - profiles.begins).min()
    turns[part] = own - first + profiles.measured.start
    confirmed = np.zeros(len(rows), np.bool_)
    confirmed[1:] = np.abs(np.diff(rows)) <= 1
    confirmed &= (rows >= profiles.measured.start) & (rows < profiles.measured.stop)
    confirmed[part] = False
    sure = (confirmed.sum() + share * (part.stop - part.start)) / len(rows)
    centre_turns = np.arange(0.5, len(profiles.centres)) + profiles.begins
    return _Turns(turns, ranges, centre_turns, profiles.centres, float(sure), _JOINED, part)


def _rows_of(found: _Turns, per_turn: int, origin: Floats) -> OrderedRows:
    base = np.floor(found.turns.min())
    turns = found.turns - base
    pulses = np.round(turns * per_turn).astype(np.int64)
    part = found.stretch
    last = np.array([-1.0, -1.0, 0.0])
    pulses_kernel(turns[part], found.ranges[part], per_turn, last, pulses[part])
    rows = int(pulses.max()) // per_turn + 1
    folds = np.arange(rows + 1, dtype=np.int64) * per_turn
    revolutions = Revolutions(
        method=BY_ORDER,
        revolution_rate_hz=NOMINAL_RATE_HZ,
        pulse_rate_hz=NOMINAL_RATE_HZ * per_turn,
        pulses_per_revolution=float(per_turn),
        reference_times=np.arange(rows + 1) / NOMINAL_RATE_HZ,
        fold_pulses=folds,
        segments=np.zeros(rows, np.int32),
        row_ends=folds[1:].copy(),
        coherence=found.confirmed,
    )
    trajectory = _trajectory_of(found.centre_turns - base, found.centres + origin, rows)
    share = f"{math.floor(100 * found.confirmed)}"
    reported = found.reported.filled(share=share)
    return OrderedRows(revolutions, trajectory, pulses, found.confirmed, reported)


def _trajectory_of(turns: Floats, centres: Floats, rows: int) -> Trajectory:
    """The centres as a way of the vehicle that covers all rows."""
    rising = np.concatenate([[True], np.diff(np.maximum.accumulate(turns)) > 0])
    turns, centres = turns[rising], centres[rising]
    ends = np.arange(-1.0, rows + 2.0, _SPARE_TURNS)
    asked = np.unique(np.concatenate([ends, turns, [rows + 1.0]]))
    asked = asked[(asked >= -1.0) & (asked <= rows + 1.0)]
    path = SweepPath(turns, centres, centres, 1.0)
    return Trajectory.from_positions(asked / NOMINAL_RATE_HZ, path.led_on(asked))

"""The sweeps of a scanner on a tripod, found from the order of its points.

Deliveries often lack the scanner's position and its grid. A tripod's head turns slowly while its
mirror spins, so all beams of a moment lie in one upright plane through the scanner: the planes of
many moments tell where it stood (:mod:`.scanner_positions`), and from there every point, noise
too, shows the direction of its beam. A sweep ends where the angle in the plane jumps back.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.scratch_arrays import scratch_array
from processing.methods.noise.beams.beam_kernels import PointBeams
from processing.methods.noise.beams.measured_order import measured_order
from processing.methods.noise.beams.scanner_positions import position_in_order
from processing.recording.drive import Drive

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_POINTS_AT_ONCE = 1 << 20
"""Points whose directions are worked out at a time: some 100 MB."""

_MOMENT = 256
"""Consecutive points whose plane is found: less than a sweep, in which the head hardly turns, and
enough that a millimetre beside a near beam is averaged out."""

_BACK_STEPS, _BACK_RAD = 8.0, np.radians(1.0)
"""How far the angle in the plane must fall for a new sweep, in steps and at least: a near point's
direction is off by a millimetre's angle, and a sweep spans many steps more."""

_JUMP_ROWS = 4.0
"""Turns of the head from sweep to sweep, in usual ones, beyond which sweeps are not neighbours: the
head went on without measuring, or began anew."""

_WHOLE_STEP = 0.5
"""A step is one from beam to beam if it is nearer to that than to none and to two."""

_FEWEST_WHOLE = 0.5
"""Share of steps that are so, from which the order is one of beams: a lost pulse in twenty leaves
nine tenths, points in no order a fifth."""

_FEWEST = 1_000
"""Points of which a scan's step can be told."""

_LEAST_STEP_RAD = 1e-6
"""Far finer than scanners step: points that lie in one direction tell no step."""


@dataclass(frozen=True)
class StandingScan:
    """A standing scanner's points, sweep by sweep.

    Attributes
    ----------
    drive : Drive
    position : (3,) float64
        Of the scanner, m, project CRS.
    order : (n,) int64
        The drive's points by sweep and by angle in it.
    row_starts : (rows + 1,) int64
        Where each sweep begins in that order.
    columns : (n,) int32
        Steps of the mirror, in that order.
    segments : (rows,) int32
        Sweeps of one number are neighbours of those before and behind.
    step_rad : float
    """

    drive: Drive
    position: _Floats
    order: _Integers
    row_starts: _Integers
    columns: NDArray[np.int32]
    segments: NDArray[np.int32]
    step_rad: float

    def beams_of(self, rows: range) -> tuple[PointBeams, _Integers]:
        """The beams of some sweeps, about the scanner, and which points of the drive they are."""
        starts = self.row_starts[rows.start : rows.stop + 1]
        inside = slice(int(starts[0]), int(starts[-1]))
        points = np.asarray(self.order[inside])
        xyz = self.drive.xyz(points) - self.position
        ranges = np.maximum(np.linalg.norm(xyz, axis=1), _NEAREST_M)
        beams = PointBeams(
            xyz,
            np.zeros_like(xyz),
            ranges,
            np.asarray(self.columns[inside]),
            np.ascontiguousarray(starts - starts[0]),
            np.ascontiguousarray(self.segments[rows.start : rows.stop]),
            self.step_rad,
        )
        return beams, points


_NEAREST_M = 1e-3
"""Least range, so that a point at the scanner divides nothing by zero."""


def standing_scan_of(drive: Drive, scratch: Path, monitor: Monitor) -> StandingScan | None:
    """The sweeps of a drive without rows of its own; None where its order shows none.

    Parameters
    ----------
    scratch : Path
        A folder for files meanwhile: 12 bytes a point, as long as the result is used.

    Raises
    ------
    NoSpace, Cancelled

    Notes
    -----
    1. The position is the file's, or where the planes of moments meet.
    2. The plane of each moment is the mean of its points' directions in plan, half turns being the
       same; between moments the head turns evenly.
    3. A point's angle in its plane is counted from straight down, where the tripod stands. The
       median step of it is that of the mirror; a sweep ends where it falls.
    """
    if drive.trajectory is not None or drive.count < _FEWEST:
        return None
    order = measured_order(drive)
    position = (
        np.array(drive.info.scanner_position)
        if drive.info.scanner_position is not None
        else position_in_order(drive, order)
    )
    if position is None:
        return None
    planes = _planes(drive, order, position, monitor)
    step = _mirror_step(drive, order, position, planes)
    if step is None:
        return None
    ordered = scratch_array(scratch / "sweep_order", np.int64, drive.count)
    columns = scratch_array(scratch / "sweep_columns", np.int32, drive.count)
    ordered[:] = order
    starts = _sort_into_sweeps(
        drive, position, planes, step, out=(ordered, columns), monitor=monitor
    )
    turns = planes.at(starts[:-1].astype(np.float64))
    return StandingScan(drive, position, ordered, starts, columns, _neighbours(turns), abs(step))


@dataclass(frozen=True)
class _Planes:
    """The azimuth of the scan plane, rad, without jumps, at some points of the order."""

    points: _Floats
    azimuths: _Floats

    def at(self, points: _Floats) -> _Floats:
        return np.asarray(np.interp(points, self.points, self.azimuths))


def _planes(drive: Drive, order: _Integers, position: _Floats, monitor: Monitor) -> _Planes:
    middles, doubled = [], []
    for start, xyz in _chunks(drive, order, position, monitor):
        across = (xyz[:, 0] + 1j * xyz[:, 1]) ** 2
        # Weighed by how level a beam is: a steep one tells nothing of the plane's azimuth.
        across /= np.maximum((xyz * xyz).sum(axis=1), _NEAREST_M**2)
        firsts = np.arange(0, xyz.shape[0], _MOMENT)
        doubled.append(np.add.reduceat(across, firsts))
        stops = np.minimum(firsts + _MOMENT, xyz.shape[0])
        middles.append(start + (firsts + stops - 1) / 2)
    turns = np.unwrap(np.angle(np.concatenate(doubled))) / 2
    return _Planes(np.concatenate(middles), turns)


def _angles(xyz: _Floats, azimuths: _Floats) -> _Floats:
    """(n,) rad, 0 to 2 π: the angle of beams in their plane, from straight down."""
    along = xyz[:, 0] * np.cos(azimuths) + xyz[:, 1] * np.sin(azimuths)
    angles: _Floats = np.mod(np.arctan2(along, -xyz[:, 2]), 2 * np.pi)
    return angles


def _mirror_step(
    drive: Drive, order: _Integers, position: _Floats, planes: _Planes
) -> float | None:
    """Radians from beam to beam, below zero where the mirror turns the other way."""
    starts = np.unique(np.linspace(0, max(0, order.size - _MOMENT), _MOMENT).astype(np.int64))
    steps = []
    for start in starts:
        points = np.arange(start, min(start + _MOMENT, order.size))
        xyz = drive.xyz(order[points]) - position
        steps.append(np.diff(_angles(xyz, planes.at(points.astype(np.float64)))))
    every = np.concatenate(steps)
    middle = float(np.median(every))
    # Returns of one pulse lie in one direction.
    used = every[np.abs(every) > _WHOLE_STEP * abs(middle)]
    step = float(np.median(used)) if used.size else 0.0
    if abs(step) < _LEAST_STEP_RAD:
        return None
    is_whole = np.abs(used / step - 1) < _WHOLE_STEP
    return step if float(is_whole.mean()) >= _FEWEST_WHOLE else None


def _sort_into_sweeps(
    drive: Drive,
    position: _Floats,
    planes: _Planes,
    step: float,
    *,
    out: tuple[_Integers, NDArray[np.int32]],
    monitor: Monitor,
) -> _Integers:
    """Where sweeps begin; the order is sorted by column within them, in place."""
    order, columns = out
    starts, last = [np.zeros(1, np.int64)], np.inf
    back = max(_BACK_STEPS * abs(step), _BACK_RAD)
    for start, xyz in _chunks(drive, order, position, monitor):
        points = np.arange(start, start + xyz.shape[0], dtype=np.float64)
        angles = _angles(xyz, planes.at(points))
        angles = angles if step > 0 else 2 * np.pi - angles
        falls = np.diff(angles, prepend=last) < -back
        falls[0] &= start > 0
        starts.append(start + np.flatnonzero(falls))
        last = float(angles[-1])
        columns[start : start + xyz.shape[0]] = np.rint(angles / abs(step))
    found = np.append(np.concatenate(starts), order.size)
    for first in range(0, found.size - 1, _SWEEPS_AT_ONCE):
        monitor.check()
        own = found[first : first + _SWEEPS_AT_ONCE + 1]
        inside = slice(int(own[0]), int(own[-1]))
        rows = np.repeat(np.arange(own.size - 1), np.diff(own))
        sorted_ = np.lexsort((columns[inside], rows))
        order[inside], columns[inside] = order[inside][sorted_], columns[inside][sorted_]
    return found


_SWEEPS_AT_ONCE = 256
"""Sweeps that are sorted at a time."""


def _neighbours(turns: _Floats) -> NDArray[np.int32]:
    """(rows,) numbers of runs of sweeps between which the head turned evenly."""
    steps = np.abs(np.diff(turns))
    usual = float(np.median(steps)) if steps.size else 0.0
    jumps = steps > _JUMP_ROWS * usual
    return np.concatenate([[0], np.cumsum(jumps)]).astype(np.int32)


def _chunks(
    drive: Drive, order: _Integers, position: _Floats, monitor: Monitor
) -> Iterator[tuple[int, _Floats]]:
    """Beams in their order, m from the scanner, and where each chunk begins."""
    for start in range(0, order.size, _POINTS_AT_ONCE):
        monitor.check()
        drive.columns.give_back()
        yield start, drive.xyz(np.asarray(order[start : start + _POINTS_AT_ONCE])) - position

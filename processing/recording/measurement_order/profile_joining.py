"""Profiles of a stretch joined with what lies elsewhere in the order: points sorted by object."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.recording.measurement_order.sweep_path import (
    SweepPath,
    interpolated,
    turns_of,
)

_LED_ON = 1.0
"""Share of a stretch's profiles by which its planes are led on at either end: farther off, a
straight way is a guess."""

_GAP_BINS = 360
"""Degrees of a turn, among which the widest gap of the sweep is looked for."""

_ROWS_TOGETHER = 20
"""Profiles whose steps give one normal: with things that stand upright among them it is exact to
some hundredths of a degree."""

_FEW_STEPS = 0.5
"""Of the median of steps: profiles with fewer take their normal from their neighbours."""

_LEAST_ALIKE = 0.94
"""Cosine to the plane before, 20°: steps that give another one are of things placed wrongly."""

_POINTS_AT_ONCE = 200_000
"""Points placed between two looks whether to go on."""


@dataclass(frozen=True)
class Profiles:
    """Planes of profiles, one after another along the way.

    Attributes
    ----------
    middles, normals, centres : (r, 3) float64
        A place in each plane; its unit normal; where its beams came from, m.
    begins : float
        Of a turn from straight down: where the sweep begins.
    measured : slice
        Profiles that the stretch has; the others are led on.
    sense : float
        As the path has it.
    """

    middles: Floats
    normals: Floats
    centres: Floats
    begins: float
    measured: slice
    sense: float


def profiles_of(path: SweepPath, xyz: Floats) -> Profiles | None:
    """The profiles of a stretch of points; None where it has fewer than two.

    Parameters
    ----------
    path : SweepPath
        Of the stretch.
    xyz : (n, 3) float64
        Its points, m.
    """
    turns, _ = turns_of(path, xyz)
    begins = _widest_gap(turns % 1.0)
    turns, _ = turns_of(path, xyz, begins)
    rows = np.floor(turns - begins).astype(np.int64)
    rows -= rows.min()
    filled, first = np.unique(rows, return_index=True)
    if filled.size < 2:
        return None
    counts = np.diff(np.append(first, rows.size))
    sums = np.add.reduceat(xyz, first, axis=0)
    every = np.arange(filled[-1] + 1)
    positions = np.interp(every, filled, first + 0.5 * counts)
    led_on = int(_LED_ON * every.size) + 1
    reach = np.concatenate(
        [
            positions[0] - _steps(positions[:2], led_on)[::-1],
            positions,
            positions[-1] + _steps(positions[-2:], led_on),
        ]
    )
    centres = path.led_on(reach)
    middles = interpolated(
        every.astype(np.float64), filled.astype(np.float64), sums / counts[:, None]
    )
    before = centres[:led_on] + (middles[0] - centres[led_on])
    after = centres[-led_on:] + (middles[-1] - centres[-led_on - 1])
    normals = interpolated(reach, path.at, path.normals)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    measured = slice(led_on, led_on + every.size)
    middles = np.concatenate([before, middles, after])
    return Profiles(middles, normals, centres, begins, measured, path.sense)


def place_in_profiles(
    profiles: Profiles, xyz: Floats, monitor: Monitor
) -> tuple[NDArray[np.int64], Floats, Floats]:
    """The profile, the turn and the range of points, from where they lie.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.

    Returns
    -------
    rows : (n,) int64
        The profile whose plane is nearest; for points beyond all of them that at the end.
    turns : (n,) float64
        A whole turn points straight down.
    ranges : (n,) float64
        m from the centre.
    """
    rows = np.empty(xyz.shape[0], np.int64)
    for start in range(0, xyz.shape[0], _POINTS_AT_ONCE):
        monitor.check()
        stop = min(start + _POINTS_AT_ONCE, xyz.shape[0])
        _place_kernel(
            xyz[start:stop],
            profiles.middles,
            profiles.normals,
            profiles.centres,
            rows[start:stop],
        )
    at = np.arange(len(profiles.centres), dtype=np.float64)
    path = SweepPath(at, profiles.centres, profiles.normals, profiles.sense)
    angles, ranges = path.seen(xyz, rows.astype(np.float64))
    share = (angles / (2 * np.pi) - profiles.begins) % 1.0
    return rows, rows + profiles.begins + share, ranges


def straighten_planes(profiles: Profiles, xyz: Floats, rows: NDArray[np.int64]) -> Profiles:
    """The same with normals from the steps of all points that were placed in them.

    A road alone hardly tells how its profiles lean; walls and poles do.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, in order.
    rows : (n,) int64
        As :func:`place_in_profiles` has them.
    """
    steps = np.diff(xyz, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    is_inside = (np.diff(rows) == 0) & (lengths > 0)
    units = steps[is_inside] / lengths[is_inside, None]
    block = rows[1:][is_inside] // _ROWS_TOGETHER
    size = -(-len(profiles.normals) // _ROWS_TOGETHER)
    sums = np.zeros((size, 3, 3))
    np.add.at(sums, block, units[:, :, None] * units[:, None, :])
    wide = sums.copy()
    wide[1:] += sums[:-1]
    wide[:-1] += sums[1:]
    counts = np.trace(wide, axis1=1, axis2=2)
    if not counts.any():
        return profiles
    known = np.flatnonzero(counts > _FEW_STEPS * np.median(counts[counts > 0]))
    found = np.linalg.eigh(wide[known])[1][:, :, 0]
    every = np.arange(len(profiles.normals), dtype=np.float64)
    middle = np.asarray((known + 0.5) * _ROWS_TOGETHER, dtype=np.float64)
    before = interpolated(middle, every, profiles.normals)
    agreed = np.einsum("ij,ij->i", found, before)
    is_like = np.abs(agreed) > _LEAST_ALIKE
    if not is_like.any():
        return profiles
    found, middle = (found * np.sign(agreed)[:, None])[is_like], middle[is_like]
    normals = interpolated(every, middle, found)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return replace(profiles, normals=normals)


def _steps(ends: Floats, count: int) -> Floats:
    return np.asarray((ends[1] - ends[0]) * np.arange(1, count + 1))


def _widest_gap(shares: Floats) -> float:
    """The middle of the widest part of a turn in which there is no point."""
    filled = np.unique(np.floor(shares * _GAP_BINS).astype(np.int64) % _GAP_BINS)
    gaps = np.diff(np.append(filled, filled[0] + _GAP_BINS))
    widest = int(np.argmax(gaps))
    return float((filled[widest] + 0.5 + 0.5 * gaps[widest]) / _GAP_BINS) % 1.0


@kernel
def _place_kernel(
    xyz: Floats, middles: Floats, normals: Floats, centres: Floats, rows: NDArray[np.int64]
) -> None:
    """Of the planes between which a point lies, the nearer of the pair whose centre is nearest."""
    for point in range(xyz.shape[0]):
        x, y, z = xyz[point, 0], xyz[point, 1], xyz[point, 2]
        best, nearest, before, least, end = -1, np.inf, 0.0, np.inf, 0
        for row in range(middles.shape[0]):
            off = (
                (x - middles[row, 0]) * normals[row, 0]
                + (y - middles[row, 1]) * normals[row, 1]
                + (z - middles[row, 2]) * normals[row, 2]
            )
            if best < 0 and (row == 0 or abs(off) < least):
                least, end = abs(off), row
            if row > 0 and (off > 0) != (before > 0):
                a, b, c = x - centres[row, 0], y - centres[row, 1], z - centres[row, 2]
                distance = a * a + b * b + c * c
                if distance < nearest:
                    nearest = distance
                    best = row if abs(off) < abs(before) else row - 1
            before = off
        rows[point] = best if best >= 0 else end


def warm_up() -> None:
    """Compile the kernels."""
    planes = np.zeros((2, 3))
    _place_kernel(planes, planes, planes, planes, np.zeros(2, np.int64))

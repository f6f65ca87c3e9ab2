"""Intensity toned for the eye: range and incidence taken out, dark and bright in one picture.

A return is the weaker the farther it comes from, so that asphalt beside the vehicle is grey and
across the road black. How intensity falls with range is measured on the recording itself: the
median in each band of range, over pieces of the whole drive. A surface that is seen askew returns
less than one that faces the scanner: where the drive has normals, that is measured and taken out
in the same way. Joints and wear are then lifted off what lies around them along the scan line, and
what is left of the differences goes through a curve by ranks, which gives dark surfaces as much of
the scale as bright ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.recording.drive import Drive

_PIECES, _PIECE_POINTS = 128, 1024
"""Pieces of the drive from which tones are learnt: some hundred thousand points."""

_BANDS = 24
"""Bands of range with as many points each: each median rests on thousands of points."""

_FACING_BANDS = 12
"""The same of how squarely surfaces are seen: it changes less than range does."""

_LEAST_SHARE = 0.05
"""Nothing is made brighter than twenty times."""

_MOST_ASKEW = 0.05
"""Cosine of incidence below which a normal says nothing of the light."""

_AROUND, _STEP = 24, 3
"""Points along the scan line before and behind, every third of them, that are around a point: some
decimetres on the road, whatever the scanner's rate."""

_LIFT, _MOST_TIMES = 0.4, 3.0
"""Power of the share of a value in what lies around it, and the most that it counts: noise of even
asphalt stays below the steps of the curve."""

_NEAREST_M = 0.1
"""Nothing is measured nearer; a range of 0 has no logarithm."""

_RANKS = 256
_BY_RANK = 0.5
"""How far values are moved from their size to their rank: all the way would make noise of even
surfaces as strong as markings, not at all leaves asphalt black beside paint."""


def toned_intensity(
    drive: Drive, points: NDArray[np.int64], low: float, high: float
) -> NDArray[np.uint8]:
    """Intensities as 0 to 255, comparable at all ranges.

    Parameters
    ----------
    points : integer array
        Of any shape.
    low, high : float
        Percentiles that become black and white.

    Returns
    -------
    uint8 array of the shape of points
    """
    has_trajectory, has_normals = drive.trajectory is not None, drive.columns.has("normal")
    curve = _curve_of(
        drive.folder, drive.count, has_trajectory=has_trajectory, has_normals=has_normals
    )
    seen = _seen(drive, points)
    return curve.tones(_lifted(drive, points), seen.ranges, low, high, facing=seen.facing)


@dataclass(frozen=True)
class _Seen:
    """How points were seen: from how far, m, and how squarely, 0 to 1; None where unknown."""

    ranges: Floats | None = None
    facing: Floats | None = None


class ToneCurve:
    """What a drive's tones were found to be.

    Parameters
    ----------
    values : (n,) float64
        Intensities of points from all over the drive.
    ranges : (n,) float64 or None
        How far away they were, m; None where that isn't known.
    facing : (n,) float64 or None
        Cosines of incidence; NaN of a point without a normal.

    Attributes
    ----------
    ranges, medians : (k,) float64
        Intensity to be expected at a range; empty where ranges aren't known.
    cosines, shares_facing : (m,) float64
        Share of it that is to be expected at an incidence; empty where that isn't known.
    shares, values : (n,) float64
        Shares of points, 0 to 1, and the value that so many don't exceed.
    """

    def __init__(self, values: Floats, ranges: Floats | None, facing: Floats | None = None) -> None:
        self.ranges = self.medians = self.cosines = self.shares_facing = np.zeros(0)
        if ranges is not None and values.size >= _BANDS:
            bands = np.array_split(np.argsort(ranges, kind="stable"), _BANDS)
            middles = [np.median(ranges[band]) for band in bands]
            self.ranges = np.maximum(np.array(middles), _NEAREST_M)
            self.medians = np.maximum([np.median(values[band]) for band in bands], 1.0)
            values = values / self._expected(ranges)
        known = np.zeros(0, bool) if facing is None else np.isfinite(facing)
        if facing is not None and known.sum() >= _FACING_BANDS:
            order = np.flatnonzero(known)[np.argsort(facing[known], kind="stable")]
            bands = np.array_split(order, _FACING_BANDS)
            self.cosines = np.array([np.median(facing[band]) for band in bands])
            whole = max(float(np.median(values[known])), 1e-9)
            shares = np.array([np.median(values[band]) / whole for band in bands])
            self.shares_facing = np.maximum(shares, _LEAST_SHARE)
            values = values / self._share_facing(facing)
        self.shares = np.linspace(0.0, 1.0, _RANKS)
        self.values = np.quantile(values, self.shares) if values.size else self.shares.copy()

    def _expected(self, ranges: Floats) -> Floats:
        """Intensities fall with a power of range, which is straight between logarithms."""
        fall = np.interp(
            np.log(np.maximum(ranges, _NEAREST_M)), np.log(self.ranges), np.log(self.medians)
        )
        return np.asarray(np.exp(fall))

    def _share_facing(self, facing: Floats) -> Floats:
        share = np.interp(facing, self.cosines, self.shares_facing)
        # Beyond the last band as light falls on any surface: with the cosine.
        ends = self.cosines[[0, -1]]
        share = share * np.clip(facing / ends[0], None, 1.0) * np.maximum(facing / ends[1], 1.0)
        return np.asarray(np.where(np.isfinite(facing), share, 1.0))

    def tones(
        self,
        values: Floats,
        ranges: Floats | None,
        low: float,
        high: float,
        *,
        facing: Floats | None = None,
    ) -> NDArray[np.uint8]:
        """Intensities as 0 to 255, black and white at these percentiles.

        Parameters
        ----------
        values, ranges, facing : float64 arrays of one shape
            As those that the curve was learnt from.
        """
        if ranges is not None and self.ranges.size:
            values = values / self._expected(ranges)
        if facing is not None and self.cosines.size:
            values = values / self._share_facing(facing)
        ends = np.interp([low / 100, high / 100], self.shares, self.values)
        by_size = np.clip((values - ends[0]) / max(float(ends[1] - ends[0]), 1e-9), 0.0, 1.0)
        ranked = np.interp(values, self.values, self.shares)
        by_rank = np.clip((ranked - low / 100) / max((high - low) / 100, 1e-9), 0.0, 1.0)
        return np.asarray(255 * ((1 - _BY_RANK) * by_size + _BY_RANK * by_rank), dtype=np.uint8)


@lru_cache(maxsize=64)
def _curve_of(folder: Path, count: int, *, has_trajectory: bool, has_normals: bool) -> ToneCurve:
    """What is learnt of a drive once; what it gets later makes range and incidence known."""
    drive = Drive(folder)
    starts = np.linspace(0, max(0, count - _PIECE_POINTS), _PIECES).astype(np.int64)
    points = np.unique(starts[:, None] + np.arange(min(count, _PIECE_POINTS)))
    seen = _seen(drive, points) if has_trajectory else _Seen()
    return ToneCurve(_lifted(drive, points), seen.ranges, seen.facing if has_normals else None)


def _lifted(drive: Drive, points: NDArray[np.int64]) -> Floats:
    """Intensities, those that differ from what lies around them made to differ more."""
    # A copy can be written; compiled code for arrays that can't be would be other code.
    column, flat = np.asarray(drive.columns["intensity"]), np.array(points, np.int64).ravel()
    lifted = np.empty(flat.size)
    lifted_kernel(column, flat, _COMPARED, lifted)
    return lifted.reshape(np.shape(points))


def _comparisons(count: int) -> NDArray[np.int64]:
    """(k, 2) which of so many values, a power of two, are put in order one after the other.

    Batcher's odd-even merge sort (Knuth, The Art of Computer Programming 3, 5.2.2, algorithm M):
    the same comparisons whatever the values are, so that many points are sorted at a time.
    """
    pairs = []
    merged = count // 2
    while merged:
        high, rest, gap = count // 2, 0, merged
        while True:
            pairs += [(i, i + gap) for i in range(count - gap) if i & merged == rest]
            if high == merged:
                break
            gap, high, rest = high - merged, high // 2, merged
        merged //= 2
    return np.array(pairs)


_COMPARED = _comparisons(2 * (_AROUND // _STEP))
_AT_ONCE = 64


@kernel
def lifted_kernel(
    column: NDArray[np.generic],
    points: NDArray[np.int64],
    compared: NDArray[np.int64],
    lifted: Floats,
) -> None:
    """Write values of points, (n,) each, lifted off the median of those before and behind.

    The median, not the mean: beside paint asphalt stays as it is. ``compared``: as
    :func:`_comparisons` gives them.
    """
    half = _AROUND // _STEP
    around = np.empty((2 * half, _AT_ONCE), np.float32)
    last = len(column) - 1
    for first in range(0, points.size, _AT_ONCE):
        count = min(_AT_ONCE, points.size - first)
        for place in range(2 * half):
            step = _STEP * (place - half + (place >= half))
            for one in range(count):
                around[place, one] = column[min(max(points[first + one] + step, 0), last)]
        for k in range(len(compared)):
            low, high = around[compared[k, 0]], around[compared[k, 1]]
            for one in range(_AT_ONCE):
                less, more = low[one], high[one]
                low[one], high[one] = (less, more) if less < more else (more, less)
        for one in range(count):
            usual = max((around[half - 1, one] + around[half, one]) / 2, 1.0)
            value = float(column[points[first + one]])
            share = min(max(value / usual, 1 / _MOST_TIMES), _MOST_TIMES)
            lifted[first + one] = value * share**_LIFT


def _seen(drive: Drive, points: NDArray[np.int64]) -> _Seen:
    """From the vehicle's reference point to each point; nothing where that isn't known."""
    trajectory = drive.trajectory
    if trajectory is None or not drive.columns.has("time"):
        return _Seen()
    times = np.asarray(drive.columns["time"][points], np.float64)
    times = np.clip(times, trajectory.time[0], trajectory.time[-1])
    seen_from = np.stack(
        [np.interp(times, trajectory.time, axis) for axis in trajectory.xyz.T], axis=-1
    )
    if not np.isfinite(seen_from).all():
        return _Seen()
    flat = np.asarray(points).ravel()
    away = drive.xyz(flat).reshape(*np.shape(points), 3) - seen_from
    ranges = np.sqrt(np.einsum("...k,...k", away, away))
    if not drive.columns.has("normal"):
        return _Seen(ranges)
    normals = np.asarray(drive.columns["normal"][flat], np.float64).reshape(away.shape)
    long = np.linalg.norm(normals, axis=-1) * np.maximum(ranges, _NEAREST_M)
    cosines = np.abs((normals * away).sum(axis=-1)) / np.maximum(long, 1e-9)
    return _Seen(ranges, np.where((long > 0) & (cosines >= _MOST_ASKEW), cosines, np.nan))


def warm_up() -> None:
    """Compile the kernel, which the first picture of a recording asks for."""
    column = np.zeros(1, np.uint16)
    column.flags.writeable = False  # as mapped columns are
    lifted_kernel(column, np.zeros(1, np.int64), _COMPARED, np.empty(1))

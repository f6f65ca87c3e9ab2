"""Intensity toned for the eye: the fall with range taken out, dark and bright read in one picture.

A return is the weaker the farther it comes from, so that asphalt beside the vehicle is grey and
across the road black. How intensity falls with range is measured on the recording itself: the
median in each band of range, over pieces of the whole drive. What is left of the differences goes
through a curve by ranks, which gives dark surfaces as much of the scale as bright ones.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.recording.drive import Drive

_PIECES, _PIECE_POINTS = 128, 1024
"""Pieces of the drive from which tones are learnt: some hundred thousand points."""

_BANDS = 24
"""Bands of range with as many points each: each median rests on thousands of points."""

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
    values = np.asarray(drive.columns["intensity"][points], np.float64)
    has_trajectory = drive.trajectory is not None
    curve = _curve_of(drive.folder, drive.count, has_trajectory=has_trajectory)
    return curve.tones(values, _ranges(drive, points), low, high)


class ToneCurve:
    """What a drive's tones were found to be.

    Parameters
    ----------
    values : (n,) float64
        Intensities of points from all over the drive.
    ranges : (n,) float64 or None
        How far away they were, m; None where that isn't known.

    Attributes
    ----------
    ranges, medians : (k,) float64
        Intensity to be expected at a range; empty where ranges aren't known.
    shares, values : (n,) float64
        Shares of points, 0 to 1, and the value that so many don't exceed.
    """

    def __init__(self, values: Floats, ranges: Floats | None) -> None:
        self.ranges = self.medians = np.zeros(0)
        if ranges is not None and values.size >= _BANDS:
            bands = np.array_split(np.argsort(ranges, kind="stable"), _BANDS)
            middles = [np.median(ranges[band]) for band in bands]
            self.ranges = np.maximum(np.array(middles), _NEAREST_M)
            self.medians = np.maximum([np.median(values[band]) for band in bands], 1.0)
            values = values / self._expected(ranges)
        self.shares = np.linspace(0.0, 1.0, _RANKS)
        self.values = np.quantile(values, self.shares) if values.size else self.shares.copy()

    def _expected(self, ranges: Floats) -> Floats:
        """Intensities fall with a power of range, which is straight between logarithms."""
        fall = np.interp(
            np.log(np.maximum(ranges, _NEAREST_M)), np.log(self.ranges), np.log(self.medians)
        )
        return np.asarray(np.exp(fall))

    def tones(
        self, values: Floats, ranges: Floats | None, low: float, high: float
    ) -> NDArray[np.uint8]:
        """Intensities as 0 to 255, black and white at these percentiles.

        Parameters
        ----------
        values, ranges : float64 arrays of one shape
            As those that the curve was learnt from.
        """
        if ranges is not None and self.ranges.size:
            values = values / self._expected(ranges)
        ends = np.interp([low / 100, high / 100], self.shares, self.values)
        by_size = np.clip((values - ends[0]) / max(float(ends[1] - ends[0]), 1e-9), 0.0, 1.0)
        ranked = np.interp(values, self.values, self.shares)
        by_rank = np.clip((ranked - low / 100) / max((high - low) / 100, 1e-9), 0.0, 1.0)
        return np.asarray(255 * ((1 - _BY_RANK) * by_size + _BY_RANK * by_rank), dtype=np.uint8)


@lru_cache(maxsize=64)
def _curve_of(folder: Path, count: int, *, has_trajectory: bool) -> ToneCurve:
    """What is learnt of a drive once; a trajectory that is added later makes ranges known."""
    drive = Drive(folder)
    starts = np.linspace(0, max(0, count - _PIECE_POINTS), _PIECES).astype(np.int64)
    points = np.unique(starts[:, None] + np.arange(min(count, _PIECE_POINTS)))
    values = np.asarray(drive.columns["intensity"][points], np.float64)
    return ToneCurve(values, _ranges(drive, points) if has_trajectory else None)


def _ranges(drive: Drive, points: NDArray[np.int64]) -> Floats | None:
    """From the vehicle's reference point to each point, m; None where that isn't known."""
    trajectory = drive.trajectory
    if trajectory is None or not drive.columns.has("time"):
        return None
    times = np.asarray(drive.columns["time"][points], np.float64)
    times = np.clip(times, trajectory.time[0], trajectory.time[-1])
    seen_from = np.stack(
        [np.interp(times, trajectory.time, axis) for axis in trajectory.xyz.T], axis=-1
    )
    if not np.isfinite(seen_from).all():
        return None
    flat = np.asarray(points).ravel()
    away = drive.xyz(flat).reshape(*np.shape(points), 3) - seen_from
    return np.asarray(np.linalg.norm(away, axis=-1))

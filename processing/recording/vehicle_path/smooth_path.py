"""The path of a vehicle without the trembling of its records: positions at even steps, directions.

Records are as dense as their rate and as quiet as their filter: at 200 Hz they jitter by
centimetres and crowd where the vehicle stands, at 1 Hz they are corners of a rounded path.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

APART_M = 0.5
"""Records nearer than this in plan count together as one position: those of a waiting vehicle."""

STEP_M = 0.25
"""Between positions of the smooth path: under a bend of 5 m radius its chord leaves the arc by 1.6
mm."""

SMOOTHED_M = 1.0
"""Standard deviation of the bell over which positions are averaged along the vehicle's path:
an axle's distance is some three of it, so no vehicle turns faster than this follows."""

_LEAST_CHORD_M = 1e-6
"""Shorter chords have no direction: far below the millimetre of delivered positions."""


class SmoothPath(NamedTuple):
    """A path in plan with its heights, sampled at even steps.

    Attributes
    ----------
    step_m : float
    positions : (k, 3) float64
        About a local origin, m.
    directions : (k, 2) float64
        Unit vectors in plan along the vehicle's path.
    """

    step_m: float
    positions: Floats
    directions: Floats

    @property
    def length_m(self) -> float:
        """Its length in plan."""
        return self.step_m * (len(self.positions) - 1)


def monotone_runs(xyz: Floats) -> list[tuple[int, int]]:
    """Stretches of records in which the vehicle doesn't turn back.

    Parameters
    ----------
    xyz : (m, 3) float64

    Returns
    -------
    list of tuple of int
        First record, and the one behind the last; the record at which it turns back ends one
        stretch and begins the next.

    Notes
    -----
    It turns back where the path from one of the positions half a metre apart to the next leads back
    by more than a right angle.
    """
    marks = apart(xyz)
    if marks.size < 3:
        return [(0, len(xyz))]
    chords = np.diff(xyz[marks, :2], axis=0)
    turned = np.flatnonzero((chords[:-1] * chords[1:]).sum(axis=1) < 0)
    ends = [0]
    for corner in turned.tolist():
        first, last = marks[corner], marks[min(corner + 2, marks.size - 1)]
        ahead = (xyz[first : last + 1, :2] - xyz[first, :2]) @ chords[corner]
        ends.append(int(first + ahead.argmax()))
    ends = sorted({*ends, len(xyz) - 1})
    return [(first, last + 1) for first, last in pairwise(ends)]


def smooth_way(xyz: Floats) -> SmoothPath | None:
    """The path through records in which the vehicle doesn't turn back.

    Parameters
    ----------
    xyz : (m, 3) float64
        About a local origin, m.

    Returns
    -------
    SmoothPath or None
        None where it is shorter than two steps.

    Notes
    -----
    1. Records within half a metre become their mean.
    2. A rounded line (cubic, its tangents parallel to the chords of neighbours) joins the means.
    3. It is averaged along itself by a bell; beyond its ends it goes on turned about them.
    """
    corners = _means(xyz)
    if len(corners) < 2:
        return None
    even = _at_even_steps(_round_corners(corners))
    if len(even) < 3:
        return None
    even = _at_even_steps(_average_positions(even))
    if len(even) < 3:
        return None
    step = float(np.hypot(*np.diff(even[:, :2], axis=0).T).sum()) / (len(even) - 1)
    along = np.gradient(even[:, :2], axis=0)
    return SmoothPath(step, even, along / np.hypot(along[:, 0], along[:, 1])[:, None])


def apart(xyz: Floats, apart_m: float = APART_M) -> Integers:
    """The first record and each that is so far in plan from the one before: indices, rising.

    A vehicle at rest trembles: what counts is how far it gets, not how far it wanders.
    """
    marked = np.zeros(len(xyz), np.bool_)
    _mark_kernel(np.ascontiguousarray(xyz), apart_m, marked)
    return np.flatnonzero(marked)


def _means(xyz: Floats) -> Floats:
    """(k, 3): the first record, means of what lies together, the last record."""
    marks = apart(xyz)
    sums = np.add.reduceat(xyz, marks, axis=0)
    means = sums / np.diff(np.append(marks, len(xyz)))[:, None]
    positions = np.concatenate([xyz[:1], means, xyz[-1:]])
    # The first and the last mean may lie hardly apart from the ends, or behind them.
    kept = np.ones(len(positions), np.bool_)
    chord = np.diff(positions[:, :2], axis=0)
    kept[1:-1] &= np.hypot(*(positions[1:-1, :2] - positions[0, :2]).T) >= APART_M / 2
    kept[1:-1] &= np.hypot(*(positions[1:-1, :2] - positions[-1, :2]).T) >= APART_M / 2
    if len(chord) == 1 or not kept[1:-1].any():
        kept[1:-1] = False
    return np.asarray(positions[kept])


def _round_corners(corners: Floats) -> Floats:
    """Places along a cubic through corners, some five centimetres apart or nearer."""
    chords = np.diff(corners, axis=0)
    lengths = np.hypot(chords[:, 0], chords[:, 1])
    is_long = lengths > _LEAST_CHORD_M
    corners = np.concatenate([corners[:1], corners[1:][is_long]])
    lengths, chords = lengths[is_long], chords[is_long]
    if len(corners) < 3:
        return corners
    # Tangents per metre: the parabola's through a corner and its neighbours.
    slopes = chords / lengths[:, None]
    before, behind = lengths[:-1, None], lengths[1:, None]
    inner = (slopes[:-1] * behind + slopes[1:] * before) / (before + behind)
    tangents = np.concatenate([slopes[:1], inner, slopes[-1:]])
    counts = np.maximum(1, np.ceil(lengths / (STEP_M / 5)).astype(np.int64))
    part = np.repeat(np.arange(counts.size), counts)
    within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    u = (within / counts[part])[:, None]
    length = lengths[part, None]
    positions = (
        (1 + 2 * u) * (1 - u) ** 2 * corners[part]
        + u * (1 - u) ** 2 * length * tangents[part]
        + u**2 * (3 - 2 * u) * corners[part + 1]
        + u**2 * (u - 1) * length * tangents[part + 1]
    )
    return np.concatenate([positions, corners[-1:]])


def _at_even_steps(positions: Floats) -> Floats:
    """Places of a polyline about a step apart, from its first to its last."""
    lengths = np.hypot(*np.diff(positions[:, :2], axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    steps = max(1, round(along[-1] / STEP_M))
    wanted = np.linspace(0.0, along[-1], steps + 1)
    return np.column_stack([np.interp(wanted, along, axis) for axis in positions.T])


def _average_positions(even: Floats) -> Floats:
    aside = min(round(3 * SMOOTHED_M / STEP_M), len(even) - 1)
    weights = np.exp(-0.5 * (np.arange(-aside, aside + 1) * STEP_M / SMOOTHED_M) ** 2)
    weights /= weights.sum()
    longer = np.concatenate(
        [2 * even[0] - even[aside:0:-1], even, 2 * even[-1] - even[-2 : -aside - 2 : -1]]
    )
    return np.column_stack([np.convolve(axis, weights, mode="valid") for axis in longer.T])


@kernel
def _mark_kernel(xyz: Floats, apart_m: float, marked: NDArray[np.bool_]) -> None:
    """Mark the first record and each that is so far from the one marked before."""
    last = -1
    for i in range(xyz.shape[0]):
        if last >= 0:
            east, north = xyz[i, 0] - xyz[last, 0], xyz[i, 1] - xyz[last, 1]
            if east * east + north * north < apart_m * apart_m:
                continue
        marked[i] = True
        last = i


def warm_up() -> None:
    """Compile the kernel."""
    _mark_kernel(np.zeros((2, 3)), 1.0, np.zeros(2, np.bool_))

"""Where lids lie across a gutter, all along it: by their holes and by the grooves at their sides.

A lid lies in its bed with a gap of some millimetres to either side. A row that crosses such a
groove dips by a few millimetres, so the grooves are fine lines of narrow, shallow notches as far
apart as a lid is wide. Holes say within a few centimetres where the lids' middle is, grooves within
one. Both are asked together for every metre and every type of lid, and what lies between is the
smoothest way through (a hidden Markov model along the gutter).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from processing.methods.road.gutters.gutter_axis import STEP_M, GutterAxis
from processing.methods.road.gutters.gutter_holes import (
    EDGES_M,
    LID_TYPES,
    OFFSETS_M,
    JointNotches,
    LidType,
    counts_across,
    hole_likelihoods,
)

_Floats = NDArray[np.float64]

_STATION_M = 1.0
"""A gutter's middle is asked for every metre: some ten rows at 30 km/h and 100 revolutions/s."""

_SPREAD_M = 0.01
"""Standard deviation of a groove's place across: a spacing of points."""

_SHARES = (0.1, 0.25, 0.5, 0.75)
"""Shares of narrow notches between joints that are of the grooves, of which the likeliest is taken:
dirt fills some, and worn concrete has dents of its own."""

_SWAY_M = 0.02
"""How far the middle may sway from a smooth axis in a metre, standard deviation; over n metres √n
times as far. Of 52 gutters of 24 development streets and both samples, 1 cm left 3.4 cm at the
edges, 2 cm 2.9 and 3 cm 3.1 (root mean squares)."""

_AROUND_M, _LEAST_AROUND = 0.08, 0.05
"""What else is noted across the gutter is counted over so much to either side (standard deviation),
and is nowhere less than this share of its mean."""

_SMOOTH_M = 3.0
"""Gutters bend evenly over so much (standard deviation of the window in which a parabola is laid):
at a radius of 50 m, where a bend begins, that cuts off less than a centimetre."""

_LEAST_VARIANCE_M2 = 0.005**2
"""No metre is surer: half a bin."""

_RIDGE = 1e-3
"""Guard of parabolas where the window holds few stations: flat, then straight."""

_LEAST_CHANCE = 1e-12
"""Guard of divisions and logarithms."""


class SideNotches(NamedTuple):
    """Narrow notches between the joints of lids: (n,) along and across the axis, m."""

    along_m: _Floats
    across_m: _Floats


class LidsAcross(NamedTuple):
    """The type of lids that holes and grooves fit best, and the axis through their middle."""

    type: LidType
    axis: GutterAxis


def lids_across(
    axis: GutterAxis, joints: tuple[_Floats, JointNotches], sides: SideNotches
) -> LidsAcross:
    """Type and middle of the lids along a gutter.

    Parameters
    ----------
    axis : GutterAxis
        Within 20 cm of the lids' middle.
    joints : (n,) float64, JointNotches
        Where notches lie along the axis that are at joints or between them, and what they say.
    sides : SideNotches

    References
    ----------
    Rabiner 1989, A tutorial on hidden Markov models (forward-backward, scaled; states are places
    across); Cleveland 1979 (local regression).
    """
    count = max(1, int(np.ceil(axis.length_m / _STATION_M)))
    stations = (np.arange(count) + 0.5) * _STATION_M
    evidence = _evidence_of_holes(*joints, count)[:, :, None] + _evidence_of_grooves(sides, count)
    shape = evidence.shape[:3]
    chains = evidence.reshape(-1, *evidence.shape[3:])
    priors = np.log([one.share for one in LID_TYPES])
    ahead, worth = _forward(chains)
    best = int((worth.reshape(shape) + priors[:, None, None]).argmax())
    chances = ahead[:, best] * _backward(chains[best])
    chances /= chances.sum(axis=1, keepdims=True)
    middle = chances @ OFFSETS_M
    variance = chances @ OFFSETS_M**2 - middle**2
    at = np.arange(len(axis.xyz), dtype=np.float64) * STEP_M
    moved = axis.positions(at, np.interp(at, stations, middle).astype(np.float64))
    sure = 1.0 / (np.interp(at, stations, variance) + _LEAST_VARIANCE_M2)
    kind = LID_TYPES[int(np.unravel_index(best, shape)[0])]
    return LidsAcross(kind, GutterAxis.through(_smoothed(moved, sure)))


def smooth_axis(axis: GutterAxis) -> GutterAxis:
    """The axis without what sways faster than gutters bend."""
    return GutterAxis.through(_smoothed(axis.xyz, np.ones(len(axis.xyz))))


def _station_of(along: _Floats, count: int) -> NDArray[np.int64]:
    return np.clip((along / _STATION_M).astype(np.int64), 0, count - 1)


def _evidence_of_holes(along: _Floats, notches: JointNotches, count: int) -> _Floats:
    """(types, grooves, stations, offsets): logarithms."""
    likelihoods = hole_likelihoods()
    counts = counts_across(notches, _station_of(along, count), count)
    found = np.tensordot(likelihoods, counts, axes=((3, 4), (1, 2)))
    return np.asarray(found.transpose(0, 2, 3, 1), np.float64)


def _evidence_of_grooves(sides: SideNotches, count: int) -> _Floats:
    """(types, 1, shares, stations, offsets): logarithms against what else lies about."""
    bins = EDGES_M.size - 1
    at = np.searchsorted(EDGES_M, sides.across_m) - 1
    is_in = (at >= 0) & (at < bins)
    keys = _station_of(sides.along_m[is_in], count) * bins + at[is_in]
    counts = np.bincount(keys, minlength=count * bins).reshape(count, bins).astype(np.float64)
    bin_m = float(EDGES_M[1] - EDGES_M[0])
    about = gaussian_filter1d(counts.sum(axis=0), _AROUND_M / bin_m, mode="nearest")
    about += max(_LEAST_AROUND * float(about.mean()), _LEAST_CHANCE)
    about /= about.sum() * bin_m
    middles = (EDGES_M[1:] + EDGES_M[:-1]) / 2
    halves = np.array([one.width_m / 2 for one in LID_TYPES])
    off = np.abs(middles - OFFSETS_M[:, None])[None] - halves[:, None, None]
    # Both sides of a lid: half of the notches in each.
    density = np.exp(-0.5 * (off / _SPREAD_M) ** 2) / (2 * _SPREAD_M * np.sqrt(2 * np.pi))
    shares = np.array(_SHARES)[:, None, None]
    likelihoods = np.log(1.0 - shares + shares * (density / about)[:, None])
    return np.asarray((likelihoods @ counts.T).transpose(0, 1, 3, 2)[:, None], np.float64)


def _moves() -> _Floats:
    """(k, k) chance of each offset after each: rows sum to 1."""
    off = (OFFSETS_M[:, None] - OFFSETS_M) / (_SWAY_M * np.sqrt(_STATION_M))
    chance = np.exp(-0.5 * off**2) + _LEAST_CHANCE
    return np.asarray(chance / chance.sum(axis=1, keepdims=True), np.float64)


def _forward(chains: _Floats) -> tuple[_Floats, _Floats]:
    """(stations, chains, offsets) chances by what is behind, and (chains,) logarithms of all."""
    moves = _moves()
    ahead = np.empty((chains.shape[1], chains.shape[0], chains.shape[2]))
    worth = np.zeros(len(chains))
    before = np.full((chains.shape[0], chains.shape[2]), 1.0 / chains.shape[2])
    for station in range(chains.shape[1]):
        most = chains[:, station].max(axis=1)
        now = before * np.exp(chains[:, station] - most[:, None]) + _LEAST_CHANCE
        total = now.sum(axis=1)
        worth += np.log(total) + most
        ahead[station] = now / total[:, None]
        before = ahead[station] @ moves
    return ahead, worth


def _backward(chain: _Floats) -> _Floats:
    """(stations, offsets) chances by what is ahead, of one chain."""
    moves = _moves()
    behind = np.ones_like(chain)
    for station in range(len(chain) - 2, -1, -1):
        after = chain[station + 1]
        now = moves @ (behind[station + 1] * np.exp(after - after.max())) + _LEAST_CHANCE
        behind[station] = now / now.sum()
    return behind


def _smoothed(xyz: _Floats, sure: _Floats) -> _Floats:
    """Places every `STEP_M` on the parabolas through those about them, as sure as each is."""
    reach = int(3 * _SMOOTH_M / STEP_M)
    away = np.arange(-reach, reach + 1) * STEP_M / _SMOOTH_M
    window = np.exp(-0.5 * away**2)

    def summed(values: _Floats, power: int) -> _Floats:
        kernel = (window * away**power)[::-1]
        return np.convolve(values, kernel, mode="full")[reach : reach + values.size]

    origin = xyz.mean(axis=0)
    moments = [summed(sure, power) for power in range(5)]
    left = np.empty((len(xyz), 3, 3))
    for i in range(3):
        for j in range(3):
            left[:, i, j] = moments[i + j]
    left[:, (1, 2), (1, 2)] += _RIDGE * moments[0][:, None]
    right = np.stack(
        [
            np.column_stack([summed(sure * values, power) for values in (xyz - origin).T])
            for power in range(3)
        ],
        axis=1,
    )
    return np.asarray(np.linalg.solve(left, right)[:, 0] + origin, np.float64)

"""Where a scanner stood on its tripod, found from the order in which it measured.

A tripod's head turns slowly while its mirror spins: for a moment all beams lie in one upright
plane through the scanner. Seen from above, points measured within a moment lie on a line through
it, and lines of many moments meet where it stood. Its mirror turns evenly, so its height is where
the points of a moment are evenly spaced by their angles.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.noise.beams.beam_origins import beam_origins
from processing.methods.noise.beams.measured_order import measured_times
from processing.recording.drive import Drive

Floats = NDArray[np.float64]

_MOMENTS = 24
"""Moments, spread over a recording: of a full turn of the head one every 15°, so that their lines
cross at good angles."""

_POINTS_OF_MOMENT = 1000
"""Consecutive points of a moment: a few sweeps of the mirror, in which the head hardly turns. By
trial."""

_PULSES_APART = 8
"""Pulses between two points that are compared; from one to the next the noise is as large as the
step. By trial."""

_LEAST_LENGTH_M = 0.5
"""Of the line through two such points, in plan: shorter ones have no sure direction. By trial."""

_PULSES_WITHIN = 2 * _PULSES_APART
"""Pulses that may have passed between them: with more, the mirror jumped over a part of the sky."""

_FEWEST = 200
"""Points or lines that tell anything; by trial."""

_MOST_SPREAD_M = 0.3
"""Of lines about the position where they meet, and of centres about their middle, in the median: a
scanner that moved spreads them farther. By trial."""

_ROUNDS = 30
"""Of reweighted least squares; by trial."""

_WORST_CONDITION = 1e6
"""Of the normal equations: above, all lines run the same way and do not cross."""

_LEAST_SPREAD_M = 1e-3
"""Keeps weights finite where lines meet to better than a scanner measures."""

_SIGMA_PER_MEDIAN = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""

_GROUND_PERCENT, _GROUND_NEAR_M = (10, 90), 6.0
"""The ground around a tripod: heights within this distance between these percentiles. By trial;
nearest is a blind cone, and the lowest points may be echoes. On a bank they are metres apart."""

_SEEN_HEIGHTS_M = (0.5, 3.5)
"""Above the lower and the higher of them, between which the scanner is looked for: tripods from the
lowest to those that are set up with a ladder."""

_STEPS_M = (0.05, 0.01)
"""Of the first and the second search: the second looks about what the first found, to 1 cm."""

_USUAL_HEIGHT_M = 1.7
"""Of a tripod, at a person's eyes: taken where the points tell none."""

_CLEARLY_SHARE = 0.5
"""A height is found where it leaves less than this share of the usual unevenness; by trial."""

_SAME_PULSE = 0.5
"""Pulses by which a count may be off its whole number: the nearest whole number is meant."""


def scanner_position_of(drive: Drive) -> Floats | None:
    """Where a drive's scanner stood: (3,) float64, m, project CRS; None where nothing tells.

    Deliveries without times, and scanners that moved, don't tell it.
    """
    if drive.info.scanner_position is not None:
        return np.array(drive.info.scanner_position)
    if drive.trajectory is not None or not drive.columns.has("time"):
        return None
    if drive.revolutions is not None:
        return _middle_of_revolutions(drive)
    times = np.asarray(drive.columns["time"])
    if not np.isfinite(times).all():
        return None
    return _met(drive, np.argsort(times, kind="stable"), times)


def position_in_order(drive: Drive, order: NDArray[np.int64]) -> Floats | None:
    """The same from the points of a drive as they were measured, with or without times.

    Parameters
    ----------
    order : (n,) int64
        As :func:`processing.methods.noise.beams.measured_order.measured_order` gives it. Without
        times every point is taken for a pulse of its own, right after the one before.
    """
    times = measured_times(drive)
    if times is None:
        times = np.empty(order.size)
        times[order] = np.arange(order.size)
    return _met(drive, order, times)


def _met(drive: Drive, order: NDArray[np.int64], times: Floats) -> Floats | None:
    """Where the planes of moments meet; None where they don't."""
    moments = _moments(drive, order, times)
    if not moments:
        return None
    across = _crossing(moments)
    if across is None:
        return None
    return np.array([*across, _height_over(moments, across)])


def _middle_of_revolutions(drive: Drive) -> Floats | None:
    """The centre of all revolutions; None where it moved."""
    origins = beam_origins(drive)
    if origins is None:
        return None
    middle: Floats = np.median(origins.positions, axis=0)
    away = np.linalg.norm(origins.positions - middle, axis=1)
    return middle if float(np.median(away)) <= _MOST_SPREAD_M else None


def _moments(drive: Drive, order: NDArray[np.int64], times: Floats) -> list[Floats]:
    """Points measured one after the other, in several moments spread over the recording."""
    if times.size < _FEWEST or times.min() == times.max():
        return []
    starts = np.unique(
        np.linspace(0, max(times.size - _POINTS_OF_MOMENT, 0), _MOMENTS).astype(np.int64)
    )
    found = []
    for start in starts:
        points = order[start : start + _POINTS_OF_MOMENT]
        steps = np.diff(times[points])
        # What lies between two pulses without a return is no step of the mirror.
        pulse_s = float(np.median(steps[steps > 0])) if (steps > 0).any() else 0.0
        if pulse_s > 0.0:
            found.append(np.column_stack([drive.xyz(points), times[points] / pulse_s]))
    return found


def _crossing(moments: list[Floats]) -> Floats | None:
    """Where the lines of the moments meet in plan: (2,); None where they don't."""
    starts, normals = [], []
    for moment in moments:
        first, second = moment[:-_PULSES_APART], moment[_PULSES_APART:]
        directions = second[:, :2] - first[:, :2]
        long = np.hypot(directions[:, 0], directions[:, 1])
        is_line = (long > _LEAST_LENGTH_M) & (second[:, 3] - first[:, 3] <= _PULSES_WITHIN)
        directions = directions[is_line] / long[is_line, None]
        starts.append(first[is_line, :2])
        normals.append(np.column_stack([-directions[:, 1], directions[:, 0]]))
    on_lines, across = np.concatenate(starts), np.concatenate(normals)
    if len(across) < _FEWEST:
        return None
    middle = on_lines.mean(axis=0)
    offsets = np.einsum("ij,ij->i", on_lines - middle, across)
    weights, position, spread = np.ones(len(across)), np.zeros(2), np.inf
    for _ in range(_ROUNDS):
        form = across.T @ (across * weights[:, None])
        if np.linalg.cond(form) > _WORST_CONDITION:
            return None
        position = np.linalg.solve(form, across.T @ (weights * offsets))
        misses = across @ position - offsets
        middle_miss = float(np.median(np.abs(misses)))
        spread = max(_SIGMA_PER_MEDIAN * middle_miss, _LEAST_SPREAD_M)
        weights = 1.0 / np.square(1.0 + np.square(misses / spread))
    return position + middle if spread <= _MOST_SPREAD_M else None


def _height_over(moments: list[Floats], position: Floats) -> float:
    """Where the points of a moment are evenly spaced by their angles, m; else the usual height."""
    everything = np.concatenate(moments)
    away = np.hypot(*(everything[:, :2] - position).T)
    near = everything[away < _GROUND_NEAR_M, 2]
    below = above = float(everything[:, 2].min())
    if near.size >= _FEWEST:
        below, above = (float(one) for one in np.percentile(near, _GROUND_PERCENT))
    low, high = below + _SEEN_HEIGHTS_M[0], above + _SEEN_HEIGHTS_M[1]
    slants = [_slants_of(moment, position) for moment in moments]
    best, least, usual = below + _USUAL_HEIGHT_M, np.inf, np.inf
    for step in _STEPS_M:
        heights = np.arange(low, high, step)
        uneven = [_unevenness(slants, float(height)) for height in heights]
        best, least = float(heights[int(np.argmin(uneven))]), float(np.min(uneven))
        # The first search spans all heights: what most of them would give.
        usual = usual if np.isfinite(usual) else float(np.median(uneven))
        low, high = best - step, best + step
    return best if least < _CLEARLY_SHARE * usual else below + _USUAL_HEIGHT_M


@dataclass(frozen=True)
class _Slants:
    """A moment's points beside the scanner's upright line: what doesn't depend on its height."""

    away_m: Floats
    z: Floats
    is_whole: NDArray[np.bool_]


def _slants_of(moment: Floats, position: Floats) -> _Slants:
    away = np.hypot(*(moment[:, :2] - position).T)
    is_whole = (
        np.abs(moment[_PULSES_APART:, 3] - moment[:-_PULSES_APART, 3] - _PULSES_APART) < _SAME_PULSE
    )
    return _Slants(away, moment[:, 2].copy(), is_whole)


def _unevenness(slants: list[_Slants], height: float) -> float:
    spreads = []
    for moment in slants:
        angles = np.arctan2(moment.z - height, moment.away_m)
        steps = (angles[_PULSES_APART:] - angles[:-_PULSES_APART])[moment.is_whole]
        if steps.size:
            spreads.append(_middle(np.abs(steps - _middle(steps))))
    return _middle(np.array(spreads)) if spreads else np.inf


def _middle(values: Floats) -> float:
    """The median; numpy's own looks for NaN first, which takes as long."""
    half = values.size // 2
    if values.size % 2:
        return float(np.partition(values, half)[half])
    low, high = np.partition(values, [half - 1, half])[half - 1 : half + 1]
    return float(low + high) / 2

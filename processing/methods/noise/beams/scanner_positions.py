"""Where a scanner stood on its tripod, told by the order in which it measured.

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
from processing.recording.drive import Drive

Floats = NDArray[np.float64]

_MOMENTS = 24
_OF_MOMENT = 1000
_APART = 8
_LEAST_M = 0.5
_FEWEST = 200
_MOST_SPREAD_M = 0.3
_ROUNDS = 30
_SEEN_HEIGHTS_M = (0.5, 3.5)
_STEPS_M = (0.05, 0.01)
_USUAL_M = 1.7
_CLEARLY = 0.5
_SAME_PULSE = 0.5
_NEAR_M = 6.0


def scanner_position_of(drive: Drive) -> Floats | None:
    """Where a drive's scanner stood: (3,) float64, m, project CRS; None where nothing tells.

    Deliveries without times, and scanners that moved, don't tell.
    """
    if drive.info.scanner_position is not None:
        return np.array(drive.info.scanner_position)
    if drive.trajectory is not None or not drive.columns.has("time"):
        return None
    if drive.revolutions is not None:
        return _middle_of_revolutions(drive)
    moments = _moments(drive)
    if not moments:
        return None
    across = _crossing(moments)
    if across is None:
        return None
    up = _height_over(moments, across)
    return np.array([*across, up])


def _middle_of_revolutions(drive: Drive) -> Floats | None:
    """The centre of all turns; None where it moved."""
    origins = beam_origins(drive)
    if origins is None:
        return None
    middle: Floats = np.median(origins.positions, axis=0)
    away = np.linalg.norm(origins.positions - middle, axis=1)
    return middle if float(np.median(away)) <= _MOST_SPREAD_M else None


def _moments(drive: Drive) -> list[Floats]:
    """Points measured one after the other, in several moments spread over the recording."""
    times = np.asarray(drive.columns["time"])
    if times.size < _FEWEST or not np.isfinite(times).all() or times.min() == times.max():
        return []
    order = np.argsort(times, kind="stable")
    starts = np.unique(np.linspace(0, max(times.size - _OF_MOMENT, 0), _MOMENTS).astype(np.int64))
    found = []
    for start in starts:
        points = order[start : start + _OF_MOMENT]
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
        first, second = moment[:-_APART], moment[_APART:]
        directions = second[:, :2] - first[:, :2]
        long = np.hypot(directions[:, 0], directions[:, 1])
        is_line = (long > _LEAST_M) & (second[:, 3] - first[:, 3] <= 2 * _APART)
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
        if np.linalg.cond(form) > 1e6:
            return None
        position = np.linalg.solve(form, across.T @ (weights * offsets))
        misses = across @ position - offsets
        spread = max(1.4826 * float(np.median(np.abs(misses))), 1e-3)
        weights = 1.0 / np.square(1.0 + np.square(misses / spread))
    return position + middle if spread <= _MOST_SPREAD_M else None


def _height_over(moments: list[Floats], position: Floats) -> float:
    """Where the points of a moment are evenly spaced by their angles, m; else the usual height."""
    everything = np.concatenate(moments)
    away = np.hypot(*(everything[:, :2] - position).T)
    near = everything[away < _NEAR_M, 2]
    below = (
        float(np.percentile(near, 10)) if near.size >= _FEWEST else float(everything[:, 2].min())
    )
    low, high = below + _SEEN_HEIGHTS_M[0], below + _SEEN_HEIGHTS_M[1]
    slants = [_slants_of(moment, position) for moment in moments]
    best, least, usual = below + _USUAL_M, np.inf, np.inf
    for step in _STEPS_M:
        heights = np.arange(low, high, step)
        uneven = [_unevenness(slants, float(height)) for height in heights]
        best, least = float(heights[int(np.argmin(uneven))]), float(np.min(uneven))
        # The first search spans all heights: what most of them would give.
        usual = usual if np.isfinite(usual) else float(np.median(uneven))
        low, high = best - step, best + step
    return best if least < _CLEARLY * usual else below + _USUAL_M


@dataclass(frozen=True)
class _Slants:
    """A moment's points beside the scanner's upright line: what doesn't depend on its height."""

    away_m: Floats
    z: Floats
    is_whole: NDArray[np.bool_]


def _slants_of(moment: Floats, position: Floats) -> _Slants:
    away = np.hypot(*(moment[:, :2] - position).T)
    # Over some pulses: from one to the next the noise is as large as the step.
    is_whole = np.abs(moment[_APART:, 3] - moment[:-_APART, 3] - _APART) < _SAME_PULSE
    return _Slants(away, moment[:, 2].copy(), is_whole)


def _unevenness(slants: list[_Slants], height: float) -> float:
    spreads = []
    for moment in slants:
        angles = np.arctan2(moment.z - height, moment.away_m)
        steps = (angles[_APART:] - angles[:-_APART])[moment.is_whole]
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

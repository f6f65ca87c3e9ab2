"""The phase of the mirror through a whole drive, followed window by window as its rate drifts."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_TURNS_PER_WINDOW = 8.0
_LEAST_POINTS = 24
_LEAST_COHERENCE = 0.3
_CLEAR_ANGLE_RAD = 0.6


@dataclass(frozen=True)
class TurnPhase:
    """Turns as a function of time, in one stretch without a stop.

    Attributes
    ----------
    time : (k,) float64
        Knots, rising.
    turns : (k,) float64
        Turns of the mirror at the knots, rising; whole numbers where its angle is 0.
    rate_hz : float
        Mean rate, positive.
    coherence : float
        0..1, mean over the windows.
    """

    time: Floats
    turns: Floats
    rate_hz: float
    coherence: float

    def times_of(self, turns: Floats) -> Floats:
        """When the mirror had made so many turns; steady beyond the knots.

        Parameters
        ----------
        turns : (n,) float64
        """
        times = np.interp(turns, self.turns, self.time)
        early, late = turns < self.turns[0], turns > self.turns[-1]
        times[early] = self.time[0] + (turns[early] - self.turns[0]) / self._rate_at(slice(0, 4))
        times[late] = self.time[-1] + (turns[late] - self.turns[-1]) / self._rate_at(
            slice(-4, None)
        )
        return times

    def turns_at(self, times: Floats) -> Floats:
        """How many turns the mirror had made at some times."""
        turns = np.interp(times, self.time, self.turns)
        early, late = times < self.time[0], times > self.time[-1]
        turns[early] = self.turns[0] + (times[early] - self.time[0]) * self._rate_at(slice(0, 4))
        turns[late] = self.turns[-1] + (times[late] - self.time[-1]) * self._rate_at(
            slice(-4, None)
        )
        return turns

    def _rate_at(self, knots: slice) -> float:
        time, turns = self.time[knots], self.turns[knots]
        if time.size < 2:
            return self.rate_hz
        return float((turns[-1] - turns[0]) / (time[-1] - time[0]))


def track_turns(time: Floats, angle: Floats, rate_hz: float) -> TurnPhase:
    """Follow the mirror through a stretch without a stop.

    Parameters
    ----------
    time : (n,) float64
        s, not decreasing; some dozens a turn.
    angle : (n,) float64
        rad.
    rate_hz : float
        Signed, as found on samples of the drive.

    Notes
    -----
    In windows of some turns, the angles that miss the prediction turn its phase and rate. Windows
    of few or incoherent points leave the prediction as it is.
    """
    turning = float(np.sign(rate_hz))
    angle = angle * turning
    rate = 2 * np.pi * abs(rate_hz)
    length = _TURNS_PER_WINDOW / abs(rate_hz)
    edges = np.arange(time[0], time[-1] + length, length)
    bounds = np.searchsorted(time, edges)
    knots, phases, coherences = [], [], []
    at, phase = float(time[0]), 0.0
    is_locked = False
    for start, stop in pairwise(bounds):
        if stop - start < _LEAST_POINTS:
            continue
        mine = time[start:stop]
        waves = np.exp(1j * (angle[start:stop] - phase - rate * (mine - at)))
        mean = waves.mean()
        if abs(mean) < _LEAST_COHERENCE and is_locked:
            continue
        turned = float(np.angle(mean))
        miss = np.angle(waves * np.exp(-1j * turned))
        near = np.abs(miss) < _CLEAR_ANGLE_RAD
        if np.count_nonzero(near) < _LEAST_POINTS:
            continue
        middle = float(mine[near].mean())
        centred = mine[near] - middle
        spread = float(centred @ centred)
        phase += rate * (middle - at) + turned + float(miss[near].mean())
        at = middle
        knots.append(middle)
        phases.append(phase)
        coherences.append(float(np.mean(np.cos(miss))))
        if spread > 0:
            change = float(centred @ miss[near]) / spread
            rate += (0.5 if is_locked else 1.0) * float(np.clip(change, -0.01 * rate, 0.01 * rate))
        is_locked = True
    return _phase_of(np.array(knots), np.array(phases), np.array(coherences), time, abs(rate_hz))


def _phase_of(
    knots: Floats, phases: Floats, coherences: Floats, time: Floats, rate_hz: float
) -> TurnPhase:
    if knots.size == 0:
        middle = 0.5 * float(time[0] + time[-1])
        return TurnPhase(np.array([middle]), np.zeros(1), rate_hz, 0.0)
    turns = phases / (2 * np.pi)
    # Window means whose phase would run backwards are noise of a stretch hardly seen.
    rising = np.concatenate([[True], np.diff(turns) > 0.5 * rate_hz * np.diff(knots)])
    knots, turns, coherences = knots[rising], turns[rising], coherences[rising]
    if knots.size > 1:
        rate_hz = float((turns[-1] - turns[0]) / (knots[-1] - knots[0]))
    return TurnPhase(knots, turns, rate_hz, float(np.mean(coherences)))

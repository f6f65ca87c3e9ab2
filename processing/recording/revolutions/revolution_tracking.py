"""The phase of the mirror through a whole drive, followed window by window as its rate drifts."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from processing.core.arrays import Floats

_REVOLUTIONS_PER_WINDOW = 8.0
"""Length of a window in which the rotation is even and the vehicle straight. By trial; no
measurement is recorded."""

_LEAST_POINTS = 24
"""Points of a window from which its phase is computed. By trial; no measurement is recorded."""

_LEAST_COHERENCE = 0.3
"""How well directions of a window follow the rotation, 0 to 1, for its phase to count. By trial; no
measurement is recorded."""

_MOST_CHANGE = 0.01
"""Share by which the rate may change from window to window: a heavy mirror keeps it."""

_CLEAR_ANGLE_RAD = 0.6
"""Directions farther off the rotation are of other things: 34°, as in `rotation_fit`."""

_TAKEN_OVER = 0.5
"""Share of a window's change of rate that is taken over once locked, so that noise is halved. By
trial; no measurement is recorded."""

_LEAST_ADVANCE = 0.5
"""Share of the expected revolutions that must lie between two windows; less is noise. By trial; no
measurement is recorded."""

_KNOTS_AT_ENDS = 4
"""Windows at both ends by whose rate the phase is led on beyond them. By trial; no measurement is
recorded."""


@dataclass(frozen=True)
class RevolutionPhase:
    """Revolutions as a function of time, in one stretch without a stop.

    Attributes
    ----------
    time : (k,) float64
        Knots, rising.
    revolutions : (k,) float64
        Revolutions of the mirror at the knots, rising; whole numbers where its angle is 0.
    rate_hz : float
        Mean rate, positive.
    coherence : float
        0..1, mean over the windows.
    """

    time: Floats
    revolutions: Floats
    rate_hz: float
    coherence: float

    def times_of(self, revolutions: Floats) -> Floats:
        """When the mirror had made so many revolutions; steady beyond the knots.

        Parameters
        ----------
        revolutions : (n,) float64
        """
        times = np.interp(revolutions, self.revolutions, self.time)
        early, late = revolutions < self.revolutions[0], revolutions > self.revolutions[-1]
        times[early] = self.time[0] + (revolutions[early] - self.revolutions[0]) / self._rate_at(
            slice(0, _KNOTS_AT_ENDS)
        )
        times[late] = self.time[-1] + (revolutions[late] - self.revolutions[-1]) / self._rate_at(
            slice(-_KNOTS_AT_ENDS, None)
        )
        return times

    def revolutions_at(self, times: Floats) -> Floats:
        """How many revolutions the mirror had made at some times."""
        revolutions = np.interp(times, self.time, self.revolutions)
        early, late = times < self.time[0], times > self.time[-1]
        revolutions[early] = self.revolutions[0] + (times[early] - self.time[0]) * self._rate_at(
            slice(0, _KNOTS_AT_ENDS)
        )
        revolutions[late] = self.revolutions[-1] + (times[late] - self.time[-1]) * self._rate_at(
            slice(-_KNOTS_AT_ENDS, None)
        )
        return revolutions

    def _rate_at(self, knots: slice) -> float:
        time, revolutions = self.time[knots], self.revolutions[knots]
        if time.size < 2:
            return self.rate_hz
        return float((revolutions[-1] - revolutions[0]) / (time[-1] - time[0]))


class RevolutionTracker:
    """Follows the mirror through a stretch without a stop, as its points come.

    Parameters
    ----------
    rate_hz : float
        Signed, as found on samples of the drive.

    Notes
    -----
    In windows of some revolutions, the angles that miss the prediction correct its phase and rate.
    Windows of few or incoherent points leave the prediction as it is. Only the points of the last
    window are kept.
    """

    def __init__(self, rate_hz: float) -> None:
        self._rate_hz = abs(rate_hz)
        self._turning = float(np.sign(rate_hz))
        self._rate = 2 * np.pi * abs(rate_hz)
        self._length = _REVOLUTIONS_PER_WINDOW / abs(rate_hz)
        self._time, self._angle = np.empty(0), np.empty(0)
        self._first, self._last = np.nan, np.nan
        self._window = 0
        self._at, self._phase = 0.0, 0.0
        self._is_locked = False
        self._knots: list[float] = []
        self._phases: list[float] = []
        self._coherences: list[float] = []

    @property
    def has_points(self) -> bool:
        """Whether any point came."""
        return bool(np.isfinite(self._first))

    def add(self, time: Floats, angle: Floats) -> None:
        """Take the next points.

        Parameters
        ----------
        time : (n,) float64
            s, not decreasing; some dozens a revolution.
        angle : (n,) float64
            rad.
        """
        if time.size == 0:
            return
        if not self.has_points:
            self._first = self._at = float(time[0])
        self._last = float(time[-1])
        self._time = np.concatenate([self._time, time])
        self._angle = np.concatenate([self._angle, angle * self._turning])
        # The last window may still get points.
        last = int((self._last - self._first) / self._length) - 1
        self._follow(last + 1)

    def phase(self) -> RevolutionPhase:
        """The revolutions, when all points came."""
        self._follow(np.arange(self._first, self._last + self._length, self._length).size)
        ends = self._first, self._last
        knots, phases = np.array(self._knots), np.array(self._phases)
        return _phase_of(knots, phases, np.array(self._coherences), ends, self._rate_hz)

    def _follow(self, edge: int) -> None:
        """Go through the windows before an edge; the points in them are dropped."""
        # The step that the first edge and the next one really make, as `arange` has it.
        step = (self._first + self._length) - self._first
        edges = np.asarray(self._first + np.arange(self._window, edge) * step, dtype=np.float64)
        if edges.size < 2:
            return
        bounds = np.searchsorted(self._time, edges)
        for start, stop in pairwise(bounds):
            if stop - start >= _LEAST_POINTS:
                self._turn(self._time[start:stop], self._angle[start:stop])
        self._window += edges.size - 1
        self._time, self._angle = self._time[bounds[-1] :], self._angle[bounds[-1] :]

    def _turn(self, time: Floats, angle: Floats) -> None:
        """Let a window correct phase and rate."""
        waves = np.exp(1j * (angle - self._phase - self._rate * (time - self._at)))
        mean = waves.mean()
        if abs(mean) < _LEAST_COHERENCE and self._is_locked:
            return
        turned = float(np.angle(mean))
        miss = np.angle(waves * np.exp(-1j * turned))
        near = np.abs(miss) < _CLEAR_ANGLE_RAD
        if np.count_nonzero(near) < _LEAST_POINTS:
            return
        middle = float(time[near].mean())
        centred = time[near] - middle
        spread = float(centred @ centred)
        self._phase += self._rate * (middle - self._at) + turned + float(miss[near].mean())
        self._at = middle
        self._knots.append(middle)
        self._phases.append(self._phase)
        self._coherences.append(float(np.mean(np.cos(miss))))
        if spread > 0:
            change = float(centred @ miss[near]) / spread
            most = _MOST_CHANGE * self._rate
            self._rate += (_TAKEN_OVER if self._is_locked else 1.0) * float(
                np.clip(change, -most, most)
            )
        self._is_locked = True


def _phase_of(
    knots: Floats,
    phases: Floats,
    coherences: Floats,
    ends: tuple[float, float],
    rate_hz: float,
) -> RevolutionPhase:
    if knots.size == 0:
        middle = 0.5 * (ends[0] + ends[1])
        return RevolutionPhase(np.array([middle]), np.zeros(1), rate_hz, 0.0)
    revolutions = phases / (2 * np.pi)
    # Window means whose phase would run backwards are noise of a stretch hardly seen.
    rising = np.concatenate(
        [[True], np.diff(revolutions) > _LEAST_ADVANCE * rate_hz * np.diff(knots)]
    )
    knots, revolutions, coherences = knots[rising], revolutions[rising], coherences[rising]
    if knots.size > 1:
        rate_hz = float((revolutions[-1] - revolutions[0]) / (knots[-1] - knots[0]))
    return RevolutionPhase(knots, revolutions, rate_hz, float(np.mean(coherences)))

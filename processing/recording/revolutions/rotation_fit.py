"""The rotation of a line scanner found from its points: rate, direction and centre of rotation.

Every point lies on the ray of its phase, so phase and centre are found alternately: a rough centre
gives angles, angles give the rate at which they agree with the clock, and the rate gives a better
centre.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel

SLOWEST_HZ, FASTEST_HZ = 38.0, 310.0
"""Rates of rotation that are looked for: scanners on vehicles make 50 to 250 lines a second."""

_ROUNDS = 12
"""Of the robust fit. By trial; no measurement is recorded."""

_ROUNDS_TO_CHOOSE = 6
"""Enough to separate the right candidate from the others."""

_CLEAR_ANGLE_RAD = 0.6
"""Directions farther off the rotation are of other things: 34°. By trial; no measurement is
recorded."""

_MOST_SEARCHED = 1_500
"""Points by which rates are searched, for the time."""

_MOST_COMPARED = 4_000
"""Points by which candidates are compared, for the time."""

_STEP = 0.25
"""Between rates that are tried, over the length of a window: from one to the next the phase at
its ends shifts by 45° either way."""

_APART = 6
"""Steps between candidates: nearer ones are one peak, 4.8 steps wide at half its height."""

_CANDIDATES = 3
"""Rates that are refined: the best by a rough centre need not be the right one. By trial; no
measurement is recorded."""

_FINER = 10
"""Parts of a step in which a candidate is made better."""

_NEAREST_M = 0.3
"""Rays count as at least so long, m: the direction of a nearer point is that of its noise. By
trial; no measurement is recorded."""

_USUAL_MISSES = 2.0
"""Times the median miss up to which a point counts in full. By trial; no measurement is
recorded."""

_LEAST_SCALE_RAD = 1e-3
"""Limit of that where the median is less: 1 mm at 1 m, as coordinates are delivered."""

_CLEAR_SCALES = 3.0
"""Times that scale beyond which a point counts no more, where it is more than `_CLEAR_ANGLE_RAD`.
By trial; no measurement is recorded."""

_MOST_SHIFT_M = 1.5
"""Of the centre in one round, so that it doesn't leave the vehicle. By trial; no measurement is
recorded."""

_RIDGE_OF_PHASES, _RIDGE_OF_CENTRE = 1e-9, 1e-6
"""Per point, on phases and rate, and on centre and velocity: so little that it keeps only what the
points don't determine."""


@dataclass(frozen=True)
class RotationFit:
    """A steady rotation that explains points in the scan plane over short windows of time.

    Attributes
    ----------
    rate_hz : float
        Revolutions a second; negative when the angle falls.
    centre : (2,) float64
        Centre of rotation in the plane, m, at time 0 of its window.
    velocity : (2,) float64
        Its motion, m/s; 0 unless it was asked for.
    phases : (w,) float64
        Angle at time 0 of each window, rad.
    coherence : float
        0..1: length of the mean of exp(i · (angle − clock)).
    """

    rate_hz: float
    centre: Floats
    velocity: Floats
    phases: Floats
    coherence: float


@dataclass(frozen=True)
class PlanePoints:
    """Points in the scan plane, in a few short windows of time.

    Attributes
    ----------
    position : (n, 2) float64
        m.
    time : (n,) float64
        s since the middle of the window.
    window : (n,) int64
        0 … w − 1.
    """

    position: Floats
    time: Floats
    window: NDArray[np.int64]

    @property
    def windows(self) -> int:
        """Number of windows."""
        return int(self.window.max()) + 1

    def thinned(self, every: int) -> PlanePoints:
        """Every so many of the points."""
        return PlanePoints(self.position[::every], self.time[::every], self.window[::every])


def fit_rotation(
    points: PlanePoints, starts: list[Floats], *, moves: bool, rates_hz: list[float] | None = None
) -> RotationFit:
    """The rotation that best explains points.

    Parameters
    ----------
    starts : list of (2,) float64
        Rough centres to start from.
    moves : bool
        Whether the centre moves within a window at an unknown velocity.
    rates_hz : list of float, optional
        Signed rates to try; searched for when not given.

    Returns
    -------
    RotationFit
        The most coherent one; whether that is good enough is for the caller to say.
    """
    # Some of the points show the right candidate; all of them are for it alone.
    some = points.thinned(max(1, points.time.size // _MOST_COMPARED))
    fits: list[RotationFit] = []
    for start in starts:
        angle = _angles(points.position - start)
        candidates = rates_hz or _candidate_rates(angle, points)
        fits.extend(
            _refine_fit(some, (rate, start), moves=moves, rounds=_ROUNDS_TO_CHOOSE)
            for rate in candidates
        )
    best = max(fits, key=lambda fit: fit.coherence)
    return _refine_fit(points, (best.rate_hz, best.centre), moves=moves, rounds=_ROUNDS)


def _angles(position: Floats) -> Floats:
    angle: Floats = np.arctan2(position[:, 1], position[:, 0])
    return angle


def _candidate_rates(angle: Floats, points: PlanePoints) -> list[float]:
    every = max(1, angle.size // _MOST_SEARCHED)
    angle, time, window = angle[::every], points.time[::every], points.window[::every]
    span = float(time.max() - time.min())
    step = _STEP / span
    count = int((FASTEST_HZ - SLOWEST_HZ) / step) + 1
    rates = np.concatenate(
        [
            first + step * np.arange(count)
            for first in (-SLOWEST_HZ - step * (count - 1), SLOWEST_HZ)
        ]
    )
    strength = np.concatenate(
        [_strengths(half[0], step, count, (angle, time, window)) for half in np.split(rates, 2)]
    )
    found: list[float] = []
    for at in np.argsort(strength)[::-1]:
        if all(abs(rates[at] - rate) > _APART * step for rate in found):
            found.append(float(rates[at]))
        if len(found) == _CANDIDATES:
            break
    refined = []
    for rate in found:
        near = _strengths(rate - step, step / _FINER, 2 * _FINER + 1, (angle, time, window))
        refined.append(rate - step + step / _FINER * int(np.argmax(near)))
    return refined


def _strengths(
    first_hz: float, step_hz: float, count: int, sample: tuple[Floats, Floats, NDArray[np.int64]]
) -> Floats:
    """How well evenly spaced rates fit: mean length of the windows' summed phasors."""
    angle, time, window = sample
    sums = np.zeros((int(window.max()) + 1, count), np.complex128)
    _sum_phasors_kernel(first_hz, step_hz, angle, time, window, sums)
    strength: Floats = np.abs(sums).sum(axis=0) / angle.size
    return strength


@kernel
def _sum_phasors_kernel(
    first_hz: float,
    step_hz: float,
    angle: Floats,
    time: Floats,
    window: NDArray[np.int64],
    sums: NDArray[np.complex128],
) -> None:
    # From one rate to the next a point's phasor turns by the same amount, so one product a rate
    # does instead of one exponential.
    for point in range(angle.size):
        phasor = np.exp(1j * (angle[point] - 2 * np.pi * first_hz * time[point]))
        rotation = np.exp(-2j * np.pi * step_hz * time[point])
        own = sums[window[point]]
        for rate in range(own.size):
            own[rate] += phasor
            phasor *= rotation


def warm_up() -> None:
    """Compile the kernels."""
    _strengths(50.0, 1.0, 2, (np.zeros(2), np.zeros(2), np.zeros(2, np.int64)))


def _refine_fit(
    points: PlanePoints, begin: tuple[float, Floats], *, moves: bool, rounds: int
) -> RotationFit:
    """Gauss-Newton on centre, velocity, rate and the windows' phases; far misses count less."""
    windows = points.windows
    rate_hz, start = begin
    centre, velocity, rate = start.astype(np.float64), np.zeros(2), 2 * np.pi * rate_hz
    phases = np.zeros(windows)
    member = (points.window[:, None] == np.arange(windows)).astype(np.float64)
    for done in range(rounds + 1):
        rays = points.position - centre - points.time[:, None] * velocity
        distance = np.maximum(np.hypot(rays[:, 0], rays[:, 1]), _NEAREST_M)
        waves = np.exp(1j * (_angles(rays) - rate * points.time))
        phases = np.angle(_sums_by_window(waves, points))
        clock = phases[points.window] + rate * points.time
        miss = np.angle(waves * np.exp(-1j * phases[points.window]))
        if done == rounds:
            break
        across = np.column_stack([-np.sin(clock), np.cos(clock)]) / distance[:, None]
        parts = [member, points.time[:, None], across]
        if moves:
            parts.append(across * points.time[:, None])
        design = np.hstack(parts)
        scale = max(float(np.median(np.abs(miss))) * _USUAL_MISSES, _LEAST_SCALE_RAD)
        weight = np.minimum(1.0, scale / np.maximum(np.abs(miss), 1e-12))
        weight[np.abs(miss) > max(_CLEAR_ANGLE_RAD, _CLEAR_SCALES * scale)] = 0.0
        # A trace of ridge keeps what the points don't determine where it is.
        ridge = np.full(design.shape[1], _RIDGE_OF_PHASES * points.time.size)
        ridge[windows + 1 :] = _RIDGE_OF_CENTRE * points.time.size
        weighted = design * weight[:, None]
        # Libraries of linear algebra let other cores wait for such small products, which are
        # reading points meanwhile.
        normal = np.einsum("ni,nj->ij", weighted, design) + np.diag(ridge)
        change = np.linalg.solve(normal, np.einsum("ni,n->i", weighted, miss))
        rate += change[windows]
        shift = change[windows + 1 : windows + 3]
        centre = centre + shift * min(1.0, _MOST_SHIFT_M / max(float(np.hypot(*shift)), 1e-9))
        if moves:
            velocity = velocity + change[windows + 3 :]
    coherence = float(np.mean(np.cos(miss)))
    return RotationFit(rate / (2 * np.pi), centre, velocity, phases, max(coherence, 0.0))


def _sums_by_window(waves: NDArray[np.complex128], points: PlanePoints) -> NDArray[np.complex128]:
    real, imaginary = (
        np.bincount(points.window, weights=part, minlength=points.windows)
        for part in (waves.real, waves.imag)
    )
    return real + 1j * imaginary

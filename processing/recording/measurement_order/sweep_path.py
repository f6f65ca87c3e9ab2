"""SweepPath: planes and centres of the beams along a stretch, and the turns of its points."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import Monitor, PartMonitor
from processing.recording.measurement_order.order_stretches import WINDOW_POINTS
from processing.recording.measurement_order.sweep_fit import SweepFit, fit_sweep
from processing.recording.measurement_order.sweep_kernels import unwrap_kernel

_SMOOTHED = 3
"""Knots to either side by which a centre is smoothed: together a vehicle's way of about a metre,
along which it is straight."""

_LEAST_STEEP = 0.5
"""Downward share of a direction that is below: 30°. Planes along the way have none."""

_SEEN_AT_ONCE = 200_000
"""Points whose angles are computed at a time: they need twenty numbers each."""

_LEAST_KNOTS = 3
"""From which a line follows with something left over."""


@dataclass(frozen=True)
class SweepPath:
    """Where beams came from along a stretch of points.

    Attributes
    ----------
    at : (k,) float64
        Knots: positions in the order of points, rising; k >= 2.
    centres, normals : (k, 3) float64
        m, about the origin of the points; unit vectors.
    sense : float
        As :class:`SweepFit` has it.
    """

    at: Floats
    centres: Floats
    normals: Floats
    sense: float

    def led_on(self, positions: Floats) -> Floats:
        """(n, 3) centres at positions, m; straight on beyond the first and last knot."""
        at, centres = self.at, self.centres
        low = min(float(positions.min()), at[0]) - 1.0
        high = max(float(positions.max()), at[-1]) + 1.0
        first = (centres[1] - centres[0]) / (at[1] - at[0])
        last = (centres[-1] - centres[-2]) / (at[-1] - at[-2])
        wide = np.concatenate(
            [
                centres[:1] + first * (low - at[0]),
                centres,
                centres[-1:] + last * (high - at[-1]),
            ]
        )
        return interpolated(positions, np.concatenate([[low], at, [high]]), wide)

    def seen(self, xyz: Floats, positions: Floats) -> tuple[Floats, Floats]:
        """How points are seen from the centres in the planes of their positions.

        Parameters
        ----------
        xyz : (n, 3) float64
            m.
        positions : (n,) float64
            In the order.

        Returns
        -------
        angles : (n,) float64
            rad, 0…2π in the sense of the turning, from the direction in which the plane crosses
            the way of the centre, below it.
        ranges : (n,) float64
            m.
        """
        centre = self.led_on(positions)
        normal = interpolated(positions, self.at, self.normals)
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
        down = _down_along(normal, interpolated(positions, self.at, self.forward))
        right = np.cross(down, normal)
        beams = xyz - centre
        x, y = np.einsum("ij,ij->i", beams, right), np.einsum("ij,ij->i", beams, down)
        angles = (self.sense * np.arctan2(x, y)) % (2 * np.pi)
        return angles, np.hypot(x, y)

    @cached_property
    def forward(self) -> Floats:
        """(k, 3) horizontal directions of the way at the knots, of any length."""
        moved = np.gradient(self.centres, axis=0)
        moved[:, 2] = 0.0
        return np.asarray(moved)


def _down_along(normal: Floats, forward: Floats) -> Floats:
    """(n, 3) unit vectors in planes and in the upright planes of ways, downward.

    Straight down in its plane where the way lies in the plane, or there is none.
    """
    aside = np.column_stack([-forward[:, 1], forward[:, 0], np.zeros(len(forward))])
    down = np.cross(normal, aside)
    down *= -np.sign(down[:, 2:])
    length = np.linalg.norm(down, axis=1, keepdims=True)
    steep = -down[:, 2:] > _LEAST_STEEP * np.maximum(length, 1e-12)
    straight = normal * normal[:, 2:] - np.array([0.0, 0.0, 1.0])
    down = np.where(steep, down, straight)
    return np.asarray(down / np.maximum(np.linalg.norm(down, axis=1, keepdims=True), 1e-12))


def interpolated(positions: Floats, at: Floats, values: Floats) -> Floats:
    """(n, 3): values of knots at positions, those of the ends beyond them."""
    return np.column_stack([np.interp(positions, at, one) for one in values.T])


def follow_sweeps(
    xyz: Floats, quantum_m: float, first: SweepFit, monitor: Monitor
) -> tuple[SweepPath, float]:
    """The path of the beams' centre along a stretch, and how much of the stretch it explains.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, in order.
    first : SweepFit
        Of anywhere in the stretch: its sense and step hold for all.

    Returns
    -------
    SweepPath
    float
        Share of points that a beam from there reaches next after the point before.

    Notes
    -----
    1. Each window is fitted as if its beams came from one place.
    2. The path through these places says how the scanner moved inside of each window; with that
       taken off its points, it is fitted again.
    """
    path, _ = _follow(xyz, quantum_m, first, None, PartMonitor(monitor, 0.0, 0.5))
    return _follow(xyz, quantum_m, first, path, PartMonitor(monitor, 0.5, 1.0))


def _follow(
    xyz: Floats, quantum_m: float, first: SweepFit, before: SweepPath | None, monitor: Monitor
) -> tuple[SweepPath, float]:
    """The path from fits to its windows; the motion inside of them is taken from a path before."""
    starts = np.arange(0, max(xyz.shape[0] - WINDOW_POINTS, 0) + 1, WINDOW_POINTS)
    starts[-1] = max(xyz.shape[0] - WINDOW_POINTS, 0)
    fits: list[SweepFit] = []
    at = starts + 0.5 * min(WINDOW_POINTS, xyz.shape[0])
    last = fit_sweep(xyz[:WINDOW_POINTS], quantum_m, first.step_rad) or first
    if last.sense * float(last.normal @ first.normal) * first.sense < 0:
        last = first
    for number, start in enumerate(starts):
        monitor.check()
        window, expected = xyz[start : start + WINDOW_POINTS], last
        if before is not None:
            inside = before.led_on(np.arange(start, start + len(window), dtype=np.float64))
            expected = replace(last, centre=before.centres[number])
            window = window - (inside - before.centres[number])
        elif len(fits) > 1:
            moved = fits[-1].centre - fits[-2].centre
            expected = replace(last, centre=last.centre + moved)
        fit = fit_sweep(window, quantum_m, first.step_rad, expected)
        last = last if fit is None else fit
        fits.append(last)
        monitor.report(start / xyz.shape[0])
    centres = np.array([fit.centre for fit in fits])
    normals = np.array([fit.normal for fit in fits])
    coherence = np.array([fit.coherence for fit in fits])
    path = SweepPath(at, _smoothed(at, centres, np.clip(coherence, 0.01, 1)), normals, last.sense)
    return path, float(np.mean([fit.following for fit in fits]))


def turns_of(path: SweepPath, xyz: Floats, begins: float = 0.0) -> tuple[Floats, Floats]:
    """Turns of the beam at each point of a stretch, and ranges, m; a whole turn points down.

    Parameters
    ----------
    begins : float
        Of a turn from straight down, where the sweep has its gap: with it turns are counted.
    """
    turns, ranges = np.empty(xyz.shape[0]), np.empty(xyz.shape[0])
    last = np.array([np.nan])
    for start in range(0, xyz.shape[0], _SEEN_AT_ONCE):
        part = slice(start, min(start + _SEEN_AT_ONCE, xyz.shape[0]))
        positions = np.arange(part.start, part.stop, dtype=np.float64)
        angles, ranges[part] = path.seen(xyz[part], positions)
        unwrap_kernel((angles - 2 * np.pi * begins) % (2 * np.pi), last, turns[part])
    return turns + begins, ranges


def _smoothed(at: Floats, values: Floats, weights: Floats) -> Floats:
    """Values on lines through the knots about each."""
    if at.size < _LEAST_KNOTS:
        return values
    smooth = np.empty_like(values)
    for number in range(at.size):
        near = slice(max(0, number - _SMOOTHED), number + _SMOOTHED + 1)
        weight = np.sqrt(weights[near])[:, None]
        design = np.column_stack([np.ones(at[near].size), (at[near] - at[number]) / WINDOW_POINTS])
        solved = np.linalg.lstsq(design * weight, values[near] * weight, rcond=None)[0]
        smooth[number] = solved[0]
    return smooth

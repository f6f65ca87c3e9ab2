"""The adjustment: one sparse least-squares problem over all tracks, heads and control points.

Every track is a chain of knots that hangs together with the knots of other tracks at the same
places, so the normal equations have few numbers per knot and their factors hardly more: work and
memory grow as the length driven. Weights follow from the data: ties that don't fit count little,
ties as a whole by how well neighbouring seconds agree, expectations by how far the solution goes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor
from processing.methods.registration.expectations import (
    Expectations,
    Expected,
    LearntVariance,
    loosened_steps,
    previous_knots,
)
from processing.methods.registration.ties import CONTROL_KINDS, TieKind, Ties
from processing.methods.registration.unknowns import Unknowns

_ROUNDS = 8
_SAMPLES = 24
"""Random solutions that tell variances: each is known to a third, their means over many knots much
better."""

_TAIL = 3.0
"""Standard deviations: a tie that is farther off counts as its square less (Geman and McClure's
weights with this scale)."""

_WIDE_FIRST = 20.0
"""In the first round ties count as if so many times less sure, so that none is thrown out for the
drift that is still in it."""

_LEAST_SCALE, _MOST_SCALE = 0.3, 30.0
_STRETCH_S = 1.0
_FEWEST_IN_STRETCH = 3


@dataclass(frozen=True, eq=False)
class Adjusted:
    """A solution.

    Attributes
    ----------
    unknowns : Unknowns
    solved : (count,) float64
    samples : (count, s) float64
        Random deviations from it, as likely as its own errors: variances of whatever follows.
    residual_m : (m,) float64
        What is left of the gap of each tie.
    weight : (m,) float64
        Between 0, thrown out, and 1.
    sigma_m : (m,) float64
        Of each tie, as the data have corrected it.
    expectations : Expectations
    """

    unknowns: Unknowns
    solved: Floats
    samples: Floats
    residual_m: Floats
    weight: Floats
    sigma_m: Floats
    expectations: Expectations


def adjust(unknowns: Unknowns, ties: Ties, monitor: Monitor) -> Adjusted:
    """Solve for the corrections that make ties close.

    Raises
    ------
    Cancelled
    """
    design = unknowns.design(ties)
    expectations, loosened = Expectations.usual(), None
    sigma = ties.sigma_m.copy()
    weight = np.ones(len(ties))
    solved = np.zeros(unknowns.count)
    residual = ties.gap_m.copy()
    random = np.random.default_rng(1)
    expected = expectations.rows(unknowns, loosened)
    samples = np.zeros((unknowns.count, 0))
    for number in range(_ROUNDS):
        monitor.check()
        monitor.report(number / _ROUNDS)
        if number:
            weight = _weights(residual / sigma, _TAIL)
        else:
            weight = _weights(residual / sigma, _TAIL * _WIDE_FIRST)
        normal = _Normal(design, expected, np.sqrt(weight) / sigma)
        solved = normal.solve(-ties.gap_m)
        residual = ties.gap_m + design @ solved
        samples = normal.samples(random, _SAMPLES)
        sigma = _scaled(ties, residual, unknowns)
        loosened = loosened_steps(unknowns, expectations.rows(unknowns, None), solved)
        if number < _ROUNDS - 1:
            expectations = expectations.learnt(unknowns, solved, _variance(unknowns, samples))
            expected = expectations.rows(unknowns, loosened)
    return Adjusted(unknowns, solved, samples, residual, weight, sigma, expectations)


class _Normal:
    """Normal equations of ties and expectations, factorised."""

    def __init__(self, design: sparse.csr_matrix, expected: Expected, root: Floats) -> None:
        self._ties = sparse.diags(root) @ design
        self._expected = sparse.diags(1.0 / expected.sigma) @ expected.design
        self._root = root
        matrix = (self._ties.T @ self._ties + self._expected.T @ self._expected).tocsc()
        # Unknowns in metres and radians: brought to the same size, so that nothing is lost.
        self._size = 1.0 / np.sqrt(matrix.diagonal())
        scaled = sparse.diags(self._size) @ matrix @ sparse.diags(self._size)
        self._factors = splu(
            scaled.tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )

    def solve(self, values: Floats) -> Floats:
        """The unknowns that bring ties nearest to these values."""
        return self._solve(self._ties.T @ (self._root * values))

    def samples(self, random: np.random.Generator, count: int) -> Floats:
        """Solutions for what chance alone makes of ties and expectations: (n, count)."""
        ties = random.normal(size=(self._ties.shape[0], count))
        own = random.normal(size=(self._expected.shape[0], count))
        return self._solve(self._ties.T @ ties + self._expected.T @ own)

    def _solve(self, right: Floats) -> Floats:
        size = self._size if right.ndim == 1 else self._size[:, None]
        return np.asarray(size * self._factors.solve(size * right))


def _weights(off: Floats, tail: float) -> Floats:
    return np.asarray(1.0 / (1.0 + (off / tail) ** 2) ** 2)


def _variance(unknowns: Unknowns, samples: Floats) -> LearntVariance:
    now, before = previous_knots(unknowns)
    step = np.zeros(unknowns.count)
    step[now] = ((samples[now] - samples[before]) ** 2).mean(axis=1)
    return LearntVariance((samples**2).mean(axis=1), step)


def _scaled(ties: Ties, residual: Floats, unknowns: Unknowns) -> Floats:
    """Standard deviations of ties as their residuals tell them, by kind.

    Ties of the same second and the same two drives share errors: what a head's range is off by,
    what drifts between knots. Where their means scatter by more than single ties let expect, all of
    them count by so much less.
    """
    sigma = ties.sigma_m.copy()
    for kind in TieKind:
        mine = np.flatnonzero(ties.kind == kind)
        if mine.size < _FEWEST_IN_STRETCH or kind in CONTROL_KINDS:
            continue
        off = residual[mine] / ties.sigma_m[mine]
        scale = 1.4826 * float(np.median(np.abs(off)))
        scale = min(max(scale, _LEAST_SCALE), _MOST_SCALE)
        shared = _shared(ties, mine, off / scale, len(unknowns.survey.drives))
        sigma[mine] = ties.sigma_m[mine] * scale * shared
    return sigma


def _shared(ties: Ties, mine: Integers, off: Floats, drives: int) -> float:
    """How much more the means of stretches scatter than independent ties let expect; at least 1."""
    kept = np.abs(off) < _TAIL
    mine, off = mine[kept], off[kept]
    second = np.floor((ties.time[mine, 0] - ties.time[mine, 0].min(initial=0.0)) / _STRETCH_S)
    pair = ties.drive[mine, 0] * drives + ties.drive[mine, 1]
    _, group = np.unique(np.column_stack([pair, second]), axis=0, return_inverse=True)
    group = group.reshape(-1)
    count = np.bincount(group)
    mean = np.bincount(group, off) / np.maximum(count, 1)
    many = count >= _FEWEST_IN_STRETCH
    if not many.any():
        return 1.0
    ratio = float(np.median(mean[many] ** 2 * count[many]) / 0.455)
    return float(np.sqrt(max(1.0, ratio)))

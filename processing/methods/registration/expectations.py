"""Expectations: how far trajectories and mountings are usually off, and how fast that changes.

The error of a trajectory wanders about zero and forgets where it was (an Ornstein-Uhlenbeck
process): how far it wanders and how fast is told by the data, in the registration itself.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from processing.core.arrays import Floats, Integers
from processing.methods.registration.tracks import UNKNOWNS
from processing.methods.registration.unknowns import Unknowns

GROUPS = ((0, 1), (2,), (3, 4), (5,))
"""Of a knot's unknowns that are alike: in plan, in height, roll and pitch, heading."""

_LEAST_PER_S = np.array([0.3e-3, 0.3e-3, 2e-6, 2e-6])
_LEAST = np.array([2e-3, 2e-3, 2e-5, 2e-5])
_LONGEST_S = 1000.0
_JUMP = 3.0
"""Standard deviations: a step between two knots that is larger counts the less, as where GNSS came
back."""


@dataclass(frozen=True, eq=False)
class Expectations:
    """Standard deviations, by :data:`GROUPS`.

    Attributes
    ----------
    off : (4,) float64
        Of the error itself: m, m, rad, rad.
    per_s : (4,) float64
        Of its change within a second.
    mounting : (6,) float64
        Of a head's angles, rad, and of its lever arm, m.
    """

    off: Floats
    per_s: Floats
    mounting: Floats

    @staticmethod
    def usual() -> Expectations:
        """What navigation systems of mobile mapping are usually off by, to begin with."""
        return Expectations(
            np.array([0.03, 0.03, np.radians(0.01), np.radians(0.02)]),
            np.array([0.003, 0.003, np.radians(0.001), np.radians(0.001)]),
            np.array([np.radians(0.05)] * 3 + [0.01] * 3),
        )

    def rows(self, unknowns: Unknowns, loosened: Floats | None) -> Expected:
        """One row for every unknown: the first knots, the steps between knots, the heads.

        Parameters
        ----------
        loosened : (count,) float64 or None
            By how much the variance of each row is multiplied.
        """
        off, per_s = self._of_unknowns(self.off), self._of_unknowns(self.per_s)
        diagonal, before = np.ones(unknowns.count), np.zeros(unknowns.count)
        sigma = np.empty(unknowns.count)
        for number, track in enumerate(unknowns.survey.tracks):
            steps = np.diff(track.knots)[:, None]
            variance = np.minimum(per_s**2 * steps, 1.9 * off**2)
            kept = np.sqrt(np.maximum(1.0 - variance / off**2, 0.0))
            mine = unknowns.knots(number)
            sigma[mine] = np.concatenate([off[None], np.sqrt(off**2 * (1 - kept**2))]).reshape(-1)
            before[mine] = np.concatenate([np.zeros((1, UNKNOWNS)), -kept]).reshape(-1)
        for drive in range(len(unknowns.survey.drives)):
            sigma[unknowns.head(drive)] = self.mounting
        numbers = np.arange(unknowns.count)
        behind = np.flatnonzero(before)
        design = sparse.csr_matrix(
            (
                np.concatenate([diagonal, before[behind]]),
                (
                    np.concatenate([numbers, behind]),
                    np.concatenate([numbers, behind - UNKNOWNS]),
                ),
            ),
            shape=(unknowns.count, unknowns.count),
        )
        if loosened is not None:
            sigma = sigma * np.sqrt(loosened)
        return Expected(design, sigma)

    def learnt(self, unknowns: Unknowns, solved: Floats, variance: LearntVariance) -> Expectations:
        """What a solution tells of them: the mean squares of errors and of their steps.

        Parameters
        ----------
        variance : LearntVariance
            Of the solved unknowns and of their steps.
        """
        off, per_s = np.empty(len(GROUPS)), np.empty(len(GROUPS))
        knots = np.concatenate(
            [_knots(solved, unknowns, n) for n in range(len(unknowns.survey.tracks))]
        )
        spread = np.concatenate(
            [_knots(variance.unknown, unknowns, n) for n in range(len(unknowns.survey.tracks))]
        )
        steps, seconds, step_spread = _steps(unknowns, solved, variance.step)
        for group, members in enumerate(GROUPS):
            here = list(members)
            off[group] = np.sqrt(np.mean(knots[:, here] ** 2 + spread[:, here]))
            squares = steps[:, here] ** 2 + step_spread[:, here]
            per_s[group] = np.sqrt(np.mean(squares / seconds[:, None]))
        off = np.maximum(off, _LEAST)
        slowest = off * np.sqrt(2.0 / _LONGEST_S)
        return replace(self, off=off, per_s=np.maximum(np.maximum(per_s, _LEAST_PER_S), slowest))

    @staticmethod
    def _of_unknowns(groups: Floats) -> Floats:
        values = np.empty(UNKNOWNS)
        for group, members in enumerate(GROUPS):
            values[list(members)] = groups[group]
        return values


@dataclass(frozen=True, eq=False)
class LearntVariance:
    """Variances of a solution: of each unknown, and of its step from the knot before."""

    unknown: Floats
    step: Floats


@dataclass(frozen=True, eq=False)
class Expected:
    """Rows that say what the unknowns are expected to be: ``design`` · x = 0 ± ``sigma``."""

    design: sparse.csr_matrix
    sigma: Floats


def loosened_steps(unknowns: Unknowns, expected: Expected, solved: Floats) -> Floats:
    """By how much the variance of each row grows where a step is a jump: (count,), 1 elsewhere.

    All position unknowns of a knot jump together; so do its angles.
    """
    steps = (expected.design @ solved) / expected.sigma
    loosened = np.ones(unknowns.count)
    for number in range(len(unknowns.survey.tracks)):
        mine = unknowns.knots(number)
        table = steps[mine].reshape(-1, 2, UNKNOWNS // 2)
        far = np.sqrt((table**2).mean(axis=2))
        grown = np.maximum(1.0, (far / _JUMP) ** 2)
        grown[0] = 1.0
        loosened[mine] = np.repeat(grown, UNKNOWNS // 2, axis=1).reshape(-1)
    return loosened


def previous_knots(unknowns: Unknowns) -> tuple[Integers, Integers]:
    """Unknowns of knots that have one before, and the same unknown of that one."""
    numbers = []
    for number in range(len(unknowns.survey.tracks)):
        mine = unknowns.knots(number)
        numbers.append(np.arange(mine.start + UNKNOWNS, mine.stop))
    now = np.concatenate(numbers)
    return now, now - UNKNOWNS


def _knots(values: Floats, unknowns: Unknowns, track: int) -> Floats:
    return values[unknowns.knots(track)].reshape(-1, UNKNOWNS)


def _steps(unknowns: Unknowns, solved: Floats, variance: Floats) -> tuple[Floats, Floats, Floats]:
    tables = [
        (_knots(solved, unknowns, n), np.diff(track.knots), _knots(variance, unknowns, n)[1:])
        for n, track in enumerate(unknowns.survey.tracks)
    ]
    return (
        np.concatenate([np.diff(table, axis=0) for table, _, _ in tables]),
        np.concatenate([seconds for _, seconds, _ in tables]),
        np.concatenate([spread for _, _, spread in tables]),
    )

"""Unknowns: which numbers a registration solves for, and how ties and expectations depend on them.

First come the knots of every track, six numbers each, then six of every head.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

import numpy as np
from scipy import sparse

from processing.core.arrays import Floats, Integers
from processing.methods.registration.drift_correction import DriftCorrection
from processing.methods.registration.ties import Ties
from processing.methods.registration.tracks import UNKNOWNS
from processing.methods.registration.visits import Survey


@dataclass(frozen=True)
class Unknowns:
    """The layout of the unknowns of a survey.

    Attributes
    ----------
    survey : Survey
    """

    survey: Survey

    @cached_property
    def first_of_track(self) -> list[int]:
        """Number of the first unknown of every track."""
        sizes = [track.knots.size * UNKNOWNS for track in self.survey.tracks]
        return list(accumulate(sizes, initial=0))[:-1]

    @cached_property
    def first_of_head(self) -> int:
        """Number of the first unknown of the first drive's head."""
        return sum(track.knots.size * UNKNOWNS for track in self.survey.tracks)

    @cached_property
    def count(self) -> int:
        """How many there are."""
        return self.first_of_head + UNKNOWNS * len(self.survey.drives)

    def head(self, drive: int) -> slice:
        """The unknowns of a drive's head."""
        first = self.first_of_head + UNKNOWNS * drive
        return slice(first, first + UNKNOWNS)

    def knots(self, track: int) -> slice:
        """The unknowns of a track's knots, knot by knot."""
        first = self.first_of_track[track]
        return slice(first, first + self.survey.tracks[track].knots.size * UNKNOWNS)

    def design(self, ties: Ties) -> sparse.csr_matrix:
        """How the gap of each tie changes with the unknowns: (m, count)."""
        rows: list[Integers] = []
        columns: list[Integers] = []
        values: list[Floats] = []
        for side, sign in ((0, 1.0), (1, -1.0)):
            for drive in range(len(self.survey.drives)):
                mine = np.flatnonzero(ties.drive[:, side] == drive)
                if mine.size:
                    column, value = self._of_side(ties, side, drive, mine)
                    rows.append(np.repeat(mine, column.shape[1]))
                    columns.append(column.reshape(-1))
                    values.append(sign * value.reshape(-1))
        if not rows:
            return sparse.csr_matrix((len(ties), self.count))
        where = (np.concatenate(rows), np.concatenate(columns))
        shape = (len(ties), self.count)
        return sparse.coo_matrix((np.concatenate(values), where), shape=shape).tocsr()

    def corrections(self, solved: Floats) -> tuple[DriftCorrection, ...]:
        """The correction of every drive."""
        survey = self.survey
        return tuple(
            DriftCorrection(
                survey.tracks[survey.track_of(drive)],
                solved[self.knots(survey.track_of(drive))].reshape(-1, UNKNOWNS),
                solved[self.head(drive)],
            )
            for drive in range(len(survey.drives))
        )

    def _of_side(
        self, ties: Ties, side: int, drive: int, mine: Integers
    ) -> tuple[Integers, Floats]:
        number = self.survey.track_of(drive)
        track = self.survey.tracks[number]
        at, axes = track.places(ties.time[mine, side])
        before, share = track.spans(ties.time[mine, side])
        direction = ties.direction[mine]
        away = np.einsum("nij,ni->nj", axes, ties.xyz[mine, side] + self.survey.origin - at)
        inside = np.einsum("nij,ni->nj", axes, direction)
        # n · R (ω × v) = ω · (v × Rᵀn).
        turns = np.cross(away, inside)
        knot = np.column_stack([direction, turns])
        value = np.column_stack([knot * (1 - share)[:, None], knot * share[:, None], turns, inside])
        first = self.first_of_track[number] + UNKNOWNS * before
        head = self.first_of_head + UNKNOWNS * drive
        column = np.column_stack(
            [
                first[:, None] + np.arange(2 * UNKNOWNS),
                np.broadcast_to(head + np.arange(UNKNOWNS), (mine.size, UNKNOWNS)),
            ]
        )
        return column, value

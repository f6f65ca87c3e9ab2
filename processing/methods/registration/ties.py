"""Ties: places that two visits saw, and how far apart they see them along a direction."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.methods.registration.patches import Patches


class TieKind(IntEnum):
    """What a tie rests on."""

    LEVEL = 0
    UPRIGHT = 1
    MARKING = 2
    POLE = 3
    CONTROL_HEIGHT = 4
    CONTROL_PLAN = 5


CONTROL_KINDS = (TieKind.CONTROL_HEIGHT, TieKind.CONTROL_PLAN)

_FLAT_M = 0.001
"""How far a hard surface is from a plane between the points that two visits happened to hit; added
to what the scatter of the points tells. The data correct it as a whole."""

_MOST_VISITS = 8
_ANGLE = {1.0: 3.0, 0.5: 5.0, 0.25: 8.0}
"""Degrees between the normals of one patch as two visits see it."""

_LEVEL = 0.7
"""Upward part of the normal of what counts as level: 45°."""

_BESIDE = 0.3
"""In sides of the cube: how far apart the middles of both patches may lie within their plane."""

_APART_M = 0.2
"""No two visits see one surface farther apart: more is another surface."""


@dataclass(frozen=True, eq=False)
class Ties:
    """Ties, (m,) each. What two visits see is apart by ``gap_m`` along ``direction``.

    Attributes
    ----------
    kind : (m,) int64
        :class:`TieKind`.
    place : (m,) int64
        Ties of one thing have the same number.
    drive : (m, 2) int64
        Of the first and the second visit; −1 for a control point.
    time : (m, 2) float64
    xyz : (m, 2, 3) float64
        m about the survey's origin.
    direction : (m, 3) float64
        A unit vector.
    gap_m : (m,) float64
        The first minus the second.
    sigma_m : (m,) float64
        Standard deviation that the measurement itself lets expect.
    """

    kind: Integers
    place: Integers
    drive: Integers
    time: Floats
    xyz: Floats
    direction: Floats
    gap_m: Floats
    sigma_m: Floats

    def __len__(self) -> int:
        return self.kind.size

    def chosen(self, which: Integers | Floats) -> Ties:
        """Some of them, by number or by flag."""
        return Ties(
            self.kind[which],
            self.place[which],
            self.drive[which],
            self.time[which],
            self.xyz[which],
            self.direction[which],
            self.gap_m[which],
            self.sigma_m[which],
        )

    @staticmethod
    def joined(parts: list[Ties]) -> Ties:
        """Several of them as one."""
        return Ties(
            np.concatenate([one.kind for one in parts]),
            np.concatenate([one.place for one in parts]),
            np.concatenate([one.drive for one in parts]),
            np.concatenate([one.time for one in parts]),
            np.concatenate([one.xyz for one in parts]),
            np.concatenate([one.direction for one in parts]),
            np.concatenate([one.gap_m for one in parts]),
            np.concatenate([one.sigma_m for one in parts]),
        )


NO_TIES = Ties(
    np.empty(0, np.int64),
    np.empty(0, np.int64),
    np.empty((0, 2), np.int64),
    np.empty((0, 2)),
    np.empty((0, 2, 3)),
    np.empty((0, 3)),
    np.empty(0),
    np.empty(0),
)


def plane_ties(seen: list[tuple[int, Patches]]) -> Ties:
    """What visits to one part have in common: normals lead towards who saw it.

    Parameters
    ----------
    seen : list of (drive, Patches)
        For each visit.

    Notes
    -----
    All pairs of the visits to a place, each with the weight w_i w_j / Σ w, are the same as one
    unknown plane for the place, eliminated.
    """
    parts = [
        _ties_of_size(seen, size)
        for size in np.unique(np.concatenate([one.size_m for _, one in seen])).tolist()
    ]
    return Ties.joined(parts) if parts else NO_TIES


def _ties_of_size(seen: list[tuple[int, Patches]], size: float) -> Ties:
    rows = [np.flatnonzero(one.size_m == size) for _, one in seen]
    key = np.concatenate([one.key[row] for (_, one), row in zip(seen, rows, strict=True)])
    visit = np.repeat(np.arange(len(seen)), [row.size for row in rows])
    row = np.concatenate(rows)
    order = np.lexsort((visit, key))
    key, visit, row = key[order], visit[order], row[order]
    weight = _weights(seen, visit, row)
    first = np.flatnonzero(np.diff(key, prepend=key[:1] - 1))
    count = np.diff(np.append(first, key.size))
    total = np.repeat(np.add.reduceat(weight, first), count) if key.size else weight
    parts = []
    for step in range(1, min(_MOST_VISITS, len(seen))):
        one = np.arange(max(0, key.size - step))
        one = one[key[one] == key[one + step]]
        if one.size:
            pair = _Pair(*(_sides(seen, visit[at], row[at]) for at in (one, one + step)))
            sigma = np.sqrt(total[one] / (weight[one] * weight[one + step]))
            parts.append(_pair_ties(pair, key[one], sigma, size))
    return Ties.joined(parts) if parts else NO_TIES


@dataclass(frozen=True, eq=False)
class _Side:
    drive: Integers
    xyz: Floats
    normal: Floats
    time: Floats


@dataclass(frozen=True, eq=False)
class _Pair:
    one: _Side
    other: _Side


def _weights(seen: list[tuple[int, Patches]], visit: Integers, row: Integers) -> Floats:
    scatter = np.empty(row.size)
    count = np.empty(row.size)
    for number, (_, patches) in enumerate(seen):
        mine = visit == number
        scatter[mine], count[mine] = patches.scatter_m[row[mine]], patches.count[row[mine]]
    return np.asarray(1.0 / (scatter**2 / count + _FLAT_M**2))


def _sides(seen: list[tuple[int, Patches]], visit: Integers, row: Integers) -> _Side:
    side = _Side(
        np.empty(row.size, np.int64),
        np.empty((row.size, 3)),
        np.empty((row.size, 3)),
        np.empty(row.size),
    )
    for number, (drive, patches) in enumerate(seen):
        mine = visit == number
        side.drive[mine] = drive
        side.xyz[mine], side.normal[mine] = patches.xyz[row[mine]], patches.normal[row[mine]]
        side.time[mine] = patches.time[row[mine]]
    return side


def _pair_ties(pair: _Pair, key: Integers, sigma: Floats, size: float) -> Ties:
    one, other = pair.one, pair.other
    cosine = (one.normal * other.normal).sum(axis=1)
    normal = one.normal + other.normal
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-9)[:, None]
    apart = one.xyz - other.xyz
    across = (apart * normal).sum(axis=1)
    beside = np.linalg.norm(apart - across[:, None] * normal, axis=1)
    middle = (one.xyz + other.xyz) / 2
    gap = _height(one.xyz, one.normal, middle, normal) - _height(
        other.xyz, other.normal, middle, normal
    )
    limit = np.cos(np.radians(_ANGLE[size]))
    kept = np.flatnonzero((cosine > limit) & (beside < _BESIDE * size) & (np.abs(gap) < _APART_M))
    kind = np.where(np.abs(normal[:, 2]) > _LEVEL, int(TieKind.LEVEL), int(TieKind.UPRIGHT))
    return Ties(
        kind.astype(np.int64),
        key,
        np.column_stack([one.drive, other.drive]),
        np.column_stack([one.time, other.time]),
        np.stack([one.xyz, other.xyz], axis=1),
        normal,
        gap,
        sigma,
    ).chosen(kept)


def _height(xyz: Floats, own: Floats, middle: Floats, normal: Floats) -> Floats:
    """How far along ``normal`` from the middle a plane lies."""
    slant = (own * normal).sum(axis=1)
    slant[np.abs(slant) < 1e-3] = 1e-3
    return np.asarray(((xyz - middle) * own).sum(axis=1) / slant)

"""The straight pieces of true lines: which of them points lie at."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.laboratory.simulate.scene.things import TrueFeature

_AROUND, _REACH_M = 4, 0.75
"""Pieces that are asked about a point: at corners and where lines run close together."""

OffOf = Callable[[Floats, Integers], Floats]
"""How far points (k, 3) lie off pieces (k,), m; inf for those beside them."""


class LinePieces:
    """The pieces of some features' lines, a metre long at most.

    Attributes
    ----------
    features : list of TrueFeature
    starts, ways : (p, 3) float64
        Of all pieces, m, the street's frame.
    """

    def __init__(self, features: Sequence[TrueFeature]) -> None:
        from scipy.spatial import cKDTree

        self.features = list(features)
        self._first = np.cumsum([0, *(len(one.xyz) - 1 for one in self.features)])
        self.starts = np.concatenate([np.empty((0, 3)), *(one.xyz[:-1] for one in self.features)])
        ends = np.concatenate([np.empty((0, 3)), *(one.xyz[1:] for one in self.features)])
        self.ways = ends - self.starts
        # scipy's tree has no stub that mypy takes
        self._tree: Any = cKDTree((self.starts + self.ways / 2)[:, :2]) if len(ends) else None

    def __len__(self) -> int:
        return len(self.starts)

    def per_piece(self, values: Sequence[float]) -> Floats:
        """(p,) float64 a value of each feature, for each of its pieces."""
        return np.repeat(np.asarray(values, np.float64), np.diff(self._first))

    def rows_of(self, feature: TrueFeature) -> slice:
        """The pieces of one of the features; none of another one."""
        for number, one in enumerate(self.features):
            if one is feature:
                return slice(int(self._first[number]), int(self._first[number + 1]))
        return slice(0, 0)

    def beside(self, points: Floats, piece: Integers) -> tuple[Floats, Floats, Floats]:
        """How far along pieces, to their left, and above them points lie, m: (k,) each."""
        off, way = points - self.starts[piece], self.ways[piece]
        long = np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-6)
        at = (off[:, :2] * way[:, :2]).sum(axis=1) / long
        above = off[:, 2] - way[:, 2] * np.clip(at / long, 0.0, 1.0)
        across = (way[:, 0] * off[:, 1] - way[:, 1] * off[:, 0]) / long
        return at / long, across, above

    def owners(self, points: Floats, off_of: OffOf, limit_m: float) -> Integers:
        """The piece that each of (n, 3) points lies nearest to; −1: none within the limit."""
        owner = np.full(len(points), -1, np.int64)
        if self._tree is None or not len(points):
            return owner
        away, pieces = self._tree.query(
            points[:, :2], k=_AROUND, distance_upper_bound=_REACH_M, workers=1
        )
        best = np.full(len(points), limit_m)
        for rank in range(_AROUND):
            near = np.flatnonzero(np.isfinite(away[:, rank]))
            piece = pieces[near, rank]
            off = off_of(points[near], piece)
            closer = off < best[near]
            best[near[closer]], owner[near[closer]] = off[closer], piece[closer]
        return owner

"""Which pieces of walls the points show: those near the face over each piece of its foot."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from processing.laboratory.simulate.scanning.returns import Returns
from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.laboratory.simulate.scene.things import TrueFeature

_LABELS = (1, 6)
"""Other, building: what walls are labelled."""

_NEAR_M = 0.06
"""Before or behind the face: frames of windows stand out 3 cm."""

_LOW_M, _HIGH_M = 0.1, 3.0
"""Above the foot: where ground is told from the wall, and what a face is looked for by."""

_AROUND, _REACH_M = 4, 0.75
"""Pieces that are asked about a point: at corners and where walls stand close together."""


class WallEvidence:
    """Counts points near the faces of true walls.

    Parameters
    ----------
    features : iterable of TrueFeature
        Those of walls count.
    """

    def __init__(self, features: Iterable[TrueFeature]) -> None:
        self._walls = [one for one in features if one.file == "walls"]
        self._first = np.cumsum([0, *(len(one.xyz) - 1 for one in self._walls)])
        self._starts = np.concatenate([np.empty((0, 3)), *(one.xyz[:-1] for one in self._walls)])
        ends = np.concatenate([np.empty((0, 3)), *(one.xyz[1:] for one in self._walls)])
        self._ways = ends - self._starts
        self._heights = np.repeat([_number(one, "height_m") for one in self._walls], self._sizes())
        self._leans = np.repeat([_number(one, "lean") for one in self._walls], self._sizes())
        self._counts: Integers = np.zeros(len(self._starts), np.int64)
        self._tree = self._made_tree()

    def _sizes(self) -> list[int]:
        return [len(one.xyz) - 1 for one in self._walls]

    def _made_tree(self) -> Any:  # scipy's tree has no stub that mypy takes
        from scipy.spatial import cKDTree

        return cKDTree((self._starts + self._ways / 2)[:, :2]) if len(self._starts) else None

    def count(self, returns: Returns) -> None:
        """Count points of walls and buildings."""
        chosen = returns.xyz[np.isin(returns.label, _LABELS)]
        if self._tree is None or not len(chosen):
            return
        away, pieces = self._tree.query(
            chosen[:, :2], k=_AROUND, distance_upper_bound=_REACH_M, workers=1
        )
        best = np.full(len(chosen), _NEAR_M)
        owner = np.full(len(chosen), -1, np.int64)
        for rank in range(_AROUND):
            near = np.flatnonzero(np.isfinite(away[:, rank]))
            piece = pieces[near, rank]
            off = self._off(chosen[near], piece)
            closer = off < best[near]
            best[near[closer]], owner[near[closer]] = off[closer], piece[closer]
        self._counts += np.bincount(owner[owner >= 0], minlength=len(self._counts))

    def _off(self, points: Floats, piece: Integers) -> Floats:
        """How far points lie off the faces over pieces, m; inf for those too low or too high."""
        beside, way = points - self._starts[piece], self._ways[piece]
        long = np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-6)
        at = (beside[:, :2] * way[:, :2]).sum(axis=1) / long
        above = beside[:, 2] - way[:, 2] * np.clip(at / long, 0.0, 1.0)
        across = (way[:, 0] * beside[:, 1] - way[:, 1] * beside[:, 0]) / long
        off = np.abs(np.abs(across) - self._leans[piece] * np.maximum(above, 0.0))
        top = np.minimum(self._heights[piece], _HIGH_M)
        inside = (above > _LOW_M) & (above <= top) & (at >= 0.0) & (at <= long)
        return np.where(inside, off, np.inf)

    def of(self, feature: TrueFeature) -> Integers:
        """(n − 1,) int64 the points of each piece of one of the walls."""
        for number, one in enumerate(self._walls):
            if one is feature:
                return np.asarray(self._counts[self._first[number] : self._first[number + 1]])
        return np.zeros(len(feature.xyz) - 1, np.int64)


def _number(feature: TrueFeature, name: str) -> float:
    value = feature.facts[name]
    return float(value) if isinstance(value, int | float) else 0.0

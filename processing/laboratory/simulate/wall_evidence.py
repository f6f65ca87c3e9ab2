"""Which pieces of walls the points show: those near the face over each piece of its foot."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from processing.laboratory.simulate.line_pieces import LinePieces
from processing.laboratory.simulate.scanning.returns import Returns
from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.laboratory.simulate.scene.things import TrueFeature

_LABELS = (1, 6)
"""Other, building: what walls are labelled."""

_NEAR_M = 0.06
"""Before or behind the face: frames of windows stand out 3 cm."""

_LOW_M, _HIGH_M = 0.1, 3.0
"""Above the foot: where ground is told from the wall, and what a face is looked for by."""


class WallEvidence:
    """Counts points near the faces of true walls.

    Parameters
    ----------
    features : iterable of TrueFeature
        Those of walls count.
    """

    def __init__(self, features: Iterable[TrueFeature]) -> None:
        self._pieces = LinePieces([one for one in features if one.file == "walls"])
        walls = self._pieces.features
        self._heights = self._pieces.per_piece([_number(one, "height_m") for one in walls])
        self._leans = self._pieces.per_piece([_number(one, "lean") for one in walls])
        self._counts: Integers = np.zeros(len(self._pieces), np.int64)

    def count(self, returns: Returns) -> None:
        """Count points of walls and buildings."""
        chosen = returns.xyz[np.isin(returns.label, _LABELS)]
        owner = self._pieces.owners(chosen, self._off, _NEAR_M)
        self._counts += np.bincount(owner[owner >= 0], minlength=len(self._counts))

    def _off(self, points: Floats, piece: Integers) -> Floats:
        """How far points lie off the faces over pieces, m; inf for those too low or too high."""
        share, across, above = self._pieces.beside(points, piece)
        off = np.abs(np.abs(across) - self._leans[piece] * np.maximum(above, 0.0))
        top = np.minimum(self._heights[piece], _HIGH_M)
        inside = (above > _LOW_M) & (above <= top) & (share >= 0.0) & (share <= 1.0)
        return np.where(inside, off, np.inf)

    def of(self, feature: TrueFeature) -> Integers:
        """(n − 1,) int64 the points of each piece of one of the walls."""
        rows = self._pieces.rows_of(feature)
        found: Integers = np.zeros(len(feature.xyz) - 1, np.int64)
        found[: rows.stop - rows.start] = self._counts[rows]
        return found


def _number(feature: TrueFeature, name: str) -> float:
    value = feature.facts[name]
    return float(value) if isinstance(value, int | float) else 0.0

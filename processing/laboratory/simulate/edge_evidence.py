"""Which pieces of the carriageway's edges the points show: those of the ground on both sides."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from processing.laboratory.simulate.line_pieces import LinePieces
from processing.laboratory.simulate.scanning.returns import Returns
from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.laboratory.simulate.scene.things import TrueFeature

_LABELS = (2, 3, 11)
"""Ground, grass, road: what lies on both sides of an edge without a step."""

_BAND_M, _ABOVE_M = 0.3, 0.15
"""How far to each side, and how far above or below the line: blades of a meadow are 12 cm long."""

_CELL_M = 0.5
_ROWS = 1 << 32  # of cells: more than any street has


class EdgeEvidence:
    """Counts points of the ground on both sides of true edges of the carriageway.

    Parameters
    ----------
    features : iterable of TrueFeature
        Those of edges count.
    """

    def __init__(self, features: Iterable[TrueFeature]) -> None:
        self._pieces = LinePieces([one for one in features if one.file == "edges"])
        self._counts: Integers = np.zeros((len(self._pieces), 2), np.int64)
        middles = self._pieces.starts + self._pieces.ways / 2
        around = np.arange(-2, 3) * _CELL_M  # a metre: half a piece and the band beside it
        offs = np.stack(np.meshgrid(around, around), axis=-1).reshape(-1, 2)
        self._cells = np.unique(_cells_of((middles[:, None, :2] + offs).reshape(-1, 2)))

    def count(self, returns: Returns) -> None:
        """Count points of the ground."""
        chosen = returns.xyz[np.isin(returns.label, _LABELS)]
        if not len(self._cells) or not len(chosen):
            return
        cells = _cells_of(chosen[:, :2])
        at = np.minimum(np.searchsorted(self._cells, cells), len(self._cells) - 1)
        chosen = chosen[self._cells[at] == cells]
        owner = self._pieces.owners(chosen, self._off, _BAND_M)
        chosen, owner = chosen[owner >= 0], owner[owner >= 0]
        is_left = self._pieces.beside(chosen, owner)[1] > 0
        for side in range(2):
            self._counts[:, side] += np.bincount(
                owner[is_left == side], minlength=len(self._counts)
            )

    def _off(self, points: Floats, piece: Integers) -> Floats:
        share, across, above = self._pieces.beside(points, piece)
        inside = (np.abs(above) < _ABOVE_M) & (share >= 0.0) & (share <= 1.0)
        return np.where(inside, np.abs(across), np.inf)

    def of(self, feature: TrueFeature) -> Integers:
        """(n − 1,) int64 the points on the worse shown side of each piece of one of the edges."""
        rows = self._pieces.rows_of(feature)
        found: Integers = np.zeros(len(feature.xyz) - 1, np.int64)
        found[: rows.stop - rows.start] = self._counts[rows].min(axis=1)
        return found


def _cells_of(places: Floats) -> Integers:
    east, north = np.floor(places / _CELL_M).astype(np.int64).T
    cells: Integers = east * _ROWS + north
    return cells

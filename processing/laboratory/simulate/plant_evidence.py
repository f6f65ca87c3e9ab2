"""Which areas of plants the points show: points and cells of each that have any."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.scanning.returns import Returns
from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.laboratory.simulate.scene.things import TrueFeature

_LABELS = (2, 3, 4)
"""Ground, grass, low plants."""

_CELL_M = 0.25
_FARTHEST_M = 60_000.0
_ROW = 1 << 20


class PlantEvidence:
    """Counts points over true areas of plants.

    Parameters
    ----------
    features : iterable of TrueFeature
        Those of areas count; areas of one type don't overlap by more than a cell.
    """

    def __init__(self, features: Iterable[TrueFeature]) -> None:
        self._areas = [one for one in features if one.file == "plant_areas"]
        self._keys: dict[str, tuple[Integers, Integers]] = {}
        self._counts: dict[str, Integers] = {}
        for type_ in sorted({str(one.facts["type"]) for one in self._areas}):
            cells = [
                (number, _cells_in(one.xyz[:, :2]))
                for number, one in enumerate(self._areas)
                if one.facts["type"] == type_
            ]
            keys = np.concatenate([one for _, one in cells])
            owner = np.concatenate([np.full(len(one), number) for number, one in cells])
            keys, first = np.unique(keys, return_index=True)
            self._keys[type_] = keys, owner[first]
            self._counts[type_] = np.zeros(len(keys), np.int64)

    def count(self, returns: Returns) -> None:
        """Count points on the ground and on low plants."""
        chosen = returns.xyz[np.isin(returns.label, _LABELS)]
        asked = _key(np.floor(chosen[:, :2] / _CELL_M).astype(np.int64))
        for type_, (keys, _) in self._keys.items():
            if len(keys):
                at = np.minimum(np.searchsorted(keys, asked), len(keys) - 1)
                found = at[keys[at] == asked]
                self._counts[type_] += np.bincount(found, minlength=len(keys))

    def of(self, feature: TrueFeature) -> tuple[int, float]:
        """The points of one of the areas, and the share of its cells that have any."""
        for number, one in enumerate(self._areas):
            if one is feature:
                type_ = str(one.facts["type"])
                own = self._counts[type_][self._keys[type_][1] == number]
                return int(own.sum()), float(np.mean(own > 0)) if own.size else 0.0
        return 0, 0.0


def _cells_in(ring: Floats) -> Integers:
    """Keys of the cells whose middles lie within an outline."""
    import shapely

    low = np.floor(ring.min(axis=0) / _CELL_M).astype(np.int64)
    high = np.floor(ring.max(axis=0) / _CELL_M).astype(np.int64) + 1
    if np.abs(ring).max() > _FARTHEST_M or (high - low).prod() > _ROW * 16:
        return np.empty(0, np.int64)
    i, j = np.meshgrid(*(np.arange(a, b) for a, b in zip(low, high, strict=True)), indexing="ij")
    cells = np.column_stack([i.ravel(), j.ravel()])
    middles = (cells + 0.5) * _CELL_M
    inside: NDArray[np.bool_] = shapely.contains_xy(shapely.Polygon(ring).buffer(0), *middles.T)
    return _key(cells[inside])


def _key(cells: Integers) -> Integers:
    return np.asarray((cells[:, 0] + _ROW // 2) * _ROW + cells[:, 1] + _ROW // 2)

"""NearFeatures: the features near a place on the ground, for snapping in any view."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject

from processing.project.feature import Feature, Position
from widgets.shared.map_changes import MapChanges
from widgets.shared.map_source import MapSource

_EXTENSION_M = 5.0
"""How far lines go on beyond their ends, as snapping sees them."""

_NOWHERE = (np.inf, np.inf, -np.inf, -np.inf)


class NearFeatures(QObject):
    """Keeps the plan bounds of all features; read anew where they change.

    Parameters
    ----------
    source : MapSource
    map_changes : MapChanges
    """

    def __init__(
        self, source: MapSource, map_changes: MapChanges, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._slots: dict[str, int] = {}
        self._ids: list[str] = []
        self._bounds: NDArray[np.float64] = np.empty((0, 4))
        self._is_read = False
        map_changes.features_changed.connect(self._on_features_changed)
        map_changes.drives_changed.connect(self._forget)

    def within(self, near: Position, reach_m: float) -> list[Feature]:
        """Features whose bounds, with their extensions, come within reach of a place."""
        if not self._is_read:
            self._read_all()
        easting, northing, _ = near
        reach = reach_m + _EXTENSION_M
        bounds = self._bounds
        touches = (
            (bounds[:, 0] <= easting + reach)
            & (bounds[:, 2] >= easting - reach)
            & (bounds[:, 1] <= northing + reach)
            & (bounds[:, 3] >= northing - reach)
        )
        found = [self._source.feature(self._ids[slot]) for slot in np.flatnonzero(touches)]
        return [feature for feature in found if feature is not None]

    def _read_all(self) -> None:
        features = list(self._source.features())
        self._ids = [feature.id for feature in features]
        self._slots = {id_: slot for slot, id_ in enumerate(self._ids)}
        self._bounds = np.array([_bounds_of(one) for one in features]).reshape(-1, 4)
        self._is_read = True

    def _on_features_changed(self, ids: tuple[str, ...]) -> None:
        if not self._is_read:
            return
        new = [id_ for id_ in ids if id_ not in self._slots]
        if new:
            start = len(self._ids)
            self._ids.extend(new)
            self._slots.update({id_: start + place for place, id_ in enumerate(new)})
            self._bounds = np.concatenate([self._bounds, np.full((len(new), 4), _NOWHERE)])
        for id_ in ids:
            feature = self._source.feature(id_)
            self._bounds[self._slots[id_]] = _NOWHERE if feature is None else _bounds_of(feature)

    def _forget(self) -> None:
        self._is_read = False


def _bounds_of(feature: Feature) -> tuple[float, float, float, float]:
    eastings, northings, _ = zip(*(vertex.xyz for vertex in feature.vertices), strict=True)
    return min(eastings), min(northings), max(eastings), max(northings)

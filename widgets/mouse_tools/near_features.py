"""NearFeatures: the features near a place on the ground, for snapping in any view."""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QCoreApplication, QObject, QTimer

from processing.map.feature import Feature, Position
from widgets.shared.map_changes import MapChanges
from widgets.shared.map_source import MapSource

_EXTENSION_M = 5.0
"""How far lines go on beyond their ends, as snapping sees them."""

_IDLE_S = 0.004
_NOWHERE = (np.inf, np.inf, -np.inf, -np.inf)


class NearFeatures(QObject):
    """Keeps the plan bounds of all features; read in idle moments, anew where they change.

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
        self._waiting: Iterator[Feature] | None = None
        self._read: list[tuple[float, float, float, float]] = []
        self._idle = QTimer(self, interval=0)
        self._idle.timeout.connect(self._on_idle_timeout)
        map_changes.features_changed.connect(self._on_features_changed)
        map_changes.drives_changed.connect(self._begin)
        self._begin()

    def within(self, near: Position, reach_m: float) -> list[Feature]:
        """Features whose bounds, with their extensions, come within reach of a place."""
        self._read_until(np.inf)
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

    def _begin(self) -> None:
        """Read everything anew, another project being open."""
        self._slots.clear()
        self._ids.clear()
        self._read.clear()
        self._bounds = np.empty((0, 4))
        self._waiting = iter(tuple(self._source.features()))
        if QCoreApplication.instance() is not None:  # nothing is idle where nothing runs
            self._idle.start()

    def _read_until(self, moment: float) -> None:
        if self._waiting is None:
            return
        for feature in self._waiting:
            self._put(feature.id, _bounds_of(feature))
            if time.perf_counter() > moment:
                return
        self._waiting = None
        self._idle.stop()
        self._take_over()

    def _put(self, id_: str, bounds: tuple[float, float, float, float]) -> None:
        if id_ not in self._slots:
            self._slots[id_] = len(self._ids)
            self._ids.append(id_)
            self._read.append(bounds)

    def _take_over(self) -> None:
        if self._read:
            self._bounds = np.concatenate([self._bounds, np.array(self._read)])
            self._read.clear()

    def _on_idle_timeout(self) -> None:
        self._read_until(time.perf_counter() + _IDLE_S)

    def _on_features_changed(self, ids: tuple[str, ...]) -> None:
        if self._waiting is not None:
            self._begin()
            return
        for id_ in ids:
            self._put(id_, _NOWHERE)
        self._take_over()
        for id_ in ids:
            feature = self._source.feature(id_)
            self._bounds[self._slots[id_]] = _NOWHERE if feature is None else _bounds_of(feature)


def _bounds_of(feature: Feature) -> tuple[float, float, float, float]:
    eastings, northings, _ = zip(*(vertex.xyz for vertex in feature.vertices), strict=True)
    return min(eastings), min(northings), max(eastings), max(northings)

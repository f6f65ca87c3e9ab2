"""WaitingFeatures: whose vertices are searched next; what is in the window goes first."""

from __future__ import annotations

import math

import numpy as np

from processing.map.feature import Feature

_FAR_M = 20.0


class WaitingFeatures:
    """Features in the order of their distance from where the view is."""

    def __init__(self) -> None:
        self._positions: dict[str, tuple[float, float]] = {}
        self._order: list[str] = []
        self._ordered_for: tuple[float, float] | None = None

    def __bool__(self) -> bool:
        return bool(self._positions)

    def add(self, feature: Feature) -> None:
        """Let a feature wait."""
        self._positions[feature.id] = feature.vertices[0].xyz[:2]
        self._ordered_for = None

    def clear(self) -> None:
        """Let none wait."""
        self._positions.clear()
        self._order.clear()

    def next_to(self, near: tuple[float, float]) -> str:
        """Id of the feature that is nearest to a place; empty when none waits.

        The same one is given until it is done, unless the place moves by more than 20 m.
        """
        if not self._positions:
            return ""
        if self._ordered_for is None or math.dist(near, self._ordered_for) > _FAR_M:
            ids = list(self._positions)
            away = np.hypot(*(np.array([self._positions[id_] for id_ in ids]) - near).T)
            self._order = [ids[index] for index in np.argsort(-away, kind="stable")]
            self._ordered_for = near
        return self._order[-1]

    def done(self) -> bool:
        """Take the feature given last out; says whether there was one."""
        if not self._order:
            return False
        self._positions.pop(self._order.pop(), None)
        return True

"""StillPicture: ground and map, painted once and shown until something about them changes."""

from __future__ import annotations

from typing import Protocol

from PySide6.QtGui import QColor, QPainter, QPixmap

from processing.project.catalogue import Catalogue
from widgets.plane_view.feature_painter import FeaturePainter
from widgets.plane_view.projected_map import PlaneFeatures
from widgets.plane_view.viewport import PlaneViewport

BACKGROUND = QColor("#14161a")


class Ground(Protocol):
    """Who paints what lies below the map."""

    def paint_ground(self, painter: QPainter, viewport: PlaneViewport) -> None:
        """Paint it."""


class StillPicture:
    """A move of the mouse paints its own marks over this and nothing else anew."""

    def __init__(self) -> None:
        self._painter = FeaturePainter()
        self._picture = QPixmap()
        self._shows: tuple[object, ...] | None = None
        self._held: tuple[PlaneFeatures, Catalogue] | None = None

    def drop(self) -> None:
        """Paint all anew the next time."""
        self._shows = None

    def paint(
        self,
        painter: QPainter,
        ground: Ground,
        features: PlaneFeatures,
        viewport: PlaneViewport,
        *,
        catalogue: Catalogue,
        selected: frozenset[str],
    ) -> None:
        """Show ground and map, painted anew where they are others than before."""
        ratio = painter.device().devicePixelRatioF()
        # Features and catalogue are values: others are other objects.
        shows = id(features), id(catalogue), viewport, selected, ratio
        if shows != self._shows:
            self._paint_anew(ratio, viewport)
            with QPainter(self._picture) as still:
                ground.paint_ground(still, viewport)
                self._painter.paint(still, features, viewport, catalogue, selected)
            # Held, so that their ids belong to no others.
            self._held = features, catalogue
            self._shows = shows
        painter.drawPixmap(0, 0, self._picture)

    def _paint_anew(self, ratio: float, viewport: PlaneViewport) -> None:
        size = round(viewport.width * ratio), round(viewport.height * ratio)
        if (self._picture.width(), self._picture.height()) != size:
            self._picture = QPixmap(*size)
        self._picture.setDevicePixelRatio(ratio)
        self._picture.fill(BACKGROUND)

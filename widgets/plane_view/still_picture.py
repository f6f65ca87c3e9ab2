"""StillPicture: ground and map, painted once and shown until something about them changes."""

from __future__ import annotations

from typing import Protocol

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPainter, QPixmap

from processing.map.catalogue import Catalogue
from widgets.plane_view.feature_painter import FeaturePainter
from widgets.plane_view.projected_map import PlaneFeatures
from widgets.plane_view.viewport import PlaneViewport

BACKGROUND = QColor("#14161a")


class BackgroundPainter(Protocol):
    """Who paints what lies below the map."""

    def paint_ground(self, painter: QPainter, viewport: PlaneViewport) -> None:
        """Paint it."""


class StillPicture:
    """A move of the mouse paints its own marks over this and nothing else anew.

    Ground and map are two layers, since points arrive while the map stays, and the map is edited
    while the points stay.
    """

    def __init__(self) -> None:
        self._painter = FeaturePainter()
        self._ground, self._map = QPixmap(), QPixmap()
        self._ground_shows: tuple[object, ...] | None = None
        self._map_shows: tuple[object, ...] | None = None
        self._held: tuple[PlaneFeatures, Catalogue] | None = None

    def drop_ground(self) -> None:
        """Paint the ground anew the next time; the map only if features or viewport are others."""
        self._ground_shows = None

    def paint(
        self,
        painter: QPainter,
        ground: BackgroundPainter,
        features: PlaneFeatures,
        viewport: PlaneViewport,
        *,
        catalogue: Catalogue,
        selected: frozenset[str],
    ) -> None:
        """Show ground and map, painted anew where they are others than before."""
        ratio = painter.device().devicePixelRatioF()
        if self._ground_shows != (viewport, ratio):
            self._ground = _make_empty_picture(self._ground, viewport, ratio, BACKGROUND)
            with QPainter(self._ground) as still:
                ground.paint_ground(still, viewport)
            self._ground_shows = viewport, ratio
        # Features and catalogue are values: others are other objects.
        shows = id(features), id(catalogue), viewport, selected, ratio
        if self._map_shows != shows:
            self._map = _make_empty_picture(self._map, viewport, ratio, Qt.GlobalColor.transparent)
            with QPainter(self._map) as still:
                self._painter.paint(still, features, viewport, catalogue, selected)
            # Held, so that their ids belong to no others.
            self._held = features, catalogue
            self._map_shows = shows
        painter.drawPixmap(0, 0, self._ground)
        painter.drawPixmap(0, 0, self._map)


def _make_empty_picture(
    picture: QPixmap, viewport: PlaneViewport, ratio: float, colour: QColor | Qt.GlobalColor
) -> QPixmap:
    width, height = round(viewport.width * ratio), round(viewport.height * ratio)
    if (picture.width(), picture.height()) != (width, height):
        picture = QPixmap(width, height)
    picture.setDevicePixelRatio(ratio)
    picture.fill(colour)
    return picture

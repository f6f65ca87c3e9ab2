"""A plane view over a plan on which a grid of points was measured, one a metre."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtCore import QPoint, QRectF, Qt
from PySide6.QtGui import QPainter, QPolygonF
from pytestqt.qtbot import QtBot
from typing_extensions import override

from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, PointReference, Position, Vertex, new_feature_id
from tests.widgets.builders import OpenMap
from tests.widgets.view_user import ViewUser
from widgets.mouse_tools.mouse_tool import Ray
from widgets.plane_view.view import PlaneView
from widgets.plane_view.viewport import PlaneViewport
from widgets.shared.cursor import PickedPosition

RIGHT = Qt.MouseButton.RightButton


@dataclass
class GridProjection:
    """Looks straight down; what is north of the limit isn't shown."""

    limit: float = 1e9
    asked: list[int] = field(default_factory=list)

    def to_plane(self, xyz: NDArray[np.float64]) -> NDArray[np.float64]:
        self.asked.append(len(xyz))
        positions = xyz[:, :2] * [1.0, -1.0]
        positions[xyz[:, 1] > self.limit] = np.nan
        return positions

    def lines_on_plane(
        self, xyz: NDArray[np.float64], ends: NDArray[np.int64]
    ) -> list[NDArray[np.float64]]:
        """Each segment as two pieces."""
        lines = []
        for first, second in self.to_plane(xyz)[ends]:
            line = np.stack([first, (first + second) / 2, second])
            lines.append(line if np.isfinite(line).all() else np.empty((0, 2)))
        return lines

    def ray(self, position: tuple[float, float]) -> Ray:
        return Ray((position[0], -position[1], 100.0), (0.0, 0.0, -1.0))

    def reach_m(self, position: tuple[float, float], reach: float, at: Position | None) -> float:
        return reach

    def is_near(self, xyz: NDArray[np.float64]) -> NDArray[np.bool_]:
        return xyz[:, 2] < 50.0


class GridView(PlaneView):
    """Points lie on whole metres from 0 to 10."""

    def __init__(self, open_map: OpenMap) -> None:
        super().__init__(open_map, open_map.shared)
        self.shown_projection: GridProjection | None = GridProjection()
        self.grounds = 0
        self.box: NDArray[np.float64] | None = None

    @override
    def projection(self) -> GridProjection | None:
        return self.shown_projection

    @override
    def words(self) -> str:
        return "nothing"

    @override
    def extent(self) -> QRectF | None:
        return QRectF(0, -10, 10, 10)

    @override
    def reach_box(self) -> NDArray[np.float64] | None:
        return self.box

    @override
    def paint_ground(self, painter: QPainter, viewport: PlaneViewport) -> None:
        self.grounds += 1

    @override
    def position_at(
        self, position: tuple[float, float], reach: float, *, exact: bool
    ) -> PickedPosition | None:
        east, north = round(position[0]), round(-position[1])
        away = np.hypot(east - position[0], north + position[1])
        if not (0 <= east <= 10 and 0 <= north <= 10) or away > reach:
            return None
        return grid_position(east, north)

    @override
    def points_inside(self, outline: QPolygonF) -> Mapping[str, NDArray[np.int64]]:
        return {"grid": np.array([1, 2])}


def grid_position(east: int, north: int) -> PickedPosition:
    """A measured point of the grid."""
    return PickedPosition(
        (float(east), float(north), 5.0), PointReference("grid", 100 * east + north)
    )


@dataclass
class PlaneViewUser(ViewUser):
    """A view and the hand at its mouse and keyboard."""

    view: GridView

    def add(self, geometry: Geometry, *positions: tuple[int, int], **fields: object) -> Feature:
        feature = Feature(
            new_feature_id(),
            self.map.kind_of(geometry),
            geometry,
            tuple(
                Vertex(position.xyz, position.measured)
                for position in (grid_position(east, north) for east, north in positions)
            ),
            **fields,  # type: ignore[arg-type]
        )
        self.map.apply(Text.same("test"), Change(added=(feature,)))
        return feature

    def spot(self, east: float, north: float) -> QPoint:
        position = self.view.position_of(PickedPosition((float(east), float(north), 5.0)))
        assert position is not None
        return position.toPoint()

    def colour_at(self, spot: QPoint) -> str:
        image = self.view.grab().toImage()
        ratio = image.devicePixelRatioF()
        return image.pixelColor((spot.toPointF() * ratio).toPoint()).name()


@pytest.fixture
def user(qtbot: QtBot) -> PlaneViewUser:
    """Give a shown view of the grid, all of it in the window."""
    open_map = OpenMap()
    view = GridView(open_map)
    qtbot.addWidget(view)
    view.resize(800, 600)
    with qtbot.waitExposed(view):
        view.show()
    return PlaneViewUser(qtbot, open_map, view)

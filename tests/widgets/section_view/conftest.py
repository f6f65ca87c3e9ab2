"""The section view on a shown window, its points there, with a map behind it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot
from typing_extensions import override

from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, Vertex, new_feature_id
from processing.recording.drive import Drive
from tests.builders import START
from tests.street_scene import CURB_AT_M
from tests.widgets.builders import OpenMap, position_on
from tests.widgets.view_user import ViewUser
from widgets.section_view.pane import SectionPane
from widgets.section_view.view import SectionView
from widgets.shared.cursor import PickedPosition


@dataclass
class SectionViewUser(ViewUser):
    """A view and the hand at its mouse and keyboard."""

    view: SectionView

    @property
    def pane(self) -> SectionPane:
        return self.view.panes[0]

    @property
    @override
    def picture(self) -> QWidget:
        return self.pane

    def do(self, work: Callable[[], object]) -> None:
        """Do something after which the section is painted anew."""
        with self.qtbot.waitSignal(self.view.sharpened, timeout=30_000):
            work()

    def line(self, *vertices: Vertex) -> Feature:
        """Put a line on the map."""
        kind = self.map.kind_of(Geometry.LINE)
        feature = Feature(new_feature_id(), kind, Geometry.LINE, vertices)
        self.map.apply(Text.same("test"), Change(added=(feature,)))
        return feature

    def spot(self, position: PickedPosition) -> QPoint:
        pixel = self.pane.position_of(position)
        assert pixel is not None
        return QPoint(int(np.floor(pixel.x())), int(np.floor(pixel.y())))

    def look_closely(self) -> None:
        """Look at the road in a thin slab, so large that points are apart."""
        settings = replace(self.view.settings, width_m=0.3)
        self.do(lambda: self.view.use_settings(settings))
        picture, pane = self.pane.picture, self.pane
        projection = pane.projection()
        assert picture is not None
        assert projection is not None
        road = picture.section[np.abs(picture.section[:, 0]) < 1.0]
        x, y = np.median(projection.on_plane(road), axis=0).tolist()
        scaled = pane.viewport.zoomed(30.0, 0.0, 0.0)
        pane.set_viewport(scaled.centred_on(x, y))

    def lone_point(self, avoid: QPoint | None = None) -> PickedPosition:
        """A measured point of the picture with no other near it in the window."""
        picture, pane = self.pane.picture, self.pane
        projection = pane.projection()
        assert picture is not None
        assert projection is not None
        spots = pane.viewport.to_screen(projection.on_plane(picture.section))
        inside = (spots > (80, 40)).all(axis=1)
        inside &= (spots < (pane.width() - 20, pane.height() - 40)).all(axis=1)
        for number in np.flatnonzero(inside):
            away = np.hypot(*(spots - spots[number]).T)
            away[number] = np.inf
            is_far = avoid is None or np.hypot(*(spots[number] - avoid.toTuple())) > 40
            if away.min() > 6 and is_far:
                drive = picture.request.drives[int(picture.drive_numbers[number])]
                return position_on(drive, int(picture.points[number]))
        pytest.fail("every point has another one near it")


@pytest.fixture
def open_map(left_drive: Drive, right_drive: Drive) -> OpenMap:
    return OpenMap((left_drive, right_drive))


@pytest.fixture
def user(qtbot: QtBot, open_map: OpenMap) -> Iterator[SectionViewUser]:
    """Give a view of both heads' street, in the middle of the ten metres."""
    user = shown(qtbot, open_map)
    user.do(lambda: user.view.show_position(on_road(user, 5.0)))
    yield user
    user.view.close()


def shown(qtbot: QtBot, open_map: OpenMap) -> SectionViewUser:
    view = SectionView(open_map, open_map.shared)
    qtbot.addWidget(view)
    view.resize(900, 600)
    if open_map.all_drives and view.standing is not None:
        with qtbot.waitSignal(view.sharpened, timeout=30_000):
            view.show()
    else:
        view.show()
    return SectionViewUser(qtbot, open_map, view)


def on_road(user: SectionViewUser, station_m: float) -> PickedPosition:
    """The place of the trajectory at a station."""
    standing = user.view.standing
    assert standing is not None
    return PickedPosition(standing.line.stations.position_at(station_m))


def station(user: SectionViewUser) -> float:
    assert user.view.standing is not None
    return user.view.standing.station_m


def curb_line(user: SectionViewUser) -> Feature:
    """The left curb as it was made: four metres to the left of the road's middle."""
    ends = [START + np.array([-CURB_AT_M, north, 0.07]) for north in (1.0, 4.0, 9.0)]
    return user.line(*(Vertex(tuple(end.tolist())) for end in ends))

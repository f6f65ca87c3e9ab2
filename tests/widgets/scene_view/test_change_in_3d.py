"""The later ground in the colours of its change, among the points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtGui import QImage
from vtkmodules.vtkRenderingCore import vtkRenderer

from processing.image.search.clip import Clip
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.ground.filters.cells import CellGrid
from tests.widgets.builders import position_on
from tests.widgets.scene_view.conftest import SceneViewUser
from tests.widgets.scene_view.test_scene_view import image_of
from widgets.scene_view.rendering.change_surface import MOST_FACES, ChangeSurface
from widgets.shared.cursor import PickedPosition
from widgets.shared.shown_volume import VolumeStyle

SIZE_M = 0.05
COUNT = 60


def _change(middle: NDArray[np.float64]) -> ChangeGrid:
    """Three metres square, a little above a place: cut in the west, fill in the east."""
    before = np.full((COUNT, COUNT), 0.5, np.float32)
    after = np.full((COUNT, COUNT), 0.1, np.float32)
    before[:, COUNT // 2 :] = -0.3
    shape = (COUNT, COUNT)
    corner = middle - np.array([SIZE_M * COUNT / 2, SIZE_M * COUNT / 2, 0.0])
    grid = CellGrid(corner, SIZE_M, COUNT, COUNT)
    return ChangeGrid(grid, before, after, np.ones(shape, np.bool_), np.ones(shape, np.float32))


@pytest.fixture
def middle(user: SceneViewUser) -> NDArray[np.float64]:
    """A place on the road, looked at obliquely from some metres."""
    position = position_on(user.drive, user.road_points(3)[1])
    user.look_at(position, 5.0, pitch_deg=-50.0)
    return np.array(position.xyz)


def _redness(user: SceneViewUser, image: QImage, xyz: NDArray[np.float64]) -> float:
    spot = user.spot(PickedPosition((float(xyz[0]), float(xyz[1]), float(xyz[2]))))
    colours = [image.pixelColor(spot.x() + dx, spot.y() + dy) for dx in (-2, 2) for dy in (-2, 2)]
    return float(np.mean([colour.red() - colour.blue() for colour in colours]))


def test_cut_is_blue_and_fill_orange_where_they_are_until_it_is_hidden(
    user: SceneViewUser, middle: NDArray[np.float64]
) -> None:
    volume = user.map.shared.volume
    west, east = (middle + np.array([side, 0.2, 0.1]) for side in (-0.7, 0.7))
    plain = image_of(user)
    volume.show(_change(middle), 1.0)
    shown = image_of(user)
    assert _redness(user, shown, west) < _redness(user, plain, west) - 40
    assert _redness(user, shown, east) > _redness(user, plain, east) + 40
    volume.use_look(replace(volume.look, is_shown=False))
    hidden = image_of(user)
    assert abs(_redness(user, hidden, east) - _redness(user, plain, east)) < 10


def test_another_range_gives_other_colours(
    user: SceneViewUser, middle: NDArray[np.float64]
) -> None:
    volume = user.map.shared.volume
    east = middle + np.array([0.7, 0.2, 0.1])
    volume.show(_change(middle), 1.0)
    near = _redness(user, image_of(user), east)
    volume.use_look(replace(volume.look, limit_m=20.0))
    assert _redness(user, image_of(user), east) < near - 30


def _surface() -> ChangeSurface:
    return ChangeSurface(vtkRenderer())


def test_a_large_map_is_drawn_with_fewer_faces() -> None:
    rows, columns = 1500, 1200
    grid = CellGrid(np.array([-11_000.0, -35_000.0, 100.0]), 0.1, rows, columns)
    ground = np.zeros((rows, columns), np.float32)
    change = ChangeGrid(
        grid, ground, ground, np.ones(ground.shape, np.bool_), np.ones(ground.shape, np.float32)
    )
    surface = _surface()
    surface.show(change, VolumeStyle(), np.array([-11_000.0, -35_000.0, 0.0]), None)
    assert 0.3 * MOST_FACES < surface.count <= MOST_FACES
    surface.show(None, VolumeStyle(), np.zeros(3), None)
    assert surface.count == 0


def test_nothing_is_drawn_without_ground_outside_the_boundary_and_beside_the_clip() -> None:
    change = _change(np.array([-11_000.0, -35_000.0, 100.0]))
    change.inside[:10] = 0.0
    change.after[:, :10] = np.nan
    surface, origin = _surface(), np.array([-11_000.0, -35_000.0, 0.0])
    surface.show(change, VolumeStyle(), origin, None)
    assert surface.count == (COUNT - 10 - 1) ** 2
    low = np.array([-11_000.0, -36_000.0, 0.0])
    clip = Clip.box(low, low + 2000.0)
    surface.show(change, VolumeStyle(), origin, clip)
    assert surface.count == (COUNT - 10 - 1) * (COUNT // 2 - 1)

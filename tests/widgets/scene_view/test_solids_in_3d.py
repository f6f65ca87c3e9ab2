"""Lids and gratings as bodies: seen, seen through, hidden with their kind, thousands at once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtCore import QPoint
from PySide6.QtGui import QImage

from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, Provenance, Status, Vertex, new_feature_id
from processing.map.solids import Solid, solid_of
from tests.widgets.builders import KINDS, position_on
from tests.widgets.scene_view.conftest import SceneViewUser
from tests.widgets.scene_view.test_scene_view import image_of
from widgets.feature_drawing.feature_shapes import FeatureShape
from widgets.feature_drawing.feature_style import style_of
from widgets.mouse_tools.editing.select import Select
from widgets.shared.cursor import PickedPosition

HALF_M = np.array([[-0.5, -0.4, 0.0], [0.5, -0.4, 0.0], [0.5, 0.4, 0.0], [-0.5, 0.4, 0.0]])

BESIDE = np.array([0.15, 0.1, 0.0])
"""Beside the cursor's cross and away from the edges."""


def lid_at(middle: NDArray[np.float64], confidence: float = 0.9, kind: str = "lid") -> Feature:
    vertices = tuple(Vertex((float(x), float(y), float(z))) for x, y, z in middle + HALF_M)
    provenance = Provenance("gutters", 1, {}, confidence, "run")
    status = Status.CANDIDATE
    return Feature(new_feature_id(), kind, Geometry.AREA, vertices, {}, status, provenance)


def put(user: SceneViewUser, feature: Feature) -> Feature:
    user.map.apply(Text.same("add"), Change(added=(feature,)))
    return feature


def judge(user: SceneViewUser, feature: Feature, status: Status) -> None:
    pair = Replacement(feature, replace(feature, status=status))
    user.map.apply(Text.same("judge"), Change(replaced=(pair,)))


def blue_at(image: QImage, spot: QPoint) -> float:
    """How much bluer than red it is about a place; the road is grey."""
    span = range(-3, 4)
    colours = [image.pixelColor(spot.x() + dx, spot.y() + dy) for dx in span for dy in span]
    return float(np.mean([colour.blue() - colour.red() for colour in colours]))


@pytest.fixture
def middle(user: SceneViewUser) -> NDArray[np.float64]:
    """A place on the road, looked at obliquely from some metres."""
    position = position_on(user.drive, user.road_points(3)[1])
    user.look_at(position, 5.0, pitch_deg=-35.0)
    return np.array(position.xyz)


def spot_of(user: SceneViewUser, xyz: NDArray[np.float64]) -> QPoint:
    return user.spot(PickedPosition((float(xyz[0]), float(xyz[1]), float(xyz[2]))))


def test_a_body_is_fuller_the_surer_it_is(user: SceneViewUser, middle: NDArray[np.float64]) -> None:
    spot = spot_of(user, middle + BESIDE)
    seen = [blue_at(image_of(user), spot)]
    doubtful = put(user, lid_at(middle, 0.1))
    seen.append(blue_at(image_of(user), spot))
    user.map.apply(Text.same("away"), Change(removed=(doubtful,)))
    sure = put(user, lid_at(middle, 0.9))
    seen.append(blue_at(image_of(user), spot))
    judge(user, sure, Status.ACCEPTED)
    seen.append(blue_at(image_of(user), spot))
    user.map.shared.selection.choose_features(frozenset({sure.id}))
    seen.append(blue_at(image_of(user), spot))
    assert seen == sorted(seen)
    assert min(np.diff(seen)) > 5


def test_the_sides_are_seen_below_the_top(user: SceneViewUser, middle: NDArray[np.float64]) -> None:
    feature = put(user, lid_at(middle))
    judge(user, feature, Status.ACCEPTED)
    image = image_of(user)
    near = min(
        ((HALF_M[at] + HALF_M[at - 1]) / 2 for at in range(4)),
        key=lambda side: -spot_of(user, middle + side).y(),
    )
    assert blue_at(image, spot_of(user, middle + near - [0, 0, 0.15])) > 15
    assert blue_at(image, spot_of(user, middle + near * 1.6 - [0, 0, 0.4])) < 5


def test_bodies_go_with_their_kind_and_when_they_are_rejected(
    user: SceneViewUser, middle: NDArray[np.float64]
) -> None:
    spot = spot_of(user, middle + BESIDE)
    before = blue_at(image_of(user), spot)
    feature = put(user, lid_at(middle))
    assert blue_at(image_of(user), spot) > before + 10
    settings = user.map.shared.view_settings
    settings.hide_kinds(frozenset({"lid"}))
    assert blue_at(image_of(user), spot) == pytest.approx(before, abs=2)
    settings.hide_kinds(frozenset())
    settings.set_shows_rejected(True)
    judge(user, feature, Status.REJECTED)
    assert blue_at(image_of(user), spot) == pytest.approx(before, abs=2)


def test_a_click_on_the_edge_of_a_body_chooses_it(
    user: SceneViewUser, middle: NDArray[np.float64]
) -> None:
    feature = put(user, lid_at(middle))
    image_of(user)
    user.take(Select(user.map, user.map.shared))
    user.click(spot_of(user, middle + (HALF_M[0] + HALF_M[1]) / 2))
    assert user.map.shared.selection.features == {feature.id}


def shape_of(feature: Feature) -> FeatureShape:
    return FeatureShape(feature, np.array([vertex.xyz for vertex in feature.vertices]))


def test_thousands_of_bodies_are_one_mesh_and_are_shaped_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from vtkmodules.vtkRenderingCore import vtkRenderer

    from widgets.scene_view.rendering import solid_actors
    from widgets.scene_view.rendering.solid_actors import SolidActors, StyledSolid

    made: list[float] = []

    def counted(ring: NDArray[np.float64], thickness_m: float) -> Solid | None:
        made.append(thickness_m)
        return solid_of(ring, thickness_m)

    monkeypatch.setattr(solid_actors, "solid_of", counted)
    renderer = vtkRenderer()
    actors = SolidActors(renderer)
    lids = [lid_at(np.array([0.6 * at, 0.0, 0.0])) for at in range(3000)]
    shapes = [shape_of(lid) for lid in lids]

    def shown(chosen: str) -> list[StyledSolid]:
        return [
            StyledSolid(shape, style_of(KINDS, lid, is_selected=lid.id == chosen), 0.1)
            for lid, shape in zip(lids, shapes, strict=True)
        ]

    actors.show(shown(""))
    assert renderer.GetActors().GetNumberOfItems() == 1
    assert actors.count == 6 * 3000
    assert len(made) == 3000
    actors.show(shown(lids[7].id))
    assert len(made) == 3000
    actors.clear()
    assert renderer.GetActors().GetNumberOfItems() == 0
    assert actors.count == 0


def test_a_grating_has_bars_across_its_longer_side() -> None:
    from vtkmodules.vtkRenderingCore import vtkRenderer

    from widgets.scene_view.rendering.solid_actors import SolidActors, StyledSolid

    renderer = vtkRenderer()
    actors = SolidActors(renderer)
    for turned in (0, 1):
        grating = lid_at(np.zeros(3), kind="gutter_grating")
        grating = grating.with_vertices(grating.vertices[turned:] + grating.vertices[:turned])
        style = style_of(KINDS, grating, is_selected=False)
        actors.show([StyledSolid(shape_of(grating), style, 0.05)])
        # 25 gaps and the bars between and beside them, four sides, the bottom.
        assert actors.count == 25 + 26 + 5
        mesh = renderer.GetActors().GetLastActor().GetMapper().GetInput()
        first = mesh.GetCell(0).GetBounds()
        assert first[1] - first[0] < 0.04
        assert first[3] - first[2] == pytest.approx(0.8)
        colours = mesh.GetCellData().GetScalars()
        assert colours.GetTuple(0) == colours.GetTuple(2) != colours.GetTuple(1)
    actors.clear()

"""Features under the mouse and in a rectangle, and how candidates are dashed."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QRectF
from PySide6.QtGui import QPolygonF

from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Status, Vertex, new_feature_id
from widgets.feature_drawing.feature_hits import FeatureHit
from widgets.feature_drawing.feature_shapes import FeatureShapes, flatten_shapes, segments_of
from widgets.scene_view.map.feature_hits import feature_at, features_within
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.rendering.projection import SceneProjection
from widgets.shared.view_settings import ViewSettings

ORIGIN = np.array([-11_000.0, -35_000.0, 100.0])
CAMERA = SceneCamera((0.0, 0.0, 0.0), heading_deg=0.0, pitch_deg=0.0, angle_deg=90.0)
VIEW = SceneProjection(CAMERA, 1000, 1000)
SHOWN = ViewSettings()


def feature(geometry: Geometry, *pixels: tuple[float, float], **fields: object) -> Feature:
    """A feature ten metres in front of the camera, its vertices at these pixels."""
    positions = [VIEW.position_at(x, y, 10.0) + ORIGIN for x, y in pixels]
    vertices = tuple(Vertex((float(e), float(n), float(h))) for e, n, h in positions)
    return Feature(new_feature_id(), "kind", geometry, vertices, **fields)


def hit(
    features: list[Feature], x: float, y: float, selected: frozenset[str] = frozenset()
) -> FeatureHit:
    shapes = FeatureShapes(ORIGIN, features)
    return feature_at(flatten_shapes(shapes.seen(SHOWN.shows)), VIEW, (x, y), selected)


def test_a_vertex_is_hit_within_eight_pixels() -> None:
    line = feature(Geometry.LINE, (200, 200), (800, 200))
    assert hit([line], 807, 200) == FeatureHit(line.id, vertex=1)
    assert hit([line], 809, 200) == FeatureHit()


def test_a_segment_is_hit_within_six_pixels() -> None:
    line = feature(Geometry.LINE, (200, 200), (500, 200), (800, 400))
    assert hit([line], 350, 205) == FeatureHit(line.id, segment=0)
    assert hit([line], 650, 300) == FeatureHit(line.id, segment=1)
    assert hit([line], 350, 208) == FeatureHit()


def test_the_side_that_closes_an_area_is_its_last_segment() -> None:
    area = feature(Geometry.AREA, (200, 200), (800, 200), (500, 700))
    assert hit([area], 350, 450) == FeatureHit(area.id, segment=2)


def test_a_vertex_goes_before_a_segment_and_the_chosen_before_the_nearer() -> None:
    first = feature(Geometry.LINE, (200, 200), (800, 200))
    second = feature(Geometry.LINE, (500, 203), (500, 800))
    assert hit([first, second], 500, 199) == FeatureHit(second.id, vertex=0)
    third = feature(Geometry.LINE, (200, 204), (800, 204))
    chosen = frozenset({third.id})
    assert hit([first, third], 400, 201) == FeatureHit(first.id, segment=0)
    assert hit([first, third], 400, 201, chosen) == FeatureHit(third.id, segment=0)


def test_hidden_rejected_and_edited_features_are_not_there() -> None:
    shown = feature(Geometry.POINT, (500, 500))
    rejected = feature(Geometry.POINT, (500, 500), status=Status.REJECTED)
    shapes = FeatureShapes(ORIGIN, [shown, rejected])
    assert [one.feature for one in shapes.seen(SHOWN.shows)] == [shown]
    assert shapes.seen(SHOWN.shows, shown.id) == ()
    settings = ViewSettings()
    settings.hide_kinds(frozenset({"kind"}))
    assert shapes.seen(settings.shows) == ()


def test_rejected_features_are_there_on_request() -> None:
    rejected = feature(Geometry.POINT, (500, 500), status=Status.REJECTED)
    settings = ViewSettings()
    settings.set_shows_rejected(True)
    (shape,) = FeatureShapes(ORIGIN, [rejected]).seen(settings.shows)
    assert shape.feature == rejected


def test_features_that_changed_are_replaced_or_forgotten() -> None:
    point = feature(Geometry.POINT, (500, 500))
    shapes = FeatureShapes(ORIGIN, [point])
    moved = point.with_vertices((Vertex((-10_990.0, -34_990.0, 100.0)),))
    shapes.replace(point.id, moved)
    (shape,) = shapes.seen(SHOWN.shows)
    assert shape.local_xyz == pytest.approx(np.array([[10.0, 10.0, 0.0]]))
    shapes.replace(point.id, None)
    assert shapes.seen(SHOWN.shows) == ()


def test_a_box_holds_what_lies_wholly_inside() -> None:
    inside = feature(Geometry.LINE, (300, 300), (400, 400))
    across = feature(Geometry.LINE, (300, 300), (900, 400))
    flat = flatten_shapes(FeatureShapes(ORIGIN, [inside, across]).seen(SHOWN.shows))
    box = QPolygonF(QRectF(250, 250, 300, 300))
    assert features_within(flat, VIEW, box) == {inside.id}


def test_a_feature_behind_the_camera_is_in_no_box() -> None:
    behind = Feature("b", "kind", Geometry.POINT, (Vertex((-11_000.0, -35_010.0, 100.0)),))
    flat = flatten_shapes(FeatureShapes(ORIGIN, [behind]).seen(SHOWN.shows))
    assert features_within(flat, VIEW, QPolygonF(QRectF(0, 0, 1000, 1000))) == frozenset()


def test_no_features_are_hit_where_there_are_none() -> None:
    assert hit([], 5, 5) == FeatureHit()
    assert features_within(flatten_shapes(()), VIEW, QPolygonF(QRectF(0, 0, 9, 9))) == frozenset()


@pytest.mark.parametrize(
    ("geometry", "count", "ends"),
    [
        (Geometry.POINT, 1, []),
        (Geometry.LINE, 3, [[0, 1], [1, 2]]),
        (Geometry.AREA, 3, [[0, 1], [1, 2], [2, 0]]),
        (Geometry.AREA, 2, [[0, 1]]),
        (Geometry.LINE, 1, []),
    ],
)
def test_vertices_are_joined_by_the_shape(
    geometry: Geometry, count: int, ends: list[list[int]]
) -> None:
    assert segments_of(geometry, count).tolist() == ends


def test_dashes_cover_their_share_of_a_bent_line_and_stay_on_it() -> None:
    from widgets.scene_view.rendering.feature_actors import dash_segments

    corners = np.array([[0.0, 0.0, 0.0], [4.3, 0.0, 0.0], [4.3, 5.7, 0.0]])
    dashes = dash_segments(corners, segments_of(Geometry.LINE, 3))
    lengths = np.linalg.norm(dashes[:, 1] - dashes[:, 0], axis=1)
    assert lengths.sum() == pytest.approx(6.0)
    on_first = np.isclose(dashes[:, :, 1], 0.0).all(axis=1)
    on_second = np.isclose(dashes[:, :, 0], 4.3).all(axis=1)
    assert (on_first | on_second).all()

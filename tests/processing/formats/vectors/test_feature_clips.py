"""What is copied is pasted whole: in the same project, in another, from another program."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from processing.core.errors import MissingInput, OutOfRange, Unsuitable
from processing.core.text import Text
from processing.formats.vectors.feature_clips import clip_of, features_of_clip
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, PointReference, Provenance, Status, Vertex
from resources import path_of
from tests.processing.project.drawn import curb, sign

_ZONE_9, _ZONE_8 = "EPSG:6677", "EPSG:6676"
_LID = Feature(
    "lid",
    "gutter_lid",
    Geometry.AREA,
    (
        Vertex((-11380.123, -35124.456, 125.789), PointReference("left", 7)),
        Vertex((-11379.6, -35124.5, 125.8), is_occluded=True),
        Vertex((-11379.7, -35124.1, 125.1 + 1e-12), PointReference("right", 0)),
    ),
    {"id": "7", "attribute_id": 8, "kind": None, "note": "蓋 🌳", "width_m": 0.4, "is_new": True},
    Status.REJECTED,
)
_KIND_FOR = {Geometry.POINT: "sign", Geometry.LINE: "road_edge", Geometry.AREA: "crosswalk"}


@pytest.fixture(scope="module")
def bundled() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _kind(id_: str, geometry: Geometry, dm_code: str, layer: str = "a") -> FeatureKind:
    return FeatureKind(
        id_, Text(f"An {id_}", f"{id_}です"), geometry, dm_code, layer, "#d55e00", 30
    )


def _without_ids(features: tuple[Feature, ...]) -> list[Feature]:
    return [replace(feature, id="") for feature in features]


def _geojson(*geometries: object, crs: object = "EPSG:6677") -> str:
    members = [
        {"type": "Feature", "geometry": one, "properties": {"name": "n", "list": [1, "あ"]}}
        for one in geometries
    ]
    named = {"type": "name", "properties": {"name": crs}} if isinstance(crs, str) else crs
    return json.dumps({"type": "FeatureCollection", "crs": named, "features": members})


def test_a_copy_in_the_same_project_is_the_same_to_the_last_bit_with_an_id_of_its_own(
    bundled: Catalogue,
) -> None:
    drawn = (curb("a", vertices=40), sign("b"), _LID)
    pasted = features_of_clip(clip_of(drawn, _ZONE_9, bundled), _ZONE_9, bundled, ("left", "right"))
    assert _without_ids(pasted.features) == _without_ids(drawn)
    assert pasted.notes == ()
    assert len({feature.id for feature in (*drawn, *pasted.features)}) == 6


def test_every_paste_of_a_text_gives_other_ids(bundled: Catalogue) -> None:
    text = clip_of([sign("b")], _ZONE_9, bundled)
    ids = {features_of_clip(text, _ZONE_9, bundled, ()).features[0].id for _ in range(3)}
    assert len(ids) == 3


def test_in_another_project_vertices_keep_their_place_but_not_the_measured_points(
    bundled: Catalogue,
) -> None:
    text = clip_of([_LID, curb("a")], _ZONE_9, bundled)
    pasted = features_of_clip(text, _ZONE_9, bundled, ("right",))
    lid, line = pasted.features
    assert [vertex.xyz for vertex in lid.vertices] == [vertex.xyz for vertex in _LID.vertices]
    assert [one.measured for one in lid.vertices] == [None, None, PointReference("right", 0)]
    assert [one.is_occluded for one in lid.vertices] == [False, True, False]
    assert line.provenance == replace(curb("a").provenance, run="")
    assert [note.en[:2] for note in pasted.notes] == ["3 "]


def test_in_another_zone_places_are_transformed_and_said_and_heights_kept(
    bundled: Catalogue,
) -> None:
    # The origin of zone IX (36° N, 139°50′ E) in zone VIII, whose meridian is 138°30′ E.
    origin = Feature(
        "o", "sign", Geometry.POINT, (Vertex((0.0, 0.0, 9.25), PointReference("d", 1)),)
    )
    pasted = features_of_clip(clip_of([origin], _ZONE_9, bundled), _ZONE_8, bundled, ("d",))
    (vertex,) = pasted.features[0].vertices
    x, y, height = vertex.xyz
    assert (round(x / 1000), round(y / 1000)) == (120, 1)
    assert height == 9.25
    assert vertex.measured is None
    assert "EPSG:6676" in pasted.notes[0].en
    assert "標高" in pasted.notes[0].ja
    back = features_of_clip(clip_of(pasted.features, _ZONE_8, bundled), _ZONE_9, bundled, ())
    assert np.allclose(back.features[0].vertices[0].xyz, (0, 0, 9.25), rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    ("here", "there", "said"),
    [
        ("EPSG:30169", "EPSG:6677", "tky2jgd.gsb"),  # Tokyo datum
        ("EPSG:2451", "EPSG:6677", "1.00 m"),  # JGD2000: the earthquake of 2011 lies between
        ("EPSG:6677", "EPSG:27700", "known accuracy"),
    ],
)
def test_a_way_between_datums_that_is_not_exact_enough_is_refused_with_the_reason(
    bundled: Catalogue, here: str, there: str, said: str
) -> None:
    with pytest.raises(Unsuitable) as refusal:
        features_of_clip(clip_of([sign("a")], here, bundled), there, bundled, ())
    assert said in refusal.value.line("en")
    assert "\n" not in refusal.value.line("ja")


def test_zones_of_one_old_datum_are_exact(bundled: Catalogue) -> None:
    text = clip_of([sign("a")], "EPSG:30169", bundled)
    assert len(features_of_clip(text, "EPSG:30168", bundled, ()).features) == 1


@pytest.mark.parametrize(("here", "there"), [(_ZONE_9, ""), ("", _ZONE_9)])
def test_one_unknown_reference_system_is_refused(bundled: Catalogue, here: str, there: str) -> None:
    with pytest.raises(MissingInput) as refusal:
        features_of_clip(clip_of([sign("a")], here, bundled), there, bundled, ())
    assert _ZONE_9 in refusal.value.where.ja


def test_two_unknown_reference_systems_are_taken_as_one_and_said(bundled: Catalogue) -> None:
    pasted = features_of_clip(clip_of([_LID], "", bundled), "", bundled, ("left", "right"))
    assert _without_ids(pasted.features) == _without_ids((_LID,))
    assert len(pasted.notes) == 1


def test_a_reference_system_that_there_is_not_is_refused(bundled: Catalogue) -> None:
    with pytest.raises(OutOfRange):
        features_of_clip(clip_of([sign("a")], "EPSG:999999", bundled), _ZONE_9, bundled, ())


def test_a_place_that_the_other_zone_cannot_express_is_refused(bundled: Catalogue) -> None:
    far = sign("a", easting=9e7, northing=9e7)
    with pytest.raises(OutOfRange):
        features_of_clip(clip_of([far], _ZONE_9, bundled), _ZONE_8, bundled, ())


def test_a_kind_that_the_other_catalogue_lacks_becomes_one_of_its_code_and_geometry(
    bundled: Catalogue,
) -> None:
    office = Catalogue(
        (
            _kind("mark", Geometry.POINT, "2238"),
            _kind("hedge_area", Geometry.AREA, "6136"),
            _kind("rail_a", Geometry.LINE, "6132", "6132_柵"),
            _kind("rail_b", Geometry.LINE, "6132", "6132_防護柵"),
        )
    )
    line = (Vertex((0.0, 0.0, 0.0)), Vertex((1.0, 0.0, 0.0)))
    drawn = (
        replace(sign("t"), kind="street_tree"),
        Feature("r", "guard_rail", Geometry.LINE, line),
        Feature("h", "hedge", Geometry.LINE, line),
        sign("s"),
        sign("s2"),
    )
    pasted = features_of_clip(clip_of(drawn, _ZONE_9, bundled), _ZONE_9, office, ())
    kinds = [feature.kind for feature in pasted.features]
    assert kinds == ["mark", "rail_b", "hedge", "sign", "sign"]
    assert len(pasted.notes) == 4
    assert "街路樹" in pasted.notes[0].ja
    assert pasted.notes[3].en.startswith("2 features")


def test_a_kind_of_the_same_id_and_another_geometry_is_not_taken(bundled: Catalogue) -> None:
    office = Catalogue((_kind("sign", Geometry.AREA, ""),))
    pasted = features_of_clip(clip_of([sign("a")], _ZONE_9, bundled), _ZONE_9, office, ())
    assert pasted.features[0].kind == "sign"
    assert pasted.features[0].geometry is Geometry.POINT
    assert len(pasted.notes) == 1


def test_other_programs_can_read_the_text(bundled: Catalogue) -> None:
    whole = json.loads(clip_of([_LID], _ZONE_9, bundled))
    assert whole["type"] == "FeatureCollection"
    assert whole["crs"]["properties"]["name"] == "urn:ogc:def:crs:EPSG::6677"
    (member,) = whole["features"]
    assert member["geometry"]["type"] == "Polygon"
    ring = member["geometry"]["coordinates"][0]
    assert ring[0] == ring[-1] == list(_LID.vertices[0].xyz)
    assert member["properties"]["note"] == "蓋 🌳"
    assert member["properties"]["kind"] == "gutter_lid"


def test_shapes_of_other_programs_become_the_kinds_that_are_given(bundled: Catalogue) -> None:
    square = [[0, 0, 1], [9, 0, 1], [9, 9, 1], [0, 9, 1], [0, 0, 1]]
    hole = [[1, 1, 1], [2, 1, 1], [2, 2, 1], [1, 1, 1]]
    text = _geojson(
        {"type": "Point", "coordinates": [1, 2.5]},
        {"type": "MultiLineString", "coordinates": [[[0, 0, 1], [1, 0, 1]], [[2, 0, 1], [3, 0]]]},
        {"type": "Polygon", "coordinates": [square, hole]},
        {
            "type": "GeometryCollection",
            "geometries": [{"type": "MultiPoint", "coordinates": [[1, 2, 3], [4, 5, 6, 7]]}],
        },
        None,
    )
    pasted = features_of_clip(text, _ZONE_9, bundled, (), kind_for=_KIND_FOR)
    kinds = [feature.kind for feature in pasted.features]
    assert kinds == ["sign", *["road_edge"] * 2, *["crosswalk"] * 2, *["sign"] * 2]
    assert pasted.features[0].vertices == (Vertex((1.0, 2.5, 0.0)),)
    assert len(pasted.features[3].vertices) == 4
    assert pasted.features[6].vertices == (Vertex((4.0, 5.0, 6.0)),)
    assert pasted.features[0].attributes == {"name": "n", "list": '[1, "あ"]'}
    assert all(feature.status is Status.ACCEPTED for feature in pasted.features)
    assert all(feature.provenance == Provenance() for feature in pasted.features)
    assert [note.en[:2] for note in pasted.notes] == ["2 ", "1 ", "1 "]


@pytest.mark.parametrize(
    "text",
    [
        '{"type": "Point", "coordinates": [1, 2, 3]}',
        '\ufeff \n{"type": "Feature", "geometry": {"type": "Point", "coordinates": [1, 2, 3]}}',
        '{"type": "Feature", "properties": null, "crs": null, '
        '"geometry": {"type": "Point", "coordinates": [1, 2, 3]}}',
    ],
)
def test_a_geometry_or_a_feature_alone_is_pasted(bundled: Catalogue, text: str) -> None:
    crs = "" if "null" in text else "EPSG:4326"
    pasted = features_of_clip(text, crs, bundled, (), kind_for=_KIND_FOR)
    assert np.allclose(pasted.features[0].vertices[0].xyz, (1, 2, 3))


def test_a_shape_that_no_kind_is_given_for_is_refused(bundled: Catalogue) -> None:
    text = _geojson({"type": "Point", "coordinates": [1, 2, 3]})
    with pytest.raises(Unsuitable) as refusal:
        features_of_clip(text, _ZONE_9, bundled, (), kind_for={Geometry.LINE: "road_edge"})
    assert "points" in refusal.value.line("en")


def test_geojson_of_degrees_is_refused_where_degrees_are_too_inexact(bundled: Catalogue) -> None:
    text = '{"type": "Point", "coordinates": [139.7, 35.7, 3]}'
    with pytest.raises(Unsuitable) as refusal:
        features_of_clip(text, _ZONE_9, bundled, (), kind_for=_KIND_FOR)
    assert "1.00 m" in refusal.value.line("en")


def test_geojson_of_metres_that_names_no_reference_system_is_refused(bundled: Catalogue) -> None:
    text = '{"type": "Point", "coordinates": [-11380, -35124, 3]}'
    with pytest.raises(MissingInput):
        features_of_clip(text, _ZONE_9, bundled, (), kind_for=_KIND_FOR)


def test_degrees_of_the_same_datum_become_metres(bundled: Catalogue) -> None:
    text = _geojson({"type": "Point", "coordinates": [139 + 50 / 60, 36.0, 3]}, crs="EPSG:6668")
    pasted = features_of_clip(text, _ZONE_9, bundled, (), kind_for=_KIND_FOR)
    assert np.allclose(pasted.features[0].vertices[0].xyz, (0, 0, 3), atol=1e-6)


def test_another_programs_change_of_the_vertices_drops_what_they_rest_on(
    bundled: Catalogue,
) -> None:
    whole = json.loads(clip_of([curb("a", vertices=3)], _ZONE_9, bundled))
    del whole["features"][0]["geometry"]["coordinates"][1]
    pasted = features_of_clip(json.dumps(whole), _ZONE_9, bundled, ("left",))
    assert [vertex.measured for vertex in pasted.features[0].vertices] == [None, None]


def test_an_empty_copy_pastes_nothing_and_says_so(bundled: Catalogue) -> None:
    pasted = features_of_clip(clip_of([], _ZONE_9, bundled), "", bundled, ())
    assert pasted.features == ()
    assert len(pasted.notes) == 1


def test_ten_thousand_features_go_through_whole(bundled: Catalogue) -> None:
    drawn = tuple(curb(f"f{number}", vertices=8) for number in range(10_000))
    pasted = features_of_clip(clip_of(drawn, _ZONE_9, bundled), _ZONE_9, bundled, ("left",))
    assert _without_ids(pasted.features) == _without_ids(drawn)


def test_more_than_a_clipboard_should_hold_is_refused_when_it_is_copied(
    bundled: Catalogue,
) -> None:
    big = replace(sign("a"), attributes={"note": "x" * (65 << 20)})
    with pytest.raises(OutOfRange):
        clip_of([big], _ZONE_9, bundled)

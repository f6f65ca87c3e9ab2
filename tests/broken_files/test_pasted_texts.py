"""A text that can't be pasted ends in one sentence; whatever else comes out of it is whole."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import BadFile, UserError
from processing.core.text import Text
from processing.formats.vectors.feature_clips import PastedFeatures, clip_of, features_of_clip
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, PointReference, Vertex
from resources import path_of
from tests.processing.project.drawn import curb

_KIND_FOR = {Geometry.POINT: "sign", Geometry.LINE: "road_edge", Geometry.AREA: "crosswalk"}
_LID = Feature(
    "lid",
    "gutter_lid",
    Geometry.AREA,
    (
        Vertex((-11380.123, -35124.456, 125.789), PointReference("left", 7)),
        Vertex((-11379.6, -35124.5, 125.8), is_occluded=True),
        Vertex((-11379.7, -35124.1, 125.1)),
    ),
    {"id": "7", "note": "蓋 🌳"},
)


@pytest.fixture(scope="module")
def bundled() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _outcome(text: str, crs: str, catalogue: Catalogue) -> PastedFeatures | UserError:
    try:
        return features_of_clip(text, crs, catalogue, ("left",), kind_for=_KIND_FOR)
    except UserError as error:
        return error


def _damages() -> list[str]:
    good = {"type": "Point", "coordinates": [1, 2, 3]}
    own = {"kind": "sign", "status": "accepted", "confidence": 1, "tool": "hand"}

    def ours(**changes: object) -> str:
        member = {"type": "Feature", "geometry": good, "properties": own, **changes}
        return json.dumps({"type": "FeatureCollection", "crs": None, "features": [member]})

    return [
        "",
        "道路縁を3本",
        "[1, 2, 3]",
        "{",
        "{}",
        '{"type": "Topology"}',
        '{"type": "FeatureCollection"}',
        '{"type": "FeatureCollection", "features": [1]}',
        '{"type": "Point", "coordinates": [NaN, 2, 3]}',
        '{"type": "Point", "coordinates": [1e999, 2, 3]}',
        '{"type": "Point", "coordinates": [' + "9" * 400 + ", 2, 3]}",
        '{"type": "Point", "coordinates": [' + "9" * 5000 + ", 2, 3]}",
        '{"type": "Point", "coordinates": [true, 2, 3]}',
        '{"type": "Point", "coordinates": ["1", "2"]}',
        '{"type": "Point", "coordinates": [1, ' + "[" * 900 + "]" * 900 + "]}",
        '{"type": "Point", "coordinates": [1]}',
        '{"type": "Point", "coordinates": {}}',
        '{"type": "Point"}',
        '{"type": "LineString", "coordinates": [[1, 2, 3]]}',
        '{"type": "Polygon", "coordinates": []}',
        '{"type": "Polygon", "coordinates": [[[1, 2], [3, 4], [1, 2]]]}',
        '{"type": "Feature", "geometry": {"type": "Circle"}}',
        '{"type": "Feature", "geometry": 5}',
        '{"type": ["Feature"]}',
        '{"type": "FeatureCollection", "features": [], "zuka": 5}',
        '{"type": "FeatureCollection", "features": [], "zuka": {"version": 2}}',
        '{"type": "FeatureCollection", "features": [], "crs": "EPSG:6677"}',
        '{"type": "FeatureCollection", "features": [], "crs": {"properties": {"name": "ESRI:1"}}}',
        '{"type": "Feature", "properties": {"a": "\\ud800"}, "geometry": null}',
        "[" * 100_000,
        '{"a":' * 100_000,
        ours(properties=[1]),
        ours(properties={**own, "status": []}),
        ours(properties={**own, "status": "done"}),
        ours(properties={**own, "kind": 5}),
        ours(properties={**own, "confidence": 2}),
        ours(properties={**own, "confidence": "x"}),
        ours(zuka=5),
        ours(zuka={"parameters": []}),
        ours(zuka={"measured": 5}),
        ours(zuka={"measured": [["left", -1]]}),
        ours(zuka={"measured": [[5, 5]]}),
    ]


@pytest.mark.parametrize("text", _damages())
def test_a_text_that_is_no_map_is_refused_in_one_sentence(bundled: Catalogue, text: str) -> None:
    with pytest.raises(BadFile) as refusal:
        features_of_clip(text, "", bundled, (), kind_for=_KIND_FOR)
    for language in ("en", "ja"):
        line = refusal.value.line(language)
        assert "\n" not in line
        assert len(line) < 400


def test_a_text_of_many_megabytes_is_refused(bundled: Catalogue) -> None:
    with pytest.raises(BadFile):
        features_of_clip("{" + " " * (65 << 20), "EPSG:6677", bundled, ())


def test_a_text_cut_or_altered_anywhere_ends_in_features_or_in_a_sentence(
    bundled: Catalogue,
) -> None:
    text = clip_of([_LID, curb("a")], "EPSG:6677", bundled)
    random = np.random.default_rng(5)
    texts = [text[:size] for size in range(0, len(text), 7)]
    for position in random.integers(0, len(text), 600):
        other = '[]{},:"0aé\\-e'[int(random.integers(13))]
        texts.append(text[:position] + other + text[position + 1 :])
    for damaged in texts:
        outcome = _outcome(damaged, "EPSG:6677", bundled)
        if isinstance(outcome, UserError):
            assert "\n" not in outcome.line("ja")
        else:
            assert all(np.isfinite(v.xyz).all() for f in outcome.features for v in f.vertices)


@given(
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
        lambda inner: (
            st.lists(inner, max_size=3)
            | st.dictionaries(
                st.sampled_from(
                    [
                        "type",
                        "features",
                        "geometry",
                        "coordinates",
                        "properties",
                        "crs",
                        "zuka",
                        "kind",
                    ]
                ),
                inner | st.sampled_from(["Feature", "FeatureCollection", "Point", "Polygon"]),
                max_size=4,
            )
        ),
        max_leaves=12,
    )
)
def test_any_json_ends_in_features_or_in_a_sentence(value: object) -> None:
    bundled = Catalogue(
        (FeatureKind("sign", Text("Sign", "標識"), Geometry.POINT, "", "a", "#d55e00", 30),)
    )
    outcome = _outcome(json.dumps(value), "", bundled)
    if isinstance(outcome, UserError):
        assert "\n" not in outcome.line("en")

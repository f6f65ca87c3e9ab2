"""Failures of things: what was missed, is none or is told wrongly, and where a picture shows it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from processing.laboratory.accuracy.road.road_pictures import FOUND, TRUE
from processing.laboratory.accuracy.road.thing_failures import (
    TrueAndFound,
    paint_thing,
    thing_failures,
)
from processing.scoring.features.mapped_features import MappedFeature, MappedFile

ORIGIN = np.array([-12_000.0, -36_000.0, 20.0])


def _file(*poles: tuple[float, dict[str, object]]) -> MappedFile:
    features = tuple(
        MappedFeature(number, "point", ORIGIN[None] + np.array([[east, 0.0, 0.0]]), facts)
        for number, (east, facts) in enumerate(poles, 1)
    )
    return MappedFile(Path("poles.geojson"), "EPSG:6677", features)


def test_each_failure_is_told_once_and_what_no_point_shows_is_none() -> None:
    truth = _file(
        (0.0, {"type": "street_light", "points": 90}),
        (10.0, {"type": "bollard", "points": 60}),
        (20.0, {"type": "sign_pole", "points": 3}),
        (30.0, {"type": "banner", "points": 40}),
    )
    result = _file(
        (0.1, {"type": "sign_pole", "confidence": 0.9}),
        (30.0, {"type": "other", "confidence": 0.8}),
        (40.0, {"type": "bollard", "confidence": 0.6}),
    )
    told = [(one.what, one.type, one.detail) for one in thing_failures("poles", "", result, truth)]
    assert told == [
        ("missed", "bollard", "60 points"),
        ("false", "bollard", "confidence 0.60"),
        ("wrong", "street_light", "sign_pole for street_light"),
    ]


def test_a_picture_shows_the_points_and_what_is_true_and_found() -> None:
    truth = _file((0.0, {"type": "bollard", "points": 90}))
    missed = next(thing_failures("poles", "a street", _file(), truth))
    heights = np.linspace(0.0, 1.0, 200)
    post = ORIGIN + np.column_stack([np.full(200, 0.05), np.zeros(200), heights])
    things = TrueAndFound(ORIGIN[None], ORIGIN[None] + np.array([[0.6, 0.0, 0.0]]))
    picture = paint_thing(missed, post, things)
    colours = {tuple(one) for one in picture.reshape(-1, 3).tolist()}
    assert {TRUE, FOUND} <= colours
    bare = paint_thing(missed, post[:0], things)
    assert (picture != bare).any()
    assert bare.shape == picture.shape

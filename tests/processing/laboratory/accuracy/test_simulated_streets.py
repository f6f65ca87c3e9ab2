"""Simulated recordings measured from their points, on shapes whose values are known."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from processing.laboratory.accuracy.disturbed_truths import DISTURBANCES, score_disturbed
from processing.laboratory.accuracy.simulated_streets import (
    RecordedCloud,
    curb_heights,
    plate_distances,
    pulse_rate,
    trunk_diameters,
)
from processing.laboratory.simulate.scanning.delivered_files import DeliveredPoints, PointFile

_CRS = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::6677"}}


def _write(path: Path, members: list[tuple[str, Any, dict[str, Any]]]) -> None:
    features = [
        {
            "type": "Feature",
            "geometry": {"type": shape, "coordinates": positions},
            "properties": {"confidence": 1.0, "status": "candidate", **facts},
        }
        for shape, positions, facts in members
    ]
    text = json.dumps({"type": "FeatureCollection", "crs": _CRS, "features": features})
    path.write_text(text, encoding="utf-8")


def _cloud(xyz: np.ndarray, label: int, instance: int) -> RecordedCloud:
    count = len(xyz)
    return RecordedCloud(xyz, np.full(count, label, np.uint8), np.full(count, instance, np.int32))


def test_a_step_is_measured_from_the_points_beside_it(tmp_path: Path) -> None:
    """A road that falls by 6 % to a curb of 15 cm whose points lie 2 mm too high on top."""
    x, y = (one.ravel() for one in np.meshgrid(np.arange(0, 4, 0.02), np.arange(-0.5, 0.5, 0.01)))
    z = np.where(y < 0, -0.06 * (y + 0.0), 0.152)
    edges = {"upper": (0.0, 0.15), "lower": (0.0, 0.0)}
    sections = [{"u0": 0.0, "u1": 2.0, "points": 9, "covered": 1.0, "in_span": True}]
    members = [
        ("LineString", [[0.5 * k, across, high] for k in range(9)],
         {"kind": "curb", "edge": edge, "run": 1, "type": "curb", "sections": sections})
        for edge, (across, high) in edges.items()
    ]  # fmt: skip
    _write(tmp_path / "curbs.geojson", members)
    found = curb_heights(_cloud(np.column_stack([x, y, z]), 11, 1), tmp_path)
    assert found.count == 1
    assert found.median == pytest.approx(0.002, abs=1e-6)


def test_a_trunk_is_measured_by_a_circle(tmp_path: Path) -> None:
    angles = np.linspace(0, 2.6, 200)
    ring = np.column_stack([5 + 0.1 * np.cos(angles), 7 + 0.1 * np.sin(angles), angles * 0 + 1.2])
    facts = {"kind": "tree", "instance": 3, "arc_deg": 150.0, "stems": 1, "dbh_m": 0.19}
    _write(tmp_path / "trees.geojson", [("Point", [5.0, 7.0, 0.0], facts)])
    found = trunk_diameters(_cloud(ring, 66, 3), tmp_path)
    assert found.median == pytest.approx(0.01, abs=1e-6)


def test_a_plate_is_measured_along_its_normal(tmp_path: Path) -> None:
    """A plate that faces north, its points 3 mm before it."""
    random = np.random.default_rng(2)
    xyz = np.column_stack(
        [random.uniform(-0.3, 0.3, 400), np.full(400, 0.003), random.uniform(1.7, 2.3, 400)]
    )
    facts = {"kind": "sign", "instance": 4, "facing_deg": 0.0, "front_points": 400}
    _write(tmp_path / "signs.geojson", [("Point", [0.0, 0.0, 2.0], facts)])
    away, turned = plate_distances(_cloud(xyz, 65, 4), tmp_path)
    assert away.median == pytest.approx(0.003, abs=1e-9)
    assert turned.median == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("rate_hz", [300_000.0, 550_000.0, 1_016_000.0])
def test_the_rate_is_found_in_times_of_adjusted_gps(tmp_path: Path, rate_hz: float) -> None:
    random = np.random.default_rng(4)
    pulses = np.flatnonzero(random.random(300_000) < 0.6)
    ones = np.ones(pulses.size, np.uint8)
    with PointFile(tmp_path / "one.laz", np.zeros(3)) as file:
        file.write(
            DeliveredPoints(
                np.zeros((pulses.size, 3)),
                3.9e8 + pulses / rate_hz,
                ones.astype(np.uint16),
                ones,
                ones,
                1,
            )
        )
    assert pulse_rate(tmp_path / "one.laz") == pytest.approx(rate_hz, rel=2e-6)


def test_scores_of_disturbed_truths_fall(tmp_path: Path) -> None:
    lines = ("wires", "markings", "barriers", "walls", "edges", "covers", "clearance")
    for name in ("curbs", "gutters", "trees", "signs", *lines):
        _write(tmp_path / f"{name}.geojson", [])
    facts = {"kind": "pole", "type": "street_light", "height_m": 8.0, "diameter_m": 0.15}
    poles = [("Point", [30.0 * k, 2.0 * (k % 2), 0.0], facts) for k in range(6)]
    _write(tmp_path / "poles.geojson", poles)
    rows = list(score_disturbed(tmp_path))
    scores = dict(zip(DISTURBANCES, map(float, rows[1][2:]), strict=True))
    assert scores["as it is"] == scores["30 cm aside"] == 1.0
    assert scores["3 m aside"] == 0.0
    assert scores["each third left out"] == pytest.approx(0.8)

"""Truth of areas of plants: outlines about what grows, and what points show of them."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from processing.laboratory.simulate.assembly.street import BuiltSection, Street
from processing.laboratory.simulate.plant_evidence import PlantEvidence
from processing.laboratory.simulate.scanning.returns import Returns
from processing.laboratory.simulate.scene.things import TrueFeature
from processing.laboratory.simulate.street.styles import URBAN


@pytest.fixture(scope="module")
def sections() -> list[BuiltSection]:
    street = Street(9541, URBAN, 90.0)
    return [street.section(row) for row in street.within(0.0, 90.0)]


def areas_of(section: BuiltSection, type_: str) -> list[TrueFeature]:
    return [
        one for one in section.truth if one.file == "plant_areas" and one.facts["type"] == type_
    ]


def test_outlines_are_valid_and_as_large_as_they_say(sections: list[BuiltSection]) -> None:
    types = set()
    for section in sections:
        for one in [one for one in section.truth if one.file == "plant_areas"]:
            types.add(one.facts["type"])
            assert one.xyz[0] == pytest.approx(one.xyz[-1])
            if one.facts["type"] in ("hedge", "planting_strip"):
                area = shapely.Polygon(one.xyz[:, :2]).area
                assert area == pytest.approx(one.facts["area_m2"], rel=0.02, abs=0.02)
    assert types == {"hedge", "lawn", "other", "planting_strip"}


def test_a_hedge_lies_within_its_outline(sections: list[BuiltSection]) -> None:
    found = 0
    for section in sections:
        mesh = section.mesh
        for one in areas_of(section, "hedge"):
            corners = mesh.vertices[mesh.triangles[mesh.instance == one.instance]].reshape(-1, 3)
            outline = shapely.Polygon(one.xyz[:, :2]).buffer(0.12)
            assert np.mean(shapely.contains_xy(outline, *corners[:, :2].T)) > 0.95
            found += 1
    assert found > 3


def test_points_and_covered_cells_of_an_area_are_counted() -> None:
    ring = np.array([[0, 0, 0], [4, 0, 0], [4, 1, 0], [0, 1, 0], [0, 0, 0]], np.float64)
    facts = {"type": "lawn"}
    lawn = TrueFeature("plant_areas", "Polygon", ring, facts, 0, 0.0)
    evidence = PlantEvidence([lawn])
    x, y = np.meshgrid(np.arange(-1.0, 2.0, 0.1) + 0.05, np.arange(-1.0, 2.0, 0.1) + 0.05)
    xyz = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    evidence.count(_returns(xyz, 3))
    evidence.count(_returns(xyz, 11))
    assert evidence.of(lawn) == (200, 0.5)
    assert PlantEvidence([]).of(lawn) == (0, 0.0)


def _returns(xyz: np.ndarray, label: int) -> Returns:
    count = len(xyz)
    ones, none = np.ones(count, np.uint8), np.zeros(count, np.int64)
    labels = np.full(count, label, np.uint8)
    return Returns(none, np.zeros(count), xyz, np.ones(count), ones, ones, labels, none)

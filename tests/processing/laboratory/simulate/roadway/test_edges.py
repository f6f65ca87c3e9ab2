"""Truth of the carriageway's edges lies where its asphalt ends, and says what lies outside."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import BuiltSection, Street
from processing.laboratory.simulate.edge_evidence import EdgeEvidence
from processing.laboratory.simulate.scanning.returns import Returns
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import TrueFeature
from processing.laboratory.simulate.street.plan import plans_of
from processing.laboratory.simulate.street.styles import RURAL, URBAN, Style

ROAD = 11


def sections_of(style: Style, seed: int, *, is_flush: bool) -> list[BuiltSection]:
    street = Street(seed, style, 60.0, is_flush=is_flush)
    return [street.section(row) for row in street.within(0.0, 60.0)]


def edges_of(section: BuiltSection) -> list[TrueFeature]:
    return [one for one in section.truth if one.file == "edges"]


def asked(section: BuiltSection) -> list[TrueFeature]:
    return [one for one in edges_of(section) if one.facts["type"] != "other"]


@pytest.mark.parametrize(("style", "seed"), [(URBAN, 3), (RURAL, 5)])
def test_sides_without_curbs_have_edges_whose_pieces_are_a_metre_long(
    style: Style, seed: int
) -> None:
    found = [one for section in sections_of(style, seed, is_flush=True) for one in asked(section)]
    assert found
    assert {str(one.facts["type"]) for one in found} <= {"walk", "soil", "grass", "gutter"}
    for one in found:
        steps = np.hypot(*np.diff(one.xyz[:, :2], axis=0).T)
        assert steps.min() > 0.3
        assert steps.max() <= 1.01


def test_asphalt_lies_on_one_side_of_an_edge_and_none_on_the_other() -> None:
    for section in sections_of(URBAN, 3, is_flush=True):
        mesh = section.mesh
        road = mesh.vertices[np.unique(mesh.triangles[mesh.label == ROAD])]
        for one in asked(section):
            if one.facts["type"] == "gutter":
                continue  # what covers it counts as road
            away = np.hypot(*(road[:, None, :2] - one.xyz[None, :, :2]).transpose(2, 0, 1))
            assert away.min(axis=0).max() < 1.0


def test_what_is_drawn_for_sides_without_curbs_changes_no_other_street() -> None:
    usual, flush = (plans_of(3, URBAN, 60.0, is_flush=one) for one in (False, True))
    assert [one.start_m for one in usual] == [one.start_m for one in flush]
    assert [one.lane_m for one in usual] == [one.lane_m for one in flush]
    assert all(one.side(side).flush == "none" for one in usual for side in (-1, 1))
    assert any(one.side(side).flush != "none" for one in flush for side in (-1, 1))


def returns_at(xyz: Floats, label: int) -> Returns:
    whole = np.zeros(len(xyz), np.int64)
    return Returns(
        pulse=whole,
        time_s=np.zeros(len(xyz)),
        xyz=xyz,
        strength=np.zeros(len(xyz)),
        number=np.ones(len(xyz), np.uint8),
        count=np.ones(len(xyz), np.uint8),
        label=np.full(len(xyz), label, np.uint8),
        evidence=whole,
    )


def test_an_edge_is_shown_as_well_as_its_worse_side() -> None:
    line = np.column_stack([np.arange(4.0), np.zeros(4), np.zeros(4)])
    edge = TrueFeature("edges", "LineString", line, {"type": "grass"}, 0, 0.0)
    seen = EdgeEvidence([edge])
    left = np.array([[0.5, 0.1, 0.0], [0.6, 0.2, 0.1], [1.5, 0.1, 0.0], [2.5, 0.1, 0.0]])
    right = np.array([[0.5, -0.1, 0.0], [1.5, -0.2, 0.0], [1.6, -0.1, 0.0], [2.5, -0.5, 0.0]])
    seen.count(returns_at(np.concatenate([left, right]), 2))
    seen.count(returns_at(left, 5))  # leaves above it
    assert seen.of(edge).tolist() == [1, 1, 0]

"""Truth of walls and buildings lies on what was built."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import BuiltSection, Street
from processing.laboratory.simulate.scanning.returns import Returns
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import TrueFeature
from processing.laboratory.simulate.street.styles import HIGHWAY, RURAL, URBAN, Style
from processing.laboratory.simulate.wall_evidence import WallEvidence

_TOWNS, _SLOPES = (URBAN, 21), (RURAL, 9304)


def built_sections(style: Style, seed: int) -> list[BuiltSection]:
    street = Street(seed, style, 60.0)
    return [street.section(row) for row in street.within(0.0, 60.0)]


def walls_of(section: BuiltSection) -> list[TrueFeature]:
    return [one for one in section.truth if one.file == "walls"]


def off_faces(places: Floats, vertices: Floats) -> Floats:
    """How far places are from the nearest vertex in plan."""
    away = np.hypot(*(places[:, None, :2] - vertices[None, :, :2]).transpose(2, 0, 1))
    return np.asarray(away.min(axis=1))


@pytest.mark.parametrize(("style", "seed"), [_TOWNS, _SLOPES, (HIGHWAY, 9306)])
def test_ends_of_walls_and_corners_of_buildings_are_vertices_of_their_bodies(
    style: Style, seed: int
) -> None:
    for section in built_sections(style, seed):
        for one in walls_of(section):
            own = np.unique(section.mesh.triangles[section.mesh.instance == one.instance])
            if own.size:  # walls of the ground have no triangles of their own
                ends = one.xyz[[0, -1]]
                assert off_faces(ends, section.mesh.vertices[own]).max() < 0.02
            assert np.hypot(*np.diff(one.xyz[:, :2], axis=0).T).max() < 2.1


def test_towns_have_walls_and_buildings_and_slopes_have_retaining_walls() -> None:
    types = {one.facts["type"] for section in built_sections(*_TOWNS) for one in walls_of(section)}
    assert {"wall", "building"} <= types
    types = {one.facts["type"] for section in built_sections(*_SLOPES) for one in walls_of(section)}
    assert "retaining" in types


def returns_at(xyz: Floats, label: int) -> Returns:
    count = len(xyz)
    whole = np.zeros(count, np.int64)
    return Returns(
        pulse=whole,
        time_s=np.zeros(count),
        xyz=xyz,
        strength=np.zeros(count),
        number=np.ones(count, np.uint8),
        count=np.ones(count, np.uint8),
        label=np.full(count, label, np.uint8),
        evidence=whole,
    )


def test_points_on_a_leaning_face_are_counted_by_piece_of_its_foot() -> None:
    foot = np.column_stack([np.arange(4.0), np.zeros(4), np.zeros(4)])
    facts = {"type": "retaining", "height_m": 2.0, "lean": 0.1}
    wall = TrueFeature("walls", "LineString", foot, facts, 1, 0.0)
    seen = WallEvidence([wall])
    on = np.array([[0.5, 0.1, 1.0], [0.6, 0.2, 2.0], [2.5, 0.05, 0.5]])
    off = np.array([[0.5, 0.0, 1.5], [1.5, 0.05, 0.05], [1.5, 0.3, 2.5], [9.0, 0.1, 1.0]])
    seen.count(returns_at(np.concatenate([on, off]), 1))
    seen.count(returns_at(on, 5))  # leaves before it
    assert seen.of(wall).tolist() == [2, 0, 1]

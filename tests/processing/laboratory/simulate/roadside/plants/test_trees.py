"""Trees of known girths: a tape round the mesh tells what the truth tells."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.roadside.plants.trunks import (
    Stem,
    StemOptions,
    girth_of_stem_m,
    stem_of,
    stem_shape,
    tape_girth_m,
)
from processing.laboratory.simulate.scene.mesh import Mesh
from processing.laboratory.simulate.scene.things import TrueFeature
from processing.laboratory.simulate.street.styles import RURAL, URBAN

TRUNK = 66
SOIL_OF_PITS_M = 0.035


@pytest.fixture(scope="module")
def trees() -> list[tuple[TrueFeature, Mesh, float]]:
    """Trees of a street, their section's mesh and the ground's height at their feet."""
    street = Street(3, URBAN, 150.0)
    found = []
    for row in street.within(-30.0, 150.0):
        built = street.section(row)
        ground = street.bare_section(row).ground
        for tree in built.truth:
            if tree.file == "trees":
                offset = _offset(street, tree)
                height = float(ground.height(tree.chainage_m, offset))
                found.append((tree, built.mesh, height))
    assert len(found) > 5
    return found


def _offset(street: Street, tree: TrueFeature) -> float:
    heading = float(street.alignment.heading(tree.chainage_m))
    centre = street.alignment.at(tree.chainage_m, 0.0, 0.0)
    return float((tree.xyz[0] - centre)[:2] @ [-np.sin(heading), np.cos(heading)])


def _stem(ratio: float, lean: tuple[float, float]) -> Stem:
    levels = np.linspace(-0.2, 3.0, 17)
    path = np.column_stack([np.outer(np.maximum(levels, -0.2), lean), levels])
    return Stem(path, np.full(17, 0.1), ratio, 0.4, np.zeros((17, 36)))


def test_a_tape_round_an_upright_ellipse_shows_its_circumference() -> None:
    stem = _stem(0.85, (0.0, 0.0))
    a, b = 0.1, 0.085
    ramanujan = np.pi * (3 * (a + b) - np.sqrt((3 * a + b) * (a + 3 * b)))
    assert girth_of_stem_m(stem, stem_shape(stem)[0]) == pytest.approx(ramanujan, rel=0.003)


def test_a_tape_round_a_leaning_stem_lies_square_to_it() -> None:
    upright, leaning = _stem(1.0, (0.0, 0.0)), _stem(1.0, (0.14, 0.0))
    straight = girth_of_stem_m(upright, stem_shape(upright)[0])
    assert girth_of_stem_m(leaning, stem_shape(leaning)[0]) < straight
    assert girth_of_stem_m(leaning, stem_shape(leaning)[0]) == pytest.approx(straight, rel=0.01)


def test_each_sector_of_the_breast_band_faces_its_ten_degrees() -> None:
    stem = stem_of(np.random.default_rng(4), StemOptions(0.12, 5.0, 0.4, (0.02, 0.0)))
    (vertices, faces), pieces = stem_shape(stem)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outwards = corners.mean(axis=1)[:, :2]
    is_breast = (pieces >= 1) & (pieces <= 36)
    axis = stem.at(1.2)[:2]
    assert ((outwards[is_breast] - axis) * normals[is_breast, :2]).sum(axis=1).min() > 0
    turn = np.rad2deg(np.arctan2(normals[:, 1], normals[:, 0])) % 360
    np.testing.assert_array_equal(pieces[is_breast], turn[is_breast] // 10 + 1)
    assert len(np.unique(pieces[is_breast])) > 28


def test_the_girth_of_every_tree_is_what_a_tape_shows_on_its_mesh(
    trees: list[tuple[TrueFeature, Mesh, float]],
) -> None:
    checked = 0
    for tree, mesh, _ in trees:
        if tree.facts["stems"] != 1:
            continue
        is_trunk = (mesh.instance == tree.instance) & (mesh.piece >= 1) & (mesh.piece <= 37)
        trunk = mesh.vertices[mesh.triangles[is_trunk]]
        band = trunk.reshape(-1, 3)[
            np.abs(trunk.reshape(-1, 3)[:, 2] - tree.xyz[0, 2] - 1.2) < 0.11
        ]
        levels = np.unique(band[:, 2].round(6))
        rings = [np.unique(band[np.abs(band[:, 2] - z) < 1e-5].round(7), axis=0) for z in levels]
        low, middle, high = (ring.mean(axis=0) for ring in rings)
        shape = trunk.reshape(-1, 3), np.arange(trunk.size // 3).reshape(-1, 3)
        girth = tape_girth_m(shape, middle, high - low)
        assert girth == pytest.approx(tree.facts["girth_m"], abs=0.001)
        assert tree.facts["dbh_m"] == pytest.approx(girth / np.pi, abs=0.001)
        checked += 1
    assert checked > 3


def test_trees_stand_on_the_ground_and_reach_their_height(
    trees: list[tuple[TrueFeature, Mesh, float]],
) -> None:
    for tree, mesh, ground in trees:
        assert ground - 0.02 < tree.xyz[0, 2] < ground + SOIL_OF_PITS_M
        positions = mesh.vertices[np.unique(mesh.triangles[mesh.instance == tree.instance])]
        assert positions[:, 2].max() - tree.xyz[0, 2] == pytest.approx(tree.facts["height_m"])
        assert positions[:, 2].min() < tree.xyz[0, 2] - 0.1


def test_no_two_trees_grow_into_each_other(
    trees: list[tuple[TrueFeature, Mesh, float]],
) -> None:
    feet = np.array([tree.xyz[0] for tree, _, _ in trees])
    gaps = np.linalg.norm(feet[:, None] - feet[None], axis=2) + 9 * np.eye(len(feet))
    assert gaps.min() > 0.5


def test_trees_of_woods_are_in_the_truth_and_not_asked_for() -> None:
    street = Street(763, RURAL, 60.0)
    feet = []
    for row in street.within(0.0, 60.0):
        built = street.section(row)
        known = {one.instance for one in built.truth if one.file == "trees"}
        assert known == {one.instance for one in built.things if one.kind == "tree"}
        feet += [one for one in built.truth if one.file == "trees"]
    far = [one for one in feet if one.facts.get("in_span") is False]
    assert len(far) > 5
    assert all(one.facts["dbh_m"] for one in far)

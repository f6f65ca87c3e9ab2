"""Tree pits: they lie in the walk, trees stand on their soil, edges are those of the mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.roadside.plants.street_trees import add_street_trees
from processing.laboratory.simulate.roadside.plants.tree_pits import (
    PitStyle,
    add_pit,
    pit_habit,
    take_pit,
)
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePosition, FreePositions
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import URBAN

HABIT = PitStyle(
    is_round=False, long_m=1.2, wide_m=1.0, gap_m=0.2, stone_m=0.1, high_m=0.1, soil_m=0.02,
    stone=Material.CONCRETE, filling=Material.SOIL, has_grating=False,
)  # fmt: skip
SEED_WITH_PITS = 14


def _walk() -> tuple[StreetSection, int, FreePosition]:
    """A section with a wide walk, and a place for a pit in it."""
    street = Street(SEED_WITH_PITS, URBAN, 160.0)
    for row in street.within(0.0, 160.0):
        section = street.bare_section(row)
        for side in (1, -1):
            if pit_habit(section, side) is None or side in section.plan.junctions:
                continue
            away = HABIT.middle_m(FreePositions(section).near_m(side))
            for at in np.arange(section.plan.start_m + 2, section.plan.end_m - 2, 0.5):
                spot = FreePosition(float(at), side * away)
                if take_pit(FreePositions(section), spot, HABIT):
                    return section, side, spot
    raise ValueError("no walk for a pit")


def _nearest(positions: Floats, vertices: Floats) -> float:
    gaps = np.linalg.norm(positions[:, None] - vertices[None], axis=2)
    return float(gaps.min(axis=1).max())


def _built(habit: PitStyle) -> tuple[StreetSection, FreePosition, SectionBuilder]:
    section, _, spot = _walk()
    built = SectionBuilder(1)
    add_pit(section, built, spot, habit, np.random.default_rng(3))
    return section, spot, built


def test_each_side_of_a_pit_is_a_run_that_faces_outwards() -> None:
    section, spot, built = _built(HABIT)
    mesh = built.mesh.mesh()
    middle = section.position(spot.chainage_m, spot.offset_m)
    uppers = [one for one in built.truth if one.facts["edge"] == "upper"]
    assert len(uppers) == 4
    assert len(built.truth) == 8
    for upper in uppers:
        lower = next(
            one
            for one in built.truth
            if one.facts["run"] == upper.facts["run"] and one.facts["edge"] == "lower"
        )
        assert upper.facts["role"] == "edging"
        assert upper.facts["type"] == "curb"
        assert upper.facts["height_m"] == pytest.approx(0.1, abs=0.01)
        own = mesh.triangles[mesh.instance == upper.instance]
        for line in (upper.xyz, lower.xyz):
            assert _nearest(line, mesh.vertices[np.unique(own)]) < 1e-4
        stones = mesh.vertices[own].mean(axis=1)
        away = np.linalg.norm((lower.xyz.mean(axis=0) - middle)[:2])
        assert away > np.linalg.norm((stones.mean(axis=0) - middle)[:2])


def test_a_round_pit_is_one_run() -> None:
    _, _, built = _built(replace(HABIT, is_round=True, long_m=1.0))
    assert len(built.truth) == 2
    assert built.truth[0].facts["length_m"] == pytest.approx(np.pi, rel=0.02)


def test_low_edging_is_no_curb_of_the_truth() -> None:
    for high in (0.003, 0.025):
        _, _, built = _built(replace(HABIT, high_m=high, soil_m=0.004))
        assert not built.truth


def test_gratings_lie_over_the_soil_and_leave_room_for_the_trunk() -> None:
    section, spot, built = _built(replace(HABIT, high_m=0.003, soil_m=0.004, has_grating=True))
    mesh = built.mesh.mesh()
    bars = mesh.vertices[np.unique(mesh.triangles[mesh.material == Material.GRATING])]
    soil = mesh.vertices[np.unique(mesh.triangles[mesh.material == Material.SOIL])]
    assert bars[:, 2].max() > soil[:, 2].max()
    middle = section.position(spot.chainage_m, spot.offset_m)
    assert np.linalg.norm((bars - middle)[:, :2], axis=1).min() > 0.15


def test_a_pit_takes_its_place() -> None:
    section, side, spot = _walk()
    positions = FreePositions(section)
    assert take_pit(positions, spot, HABIT)
    assert not take_pit(positions, spot, HABIT)
    corner = FreePosition(spot.chainage_m + 0.59, spot.offset_m + side * 0.49)
    assert not positions.is_free(corner, 0.03)


def test_trees_stand_in_their_pits_on_the_soil() -> None:
    street = Street(SEED_WITH_PITS, URBAN, 160.0)
    found = 0
    for row in street.within(0.0, 160.0):
        section = street.bare_section(row)
        built = SectionBuilder(1)
        add_street_trees(FreePositions(section), built)
        if not any(one.kind == "tree_pit" for one in built.things):
            continue
        mesh = built.mesh.mesh()
        pits = {one.instance for one in built.things if one.kind == "tree_pit"}
        middles = np.array([
            mesh.vertices[np.unique(mesh.triangles[mesh.instance == one])].mean(axis=0)
            for one in sorted(pits)
        ])  # fmt: skip
        for tree in (one for one in built.truth if one.file == "trees"):
            away = np.linalg.norm((middles - tree.xyz[0])[:, :2], axis=1)
            if away.min() < 0.4:
                assert abs(float(middles[away.argmin(), 2]) - tree.xyz[0, 2]) < 0.02
                found += 1
    assert found

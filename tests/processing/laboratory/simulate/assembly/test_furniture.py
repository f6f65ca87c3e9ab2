"""What stands beside the road stands apart, off the road, and looks the right way."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.roadside.overhead_signs import add_overhead_signs
from processing.laboratory.simulate.roadside.signals import add_signals, has_signals
from processing.laboratory.simulate.scene.mesh import Mesh
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.free_positions import (
    FreePosition,
    FreePositions,
    free_from_m,
)
from processing.laboratory.simulate.street.neighbours import neighbour
from processing.laboratory.simulate.street.plan import LEFT, RIGHT
from processing.laboratory.simulate.street.styles import HIGHWAY, URBAN

BREAST_M = 1.2
TALL = ("utility_pole", "street_light", "sign_pole", "signal_pole", "mirror_pole", "arm_pole")


@pytest.fixture(scope="module")
def street() -> Street:
    """A street in a town."""
    return Street(9, URBAN, 110.0)


def _standing(street: Street) -> list[tuple[TrueFeature, Mesh]]:
    return [
        (one, street.section(row).mesh)
        for row in street.within(0.0, 110.0)
        for one in street.section(row).truth
        if one.file in ("poles", "trees")
    ]


def test_a_place_is_given_away_once(street: Street) -> None:
    row = next(i for i in street.within(0.0, 110.0) if not street.plans[i].junctions)
    section = street.bare_section(row)
    positions = FreePositions(section)
    away = positions.near_m(LEFT) + 2.0
    at = np.linspace(section.plan.start_m + 1, section.plan.end_m - 1, 30)
    taken = [one for one in at if positions.take(FreePosition(float(one), away), 0.2)]
    assert taken
    assert not any(positions.take(FreePosition(float(one), away), 0.2) for one in taken)


def test_nothing_may_stand_on_the_road_or_on_curbs_and_lids(street: Street) -> None:
    for row in street.within(0.0, 110.0):
        section = street.bare_section(row)
        positions = FreePositions(section)
        middle = (section.plan.start_m + section.plan.end_m) / 2
        for side in (LEFT, RIGHT):
            edge = free_from_m(section.plan.side(side))
            for away in (0.5, edge - 1.0, edge):
                assert not positions.is_free(FreePosition(middle, side * away), 0.05)


def test_a_plan_knows_its_neighbours_without_building_them(street: Street) -> None:
    for row in street.within(0.0, 110.0):
        section = street.bare_section(row)
        assert neighbour(section, 1) == street.plans[row + 1]
        assert neighbour(section, -1) == street.plans[row - 1]


def test_feet_of_poles_and_trees_are_apart(street: Street) -> None:
    standing = [one for one, _ in _standing(street)]
    assert len(standing) > 10
    feet = np.array([one.xyz[0, :2] for one in standing])
    gaps = np.linalg.norm(feet[:, None] - feet[None], axis=2) + 9 * np.eye(len(feet))
    assert gaps.min() > 0.12


def test_poles_are_as_thick_at_breast_height_as_the_truth_says(street: Street) -> None:
    checked = 0
    for pole, mesh in _standing(street):
        if pole.file != "poles" or pole.facts["type"] not in TALL:
            continue
        shaft = mesh.vertices[mesh.triangles[(mesh.instance == pole.instance) & (mesh.piece == 1)]]
        level = pole.xyz[0, 2] + BREAST_M
        edges = np.concatenate([shaft[:, [0, 1]], shaft[:, [1, 2]], shaft[:, [2, 0]]])
        low, high = edges[:, 0], edges[:, 1]
        crosses = (low[:, 2] - level) * (high[:, 2] - level) < 0
        share = (level - low[crosses, 2]) / (high - low)[crosses, 2]
        ring = low[crosses] + share[:, None] * (high - low)[crosses]
        middle = (ring[:, :2].max(axis=0) + ring[:, :2].min(axis=0)) / 2
        wide = 2 * np.linalg.norm(ring[:, :2] - middle, axis=1).mean()
        assert wide == pytest.approx(pole.facts["diameter_m"], rel=0.03)
        checked += 1
    assert checked > 5


def test_lights_stand_next_to_junctions_that_have_them() -> None:
    found = 0
    for seed in (3, 9):
        made = Street(seed, URBAN, 250.0)
        for row in made.within(-100.0, 250.0):
            section = made.bare_section(row)
            built = SectionBuilder(1)
            add_signals(FreePositions(section), built)
            beside = [neighbour(section, step) for step in (-1, 1)]
            if built.things:
                assert any(one is not None and has_signals(seed, one) for one in beside)
                found += 1
    assert found >= 1


def test_guide_signs_over_the_road_leave_five_metres_free() -> None:
    made = Street(4, HIGHWAY, 900.0)
    found = 0
    for row in made.within(0.0, 900.0):
        section = made.bare_section(row)
        built = SectionBuilder(1)
        add_overhead_signs(FreePositions(section), built)
        for sign in built.truth:
            if sign.file != "signs":
                continue
            road = float(made.alignment.carriageway_height(sign.chainage_m, 0.0))
            low = sign.xyz[0, 2] - float(str(sign.facts["plate_height_m"])) / 2
            assert low > road + 4.3
            found += 1
    assert found >= 1


def test_the_plate_with_a_junctions_name_does_not_reach_into_its_lights() -> None:
    plates = 0
    for seed in (208, 210, 213):
        made = Street(seed, URBAN, 250.0)
        for row in made.within(-100.0, 250.0):
            built = SectionBuilder(1)
            add_signals(FreePositions(made.bare_section(row)), built)
            mesh = built.mesh.mesh()
            lights = [one.instance for one in built.things if one.kind == "signal"]
            used = mesh.vertices[np.unique(mesh.triangles[np.isin(mesh.instance, lights)])]
            for plate in (one for one in built.truth if one.file == "signs"):
                plates += 1
                high = used[used[:, 2] > plate.xyz[0, 2] - 0.2]
                away = np.linalg.norm(high[:, :2] - plate.xyz[0, :2], axis=1).min()
                wide = plate.facts["size_m"]
                assert isinstance(wide, float)
                assert away > wide / 2
    assert plates > 0

"""Parked vehicles: on their wheels, in nobody's way, the same whoever builds the section."""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scene.mesh import Mesh, box
from processing.laboratory.simulate.scene.things import SectionBuilder, Thing
from processing.laboratory.simulate.street.plan import SIDES
from processing.laboratory.simulate.street.styles import URBAN
from processing.laboratory.simulate.traffic.parked_vehicles import add_parked
from processing.laboratory.simulate.traffic.parking import has_parking, parking_positions

SEED = next(seed for seed in range(50) if all(has_parking(seed, URBAN, side) for side in SIDES))
STREET = Street(SEED, URBAN, 300.0)


def parked_in(row: int, built: SectionBuilder | None = None) -> tuple[Mesh, list[Thing]]:
    built = built or SectionBuilder(1)
    add_parked(STREET.bare_section(row), built)
    return built.mesh.mesh(), built.things


def rows_with_parking() -> list[int]:
    return [row for row in STREET.within(0, 300) if parked_in(row)[1]]


def test_parked_things_stand_on_the_ground_at_the_edge() -> None:
    seen = 0
    for row in rows_with_parking():
        mesh, things = parked_in(row)
        section = STREET.bare_section(row)
        lane = section.plan.lane_offset_m(0)
        for one in things:
            positions = mesh.vertices[mesh.triangles[mesh.instance == one.instance].ravel()]
            middle = positions.mean(axis=0)
            centre = section.alignment.at(section.alignment.chainages, 0.0, 0.0)[:, :2]
            away = np.linalg.norm(centre - middle[:2], axis=1).min()
            assert away > lane + 1.3
            if one.kind != "bicycle":
                seen += 1
                near = np.linalg.norm(centre - middle[:2], axis=1).argmin()
                s = float(section.alignment.chainages[near])
                sides = section.position(s, np.array([-away, away]))
                ground = sides[np.linalg.norm(sides[:, :2] - middle[:2], axis=1).argmin(), 2]
                assert abs(positions[:, 2].min() - ground) < 0.6
    assert seen > 4


def test_nothing_is_parked_where_something_stands() -> None:
    row = rows_with_parking()[0]
    _, free = parked_in(row)
    built = SectionBuilder(1)
    section = STREET.bare_section(row)
    for one in parking_positions(SEED, section.plan):
        post = section.position(one.chainage_m, one.offset_m)
        low, high = post - np.array([0.05, 0.05, 0.5]), post + np.array([0.05, 0.05, 3.0])
        built.mesh.add(box(low.tolist(), high.tolist()), 0, 66, 0)
    _, hindered = parked_in(row, built)
    assert free
    assert not hindered


def test_the_same_section_parks_the_same() -> None:
    row = rows_with_parking()[0]
    one, other = parked_in(row)[0], parked_in(row)[0]
    np.testing.assert_array_equal(one.vertices, other.vertices)


def test_no_vehicle_is_parked_where_a_side_street_meets_the_road() -> None:
    for plan in STREET.plans:
        for position in parking_positions(SEED, plan):
            assert position.side not in plan.junctions
            assert plan.start_m < position.chainage_m < plan.end_m

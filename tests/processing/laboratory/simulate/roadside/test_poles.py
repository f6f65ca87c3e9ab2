"""Poles stand on the ground and carry cables from section to section."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.roadside.pole_line import cable_ends, pole_line
from processing.laboratory.simulate.roadside.wires import hanging
from processing.laboratory.simulate.scene.mesh import Mesh
from processing.laboratory.simulate.scene.things import TrueFeature
from processing.laboratory.simulate.street.free_positions import free_from_m
from processing.laboratory.simulate.street.styles import RURAL, URBAN

WIRE, POLE, SHAFT = 14, 66, 1


@pytest.fixture(scope="module")
def street() -> Street:
    """A street in a town that has utility poles."""
    made = Street(3, URBAN, 150.0)
    assert pole_line(made.bare_section(8)).poles
    return made


def _rows(street: Street) -> range:
    return street.within(-20.0, 150.0)


def _poles(street: Street) -> list[tuple[TrueFeature, Mesh, int]]:
    return [
        (one, street.section(row).mesh, row)
        for row in _rows(street)
        for one in street.section(row).truth
        if one.file == "poles"
    ]


def test_feet_of_poles_lie_on_the_ground(street: Street) -> None:
    poles = _poles(street)
    assert len(poles) > 5
    for pole, _, row in poles:
        section = street.bare_section(row)
        foot = pole.xyz[0]
        beside = section.position(pole.chainage_m, np.linspace(-60, 60, 2001))
        nearest = beside[np.argmin(np.hypot(*(beside[:, :2] - foot[:2]).T))]
        assert foot[2] == pytest.approx(nearest[2], abs=0.05)


def test_poles_are_as_thick_and_high_as_the_truth_says(street: Street) -> None:
    for pole, mesh, _ in _poles(street):
        of_pole = (mesh.instance == pole.instance) & (mesh.piece == SHAFT)
        positions = mesh.vertices[np.unique(mesh.triangles[of_pole])]
        high = positions[:, 2].max() - pole.xyz[0, 2]
        assert high == pytest.approx(pole.facts["height_m"], abs=0.05)


def test_no_pole_stands_on_the_road_or_in_a_side_street(street: Street) -> None:
    for row in _rows(street):
        plan = street.plans[row]
        for pole in street.section(row).truth:
            if pole.file != "poles":
                continue
            centre = street.alignment.at(pole.chainage_m, 0.0, 0.0)[:2]
            away = float(np.hypot(*(pole.xyz[0, :2] - centre)))
            heading = street.alignment.heading(pole.chainage_m)
            left = np.array([-np.sin(heading), np.cos(heading)])
            side = 1 if (pole.xyz[0, :2] - centre) @ left > 0 else -1
            assert away > free_from_m(plan.side(side))
            assert side not in plan.junctions


def test_cables_of_neighbouring_sections_meet_on_their_pole(street: Street) -> None:
    line = pole_line(street.bare_section(8))
    joints = 0
    for before, pole in zip(line.poles, line.poles[1:], strict=False):
        if not -10 < before.spot.chainage_m < 110 or before.section == pole.section:
            continue
        ends = cable_ends(street.alignment, pole, line)
        for number in (before.section, pole.section):
            row = next(i for i, one in enumerate(street.plans) if one.index == number)
            mesh = street.section(row).mesh
            positions = mesh.vertices[np.unique(mesh.triangles[mesh.label == WIRE])]
            gaps = np.linalg.norm(positions[:, None] - ends[None], axis=2).min(axis=0)
            assert gaps.max() < 0.03
        joints += 1
    assert joints >= 1


@pytest.mark.parametrize("seed", range(6))
def test_cables_of_the_line_hang_high_enough_for_lorries(seed: int) -> None:
    made = Street(seed, URBAN, 60.0)
    line = pole_line(made.bare_section(8))
    for before, pole in zip(line.poles, line.poles[1:], strict=False):
        starts = cable_ends(made.alignment, before, line)
        ends = cable_ends(made.alignment, pole, line)
        span = float(np.linalg.norm(ends[0] - starts[0]))
        lowest = hanging(starts, ends, line.cables[:, 3] * (span / 30) ** 2)[..., 2].min()
        at = np.linspace(before.spot.chainage_m, pole.spot.chainage_m, 9)
        road = made.alignment.carriageway_height(at, pole.spot.offset_m)
        assert span > 50 or lowest > road.min() + 4.4


def test_a_section_is_the_same_whatever_is_built_first() -> None:
    forwards, backwards = Street(5, RURAL, 80.0), Street(5, RURAL, 80.0)
    rows = list(forwards.within(0.0, 80.0))
    for row in rows:
        forwards.section(row)
    for row in rows[::-1]:
        backwards.section(row)
    for row in rows:
        one, other = forwards.section(row), backwards.section(row)
        assert one.things == other.things
        np.testing.assert_array_equal(one.mesh.vertices, other.mesh.vertices)
        np.testing.assert_array_equal(one.mesh.triangles, other.mesh.triangles)

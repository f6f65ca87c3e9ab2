"""Fields and slopes: what lies on the land reaches into it and keeps off road and walk."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.border.land import add_land
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePositions
from processing.laboratory.simulate.street.plan import LEFT, RIGHT
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import HIGHWAY, RURAL

STREETS = [(0, RURAL), (1, RURAL), (6, RURAL), (3, RURAL), (7, RURAL), (5, HIGHWAY)]


def _sections() -> list[StreetSection]:
    streets = [Street(seed, style, 60.0) for seed, style in STREETS]
    return [one.bare_section(row) for one in streets for row in one.within(0.0, 60.0)]


@pytest.fixture(scope="module")
def built() -> list[tuple[StreetSection, SectionBuilder]]:
    made = []
    for section in _sections():
        one = SectionBuilder(1)
        add_land(FreePositions(section), one)
        made.append((section, one))
    return made


def test_every_kind_of_land_is_met(built: list[tuple[StreetSection, SectionBuilder]]) -> None:
    kinds = {thing.kind for _, one in built for thing in one.things}
    assert kinds == {"slope_frame", "wall", "fence", "ridges", "levee"}


def test_what_covers_the_land_stands_behind_the_verge(
    built: list[tuple[StreetSection, SectionBuilder]],
) -> None:
    for section, one in built:
        mesh = one.mesh.mesh()
        if not len(mesh.triangles):
            continue
        along = np.linspace(section.plan.start_m - 2, section.plan.end_m + 2, 300)
        centre = section.position(along, 0.0)[:, :2]
        away = np.array([np.linalg.norm(centre - xy, axis=1).min() for xy in mesh.vertices[:, :2]])
        least = min(
            band.inner_m
            for side in (LEFT, RIGHT)
            if (band := section.plan.side(side).band("outside")) is not None
        )
        assert away.min() > least - 0.25


def test_bodies_on_the_land_reach_below_its_surface(
    built: list[tuple[StreetSection, SectionBuilder]],
) -> None:
    for section, one in built:
        mesh = one.mesh.mesh()
        for thing in one.things:
            of_it = mesh.vertices[mesh.triangles[mesh.instance == thing.instance]].reshape(-1, 3)
            alignment = section.alignment
            rows = [
                int(np.linalg.norm(alignment.positions[:, :2] - xy, axis=1).argmin())
                for xy in of_it[::17, :2]
            ]
            left = np.column_stack(
                [-np.sin(alignment.headings[rows]), np.cos(alignment.headings[rows])]
            )
            offset = ((of_it[::17, :2] - alignment.positions[rows, :2]) * left).sum(axis=1)
            ground = section.ground.height(alignment.chainages[rows], offset)
            assert (of_it[::17, 2] - ground).min() < 0.02, thing.kind


def test_land_is_the_same_when_it_is_built_again() -> None:
    section = _sections()[0]
    meshes = []
    for _ in range(2):
        one = SectionBuilder(1)
        add_land(FreePositions(section), one)
        meshes.append(one.mesh.mesh())
    np.testing.assert_array_equal(meshes[0].vertices, meshes[1].vertices)

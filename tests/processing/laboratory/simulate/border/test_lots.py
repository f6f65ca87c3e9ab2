"""Lots: buildings stay off the road and out of each other, and are the same in any order."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.border.houses import (
    Building,
    Plot,
    flats,
    greenhouse,
    hall,
    house,
    shop,
)
from processing.laboratory.simulate.border.lots import add_lots, lots_of
from processing.laboratory.simulate.border.yards import yard_parts
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Mesh
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePosition, FreePositions
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import RURAL, URBAN, Style

BUILDINGS: list[Building] = [house, shop, flats, hall, greenhouse]


def _sections(seed: int, style: Style) -> list[StreetSection]:
    street = Street(seed, style, 200.0)
    return [street.bare_section(row) for row in street.within(0.0, 200.0)]


def _built(section: StreetSection) -> tuple[Mesh, SectionBuilder]:
    built = SectionBuilder(1)
    add_lots(FreePositions(section), built)
    return built.mesh.mesh(), built


def _distances(section: StreetSection, mesh: Mesh) -> np.ndarray:
    """How far vertices are from the road's centre, by the nearest place of its line."""
    line = section.alignment.positions[:, :2]
    near = np.linspace(section.plan.start_m - 30, section.plan.end_m + 30, 400)
    centre = np.column_stack(
        [np.interp(near, section.alignment.chainages, line[:, axis]) for axis in range(2)]
    )
    away = np.linalg.norm(mesh.vertices[:, None, :2] - centre[None], axis=2)
    nearest: np.ndarray = away.min(axis=1)
    return nearest


@pytest.mark.parametrize("seed", [0, 1])
def test_nothing_of_a_lot_stands_on_road_or_walk(seed: int) -> None:
    for section in _sections(seed, URBAN):
        mesh, _ = _built(section)
        if len(mesh.vertices):
            inner = min(
                band.inner_m
                for side in (section.plan.left, section.plan.right)
                if (band := side.band("outside")) is not None
            )
            assert _distances(section, mesh).min() > inner - 0.05


def test_lots_follow_each_other_within_their_section() -> None:
    for section in _sections(3, URBAN):
        for side in (1, -1):
            lots = list(lots_of(section, side))
            ends = [section.plan.start_m, *(one.to_m for one in lots)]
            assert all(end <= lot.from_m for end, lot in zip(ends[:-1], lots, strict=True))
            assert ends[-1] <= section.plan.end_m
            assert side not in section.plan.junctions or not lots


@pytest.mark.parametrize("wide_m", [5.0, 9.0])
@pytest.mark.parametrize("make", BUILDINGS)
def test_a_building_keeps_within_its_plot_whatever_the_draw(make: Building, wide_m: float) -> None:
    plot = Plot(wide_m, 16.0)
    for number in range(60):
        parts = make(chance(number, "test"), plot)
        vertices = np.concatenate([shape[0] for shape, _ in parts])
        assert np.isfinite(vertices).all()
        assert vertices[:, 0].min() > -plot.half_m - 0.75, "eaves may stand over the side"
        assert vertices[:, 0].max() < plot.half_m + 0.75
        assert vertices[:, 1].min() > -0.5
        for shape, _ in parts:
            assert shape[1].min() >= 0
            assert shape[1].max() < len(shape[0])


def test_places_under_a_building_are_taken() -> None:
    for section in _sections(1, URBAN):
        positions, built = FreePositions(section), SectionBuilder(1)
        add_lots(positions, built)
        for lot in lots_of(section, 1):
            spot = FreePosition(lot.middle_m, lot.side * lot.front_m)
            assert not positions.is_free(spot, 0.1)


def test_buildings_are_built_quickly_and_of_few_triangles() -> None:
    for style in (URBAN, RURAL):
        for section in _sections(4, style):
            mesh, built = _built(section)
            assert len(mesh.triangles) < 30_000
            assert {one.kind for one in built.things} <= {
                "building",
                "carport",
                "fence",
                "gate",
                "vending_machine",
                "wall",
                "wheel_stop",
            }


def test_a_section_has_the_same_lots_when_it_is_built_again() -> None:
    one, other = _sections(6, URBAN)[2], _sections(6, URBAN)[2]
    np.testing.assert_array_equal(_built(one)[0].vertices, _built(other)[0].vertices)


def test_posts_of_a_gate_stand_beside_its_walls_not_in_them() -> None:
    gates = 0
    for section in _sections(205, URBAN):
        mesh, built = _built(section)
        of = {one.instance: one.kind for one in built.things}
        positions = {one: mesh.vertices[mesh.triangles[mesh.instance == one]] for one in of}
        walls = [positions[one].reshape(-1, 3)[:, :2] for one in of if of[one] == "wall"]
        for gate in (positions[one].reshape(-1, 3)[:, :2] for one in of if of[one] == "gate"):
            gates += 1
            middle = section.heading((section.plan.start_m + section.plan.end_m) / 2)
            direction = gate[np.linalg.norm(gate - gate[0], axis=1).argmax()] - gate[0]
            along = np.array([np.cos(middle), np.sin(middle)])
            along = along * np.sign(along @ direction)
            low, high = np.sort(gate @ along)[[0, -1]]
            for wall in walls:
                if np.linalg.norm(wall - gate.mean(axis=0), axis=1).min() < 1.5:
                    first, last = (wall @ along).min(), (wall @ along).max()
                    assert min(high, last) - max(low, first) < 0.1
    assert gates > 3


def test_vending_machines_stand_behind_the_wall_of_their_lot() -> None:
    machines = 0
    for number in range(200):
        parts = yard_parts(chance(number, "yard"), Plot(12.0, 15.0), "shop", [], front_m=5.0)
        for kind, (shape, _) in parts:
            machines += 1
            assert kind == "vending_machine"
            assert shape[0][:, 1].min() > 0.2
    assert machines > 20

"""Things on the ground."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.random import Generator

from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.sites.barriers import cone, fence_panel, hut, net, scaffold
from processing.laboratory.simulate.sites.bodies import SiteBody, SiteKind, block, rotate_part
from processing.laboratory.simulate.sites.heights import HeightGrid
from processing.laboratory.simulate.sites.layout import SiteLayout, layout_of, scene_mesh
from processing.laboratory.simulate.sites.machines import MACHINES
from processing.laboratory.simulate.sites.small_things import (
    batter_board,
    bush,
    survey_pole,
    worker,
)
from processing.laboratory.simulate.sites.stations import count_for, stations_of
from processing.laboratory.simulate.sites.stores import STORES
from processing.laboratory.simulate.sites.terrain import SiteGround, terrain_of

UPRIGHT = (*STORES, cone, hut, net, scaffold, batter_board, bush, survey_pole, worker)


def slope(grade: float, side_m: float = 20.0) -> SiteGround:
    count = round(side_m / 0.25) + 1
    z = np.broadcast_to(np.arange(count) * 0.25 * grade, (count, count)).astype(np.float32)
    return SiteGround(
        HeightGrid(z, 0.25),
        np.full(z.shape, int(Material.SOIL), np.uint8),
        np.ones(z.shape, np.bool_),
    )


@pytest.mark.parametrize("make", [*MACHINES, *UPRIGHT])
def test_things_stand_on_the_ground_and_have_sizes_of_their_kind(
    make: Callable[[Generator], SiteBody],
) -> None:
    for seed in range(6):
        body = make(chance(seed, "body"))
        z = np.concatenate([shape[0][:, 2] for shape, _ in body.parts])
        assert -0.45 < z.min() < 0.12
        assert 0.1 < z.max() < 11
        assert body.radius_m < 16
        assert sum(len(shape[1]) for shape, _ in body.parts) < 4000


def test_a_machine_tilts_with_the_slope_and_a_person_does_not() -> None:
    ground = slope(0.5)
    layout = SiteLayout(ground)
    plate = block((-1, -1, 0.0), (1, 1, 0.1), Material.STEEL)
    layout.add(SiteBody(SiteKind.ROLLER, (plate,), (1.0, 1.0)), 10.0, 10.0, 0.0)
    layout.add(SiteBody(SiteKind.WORKER, (plate,)), 4.0, 4.0, 0.0)
    mesh = scene_mesh(layout)
    tilted = mesh.vertices[mesh.triangles[mesh.instance == 1]].reshape(-1, 3)
    above = tilted[:, 2] - ground.heights.height(tilted[:, 0], tilted[:, 1])
    assert np.abs(above).max() < 0.15
    upright = mesh.vertices[mesh.triangles[mesh.instance == 2]].reshape(-1, 3)
    assert np.ptp(upright[:, 2]) == pytest.approx(0.1)


def test_a_fence_follows_the_ground() -> None:
    ground = slope(0.4)
    layout = SiteLayout(ground)
    layout.add(fence_panel(chance(2, "fence"), 1.8), 5.0, 5.0, 0.0)
    z = scene_mesh(layout).vertices
    low = z[:, 2] - ground.heights.height(z[:, 0], z[:, 1])
    assert -0.3 < low.min() < 0.1


def test_a_part_turns_anticlockwise() -> None:
    (vertices, _), _ = rotate_part(
        block((1, 0, 0), (2, 1, 1), Material.WOOD), 2, np.pi / 2, (0, 0, 0)
    )
    assert vertices[:, 0].min() == pytest.approx(-1)
    assert vertices[:, 1].max() == pytest.approx(2)


def test_large_things_keep_apart_and_stations_keep_off_them() -> None:
    terrain = terrain_of(6, "pad", 28.0, lambda: None)
    layout = layout_of(6, "after", terrain, lambda: None)
    assert len(layout.things) > 5
    machines = [one for one in layout.things if one.kind in (1, 2, 3, 12)]
    for one in machines:
        for other in machines:
            apart = np.hypot(one.x - other.x, one.y - other.y)
            assert one is other or apart > one.radius_m + other.radius_m
    mesh = scene_mesh(layout)
    assert set(np.unique(mesh.label)) == {1, 2}
    assert mesh.instance.max() == len(layout.things)
    scene = RaycastScene(mesh, np.array([14.0, 10.0, float(mesh.vertices[:, 2].mean())]))
    stations = stations_of(chance(6, "stations"), layout, scene, 4, lambda: None)
    assert len(stations) == 4
    for station in stations:
        x, y, z = station.position
        assert 1.4 < z - layout.ground.heights.height(x, y) < 1.9
        assert layout.is_free(x, y, 2.0)
    positions = np.array([one.position[:2] for one in stations])
    assert len(np.unique(positions, axis=0)) == 4


def test_larger_sites_get_more_stations_and_a_request_is_kept() -> None:
    assert [count_for(length, 0) for length in (20, 60, 200, 500)] == [3, 5, 8, 8]
    assert count_for(60, 12) == 12

"""Bodies of traffic: sizes as the law has them, on the ground, with air beneath."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.traffic.kinds import KINDS
from processing.laboratory.simulate.traffic.parked_vehicles import Footprint

VEHICLES = ("kei_car", "saloon", "van", "small_truck", "truck", "bus")


@pytest.mark.parametrize("name", KINDS)
def test_a_body_stands_on_the_ground_and_keeps_to_its_size(name: str) -> None:
    kind = KINDS[name]
    for number in range(12):
        for drawn in (kind.drawn, kind.drawn_at_rest):
            body = drawn(chance(number, name))
            mesh = body.mesh(7)
            low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
            assert -0.002 <= low[2] <= 0.03
            assert high[2] <= body.height_m + 0.15
            assert body.length_m <= kind.length_m
            assert body.width_m <= kind.width_m
            assert high[2] < 3.8
            assert np.isfinite(mesh.vertices).all()
            assert set(np.unique(mesh.label)) == {64}
            assert set(np.unique(mesh.instance)) == {7}


@pytest.mark.parametrize("name", VEHICLES)
def test_beams_pass_beneath_a_vehicle_and_meet_glass_and_plates_on_it(name: str) -> None:
    for number in range(4):
        mesh = KINDS[name].drawn(chance(number, name)).mesh(1)
        scene = RaycastScene(mesh, np.zeros(3))
        across = np.array([[0.1, -9.0, 0.06]]), np.array([[0.0, 1.0, 0.0]])
        assert not np.isfinite(scene.cast(*across).ranges).any()
        beneath = np.array([[0.1, 0.0, 0.01]]), np.array([[0.0, 0.0, 1.0]])
        assert 0.1 < float(scene.cast(*beneath).ranges[0]) < 1.2
        assert {Material.GLASS, Material.RUBBER, Material.SIGN_FACE} <= set(mesh.material.tolist())


def test_no_two_of_a_kind_are_the_same() -> None:
    for kind in KINDS.values():
        sums = [float(kind.drawn(chance(seed, "x")).mesh(1).vertices.sum()) for seed in range(6)]
        assert len({round(one, 6) for one in sums}) == 6


def test_rectangles_touch_where_they_share_a_place() -> None:
    one = Footprint(0.0, 0.0, 0.0, 2.0, 1.0)
    assert one.touches(Footprint(3.9, 0.0, 0.0, 2.0, 1.0))
    assert not one.touches(Footprint(4.1, 0.0, 0.0, 2.0, 1.0))
    assert not one.touches(Footprint(2.9, 1.9, np.pi / 4, 1.0, 1.0))
    assert one.touches(Footprint(2.4, 1.4, np.pi / 4, 1.0, 1.0))

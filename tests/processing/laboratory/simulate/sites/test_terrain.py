"""Ground on two dates."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.sites.heights import HeightGrid, nodes_apart
from processing.laboratory.simulate.sites.relief import distance_to_path, puddle
from processing.laboratory.simulate.sites.terrain import terrain_of
from processing.laboratory.simulate.sites.works import PLANS, Plan, progress_of, work_placement_of

STYLES = sorted(PLANS)


def nothing() -> None:
    return


@pytest.mark.parametrize("style", STYLES)
def test_a_site_changes_by_decimetres_to_metres_but_not_everywhere(style: str) -> None:
    terrain = terrain_of(5, style, 24.0, nothing)
    change = terrain.after.heights.z - terrain.before.heights.z
    assert 0.1 < np.abs(change).max() < 8
    assert 0.02 < terrain.unchanged.mean() < 0.75
    assert (change[terrain.unchanged] == 0).all()


def test_a_seed_gives_the_same_ground_and_another_one_gives_another() -> None:
    one, same, other = (terrain_of(seed, "pad", 22.0, nothing) for seed in (3, 3, 4))
    assert one.after.heights.z.tobytes() == same.after.heights.z.tobytes()
    assert one.after.heights.z.shape != other.after.heights.z.shape


@pytest.mark.parametrize("style", STYLES)
def test_work_never_goes_back_nor_past_its_design(style: str) -> None:
    x, y = np.meshgrid(np.arange(0, 60, 0.5), np.arange(0, 40, 0.5))
    random = chance(8, style)
    lie = work_placement_of(random, x, y)
    plan = PLANS[style](random, lie)
    first, second = (plan.built(one.down_to, one.up_to) for one in progress_of(random, lie, plan))
    low, high = np.minimum(plan.natural, plan.design), np.maximum(plan.natural, plan.design)
    for state in (first, second):
        assert (state >= low).all()
        assert (state <= high).all()
    left = np.abs(second - plan.design) - np.abs(first - plan.design)
    assert left.max() < 1e-9


def test_a_level_between_ground_and_design_is_where_the_fill_stands() -> None:
    flat = np.zeros((2, 2))
    plan = Plan(flat, flat + 3)
    assert (plan.built(flat + 9, flat + 1.2) == 1.2).all()
    assert (Plan(flat + 3, flat).built(flat + 1.2, flat - 9) == 1.2).all()


def test_heights_between_nodes_are_those_of_the_triangles() -> None:
    grid = HeightGrid(np.array([[0.0, 0.0], [0.0, 1.0]], np.float32), 2.0)
    assert grid.height(1.0, 1.0) == pytest.approx(0.5)  # on the diagonal
    assert grid.height(1.5, 0.5) == pytest.approx(0.25)
    assert grid.height(0.5, 1.5) == pytest.approx(0.25)
    vertices, triangles = grid.shape()
    middles = vertices[triangles].mean(axis=1)
    assert np.allclose(grid.height(middles[:, 0], middles[:, 1]), middles[:, 2])
    normals = np.cross(*(vertices[triangles[:, one]] - vertices[triangles[:, 0]] for one in (1, 2)))
    assert (normals[:, 2] > 0).all()


def test_large_sites_have_coarser_nodes_and_no_more_than_two_million_triangles() -> None:
    for length in (60.0, 100.0, 250.0, 500.0):
        assert 2 * (length / nodes_apart(length)) ** 2 * 0.86 < 2.0e6


def test_the_distance_to_a_path_is_signed_and_counted_along_it() -> None:
    x, y = np.meshgrid(np.arange(0, 20, 0.5), np.arange(0, 10, 0.5))
    signed, along = distance_to_path(x, y, np.array([[2.0, 5.0], [10.0, 5.0], [18.0, 5.0]]))
    assert signed[14, 12] == pytest.approx(2.0)  # (6, 7): left of the way east
    assert signed[6, 12] == pytest.approx(-2.0)
    assert along[10, 28] == pytest.approx(12.0)
    assert np.isinf(signed[0, 20])


def test_water_is_level_and_keeps_off_slopes() -> None:
    x, y = np.meshgrid(np.arange(0, 6, 0.1), np.arange(0, 6, 0.1))
    bowl = 0.02 * ((x - 3) ** 2 + (y - 3) ** 2)
    wet = puddle(chance(1, "wet"), bowl, x, y, (3.0, 3.0))
    assert wet.any()
    assert np.ptp(bowl[wet]) == 0
    slope = 2 * x
    assert not puddle(chance(1, "wet"), slope, x, y, (3.0, 3.0)).any()

"""The ground has no holes, is as high as makers are told, and is the same in any order."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.gutters.aprons import add_aprons
from processing.laboratory.simulate.gutters.transverse_gutters import add_transverse_gutters
from processing.laboratory.simulate.roadway.ends import add_ends
from processing.laboratory.simulate.roadway.islands import add_islands
from processing.laboratory.simulate.roadway.junctions import add_junctions
from processing.laboratory.simulate.roadway.markings import add_markings
from processing.laboratory.simulate.roadway.pavement import add_pavement
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Mesh
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.plan import SIDES
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import HIGHWAY, RURAL, URBAN, Style
from processing.laboratory.simulate.street.surfaces import add_ground

MAKERS = (
    add_ground, add_junctions, add_islands, add_ends, add_markings, add_pavement, add_aprons,
    add_transverse_gutters,
)  # fmt: skip
SKY_M = 300.0


def _built(section: StreetSection) -> tuple[Mesh, list[TrueFeature]]:
    built = SectionBuilder(1)
    for add in MAKERS:
        add(section, built)
    return built.mesh.mesh(), built.truth


def _fallen(
    mesh: Mesh, positions: np.ndarray[tuple[int, int], np.dtype[np.float64]]
) -> list[float]:
    """Heights at which rays straight down from the sky meet the mesh."""
    import open3d

    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        open3d.core.Tensor(mesh.vertices.astype(np.float32)),
        open3d.core.Tensor(mesh.triangles.astype(np.uint32)),
    )
    rays = np.zeros((len(positions), 6), np.float32)
    rays[:, :2], rays[:, 2], rays[:, 5] = positions[:, :2], SKY_M, -1.0
    hit = scene.cast_rays(open3d.core.Tensor(rays))["t_hit"].numpy()
    return list(SKY_M - hit)


def _is_lids(section: StreetSection, offset: float) -> bool:
    side = 1 if offset > 0 else -1
    plan = section.plan.side(side)
    if plan.drain != "lids" or side in section.plan.junctions:
        return False
    return -0.2 < abs(offset) - plan.edge_m < plan.drain_m + 0.2


@pytest.mark.parametrize(("seed", "style"), [(6, URBAN), (8, URBAN), (1, RURAL), (3, HIGHWAY)])
def test_rays_straight_down_meet_the_ground_everywhere(seed: int, style: Style) -> None:
    street = Street(seed, style, 150.0)
    sections = [street.bare_section(row) for row in street.within(15, 130)]
    mesh = Mesh.joined(_built(one)[0] for one in sections)
    random = np.random.default_rng(0)
    chainages, offsets = random.uniform(15, 130, 20_000), random.uniform(-30, 30, 20_000)
    bends = np.interp(chainages, street.alignment.chainages, street.alignment.curvatures)
    heights = np.array(_fallen(mesh, street.alignment.at(chainages, offsets, 0.0)))
    missing = ~np.isfinite(heights) & (bends * offsets < 0.75)
    for section in sections:
        plan = section.plan
        here = missing & (chainages >= plan.start_m) & (chainages < plan.end_m)
        assert all(_is_lids(section, float(one)) for one in offsets[here])


def test_the_ground_is_as_high_as_the_mesh_and_nearly_so_in_mouths() -> None:
    street = Street(8, URBAN, 150.0)
    random = np.random.default_rng(0)
    for row in street.within(0, 100):
        section = street.bare_section(row)
        plan = section.plan
        chainages = random.uniform(plan.start_m, plan.end_m, 4000)
        offsets = random.uniform(-14, 14, 4000)
        built = SectionBuilder(1)
        for add in (add_ground, add_junctions):
            add(section, built)
        positions = street.alignment.at(chainages, offsets, 0.0)
        heights = np.array(_fallen(built.mesh.mesh(), positions))
        lids = np.array([_is_lids(section, float(one)) for one in offsets])
        known = np.isfinite(heights) & ~lids
        off = np.abs(heights - section.ground.height(chainages, offsets))[known]
        limit = 0.12 if plan.junctions else 0.004
        assert np.quantile(off, 0.98) < limit


def test_paint_lies_on_the_road() -> None:
    for seed in (1, 3):
        street = Street(seed, URBAN, 100.0)
        for row in street.within(0, 100):
            section = street.bare_section(row)
            if section.plan.junctions:
                continue
            built = SectionBuilder(1)
            add_ground(section, built)
            ground = built.mesh.mesh()
            built = SectionBuilder(1)
            add_markings(section, built)
            paint = built.mesh.mesh()
            assert (paint.material == Material.PAINT).all()
            middles = paint.vertices[paint.triangles].mean(axis=1)
            above = middles[:, 2] - np.array(_fallen(ground, middles))
            assert above.min() > 0.0005
            assert above.max() < 0.005


def test_sections_are_the_same_in_whatever_order_they_are_built() -> None:
    one, other = Street(5, URBAN, 200.0), Street(5, URBAN, 120.0)
    rows = list(one.within(0, 100))
    ahead = {row: _built(one.bare_section(row)) for row in rows}
    back = {row: _built(other.bare_section(row)) for row in rows[::-1]}
    for row in rows:
        first, second = ahead[row][0], back[row][0]
        assert np.array_equal(first.vertices, second.vertices)
        assert np.array_equal(first.triangles, second.triangles)
        assert np.array_equal(first.piece, second.piece)
        for mine, theirs in zip(ahead[row][1], back[row][1], strict=True):
            assert mine.facts == theirs.facts
            assert np.array_equal(mine.xyz, theirs.xyz)


def test_no_section_has_more_triangles_than_a_scene_can_bear() -> None:
    for style in (URBAN, RURAL, HIGHWAY):
        street = Street(2, style, 150.0)
        for row in street.within(0, 150):
            assert len(_built(street.bare_section(row))[0].triangles) < 60_000


def test_side_streets_have_curbs_round_both_corners() -> None:
    street = Street(6, URBAN, 150.0)
    found = 0
    for row in street.within(0, 150):
        section = street.bare_section(row)
        for side in section.plan.junctions:
            if section.plan.side(side).curb == "none":
                continue
            edge = section.plan.side(side).edge_m
            truth = [one for one in _built(section)[1] if one.facts.get("edge") == "upper"]
            far = 0.0
            for one in truth:
                middle = street.alignment.at(one.chainage_m, 0.0, 0.0)
                far = max(far, float(np.linalg.norm(one.xyz[:, :2] - middle[:2], axis=1).max()))
            assert far > edge + 20
            found += 1
        assert all(each in SIDES for each in section.plan.junctions)
    assert found

"""Aprons of L-gutters: no holes but basins, joints of some millimetres, gratings as their truth."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.gutters.aprons import add_aprons
from processing.laboratory.simulate.scene.mesh import Floats, Mesh
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.plan import SIDES
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import URBAN

Aprons = list[tuple[StreetSection, Mesh, list[TrueFeature], SectionBuilder]]


@pytest.fixture(scope="module")
def aprons() -> Aprons:
    """Sections with aprons, with nothing but them."""
    made: Aprons = []
    for seed in (2, 5, 6):
        street = Street(seed, URBAN, 160.0)
        for row in street.within(0.0, 160.0):
            section = street.bare_section(row)
            built = SectionBuilder(1)
            add_aprons(section, built)
            mesh = built.mesh.mesh()
            if mesh.triangles.size:
                own = [one for one in built.truth if one.file == "gutters"]
                made.append((section, mesh, own, built))
    return made


def _heights(mesh: Mesh, positions: Floats) -> Floats:
    import open3d

    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        open3d.core.Tensor(mesh.vertices.astype(np.float32)),
        open3d.core.Tensor(mesh.triangles.astype(np.uint32)),
    )
    rays = np.zeros((len(positions), 6), np.float32)
    rays[:, :2], rays[:, 2], rays[:, 5] = positions[:, :2], 200.0, -1.0
    found: Floats = 200.0 - scene.cast_rays(open3d.core.Tensor(rays))["t_hit"].numpy()
    return found


def test_aprons_are_as_high_as_the_ground_but_for_joints_and_basins(aprons: Aprons) -> None:
    random = np.random.default_rng(1)
    dips = []
    for section, mesh, _, _ in aprons:
        for side in SIDES:
            plan = section.plan.side(side)
            if plan.drain != "apron" or side in section.plan.junctions:
                continue
            sweep = section.layout.sides[side].sweep
            row = random.integers(0, sweep.chainages.shape[0] - 1, 3000)
            along, across = random.random(3000), random.uniform(0.1, 0.9, 3000)
            s = sweep.chainages[row, 0]
            s = s + along * (sweep.chainages[row + 1, 0] - s)
            edges = [np.interp(s, sweep.chainages[:, 0], sweep.offsets[:, one]) for one in (0, 1)]
            o = edges[0] + across * (edges[1] - edges[0])
            position = section.position(s, o)
            dips.append(position[:, 2] - _heights(mesh, position))
    dip = np.concatenate(dips)
    assert np.isfinite(dip).all()
    assert np.abs(np.median(dip)) < 0.001
    assert dip.min() > -0.004
    in_joints = (dip > 0.002) & (dip < 0.02)
    assert 0.0005 < in_joints.mean() < 0.05
    assert np.mean(np.abs(dip) < 0.003) > 0.93


def test_gratings_of_basins_are_the_truth_of_runs_of_their_own(aprons: Aprons) -> None:
    found = []
    for section, mesh, truth, built in aprons:
        kinds = {one.instance: one.kind for one in built.things}
        for one in truth:
            assert kinds[one.instance] == "grating"
            assert kinds[int(str(one.facts["run"]))] == "basin"
            vertices = mesh.vertices[np.unique(mesh.triangles[mesh.instance == one.instance])]
            gaps = np.linalg.norm(vertices[None] - one.xyz[:4, None], axis=2).min(axis=1)
            assert gaps.max() < 1e-4
            assert np.linalg.norm(one.xyz[1] - one.xyz[0]) == pytest.approx(
                one.facts["length_m"], abs=1e-4
            )
            side = 1 if one.facts["side"] == "left" else -1
            middle = one.xyz[:4].mean(axis=0)
            plan = section.plan.side(side)
            ground = section.position(one.chainage_m, side * (plan.edge_m + plan.drain_m / 2))
            assert np.linalg.norm(middle - ground) < 0.15
            assert abs(middle[2] - ground[2]) < 0.02
            found.append(one.facts["run"])
    assert len(found) > 3


def test_basins_stand_clear_of_lowered_curbs(aprons: Aprons) -> None:
    for section, _, truth, _ in aprons:
        for one in truth:
            side = 1 if one.facts["side"] == "left" else -1
            for drop in section.layout.sides[side].drops:
                assert not drop.from_m < one.chainage_m < drop.to_m


def test_below_a_grating_is_a_shaft(aprons: Aprons) -> None:
    open_positions = []
    for _, mesh, truth, _ in aprons:
        for one in truth:
            share = np.random.default_rng(0).uniform(0.1, 0.9, (200, 2))
            ring = one.xyz
            positions = (
                ring[0] + share[:, :1] * (ring[1] - ring[0]) + share[:, 1:] * (ring[3] - ring[0])
            )
            deep = positions[:, 2] - _heights(mesh, positions)
            assert np.isfinite(deep).all()
            open_positions.append(np.mean(deep > 0.3))
    assert min(open_positions) > 0.3

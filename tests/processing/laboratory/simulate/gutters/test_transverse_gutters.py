"""Gutters across side streets: they fill the opening in the asphalt and lie level with it."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.gutters.aprons import add_aprons
from processing.laboratory.simulate.gutters.transverse_gutters import add_transverse_gutters
from processing.laboratory.simulate.roadway.junctions import add_junctions
from processing.laboratory.simulate.roadway.transverse import transverse_of
from processing.laboratory.simulate.scene.mesh import Mesh
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.junction_shape import Mouth
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import URBAN
from processing.laboratory.simulate.street.surfaces import add_ground

SEEDS = (11, 13, 27)
Crossed = list[tuple[StreetSection, Mouth, tuple[float, float], Mesh, list[TrueFeature]]]


@pytest.fixture(scope="module")
def crossed() -> Crossed:
    """Side streets with a gutter across, and all their ground."""
    made: Crossed = []
    for seed in SEEDS:
        street = Street(seed, URBAN, 150.0)
        for row in street.within(0.0, 150.0):
            section = street.bare_section(row)
            for side in section.plan.junctions:
                mouth = section.layout.sides[side].mouth
                beside = None if mouth is None else transverse_of(section, mouth)
                if mouth is None or beside is None:
                    continue
                built = SectionBuilder(1)
                for add in (add_ground, add_junctions, add_aprons, add_transverse_gutters):
                    add(section, built)
                made.append((section, mouth, beside, built.mesh.mesh(), built.truth))
    assert made
    return made


def _gratings(truth: list[TrueFeature]) -> list[TrueFeature]:
    return [one for one in truth if one.file == "gutters"]


def test_rays_straight_down_meet_asphalt_gratings_or_the_channel(crossed: Crossed) -> None:
    import open3d

    random = np.random.default_rng(2)
    for section, mouth, beside, mesh, _ in crossed:
        track = section.layout.sides[mouth.side].corners[0].track
        along = random.uniform(mouth.middle_m - mouth.half_m, mouth.middle_m + mouth.half_m, 5000)
        deep = random.uniform(beside[0] - 0.5, beside[1] + 0.5, 5000)
        chainage, offset = track.placed(along, deep)
        positions = section.alignment.at(chainage, offset, 0.0)
        scene = open3d.t.geometry.RaycastingScene()
        scene.add_triangles(
            open3d.core.Tensor(mesh.vertices.astype(np.float32)),
            open3d.core.Tensor(mesh.triangles.astype(np.uint32)),
        )
        rays = np.zeros((5000, 6), np.float32)
        rays[:, :2], rays[:, 2], rays[:, 5] = positions[:, :2], 200.0, -1.0
        found = scene.cast_rays(open3d.core.Tensor(rays))["t_hit"].numpy()
        assert np.isfinite(found).all()
        in_gutter = (deep > beside[0] + 0.1) & (deep < beside[1] - 0.1)
        level = np.median(200.0 - found[~in_gutter])
        assert np.mean(200.0 - found[in_gutter] < level - 0.15) > 0.15


def test_gratings_are_a_run_across_the_mouth_level_with_the_asphalt(crossed: Crossed) -> None:
    for section, mouth, beside, _, truth in crossed:
        gratings = [
            one
            for one in _gratings(truth)
            if np.linalg.norm(one.xyz[2] - one.xyz[1])
            == pytest.approx(one.facts["width_m"], abs=1e-3)
            and abs(one.chainage_m - mouth.middle_m) < 2 * mouth.half_m + 4
        ]
        runs: dict[object, list[TrueFeature]] = {}
        for one in gratings:
            runs.setdefault(one.facts["run"], []).append(one)
        run = max(runs.values(), key=len)
        total = sum(float(str(one.facts["length_m"])) for one in run)
        assert 2 * mouth.half_m - 1.7 < total < 2.4 * mouth.half_m
        assert [one.facts["order"] for one in run] == list(range(len(run)))
        assert all(0.2 < float(str(one.facts["width_m"])) < beside[1] - beside[0] for one in run)
        heights = np.array([one.xyz[:4, 2].mean() for one in run])
        ends = np.polyval(np.polyfit(np.arange(len(run)), heights, 2), np.arange(len(run)))
        assert np.abs(heights - ends).max() < 0.02
        assert section.plan.start_m < run[0].chainage_m < section.plan.end_m

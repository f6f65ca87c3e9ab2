"""What lies in the pavement: blocks for the blind before lowered curbs."""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.roadway.pavement import add_pavement
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.styles import URBAN


def test_tactile_blocks_lie_before_the_lowered_curbs_of_some_corners() -> None:
    found = 0
    for seed in (12, 16, 17, 18):
        street = Street(seed, URBAN, 150.0)
        for row in street.within(0.0, 150.0):
            plan = street.plans[row]
            if not any(plan.side(side).has_tactile for side in plan.junctions):
                continue
            section = street.bare_section(row)
            built = SectionBuilder(1)
            add_pavement(section, built)
            mesh = built.mesh.mesh()
            blocks = mesh.vertices[np.unique(mesh.triangles[mesh.material == Material.TACTILE])]
            for side in plan.junctions:
                for corner in section.layout.sides[side].corners:
                    sweep = corner.sweep
                    foot = section.alignment.at(
                        sweep.chainages[:, 0], sweep.offsets[:, 0], sweep.heights[:, 0]
                    )
                    if corner.drops and blocks.size:
                        gaps = np.linalg.norm(foot[:, None] - blocks[None], axis=2)
                        found += int(0.3 < gaps.min() < 2.0)
    assert found > 2

"""The triangles of a section's ground."""

from __future__ import annotations

import numpy as np

from processing.simulate.mesh import grid
from processing.simulate.street.section import Section
from processing.simulate.things import NO_THING, Built


def add_ground(section: Section, built: Built) -> None:
    """Add the strips of the ground; each curb is a thing of its own."""
    ground = section.ground
    for number, strip in enumerate(ground.strips):
        if not strip.has_surface:
            continue
        offsets = ground.offsets[:, number : number + 2]
        heights = ground.heights[:, number : number + 2]
        rows = section.alignment.at(
            np.broadcast_to(ground.nodes[:, None], offsets.shape), offsets, heights
        )
        built.mesh.add(grid(rows), strip.material, strip.label, NO_THING)

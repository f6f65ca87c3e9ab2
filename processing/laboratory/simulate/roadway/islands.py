"""Raised islands in the mouths of wide side streets: ellipses and drops with curbs around them.

Their curb is one run (role ``island``); pieces count half metres along its upper edge.
"""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.corner_track import CornerTrack
from processing.laboratory.simulate.street.ground import Strip
from processing.laboratory.simulate.street.junction_shape import Mouth
from processing.laboratory.simulate.street.profile import (
    CURB,
    GRASS,
    GROUND,
    STONE_TOP_M,
    Edge,
    RoadProfile,
)
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.sweep import Sweep, add_runs, add_surfaces

_LEAST_HALF_M = 3.3
"""Half the carriageway of a side street that has room for an island."""

_STEP_M = 0.12


def add_islands(section: StreetSection, built: SectionBuilder) -> None:
    """Add the islands of a section's side streets."""
    for side in section.plan.junctions:
        part = section.layout.sides[side]
        mouth = part.mouth
        random = section.chance("island", side)
        if mouth is None or mouth.half_m < _LEAST_HALF_M or random.random() < 0.3:
            continue
        wide = float(random.uniform(0.9, min(1.8, 2 * mouth.half_m - 5.4)))
        long = float(random.uniform(2.0, 8.0))
        start = max(one.radius_m for one in mouth.corners) * float(random.uniform(0.9, 1.2)) + 5.5
        shape = (wide / 2, long / 2, start + long / 2)
        outline = _outline(shape, float(random.uniform(0.0, 0.45)))
        sweep = _island(section, mouth, part.corners[0].track, outline, side)
        add_surfaces(sweep, section.alignment, built, Material.PAVING)
        add_runs(sweep, section.alignment, built)


def _outline(shape: tuple[float, float, float], taper: float) -> Floats:
    """The island's foot, from half its width and length and its middle beside the road.

    (n, 2) float64, closed: along the road from the side street's middle, and beside the road.
    """
    half_wide, half_long, middle = shape
    around = 2 * np.pi * np.sqrt((half_wide**2 + half_long**2) / 2)
    angles = np.linspace(0, 2 * np.pi, max(24, int(around / _STEP_M)) + 1)
    across = half_wide * np.cos(angles) * (1 - taper * np.sin(angles))
    beside = middle + half_long * np.sin(angles)
    outline = np.column_stack([across, beside])
    outline[-1] = outline[0]
    return outline


def _island(
    section: StreetSection, mouth: Mouth, track: CornerTrack, outline: Floats, side: int
) -> Sweep:
    random = section.chance("island stones", side)
    high = float(random.uniform(0.12, 0.25))
    lean = high * float(random.uniform(0.05, 0.1))
    tops = ((Material.GRASS, GRASS), (Material.PAVING, GROUND), (Material.OLD_CONCRETE, GROUND))
    top, label = tops[int(random.integers(3))]
    centre = np.array([0.0, float(outline[:, 1].mean())])
    outwards = outline - centre
    reach = np.linalg.norm(outwards, axis=1)
    inwards = (0.0, lean, lean + STONE_TOP_M, None)
    heights = np.array([0.0, high, high, high])
    lines = []
    for inward in inwards:
        share = np.zeros(reach.size) if inward is None else np.maximum(1 - inward / reach, 0.0)
        lines.append(centre + outwards * share[:, None])
    along = np.column_stack([one[:, 0] for one in lines]) + mouth.middle_m
    beside = np.column_stack([one[:, 1] for one in lines])
    chainages, offsets = track.placed(along, beside)
    base = section.layout.terrain.height(chainages, offsets) + mouth.crown(chainages, beside)
    profile = RoadProfile()
    stone, surface = Strip("curb", Material.CONCRETE, CURB), Strip("island", top, label)
    flat = np.zeros(reach.size)
    away = (0.0, lean, lean + STONE_TOP_M, float(reach.max()))
    for row, strip in enumerate((None, stone, stone, surface)):
        profile.line(flat + away[row], flat + heights[row], strip)
    edge = Edge("island", 0, 2, flat + lean, flat + high, 0.0, flat)
    profile.edges.append(edge)
    return Sweep(profile, chainages, offsets, base + heights, side)

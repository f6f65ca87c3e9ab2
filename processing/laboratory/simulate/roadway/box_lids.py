"""Square and oblong lids of boxes for cables, water and gas, on walks and on the carriageway.

Things: ``box_lid`` (pieces: nine of the plate, then its frame), whose truth is a cover. Lids of
walks are given with `box_lids_of`, so that nothing is set up on them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.cover_truth import tell_square_cover
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, grid
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.plan import SIDES
from processing.laboratory.simulate.street.profile import GROUND, ROAD
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import HIGHWAY, URBAN
from processing.laboratory.simulate.street.walk_lines import walk_lines

# Hand holes of power and telephone companies, valve boxes: as they lie in the street, m.
_SIZES_M = ((0.6, 0.6), (0.45, 0.45), (0.9, 0.6), (1.2, 0.6), (0.3, 0.3), (0.25, 0.4))
_SHARES = (0.3, 0.2, 0.15, 0.1, 0.15, 0.1)
_FRAME_M = 0.035
_DEEP_M = 0.012
_APART_M = 0.3
_PIECES = 9


@dataclass(frozen=True)
class BoxLid:
    """A lid's place and measures; lengths in m.

    Attributes
    ----------
    chainage_m, offset_m : float
        Of its middle.
    long_m, wide_m : float
        Along the road and across it, with its frame.
    above_m : float
        How far it stands above the pavement.
    turned_rad : float
    """

    chainage_m: float
    offset_m: float
    long_m: float
    wide_m: float
    above_m: float
    turned_rad: float
    material: Material
    label: int


def add_box_lids(section: StreetSection, built: SectionBuilder) -> None:
    """Add the lids of a section."""
    for lid in (*box_lids_of(section), *_on_road(section)):
        _add_lid(section, built, lid)


def box_lids_of(section: StreetSection) -> Iterator[BoxLid]:
    """The lids in a section's walks: away from lowered curbs and tactile blocks."""
    plan = section.plan
    for side in SIDES:
        lines = walk_lines(section, side)
        if lines is None or side in plan.junctions:
            continue
        random = section.chance("box lids", side)
        mean = plan.length_m / (14.0 if plan.style is URBAN else 40.0)
        ends: list[tuple[float, float]] = []
        for _ in range(int(random.poisson(mean))):
            lid = _drawn(random, plan.start_m, plan.end_m, GROUND)
            share = float(random.random())
            low, high = lid.chainage_m - lid.long_m / 2, lid.chainage_m + lid.long_m / 2
            ramps = [(one.from_m, one.to_m) for one in section.layout.sides[side].drops]
            near = (low - _APART_M < end and high + _APART_M > start for start, end in ends + ramps)
            inner, outer = lines.between(np.array([low, high]))
            if plan.side(side).has_tactile:
                outer = np.interp([low, high], lines.chainages, lines.bend)
            first, last = inner.max() + 0.1 + lid.wide_m / 2, outer.min() - 0.1 - lid.wide_m / 2
            if any(near) or last < first:
                continue
            ends.append((low, high))
            yield replace(lid, offset_m=side * float(first + share * (last - first)))


def _on_road(section: StreetSection) -> Iterator[BoxLid]:
    plan = section.plan
    random = section.chance("box lids of the road")
    if plan.style is HIGHWAY:
        return
    for _ in range(int(random.poisson(plan.length_m / 70.0))):
        lid = _drawn(random, plan.start_m, plan.end_m, ROAD)
        side, share = int(random.choice([-1, 1])), float(random.random())
        low = plan.median_m / 2 + 0.4 + lid.wide_m / 2
        high = plan.side(side).edge_m - 0.3 - lid.wide_m / 2
        if high > low and side not in plan.junctions:
            yield replace(lid, offset_m=side * (low + share * (high - low)))


def _drawn(random: Generator, start: float, end: float, label: int) -> BoxLid:
    long, wide = _SIZES_M[int(random.choice(len(_SIZES_M), p=_SHARES))]
    if random.random() < 0.4:
        long, wide = wide, long
    kinds = (Material.STEEL, Material.OLD_CONCRETE, Material.PAVING)
    shares = (0.5, 0.35, 0.15) if label == GROUND else (0.85, 0.15, 0.0)
    settled = 0.02 if random.random() < 0.05 else 0.006
    return BoxLid(
        float(random.uniform(start + 0.8, end - 0.8)),
        0.0,
        long,
        wide,
        float(random.uniform(0.002, settled)),
        float(random.normal(0, 0.01)),
        kinds[int(random.choice(3, p=shares))],
        label,
    )


def _add_lid(section: StreetSection, built: SectionBuilder, lid: BoxLid) -> None:
    """A plate in a steel frame, both on the pavement's surface."""
    instance = built.thing("box_lid")
    half = np.array([lid.long_m, lid.wide_m]) / 2
    inner = half - _FRAME_M
    shares = np.linspace(-1.0, 1.0, 4)
    own = np.stack(np.meshgrid(shares, shares, indexing="ij"), axis=-1)
    plate = grid(_placed(section, lid, own * inner, lid.above_m))
    pieces = np.repeat(np.arange(_PIECES), 2)
    built.mesh.add(plate, lid.material, lid.label, instance, piece=pieces)
    edge = np.concatenate([own[:-1, 0], own[-1, :-1], own[:0:-1, -1], own[0, ::-1]])
    rows = [
        _placed(section, lid, edge * size, above)
        for size, above in ((inner, lid.above_m), (half, lid.above_m), (half, -_DEEP_M))
    ]
    built.mesh.add(grid(np.stack(rows)), Material.STEEL, lid.label, instance, piece=_PIECES)
    ends = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) * half
    corners = _placed(section, lid, ends, lid.above_m)
    lies_in = "walk" if lid.label == GROUND else "carriageway"
    where = corners, lid.chainage_m, lies_in
    tell_square_cover(built, where, "manhole_area", (instance, _PIECES))


def _placed(section: StreetSection, lid: BoxLid, own: Floats, above_m: float) -> Floats:
    cosine, sine = np.cos(lid.turned_rad), np.sin(lid.turned_rad)
    along = own[..., 0] * cosine - own[..., 1] * sine
    across = own[..., 0] * sine + own[..., 1] * cosine
    return section.position(lid.chainage_m + along, lid.offset_m + across, above_m)

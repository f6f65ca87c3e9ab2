"""Gutters across the mouths of side streets (横断側溝): a channel under a row of gratings.

Things: ``gutter`` (channel and rims), ``grating`` (pieces: see `lid_shapes`), ``slab`` (what is
cast in concrete at both ends). Truth: one polygon for each grating; each gutter is a run.
"""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.gutters.aprons import grating_facts
from processing.laboratory.simulate.gutters.beds import GUTTER, Bed, Channel, add_channel
from processing.laboratory.simulate.gutters.covers import corners_of, cover_placement
from processing.laboratory.simulate.gutters.lid_shapes import SIDES_PIECE, Grating, grating_pieces
from processing.laboratory.simulate.gutters.runs import CoverPosition, CoverTilts
from processing.laboratory.simulate.roadway.junctions import (
    CARRIAGEWAY_COLUMNS,
    street_height,
    street_sides,
)
from processing.laboratory.simulate.roadway.transverse import transverse_of
from processing.laboratory.simulate.scene.cover_truth import tell_square_cover
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, grid
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.layout import SideLayout
from processing.laboratory.simulate.street.section import StreetSection

_GAP_M, _JOINT_M = 0.004, 0.006
_RIM_M = 0.02
_LEAST_END_M = 0.05


def add_transverse_gutters(section: StreetSection, built: SectionBuilder) -> None:
    """Add the gutters across a section's side streets."""
    for side in section.plan.junctions:
        part = section.layout.sides[side]
        beside = None if part.mouth is None else transverse_of(section, part.mouth)
        if beside is not None:
            _add_gutter(section, built, _bed(section, part, beside))


def _bed(section: StreetSection, part: SideLayout, beside: tuple[float, float]) -> Bed:
    """The opening that the side street's asphalt leaves, on its own nodes."""
    mouth, track = part.mouth, part.corners[0].track
    if mouth is None:
        raise ValueError("no side street here")
    low, high = street_sides(part.corners, np.array(beside))
    share = np.linspace(0.0, 1.0, CARRIAGEWAY_COLUMNS)
    lines = []
    for row, deep in enumerate(beside):
        along = low[row] + share * (high[row] - low[row])
        depth = np.full(along.size, deep)
        chainage, offset = track.placed(along, depth)
        height = street_height(section, mouth, track, along, depth)
        lines.append((chainage, section.alignment.at(chainage, offset, height)))
    return Bed(mouth.side, lines[0][0], lines[0][1], lines[1][1])


def _add_gutter(section: StreetSection, built: SectionBuilder, bed: Bed) -> None:
    random = section.chance("transverse gutter", bed.side)
    wide = bed.least_width_m
    deep, high = float(random.uniform(0.25, 0.5)), float(random.uniform(0.032, 0.06))
    rim = float(random.uniform(_RIM_M, 0.2 * wide))
    opening = wide - 2 * rim
    channel = Channel(rim, opening, min(0.03, 0.2 * opening), high, deep)
    silt = np.full(bed.chainages.size, float(random.uniform(0.0, 0.3 * deep)))
    worn = Material.OLD_CONCRETE if random.random() < 0.6 else Material.CONCRETE
    run = add_channel(built, bed, channel, silt, (worn, Material.SOIL))
    line = bed.line(rim + opening / 2)
    arcs = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1)))
    long = float(random.choice([0.5, 0.995]))
    count = int((arcs[-1] - 2 * _LEAST_END_M) / (long + _JOINT_M))
    start = (arcs[-1] - count * (long + _JOINT_M)) / 2
    first = start + np.arange(count) * (long + _JOINT_M)
    positions = [CoverPosition("grating", float(one), long, 0.0) for one in first]
    lie = CoverTilts(*(random.normal(0, one, count) for one in (0.0015, 0.002, 0.003)))
    covers = cover_placement(line, bed.outer - bed.inner, arcs, positions, lie)
    bar = float(random.uniform(0.005, 0.009))
    shape = grating_pieces(
        Grating(long, opening - 2 * _GAP_M, high, max(2 * bar, random.uniform(0.015, 0.035)), bar)
    )
    for number in range(count):
        instance = built.thing("grating")
        own = covers.moved(number, shape.vertices), shape.triangles
        built.mesh.add(own, Material.GRATING, GUTTER, instance, piece=shape.piece)
        ring = corners_of(covers, number, long, opening - 2 * _GAP_M)
        facts = grating_facts((opening - 2 * _GAP_M, long), (run, number), bed.side)
        chainage = float(np.interp(first[number] + long / 2, arcs, bed.chainages))
        built.truth.append(TrueFeature("gutters", "Polygon", ring, facts, instance, chainage))
        where = ring[:4], chainage, "gutter"
        tell_square_cover(built, where, "rain_inlet", (instance, SIDES_PIECE), is_asked=False)
    _add_ends(built, bed, channel, (arcs, start), worn)


def _add_ends(
    built: SectionBuilder, bed: Bed, channel: Channel, run: tuple[Floats, float], worn: Material
) -> None:
    """Concrete between the last gratings and the side street's curbs."""
    arcs, rest = run
    edges = [bed.line(channel.lid_at_m + at) for at in (0.0, channel.opening_m)]
    for low, high in ((0.0, rest - _JOINT_M), (arcs[-1] - rest + _JOINT_M, arcs[-1])):
        along = np.concatenate([[low], arcs[(arcs > low) & (arcs < high)], [high]])
        near, far = (
            np.column_stack([np.interp(along, arcs, edge[:, axis]) for axis in range(3)])
            for edge in edges
        )
        slab = built.thing("slab")
        built.mesh.add(grid(np.stack([near, far], axis=1)), worn, GUTTER, slab)

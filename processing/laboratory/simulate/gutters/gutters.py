"""Covered U-gutters: channel, lids with drain holes, gratings, dirt, and their truth.

Things: ``gutter`` (the channel with its rims), ``lid`` and ``grating`` (pieces: see
`lid_shapes`), ``slab`` (a stretch cast in concrete, no feature of the ledger), ``soil``,
``litter`` and ``weeds`` on them. Truth: one polygon for each lid and grating, on its top.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.gutters.beds import (
    GUTTER,
    Bed,
    Channel,
    add_channel,
    beds_of,
    channel_of,
    squeeze_share,
)
from processing.laboratory.simulate.gutters.covers import (
    CoverPlacement,
    HoleRow,
    corners_of,
    cover_pieces,
    cover_placement,
    holes_of,
    plugs_between,
    uncovered_share,
)
from processing.laboratory.simulate.gutters.dirt import add_heaps, add_plugs
from processing.laboratory.simulate.gutters.lid_shapes import SIDES_PIECE, CoverShape
from processing.laboratory.simulate.gutters.runs import (
    CoverPosition,
    CoverStyle,
    cover_positions_of,
    cover_style_of,
    cover_tilts_of,
    wide_m,
)
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.cover_truth import tell_square_cover
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, grid
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.plan import LEFT
from processing.laboratory.simulate.street.section import StreetSection

_CAST_M = 0.02  # a wider rest of a run is closed by concrete
_BEND_STEP_M = 2.0
_REPLACED_SHARE = 0.04
_BASIN_DEEPER_M = 0.15
_BLIND_SHARE, _CHIPPED_SHARE, _CHIPS = 0.12, 0.3, 4
"""Of the lids of a gutter as worn as any: those without holes, which replaced broken ones; those
with an end that is broken away, in so many shapes."""


@dataclass(frozen=True)
class _Gutter:
    """One gutter of a section while it is built."""

    bed: Bed
    habit: CoverStyle
    channel: Channel
    wide_m: float
    arcs: Floats
    worn: Material

    @property
    def middle_m(self) -> float:
        """From the bed's inner edge to the middle of the lids."""
        return self.channel.lid_at_m + self.channel.opening_m / 2

    @property
    def line(self) -> Floats:
        """The lids' middle line at the bed's nodes: (n, 3)."""
        return self.bed.line(self.middle_m)


def add_gutters(section: StreetSection, built: SectionBuilder) -> None:
    """Add what fills the strips that the ground leaves open for covered gutters."""
    for bed in beds_of(section):
        random = section.chance("gutters", bed.side)
        gutter = _gutter(section, bed)
        positions = _positions(random, gutter)
        floor, silt = _silt(random, gutter, positions)
        run = add_channel(built, bed, gutter.channel, floor, (gutter.worn, silt))
        heaps = add_heaps(random, built, bed, gutter.arcs)
        _add_slabs(built, gutter, positions)
        covers = cover_placement(
            gutter.line,
            gutter.bed.outer - gutter.bed.inner,
            gutter.arcs,
            positions,
            cover_tilts_of(random, gutter.habit.wear, len(positions)),
        )
        rows = _add_covers(random, built, gutter, positions, covers)
        order = 0
        for number, (position, row) in enumerate(zip(positions, rows, strict=True)):
            if row is None:
                continue
            facts = {
                "kind": "gutter",
                "type": position.what,
                "width_m": round(gutter.wide_m, 4),
                "length_m": round(position.long_m, 4),
                "run": run,
                "order": order,
                "holes": row.count,
                "hole_length_m": row.long_m,
                "hole_width_m": row.wide_m,
                "side": "left" if bed.side == LEFT else "right",
                "uncovered": uncovered_share(
                    heaps, position, gutter.wide_m, gutter.middle_m, bed.side
                ),
            }
            ring = corners_of(covers, number, position.long_m, gutter.wide_m)
            middle = position.start_m + position.long_m / 2
            chainage = float(np.interp(middle, gutter.arcs, bed.chainages))
            built.truth.append(
                TrueFeature("gutters", "Polygon", ring, facts, row.instance, chainage)
            )
            if position.what == "grating":
                where, which = (ring[:4], chainage, "gutter"), (row.instance, SIDES_PIECE)
                tell_square_cover(built, where, "rain_inlet", which, is_asked=False)
            order += 1
        _add_plugs(random, built, positions, (covers, rows))


def _gutter(section: StreetSection, bed: Bed) -> _Gutter:
    """What a gutter keeps along all sections whose side is alike."""
    plan = section.plan.side(bed.side)
    own = chance(section.seed, "gutter", bed.side, round(plan.drain_m * 1e6))
    wide = bed.usual_width_m
    habit = cover_style_of(own, wide, 1.0 / max(_line_bend(bed.chainages, bed.inner), 1e-6))
    lid = wide_m(habit, wide)
    channel = channel_of(own, wide, lid + 2 * habit.gap_m)
    middle = bed.line(channel.lid_at_m + channel.opening_m / 2)
    steps = np.linalg.norm(np.diff(middle, axis=0), axis=1)
    arcs = np.concatenate([[0.0], np.cumsum(steps)])
    is_worn = own.random() < 0.3 + 0.5 * habit.wear
    worn = Material.OLD_CONCRETE if is_worn else Material.CONCRETE
    return _Gutter(bed, habit, channel, lid, arcs, worn)


def _positions(random: Generator, gutter: _Gutter) -> list[CoverPosition]:
    """The covers of a gutter, where its bed is as wide as they need."""
    first, last = gutter.bed.usual_nodes()
    start, end = float(gutter.arcs[first]), float(gutter.arcs[last])
    positions = cover_positions_of(random, gutter.habit, end - start, _bend(gutter))
    return [replace(one, start_m=one.start_m + start) for one in positions]


def _bend(gutter: _Gutter) -> float:
    return _line_bend(gutter.arcs, gutter.line)


def _line_bend(along: Floats, line: Floats) -> float:
    """The sharpest curvature of a line in plan, 1/m, over some metres."""
    at = np.linspace(along[0], along[-1], max(2, int((along[-1] - along[0]) / _BEND_STEP_M) + 1))
    directions = np.diff([np.interp(at, along, line[:, axis]) for axis in range(2)], axis=1)
    headings = np.unwrap(np.arctan2(directions[1], directions[0]))
    if headings.size < 2:
        return 0.0
    return float(np.abs(np.diff(headings)).max() / (at[1] - at[0]))


def _silt(
    random: Generator, gutter: _Gutter, positions: list[CoverPosition]
) -> tuple[Floats, Material]:
    """Height of what lies on the channel's floor at each node, and what it is."""
    arcs = gutter.arcs
    knots = np.arange(0.0, arcs[-1] + 5.0, 4.0)
    most = gutter.channel.deep_m - gutter.channel.thick_m - 0.06
    level = float(random.uniform(0.0, 0.6)) ** 2 * most
    height = np.interp(arcs, knots, level * random.uniform(0.2, 1.8, knots.size))
    for position in positions:
        if position.what == "grating" and position.long_m < 0.9:
            height -= np.where(np.abs(arcs - position.start_m - 0.3) < 0.5, _BASIN_DEEPER_M, 0.0)
    names = (Material.OLD_CONCRETE, Material.SOIL, Material.WATER)
    shares = (0.4, 0.5, 0.1)
    return np.minimum(height, most), names[int(random.choice(3, p=shares))]


def _add_slabs(built: SectionBuilder, gutter: _Gutter, positions: list[CoverPosition]) -> None:
    """Add what is cast in concrete in place of lids, and the rest at the run's end."""
    stretches = [(one.start_m, one.start_m + one.long_m) for one in positions if one.what == "slab"]
    last = positions[-1].start_m + positions[-1].long_m if positions else 0.0
    if positions and positions[0].start_m > _CAST_M:
        stretches.append((0.0, positions[0].start_m))
    if gutter.arcs[-1] - last > _CAST_M:
        stretches.append((last, float(gutter.arcs[-1])))
    start, end = gutter.channel.lid_at_m, gutter.channel.lid_at_m + gutter.channel.opening_m
    squeezed = squeeze_share(gutter.bed, end)
    edges = gutter.bed.line(start * squeezed), gutter.bed.line(end * squeezed)
    deep = np.array([0.0, 0.0, gutter.channel.thick_m])
    for low, high in stretches:
        along = np.concatenate(
            [[low], gutter.arcs[(gutter.arcs > low) & (gutter.arcs < high)], [high]]
        )
        near, far = (
            np.column_stack([np.interp(along, gutter.arcs, edge[:, axis]) for axis in range(3)])
            for edge in edges
        )
        instance = built.thing("slab")
        built.mesh.add(grid(np.stack([near, far], axis=1)), gutter.worn, GUTTER, instance)
        for at in (0, -1):
            top = np.stack([near[at], far[at]])
            built.mesh.add(grid(np.stack([top, top - deep])), gutter.worn, GUTTER, instance)


def _add_covers(
    random: Generator,
    built: SectionBuilder,
    gutter: _Gutter,
    positions: list[CoverPosition],
    covers: CoverPlacement,
) -> list[HoleRow | None]:
    """Add lids and gratings; what holes each has, None where there is neither."""
    rows: list[HoleRow | None] = []
    shapes: dict[tuple[object, ...], CoverShape] = {}
    made = random.random((len(positions), 2))
    for number, position in enumerate(positions):
        if position.what not in ("lid", "grating"):
            rows.append(None)
            continue
        is_new, is_other = made[number] < (_REPLACED_SHARE, 0.3)
        # Of all lids alike, whether one is blind or chipped says what is left of its own number.
        rest = float(made[number, 1])
        holes = holes_of(
            gutter.habit,
            gutter.wide_m,
            position,
            is_other=bool(is_new and is_other),
            is_blind=not is_new and rest > 1.0 - _BLIND_SHARE * gutter.habit.wear,
        )
        is_chipped = not is_new and rest < _CHIPPED_SHARE * gutter.habit.wear**2
        chip = int(rest * 1e6) % _CHIPS if is_chipped else -1
        key = (position.what, round(position.long_m, 6), holes.count, chip)
        if key not in shapes:
            own = chance(number, "chip", int(rest * 1e6)) if is_chipped else random
            shapes[key] = cover_pieces(
                own, (gutter.habit, gutter.channel), position, holes, is_chipped=is_chipped
            )
        shape = shapes[key]
        material = Material.CONCRETE if is_new else gutter.worn
        instance = built.thing(position.what)
        built.mesh.add(
            (covers.moved(number, shape.vertices), shape.triangles),
            Material.GRATING if position.what == "grating" else material,
            GUTTER,
            instance,
            piece=shape.piece,
        )
        rows.append(holes.of(instance))
    return rows


def _add_plugs(
    random: Generator,
    built: SectionBuilder,
    positions: list[CoverPosition],
    laid: tuple[CoverPlacement, list[HoleRow | None]],
) -> None:
    """Add soil in some holes: few in a clean gutter, most in one that nobody cleans."""
    share = float(random.random()) ** 3
    filled = random.random(len(positions)) < share
    depths = random.uniform(0.004, 0.07, len(positions))
    covers, rows = laid
    plugs = [
        corners
        for number in range(len(positions) - 1)
        if filled[number]
        for corners in plugs_between(covers, positions, rows, number, depth_m=depths[number])
    ]
    if plugs:
        add_plugs(built, np.array(plugs))

"""What stands in yards and at their front: walls, fences, gates, carports, machines."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.border.along import pipe, posts, stations, sweep_section, wall
from processing.laboratory.simulate.border.houses import Plot
from processing.laboratory.simulate.border.line_things import LineThing, spacing_of
from processing.laboratory.simulate.border.parts import BELOW_M, BorderPart, block, merge_parts
from processing.laboratory.simulate.border.wall_lines import add_block_outline, add_swept_wall
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import grid
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.section import StreetSection

OTHER = 1

_WALLS = (Material.CONCRETE, Material.OLD_CONCRETE, Material.BRICK, Material.PLASTER)
_POST_M = 0.35
"""Thickness of a gate's posts."""

_BEHIND_WALL_M = 0.25  # walls along front lines are up to 0.2 m thick
_NO_WALL_SHARE = {"shop": 0.9, "parking": 0.45, "empty": 0.5, "greenhouse": 0.7, "hall": 0.4}


def add_boundary(
    random: Generator,
    section: StreetSection,
    built: SectionBuilder,
    offset_m: float,
    lot: tuple[str, float, float],
) -> None:
    """Add a wall or fence along a lot's front, open at a gate.

    Parameters
    ----------
    offset_m : float
        Of the front line.
    lot : (str, float, float)
        Kind of the lot, its chainages from and to.
    """
    kind, start, end = lot
    if random.random() < _NO_WALL_SHARE.get(kind, 0.2):
        return
    gate = min(float(random.uniform(2.5, 5.0)), (end - start) * 0.5)
    at = float(random.uniform(start + 0.3, end - 0.3 - gate))
    choice, wall_kind = random.random(), _WALLS[int(random.integers(len(_WALLS)))]
    high, thick = float(random.uniform(0.6, 2.0)), float(random.uniform(0.1, 0.2))
    has_posts = choice < 0.5 and kind == "house"
    wide, tall = float(random.uniform(0.25, 0.5)), float(random.uniform(1.1, 1.7))
    room = wide if has_posts else 0.0  # posts stand at the ends of the wall, not in it
    for low, far in ((start, at - room), (at + gate + room, end)):
        if far - low < 0.5:
            continue
        along = stations(low, far)
        if choice < 0.5:
            shape = sweep_section(section, along, offset_m, wall(thick, high))
            instance = built.thing("wall")
            built.mesh.add(shape, wall_kind, OTHER, instance)
            add_swept_wall(section, built, instance, (low, far, offset_m), ("wall", high, 0.0))
        elif choice < 0.75:
            base = min(high, 0.7)
            shape = sweep_section(section, along, offset_m, wall(thick, base))
            instance = built.thing("wall")
            built.mesh.add(shape, wall_kind, OTHER, instance)
            add_swept_wall(section, built, instance, (low, far, offset_m), ("wall", base, 0.0))
            add_bars(random, section, built, (low, far, offset_m + 0.05), (base, high * 0.6))
        else:
            add_mesh_fence(section, built, (low, far, offset_m), high + 0.2)
    if has_posts:
        _add_gate_posts(section, built, (at, at + gate, offset_m), (wide, tall))


def add_mesh_fence(
    section: StreetSection, built: SectionBuilder, line: tuple[float, float, float], high_m: float
) -> None:
    """Add a fence of wire mesh that beams partly pass, with posts every two metres.

    Parameters
    ----------
    line : (float, float, float)
        Chainages from and to, offset, m.
    """
    low, far, offset = line
    along = stations(low, far, 2.0)
    thing = LineThing(section, built, "fence", line)
    sheet = sweep_section(section, along, offset, [(0.0, 0.05), (0.0, high_m)], is_closed=False)
    thing.add(sheet, Material.NET)
    feet = section.position(along, offset)
    thing.add(posts(feet, 0.024, high_m), Material.PAINTED_METAL)
    rail = sweep_section(section, along, offset, pipe(0.016, high_m, 4))
    thing.add(rail, Material.PAINTED_METAL)
    thing.tell("fence", high_m, spacing_of(low, far, 2.0))


def add_bars(
    random: Generator,
    section: StreetSection,
    built: SectionBuilder,
    line: tuple[float, float, float],
    heights: tuple[float, float],
) -> None:
    """Add a fence of upright bars between two rails.

    Parameters
    ----------
    line : (float, float, float)
        Chainages from and to, offset, m.
    heights : (float, float)
        Where it begins above the ground, and how high it is, m.
    """
    low, far, offset = line
    base, high = heights
    thing = LineThing(section, built, "fence", line)
    spacing = float(random.uniform(0.1, 0.25))
    bars = section.position(stations(low, far, spacing), offset, base)
    thing.add(posts(bars, 0.01, high, sides=3, below_m=0.0), Material.PAINTED_METAL)
    for above in (base + 0.06, base + high - 0.03):
        rail = sweep_section(section, stations(low, far, 2.0), offset, pipe(0.018, above, 4))
        thing.add(rail, Material.PAINTED_METAL)
    thing.tell("other", base + high)  # it stands on a wall, whose line the map shows


def _add_gate_posts(
    section: StreetSection,
    built: SectionBuilder,
    line: tuple[float, float, float],
    size: tuple[float, float],
) -> None:
    low, far, offset = line
    wide, high = size
    for at in (low - wide, far):
        shape = sweep_section(section, stations(at, at + wide), offset, wall(_POST_M, high))
        instance = built.thing("gate")
        built.mesh.add(shape, Material.BRICK, OTHER, instance)
        rear = offset + np.sign(offset) * _POST_M
        ring = section.position([at, at + wide, at + wide, at], [offset, offset, rear, rear])
        add_block_outline(section, built, instance, ring, ("other", high))


def yard_parts(
    random: Generator, plot: Plot, kind: str, parts: list[BorderPart], *, front_m: float
) -> Iterator[tuple[str, BorderPart]]:
    """What stands in a yard, with its kind: carports, vending machines, wheel stops.

    Parameters
    ----------
    parts : list of BorderPart
        The building's; its first part is its body.
    front_m : float
        How far its body stands behind the front line.
    """
    if kind == "parking":
        yield from _wheel_stops(random, plot)
    if kind in ("shop", "parking", "hall") and random.random() < 0.4 and front_m > 1.1:
        yield from _machines(random, plot)
    if kind == "house" and parts and random.random() < 0.6:
        xs = parts[0][0][0][:, 0]
        for low, high in ((-plot.half_m, float(xs.min())), (float(xs.max()), plot.half_m)):
            if high - low > 2.7:
                yield "carport", _carport(random, (low + 0.1, min(high - 0.1, low + 3.2)))
                return


def _machines(random: Generator, plot: Plot) -> Iterator[tuple[str, BorderPart]]:
    """Vending machines: some 1.0–1.2 m wide, 0.75 m deep, 1.83 m high."""
    count = int(random.integers(1, 4))
    x = float(random.uniform(-plot.half_m, max(plot.half_m - count * 1.3, -plot.half_m + 0.1)))
    for _ in range(count):
        wide = float(random.uniform(0.9, 1.2))
        if x + wide > plot.half_m:
            return
        body = block((x, x + wide), (_BEHIND_WALL_M, 1.0), (-BELOW_M, 1.83))
        yield "vending_machine", (body, Material.PAINTED_METAL)
        x += wide + float(random.uniform(0.02, 0.12))


def _wheel_stops(random: Generator, plot: Plot) -> Iterator[tuple[str, BorderPart]]:
    y, bay = float(random.uniform(5.0, 6.5)), float(random.uniform(2.3, 2.7))
    xs = np.arange(-plot.half_m + bay / 2, plot.half_m - bay / 2, bay)
    stops = [
        block((x + shift - 0.3, x + shift + 0.3), (y, y + 0.12), (-0.1, 0.11))
        for x in xs
        for shift in (-0.5, 0.5)
    ]
    if stops:
        yield "wheel_stop", (merge_parts(stops), Material.CONCRETE)


def _carport(random: Generator, across: tuple[float, float]) -> BorderPart:
    """Two or four thin posts and a bent sheet on top."""
    x0, x1 = across
    start, deep = float(random.uniform(0.5, 1.5)), float(random.uniform(4.6, 5.6))
    high, bend = float(random.uniform(2.1, 2.5)), float(random.uniform(0.0, 0.35))
    share = np.linspace(0, 1, 7)
    arch = np.column_stack([x0 + share * (x1 - x0), high + bend * np.sin(np.pi * share)])
    rows = np.stack(
        [np.column_stack([arch[:, 0], np.full(7, y), arch[:, 1]]) for y in (start, start + deep)]
    )
    sides = (x0,) if random.random() < 0.4 else (x0, x1 - 0.07)
    legs = [
        block((x, x + 0.07), (y, y + 0.07), (-BELOW_M, high))
        for x in sides
        for y in (start + 0.4, start + deep - 0.5)
    ]
    return merge_parts([grid(rows), *legs]), Material.PAINTED_METAL

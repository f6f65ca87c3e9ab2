"""Markings of the carriageway: lines, crossings, stop lines, arrows and speeds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadway.junctions import street_height, street_sides
from processing.laboratory.simulate.roadway.paint import Rectangle, dashes
from processing.laboratory.simulate.roadway.strokes import PaintedStroke, add_strokes, truth_line
from processing.laboratory.simulate.roadway.transverse import transverse_of
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import grid
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.corner_track import CornerTrack
from processing.laboratory.simulate.street.junction_shape import Mouth
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SIDES
from processing.laboratory.simulate.street.profile import ROAD
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import RURAL, URBAN

# Widths and patterns of the ordinance on signs and markings (道路標識、区画線及び道路標示に関する
# 命令, 1960, table 4) and of the police's standards for markings.
_LINE_M = 0.15
_STRIPE_M = 0.45
_STOP_M = 0.45
_STOP_BEFORE_M = 2.0
_NARROW_M = 2.6  # lanes below this have no centre line
_SEGMENTS = {
    "3": "abgcd", "4": "fgbc", "5": "afgcd", "6": "afgecd", "0": "abcdef", "8": "abcdefg",
}  # fmt: skip
_SIDE_PAINT_M = 0.003


def add_markings(section: StreetSection, built: SectionBuilder) -> None:
    """Add the paint of a section."""
    random = section.chance("markings")
    habits = chance(section.seed, "markings")
    wear = 0.3 * float(habits.random()) ** 2
    crossing: list[PaintedStroke] = []
    if section.plan.style is URBAN and not section.plan.junctions and random.random() < 0.3:
        crossing = [*_crossing(section, random)]
    strokes = [*_lines(section, habits, crossing)]
    if section.plan.junctions:
        add_strokes(section, built, strokes, (random, wear))
        for side in section.plan.junctions:
            _add_side_street(section, built, side, random, wear)
        return
    if not crossing and random.random() < 0.5:
        strokes += [PaintedStroke((one,), "other") for one in symbols_of(section, random)]
    add_strokes(section, built, strokes + crossing, (random, wear))


def _lines(
    section: StreetSection, habits: Generator, crossing: list[PaintedStroke]
) -> Iterator[PaintedStroke]:
    plan = section.plan
    start, end = plan.start_m, plan.end_m
    has_edges = plan.style is not RURAL or habits.random() < 0.7
    is_solid = habits.random() < 0.4
    pattern = (5.0, 5.0) if habits.random() < 0.5 else (6.0, 9.0)
    breaks = [one.mouth for one in section.layout.sides.values() if one.mouth is not None]
    whole = _whole(start, end, breaks)
    if crossing:
        painted = [one for stroke in crossing for one in stroke.rectangles]
        low, high = min(one[0] for one in painted), max(one[1] for one in painted)
        whole = [(start, low), (high, end)]
    if plan.median_m <= 0 and plan.lane_m >= _NARROW_M:
        for low, high in whole:
            yield from _line(low, high, 0.0, None if is_solid or plan.lanes > 1 else pattern)
    for side in SIDES:
        for lane in range(1, plan.lanes):
            offset = side * (plan.median_m / 2 + lane * plan.lane_m)
            for low, high in whole if crossing else [(start, end)]:
                yield from _line(low, high, offset, (6.0, 9.0))
        own = [one for one in breaks if one.side == side]
        yield from _borders(section, side, (whole, _whole(start, end, own)), has_edges=has_edges)


def _borders(
    section: StreetSection,
    side: int,
    stretches: tuple[list[tuple[float, float]], list[tuple[float, float]]],
    *,
    has_edges: bool,
) -> Iterator[PaintedStroke]:
    """The lines along the median and along the road's edge."""
    plan = section.plan
    if plan.median_m > 0:
        for low, high in stretches[0]:
            yield from _line(low, high, side * (plan.median_m / 2 + 0.25), None)
    if has_edges:
        half = plan.lanes * plan.lane_m + plan.median_m / 2
        for low, high in stretches[1]:
            yield from _line(low, high, side * half, None)


def _whole(start: float, end: float, mouths: list[Mouth]) -> list[tuple[float, float]]:
    """The stretches before and behind the mouths of side streets."""
    if not mouths:
        return [(start, end)]
    return [(start, min(one.from_m for one in mouths)), (max(one.to_m for one in mouths), end)]


def _line(
    start: float, end: float, offset: float, pattern: tuple[float, float] | None
) -> Iterator[PaintedStroke]:
    right, left = offset - _LINE_M / 2, offset + _LINE_M / 2
    if pattern is None:
        yield PaintedStroke(((start, end, right, left),), "solid")
        return
    ends = [
        (max(float(first), start), min(float(first) + pattern[0], end))
        for first in dashes(start, end, *pattern)
    ]
    rectangles = tuple((low, high, right, left) for low, high in ends if high > low)
    if rectangles:
        yield PaintedStroke(rectangles, "broken", pattern)


def _crossing(section: StreetSection, random: Generator) -> Iterator[PaintedStroke]:
    """A zebra crossing with its stop lines, where a curb is lowered if there is one."""
    plan = section.plan
    wide = float(random.uniform(3.0, 4.5))
    positions = [
        (drop.from_m + drop.to_m) / 2
        for one in section.layout.sides.values()
        for drop in one.drops
        if drop.high_m <= 0.03
    ]
    clear = wide / 2 + _STOP_BEFORE_M + _STOP_M
    if plan.length_m < 2 * clear + 1 or plan.median_m > 0:
        return
    middle = (
        positions[0]
        if positions
        else float(random.uniform(0.3, 0.7)) * plan.length_m + plan.start_m
    )
    middle = min(max(middle, plan.start_m + clear), plan.end_m - clear)
    low, high = middle - wide / 2, middle + wide / 2
    right, left = -plan.right.edge_m + 0.3, plan.left.edge_m - 0.3
    for offset in np.arange(right, left - _STRIPE_M, 2 * _STRIPE_M):
        bar = (low, high, float(offset), float(offset) + _STRIPE_M)
        yield PaintedStroke((bar,), "crosswalk_bar")
    before, behind = low - _STOP_BEFORE_M, high + _STOP_BEFORE_M
    yield PaintedStroke(((before - _STOP_M, before, 0.1, left),), "stop_line")
    yield PaintedStroke(((behind, behind + _STOP_M, right, -0.1),), "stop_line")


def symbols_of(section: StreetSection, random: Generator) -> Iterator[Rectangle]:
    """An arrow or a speed in each lane of one direction; arrows tell lanes of a town apart."""
    plan = section.plan
    if plan.length_m < 16 or plan.lane_m < _NARROW_M:
        return
    side = LEFT if random.random() < 0.6 else RIGHT
    at = plan.start_m + float(random.uniform(4.0, plan.length_m - 10.0))
    has_arrows = random.random() >= 0.5 and plan.style is URBAN and plan.lanes > 1
    first = "3456"[int(random.integers(4))]
    for lane in range(plan.lanes):
        offset = plan.lane_offset_m(lane)
        shapes = _arrow() if has_arrows else _speed(first)
        for low, high, right, left in shapes:
            if side == LEFT:
                yield at + low, at + high, offset + right, offset + left
            else:
                yield at - high, at - low, -offset - left, -offset - right


def _arrow() -> Iterator[Rectangle]:
    yield 0.0, 3.0, -0.075, 0.075
    for step in range(8):
        half = 0.4 * (1 - step / 8)
        yield 3.0 + step * 0.25, 3.25 + step * 0.25, -half, half


def _speed(first: str) -> Iterator[Rectangle]:
    """Two digits, 5 m high and 0.5 m wide, of seven strokes, as read in the lane's direction."""
    bar, tall, wide = 0.6, 5.0, 0.5
    thin = 0.13
    for digit, left in ((first, 0.65), ("0", -0.15)):
        right = left - wide
        strokes: dict[str, Rectangle] = {
            "a": (tall - bar, tall, right, left),
            "g": ((tall - bar) / 2, (tall + bar) / 2, right, left),
            "d": (0.0, bar, right, left),
            "f": ((tall + bar) / 2, tall - bar, left - thin, left),
            "b": ((tall + bar) / 2, tall - bar, right, right + thin),
            "e": (bar, (tall - bar) / 2, left - thin, left),
            "c": (bar, (tall - bar) / 2, right, right + thin),
        }
        for name in _SEGMENTS[digit]:
            yield strokes[name]


def _add_side_street(
    section: StreetSection, built: SectionBuilder, side: int, random: Generator, wear: float
) -> None:
    """Add the crossing and the stop line of a side street."""
    part = section.layout.sides[side]
    if part.mouth is None:
        return
    deepest = max(one.radius_m for one in part.mouth.corners)
    wide = float(random.uniform(2.5, 3.5))
    first = deepest * float(random.uniform(0.6, 1.0)) + 0.4
    gutter = transverse_of(section, part.mouth)
    has_zebra = random.random() < 0.6 and gutter is None
    stop = first + (wide + 1.0 if has_zebra else 0.0)
    if gutter is not None:
        stop = gutter[1] + 0.5
    track = part.corners[0].track
    low, high = street_sides(part.corners, np.array([first + wide, stop]))
    if has_zebra:
        for left in np.arange(low[0] + 0.3, high[0] - 0.3 - _STRIPE_M, 2 * _STRIPE_M):
            where = (float(left), float(left) + _STRIPE_M, first, first + wide)
            _add_patch(section, built, (part.mouth, track), where, (random, wear))
    if random.random() < 0.8:
        middle = float(low[1] + high[1]) / 2
        ends = (float(low[1]) + 0.3, middle - 0.05)
        if side == LEFT:
            ends = (middle + 0.05, float(high[1]) - 0.3)
        where = (*ends, stop, stop + _STOP_M)
        _add_patch(section, built, (part.mouth, track), where, (random, wear))


def _add_patch(
    section: StreetSection,
    built: SectionBuilder,
    street: tuple[Mouth, CornerTrack],
    where: tuple[float, float, float, float],
    worn: tuple[Generator, float],
) -> None:
    """Add paint on a side street: from and to which place along the road, and beside it."""
    low, high, near, far = where
    random, wear = worn
    beside = np.linspace(near, far, int(np.ceil((far - near) / 0.3)) + 1)
    along = np.linspace(low, high, int(np.ceil((high - low) / 0.3)) + 1)
    flat, deep = np.meshgrid(along, beside)
    height = street_height(section, street[0], street[1], flat, deep) + _SIDE_PAINT_M
    chainage, offset = street[1].placed(flat, deep)
    vertices, triangles = grid(section.alignment.at(chainage, offset, height))
    kept = np.repeat(random.random(triangles.shape[0] // 2) >= wear, 2)
    instance = built.last_thing("marking")
    is_bar = far - near > high - low
    middles = (np.full(beside.size, (low + high) / 2), beside)
    if not is_bar:
        middles = (along, np.full(along.size, (near + far) / 2))
    number = np.arange(len(triangles)) // 2
    piece = number // (along.size - 1) if is_bar else number % (along.size - 1)
    built.mesh.add((vertices, triangles[kept]), Material.PAINT, ROAD, instance, piece=piece[kept])
    at, away = street[1].placed(*middles)
    line = section.alignment.at(at, away, street_height(section, street[0], street[1], *middles))
    wide = high - low if is_bar else far - near
    built.truth.append(truth_line(section, instance, line, wide, is_bar=is_bar))

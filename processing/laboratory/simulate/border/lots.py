"""Lots beside the street: which building stands on each, behind which wall or fence.

Things: ``building`` (label 6), ``wall``, ``fence``, ``gate``, ``carport``, ``vending_machine``,
``wheel_stop`` (label 1); pieces are not told apart.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.border.houses import (
    Building,
    Plot,
    flats,
    greenhouse,
    hall,
    house,
    second_row,
    shop,
)
from processing.laboratory.simulate.border.parts import BorderPart
from processing.laboratory.simulate.border.wall_lines import add_body_outlines
from processing.laboratory.simulate.border.yards import add_boundary, yard_parts
from processing.laboratory.simulate.scene.mesh import Floats, place_shape
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePositions
from processing.laboratory.simulate.street.plan import LEFT, SIDES
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import URBAN

BUILDING = 6

_END_M = 0.4  # between a section's end and its first lot
_LEAST_M = 6.0  # a narrower rest stays empty
_MOST_FALL_M = 1.4  # over a lot: steeper ones stay empty
_FRONT_GAP_M = 0.3
_WALL_M = 0.25  # kept free along front lines for walls and gates

_KINDS: Mapping[str, tuple[Building | None, float, float]] = {
    "house": (house, 0.36, 0.5),
    "shop": (shop, 0.25, 0.05),
    "flats": (flats, 0.17, 0.0),
    "hall": (hall, 0.04, 0.18),
    "greenhouse": (greenhouse, 0.0, 0.1),
    "parking": (None, 0.1, 0.05),
    "empty": (None, 0.08, 0.12),
}


@dataclass(frozen=True)
class Lot:
    """A piece of land at the street.

    Attributes
    ----------
    from_m, to_m : float
        Chainages.
    front_m : float
        Distance of its front line from the road's centre.
    back_m : float
        How far what is built stands behind it at least: a straight front at a bend.
    plot : Plot
        What of it can be built on.
    """

    side: int
    from_m: float
    to_m: float
    front_m: float
    back_m: float
    plot: Plot

    @property
    def middle_m(self) -> float:
        """Chainage of its middle."""
        return (self.from_m + self.to_m) / 2

    def heading(self, section: StreetSection) -> float:
        """Of its own x axis, so that its y axis leads away from the street."""
        return section.heading(self.middle_m) + (0.0 if self.side == LEFT else np.pi)


def lots_of(section: StreetSection, side: int) -> Iterator[Lot]:
    """The lots along one side of a section; none where a side street meets it."""
    plan = section.plan.side(side)
    outside = plan.band("outside")
    if plan.outside != "lots" or side in section.plan.junctions or outside is None:
        return
    random = section.chance("lots", side)
    front = outside.inner_m + 1.5 * abs(plan.outside_high_m) + _FRONT_GAP_M
    is_urban = section.plan.style is URBAN
    at = section.plan.start_m + _END_M
    while True:
        wide = float(random.uniform(6.5, 18.0) if is_urban else random.uniform(12.0, 26.0))
        deep = float(random.uniform(10.0, 22.0))
        end = section.plan.end_m - _END_M
        wide = end - at if end - at - wide < _LEAST_M else wide
        if end - at < _LEAST_M:
            return
        bend = side * _bend(section, at, at + wide)
        # On the inner side of a bend lots grow narrower away from the road, and the road's edge
        # comes nearer at both ends of a straight front.
        shares = [1.0 - bend * away for away in (front, front + deep)]
        built_on = wide * float(min(*shares, 1.0)) - 0.6
        back = max(bend, 0.0) * wide**2 / 8
        if built_on >= _LEAST_M - 1.0:
            yield Lot(side, at, at + wide, front, back, Plot(built_on, deep))
        at += wide


def _bend(section: StreetSection, from_m: float, to_m: float) -> float:
    """The curvature to the left that matters most within a stretch, 1/m."""
    alignment = section.alignment
    along = np.linspace(from_m, to_m, 9)
    bends = np.interp(along, alignment.chainages, alignment.curvatures)
    return float(bends[np.abs(bends).argmax()])


def add_lots(positions: FreePositions, built: SectionBuilder) -> None:
    """Add buildings, walls, fences and what stands in yards."""
    section = positions.section
    for side in SIDES:
        for number, lot in enumerate(lots_of(section, side)):
            random = section.chance("lot", side * (number + 1))
            _add_lot(random, positions, built, lot)


def _add_lot(random: Generator, positions: FreePositions, built: SectionBuilder, lot: Lot) -> None:
    section = positions.section
    column = 1 if section.plan.style is URBAN else 2
    names = list(_KINDS)
    shares = np.array([_KINDS[one][column] for one in names], np.float64)
    kind = names[int(random.choice(len(names), p=shares / shares.sum()))]
    where, fall = _ground(section, lot)
    made = _KINDS[kind][0] if fall < _MOST_FALL_M else None
    heading = lot.heading(section)
    parts = made(random, lot.plot) if made is not None else []
    if parts:
        instance = _add_parts(built, parts, where, heading, "building")
        add_body_outlines(section, built, instance, parts, (where, heading))
        _block(positions, lot, parts)
    if lot.back_m == 0.0 and random.random() < (0.5 if section.plan.style is URBAN else 0.1):
        behind = second_row(random, lot.plot)
        instance = _add_parts(built, behind, where, heading, "building")
        add_body_outlines(section, built, instance, behind, (where, heading))
        _block(positions, lot, behind)
    front = float(parts[0][0][0][:, 1].min()) if parts else lot.plot.deep_m
    for name, part in yard_parts(random, lot.plot, kind, parts, front_m=front):
        _add_parts(built, [part], where, heading, name)
    add_boundary(random, section, built, lot.side * lot.front_m, (kind, lot.from_m, lot.to_m))
    line = lot.side * lot.front_m
    positions.block((lot.from_m, lot.to_m), (line - _WALL_M, line + _WALL_M))


def _add_parts(
    built: SectionBuilder, parts: list[BorderPart], where: Floats, heading: float, kind: str
) -> int:
    """Add a thing of some parts; its instance."""
    instance = built.thing(kind)
    label = BUILDING if kind == "building" else 1
    for shape, material in parts:
        built.mesh.add(place_shape(shape, where.tolist(), heading), material, label, instance)
    return instance


def _ground(section: StreetSection, lot: Lot) -> tuple[Floats, float]:
    """The place of a lot's front middle on its mean height, and how far its ground falls."""
    along = np.linspace(lot.from_m, lot.to_m, 5)[:, None]
    away = lot.side * (lot.front_m + np.array([[0.0, 4.0, 8.0]]))
    heights = section.ground.height(along, away)
    where = section.position(lot.middle_m, lot.side * (lot.front_m + lot.back_m))
    where[2] = heights.mean()
    return where, float(np.ptp(heights))


def _block(positions: FreePositions, lot: Lot, parts: list[BorderPart]) -> None:
    corners = np.concatenate([shape[0] for shape, _ in parts])[:, :2]
    low, high = corners.min(axis=0), corners.max(axis=0)
    # The lot's x axis runs against the chainage on the right.
    along = np.array([low[0], high[0]]) * (1.0 if lot.side == LEFT else -1.0)
    away = lot.side * (lot.front_m + lot.back_m + np.array([low[1], high[1]]))
    positions.block(
        (lot.middle_m + float(along.min()), lot.middle_m + float(along.max())),
        (float(away.min()), float(away.max())),
    )

"""Lines and areas cut at the edges of map sheets: the vertex on an edge is in both sheets."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby, pairwise

import numpy as np

from processing.formats.survey.map_sheets import SHEET_X_MM, SHEET_Y_MM, MapSheet, sheet_at

PlaceMm = tuple[int, int, int]
"""X (north), Y (east), height in whole millimetres."""

SheetPart = tuple[MapSheet, tuple[PlaceMm, ...]]


def cut_line(zone: int, places: Sequence[PlaceMm]) -> Iterator[SheetPart]:
    """The parts of a line, each with the sheet that it is on, along the line.

    Heights at edges are interpolated along the line. Places that follow on the same place are one.

    Raises
    ------
    OutOfRange
        No sheet of the zone has it.
    """
    steps = [
        step for start, end in pairwise(places) for step in pairwise(_crossed(start, end))
        if step[0] != step[1]
    ]  # fmt: skip
    for sheet, group in groupby(steps, key=lambda step: _sheet_of_step(zone, *step)):
        members = list(group)
        yield sheet, (members[0][0], *(end for _, end in members))


def cut_area(zone: int, ring: Sequence[PlaceMm]) -> Iterator[SheetPart]:
    """The parts of an area, each with its sheet; outlines whose first place is not repeated.

    Raises
    ------
    OutOfRange
        No sheet of the zone has it.
    """
    import shapely

    xs, ys = ([place[axis] for place in ring] for axis in (0, 1))
    first = sheet_at(zone, min(xs), min(ys))
    south, west = first.south_west_mm
    if max(xs) <= south + SHEET_X_MM and max(ys) <= west + SHEET_Y_MM:
        yield first, tuple(ring)
        return
    area = shapely.Polygon(ring)
    area = area if area.is_valid else shapely.make_valid(area)
    for x in range(south, max(xs), SHEET_X_MM):
        for y in range(west, max(ys), SHEET_Y_MM):
            common = area.intersection(shapely.box(x, y, x + SHEET_X_MM, y + SHEET_Y_MM))
            for part in shapely.get_parts(common):
                # A touching edge or corner is no part of the area.
                if part.geom_type == "Polygon":
                    yield sheet_at(zone, x, y), _whole_mm(shapely.get_coordinates(
                        part.exterior, include_z=True
                    ))  # fmt: skip


def _whole_mm(xyz: np.ndarray) -> tuple[PlaceMm, ...]:
    return tuple((round(x), round(y), round(z)) for x, y, z in xyz[:-1].tolist())


def _crossed(start: PlaceMm, end: PlaceMm) -> list[PlaceMm]:
    """A stretch with the places at which it crosses edges; on the edge to the millimetre."""
    found: list[tuple[float, PlaceMm]] = [(0.0, start), (1.0, end)]
    for axis, size in ((0, SHEET_X_MM), (1, SHEET_Y_MM)):
        low, high = sorted((start[axis], end[axis]))
        for edge in range((low // size + 1) * size, high, size):
            share = (edge - start[axis]) / (end[axis] - start[axis])
            place = [round(a + share * (b - a)) for a, b in zip(start, end, strict=True)]
            place[axis] = edge
            found.append((share, (place[0], place[1], place[2])))
    return [place for _, place in sorted(found)]


def _sheet_of_step(zone: int, start: PlaceMm, end: PlaceMm) -> MapSheet:
    return sheet_at(zone, (start[0] + end[0]) / 2, (start[1] + end[1]) / 2)

"""Words beside features so that all can be read: the best of some candidate places for each.

A place is refused where its words would cover other words or a symbol, or leave the window; of the
others the one that crosses the fewest lines is taken, and of equals the first. What has no place
is given back. The order is that of the labels: those that have the least choice come first.

References
----------
Christensen, Marks, Shieber 1995, An empirical study of algorithms for point-feature label
placement: candidate positions, chosen greedily.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from processing.formats.sheets.paper_shapes import PaperPlace, words_width

_GAP_MM = 0.6
_RINGS_MM = (0.0, 2.5)
_SHARES = (0.5, 0.35, 0.65, 0.2, 0.8, 0.1, 0.9)
_UPRIGHT = math.pi / 2 + math.radians(3.0)
"""Words beside a line that goes up all but straight read upwards, as the sheet is turned by hand:
lines across one road do not read one way and the other."""

_LINE_ROOM = 1.25
"""Height of a box, of that of its letters."""


@dataclass(frozen=True)
class SheetLabel:
    """Words that belong to a feature on a sheet.

    Attributes
    ----------
    feature : str
        Its id.
    shape : shapely.Geometry
        The feature on paper, mm: a point, a line, or a polygon.
    reach : float
        How far the feature's symbol reaches, mm.
    """

    feature: str
    words: str
    height: float
    shape: shapely.Geometry
    reach: float = 0.0


@dataclass(frozen=True)
class LabelPlace:
    """Where words are: their middle, mm, and how they lie, counter-clockwise."""

    middle: PaperPlace
    angle_deg: float = 0.0


def place_labels(
    labels: Sequence[SheetLabel],
    window: shapely.Polygon,
    lines: Sequence[shapely.Geometry],
    symbols: Sequence[shapely.Geometry],
) -> list[LabelPlace | None]:
    """Places for labels, in their order; None where there is none.

    Parameters
    ----------
    window : shapely.Polygon
        Of the map, mm on paper.
    lines : sequence of shapely.Geometry
        What words should not cross.
    symbols : sequence of shapely.Geometry
        What words must not cover.
    """
    crossed = shapely.STRtree(lines)
    covered = shapely.STRtree(symbols)
    shapely.prepare(window)
    taken: list[shapely.Geometry] = []
    found: list[LabelPlace | None] = [None] * len(labels)
    ranks = {"Polygon": 0, "LineString": 1, "Point": 2}
    order = sorted(range(len(labels)), key=lambda at: ranks.get(labels[at].shape.geom_type, 3))
    for at in order:
        best: tuple[int, LabelPlace, shapely.Geometry] | None = None
        for place in _candidates(labels[at]):
            box = _box(place, words_width(labels[at].words, labels[at].height), labels[at].height)
            if not window.contains(box) or len(covered.query(box, predicate="intersects")):
                continue
            if taken and shapely.intersects(np.array(taken, dtype=object), box).any():
                continue
            count = len(crossed.query(box, predicate="intersects"))
            if best is None or count < best[0]:
                best = count, place, box
            if count == 0:
                break
        if best is not None:
            found[at] = best[1]
            taken.append(best[2])
    return found


def _box(place: LabelPlace, width: float, height: float) -> shapely.Geometry:
    tall = height * _LINE_ROOM
    cos, sin = (one(math.radians(place.angle_deg)) for one in (math.cos, math.sin))
    corners = [
        (
            place.middle[0] + x * width * cos - y * tall * sin,
            place.middle[1] + x * width * sin + y * tall * cos,
        )
        for x, y in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))
    ]
    return shapely.Polygon(corners)


def _candidates(label: SheetLabel) -> Iterator[LabelPlace]:
    width, height = words_width(label.words, label.height), label.height * _LINE_ROOM
    match label.shape.geom_type:
        case "Point":
            yield from _around(label.shape.coords[0], label.reach, (width, height))
        case "LineString":
            yield from _along(label.shape, height)
        case _:
            yield from _inside(label.shape, (width, height))


def _around(place: PaperPlace, reach: float, size: tuple[float, float]) -> Iterator[LabelPlace]:
    """Right, left, above, below, then the corners; then the same farther away."""
    ways = ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1))
    for ring in _RINGS_MM:
        away = reach + _GAP_MM + ring
        for x, y in ways:
            off = away * (0.8 if x and y else 1.0)
            yield LabelPlace(
                (place[0] + x * (off + size[0] / 2), place[1] + y * (off + size[1] / 2))
            )


def _along(line: shapely.LineString, height: float) -> Iterator[LabelPlace]:
    """Above and below the line at places along it."""
    for share in _SHARES:
        middle = line.interpolate(share, normalized=True)
        step = min(1.0, line.length / 20)
        at = share * line.length
        start, end = line.interpolate(max(0.0, at - step)), line.interpolate(at + step)
        direction = math.atan2(end.y - start.y, end.x - start.x)
        if not _UPRIGHT - math.pi < direction <= _UPRIGHT:
            direction += math.pi
        off = height / 2 + _GAP_MM
        for side in (1, -1):
            x = middle.x - side * off * math.sin(direction)
            y = middle.y + side * off * math.cos(direction)
            yield LabelPlace((x, y), (math.degrees(direction) + 180) % 360 - 180)


def _inside(area: shapely.Polygon, size: tuple[float, float]) -> Iterator[LabelPlace]:
    """The middle, a place within, steps around it, then outside the area."""
    inner = area.representative_point()
    for x, y in ((area.centroid.x, area.centroid.y), (inner.x, inner.y)):
        yield LabelPlace((x, y))
        for step in (1, -1, 2, -2):
            yield LabelPlace((x, y + step * size[1]))
    west, south, east, north = area.bounds
    middle = ((west + east) / 2, (south + north) / 2)
    reach = (east - west) / 2, (north - south) / 2
    for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        yield LabelPlace(
            (
                middle[0] + x * (reach[0] + _GAP_MM + size[0] / 2),
                middle[1] + y * (reach[1] + _GAP_MM + size[1] / 2),
            )
        )

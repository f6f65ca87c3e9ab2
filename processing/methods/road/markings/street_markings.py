"""Markings of a survey: all heads and passes together, in the plan of the road."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.markings.marking_confidence import MarkingFacts, chance_of, facts_of
from processing.methods.road.markings.marking_lines import MarkingLine, MarkingType, markings_of
from processing.methods.road.markings.paint_raster import (
    HeadTones,
    PaintRaster,
    cells_per_tile,
    head_tones,
    paint_raster,
    road_extent,
)
from processing.methods.road.markings.stroke_kernels import surface_kernel
from processing.methods.road.markings.strokes import strokes_of
from processing.methods.road.objects.driven_path import driven_places
from processing.methods.road.objects.survey import survey_ground
from processing.recording.drive import Drive

_STRAIGHT_M = 0.003
"""Vertices that lie so near to the line through the others say nothing."""

_ASKED_PLACES, _ASIDE_M, _APART_M = 7, 0.1, 4
"""Places of a marking from which the road is looked at towards the vehicle's way, the step along
that look, and how many steps lie between heights that are compared: 0.4 m, wider than a curb."""


@dataclass(frozen=True)
class StreetMarking:
    """One marking.

    Attributes
    ----------
    type : str
    line : (n, 3) float64
        Along its middle, on the road, m, project CRS.
    width_m : float
    pattern_m : (dash, gap) or None
        Of a broken line.
    painted_m : float
        Length of its paint.
    paint : float
        Of the drive's usual contrast of paint: worn and dirty ones have less.
    confidence : float
        The share of its like that are markings.
    """

    type: MarkingType
    line: Floats
    width_m: float
    pattern_m: tuple[float, float] | None
    painted_m: float
    paint: float
    confidence: float


@dataclass(frozen=True)
class FoundMarkings:
    """What was found, and how well the heads told paint from road.

    Attributes
    ----------
    markings : tuple of StreetMarking
    heads : tuple of HeadTones
    """

    markings: tuple[StreetMarking, ...]
    heads: tuple[HeadTones, ...]


@dataclass(frozen=True)
class SeenMarkings:
    """Markings before their confidence.

    Attributes
    ----------
    raster : PaintRaster or None
        None where no head told paint from road.
    markings : tuple of (MarkingLine, MarkingFacts)
    heads : tuple of HeadTones
    """

    raster: PaintRaster | None
    markings: tuple[tuple[MarkingLine, MarkingFacts], ...]
    heads: tuple[HeadTones, ...]


def street_markings(drives: Sequence[Drive], monitor: Monitor) -> FoundMarkings:
    """All strokes of paint on a road and what they make.

    Notes
    -----
    1. The road's own tone is told place by place for each head; what is brighter is paint.
    2. Paint is put into a raster of the plan; strokes with road on both sides are followed on it,
       their edges where paint falls by half.
    3. Strokes are joined to lines, broken lines, stop lines and bars of crossings.
    """
    seen = seen_markings(drives, monitor)
    if seen.raster is None:
        return FoundMarkings((), seen.heads)
    markings = [
        _street_marking(seen.raster, one, chance_of(facts))
        for one, facts in seen.markings
        if one.type != "other"
    ]
    on_road = [one for one in markings if len(one.line) >= 2]
    return FoundMarkings(tuple(sorted(on_road, key=lambda one: -one.confidence)), seen.heads)


def seen_markings(drives: Sequence[Drive], monitor: Monitor) -> SeenMarkings:
    """Markings with what speaks for them."""
    if not any(drive.count for drive in drives):
        return SeenMarkings(None, (), ())
    plan, ground = survey_ground(drives, PartMonitor(monitor, 0.0, 0.3))
    path = driven_places(drives, plan)
    road = road_extent(plan, ground, path)
    heads = []
    for number, drive in enumerate(drives):
        share = 0.3 + 0.2 * np.array([number, number + 1]) / len(drives)
        part = PartMonitor(monitor, float(share[0]), float(share[1]))
        heads.append(head_tones(drive, road, part))
    told = [head for head in heads if head.contrast > 0]
    if not told:
        return SeenMarkings(None, (), tuple(heads))
    part = PartMonitor(monitor, 0.5, 0.8)
    raster = paint_raster(drives, heads, road, cells_per_tile(told), part)
    strokes = strokes_of(raster, PartMonitor(monitor, 0.8, 0.95))
    monitor.check()
    found = markings_of(strokes, path)
    monitor.check()
    steps = _steps_to_way(raster, found)
    facts = [facts_of(one, step) for one, step in zip(found, steps, strict=True)]
    monitor.report(1.0)
    return SeenMarkings(raster, tuple(zip(found, facts, strict=True)), tuple(heads))


def _street_marking(raster: PaintRaster, marking: MarkingLine, chance: float) -> StreetMarking:
    import shapely

    line = np.asarray(
        shapely.get_coordinates(shapely.LineString(marking.line).simplify(_STRAIGHT_M))
    )
    xyz = np.column_stack([line, _heights_along(raster, line)]) + raster.plan.origin
    known = np.isfinite(xyz[:, 2])
    return StreetMarking(
        marking.type,
        xyz[known],
        marking.width_m,
        marking.pattern_m,
        marking.painted_m,
        marking.mean_of("paint"),
        chance,
    )


def _heights_along(raster: PaintRaster, line: Floats) -> Floats:
    """The road's height at places of a line, between those that were measured; NaN: none was."""
    heights = np.empty(len(line))
    surface_kernel(line, raster.table, raster.heights, heights)
    known = np.flatnonzero(np.isfinite(heights))
    if known.size == 0:
        return heights
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T))]
    return np.asarray(np.interp(along, along[known], heights[known]))


def _steps_to_way(raster: PaintRaster, markings: Sequence[MarkingLine]) -> list[float]:
    """The highest step between each marking and the vehicle's way: a curb; NaN: nothing tells."""
    from scipy.spatial import cKDTree

    if not len(raster.path):
        return [float("nan")] * len(markings)
    tree = cKDTree(raster.path)
    steps = []
    for one in markings:
        asked = one.line[np.linspace(0, len(one.line) - 1, _ASKED_PLACES).astype(np.int64)]
        nearest = np.asarray(tree.query(asked)[1])
        found = [
            highest_step(raster.table, raster.heights, place, raster.path[way])
            for place, way in zip(asked, nearest.tolist(), strict=True)
        ]
        told = [step for step in found if np.isfinite(step)]
        steps.append(float(np.median(told)) if told else float("nan"))
    return steps


def highest_step(table: NDArray[np.int32], surface: Floats, start: Floats, end: Floats) -> float:
    """The most that the road rises or falls beyond its slope, on the way between two places.

    Parameters
    ----------
    table : (nx, ny) int32
        The numbers of the tiles of ``surface``.
    surface : (tiles × 64²,) float64
        Its heights in cells of 20 cm, m; NaN where it wasn't seen.

    Returns
    -------
    float
        m; NaN where nothing was seen.
    """
    long = float(np.hypot(*(end - start)))
    share = np.arange(0.0, long, _ASIDE_M)[:, None] / max(long, _ASIDE_M)
    places = start + share * (end - start)
    heights = np.empty(len(places))
    surface_kernel(places, table, surface, heights)
    known = np.flatnonzero(np.isfinite(heights))
    if known.size == 0:
        return float("nan")
    # Faces of curbs and what they hide aren't seen: what was seen last goes on there.
    last = np.searchsorted(known, np.arange(len(heights)), "right") - 1
    heights = heights[known[np.maximum(last, 0)]]
    if len(heights) <= _APART_M:
        return 0.0
    rises = heights[_APART_M:] - heights[:-_APART_M]
    return float(np.abs(rises - np.median(rises)).max())

"""Covers of a survey: all heads and passes together, in the plan of road and walks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import Monitor, PartMonitor, parts_of
from processing.core.worked_ahead import in_order
from processing.methods.road.covers.cover_confidence import (
    RoadCoverFacts,
    chance_of,
    edge_means,
    facts_of,
)
from processing.methods.road.covers.cover_fits import FittedCover, fitted_covers, without_overlaps
from processing.methods.road.covers.cover_raster import CoverRaster, cover_raster
from processing.methods.road.markings.paint_raster import HeadTones, head_tones, road_extent
from processing.methods.road.markings.street_markings import highest_step
from processing.methods.road.objects.driven_path import driven_places
from processing.methods.road.objects.survey import survey_ground
from processing.recording.drive import Drive

CoverType = Literal["round", "square", "grating"]
CoverGround = Literal["carriageway", "walk", ""]

_CURB_M = 0.05
"""A step between a cover and the vehicle's way that makes what it lies in a walk; ruts and crowns
of roads are flatter over 0.4 m, lowered curbs 2 to 5 cm high."""

_OPEN_SHARE = 0.08
"""Of the points within a grating that lie below its top, at least: no other cover lets any through,
and noise makes one of a hundred."""


@dataclass(frozen=True)
class StreetCover:
    """One cover.

    Attributes
    ----------
    type : str
        ``round``, ``square`` (any with four corners) or ``grating``.
    middle : (3,) float64
        On its top, m, project CRS.
    corners : (4, 3) float64
        Round it; of a round one the square about it. m, project CRS.
    sides_m : (float, float)
        Length and width; of a round one its diameter twice.
    direction_deg : float
        Of its length, clockwise from north, 0 to 180.
    raised_m : float
        How far its rim stands above the road about it.
    lies_in : str
        ``carriageway``, ``walk`` (behind a curb); empty without a trajectory.
    confidence : float
        The share of its like that are covers.
    facts : RoadCoverFacts
        What that was told by.
    """

    type: CoverType
    middle: Floats
    corners: Floats
    sides_m: tuple[float, float]
    direction_deg: float
    raised_m: float
    lies_in: CoverGround
    confidence: float
    facts: RoadCoverFacts


@dataclass(frozen=True)
class FoundCovers:
    """What was found, and how well the heads told brightness.

    Attributes
    ----------
    shapes : int
        How many there are that may be covers, likely or not.
    covers : tuple of StreetCover
        Those that are likely enough, the likeliest first.
    heads : tuple of HeadTones
    """

    shapes: int
    covers: tuple[StreetCover, ...]
    heads: tuple[HeadTones, ...]


@dataclass(frozen=True)
class SeenCovers:
    """Shapes in the surface before their confidence.

    Attributes
    ----------
    raster : CoverRaster or None
        None where there are no points.
    covers : tuple of (FittedCover, RoadCoverFacts)
        They may overlap.
    heads : tuple of HeadTones
    """

    raster: CoverRaster | None
    covers: tuple[tuple[FittedCover, RoadCoverFacts], ...]
    heads: tuple[HeadTones, ...]


def street_covers(drives: Sequence[Drive], least: float, monitor: Monitor) -> FoundCovers:
    """All shapes in road and walks that may be covers; a confidence tells which are.

    Parameters
    ----------
    least : float
        The confidence below which nothing is told.

    Notes
    -----
    1. Brightness over the road's own tone, height and what lies below are put into a raster.
    2. Places that differ from the road on their sides are fitted by circles and rectangles.
    3. The likelier of shapes that overlap stays; a step towards the vehicle's way tells walks.
    """
    seen = seen_covers(drives, monitor)
    if seen.raster is None:
        return FoundCovers(0, (), seen.heads)
    chances = np.array([chance_of(facts) for _, facts in seen.covers])
    fitted = [one for one, _ in seen.covers]
    kept = without_overlaps(fitted, chances)
    surface = seen.raster.surface()
    told = (
        _street_cover(seen.raster, surface, seen.covers[one], float(chances[one]))
        for one in kept
        if chances[one] >= least
    )
    covers = tuple(told)
    monitor.report(1.0)
    return FoundCovers(len(kept), covers, seen.heads)


def seen_covers(drives: Sequence[Drive], monitor: Monitor) -> SeenCovers:
    """Shapes with what speaks for them."""
    if not any(drive.count for drive in drives):
        return SeenCovers(None, (), ())
    plan, ground = survey_ground(drives, PartMonitor(monitor, 0.0, 0.3))
    road = road_extent(plan, ground, driven_places(drives, plan))
    parts = parts_of(PartMonitor(monitor, 0.3, 0.5), [1.0] * len(drives))

    def of_head(number: int) -> HeadTones:
        return head_tones(drives[number], road, parts[number])

    heads = list(in_order(of_head, range(len(drives))))
    raster = cover_raster(drives, heads, road, ground, PartMonitor(monitor, 0.5, 0.7))
    fitted = fitted_covers(raster, PartMonitor(monitor, 0.7, 0.95))
    monitor.check()
    return SeenCovers(raster, tuple((one, facts_of(one)) for one in fitted), tuple(heads))


def _street_cover(
    raster: CoverRaster, surface: Floats, seen: tuple[FittedCover, RoadCoverFacts], chance: float
) -> StreetCover:
    cover, facts = seen
    origin, means = raster.road.plan.origin, edge_means(cover.edge)
    off = cover.corners - cover.middle
    heights = cover.plane[0] + off @ cover.plane[1:]
    middle = np.append(cover.middle, cover.plane[0])
    return StreetCover(
        type="grating" if means.below >= _OPEN_SHARE else "round" if cover.is_round else "square",
        middle=middle + origin,
        corners=np.column_stack([cover.corners, heights]) + origin,
        sides_m=cover.sides_m,
        direction_deg=(90.0 - math.degrees(cover.angle_rad)) % 180.0,
        raised_m=means.height_m,
        lies_in=_lies_in(raster, surface, cover.middle),
        confidence=chance,
        facts=facts,
    )


def _lies_in(raster: CoverRaster, surface: Floats, middle: Floats) -> CoverGround:
    path = raster.road.path
    if not len(path):
        return ""
    nearest = path[int(np.argmin(((path - middle) ** 2).sum(axis=1)))]
    step = highest_step(raster.road.table, surface, middle, nearest)
    return "walk" if step >= _CURB_M else "carriageway"

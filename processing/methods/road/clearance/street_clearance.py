"""What hangs lower over a street than the law lets it: all heads and passes together.

Over a carriageway 4.5 m are kept free, over a walk 2.5 m (建築限界, 道路構造令 第12条). The room is
measured from the surface itself, between the edges of carriageway and walk; its oblique corners
over shoulders, which the ordinance allows, aren't taken off.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.clearance.clearance_confidence import (
    ClearanceFacts,
    chance_of,
    facts_of,
)
from processing.methods.road.clearance.hanging_bodies import (
    HangingBody,
    hanging_bodies,
    touching_cubes,
)
from processing.methods.road.clearance.passed_through import is_passed_through
from processing.methods.road.clearance.points_over_road import PointsOverRoad, points_over_road
from processing.methods.road.clearance.thing_types import ThingKind, ThingType, thing_of
from processing.methods.road.surface.carriageway import edges_of, profiles_of
from processing.methods.road.surface.road_cells import CARRIAGEWAY, WALK, RoadCells, road_cells
from processing.methods.road.surface.road_frame import RoadFrame, driven_lines
from processing.methods.road.surface.road_raster import RoadRaster, road_raster
from processing.recording.drive import Drive

APART_M = 0.75
"""Bodies less than two cubes of this width apart are one place: twigs of a crown."""

_FEW, _SCATTERED = 30, 4.0
"""Fewer points, and fewer for each cube of 0.3 m that they fill, are drops, dust or mixed."""

_LEAST_INSIDE_M = 0.25
"""What reaches less inside the edge may stand outside: edges are told to a cell of 0.2 m."""

_RANK = 2
"""The third lowest point tells the height: one or two may be stray."""


@dataclass(frozen=True)
class ClearanceLimits:
    """Heights to be kept free over carriageway and walk, m."""

    road_m: float
    walk_m: float

    def of(self, part: int) -> float:
        """That over a part of the road."""
        return self.road_m if part == CARRIAGEWAY else self.walk_m


@dataclass(frozen=True)
class ClearancePlace:
    """Where something hangs too low.

    Attributes
    ----------
    xyz : (3,) float64
        A measured point at its lowest, m, project CRS.
    lowest_m : float
        Over the surface below, m.
    limit_m : float
        What should be kept free there.
    is_walk : bool
    type : str
    is_classified : bool
        Whether classes of points said the type, else its shape.
    stretch_m : (float, float)
        From and to which metre of the way that was driven.
    depth_m : float
        How far inside the edge of carriageway or walk it reaches.
    confidence : float
    point, drive : int
        The measured point.
    own_points, own_drives : (n,) int64
        All points of it in the room to be kept free.
    facts : ClearanceFacts
        What its confidence was told from.
    """

    xyz: Floats
    lowest_m: float
    limit_m: float
    is_walk: bool
    type: ThingType
    is_classified: bool
    stretch_m: tuple[float, float]
    depth_m: float
    confidence: float
    point: int
    drive: int
    own_points: Integers
    own_drives: Integers
    facts: ClearanceFacts


@dataclass(frozen=True)
class StreetClearance:
    """What was found over a street.

    Attributes
    ----------
    places : tuple of ClearancePlace
        The likeliest first.
    checked_m2 : float
        Area of the carriageway below which the room was looked at.
    seen_share : float
        Of that area the share on whose side an edge was seen.
    """

    places: tuple[ClearancePlace, ...] = ()
    checked_m2: float = 0.0
    seen_share: float = 0.0


_CELL_M2 = 0.04


class DrivenCells(NamedTuple):
    """Cells of a raster about ways that were driven, and these."""

    cells: RoadCells
    frames: tuple[RoadFrame, ...]


def street_clearance(
    drives: Sequence[Drive], limits: ClearanceLimits, monitor: Monitor
) -> StreetClearance:
    """All that hangs too low over the road that was driven.

    Raises
    ------
    OutOfRange
        The drives lie too far apart.

    Notes
    -----
    1. The surface about the vehicle's way is gathered in cells, with the edges of the carriageway.
    2. Points between 0.3 m and the limit over it are bodies where they touch; bodies that come down
       to the road stand there.
    3. What is left is a place where it lies near to each other.
    """
    lines = driven_lines(drives)
    if not lines or not any(drive.count for drive in drives):
        return StreetClearance()
    raster = road_raster(drives, lines, PartMonitor(monitor, 0.0, 0.6))
    driven = driven_cells(raster, drives, monitor)
    part = PartMonitor(monitor, 0.6, 1.0)
    return clearance_over(drives, (raster, driven.cells), limits, part, driven=driven)


def clearance_over(
    drives: Sequence[Drive],
    below: tuple[RoadRaster, RoadCells],
    limits: ClearanceLimits,
    monitor: Monitor,
    *,
    driven: DrivenCells,
) -> StreetClearance:
    """All that hangs too low over the cells of a road.

    Parameters
    ----------
    driven : DrivenCells
        Cells of the same raster about the ways that were driven.
    """
    raster, road = below
    highest = (limits.road_m, limits.walk_m)
    found = points_over_road(drives, raster.plan, road, highest, PartMonitor(monitor, 0.0, 0.9))
    bodies = [
        one
        for one in hanging_bodies(found, road)
        if not _is_scattered(one)
        and not is_passed_through(one.lines, found, driven.cells, driven.frames)
    ]
    monitor.check()
    every = [_place(found, below, limits, one) for one in _together(found, bodies, monitor)]
    places = [one for one in every if one.depth_m >= _LEAST_INSIDE_M]
    monitor.report(1.0)
    is_road = road.part == CARRIAGEWAY
    area = int(is_road.sum())
    return StreetClearance(
        tuple(sorted(places, key=lambda one: -one.confidence)),
        _CELL_M2 * area,
        float(road.is_seen[is_road].mean()) if area else 0.0,
    )


def driven_cells(raster: RoadRaster, drives: Sequence[Drive], monitor: Monitor) -> DrivenCells:
    """The road about the ways that drives took, as its surface tells it."""
    frames = []
    roads = []
    for line in driven_lines(drives):
        monitor.check()
        frame = RoadFrame.along(line - raster.plan.origin[:2])
        if frame is not None:
            profiles = profiles_of(raster, frame)
            frames.append(frame)
            roads.append((frame, profiles, edges_of(profiles)))
    return DrivenCells(road_cells(raster, roads), tuple(frames))


def _is_scattered(body: HangingBody) -> bool:
    points = body.lines.size
    return points < _FEW and points < _SCATTERED * body.voxels


@dataclass(frozen=True)
class _Gathered:
    """Bodies that are one place."""

    lines: Integers
    part: int
    voxels: int
    kind: ThingKind


def _together(
    found: PointsOverRoad, bodies: Sequence[HangingBody], monitor: Monitor
) -> Iterator[_Gathered]:
    """Bodies over one part of the road that lie near to each other; the largest tells the kind."""
    for part in (CARRIAGEWAY, WALK):
        mine = [one for one in bodies if one.part == part]
        if not mine:
            continue
        lines = np.concatenate([one.lines for one in mine])
        owner = np.repeat(np.arange(len(mine)), [one.lines.size for one in mine])
        group = touching_cubes(found.local[lines], APART_M)
        order = np.argsort(group, kind="stable")
        for chosen in np.split(order, np.flatnonzero(np.diff(group[order])) + 1):
            monitor.check()
            those = [mine[one] for one in np.unique(owner[chosen]).tolist()]
            largest = max(those, key=lambda one: one.lines.size).lines
            yield _Gathered(
                np.sort(lines[chosen]),
                part,
                sum(one.voxels for one in those),
                thing_of(found.codes[lines[chosen]], found.local[largest]),
            )


def _place(
    found: PointsOverRoad,
    below: tuple[RoadRaster, RoadCells],
    limits: ClearanceLimits,
    one: _Gathered,
) -> ClearancePlace:
    raster, road = below
    lines = one.lines
    order = lines[np.argsort(found.over[lines], kind="stable")]
    lowest = int(order[min(_RANK, order.size - 1)])
    cells = found.cells[lines]
    depth = float(road.depth[cells].max())
    stations = road.station[cells]
    heights = (float(found.over[lowest]), limits.of(one.part))
    is_walk = one.part == WALK
    facts = facts_of(
        (lines.size, one.voxels),
        heights,
        depth,
        is_walk=is_walk,
        is_seen=bool(road.is_seen[cells].any()),
    )
    return ClearancePlace(
        xyz=found.local[lowest] + raster.plan.origin,
        lowest_m=heights[0],
        limit_m=heights[1],
        is_walk=is_walk,
        type=one.kind.type,
        is_classified=one.kind.is_classified,
        stretch_m=(float(stations.min()), float(stations.max())),
        depth_m=depth,
        confidence=chance_of(facts),
        point=int(found.points[lowest]),
        drive=int(found.drives[lowest]),
        own_points=found.points[lines],
        own_drives=found.drives[lines],
        facts=facts,
    )

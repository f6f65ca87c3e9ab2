"""Barriers of a survey: all heads and passes together, in the plan of the road."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.barriers.barrier_confidence import likeliest, stretch_chance_of
from processing.methods.road.barriers.barrier_facts import FactWindow, VehicleWay, windows_of
from processing.methods.road.barriers.barrier_lines import (
    BarrierStretch,
    LikelyWindow,
    height_of,
    stretches_of,
)
from processing.methods.road.barriers.barrier_types import BarrierType
from processing.methods.road.barriers.raised_cells import raised_cells
from processing.methods.road.barriers.strip_profiles import StripProfile, profiles_of
from processing.methods.road.barriers.strips import strips_of
from processing.methods.road.objects.driven_path import driven_places
from processing.methods.road.objects.survey import survey_ground
from processing.recording.drive import Drive

_STEP_M, _SAME_M, _SAME_SHARE = 0.25, 0.4, 0.5
"""Between places that are compared; lines so near are one thing: a beam and its posts."""


@dataclass(frozen=True)
class StreetBarrier:
    """One barrier.

    Attributes
    ----------
    type : str
    line : (n, 3) float64
        Its foot on the ground, m, project CRS.
    height_m : float
        Of its top above its foot.
    posts_m : float or None
        From post to post, where they are seen.
    length_m : float
        Along the line in plan.
    confidence : float
        The share of its like that are barriers.
    """

    type: BarrierType
    line: Floats
    height_m: float
    posts_m: float | None
    length_m: float
    confidence: float


@dataclass(frozen=True)
class SeenStrips:
    """Strips with what speaks for them.

    Attributes
    ----------
    origin : (3,) float64
        Of the plan, m, project CRS.
    way : VehicleWay
    strips : tuple of (StripProfile, tuple of FactWindow)
    """

    origin: Floats
    way: VehicleWay
    strips: tuple[tuple[StripProfile, tuple[FactWindow, ...]], ...]


def street_barriers(drives: Sequence[Drive], monitor: Monitor) -> list[StreetBarrier]:
    """All barriers of a survey, the surest first.

    Notes
    -----
    1. Fine cells of the plan tell at which heights something stands; long thin strips of them are
       followed.
    2. Points about each strip make a profile of it, as seen square to it.
    3. Each 3 m of it tell by a few facts how likely they are a barrier; likely ones that follow
       each other are one, and its layers tell what sort.
    """
    if not any(drive.count for drive in drives):
        return []
    seen = seen_strips(drives, monitor)
    stretches = likely_stretches(seen, monitor)
    monitor.report(1.0)
    found = [_barrier(one, seen.origin) for one in stretches]
    return sorted(found, key=lambda one: -one.confidence)


def seen_strips(drives: Sequence[Drive], monitor: Monitor) -> SeenStrips:
    """All strips of a survey with the facts of their windows."""
    plan, ground = survey_ground(drives, PartMonitor(monitor, 0.0, 0.4))
    way = VehicleWay(driven_places(drives, plan))
    cells = raised_cells(drives, plan, ground, PartMonitor(monitor, 0.4, 0.6))
    strips = strips_of(cells, monitor)
    profiles = profiles_of(
        [one.nodes for one in strips], cells, drives, PartMonitor(monitor, 0.6, 0.95)
    )
    seen = []
    for profile in profiles:
        monitor.check()
        seen.append((profile, tuple(windows_of(profile, way))))
    return SeenStrips(plan.origin, way, tuple(seen))


def likely_stretches(seen: SeenStrips, monitor: Monitor) -> list[BarrierStretch]:
    """What follows each other on strips and is likely a barrier, each thing once."""
    stretches: list[BarrierStretch] = []
    for profile, windows in seen.strips:
        monitor.check()
        likely = [LikelyWindow(one.first, one.last, *likeliest(one.options)) for one in windows]
        stretches += stretches_of(profile, likely, seen.way)
    return distinct_stretches(stretches)


def distinct_stretches(stretches: Sequence[BarrierStretch]) -> list[BarrierStretch]:
    """Stretches without those that lie for the most part along a longer and surer one."""
    from scipy.spatial import cKDTree

    kept: list[BarrierStretch] = []
    places = np.empty((0, 2))
    for one in sorted(stretches, key=lambda stretch: -stretch.long_m * stretch.chance):
        own = _places_along(one.line)
        if len(places) and np.mean(cKDTree(places).query(own)[0] < _SAME_M) > _SAME_SHARE:
            continue
        kept.append(one)
        places = np.concatenate([places, own])
    return kept


def _places_along(line: Floats) -> Floats:
    """Places in plan along a line, a quarter of a metre apart."""
    ends = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T))]
    at = np.arange(0.0, ends[-1] + _STEP_M, _STEP_M)
    return np.column_stack([np.interp(at, ends, axis) for axis in line[:, :2].T])


def _barrier(stretch: BarrierStretch, origin: Floats) -> StreetBarrier:
    return StreetBarrier(
        stretch.type,
        stretch.line + origin,
        height_of(stretch),
        stretch.posts_m,
        stretch.long_m,
        stretch_chance_of(stretch.chance, stretch.long_m),
    )

"""Wires of a survey with their sag and how high they hang over the ground and over the road."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.objects.drive_passes import passes_of
from processing.methods.road.objects.driven_path import driven_places
from processing.methods.road.objects.ground_heights import height_of
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.objects.survey import survey_ground
from processing.methods.road.wires.spans import WireSpan, spans_of
from processing.methods.road.wires.wire_confidence import chance_of, facts_of
from processing.methods.road.wires.wire_points import WirePoints, wire_points
from processing.recording.drive import Drive

_STEP_M = 0.5
"""Between vertices: chords of usual wires lie 0.3 mm below the curve."""

_ROAD_M = 3.0
"""What lies so near to the vehicle's path in plan is carriageway: half a lane and the next one's
edge (道路構造令 第5条: lanes of 2.75 to 3.5 m)."""

_SAME_M, _SAME_SHARE, _COMPARED = 0.12, 0.6, 15
"""Wires of two passes so near to each other along so much of the one are one wire: positions of
passes differ by up to a decimetre 10 m above the vehicle. Places that are compared."""


@dataclass(frozen=True)
class WireSettings:
    """What is looked for.

    Attributes
    ----------
    lowest_m : float
        Lines are higher above the ground.
    shortest_m : float
        Length in plan.
    """

    lowest_m: float
    shortest_m: float


@dataclass(frozen=True)
class StreetWire:
    """One wire, as far as it was seen.

    Attributes
    ----------
    line : (n, 3) float64
        Every half metre along it, m, project CRS.
    sag_m : float
        How far it hangs below the straight line between its ends.
    clearance_m : float
        Lowest height over the ground below; NaN over no known ground.
    road_clearance_m : float
        The same over the vehicle's way; NaN where it doesn't hang over it.
    noise_m : float
        How far its points lie off it.
    confidence : float
        The share of its like that are wires.
    points, drives : (n,) int64
        Of each vertex the measured point nearest along the wire by its number in its drive, −1
        where none is near; and which drive it is of.
    own_points, own_drives : (k,) int64
        All measured points on it, in the order along it.
    """

    line: Floats
    sag_m: float
    clearance_m: float
    road_clearance_m: float
    noise_m: float
    confidence: float
    points: Integers
    drives: Integers
    own_points: Integers
    own_drives: Integers


def street_wires(
    drives: Sequence[Drive], settings: WireSettings, monitor: Monitor
) -> tuple[StreetWire, ...]:
    """All thin free lines high above the ground; a confidence tells wires from the others.

    Notes
    -----
    1. A scan line crosses a wire in a short run of points; those that lie on a line with nothing
       close beside it are kept.
    2. Points on each other's lines are of one piece; pieces are fitted as wires hang, split where
       they are held and joined over gaps.
    """
    plan, ground = survey_ground(drives, PartMonitor(monitor, 0.0, 0.4))
    seen = _seen_wires(drives, plan, ground, settings, PartMonitor(monitor, 0.4, 0.9))
    is_over = _PathTree(driven_places(drives, plan))
    wires: list[StreetWire] = []
    for span, found in seen:
        monitor.check()
        at = np.linspace(span.start_m, span.end_m, math.ceil(span.long_m / _STEP_M) + 1)
        line, rests = span.at(at), _rests(span, found.local, at)
        over = line[:, 2] - _ground_below(ground, plan, line)
        wires.append(
            StreetWire(
                line=line + plan.origin,
                sag_m=span.sag_m,
                clearance_m=_least(over),
                road_clearance_m=_least(over[is_over(line)]),
                noise_m=span.noise_m,
                confidence=chance_of(facts_of(span, found.solid)),
                points=np.where(rests >= 0, found.points[rests], -1),
                drives=np.where(rests >= 0, found.drives[rests], 0),
                own_points=found.points[span.lines],
                own_drives=found.drives[span.lines],
            )
        )
    monitor.report(1.0)
    return tuple(sorted(wires, key=lambda one: -one.confidence))


def _seen_wires(
    drives: Sequence[Drive],
    plan: SparsePlan,
    ground: NDArray[np.float32],
    settings: WireSettings,
    monitor: Monitor,
) -> list[tuple[WireSpan, WirePoints]]:
    """Spans of all passes; of one wire that several passes saw, the one with the most points."""
    seen: list[tuple[WireSpan, WirePoints, int]] = []
    passes = passes_of(drives)
    for number, members in enumerate(passes):
        part = PartMonitor(monitor, number / len(passes), (number + 1) / len(passes))
        chosen = [drives[one] for one in members]
        found = wire_points(chosen, plan, ground, settings.lowest_m, part)
        found = replace(found, drives=np.array(members, np.int64)[found.drives])
        spans = spans_of(found, part)
        seen += [(one, found, number) for one in spans if one.long_m >= settings.shortest_m]
    seen.sort(key=lambda one: -one[0].lines.size)
    kept: list[tuple[WireSpan, WirePoints, int]] = []
    for span, found, number in seen:
        if not any(other != number and _is_same(span, one) for one, _, other in kept):
            kept.append((span, found, number))
    return [(span, found) for span, found, _ in kept]


def _is_same(span: WireSpan, other: WireSpan) -> bool:
    """Whether another pass saw a wire already."""
    places = span.at(np.linspace(span.start_m, span.end_m, _COMPARED))
    at = other.along(places)
    beside = (at >= other.start_m) & (at <= other.end_m)
    if beside.mean() < _SAME_SHARE:
        return False
    off = np.linalg.norm(places[beside] - other.at(at[beside]), axis=1)
    return bool(np.median(off) < _SAME_M)


def _rests(span: WireSpan, local: Floats, at: Floats) -> Integers:
    """Of places along a span the line of the nearest point among all; −1: none within a step."""
    along = span.along(local[span.lines])
    after = np.clip(np.searchsorted(along, at), 1, len(along) - 1)
    nearest = np.where(at - along[after - 1] < along[after] - at, after - 1, after)
    is_near = np.abs(along[nearest] - at) <= _STEP_M
    return np.where(is_near, span.lines[nearest], -1)


def _ground_below(ground: NDArray[np.float32], plan: SparsePlan, line: Floats) -> Floats:
    return np.array([height_of(ground, plan, *place) for place in line[:, :2].tolist()])


def _least(heights: Floats) -> float:
    known = heights[np.isfinite(heights)]
    return float(known.min()) if known.size else float("nan")


class _PathTree:
    """Tells which places lie over the vehicle's way."""

    def __init__(self, places: Floats) -> None:
        from scipy.spatial import cKDTree

        self._tree = cKDTree(places) if len(places) else None

    def __call__(self, line: Floats) -> NDArray[np.bool_]:
        """(n,) which of (n, 3) places."""
        if self._tree is None:
            return np.zeros(len(line), np.bool_)
        away, _ = self._tree.query(line[:, :2], distance_upper_bound=_ROAD_M)
        return np.asarray(np.isfinite(away))

"""Curbs as they are delivered: a pair of lines for each stretch of one type."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.map.drafting.needed_positions import needed_positions
from processing.methods.road.curbs.edges.approximate_lines import ApproximateLine
from processing.methods.road.curbs.edges.curb_edges import MeasuredEdges
from processing.methods.road.curbs.edges.curb_lines import CurbLine, in_space
from processing.methods.road.curbs.edges.curb_types import CurbType, TypedPart, typed_parts
from processing.methods.road.curbs.edges.edge_measures import STEP_M

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_OFF_M = 0.002
"""A vertex that moves the line by less is left out: less than edges are known by."""

_LONGEST_M = 5.0
"""Between vertices, so that each rests on points near it."""

_NEAR_M = 0.15
"""A vertex names the nearest measured point within so much, or none: rows of a fast drive are 10 to
30 cm apart. By trial: no measurement is recorded."""

_SHORTEST_M = 0.3
"""Shorter parts are left out: two stations have no mean height. By trial."""

_END_STATIONS = 0.1
"""A whole station nearer to a part's exact end is left out: 2.5 cm, no two vertices lie nearer."""


@dataclass(frozen=True)
class EdgeLine:
    """One edge.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, project CRS, in the direction of the first drive.
    points, drives : (n,) int64
        The measured point nearest to each vertex and whose it is; −1 where bridged.
    """

    xyz: _Floats
    points: _Integers
    drives: _Integers


@dataclass(frozen=True)
class CurbFeature:
    """A stretch of curb of one type.

    Attributes
    ----------
    type : {"curb", "dropped"}
    lower, upper : EdgeLine
    height_m : float
        Mean step.
    bridged_m : float
        How much of it nobody saw.
    confidence : float
    """

    type: CurbType
    lower: EdgeLine
    upper: EdgeLine
    height_m: float
    bridged_m: float
    confidence: float


def features_of(
    approximate_line: ApproximateLine,
    line: CurbLine,
    measured: Sequence[MeasuredEdges],
    confidence: float,
) -> Iterator[CurbFeature]:
    """The stretches of one curb, in the direction of the first drive."""
    parts = typed_parts(line.steps_m)
    for part in parts if approximate_line.is_along else reversed(parts):
        at = _stations(part)
        if (at[-1] - at[0]) * STEP_M < _SHORTEST_M:
            continue
        all_at = np.arange(line.is_seen.size)
        seen = np.interp(at, all_at, line.is_seen.astype(float)) > 0.5
        edges = [
            _edge(approximate_line, _between(frame, at), seen, measured)
            for frame in (line.frame, line.upper_frame)
        ]
        steps = np.interp(at, all_at, line.steps_m)
        spans = np.diff(at) * STEP_M
        mean = float(((steps[1:] + steps[:-1]) / 2 * spans).sum() / spans.sum())
        bridged = float(spans[~(seen[1:] | seen[:-1])].sum())
        yield CurbFeature(part.type, edges[0], edges[1], mean, bridged, confidence)


def _stations(part: TypedPart) -> _Floats:
    """Whole stations within a part, and its exact ends."""
    whole = np.arange(np.ceil(part.first + _END_STATIONS), np.floor(part.last - _END_STATIONS) + 1)
    return np.concatenate([[part.first], whole, [part.last]])


def _between(frame: _Floats, at: _Floats) -> _Floats:
    whole = np.arange(frame.shape[0])
    return np.column_stack([np.interp(at, whole, column) for column in frame.T])


def _edge(
    approximate_line: ApproximateLine,
    frame: _Floats,
    seen: NDArray[np.bool_],
    measured: Sequence[MeasuredEdges],
) -> EdgeLine:
    xyz = in_space(approximate_line, frame)
    points = np.full(seen.size, -1, np.int64)
    drives = np.zeros(seen.size, np.int64)
    least = np.full(seen.size, np.inf)
    kept = _kept(xyz, seen)
    for number, one in enumerate(measured):
        found, away = one.nearest(frame[kept], _NEAR_M)
        better = seen[kept] & (found >= 0) & (away < least[kept])
        which = kept[better]
        points[which], drives[which], least[which] = found[better], number, away[better]
    if not approximate_line.is_along:
        kept = kept[::-1]
    return EdgeLine(xyz[kept], points[kept], drives[kept])


def _kept(xyz: _Floats, seen: NDArray[np.bool_]) -> _Integers:
    """Vertices that the line needs, those at the ends of bridges, and some between."""
    ends = np.flatnonzero(np.diff(seen.astype(np.int8)))
    fixed = np.unique(np.concatenate([[0, seen.size - 1], ends, ends + 1]))
    kept = [fixed]
    for start, stop in itertools.pairwise(fixed):
        needed = start + needed_positions(xyz[start : stop + 1], _OFF_M)
        for one, other in itertools.pairwise(needed):
            count = int(np.ceil((other - one) * STEP_M / _LONGEST_M))
            kept.append(np.linspace(one, other, count + 1).round().astype(np.int64))
    return np.unique(np.concatenate(kept))

"""Gratings and catch basins: where many notches lie close together (mms.md, 7.3 c1).

The holes of lids lie on a line across the gutter; between the bars of a grating the surface is
open all over a rectangle. So what makes a grating is a count, that grows as rows lie closer, and
that notches fill a rectangle of a possible size with an edge all round.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.monitor import Monitor
from processing.points.drive import Drive
from processing.points.passes import Pass, passes_of
from processing.road.grating_found import GratingFacts, GratingFound
from processing.road.notches import Notches

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

_ROW_SPACING_M = 0.111
"""Of the thesis' recording, 40 km/h and 100 turns a second: its count of 8 is meant for that."""
_EDGE_M = 0.005  # frame beyond the outermost opening
_RIM_M = 0.10
_BIN_M = 0.01
_EDGE_SHARE = 0.4
_MOST_TURNED_DEG, _TURN_STEP_DEG = 8.0, 0.5


@dataclass(frozen=True)
class GratingParameters:
    """What counts as a grating.

    Attributes
    ----------
    radius_m, fewest : float, int
        So many further notches within so far (Table 7-3: 8 within 0.25 m), at rows 0.111 m apart.
    least_strength : float
        Of a notch that counts.
    least_deep_m : float
        Median depth of its notches.
    least_m, longest_m, widest_m : float
        Sizes that are made: shortest side, longest long side, longest short side.
    joining_m : float
        Notches nearer than this to one another are of one grating, or of its neighbour's.
    least_confidence : float
    """

    radius_m: float = 0.25
    fewest: int = 8
    least_strength: float = 0.10
    least_deep_m: float = 0.008
    least_m: float = 0.18
    longest_m: float = 1.30
    widest_m: float = 0.80
    joining_m: float = 0.12
    least_confidence: float = 0.20


def gratings_of(
    drive: Drive, notches: Notches, parameters: GratingParameters, monitor: Monitor
) -> tuple[tuple[GratingFound, ...], NDArray[np.bool_]]:
    """Gratings among the notches of a drive: as :func:`gratings_among`."""
    monitor.check()
    return gratings_among(notches, passes_of(drive), parameters)


def gratings_among(
    notches: Notches, passes: tuple[Pass, ...], parameters: GratingParameters
) -> tuple[tuple[GratingFound, ...], NDArray[np.bool_]]:
    """Gratings among notches.

    Returns
    -------
    found : tuple of GratingFound
        In the order of passes and stations.
    is_taken : (n,) bool
        Notches inside them, that are no holes of lids.
    """
    found: list[GratingFound] = []
    is_taken: NDArray[np.bool_] = np.zeros(notches.count, np.bool_)
    for way in passes:
        spacing = _row_spacing(notches, way)
        for members in _clusters(notches, way.number, spacing, parameters):
            one = _grating(notches, members, way, spacing, parameters)
            if one is None:
                continue
            is_taken |= _is_inside(notches.xyz, one.corners, 2 * _EDGE_M)
            found.append(one)
    return tuple(sorted(found, key=lambda one: one.time_s)), is_taken


def _row_spacing(notches: Notches, way: Pass) -> float:
    """Median distance between rows that have notches, along the way, m."""
    which = notches.stretch == way.number
    rows, first = np.unique(notches.row[which], return_index=True)
    if rows.size < 2:
        return _ROW_SPACING_M
    stations = way.station_at(notches.time_s[which][first])
    steps = np.diff(stations) / np.diff(rows)
    steps = steps[steps > 0]
    return float(np.median(steps)) if steps.size else _ROW_SPACING_M


def _clusters(
    notches: Notches, stretch: int, spacing: float, parameters: GratingParameters
) -> Iterator[Integers]:
    """Numbers of notches that lie close together."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    chosen = np.flatnonzero(
        (notches.stretch == stretch) & (notches.strength >= parameters.least_strength)
    )
    if chosen.size <= parameters.fewest:
        return
    places = notches.xyz[chosen, :2] - notches.xyz[chosen[0], :2]
    tree = cKDTree(places)
    wanted = parameters.fewest * min(max(_ROW_SPACING_M / spacing, 0.5), 3.0)
    around = tree.query_ball_point(places, parameters.radius_m, return_length=True) - 1
    is_dense = np.asarray(around) >= wanted
    pairs = tree.query_pairs(max(parameters.joining_m, 1.1 * spacing), output_type="ndarray")
    pairs = pairs[is_dense[pairs[:, 0]] & is_dense[pairs[:, 1]]]
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(chosen.size,) * 2)
    _, part = connected_components(links, directed=False)
    order = np.argsort(part, kind="stable")
    for members in np.split(order, np.flatnonzero(np.diff(part[order])) + 1):
        if members.size > parameters.fewest / 2:
            yield chosen[members]


def _grating(
    notches: Notches, members: Integers, way: Pass, spacing: float, parameters: GratingParameters
) -> GratingFound | None:
    """The rectangle that a cluster fills, if it is one."""
    centre = np.median(notches.xyz[members], axis=0)
    half = np.maximum(notches.width_m[members] / 2 - 0.01, 0.0)[:, None]
    places = notches.xyz[members, :2] - centre[:2]
    aside = half * notches.direction[members]
    ends = np.stack([places - aside, places + aside])
    ahead = way.directions_at(np.array([np.median(notches.station_m[members])]))[0]
    along, box = _least_box(ends, ahead)
    box = box + np.array([[-_EDGE_M], [_EDGE_M]])
    size = box[1] - box[0]
    long, wide = float(size.max()), float(size.min())
    is_made = wide >= parameters.least_m and wide <= parameters.widest_m
    if not is_made or long > parameters.longest_m:
        return None
    corners = _corners(box, along, centre, notches.xyz[members])
    depth = float(np.median(notches.depth_m[members]))
    if depth < parameters.least_deep_m:
        return None
    facts = _facts(notches, members, corners, spacing)
    confidence = _confidence(facts, members.size)
    if confidence < parameters.least_confidence:
        return None
    return GratingFound(
        corners,
        length_m=long,
        width_m=wide,
        time_s=float(np.median(notches.time_s[members])),
        points=notches.point[members],
        facts=facts,
        confidence=confidence,
    )


def _least_box(ends: Floats, ahead: Floats) -> tuple[Floats, Floats]:
    """Direction and (2, 2) low and high sides of the smallest rectangle about the way's direction.

    Parameters
    ----------
    ends : (2, n, 2)
        Both ends of each opening in plan.
    """
    best: tuple[float, Floats, Floats] = (np.inf, ahead, np.zeros((2, 2)))
    for turned in np.arange(-_MOST_TURNED_DEG, _MOST_TURNED_DEG + 0.1, _TURN_STEP_DEG):
        turn = np.exp(1j * np.radians(turned)) * (ahead[0] + 1j * ahead[1])
        along = np.array([turn.real, turn.imag])
        sides = [_filled(ends @ axis) for axis in (along, np.array([-along[1], along[0]]))]
        box = np.array(sides).T
        # Ties are for the way's own direction, since gutters follow it.
        area = float(np.prod(box[1] - box[0])) * (1.0 + 0.002 * abs(turned))
        if area < best[0]:
            best = area, along, box
    return best[1], best[2]


def _filled(ends: Floats) -> tuple[float, float]:
    """Where openings lie as densely as in the middle, by how many of them cover a place.

    Beyond are strays, and the holes of the lid that follows.
    """
    low, high = ends.min(axis=0), ends.max(axis=0)
    first = float(low.min())
    bins = int((high.max() - first) / _BIN_M) + 1
    change = np.bincount(((low - first) / _BIN_M).astype(np.int64), minlength=bins + 1)
    change = (
        change
        - np.bincount(((high - first) / _BIN_M).astype(np.int64) + 1, minlength=bins + 2)[
            : bins + 1
        ]
    )
    covered = np.cumsum(change)[:bins].astype(np.float64)
    even = np.convolve(covered, np.ones(3) / 3, mode="same")
    full = np.flatnonzero(even >= _EDGE_SHARE * np.median(even[even > 0]))
    return first + float(full[0]) * _BIN_M, first + float(full[-1] + 1) * _BIN_M


def _corners(box: Floats, along: Floats, centre: Floats, xyz: Floats) -> Floats:
    """(4, 3): counterclockwise, a long side first, on the plane through the notches' surfaces."""
    left = np.array([-along[1], along[0]])
    (x0, y0), (x1, y1) = box
    own = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    if y1 - y0 > x1 - x0:
        own = np.roll(own, -1, axis=0)
    plan = own[:, :1] * along + own[:, 1:] * left
    local = xyz - centre
    rows = np.column_stack([local[:, :2], np.ones(len(local))])
    plane = np.linalg.lstsq(rows, local[:, 2], rcond=None)[0]
    heights = plan @ plane[:2] + plane[2]
    return np.column_stack([plan, heights]) + centre


def _is_inside(xyz: Floats, corners: Floats, beyond_m: float) -> NDArray[np.bool_]:
    """Which places are in a rectangle in plan or no further outside than this."""
    own, long, wide = _own(xyz, corners)
    return np.asarray(
        (own[:, 0] >= -beyond_m)
        & (own[:, 0] <= long + beyond_m)
        & (own[:, 1] >= -beyond_m)
        & (own[:, 1] <= wide + beyond_m)
    )


def _own(xyz: Floats, corners: Floats) -> tuple[Floats, float, float]:
    """Places along and across a rectangle from its first corner, and its sides."""
    first, second, last = corners[0, :2], corners[1, :2], corners[3, :2]
    long, wide = float(np.hypot(*(second - first))), float(np.hypot(*(last - first)))
    local = xyz[:, :2] - first
    along, across = (second - first) / long, (last - first) / wide
    return np.column_stack([local @ along, local @ across]), long, wide


def _facts(notches: Notches, members: Integers, corners: Floats, spacing: float) -> GratingFacts:
    own, long, wide = _own(notches.xyz, corners)
    # Another pass of the same place says nothing here.
    span = np.ptp(notches.time_s[members]) + 1.0
    is_near = np.abs(notches.time_s - np.median(notches.time_s[members])) <= span
    is_rim = is_near & (notches.strength >= 0.1) & _is_inside(notches.xyz, corners, _RIM_M)
    is_rim &= ~_is_inside(notches.xyz, corners, 2 * _EDGE_M)
    # The joints of lids beside it are cut at its ends; what counts is beside it.
    is_rim &= (own[:, 0] > 0) & (own[:, 0] < long)
    inside = members.size / (long * wide)
    outside = is_rim.sum() / (2 * _RIM_M * long)
    local = notches.xyz[members] - notches.xyz[members].mean(axis=0)
    rows = np.column_stack([local[:, :2], np.ones(len(local))])
    plane = np.linalg.lstsq(rows, local[:, 2], rcond=None)[0]
    off = local[:, 2] - rows @ plane
    cells = np.unique(
        np.clip((own[members] / [long / 3, wide / 3]).astype(np.int64), 0, 2) @ [3, 1]
    )
    return GratingFacts(
        hits=int(members.size),
        rows=int(np.unique(notches.row[members]).size),
        density=float(min(1.0, notches.width_m[members].sum() * spacing / (long * wide))),
        depth_m=float(np.median(notches.depth_m[members])),
        rim_m=float(np.sqrt(np.mean(off**2))),
        filled=len(cells) / 9,
        contrast=float(inside / max(inside + outside, 1e-9)),
    )


def _confidence(facts: GratingFacts, hits: int) -> float:
    """From how much of the rectangle is open, how sharp its edges are and how even its top is."""
    by_hits = np.clip((hits - 4) / 16, 0.0, 1.0)
    by_edge = np.clip((facts.contrast - 0.6) / 0.35, 0.0, 1.0)
    by_fill = np.clip((facts.filled - 0.4) / 0.4, 0.0, 1.0)
    by_top = np.clip((0.02 - facts.rim_m) / 0.012, 0.0, 1.0)
    return float(0.97 * (by_hits * by_edge * by_fill * by_top) ** 0.5)

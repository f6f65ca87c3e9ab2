"""Gratings and catch basins: where many notches lie close together.

After Takahashi 2022, section 7.3 c1. The holes of lids lie on a line across the gutter; between the
bars of a grating the surface is open all over a rectangle. So what makes a grating is how much of
the surface is open, however slowly the vehicle goes, and that openings fill a rectangle of a
possible size with an edge all round.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from processing.core.monitor import Monitor
from processing.methods.road.gutters.grating_confidence import grating_chance
from processing.methods.road.gutters.grating_facts import (
    GratingFacts,
    GratingFound,
    in_rectangle,
    inside,
)
from processing.methods.road.gutters.notches.notches import Notches
from processing.recording.drive import Drive
from processing.recording.passes import Pass, passes_of

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_FEWEST = 6
"""Notches of a grating: with fewer no rectangle has an edge all round. By trial."""

_LEAST_STRENGTH = 0.1
"""Weaker notches are noise more often than not. By trial."""

_FARTHEST_M, _ROWS_APART = 0.25, 1.1
"""Rows of one grating may be so far apart: at 90 km/h and 100 rev/s they are 25 cm. Notches join
over a little more than from row to row."""

_EDGE_M = 0.005
"""Frame beyond the outermost opening. By trial."""

_FRAME_M, _ABOUT_M = 0.02, 0.50
"""The surface around begins beyond the frame and goes so far: that of the road beside. By trial."""

_BIN_M = 0.01
"""Bins of the outline, m: a spacing of points."""

_BLUNT_M = 0.01
"""An opening ends so much nearer than its width says, to both sides together twice: the rim. By
trial."""

_CORNER_M = 0.10
"""A notch so near to a corner shows it. By trial."""

_EDGE_SHARE = 0.4
"""Bins covered by this share of the usual number of openings are of the grating, rarer ones are
strays. By trial."""

_MOST_TURNED_DEG, _TURN_STEP_DEG, _TURN_COST = 8.0, 1.0, 0.002
"""Gratings lie along the vehicle's path within so much, in steps of so much; a degree costs this
share of the area, so that ties go to the path's own direction. By trial."""

_MEMBERS_WITHIN_S = 1.0
"""Rows so long after or before a grating's are of the same passage; another says nothing here."""

_DEPTH_QUANTILE = 0.75
"""Of depths: half of what falls between bars meets their flanks."""

_PARTS = 3
"""Parts along each side: nine, of which the least open but one counts."""

_LEAST_WIDTH_M = 1e-6
"""Guard of a division."""


@dataclass(frozen=True)
class GratingParameters:
    """What counts as a grating.

    Attributes
    ----------
    radius_m, least_open : float
        So much of the surface is open within so far of a place on it. The thesis' 8 notches
        within 0.25 m (Takahashi 2022, Table 7-3) are that of its recording; shares are the same
        however fast the vehicle goes. By trial: no measurement is recorded.
    least_m, longest_m, widest_m : float
        Sizes that are made, with some centimetres to either side: shortest side, longest long
        side, longest short side.
    joining_m : float
        Notches nearer than this to one another are of one grating, or of its neighbour's; as far
        as from row to row where those are farther apart.
    """

    radius_m: float = 0.12
    least_open: float = 0.20
    least_m: float = 0.22
    longest_m: float = 1.30
    widest_m: float = 0.80
    joining_m: float = 0.10


def gratings_of(
    drive: Drive, notches: Notches, parameters: GratingParameters, monitor: Monitor
) -> tuple[GratingFound, ...]:
    """Gratings among the notches of a drive: as :func:`gratings_among`."""
    monitor.check()
    return gratings_among(notches, passes_of(drive), parameters)


def gratings_among(
    notches: Notches, passes: tuple[Pass, ...], parameters: GratingParameters
) -> tuple[GratingFound, ...]:
    """Gratings among notches, in the order of passes and stations."""
    found: list[GratingFound] = []
    for one_pass in passes:
        for members in _clusters(notches, one_pass.number, parameters):
            one = _grating(notches, members, one_pass, parameters)
            if one is not None:
                found.append(one)
    return tuple(found)


def _clusters(
    notches: Notches, pass_number: int, parameters: GratingParameters
) -> Iterator[Integers]:
    """Numbers of notches that lie close together."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    chosen = np.flatnonzero(
        (notches.pass_number == pass_number) & (notches.strength >= _LEAST_STRENGTH)
    )
    if chosen.size < _FEWEST:
        return
    positions = notches.xyz[chosen, :2] - notches.xyz[chosen[0], :2]
    tree = cKDTree(positions)
    apart = float(
        np.median(notches.area_m2[chosen] / np.maximum(notches.width_m[chosen], _LEAST_WIDTH_M))
    )
    joining = min(max(parameters.joining_m, _ROWS_APART * apart), _FARTHEST_M)
    radius = max(parameters.radius_m, joining)
    pairs = tree.query_pairs(radius, output_type="ndarray")
    area = notches.area_m2[chosen]
    around = area + np.bincount(pairs[:, 0], area[pairs[:, 1]], minlength=area.size)
    around += np.bincount(pairs[:, 1], area[pairs[:, 0]], minlength=area.size)
    is_dense = around >= parameters.least_open * np.pi * radius**2
    away = np.hypot(*(positions[pairs[:, 0]] - positions[pairs[:, 1]]).T)
    pairs = pairs[away <= joining]
    pairs = pairs[is_dense[pairs[:, 0]] & is_dense[pairs[:, 1]]]
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(chosen.size,) * 2)
    _, part = connected_components(links, directed=False)
    order = np.argsort(part, kind="stable")
    for members in np.split(order, np.flatnonzero(np.diff(part[order])) + 1):
        if members.size >= _FEWEST:
            yield chosen[members]


def _grating(
    notches: Notches, members: Integers, one_pass: Pass, parameters: GratingParameters
) -> GratingFound | None:
    """The rectangle that a cluster fills, if it is one."""
    centre = np.median(notches.xyz[members], axis=0)
    half = np.maximum(notches.width_m[members] / 2 - _BLUNT_M, 0.0)[:, None]
    positions = notches.xyz[members, :2] - centre[:2]
    aside = half * notches.direction[members]
    ends = np.stack([positions - aside, positions + aside])
    ahead = one_pass.directions_at(np.array([np.median(notches.station_m[members])]))[0]
    along, box = _least_box(ends, ahead)
    box = box + np.array([[-_EDGE_M], [_EDGE_M]])
    size = box[1] - box[0]
    long, wide = float(size.max()), float(size.min())
    is_made = wide >= parameters.least_m and wide <= parameters.widest_m
    if not is_made or long > parameters.longest_m:
        return None
    corners = _corners(box, along, centre, notches.xyz[members])
    facts = _facts(notches, members, corners)
    away = np.hypot(*(corners[:, None, :2] - notches.xyz[members, :2]).transpose(2, 0, 1))
    points = np.where(away.min(axis=1) < _CORNER_M, notches.point[members][away.argmin(axis=1)], -1)
    chance = grating_chance(facts)
    return GratingFound(corners, long, wide, facts, chance, points=tuple(points.tolist()))


def _least_box(ends: Floats, ahead: Floats) -> tuple[Floats, Floats]:
    """Direction and (2, 2) low and high sides of the smallest rectangle about the path's direction.

    Parameters
    ----------
    ends : (2, n, 2)
        Both ends of each opening in plan.
    """
    turned = np.arange(-_MOST_TURNED_DEG, _MOST_TURNED_DEG + 0.1, _TURN_STEP_DEG)
    turns = np.exp(1j * np.radians(turned)) * (ahead[0] + 1j * ahead[1])
    along = np.column_stack([turns.real, turns.imag])
    left = np.column_stack([-turns.imag, turns.real])
    low, high = _filled(ends @ np.vstack([along, left]).T)
    size = (high - low).reshape(2, -1)
    # Ties are for the path's own direction, since gutters follow it.
    best = int(np.argmin(size[0] * size[1] * (1.0 + _TURN_COST * np.abs(turned))))
    which = [best, best + turned.size]
    return along[best], np.array([low[which], high[which]])


def _filled(ends: Floats) -> tuple[Floats, Floats]:
    """Where openings lie as densely as in the middle, by how many of them cover a place.

    Beyond are strays, and the holes of the lid that follows.

    Parameters
    ----------
    ends : (2, n, d)
        Both ends of each opening along so many directions.
    """
    low, high = ends.min(axis=0), ends.max(axis=0)
    first = low.min(axis=0)
    bins = int((high.max(axis=0) - first).max() / _BIN_M) + 2
    positions = np.arange(low.shape[1]) * (bins + 2)
    begins, stops = (
        ((end - first) / _BIN_M).astype(np.int64) + shift for end, shift in ((low, 0), (high, 1))
    )
    change = np.bincount((positions + begins).ravel(), minlength=positions.size * (bins + 2))
    change -= np.bincount((positions + stops).ravel(), minlength=positions.size * (bins + 2))
    covered = np.cumsum(change.reshape(positions.size, -1), axis=1).astype(np.float64)
    even = uniform_filter1d(covered, 3, axis=1, mode="constant")
    is_any = even > 0
    ordered = np.sort(np.where(is_any, even, np.inf), axis=1)
    usual = np.take_along_axis(ordered, is_any.sum(axis=1)[:, None] // 2, axis=1)
    is_full = is_any & (even >= _EDGE_SHARE * usual)
    last = is_full.shape[1] - is_full[:, ::-1].argmax(axis=1)
    return first + is_full.argmax(axis=1) * _BIN_M, first + last * _BIN_M


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


def _facts(notches: Notches, members: Integers, corners: Floats) -> GratingFacts:
    # Another pass of the same place says nothing here.
    span = np.ptp(notches.time_s[members]) + _MEMBERS_WITHIN_S
    is_near = np.abs(notches.time_s - np.median(notches.time_s[members])) <= span
    near = notches.chosen(np.flatnonzero(is_near & (notches.strength >= _LEAST_STRENGTH)))
    own, long, wide = in_rectangle(near.xyz, corners)
    is_in = inside(near.xyz, corners, _EDGE_M)
    is_about = inside(near.xyz, corners, _ABOUT_M) & ~inside(near.xyz, corners, _FRAME_M)
    about_m2 = (long + 2 * _ABOUT_M) * (wide + 2 * _ABOUT_M)
    about_m2 -= (long + 2 * _FRAME_M) * (wide + 2 * _FRAME_M)
    of_part = own[is_in] / [long / _PARTS, wide / _PARTS]
    cells = np.clip(of_part.astype(np.int64), 0, _PARTS - 1) @ [_PARTS, 1]
    count = _PARTS * _PARTS
    parts = np.bincount(cells, near.area_m2[is_in], minlength=count) * count / (long * wide)
    return GratingFacts(
        rows=int(np.unique(near.row[is_in]).size),
        open_share=float(near.area_m2[is_in].sum() / (long * wide)),
        depth_m=float(np.quantile(near.depth_m[is_in], _DEPTH_QUANTILE)),
        least_part=float(np.sort(parts)[1]),
        about=float(near.area_m2[is_about].sum() / about_m2),
        raised_m=float(np.median(near.higher_m(is_in))),
    )

"""Curbs followed beyond the ends of their runs: round corners, and where few scanlines show them.

A scanline square to the vehicle's path runs along a curb that turns into a side street, and of a
face that looks away it shows little. From each end the line is carried on a little way, edges are
measured about it, and where there is an edge like the curb's own it is carried on from there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, parts_of
from processing.methods.road.curbs.edges.approximate_lines import (
    ApproximateLine,
    outwards_of,
    rejoin_lines,
)
from processing.methods.road.curbs.edges.curb_edges import (
    EdgeSettings,
    measure_edges_among,
)
from processing.methods.road.curbs.edges.curb_joins import JointEdges, join_edges
from processing.methods.road.curbs.edges.curb_points import ChosenPoints, points_near
from processing.methods.road.curbs.edges.edge_measures import STEP_M
from processing.recording.drive import Drive

_Floats = NDArray[np.float64]

_Recorded = tuple[Sequence[Drive], Sequence[ChosenPoints]]
_Settings = tuple[EdgeSettings, float]


class _Continuation(NamedTuple):
    """A way to go on: how many stations it has, its line, what is measured there."""

    stations: int
    line: ApproximateLine
    edges: JointEdges


# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

REACH_M = 30.0
"""How far a curb is followed beyond its run: round a corner and some way into a side street. By
trial."""


class _Stride(NamedTuple):
    """How a line is carried on: stations ahead, those that say how it goes on, those it shares."""

    ahead: int
    known: int
    shared: int


_NEAR = _Stride(6, 8, 2)
"""1.5 m at a time by the last 2 m: as far as the last bend foretells within the 0.4 m in which
edges are looked for. By trial."""

_LEAST = 3
"""Stations ahead that must have an edge for the line to be followed farther. By trial."""

_LEAP, _LANDING, _LANDED = 24, 8, 7
"""Stations looked over at a time where a curb ends, lowered to the ground or hidden: 6 m, as long
as an entrance; and how many of how many behind have its edge. By trial."""

_LEAPING = _Stride(_LEAP + _LANDING, _NEAR.known, _NEAR.shared)

_LANDING_M = 0.02
"""From station to station of a landing the edge moves aside by no more: it is straight. By
trial."""

_FAN = (0.0, 0.06, -0.06, 0.12, -0.12, 0.18, -0.18, 0.26, -0.26, 0.35, -0.35)
"""Directions of a leap, rad: the last stations of a corner tell it within some 20 degrees, and an
edge is found within 0.25 m aside."""

_LEAST_LINE = 20
"""Stations of a curb that is looked for beyond a gap, 5 m: shorter ones tell too little of it. By
trial."""

_END = 16
"""Stations of an end that may lie too far ahead, 4 m: a run may go on into a mouth. By trial."""

_BENDS = (0.0, 0.07, -0.07, 0.2, -0.2)
"""More or less turn than up to now, rad a station: radii of 3.6 m and 1.25 m, of corners. By
trial."""

_MOST_BEND = 0.25
"""The sharpest turn, rad a station: a radius of 1 m."""

_STRAIGHT = math.nan
"""Straight on: what is known may hold a corner that ends here."""

_WAYS_ON = (_BENDS[:1], (*_BENDS[1:], _STRAIGHT))
"""Bends that are tried one after the other while a way ends before its last station."""

_LAST = 3
"""Stations whose direction that is."""

_HEIGHT_M = 1.2
"""How far above or below an end points are kept: 30 m of a street that rises by 4 %. By trial."""

_ASIDE_M = 0.2
"""An edge may lie so far beside where the line was expected: half of what is looked at."""

_LEAST_STEP_M = 0.015
"""The step of a dropped curb as measured (`StepSettings.least_dropped_m`)."""

_STEP_SHARE, _STEP_M, _USUAL_OF_END = 0.35, 0.03, 0.75
"""A step is of the curb if it is no higher than usual by more than this share and this much; usual
is the latter quantile near the end, as parts may be lowered. By trial."""

_ERROR_M = 0.036
"""An edge across must be known so well, which one without points on its face is in a gap of 10 cm:
no better than scanlines tell it already. By trial."""


def extend_lines(
    approximate_lines: Sequence[ApproximateLine],
    drives: Sequence[Drive],
    settings: EdgeSettings,
    limits: tuple[float, float],
    monitor: Monitor,
) -> tuple[ApproximateLine, ...]:
    """Lines followed beyond their ends, and joined where they meet.

    Parameters
    ----------
    limits : tuple of float
        Greatest step of a curb, and longest bridge, m.
    """
    ends = np.array(
        [
            xyz
            for approximate_line in approximate_lines
            for xyz in (approximate_line.xyz[0], approximate_line.xyz[-1])
        ]
    )
    reach = (REACH_M + settings.across_m, _HEIGHT_M)
    parts = parts_of(monitor, [drive.count for drive in drives])
    near = [points_near(one, ends, reach, part) for one, part in zip(drives, parts, strict=True)]
    now = _trim(approximate_lines, (drives, near), (settings, limits[0]))
    is_open = np.array([[not one.is_alone] * 2 for one in now], np.bool_)
    is_short = [one.is_alone or one.xyz.shape[0] < _LEAST_LINE for one in now]
    has_leapt = np.array([[short] * 2 for short in is_short], np.bool_)
    for _ in range(round(REACH_M / (_NEAR.ahead * STEP_M))):
        monitor.check()
        _leap(now, (is_open, has_leapt), (drives, near), (settings, limits[0]))
        if not is_open.any():
            break
        _carry_on(now, is_open, (drives, near), (settings, limits[0]))
    return rejoin_lines(now, limits[1])


def _carry_on(
    approximate_lines: list[ApproximateLine],
    is_open: NDArray[np.bool_],
    recorded: _Recorded,
    settings: _Settings,
) -> None:
    """Carry all open ends on once; ends without an edge ahead are closed."""
    ends = [(int(approximate_line), int(end)) for approximate_line, end in np.argwhere(is_open)]
    best: dict[tuple[int, int], _Continuation] = {}
    for bends in _WAYS_ON:
        lacking = [one for one in ends if one not in best or best[one].stations < _NEAR.ahead]
        found = _best_continuations(approximate_lines, lacking, bends, (recorded, settings))
        for one, way in zip(lacking, found, strict=True):
            if one not in best or way.stations > best[one].stations:
                best[one] = way
    for (number, end), chosen in best.items():
        is_open[number, end] = chosen.stations >= _LEAST
        if chosen.stations:
            line = approximate_lines[number]
            is_good = _is_good(chosen.edges, line, end)
            approximate_lines[number] = _longer(line, chosen, end, is_good)


def _leap(
    approximate_lines: list[ApproximateLine],
    flags: tuple[NDArray[np.bool_], NDArray[np.bool_]],
    recorded: _Recorded,
    settings: _Settings,
) -> None:
    """Look over what hides or lowers a curb where it ends; found ends are open again."""
    is_open, has_leapt = flags
    ends = [
        (int(approximate_line), int(end))
        for approximate_line, end in np.argwhere(~is_open & ~has_leapt)
    ]
    if not ends:
        return
    fan = [(approximate_line, end, aside) for approximate_line, end in ends for aside in _FAN]
    extensions = [
        _straight_on(approximate_lines[approximate_line], end, aside)
        for approximate_line, end, aside in fan
    ]
    measured = _measure(extensions, recorded, settings)
    for (approximate_line, end, _), extension, edges in zip(fan, extensions, measured, strict=True):
        has_leapt[approximate_line, end] = True
        if is_open[approximate_line, end]:
            continue
        is_good = _is_good(edges, approximate_lines[approximate_line], end)
        count = _landing_of(_turn_round(edges) if end == 0 else edges, is_good[:: 1 if end else -1])
        if count:
            way = _Continuation(count, extension, edges)
            approximate_lines[approximate_line] = _longer(
                approximate_lines[approximate_line], way, end, is_good
            )
            is_open[approximate_line, end] = True
            has_leapt[approximate_line, end] = False


def _straight_on(approximate_line: ApproximateLine, end: int, aside: float) -> ApproximateLine:
    """An extension as long as a leap, turned aside, rad."""
    extension = _extension(approximate_line, end, _STRAIGHT, _LEAPING)
    pivot = extension.xyz[-2 if end == 0 else 1]
    cos, sin = math.cos(aside), math.sin(aside)
    xyz = extension.xyz.copy()
    xyz[:, :2] = (xyz[:, :2] - pivot[:2]) @ np.array([[cos, sin], [-sin, cos]]) + pivot[:2]
    return replace(extension, xyz=xyz, outwards=outwards_of(xyz))


def _landing_of(edges: JointEdges, is_good: NDArray[np.bool_]) -> int:
    """How many stations behind the two known ones there are up to a straight edge; 0: none."""
    for first in range(_NEAR.shared, is_good.size - _LANDING + 1):
        part = slice(first, first + _LANDING)
        good = is_good[part]
        if is_good[first] and good.sum() >= _LANDED:
            across = edges.lower_across[part][good]
            if np.abs(np.diff(across)).max() <= _LANDING_M:
                return first - _NEAR.shared + int(np.flatnonzero(good)[-1]) + 1
    return 0


def _best_continuations(
    approximate_lines: Sequence[ApproximateLine],
    ends: Sequence[tuple[int, int]],
    bends: Sequence[float],
    known: tuple[_Recorded, _Settings],
) -> list[_Continuation]:
    """For each end the best of some ways to go on."""
    extensions = [
        _extension(approximate_lines[approximate_line], end, bend, _NEAR)
        for approximate_line, end in ends
        for bend in bends
    ]
    if not extensions:
        return []
    edges = _measure(extensions, *known)
    best: list[_Continuation] = []
    for number, (approximate_line, end) in enumerate(ends):
        those = range(number * len(bends), (number + 1) * len(bends))
        line = approximate_lines[approximate_line]
        counts = [_followed(edges[one], line, end) for one in those]
        most = int(np.argmax(counts))
        best.append(_Continuation(counts[most], extensions[those[most]], edges[those[most]]))
    return best


def _trim(
    approximate_lines: Sequence[ApproximateLine],
    recorded: _Recorded,
    settings: _Settings,
) -> list[ApproximateLine]:
    """Lines whose ends lie on the edges: without what is none, as a run may go on into a mouth.

    Places of runs lie up to some centimetres off, and their last ones straight on where a curb
    bends; how a line goes on is told by where the edge itself was measured.
    """
    ends = [
        (approximate_line, end)
        for approximate_line in range(len(approximate_lines))
        for end in (0, 1)
    ]
    edges = _measure(
        [_end_of(approximate_lines[approximate_line], end) for approximate_line, end in ends],
        recorded,
        settings,
    )
    trimmed = list(approximate_lines)
    for number, (approximate_line, end) in enumerate(ends):
        inside = approximate_lines[approximate_line]
        backwards = _turn_round(edges[number]) if end == 1 else edges[number]
        is_good = _is_good(backwards, inside, end)
        if is_good.any():
            first = int(np.argmax(is_good))
            whole = trimmed[approximate_line].xyz.shape[0]
            if whole - first >= _NEAR.known:
                part = slice(first, whole) if end == 0 else slice(0, whole - first)
                moved = _on_edge(trimmed[approximate_line], edges[number], end, is_good)
                trimmed[approximate_line] = _part(moved, part)
    return trimmed


def _on_edge(
    approximate_line: ApproximateLine, edges: JointEdges, end: int, is_good: NDArray[np.bool_]
) -> ApproximateLine:
    """A line whose last places at an end were put where edges are; ``is_good`` begins there."""
    known = is_good if end == 0 else is_good[::-1]
    at = np.arange(known.size)
    # What was cut off at the other end may have been of this one too.
    count = min(known.size, approximate_line.xyz.shape[0])
    where = slice(0, count) if end == 0 else slice(-count, None)
    xyz = approximate_line.xyz.copy()
    across = np.interp(at, at[known], edges.lower_across[known])[where]
    xyz[where, :2] += approximate_line.outwards[where] * across[:, None]
    xyz[where, 2] += np.interp(at, at[known], edges.lower_above[known])[where]
    return replace(approximate_line, xyz=xyz, outwards=outwards_of(xyz))


def _measure(
    extensions: Sequence[ApproximateLine],
    recorded: _Recorded,
    settings: _Settings,
) -> list[JointEdges]:
    measured = [
        measure_edges_among(drive, extensions, chosen, settings[0])
        for drive, chosen in zip(*recorded, strict=True)
    ]
    return [
        join_edges([one[number].measures for one in measured], settings[1])
        for number in range(len(extensions))
    ]


def _end_of(approximate_line: ApproximateLine, end: int) -> ApproximateLine:
    """The last metres of an approximate line."""
    count = min(_END, approximate_line.xyz.shape[0])
    return _part(approximate_line, slice(0, count) if end == 0 else slice(-count, None))


def _part(approximate_line: ApproximateLine, part: slice) -> ApproximateLine:
    return replace(
        approximate_line,
        xyz=approximate_line.xyz[part],
        outwards=approximate_line.outwards[part],
        is_seen=approximate_line.is_seen[part],
        step_m=approximate_line.step_m[part],
        width_m=approximate_line.width_m[part],
        is_hidden=approximate_line.is_hidden[part],
        is_edging=approximate_line.is_edging[part],
        runs=approximate_line.runs[part],
    )


def _turn_round(edges: JointEdges) -> JointEdges:
    return JointEdges(*(getattr(edges, field.name)[::-1] for field in fields(edges)))


def _extension(
    approximate_line: ApproximateLine, end: int, more_bend: float, stride: _Stride
) -> ApproximateLine:
    """The last places of an approximate line and as it would go on, in its own direction."""
    order = slice(None, None, -1 if end == 0 else 1)
    known = approximate_line.xyz[order][-stride.known :]
    ahead = np.diff(known, axis=0)
    heading = np.unwrap(np.arctan2(ahead[:, 1], ahead[:, 0]))
    bend, last = 0.0, float(heading[-1])
    if heading.size > 2:
        away = np.arange(heading.size) - (heading.size - 1) / 2
        bend = float(away @ heading) / float(away @ away)
        last = float(heading.mean()) + bend * float(away[-1])
    if math.isnan(more_bend):
        last, bend, more_bend = float(np.mean(heading[-_LAST:])), 0.0, 0.0
    turned = last + np.clip(bend + more_bend, -_MOST_BEND, _MOST_BEND) * np.arange(
        1, stride.ahead + 1
    )
    rise = float(np.median(ahead[:, 2]))
    going = np.column_stack(
        [np.cos(turned) * STEP_M, np.sin(turned) * STEP_M, np.full(stride.ahead, rise)]
    )
    xyz = np.vstack([known[-stride.shared :], known[-1] + np.cumsum(going, axis=0)])[order]
    positions = np.full(xyz.shape[0], 0 if end == 0 else approximate_line.xyz.shape[0] - 1)
    return replace(
        approximate_line,
        xyz=xyz,
        outwards=outwards_of(xyz),
        is_seen=np.ones(xyz.shape[0], np.bool_),
        step_m=approximate_line.step_m[positions],
        width_m=approximate_line.width_m[positions],
        is_hidden=approximate_line.is_hidden[positions],
        is_edging=approximate_line.is_edging[positions],
        runs=approximate_line.runs[positions],
    )


def _followed(edges: JointEdges, approximate_line: ApproximateLine, end: int) -> int:
    """How many stations ahead of the known ones have an edge like that of the approximate line."""
    is_good = _is_good(_turn_round(edges) if end == 0 else edges, approximate_line, end)
    missing = 0
    count = 0
    for station, good in enumerate(is_good[_NEAR.shared :].tolist()):
        missing = 0 if good else missing + 1
        if missing > 1:
            break
        count = station + 1 if good else count
    return count


def _is_good(edges: JointEdges, approximate_line: ApproximateLine, end: int) -> NDArray[np.bool_]:
    """Where there is an edge like those of the approximate line some way from its end."""
    inside = slice(0, 4 * _NEAR.known) if end == 0 else slice(-4 * _NEAR.known, None)
    usual = float(np.quantile(approximate_line.step_m[inside], _USUAL_OF_END))
    with np.errstate(invalid="ignore"):
        return np.asarray(
            (np.abs(edges.lower_across) <= _ASIDE_M)
            & (edges.steps_m >= _LEAST_STEP_M)
            & (edges.steps_m <= usual * (1 + _STEP_SHARE) + _STEP_M)
            & (edges.across_error <= _ERROR_M)
        )


def _longer(
    approximate_line: ApproximateLine, way: _Continuation, end: int, known: NDArray[np.bool_]
) -> ApproximateLine:
    """A line with the stations of a way on up to the last that has an edge."""
    count, extension, edges = way
    at = np.arange(known.size)
    across = np.interp(at, at[known], edges.lower_across[known])
    above = np.interp(at, at[known], edges.lower_above[known])
    xyz = extension.xyz.copy()
    xyz[:, :2] += extension.outwards * across[:, None]
    xyz[:, 2] += above
    behind = known.size - _NEAR.shared
    ahead = slice(_NEAR.shared, _NEAR.shared + count)
    part = slice(behind - count, behind) if end == 0 else ahead
    return _with(
        approximate_line,
        end,
        replace(
            extension,
            xyz=xyz[part],
            is_seen=known[part],
            step_m=np.interp(at, at[known], edges.steps_m[known])[part],
            width_m=extension.width_m[part],
            is_hidden=extension.is_hidden[part],
            is_edging=extension.is_edging[part],
            runs=extension.runs[part],
        ),
    )


def _with(approximate_line: ApproximateLine, end: int, more: ApproximateLine) -> ApproximateLine:
    """A line with more of it before or behind."""
    first, second = (more, approximate_line) if end == 0 else (approximate_line, more)
    xyz = np.vstack([first.xyz, second.xyz])
    return replace(
        approximate_line,
        xyz=xyz,
        outwards=outwards_of(xyz),
        is_seen=np.concatenate([first.is_seen, second.is_seen]),
        step_m=np.concatenate([first.step_m, second.step_m]),
        width_m=np.concatenate([first.width_m, second.width_m]),
        is_hidden=np.concatenate([first.is_hidden, second.is_hidden]),
        is_edging=np.concatenate([first.is_edging, second.is_edging]),
        runs=np.concatenate([first.runs, second.runs]),
    )

"""Spans: pieces of wires fitted as they hang, split where they are held and joined over gaps.

In plan a wire is a straight line; upwards it is a catenary, which at the sags of spans along a
street differs from a parabola by less than half a millimetre (30 m with a sag of 1 m: s⁴/24a³ with
a = 112 m, Irvine 1981, Cable Structures, 1.2).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.wires.span_kernels import (
    ASIDE,
    BEND,
    EAST,
    END,
    NOISE,
    NORTH,
    RISE,
    SPAN_WIDTH,
    START,
    TURN,
    WAY_EAST,
    WAY_NORTH,
    SpanLimits,
    span_kernel,
)
from processing.methods.road.wires.wire_points import WirePoints

_FEWEST, _LEAST_LONG_M = 6, 1.0
"""Points and length of a piece that tells a direction."""

_TRIM, _LEAST_TRIM_M = 3.0, 0.012
"""Points off by more than so many times the noise, and by more than that, are another thing's."""

_TURNS = 4

_SEED_M = 1.0
"""To either side of a point: how far a wire is followed by the line through the point alone."""

_SEEDS, _GROWTHS = 4, 12
"""Points of a group that are tried in vain; times that a wire is followed further, each time by
half of what was found: from 2 m to more than any span."""

_USUAL_BEND, _BEND_OFF = 0.004, 0.004
"""Half of the second derivative of usual wires, 1/m, and how far others are off: spans of 25 to
35 m sag by 0.3 to 1.2 m, which is 4 · sag / length²."""

_LEAST_NOISE_M = 0.003
"""Of a wire by its own thickness."""

_LIMITS = SpanLimits(
    _FEWEST, _LEAST_LONG_M, _TRIM, _LEAST_TRIM_M, _TURNS, _USUAL_BEND, _BEND_OFF, _LEAST_NOISE_M
)

MOST_OFF_M = 0.03
"""Noise of a piece that is one wire: a cable's thickness, two passes and the scanner's own."""

_GAP_M, _GAP_SHARE = 15.0, 1.5
"""Over which a wire is joined, and how many times as long as both sides together."""

_END_M, _END_GAP_M = 2.5, 0.35
"""How far a wire is followed at its ends, a quarter of its length at most, and over which gaps:
insulators, arms and other wires are near there, so that no line is free."""

_TURN = 0.03
"""Sine between the directions of two pieces of one wire: short ones are off by their noise."""

_WORSE, _WORSE_M = 1.35, 0.003
"""Noise of two pieces joined over that of the worse: more, and they are two wires."""

_SIDE_M = 0.05
"""How far the end of a piece may lie off what its neighbour foretells for the middle of a gap."""


@dataclass(frozen=True)
class WireSpan:
    """A wire between two places.

    Attributes
    ----------
    middle : (2,) float64
        In plan, m about the plan's origin.
    way : (2,) float64
        Unit vector along it in plan.
    aside : (2,) float64
        Distance to the left of the way at the middle, m, and what it gains in a metre.
    rise : (3,) float64
        Height at the middle, m, its first derivative, and half its second one, 1/m.
    start_m, end_m : float
        Along the way from the middle: where it was seen.
    noise_m : float
        How far its points lie off it.
    lines : (n,) int64
        Its points by their line among all on wires, in order along it.
    """

    middle: Floats
    way: Floats
    aside: Floats
    rise: Floats
    start_m: float
    end_m: float
    noise_m: float
    lines: Integers

    @property
    def long_m(self) -> float:
        """Between its ends, in plan."""
        return self.end_m - self.start_m

    @property
    def sag_m(self) -> float:
        """How far it hangs below the straight line between its ends."""
        return float(self.rise[2] * self.long_m**2 / 4)

    def at(self, along_m: Floats) -> Floats:
        """(n, 3) places along it, m about the plan's origin."""
        left = np.array([-self.way[1], self.way[0]])
        aside = self.aside[0] + self.aside[1] * along_m
        plan = self.middle + along_m[:, None] * self.way + aside[:, None] * left
        height = self.rise[0] + self.rise[1] * along_m + self.rise[2] * along_m**2
        return np.column_stack([plan, height])

    def along(self, places: Floats) -> Floats:
        """(n,) how far along it places lie."""
        return np.asarray((places[:, :2] - self.middle) @ self.way)


def spans_of(points: WirePoints, monitor: Monitor) -> list[WireSpan]:
    """The wires that groups of points are."""
    local, group = points.local, points.group
    order = np.argsort(group, kind="stable")
    _, first, sizes = np.unique(group[order], return_index=True, return_counts=True)
    large = sizes >= _FEWEST
    parts = zip(first[large].tolist(), sizes[large].tolist(), strict=True)

    def of_part(part: tuple[int, int]) -> list[WireSpan]:
        return _pieces(points, order[part[0] : part[0] + part[1]], monitor)

    pieces = [piece for some in in_order(of_part, parts) for piece in some]
    return _followed_to_ends(points.thin, _joined(local, pieces, monitor))


def _followed_to_ends(thin: Floats, spans: Sequence[WireSpan]) -> list[WireSpan]:
    """The same, each as far as thin points follow it: about poles too many things are near."""
    from scipy.spatial import cKDTree

    if not spans:
        return []
    tree = cKDTree(thin)
    found: list[WireSpan] = []
    for span in spans:
        reach = min(_END_M, span.long_m / 4)
        at = np.array([span.start_m - reach / 2, span.end_m + reach / 2])
        ends = [span.start_m, span.end_m]
        for side, near in enumerate(tree.query_ball_point(span.at(at), reach / 2 + MOST_OFF_M)):
            places = thin[near]
            along = span.along(places)
            is_on = np.linalg.norm(places - span.at(along), axis=1) < MOST_OFF_M
            beyond = np.sort((along - ends[side])[is_on] * (-1, 1)[side])
            beyond = beyond[beyond > 0]
            gaps = np.diff(beyond, prepend=0.0) > _END_GAP_M
            last = int(np.argmax(gaps)) if gaps.any() else beyond.size
            ends[side] += (-1, 1)[side] * (float(beyond[last - 1]) if last else 0.0)
        found.append(replace(span, start_m=ends[0], end_m=ends[1]))
    return found


def _fit(local: Floats, lines: Integers) -> WireSpan | None:
    """A wire through points; None where they are too few or too short."""
    told, kept = np.empty(SPAN_WIDTH), np.empty(lines.size, np.bool_)
    if lines.size < _FEWEST or not span_kernel(local, lines, _LIMITS, told, kept):
        return None
    lines, middle, way = lines[kept], told[EAST : NORTH + 1], told[WAY_EAST : WAY_NORTH + 1]
    order = np.argsort((local[lines, :2] - middle) @ way, kind="stable")
    return WireSpan(
        middle=middle,
        way=way,
        aside=told[ASIDE : TURN + 1],
        rise=told[RISE : BEND + 1],
        start_m=float(told[START]),
        end_m=float(told[END]),
        noise_m=float(told[NOISE]),
        lines=lines[order],
    )


def _pieces(points: WirePoints, lines: Integers, monitor: Monitor) -> list[WireSpan]:
    """The wires of a group: one, or several that cross, run side by side or meet at a pole."""
    local = points.local
    span = _fit(local, lines)
    if span is None:
        return []
    is_whole = span.lines.size > 0.9 * lines.size and span.noise_m < MOST_OFF_M / 2
    if is_whole or lines.size < 2 * _FEWEST:
        return [span] if span.noise_m < MOST_OFF_M else []
    rest, failed = lines, 0
    found: list[WireSpan] = []
    while rest.size >= _FEWEST and failed < _SEEDS:
        monitor.check()
        grown = _grown(points, rest, rest[(2 * failed + 1) * rest.size // (2 * _SEEDS)])
        if grown is None:
            failed += 1
        else:
            found.append(grown)
            rest = np.setdiff1d(rest, grown.lines, assume_unique=True)
    return found


def _grown(points: WirePoints, rest: Integers, seed: int) -> WireSpan | None:
    """The wire through a point, from what lies on its line to where others leave it."""
    local = points.local[rest]
    from_seed, way = local - points.local[seed], points.direction[seed]
    along = from_seed @ way
    near = np.linalg.norm(from_seed - along[:, None] * way, axis=1) < MOST_OFF_M
    span = _fit(points.local, rest[near & (np.abs(along) < _SEED_M)])
    for _ in range(_GROWTHS):
        if span is None or span.noise_m > MOST_OFF_M / 2:
            return None
        at = span.along(local)
        reach = max(_SEED_M, span.long_m / 2)
        near = (at > span.start_m - reach) & (at < span.end_m + reach)
        near[near] = np.linalg.norm(local[near] - span.at(at[near]), axis=1) < MOST_OFF_M
        longer = _fit(points.local, rest[near])
        if longer is None or longer.long_m < span.long_m + _SEED_M / 10:
            return span
        span = longer
    return span


def _joined(local: Floats, pieces: Sequence[WireSpan], monitor: Monitor) -> list[WireSpan]:
    """Pieces of one wire as one, the nearest joined first."""
    spans = list(pieces)
    ways = [_way_of(one) for one in spans]
    joined_to = list(range(len(spans)))

    def whole(number: int) -> int:
        while joined_to[number] != number:
            joined_to[number] = number = joined_to[joined_to[number]]
        return number

    pairs = _neighbours(pieces)
    for (a, b), is_away in zip(pairs, _turn_away(ways, pairs), strict=True):
        first, second = whole(a), whole(b)
        # Most pairs were never joined to others and turn away: all of them were asked at once.
        if (is_away and first == a and second == b) or first == second:
            continue
        monitor.check()
        if _turns_away(ways[first], ways[second]):
            continue
        both = _both(local, spans[first], spans[second])
        if both is not None:
            joined_to[first] = joined_to[second] = len(spans)
            joined_to.append(len(spans))
            spans.append(both)
            ways.append(_way_of(both))
    return [span for number, span in enumerate(spans) if joined_to[number] == number]


class _PieceWay(NamedTuple):
    """Middle, way in plan, slope and length of a piece: what rules most neighbours out."""

    middle: tuple[float, float, float]
    way: tuple[float, float]
    slope: float
    long_m: float


def _way_of(span: WireSpan) -> _PieceWay:
    east, north, height = span.at(np.zeros(1))[0].tolist()
    way = (float(span.way[0]), float(span.way[1]))
    return _PieceWay((east, north, height), way, float(span.rise[1]), span.long_m)


def _turn_away(ways: Sequence[_PieceWay], pairs: Sequence[tuple[int, int]]) -> list[bool]:
    """Whether the pieces of each pair can't be of one wire, as `_turns_away` tells it."""
    if not pairs:
        return []
    values = np.array([(*one.middle, *one.way, one.slope, one.long_m) for one in ways])
    one, other = (values[side].T for side in np.array(pairs).T)
    east, north, up = other[:3] - one[:3]
    turn, facing = one[3] * other[4] - one[4] * other[3], one[3] * other[3] + one[4] * other[4]
    least = _TURN + 0.1 / np.minimum(one[6], other[6])
    aside = np.abs(one[3] * north - one[4] * east)
    along = one[3] * east + one[4] * north
    foretold = along * (one[5] + np.copysign(1.0, facing) * other[5]) / 2
    most = _SIDE_M + least * np.hypot(east, north)
    is_away = (np.abs(turn) > least) | (aside > most) | (np.abs(up - foretold) > most)
    told: list[bool] = is_away.tolist()
    return told


def _turns_away(one: _PieceWay, other: _PieceWay) -> bool:
    """Whether two pieces can't be of one wire, by their directions and where they are."""
    least = _TURN + 0.1 / min(one.long_m, other.long_m)
    if abs(one.way[0] * other.way[1] - one.way[1] * other.way[0]) > least:
        return True
    east, north, up = (b - a for a, b in zip(one.middle, other.middle, strict=True))
    far = math.hypot(east, north)
    if abs(one.way[0] * north - one.way[1] * east) > _SIDE_M + least * far:
        return True
    along = one.way[0] * east + one.way[1] * north
    facing = math.copysign(1.0, one.way[0] * other.way[0] + one.way[1] * other.way[1])
    # Between two points of a parabola the chord is as steep as both are in the mean.
    foretold = along * (one.slope + facing * other.slope) / 2
    return abs(up - foretold) > _SIDE_M + least * far


def _neighbours(pieces: Sequence[WireSpan]) -> list[tuple[int, int]]:
    """Pairs of pieces whose ends are near each other, the nearest first."""
    from scipy.spatial import cKDTree

    if len(pieces) < 2:
        return []
    ends = np.concatenate([one.at(np.array([one.start_m, one.end_m])) for one in pieces])
    pairs = cKDTree(ends).query_pairs(_GAP_M, output_type="ndarray")
    pairs = pairs[pairs[:, 0] // 2 != pairs[:, 1] // 2]
    away = np.linalg.norm(ends[pairs[:, 0]] - ends[pairs[:, 1]], axis=1)
    sides = np.sort(pairs // 2, axis=1)
    nearest = np.argsort(away, kind="stable")
    _, first = np.unique(sides[nearest] @ (len(pieces), 1), return_index=True)
    found: list[tuple[int, int]] = [tuple(one) for one in sides[nearest[np.sort(first)]].tolist()]
    return found


def _both(local: Floats, one: WireSpan, other: WireSpan) -> WireSpan | None:
    """Two pieces of about one direction as one wire; None where they aren't."""
    ends = one.along(other.at(np.array([other.start_m, other.end_m])))
    low, high = float(ends.min()), float(ends.max())
    gap = max(low - one.end_m, one.start_m - high)
    if gap > min(_GAP_M, _GAP_SHARE * (one.long_m + other.long_m)):
        return None
    if min(high, one.end_m) - max(low, one.start_m) > 0.5 * min(one.long_m, other.long_m):
        return None if not _same(one, other) else _fit(local, _lines(one, other))
    both = _fit(local, _lines(one, other))
    if both is None or both.lines.size < 0.9 * (one.lines.size + other.lines.size):
        return None
    worse = max(one.noise_m, other.noise_m)
    if both.noise_m > max(_WORSE * worse, worse + _WORSE_M) or both.noise_m > MOST_OFF_M:
        return None
    is_kept = all(_near_ends(both, part) < _SIDE_M for part in (one, other))
    return both if is_kept else None


def _lines(one: WireSpan, other: WireSpan) -> Integers:
    return np.unique(np.concatenate([one.lines, other.lines]))


def _same(one: WireSpan, other: WireSpan) -> bool:
    """Whether two pieces beside each other are of one wire: two passes, two heads."""
    return _near_ends(one, other) < _SIDE_M


def _near_ends(span: WireSpan, part: WireSpan) -> float:
    """How far the ends and the middle of a piece lie off a wire at most."""
    places = part.at(np.array([part.start_m, (part.start_m + part.end_m) / 2, part.end_m]))
    off = places - span.at(span.along(places))
    return float(np.linalg.norm(off, axis=1).max())

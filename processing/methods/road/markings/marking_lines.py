"""Strokes of paint put together: lines, broken lines, stop lines, bars of crossings."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.methods.road.markings.strokes import BrightStroke

MarkingType = Literal["solid", "broken", "stop_line", "crosswalk_bar", "other"]

_WORN_M = 1.4
"""Shorter gaps of a line are worn, dirty or hidden; gaps of broken lines are longer (道路標識、
区画線及び道路標示に関する命令: 1.5 m between the dots of a bus lane's edge at the least)."""

_BRIDGED_M = 3.0
"""A gap of a solid line that is bridged: what a parked vehicle's wheels hide."""

_LONGEST_GAP_M = 13.0
"""Of a broken line: 12 m on expressways."""

_TURN_PER_M, _TURN, _OFF_M, _OFF_SHARE = math.radians(0.5), math.radians(1.5), 0.05, 0.2
"""How much a line bends (a radius of 60 m over half the gap), how sure a direction is, and how far
off an end may lie: a share of its width, for wide ones."""

_ALIKE = 0.4
"""Share by which widths of the dashes of one line may differ."""

_ACROSS = math.radians(50.0)
"""A stop line lies across the way; askew at skewed junctions."""

_BAR_WIDE_M, _BAR_LONG_M = (0.25, 0.75), (1.2, 8.0)
_BAR_APART_M = (0.5, 1.7)
"""Bars and the road between them are about as wide as each other: 0.45 to 0.5 m in Japan, up to
0.75 m elsewhere."""

_BAR_TURN, _FEWEST_BARS = math.radians(8.0), 3
_STOP_WIDE_M, _STOP_LONG_M = (0.2, 0.75), 1.5
_REGULAR = 0.2
"""Share by which the periods of a broken line differ from whole ones."""

_LINE_WIDE_M, _LINE_LONG_M = 0.35, 1.0
_SOLID_LONG_M = 3.0

_HERMITE_M = 1.0
"""Between vertices in a gap."""


@dataclass(frozen=True)
class MarkingLine:
    """One marking.

    Attributes
    ----------
    type : str
    strokes : tuple of BrightStroke
        In their order along it.
    line : (n, 2) float64
        Along its middle, m about the plan's origin.
    pattern_m : (dash, gap) or None
        Of a broken line.
    fellows : int
        Strokes that make it what it is: the dashes of a broken line, the bars of a crossing.
    """

    type: MarkingType
    strokes: tuple[BrightStroke, ...]
    line: Floats
    pattern_m: tuple[float, float] | None = None
    fellows: int = 1

    @property
    def width_m(self) -> float:
        """Of its paint."""
        return float(np.average([s.width_m for s in self.strokes], weights=self._lengths))

    @property
    def painted_m(self) -> float:
        """Length of its strokes."""
        return float(self._lengths.sum())

    @property
    def _lengths(self) -> Floats:
        return np.array([max(s.long_m, 0.01) for s in self.strokes])

    def mean_of(self, name: str) -> float:
        """A fact of its strokes, by their lengths."""
        return float(np.average([getattr(s, name) for s in self.strokes], weights=self._lengths))


def markings_of(strokes: Sequence[BrightStroke], path: Floats) -> list[MarkingLine]:
    """Markings that strokes make.

    Parameters
    ----------
    path : (n, 2) float64
        Where the vehicle drove; may be empty.
    """
    whole = [_joined(one) for one in _chains(_without_doubles(strokes), _WORN_M)]
    fellows = _bars_of(whole)
    bars = [
        MarkingLine("crosswalk_bar", (one,), one.line, fellows=count)
        for one, count in zip(whole, fellows.tolist(), strict=True)
        if count
    ]
    rest = [one for one, count in zip(whole, fellows.tolist(), strict=True) if not count]
    angles = _angles_to_way(rest, path)
    stops = [
        one for one, angle in zip(rest, angles, strict=True) if angle > _ACROSS and _may_stop(one)
    ]
    is_line = [one not in stops and one.width_m <= _LINE_WIDE_M for one in rest]
    lines = [one for one, is_one in zip(rest, is_line, strict=True) if is_one]
    found = bars + [MarkingLine("stop_line", (one,), one.line) for one in stops]
    for chain in _chains(lines, _LONGEST_GAP_M):
        found += _lines_of(chain)
    others = [one for one, is_one in zip(rest, is_line, strict=True) if not is_one]
    return found + [MarkingLine("other", (o,), o.line) for o in others if o not in stops]


def _without_doubles(strokes: Sequence[BrightStroke]) -> list[BrightStroke]:
    """Strokes, without those that lie on longer ones: two scales may show the same paint."""
    from scipy.spatial import cKDTree

    ordered = sorted(strokes, key=lambda one: -one.long_m)
    if not ordered:
        return []
    places = [_every(one.line, 0.2) for one in ordered]
    owner = np.repeat(np.arange(len(ordered)), [len(one) for one in places])
    tree = cKDTree(np.concatenate(places))
    kept: list[BrightStroke] = []
    is_kept = np.zeros(len(ordered), np.bool_)
    for number, one in enumerate(ordered):
        reach = max(0.15, 0.6 * one.width_m)
        near = [tree.query_ball_point(place, reach) for place in places[number]]
        covered = [any(owner[k] < number and is_kept[owner[k]] for k in some) for some in near]
        if np.mean(covered) < 0.5:
            is_kept[number] = True
            kept.append(one)
    return kept


def _every(line: Floats, step_m: float) -> Floats:
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T))]
    at = np.linspace(0.0, along[-1], max(2, math.ceil(along[-1] / step_m) + 1))
    return np.column_stack([np.interp(at, along, axis) for axis in line.T])


def _ways_out(line: Floats) -> tuple[Floats, Floats]:
    """Unit vectors that lead out of a line at its first and its last end."""
    ends = []
    for one in (line[::-1], line):
        away = np.hypot(*(one - one[-1]).T)
        start = one[max(0, int(np.argmax(away <= 2.0)) - 1)] if away[0] > 2.0 else one[0]
        way = one[-1] - start
        ends.append(way / max(float(np.hypot(*way)), 1e-9))
    return ends[0], ends[1]


def _chains(strokes: Sequence[BrightStroke], gap_m: float) -> list[list[BrightStroke]]:
    """Strokes that lead into each other, in their order and turned the same way."""
    from scipy.spatial import cKDTree

    if len(strokes) < 2:
        return [[one] for one in strokes]
    ends = np.array([[one.line[0], one.line[-1]] for one in strokes]).reshape(-1, 2)
    ways = np.array([_ways_out(one.line) for one in strokes]).reshape(-1, 2)
    pairs = cKDTree(ends).query_pairs(gap_m, output_type="ndarray")
    apart = ends[pairs[:, 1]] - ends[pairs[:, 0]]
    costs = [
        _cost(strokes, (int(a), int(b)), ways, away)
        for (a, b), away in zip(pairs.tolist(), apart, strict=True)
    ]
    partner = np.full(len(ends), -1, np.int64)
    for k in np.argsort(costs).tolist():
        a, b = pairs[k].tolist()
        if math.isfinite(costs[k]) and partner[a] < 0 and partner[b] < 0:
            partner[a], partner[b] = b, a
    return _walked(strokes, partner)


def _cost(
    strokes: Sequence[BrightStroke], ends: tuple[int, int], ways: Floats, apart: Floats
) -> float:
    """How badly an end leads to another, m; infinite where it doesn't.

    On an arc the line between two ends makes the same angle with both.
    """
    a, b = ends
    if a // 2 == b // 2:
        return math.inf
    one, other = strokes[a // 2], strokes[b // 2]
    if abs(one.width_m - other.width_m) > _ALIKE * max(one.width_m, other.width_m):
        return math.inf
    long = float(np.hypot(*apart))
    if float(ways[a] @ -ways[b]) < 0.9:
        return math.inf
    if long < 0.3:
        off = abs(float(ways[a][0] * apart[1] - ways[a][1] * apart[0]))
        return long + 10 * off if off <= 0.1 else math.inf
    first, second = _turn(ways[a], apart), _turn(apart, -ways[b])
    shorter = max(min(one.long_m, other.long_m), 0.5)
    off = max(_OFF_M, _OFF_SHARE * min(one.width_m, other.width_m))
    unsure = _TURN + math.atan(off / long) + math.atan(0.01 / shorter)
    if (
        abs(first - second) > 2 * unsure
        or max(abs(first), abs(second)) > unsure + _TURN_PER_M * long
    ):
        return math.inf
    return long + 2 * long * (abs(first) + abs(second))


def _turn(one: Floats, other: Floats) -> float:
    """From one way to another, rad."""
    return math.atan2(
        float(one[0] * other[1] - one[1] * other[0]), float(one[0] * other[0] + one[1] * other[1])
    )


def _walked(strokes: Sequence[BrightStroke], partner: Integers) -> list[list[BrightStroke]]:
    chains: list[list[BrightStroke]] = []
    is_used = np.zeros(len(strokes), np.bool_)
    starts = [k for k in range(len(partner)) if partner[k] < 0] + list(range(len(partner)))
    for start in starts:
        if is_used[start // 2]:
            continue
        chain: list[BrightStroke] = []
        end = start
        while end >= 0 and not is_used[end // 2]:
            number = end // 2
            is_used[number] = True
            one = strokes[number]
            chain.append(one if end % 2 == 0 else replace(one, line=one.line[::-1]))
            end = int(partner[end ^ 1])
        chains.append(chain)
    return chains


def _joined(chain: Sequence[BrightStroke]) -> BrightStroke:
    """One stroke of several that follow each other."""
    if len(chain) == 1:
        return chain[0]
    weights = np.array([max(one.long_m, 0.01) for one in chain])
    line = _connected(chain)
    facts = {
        name: float(np.average([getattr(one, name) for one in chain], weights=weights))
        for name in ("width_m", "width_spread_m", "paint", "beside", "seen_share")
    }
    return BrightStroke(line, **facts)


def _bars_of(strokes: Sequence[BrightStroke]) -> Integers:
    """Of each stroke how many bars the crossing has that it belongs to; 0: it is no bar."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    fellows = np.zeros(len(strokes), np.int64)
    chosen = [k for k, one in enumerate(strokes) if _may_be_bar(one)]
    if len(chosen) < _FEWEST_BARS:
        return fellows
    middles = np.array([(strokes[k].line[0] + strokes[k].line[-1]) / 2 for k in chosen])
    pairs = cKDTree(middles).query_pairs(2 * _BAR_APART_M[1], output_type="ndarray")
    alike = np.array(
        [_are_beside(strokes[chosen[a]], strokes[chosen[b]]) for a, b in pairs.tolist()], np.bool_
    )
    linked = pairs[alike] if len(pairs) else pairs
    size = len(chosen)
    graph = coo_array((np.ones(len(linked)), (linked[:, 0], linked[:, 1])), shape=(size, size))
    _, group = connected_components(graph, directed=False)
    sizes = np.bincount(group)[group]
    fellows[chosen] = np.where(sizes >= _FEWEST_BARS, sizes, 0)
    return fellows


def _may_be_bar(one: BrightStroke) -> bool:
    chord = float(np.hypot(*(one.line[-1] - one.line[0])))
    is_wide = _BAR_WIDE_M[0] <= one.width_m <= _BAR_WIDE_M[1]
    return is_wide and _BAR_LONG_M[0] <= one.long_m <= _BAR_LONG_M[1] and chord > 0.97 * one.long_m


def _are_beside(one: BrightStroke, other: BrightStroke) -> bool:
    """Whether two bars stand side by side as those of a crossing do."""
    way = one.line[-1] - one.line[0]
    long = float(np.hypot(*way))
    way /= long
    theirs = other.line[-1] - other.line[0]
    turn = abs(_turn(way, theirs))
    if min(turn, math.pi - turn) > _BAR_TURN:
        return False
    if abs(one.width_m - other.width_m) > 0.3 * max(one.width_m, other.width_m):
        return False
    apart = (other.line[0] + other.line[-1] - one.line[0] - one.line[-1]) / 2
    aside = abs(float(way[0] * apart[1] - way[1] * apart[0]))
    most = max(_BAR_APART_M[0], 2.6 * one.width_m)
    shorter = min(long, float(np.hypot(*theirs)))
    longer = max(long, float(np.hypot(*theirs)))
    overlap = (long + float(np.hypot(*theirs))) / 2 - abs(float(apart @ way))
    return (
        max(_BAR_APART_M[0], 1.4 * one.width_m) <= aside <= most
        and overlap > 0.6 * shorter
        and longer < 3 * shorter
    )


def _angles_to_way(strokes: Sequence[BrightStroke], path: Floats) -> list[float]:
    """Of strokes to the nearest place of the path, 0 to π/2; 0 without a path."""
    from scipy.spatial import cKDTree

    if len(path) < 2:
        return [0.0] * len(strokes)
    tree = cKDTree(path)
    ways = np.gradient(path, axis=0)
    angles = []
    for one in strokes:
        _, nearest = tree.query((one.line[0] + one.line[-1]) / 2)
        turn = abs(_turn(ways[int(nearest)], one.line[-1] - one.line[0]))
        angles.append(min(turn, math.pi - turn))
    return angles


def _may_stop(one: BrightStroke) -> bool:
    return _STOP_WIDE_M[0] <= one.width_m <= _STOP_WIDE_M[1] and one.long_m >= _STOP_LONG_M


def _connected(chain: Sequence[BrightStroke]) -> Floats:
    """One line through strokes; gaps are bent as the strokes on both sides lead (cubic Hermite)."""
    parts = [chain[0].line]
    for before, after in itertools.pairwise(chain):
        start, end = before.line[-1], after.line[0]
        long = float(np.hypot(*(end - start)))
        out, into = _ways_out(before.line)[1], -_ways_out(after.line)[0]
        if long > _HERMITE_M and float(out @ into) > 0.5:
            t = np.arange(1, math.ceil(long / _HERMITE_M))[:, None] * _HERMITE_M / long
            parts.append(
                (2 * t**3 - 3 * t**2 + 1) * start
                + (t**3 - 2 * t**2 + t) * long * out
                + (3 * t**2 - 2 * t**3) * end
                + (t**3 - t**2) * long * into
            )
        parts.append(after.line)
    return np.concatenate(parts)


def _lines_of(chain: Sequence[BrightStroke]) -> list[MarkingLine]:
    """A broken line, or solid ones between the gaps of a chain."""
    pattern = _pattern_of(chain)
    if pattern is not None:
        line = _connected(chain)
        return [MarkingLine("broken", tuple(chain), line, pattern, len(chain))]
    parts: list[list[BrightStroke]] = [[chain[0]]]
    for before, after in itertools.pairwise(chain):
        if float(np.hypot(*(after.line[0] - before.line[-1]))) > _BRIDGED_M:
            parts.append([])
        parts[-1].append(after)
    found = []
    for part in parts:
        line = _connected(part)
        long = float(np.hypot(*np.diff(line, axis=0).T).sum())
        is_line = long >= _SOLID_LONG_M or (len(parts) > 1 and long >= _LINE_LONG_M)
        found.append(MarkingLine("solid" if is_line else "other", tuple(part), line))
    return found


def _pattern_of(chain: Sequence[BrightStroke]) -> tuple[float, float] | None:
    """Dash and gap of a broken line; None for strokes that come irregularly.

    Where dashes are missing the way to the next one is several periods long.
    """
    if len(chain) < 2:
        return None
    gaps = np.array(
        [
            float(np.hypot(*(after.line[0] - before.line[-1])))
            for before, after in itertools.pairwise(chain)
        ]
    )
    dashes = np.array([one.long_m for one in chain])
    # The first and the last may be cut short by the end of what was seen.
    whole = dashes[1:-1] if len(chain) > 3 else dashes
    dash, gap = float(np.median(whole)), float(np.median(gaps))
    if gap < _WORN_M or dash > 1.3 * _LONGEST_GAP_M or dash < 0.25 * gap:
        return None
    middles = (dashes[:-1] + dashes[1:]) / 2
    periods = gaps + np.where(np.abs(middles - dash) < _REGULAR * dash, middles, dash)
    count = np.maximum(1.0, np.rint(periods / (dash + gap)))
    off = np.abs(periods / count - (dash + gap)) / (dash + gap)
    if len(chain) == 2:
        return (dash, gap) if dashes.min() > 0.4 * dashes.max() and dash < 11.0 else None
    even = np.abs(whole - dash) < _REGULAR * dash
    return (dash, gap) if np.mean(off < _REGULAR) > 0.6 and even.mean() > 0.5 else None

"""Break lines drawn by hand, made one net: they meet at vertices, with one height at each.

A crest and a toe are edges of the ground; where two of them cross they have to be at one height,
or one of them is drawn wrongly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.text import Text

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

_SAME_POSITION_M = 1e-3
"""Vertices, and a vertex and a line, that are nearer in plan are at one position: files have whole
millimetres."""

_PARALLEL_SINE = 1e-9
"""Sine of the angle below which two segments run the same way, and cross nowhere."""


@dataclass(frozen=True)
class BreakNet:
    """Break lines as segments that have nothing in common but their ends.

    Attributes
    ----------
    xyz : (v, 3) float64
        Vertices, each at another position in plan, in the frame of the lines, m.
    segments : (s, 2) int64
        Rows of ``xyz``.
    """

    xyz: Floats
    segments: Numbers


def break_net(lines: Sequence[Floats], agree_within_m: float) -> BreakNet:
    """Lines joined where they meet or cross.

    Parameters
    ----------
    lines : sequence of (k, 3) float64
        m, project CRS.
    agree_within_m : float
        Lines whose heights differ by less where they meet are joined at the mean of both.

    Raises
    ------
    Unsuitable
        A line without two positions apart in plan, or with a vertex that is no number; lines whose
        heights disagree where they meet.
    """
    _check_lines(lines)
    xyz = np.concatenate([np.asarray(line, np.float64) for line in lines])
    firsts = np.concatenate([[0], np.cumsum([len(line) for line in lines])])
    is_start = np.ones(len(xyz), bool)
    is_start[firsts[1:] - 1] = False
    starts = np.flatnonzero(is_start)
    net = _joined(xyz, np.column_stack([starts, starts + 1]), agree_within_m)
    xyz, segments = _cut_where_they_meet(net)
    return _joined(xyz, segments, agree_within_m)


def _check_lines(lines: Sequence[Floats]) -> None:
    for number, line in enumerate(lines, 1):
        where = Text(f"Break line {number}", f"ブレークライン{number}")
        again = Text("Draw the line again.", "線を描き直してください。")
        if not np.isfinite(line).all():
            raise Unsuitable(
                Text("A break line has a place without position.", "座標のない点があります。"),
                where,
                again,
            )
        if len(line) < 2 or np.ptp(line[:, :2], axis=0).max() < _SAME_POSITION_M:
            raise Unsuitable(
                Text("A break line has no length in plan.", "平面上の長さがありません。"),
                where,
                again,
            )


def _joined(xyz: Floats, segments: Numbers, agree_within_m: float) -> BreakNet:
    """The same with vertices at one position made one, at their mean height."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    origin = xyz[:, :2].min(axis=0)
    pairs = cKDTree(xyz[:, :2] - origin).query_pairs(_SAME_POSITION_M, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(xyz),) * 2)
    count, position = connected_components(links, directed=False)
    lowest, highest = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(lowest, position, xyz[:, 2])
    np.maximum.at(highest, position, xyz[:, 2])
    first = np.full(count, len(xyz))
    np.minimum.at(first, position, np.arange(len(xyz)))
    apart = highest - lowest
    if apart.max() > agree_within_m:
        worst = int(apart.argmax())
        raise _disagree(xyz[first[worst]], lowest[worst], highest[worst])
    heights = np.bincount(position, xyz[:, 2]) / np.bincount(position)
    merged = np.column_stack([xyz[first, :2], heights])
    ends = np.sort(position[segments].astype(np.int64), axis=1)
    ends = np.unique(ends[ends[:, 0] != ends[:, 1]], axis=0)
    return BreakNet(merged, ends)


def _disagree(at: Floats, low_m: float, high_m: float) -> Unsuitable:
    return Unsuitable(
        Text(
            f"Break lines meet at heights that differ by {high_m - low_m:.2f} m.",
            f"ブレークラインどうしの高さが交点で{high_m - low_m:.2f} m異なります。",
        ),
        Text(
            f"Easting {at[0]:.3f}, northing {at[1]:.3f}: {low_m:.3f} m and {high_m:.3f} m",
            f"東{at[0]:.3f} 北{at[1]:.3f}（{low_m:.3f} mと{high_m:.3f} m）",
        ),
        Text(
            "Give both lines the same height there, or draw one of them so that it ends before.",
            "交点で両方の線の高さをそろえるか、一方の線を手前で止めてください。",
        ),
    )


def _cut_where_they_meet(net: BreakNet) -> tuple[Floats, Numbers]:
    """Vertices and segments with each segment cut where others touch or cross it.

    A position where two meet gives each its own vertex, at the height that it has there.
    """
    origin = net.xyz[:, :2].min(axis=0)
    plan = net.xyz[:, :2] - origin
    figures = shapely.linestrings(plan[net.segments])
    pairs = shapely.STRtree(figures).query(figures, predicate="dwithin", distance=_SAME_POSITION_M)
    one, other = pairs[:, pairs[0] != pairs[1]]
    meetings = [_touched(plan, net.segments, one, net.segments[other, end]) for end in range(2)]
    meetings.append(_crossed(plan, net.segments, one, other))
    cut, shares, positions = (np.concatenate(parts) for parts in zip(*meetings, strict=True))
    low, high = net.xyz[net.segments[cut], 2].T
    added = np.column_stack([positions + origin, low + shares * (high - low)])
    every = np.arange(len(net.segments))
    of_segment = np.concatenate([every, cut, every])
    along = np.concatenate([np.full(len(every), -1.0), shares, np.full(len(every), 2.0)])
    numbers = len(net.xyz) + np.arange(len(added))
    vertices = np.concatenate([net.segments[:, 0], numbers, net.segments[:, 1]])
    order = np.lexsort((along, of_segment))
    chain, of_segment = vertices[order], of_segment[order]
    follows = of_segment[1:] == of_segment[:-1]
    segments = np.column_stack([chain[:-1][follows], chain[1:][follows]])
    return np.concatenate([net.xyz, added]), segments


def _touched(
    plan: Floats, segments: Numbers, one: Numbers, vertex: Numbers
) -> tuple[Numbers, Floats, Floats]:
    """Segments on which a vertex lies, but not at their ends: which, where along, the position."""
    start, along = plan[segments[one, 0]], plan[segments[one, 1]] - plan[segments[one, 0]]
    to_vertex = plan[vertex] - start
    share = (to_vertex * along).sum(axis=1) / (along**2).sum(axis=1)
    beside = np.hypot(*(to_vertex - share[:, None] * along).T)
    is_on = (share > 0.0) & (share < 1.0) & (beside <= _SAME_POSITION_M)
    is_on &= (vertex != segments[one, 0]) & (vertex != segments[one, 1])
    return one[is_on], share[is_on], plan[vertex[is_on]]


def _crossed(
    plan: Floats, segments: Numbers, one: Numbers, other: Numbers
) -> tuple[Numbers, Floats, Floats]:
    """Segments that others cross between the ends of both: which, where along, at what position."""
    start, along = plan[segments[one, 0]], plan[segments[one, 1]] - plan[segments[one, 0]]
    their, across = plan[segments[other, 0]], plan[segments[other, 1]] - plan[segments[other, 0]]
    between = their - start
    turn = along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0]
    is_turned = np.abs(turn) > _PARALLEL_SINE * np.hypot(*along.T) * np.hypot(*across.T)
    safe = np.where(is_turned, turn, 1.0)
    share = (between[:, 0] * across[:, 1] - between[:, 1] * across[:, 0]) / safe
    their_share = (between[:, 0] * along[:, 1] - between[:, 1] * along[:, 0]) / safe
    crosses = is_turned & (share > 0.0) & (share < 1.0) & (their_share > 0.0) & (their_share < 1.0)
    positions = start + share[:, None] * along
    return one[crosses], share[crosses], positions[crosses]

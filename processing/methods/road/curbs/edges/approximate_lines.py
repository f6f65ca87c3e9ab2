"""Rough lines of whole curbs: the step runs of all passes joined, before anything is measured.

Every line has the higher ground on its left, so that runs of drives there and back, and the two
sides of an island, follow from their own geometry. Where a run was seen by several passes the
longest gives the line; the others only go on where it ends.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.methods.road.curbs.edges.curb_smoothing import Smoothness, smooth_values
from processing.methods.road.curbs.edges.edge_measures import STEP_M as STATION_M
from processing.methods.road.curbs.steps.curb_runs import StepRun

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_SAME_M, _SAME_HEIGHT_M = 0.25, 0.25
"""Pieces that run so near beside each other are one curb: runs of several passes differ by up to
the offset of their trajectories (15 cm, `curb_join_kernels`) and their own 3 cm. By trial."""

_SAME_DIRECTION = math.cos(math.radians(30.0))
"""Cosine: what turns away by more is another curb. By trial."""

_LEAST_STATIONS = 3
"""A piece has at least three places, 0.75 m: fewer give no direction."""

_ROUGH = Smoothness(stiffness=60.0, kink=0.05)
"""Of rough lines, m: stiff, since places of runs scatter by some 3 cm; they need only lie within
the reach of the exact edges. By trial."""

_BRIDGED_WEIGHT, _GAP_WEIGHT = 0.05, 0.001
"""Weights, of 1, of places that a run bridged, and of those between two pieces, which are straight
guesses and hold the line only where nothing else does. By trial."""

_ASIDE_M, _ASIDE_PER_M = 0.12, 0.06
"""How far a piece may begin beside the line of another's end: at once, m, and per metre of the gap
(3.4°). The one of both that fits worse may be off by twice as much. By trial."""

_UP_M, _UP_PER_M = 0.1, 0.03
"""The same of the height against that which both rise to: at once, m, and per metre. By trial."""

_TURN = math.cos(math.radians(35.0))
"""Cosine of the most that a curb turns between two pieces, corners aside. By trial."""

_CORNER_M, _CORNER_TURN = 1.0, math.cos(math.radians(100.0))
_CORNER_UP_M = 0.05
"""Ends so near to each other, m, and so little apart in height are one corner of small radius,
whatever they turn up to 100°: right angles, as they were measured."""

_ASIDE_COST = 5.0
"""A metre aside costs as much as so many metres of gap: of two ways to go on the straighter one is
taken unless it is far longer. By trial."""

_DIRECTION_M = 2.0
"""Length of an end that gives its direction. By trial."""


@dataclass(frozen=True)
class ApproximateLine:
    """The rough lower edge of one curb.

    Attributes
    ----------
    xyz : (m, 3) float64
        Every ``STATION_M`` along it, the higher ground on the left, m, project CRS.
    outwards : (m, 2) float64
        Level unit vectors to the left.
    is_seen : (m,) bool
        False: bridged.
    step_m, width_m : (m,) float64
        Rough height and width of the face.
    is_hidden : (m,) bool
        The face looks away from the vehicle.
    is_edging : (m,) bool
        The far edge of a narrow edging stone.
    is_along : bool
        The first drive that saw it passed it in the line's own direction.
    runs : (m,) int64
        The step run that each place is from; −1 where bridged.
    drive : int
        The first drive that saw it.
    is_alone : bool
        It ends at corners: it isn't joined to others nor followed farther.
    """

    xyz: _Floats
    outwards: _Floats
    is_seen: NDArray[np.bool_]
    step_m: _Floats
    width_m: _Floats
    is_hidden: NDArray[np.bool_]
    is_edging: NDArray[np.bool_]
    is_along: bool
    runs: _Integers
    drive: int
    is_alone: bool = False


@dataclass(frozen=True)
class _Piece:
    """A stretch of one run: (m, …) every ``STATION_M``, the higher ground on the left."""

    xyz: _Floats
    step_m: _Floats
    width_m: _Floats
    is_seen: NDArray[np.bool_]
    is_hidden: bool
    is_edging: bool
    is_along: bool
    run: int
    drive: int
    is_alone: bool = False

    def cut(self, first: int, stop: int) -> _Piece:
        part = slice(first, stop)
        return replace(
            self,
            xyz=self.xyz[part],
            step_m=self.step_m[part],
            width_m=self.width_m[part],
            is_seen=self.is_seen[part],
        )


def approximate_lines_of(runs: Sequence[StepRun], bridge_m: float) -> tuple[ApproximateLine, ...]:
    """Rough lines of curbs.

    Parameters
    ----------
    runs : sequence of StepRun
        Of all passes of all drives.
    bridge_m : float
        How far apart the ends of pieces of one curb may be.

    Returns
    -------
    tuple of ApproximateLine
        In no order.
    """
    return _join(
        [piece for number, run in enumerate(runs) if (piece := _piece_of(run, number))], bridge_m
    )


def rejoin_lines(
    approximate_lines: Sequence[ApproximateLine], bridge_m: float
) -> tuple[ApproximateLine, ...]:
    """Lines that were extended, each place once and those that meet as one."""
    pieces = []
    for approximate_line in approximate_lines:
        of = approximate_line.runs[approximate_line.runs >= 0]
        pieces.append(
            _Piece(
                approximate_line.xyz,
                approximate_line.step_m,
                approximate_line.width_m,
                approximate_line.is_seen,
                bool(approximate_line.is_hidden.mean() > 0.5),
                bool(approximate_line.is_edging.mean() > 0.5),
                approximate_line.is_along,
                int(np.bincount(of).argmax()) if of.size else 0,
                approximate_line.drive,
                approximate_line.is_alone,
            )
        )
    return _join(pieces, bridge_m)


def _join(pieces: Sequence[_Piece], bridge_m: float) -> tuple[ApproximateLine, ...]:
    kept = _without_doubles(sorted(pieces, key=lambda one: (-one.xyz.shape[0], one.run)))
    return tuple(
        _approximate_line_of([kept[i] for i in chain]) for chain in _chains(kept, bridge_m)
    )


def outwards_of(xyz: _Floats) -> _Floats:
    """(m, 2) level unit vectors to the left of a line."""
    ahead = np.gradient(xyz[:, :2], axis=0)
    ahead /= np.maximum(np.linalg.norm(ahead, axis=1), 1e-9)[:, None]
    return np.column_stack([-ahead[:, 1], ahead[:, 0]])


def _piece_of(run: StepRun, number: int) -> _Piece | None:
    """A run, every ``STATION_M`` along its own smooth lower edge."""
    is_left_high = (run.rises > 0) == (run.side < 0)
    order = slice(None) if is_left_high else slice(None, None, -1)
    lower, upper = run.lower[order], run.upper[order]
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(lower[:, :2], axis=0).T)))
    count = int(along[-1] / STATION_M)
    if count < _LEAST_STATIONS or not run.is_seen.any():
        return None
    at = np.linspace(0.0, along[-1], count + 1)
    rough = _at(at, along, lower)
    seen = np.interp(at, along, run.is_seen[order].astype(float)) > 0.5
    weights = np.where(seen, 1.0, _BRIDGED_WEIGHT)
    smooth = np.column_stack([smooth_values(rough[:, k], weights, _ROUGH) for k in range(3)])
    step = np.interp(at, along, upper[:, 2] - lower[:, 2])
    left = outwards_of(smooth)
    lean = _at(at, along, upper - lower)
    width = (lean[:, :2] * left).sum(axis=1)
    kind = (run.rises < 0, run.is_edging, is_left_high)
    return _Piece(smooth, step, width, seen, *kind, number, run.drive, run.chance_beside > 0)


def _at(at: _Floats, along: _Floats, values: _Floats) -> _Floats:
    return np.column_stack([np.interp(at, along, column) for column in values.T])


def _without_doubles(pieces: Sequence[_Piece]) -> list[_Piece]:
    """Of places that several pieces have only the first's."""
    kept: list[_Piece] = []
    for piece in pieces:
        is_new = ~_has(kept, piece)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], is_new, [False]]).astype(np.int8)))
        for first, stop in edges.reshape(-1, 2):
            if stop - first >= _LEAST_STATIONS:
                kept.append(piece.cut(int(first), int(stop)))
    return kept


def _has(kept: Sequence[_Piece], piece: _Piece) -> NDArray[np.bool_]:
    """(m,) where a piece runs along others."""
    if not kept:
        return np.zeros(piece.xyz.shape[0], np.bool_)
    xyz = np.vstack([one.xyz for one in kept])
    left = np.vstack([outwards_of(one.xyz) for one in kept])
    away, nearest = cKDTree(xyz[:, :2]).query(
        piece.xyz[:, :2], distance_upper_bound=_SAME_M + STATION_M
    )
    found = np.isfinite(away)
    nearest = np.where(found, nearest, 0)
    mine = outwards_of(piece.xyz)
    off = piece.xyz - xyz[nearest]
    aside = np.abs((off[:, :2] * mine).sum(axis=1))
    same = (mine * left[nearest]).sum(axis=1) > _SAME_DIRECTION
    return np.asarray(found & same & (aside <= _SAME_M) & (np.abs(off[:, 2]) <= _SAME_HEIGHT_M))


def _chains(pieces: Sequence[_Piece], bridge_m: float) -> Iterator[list[int]]:
    """Pieces that follow each other, by number."""
    after: dict[int, int] = {}
    before: dict[int, int] = {}
    for _, one, other in sorted(_links(pieces, bridge_m)):
        if one in after or other in before or _leads_to(after, other, one):
            continue
        after[one], before[other] = other, one
    for first in range(len(pieces)):
        if first in before:
            continue
        chain = [first]
        while chain[-1] in after:
            chain.append(after[chain[-1]])
        yield chain


def _leads_to(after: dict[int, int], start: int, end: int) -> bool:
    while start != end and start in after:
        start = after[start]
    return start == end


def _links(pieces: Sequence[_Piece], bridge_m: float) -> Iterator[tuple[float, int, int]]:
    """Cost of each way in which a piece may go on with another, and the two."""
    if len(pieces) < 2:
        return
    extensions = np.array([piece.xyz[-1, :2] for piece in pieces])
    heads = cKDTree(np.array([piece.xyz[0, :2] for piece in pieces]))
    for one, near in enumerate(heads.query_ball_point(extensions, bridge_m + STATION_M)):
        for other in near:
            is_alone = other == one or pieces[one].is_alone or pieces[other].is_alone
            cost = math.inf if is_alone else _cost(pieces[one], pieces[other])
            if math.isfinite(cost):
                yield cost, one, other


def _cost(one: _Piece, other: _Piece) -> float:
    """How badly a piece goes on with another; infinite where it can't."""
    extension, head = _direction(one.xyz[::-1]) * -1.0, _direction(other.xyz)
    gap = other.xyz[0] - one.xyz[-1]
    long_m = float(np.hypot(gap[0], gap[1]))
    turn = float(extension[:2] @ head[:2])
    ahead = (float(gap[:2] @ extension[:2]), float(gap[:2] @ head[:2]))
    if turn < _TURN:
        is_corner = turn >= _CORNER_TURN and long_m <= _CORNER_M and abs(gap[2]) <= _CORNER_UP_M
        return 1.0 + long_m if is_corner and min(ahead) >= -STATION_M else math.inf
    aside = [abs(float(one[0] * gap[1] - one[1] * gap[0])) for one in (extension, head)]
    if min(ahead) < -2 * STATION_M or min(aside) > _ASIDE_M + _ASIDE_PER_M * long_m:
        return math.inf
    if max(aside) > 2 * (_ASIDE_M + _ASIDE_PER_M * long_m):
        return math.inf
    expected = 0.5 * (extension[2] + head[2]) * long_m
    if abs(gap[2] - expected) > _UP_M + _UP_PER_M * long_m:
        return math.inf
    return long_m + _ASIDE_COST * max(aside)


def _direction(xyz: _Floats) -> _Floats:
    """(3,) from the first place on, level length 1, by its beginning."""
    end = min(xyz.shape[0] - 1, int(_DIRECTION_M / STATION_M))
    ahead = xyz[end] - xyz[0]
    direction: _Floats = ahead / max(float(np.hypot(ahead[0], ahead[1])), 1e-9)
    return direction


def _approximate_line_of(pieces: Sequence[_Piece]) -> ApproximateLine:
    """One line of the pieces that follow each other, what lies between them bridged."""
    positions, run, piece_of = [pieces[0].xyz], [np.full(len(pieces[0].xyz), 0)], [0]
    for number in range(1, len(pieces)):
        positions.append(pieces[number].xyz)
        run.append(np.full(len(pieces[number].xyz), number))
        piece_of.append(number)
    xyz, which = np.vstack(positions), np.concatenate(run)
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(xyz[:, :2], axis=0).T)))
    rising = np.append(True, np.diff(along) > 1e-6)
    xyz, which, along = xyz[rising], which[rising], along[rising]
    steps = np.concatenate([piece.step_m for piece in pieces])[rising]
    widths = np.concatenate([piece.width_m for piece in pieces])[rising]
    seen = np.concatenate([piece.is_seen for piece in pieces])[rising]
    at = np.linspace(0.0, along[-1], max(2, round(float(along[-1]) / STATION_M) + 1))
    after = np.clip(np.searchsorted(along, at), 1, along.size - 1)
    is_near = (along[after] - along[after - 1]) <= 1.5 * STATION_M
    nearest = np.where(at - along[after - 1] < along[after] - at, after - 1, after)
    is_seen = is_near & seen[nearest]
    weights = np.where(is_seen, 1.0, _GAP_WEIGHT)
    rough = _at(at, along, xyz)
    smooth = np.column_stack([smooth_values(rough[:, k], weights, _ROUGH) for k in range(3)])
    first = min(pieces, key=lambda one: (one.drive, -one.xyz.shape[0]))
    return ApproximateLine(
        smooth,
        outwards_of(smooth),
        np.asarray(is_seen),
        np.interp(at, along, steps),
        np.interp(at, along, widths),
        np.array([piece.is_hidden for piece in pieces])[which[nearest]],
        np.array([piece.is_edging for piece in pieces])[which[nearest]],
        first.is_along,
        np.where(is_near, np.array([piece.run for piece in pieces])[which[nearest]], -1),
        first.drive,
        first.is_alone,
    )

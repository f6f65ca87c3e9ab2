"""Ends of a line that are no longer the curb: where it goes on along planting or the edge of a lot.

A curb is followed as long as there is a step. Beyond its last stone the edge of a raised lot or a
planting strip often rises as high and goes on straight; the ground about it is what differs from
pavement: soil, gravel and grass are rougher than what lies before and on the curb itself, and their
edge lies now here, now there, while stones are straight.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.curbs.edges.curb_joins import JointEdges
from processing.methods.road.curbs.edges.edge_measures import STEP_M

_Floats = NDArray[np.float64]
_Flags = NDArray[np.bool_]

FACED = 0.5
"""Of curbs whose face looks to the vehicle at least this share of places has points on it: most. By
trial: no measurement is recorded."""

_ROUGHER = 1.5
"""Times the line's own median: pavement differs by less, and soil or grass by more. By trial, on
lines that went on for 10 to 25 m beyond the last stone along raised lots and planting strips."""

_LEAST_ROUGH_M = 0.002
"""By less no scanner tells surfaces apart."""

_PLACED_M = 0.03
"""A place that is known no better (`_ERROR_M` of `curb_extension`), or by no point on the face,
says nothing of how straight the edge is."""

_JUMP_M, _JUMP_VOTE = 0.02, 2.5
"""A place lies off the middle between those beside it by no more where stones are: on samples and
own streets, worn ones too, 1 % of the places on curbs do (4 % at most), and 60 to 90 % of those on
verges that were taken for the end of a curb. A jump so speaks against stones 2.5 times as much as
none speaks for them: logarithms of 75 : 1 and of 99 : 25, about."""

_END_ERROR_M = 0.05
"""A line goes no farther than its place is known to the 5 cm that curbs are asked for: beyond, it
would lead straight on from where it was measured."""

_LEAST_M = 2.0
"""What is shorter may be litter, a joint or a wheel."""


def own_part(edges: JointEdges, is_known: _Flags, span: tuple[int, int]) -> tuple[int, int]:
    """What of a line is left once its ends are cut where its surfaces aren't its own.

    A place is doubted where it jumps aside, where the top is much rougher than along the line, or
    the ground at the foot is while no point lies on the face. An end is cut where most of it is
    doubted; places hardly known count neither way, and none of them ends a line. Of faces that
    look away the ground before them lies in their shadow: how rough it is says nothing.

    Parameters
    ----------
    edges : JointEdges
        At the stations of the approximate line.
    is_known : (m,) bool
        Where something was measured.
    span : tuple of int
        First and behind the last station of the line.

    Returns
    -------
    tuple of int
        The same of what is left; empty where nothing is.
    """
    first, stop = span
    at = first + np.flatnonzero(is_known[first:stop])
    if not at.size:
        return span
    has_face = edges.face_points[at] > 0
    is_placed = has_face & (edges.across_error[at] <= _PLACED_M)
    jumps = np.zeros(at.size, np.bool_)
    jumps[is_placed] = _jumps(edges.lower_across[at[is_placed]])
    votes = [np.where(jumps, _JUMP_VOTE, np.where(is_placed, -1.0, 0.0))]
    if has_face.mean() >= FACED:
        doubted = _is_rough(edges.high_off[at], has_face)
        doubted |= _is_rough(edges.low_off[at], has_face) & ~has_face
        votes.append(np.where(doubted, 1.0, -1.0))
    before = max(_doubted_end(one) for one in votes)
    behind = max(_doubted_end(one[::-1]) for one in votes)
    left = at[before : at.size - behind]
    left = left[edges.across_error[left] <= _END_ERROR_M]
    return (int(left[0]), int(left[-1]) + 1) if left.size else (first, first)


def _jumps(across_m: _Floats) -> _Flags:
    """Where a place lies aside of the middle between those before and behind it."""
    jumps = np.zeros(across_m.size, np.bool_)
    jumps[1:-1] = np.abs(across_m[1:-1] - (across_m[:-2] + across_m[2:]) / 2) > _JUMP_M
    return jumps


def _is_rough(off_m: _Floats, has_face: _Flags) -> _Flags:
    """Where points lie farther off a surface than where the curb is seen best."""
    usual_m = max(float(np.median(off_m[has_face])), _LEAST_ROUGH_M)
    return np.asarray(off_m > _ROUGHER * usual_m)


def _doubted_end(votes: _Floats) -> int:
    """How many of the first places are to be cut: those up to where doubts outnumber the rest most.

    (The largest sum of a beginning; Bentley, Programming Pearls, CACM 27(9), 1984.)
    """
    balance = np.cumsum(votes)
    best = int(np.argmax(balance))
    return best + 1 if balance[best] * STEP_M >= _LEAST_M else 0

"""Ends of a line that are no longer the curb: where it goes on along planting or the edge of a lot.

A curb is followed as long as there is a step. Beyond its last stone the edge of a raised lot or a
planting strip often rises as high and goes on straight; the ground about it is what differs from
pavement: soil, gravel and grass are rougher than what lies before and on the curb itself.
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

_LEAST_M = 2.0
"""What is shorter may be litter, a joint or a wheel."""


def own_part(edges: JointEdges, is_known: _Flags, span: tuple[int, int]) -> tuple[int, int]:
    """What of a line is left once its ends are cut where its surfaces aren't its own.

    A place is doubted where the top is much rougher than along the line, or the ground at the foot
    is while no point lies on the face. An end is cut where most of it is doubted. Of faces that
    look away the ground before them lies in their shadow: such lines are left as they are.

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
    is_faced = edges.face_points[at] > 0
    if not at.size or is_faced.mean() < FACED:
        return span
    doubted = _is_rough(edges.high_off[at], is_faced)
    doubted |= _is_rough(edges.low_off[at], is_faced) & ~is_faced
    before, behind = _doubted_end(doubted), _doubted_end(doubted[::-1])
    if before + behind >= at.size:
        return first, first
    return (
        int(at[before]) if before else first,
        int(at[-1 - behind]) + 1 if behind else stop,
    )


def _is_rough(off_m: _Floats, is_faced: _Flags) -> _Flags:
    """Where points lie farther off a surface than where the curb is seen best."""
    usual_m = max(float(np.median(off_m[is_faced])), _LEAST_ROUGH_M)
    return np.asarray(off_m > _ROUGHER * usual_m)


def _doubted_end(doubted: _Flags) -> int:
    """How many of the first places are to be cut: those up to where doubts outnumber the rest most.

    (The largest sum of a beginning; Bentley, Programming Pearls, CACM 27(9), 1984.)
    """
    balance = np.cumsum(np.where(doubted, 1, -1))
    best = int(np.argmax(balance))
    return best + 1 if balance[best] * STEP_M >= _LEAST_M else 0

"""Which covers lie over a channel: joints of lids are deep, for holes go through them.

Blocks of L-gutters and of paving are laid at the same spacings, but the grooves between them are
shallower than a lid is thick, and open anywhere across. Far away a beam comes in so flat that it
meets a hole's wall as near below the lid as a groove's floor: there it's the holes' places that
tell.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.gutters.gutter_holes import HoleFit
from processing.methods.road.gutters.gutter_joints import LID, JointRow
from processing.methods.road.rising import nearest_rising

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_DEPTHS_M = (0.015, 0.02, 0.025)
_OF_LIDS = (0.45, 0.30, 0.12, 0.13)
_OF_GROOVES = (0.60, 0.33, 0.05, 0.02)
"""Shares of notches between these depths: at joints of lids, also where soil fills most holes and
points are few; in grooves, which are some 12 mm deep at most, as noise makes them. Rounded from
simulated streets; the counts are not recorded."""

_JOINT_M = 0.04
"""A joint is no wider, and a notch no farther from its joint: the widest that is met
(`gutter_joints`)."""

_MOST = 2.5
_LEAST = -0.5
"""What one joint says at most for lids, so that a catch basin between blocks says little, and
against them, a fifth of it, so that filled holes say little either: logarithms. By trial."""

_CHANGE = 3.0
"""What it costs that lids end and blocks go on, as a logarithm: 20 to 1. By trial."""

_GAIN_OF_GROOVES, _BY_CHOICE = 0.9, 3.0
"""What each notch in grooves gained by holes' places at most (0.83 on 42 streets); what choosing
the best of all types and places gains."""


def are_deep(
    row: JointRow, along_m: _Floats, depth_m: _Floats, holes: HoleFit
) -> NDArray[np.bool_]:
    """Which covers of a row have joints about them that are as deep as those of lids.

    Parameters
    ----------
    row : JointRow
    along_m, depth_m : (n,) float64
        Places along the gutter and depths of the notches on it.
    holes : HoleFit
        What those at joints say by their places across.

    Returns
    -------
    (k,) bool
    """
    of_lids = row.what == LID
    # The bars of a grating are deep on any gutter: only joints between two lids are asked.
    after = of_lids[1:] & of_lids[:-1] & (row.starts_m[1:] - row.ends_m[:-1] < _JOINT_M)
    joints = (row.ends_m[:-1][after] + row.starts_m[1:][after]) / 2
    middles = (row.starts_m + row.ends_m) / 2
    if joints.size == 0:
        return np.ones(middles.size, np.bool_)
    by_positions = (holes.gain - _GAIN_OF_GROOVES) * min(holes.count, joints.size) - _BY_CHOICE
    is_lids = _part(_lid_odds_of(joints, along_m, depth_m) + max(by_positions, 0.0) / joints.size)
    found: NDArray[np.bool_] = is_lids[nearest_rising(joints, middles)]
    return found


def _part(odds: _Floats) -> NDArray[np.bool_]:
    """Which joints are of lids, so that what all of them say is the most (Viterbi)."""
    changed = np.zeros((odds.size, 2), np.int64)
    lids, blocks = odds[0], 0.0
    for one in range(1, odds.size):
        changed[one] = blocks - _CHANGE > lids, lids - _CHANGE > blocks
        lids, blocks = max(lids, blocks - _CHANGE) + odds[one], max(blocks, lids - _CHANGE)
    is_lids = np.zeros(odds.size, np.bool_)
    state = 0 if lids > blocks else 1
    for one in range(odds.size - 1, -1, -1):
        is_lids[one] = state == 0
        state = 1 - state if changed[one, state] else state
    return is_lids


def _lid_odds_of(joints: _Floats, along_m: _Floats, depth_m: _Floats) -> _Floats:
    """How much likelier each joint is that of lids than a groove, as logarithms."""
    nearest = nearest_rising(joints, along_m)
    near = np.abs(along_m - joints[nearest]) < _JOINT_M
    likelier = np.log(np.array(_OF_LIDS) / np.array(_OF_GROOVES))
    worth = likelier[np.searchsorted(_DEPTHS_M, depth_m[near])]
    summed = np.bincount(nearest[near], worth, minlength=joints.size)
    return np.clip(summed, _LEAST, _MOST)

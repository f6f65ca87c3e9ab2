"""Which covers lie over a channel: joints of lids are deep, for holes go through them.

Blocks of L-gutters and of paving are laid at the same spacings, but the grooves between them are
shallower than a lid is thick, and open anywhere across. Far away a beam comes in so flat that it
meets a hole's wall as near below the lid as a groove's floor: there it's the holes' places that
tell.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.gutters.gutter_holes import HoleFit
from processing.methods.road.gutters.gutter_joints import LID, JointRow
from processing.methods.road.rising import nearest_rising

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_DEPTHS_M = (0.015, 0.02, 0.025)
_OF_GROOVES = (0.60, 0.33, 0.05, 0.02)
"""Shares of notches in grooves between these depths: they are some 12 mm deep at most, and noise
and a worn edge add to it. By trial."""

_TELLING_M = 0.02
"""Where beams come in so flat that holes look no deeper than grooves, depth says nothing."""

_FILLED = 0.4
"""Share of notches at joints of lids that are no deeper than in grooves: soil in holes, and beams
that met the joint beside them. By trial."""

_LONG_M, _WIDE_M = 0.03, 0.10
"""Of the smallest holes, along and across a gutter (Takahashi 2022, Table 7-2)."""

_DEEP_SHARE = 0.1
"""Of notches at least that are deeper than all classes, however small the smallest hole: there are
larger ones. By trial."""

_LEAST_COSINE = 1e-3
"""Guard of a division."""

_JOINT_M = 0.04
"""A joint is no wider, and a notch no farther from its joint: the widest that is met
(`gutter_joints`)."""

_MOST = 2.5
_LEAST = -0.5
"""What one joint says at most for lids, so that a catch basin between blocks says little, and
against them, a fifth of it, so that filled holes say little either: logarithms. By trial."""

_CHANGE = 3.0
"""What it costs that lids end and blocks go on, as a logarithm: 20 to 1. By trial."""

_BY_CHOICE = 12.0
"""What choosing the best of all types and places of holes gains where there are none: at most 10 on
a pavement of slabs, whose joints lie at the same spacing; a logarithm."""

_WITHOUT_DEPTH = 1.0
"""Against lids where neither depths nor places tell: grooves between blocks are met oftener than
gutters. A logarithm, by trial."""


@dataclass(frozen=True)
class JointDepths:
    """Notches on a gutter: how deep they are, and how deep those of holes may be.

    Attributes
    ----------
    along_m, depth_m : (n,) float64
    possible_m : (n,) float64
        How deep a beam comes in the smallest hole before it meets the wall: the flatter it comes
        in, and the more along the gutter, the less.
    """

    along_m: _Floats
    depth_m: _Floats
    possible_m: _Floats

    @staticmethod
    def of(along_m: _Floats, depth_m: _Floats, square: _Floats, steepness: _Floats) -> JointDepths:
        """From the sines between rows and gutter, and how steeply beams came down."""
        cosine = np.sqrt(np.maximum(1.0 - square**2, 0.0))
        chord = np.minimum(
            _LONG_M / np.maximum(cosine, _LEAST_COSINE), _WIDE_M / np.maximum(square, _LEAST_COSINE)
        )
        return JointDepths(along_m, depth_m, chord * steepness)


def are_deep(row: JointRow, notches: JointDepths, holes: HoleFit) -> NDArray[np.bool_]:
    """Which covers of a row have joints about them that are as deep as those of lids.

    Parameters
    ----------
    row : JointRow
    notches : JointDepths
        On the gutter.
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
    by_positions = max(holes.over_groove - _BY_CHOICE, -_WITHOUT_DEPTH)
    is_lids = _part(_lid_odds_of(joints, notches) + by_positions / joints.size)
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


def _lid_odds_of(joints: _Floats, notches: JointDepths) -> _Floats:
    """How much likelier each joint is that of lids than a groove, as logarithms."""
    nearest = nearest_rising(joints, notches.along_m)
    near = np.abs(notches.along_m - joints[nearest]) < _JOINT_M
    depth, possible = notches.depth_m[near], notches.possible_m[near]
    # A beam goes in anywhere along a hole, so it comes to any depth up to the most alike often.
    ends = np.array([0.0, *_DEPTHS_M, np.inf])
    which = np.searchsorted(_DEPTHS_M, depth)
    low, high = ends[which], np.minimum(ends[which + 1], possible)
    in_holes = np.maximum(high - low, 0.0) / np.maximum(possible, _TELLING_M)
    in_grooves = np.array(_OF_GROOVES)[which]
    in_holes = np.where(possible < _TELLING_M, in_grooves, in_holes)
    # Deeper than any groove is a hole, if one of the larger ones.
    is_deepest = which == len(_DEPTHS_M)
    in_holes[is_deepest] = np.maximum(in_holes[is_deepest], _DEEP_SHARE)
    worth = np.log((_FILLED * in_grooves + (1.0 - _FILLED) * in_holes) / in_grooves)
    summed = np.bincount(nearest[near], worth, minlength=joints.size)
    return np.clip(summed, _LEAST, _MOST)

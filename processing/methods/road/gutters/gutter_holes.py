"""Where lids' holes are across a gutter, and what that says of the lids' width and middle."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

_Floats = NDArray[np.float64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_BIN_M = 0.01
"""Bins across the gutter: a spacing of points."""

_EXTENTS_M = (0.04, 0.08, 0.15, 0.25)
"""How wide openings are across the gutter: ends of classes, so that holes of 10 cm and of 18 to 19
cm (Takahashi 2022, Table 7-2) seen whole are of classes of their own, and joints of the first."""

_USUAL_M = (0.02, 0.06, 0.11, 0.18)
"""Width that stands for each class."""

_WIDER_M = 0.03
"""Openings are told apart by their width so far, for the last points on either side lie anywhere
within a spacing of the rims."""

_JOINED = 0.3
"""How likely an opening wider than a hole is, against one that fits: a row that runs along an open
joint sees it and the holes as one. By trial."""

_GROOVES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Shares of narrow openings that are the joint's beside the holes, of which the best is taken."""

_STONES_M = (0.05, 0.12, 0.18, 0.25)
"""How wide the joints of curb stones look: their tops are 15 to 20 cm wide (JIS A 5371), less where
they are rounded or where a beam meets only the edge, more with the gutter block below."""

_SPREAD_M = 0.02
"""Standard deviation of a notch's place across: a spacing of points and the axis' error. By
trial."""

_CHANCE = 0.15
"""Share of notches that lie anywhere. By trial."""

_REACH_M = 0.45
"""To either side of the axis: half of the widest lid of 66 cm and its offset."""

_MOST_OFFSET_M = 0.2
"""The middle of lids is looked for so far to either side of the axis: within half a lid. By
trial."""

_LEAST_SUM = 1e-9
"""Guard of a division."""

EDGES_M: _Floats = np.arange(-_REACH_M, _REACH_M + _BIN_M, _BIN_M)
"""Edges of the bins across a gutter, m from its axis."""

OFFSETS_M: _Floats = np.arange(-_MOST_OFFSET_M, _MOST_OFFSET_M + _BIN_M / 100, _BIN_M)
"""Where the middle of the lids is looked for, m from the axis."""


@dataclass(frozen=True)
class LidType:
    """A standard lid (Takahashi 2022, Table 7-2): m.

    Attributes
    ----------
    holes : int
        In a row across the gutter; two lie at the quarter points.
    """

    holes: int
    width_m: float
    hole_wide_m: float
    share: float

    def off(self, across: _Floats) -> _Floats:
        """How far places across a lid are from the middle of the nearer hole, m."""
        if self.holes == 1:
            return across
        quarter = self.width_m / 4
        off: _Floats = np.where(across > 0, across - quarter, across + quarter)
        return off


LID_TYPES = (
    LidType(2, 0.38, 0.10, 0.665),
    LidType(2, 0.44, 0.105, 0.156),
    LidType(2, 0.53, 0.19, 0.098),
    LidType(2, 0.66, 0.185, 0.045),
    LidType(1, 0.40, 0.18, 0.032),
    LidType(1, 0.40, 0.10, 0.002),
)
"""Types of Table 7-2 that differ in what a row across them shows, with their shares of the 3,801
lids counted there; those that differ in the length of the hole alone, or by a centimetre, are
one."""


@dataclass(frozen=True)
class JointNotches:
    """Notches at the joints of one gutter, and between them.

    Attributes
    ----------
    across_m : (n,) float64
        m to the right of the axis.
    extent_m : (n,) float64
        How wide the opening is across the gutter.
    worth : (n,) float64
        1 for one at a joint; for those between joints how many at joints are expected for each if
        they lie there by chance, negative.
    """

    across_m: _Floats
    extent_m: _Floats
    worth: _Floats


@dataclass(frozen=True)
class HoleFit:
    """What the notches at joints say of the lids.

    Attributes
    ----------
    type : LidType
    middle_m : float
        Of the lids across the axis.
    gain : float
        Mean logarithm of the likelihood against chance, per notch.
    count : int
        Notches that it rests on.
    over_groove : float
        How much likelier the notches are with holes than in a groove that is open alike all
        across lids or across curb stones, as they lie: a logarithm.
    """

    type: LidType
    middle_m: float
    gain: float
    count: int
    over_groove: float


def hole_fit(notches: JointNotches) -> HoleFit:
    """The standard lid whose holes and joints fit the notches best.

    A joint is a groove as wide as the lids, with the holes in it: narrow openings lie in either,
    wide ones in holes alone, and the wider the nearer to a hole's middle.
    """
    likelihood = _fits()
    counts = counts_across(notches, np.zeros(notches.worth.size, np.int64), 1)[0]
    of_shares = np.tensordot(likelihood, counts, axes=2)
    gains = of_shares[:, :, :-1].max(axis=2) + np.log([[one.share] for one in LID_TYPES])
    in_groove = max(of_shares[:, :, -1].max(), np.tensordot(_of_stones(), counts, axes=2).max())
    over_groove = float(gains.max() - in_groove)
    gains /= max(1.0, float(counts.sum()))
    which, at = divmod(int(gains.argmax()), OFFSETS_M.size)
    gain = float(gains[which, at])
    return HoleFit(
        LID_TYPES[which],
        float(OFFSETS_M[at]),
        gain,
        max(0, round(float(counts.sum()))),
        over_groove,
    )


def counts_across(notches: JointNotches, at: NDArray[np.int64], count: int) -> _Floats:
    """(count, classes, bins) what notches are worth, by how wide their openings are and where.

    Parameters
    ----------
    notches : JointNotches
    at : (n,) int64
        The station along the gutter that each counts at.
    count : int
        Of stations.
    """
    bins, classes = EDGES_M.size - 1, len(_USUAL_M)
    kinds = np.searchsorted(_EXTENTS_M, notches.extent_m)
    bin_of = np.searchsorted(EDGES_M, notches.across_m) - 1
    is_in = (kinds < classes) & (bin_of >= 0) & (bin_of < bins)
    keys = ((at * classes + kinds) * bins + bin_of)[is_in]
    counts = np.bincount(keys, notches.worth[is_in], minlength=count * classes * bins)
    return np.asarray(counts.reshape(count, classes, bins), np.float64)


def hole_likelihoods() -> _Floats:
    """(types, offsets, grooves, classes, bins) how much likelier than by chance notches are.

    As logarithms; of lids whose joints are not open all along alike.
    """
    return _fits()[:, :, :-1]


@cache
def _fits() -> _Floats:
    """As `hole_likelihoods`; the last of the grooves is open alike all across the lids.

    A hole may be seen narrower than it is, for few rows cross all of it: 3 cm along let a row stay
    in it for 11 cm across at 75°.
    """
    middles = (EDGES_M[1:] + EDGES_M[:-1]) / 2
    shape = (len(LID_TYPES), OFFSETS_M.size, len(_GROOVES), len(_USUAL_M), middles.size)
    mix = np.zeros(shape)
    shares = np.array(_GROOVES)[:, None]
    for number, one in enumerate(LID_TYPES):
        for at, position in enumerate(OFFSETS_M):
            for kind, usual in enumerate(_USUAL_M):
                joint = _box(middles - position, max(one.width_m - usual, _BIN_M) / 2)
                holes = _JOINED * joint
                if usual <= one.hole_wide_m + _WIDER_M:
                    holes = _holes(one, middles - position, kind)
                mix[number, at, :, kind] = (1 - shares) * holes + shares * joint
    mix = (1 - _CHANCE) * mix + _CHANCE / (2 * _REACH_M)
    return np.asarray(np.log(mix * 2 * _REACH_M), np.float64)


@cache
def _of_stones() -> _Floats:
    """(widths, k, classes, bins) as of :func:`_fits` for joints of curb stones at its places."""
    middles = (EDGES_M[1:] + EDGES_M[:-1]) / 2
    density = [
        [
            [_box(middles - at, max(wide - usual, _BIN_M) / 2) for usual in _USUAL_M]
            for at in OFFSETS_M
        ]
        for wide in _STONES_M
    ]
    mix = (1 - _CHANCE) * np.array(density) + _CHANCE / (2 * _REACH_M)
    return np.asarray(np.log(mix * 2 * _REACH_M), np.float64)


def _holes(one: LidType, across: _Floats, kind: int) -> _Floats:
    """Density of the middles of openings of a class across a lid."""
    quarter = one.width_m / 4 if one.holes == 2 else 0.0
    half = max(one.hole_wide_m - _USUAL_M[kind], _BIN_M) / 2
    return _box(np.abs(across) - quarter, half)


def _box(across: _Floats, half_m: float) -> _Floats:
    is_in = np.abs(across) <= half_m + _BIN_M / 4
    spread: _Floats = gaussian_filter1d(is_in.astype(np.float64), _SPREAD_M / _BIN_M)
    density: _Floats = spread / max(float(spread.sum()) * _BIN_M, _LEAST_SUM)
    return density

"""Where lids' holes are across a gutter, and what that says of the lids' width and middle."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

_Floats = NDArray[np.float64]

_BIN_M = 0.01
_SPREAD_M = 0.02
_CHANCE = 0.15  # share of notches that lie anywhere
_REACH_M = 0.45
_EDGES_M = np.arange(-_REACH_M, _REACH_M + _BIN_M, _BIN_M)


@dataclass(frozen=True)
class LidType:
    """A standard lid (mms.md, Table 7-2): m.

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
    """

    type: LidType
    middle_m: float
    gain: float
    count: int


def hole_fit(across_m: _Floats) -> HoleFit:
    """The standard lid whose holes fit the notches at joints best.

    Parameters
    ----------
    across_m : (n,) float64
        m to the right of the axis, n ≥ 1.
    """
    places, likelihood = _fits()
    counts = np.histogram(across_m, _EDGES_M)[0].astype(np.float64)
    gains = (counts * likelihood).sum(axis=2) + np.log([[one.share] for one in LID_TYPES])
    gains /= max(1.0, float(counts.sum()))
    which, at = divmod(int(gains.argmax()), places.size)
    gain = float(gains[which, at])
    return HoleFit(LID_TYPES[which], float(places[at]), gain, int(counts.sum()))


@cache
def _fits() -> tuple[_Floats, _Floats]:
    """Places of a lid's middle (k,), and how much likelier than by chance notches are (t, k, bins).

    The latter for each type and place, as logarithms.
    """
    places: _Floats = np.arange(-0.2, 0.2001, _BIN_M)
    middles = (_EDGES_M[1:] + _EDGES_M[:-1]) / 2
    density = np.array([[_density(one, middles - at) for at in places] for one in LID_TYPES])
    mix = (1 - _CHANCE) * density + _CHANCE / (2 * _REACH_M)
    return places, np.log(mix * 2 * _REACH_M)


def _density(one: LidType, across: _Floats) -> _Floats:
    quarter = one.width_m / 4 if one.holes == 2 else 0.0
    is_in = np.abs(np.abs(across) - quarter) <= one.hole_wide_m / 2
    spread: _Floats = gaussian_filter1d(is_in.astype(np.float64), _SPREAD_M / _BIN_M)
    return spread / max(float(spread.sum()) * _BIN_M, 1e-9)

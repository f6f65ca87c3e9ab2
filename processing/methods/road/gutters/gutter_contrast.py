"""Whether a gutter is open at its joints and nowhere else: what tells lids from rough asphalt.

In asphalt that is coarse or worn beams meet dents all over, so some of them lie at any spacing. The
holes and joints of lids leave the rest of each lid, and the road beside, as closed as concrete is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.gutters.gutter_joints import LID
from processing.methods.road.gutters.gutter_runs import GutterRun
from processing.methods.road.gutters.notches.notches import Notches

_Floats = NDArray[np.float64]
_Bools = NDArray[np.bool_]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_JOINT_M = 0.03
"""To either side of a joint its holes lie: half of the longest of 5 cm (Takahashi 2022, Table 7-2),
rounded up."""

_RIM_M = 0.03
"""Left out of the lids: the groove beside them is open all along (as in `gutter_lids`)."""

_BESIDE_FROM_M, _BESIDE_TO_M = 0.05, 0.40
"""From the lids' edges: where the road beside begins and ends. By trial."""

_LEVEL_M = 0.15
"""Notches farther above or below the axis are of something else: a curb's height. By trial."""

_LEAST_STRENGTH = 0.1
"""As in `gratings`."""

_ABOUT = 5
"""Covers to either side that are asked too: of 6 m, as one lid is crossed by few rows. By trial."""

_CLOSED = 0.005
"""Share of a closed surface that is open by noise. By trial."""

_BOX_M = 1.0
"""How far around the box of an axis notches are asked: more than the reach to either side."""

_LEAST_AREA_M2 = 1e-9
"""Guard of a division."""


@dataclass(frozen=True)
class Contrast:
    """How much more of a gutter is open at its joints than elsewhere, about each cover.

    Attributes
    ----------
    lids : (k,) float64
        Than on its lids: as a logarithm, 0 where they are open all over.
    beside : (k,) float64
        Than beside it.
    raised_m : float
        How far the gutter lies above the road, beyond what roads and walks rise to their sides.
    """

    lids: _Floats
    beside: _Floats
    raised_m: float


def contrast_of(run: GutterRun, notches: Sequence[Notches]) -> Contrast:
    """How a gutter stands out from what is around it.

    Parameters
    ----------
    run : GutterRun
    notches : sequence of Notches
        Of each drive.
    """
    row, half = run.row, run.edges[1]
    long = row.ends_m - row.starts_m
    (along, across, area), raised_m = _notches_about(run, notches)
    which = np.clip(np.searchsorted(row.starts_m, along, side="right") - 1, 0, long.size - 1)
    to_joint = np.minimum(np.abs(along - row.starts_m[which]), np.abs(along - row.ends_m[which]))
    is_on = (along > row.starts_m[which] - _JOINT_M) & (along < row.ends_m[which] + _JOINT_M)
    is_lid = row.what == LID
    inner = half - _RIM_M
    is_within, is_at = np.abs(across) <= inner, to_joint <= _JOINT_M
    positions = (
        (is_on & is_within & is_at, np.full(long.size, 2 * _JOINT_M * 2 * inner)),
        (
            is_on & is_within & ~is_at & is_lid[which],
            np.where(is_lid, (long - 2 * _JOINT_M) * 2 * inner, 0.0),
        ),
        (
            is_on & (np.abs(across) >= half + _BESIDE_FROM_M),
            long * 2 * (_BESIDE_TO_M - _BESIDE_FROM_M),
        ),
    )
    shares = [_share(which[chosen], area[chosen], of_m2) for chosen, of_m2 in positions]
    joints, lids, beside = (np.log(one + _CLOSED) for one in shares)
    return Contrast(joints - lids, joints - beside, raised_m)


def _notches_about(run: GutterRun, notches: Sequence[Notches]) -> tuple[_Floats, float]:
    """Along, across and area of notches on a gutter and beside it; how far it is raised."""
    reach = run.edges[1] + _BESIDE_TO_M
    low, high = run.axis.xyz.min(axis=0) - _BOX_M, run.axis.xyz.max(axis=0) + _BOX_M
    parts, heights = [], [np.empty(0)]
    for own in notches:
        is_near = (own.strength >= _LEAST_STRENGTH) & ((own.xyz >= low) & (own.xyz <= high)).all(1)
        along, across, above = run.axis.coordinates_of(own.xyz[is_near], reach)
        is_on = np.isfinite(along) & (np.abs(above) < _LEVEL_M)
        parts.append(np.array([along[is_on], across[is_on], own.area_m2[is_near][is_on]]))
        is_within = is_near.copy()
        is_within[is_near] = is_on & (np.abs(across) <= run.edges[1])
        heights.append(own.higher_m(is_within))
    above = np.concatenate(heights)
    return np.hstack([np.empty((3, 0)), *parts]), float(np.median(above)) if above.size else 0.0


def _share(which: NDArray[np.int64], area: _Floats, of_m2: _Floats) -> _Floats:
    """(k,) share that is open of so much surface at each cover and those about it."""
    window = np.ones(2 * _ABOUT + 1)
    sums = [
        np.convolve(one, window, mode="full")[_ABOUT : _ABOUT + of_m2.size]
        for one in (np.bincount(which, area, minlength=of_m2.size), of_m2)
    ]
    # Where there is no lid to be asked, nothing is known: as open as can be.
    share: _Floats = np.where(sums[1] > 0, sums[0] / np.maximum(sums[1], _LEAST_AREA_M2), 1.0)
    return np.minimum(share, 1.0)

"""What sort of barrier stands along a strip, told from its layers, and how far apart its posts are.

Measures are those of 防護柵の設置基準 (2021) and of makers' tables: a beam of 0.35 m below 0.8 m;
pipes 0.2 m and more apart, the lowest 0.3 m above the ground; ropes a hand's breadth apart.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats
from processing.methods.road.barriers.barrier_confidence import group_of
from processing.methods.road.barriers.barrier_facts import WindowFacts
from processing.methods.road.barriers.strip_profiles import COLUMN_M, LAYER_M, LAYERS, StripProfile

BarrierType = Literal[
    "guard_rail", "guard_pipe", "guard_cable", "fence", "parapet", "noise_barrier"
]

_FULL = 0.5
"""Share of the fullest layer's columns, from which a layer is one of rails."""

_BEAM_M, _DEEP_M = 0.25, 0.03
"""A beam is at least so high, and its waves at least so deep; ropes and pipes lie in one plane."""

_LOWEST_PIPE_M, _HIGHEST_PIPE_M = 0.335, 1.15
"""The lowest pipe of a guard pipe lies lower than that of a fence, its highest not higher."""

_ROPES_M = 0.17
"""From rope to rope at most."""

_PARAPET_M, _NOISE_M = 1.3, 1.8
"""Concrete barriers are at most so high, noise walls at least."""

_DENSE = 0.8
"""How full the foot of a sheet is."""

_LOWEST = 5
"""The first layer that may be one of a rail, 0.25 m above the ground."""

_MOST_LIFT, _LIFT_COLUMNS = 4, 2
"""Layers by which the foot may be wrong, and columns to both sides that tell it with one."""

_POST_SHARE, _BETWEEN = 0.5, 0.4
"""Of the layers between rails, those fuller than this aside, how many a post fills."""

_FEWEST_GAPS, _ALIKE = 2, 0.25
"""Gaps between posts from which their spacing is told, and how much they may differ."""


class BarrierLayers(NamedTuple):
    """The layers of a stretch.

    Attributes
    ----------
    share : (96,) float64
        Of the columns that each fills, over the fullest.
    middles : (96,) float64
        How far aside the points of each lie, m; NaN where there are none.
    top : int
    """

    share: Floats
    middles: Floats
    top: int


def layers_of(profile: StripProfile, columns: Flags, facts: WindowFacts) -> BarrierLayers:
    """The layers of some columns of a strip, each moved so that its top lies as high as others'.

    The foot is known to some centimetres only, and rails would be smeared over each other.
    """
    chosen = np.flatnonzero(columns)
    top = round(facts.top / LAYER_M) - 1
    lifts = _lifts_of(np.asarray(profile.counts[chosen] > 0), top)
    counts = np.zeros((len(chosen), LAYERS))
    aside = np.zeros(LAYERS)
    for number, column in enumerate(chosen.tolist()):
        counts[number] = np.roll(profile.counts[column], lifts[number])
        aside += np.roll(profile.aside[column], lifts[number])
    share = (counts > 0).mean(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        middles = aside / counts.sum(axis=0)
    return BarrierLayers(share / max(float(share[_LOWEST : top + 1].max()), 1e-9), middles, top)


def _lifts_of(filled: NDArray[np.bool_], top: int) -> NDArray[np.int64]:
    """How many layers each column is to be lifted for its top to lie at the stretch's."""
    reach = slice(max(_LOWEST, top - _MOST_LIFT), min(top + _MOST_LIFT + 1, LAYERS))
    part = filled[:, reach]
    has = np.asarray(part.any(axis=1))
    highest = np.asarray(part.shape[1] - 1 - np.argmax(part[:, ::-1], axis=1) + reach.start)
    lifts = np.zeros(len(filled), np.int64)
    for column in range(len(filled)):
        near = slice(max(0, column - _LIFT_COLUMNS), column + _LIFT_COLUMNS + 1)
        if has[near].any():
            lifts[column] = top - round(float(np.median(highest[near][has[near]])))
    return lifts


def type_of(layers: BarrierLayers, facts: WindowFacts) -> BarrierType:
    """What sort of barrier it is."""
    group = group_of(facts)
    if group == "screens":
        return "noise_barrier" if facts.top > _NOISE_M else "fence"
    if group != "rails" and facts.low >= _DENSE and facts.top <= _PARAPET_M:
        return "parapet" if group == "leaning" else "fence"
    rails = rails_of(layers)
    if not rails or facts.top > _HIGHEST_PIPE_M:
        return "fence"
    highest = max(last - first + 1 for first, last in rails) * LAYER_M
    if highest >= _BEAM_M and facts.low < _FULL:
        return "guard_rail" if _depth(layers, rails) >= _DEEP_M else "guard_cable"
    middles = [(first + last + 1) / 2 * LAYER_M for first, last in rails]
    if len(middles) < 2:
        return "fence"
    if len(middles) > 2 and float(np.median(np.diff(middles))) <= _ROPES_M:
        return "guard_cable"
    return "guard_pipe" if middles[0] <= _LOWEST_PIPE_M else "fence"


def rails_of(layers: BarrierLayers) -> list[tuple[int, int]]:
    """First and last layer of each rail, from the lowest."""
    is_full = layers.share[: layers.top + 1] >= _FULL
    is_full[:_LOWEST] = False
    at = np.flatnonzero(np.diff(np.r_[False, is_full, False].astype(np.int8)))
    return [(int(a), int(b) - 1) for a, b in zip(at[::2], at[1::2], strict=True)]


def _depth(layers: BarrierLayers, rails: list[tuple[int, int]]) -> float:
    """How far the layers of the highest rail lie in front of each other, m."""
    first, last = max(rails, key=lambda one: one[1] - one[0])
    middles = layers.middles[first : last + 1]
    return float(np.ptp(np.nan_to_num(middles, nan=float(np.nanmean(middles)))))


def posts_of(profile: StripProfile, columns: Flags, layers: BarrierLayers) -> float | None:
    """How far apart posts stand, m; None where they can't be told from what they carry."""
    between = np.flatnonzero(layers.share[3 : layers.top + 1] < _BETWEEN) + 3
    if between.size < 2:
        return None
    filled = (profile.counts[:, between] > 0).mean(axis=1) * columns
    is_post = filled >= _POST_SHARE
    starts = np.flatnonzero(np.diff(np.r_[False, is_post, False].astype(np.int8)))
    middles = (starts[::2] + starts[1::2] - 1) / 2 * COLUMN_M
    gaps = np.diff(middles)
    gaps = gaps[gaps > 2 * COLUMN_M]
    if gaps.size < _FEWEST_GAPS:
        return None
    usual = float(np.median(gaps))
    alike = np.abs(gaps - usual) <= _ALIKE * usual
    return float(gaps[alike].mean()) if alike.mean() > 0.5 else None

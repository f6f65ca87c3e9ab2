"""Loops of the search for gutters: regular spacing about every place, the best row of joints."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_OPEN_COST = 0.25
"""What each open place costs on a lid, against what it is worth for a grating: weeds and dirt make
a lid's surface seem open too. By trial; no measurement is recorded."""


class Notched(NamedTuple):
    """Notches: (n,) along, m, rising; (n,) cells across; (n,) values."""

    along: _Floats
    cells: _Integers
    values: _Floats


class Nearness(NamedTuple):
    """What counts as near: so far along, m, and so many cells across."""

    along_m: float
    cells: int


class Votes(NamedTuple):
    """Weights of notches: (n,) of each, and (n,) of all that lie side by side with it."""

    worth: _Floats
    abreast: _Floats


class Windows(NamedTuple):
    """Distance between the middles of windows and half their length, m; the first is at 0."""

    step_m: float
    half_m: float


class GapCost(NamedTuple):
    """Least and most length of a stretch that is no cover, in places, and its cost."""

    least: int
    most: int
    cost: float


class OpenPlaces(NamedTuple):
    """Where a gutter is open all over.

    Attributes
    ----------
    summed : (n + 1,) float64
        Evidence of gratings, summed along the line.
    is_grating : (k,) int64
        Which of the steps between joints are gratings.
    worth : float
        What a place of a grating must be worth to pay for it.
    """

    summed: _Floats
    is_grating: _Integers
    worth: float


class BestRows(NamedTuple):
    """The best row of joints that ends at each place.

    Attributes
    ----------
    value : (n,) float64
    before : (n,) int64
        Where its last joint before is; −1: none.
    taken : (n,) int64
        The step from there; −1: a gap.
    """

    value: _Floats
    before: _Integers
    taken: _Integers


@kernel
def near_kernel(positions: Notched, near: Nearness, summed: _Floats) -> None:
    """Sum of the values about each place, its own with them.

    Parameters
    ----------
    positions : Notched
    near : Nearness
    summed : (n,) float64
        Result.
    """
    along, cells, values = positions
    along_m, across = near
    first = 0
    for i in range(along.shape[0]):
        while along[first] < along[i] - along_m:
            first += 1
        total = 0.0
        for j in range(first, along.shape[0]):
            if along[j] > along[i] + along_m:
                break
            if abs(cells[j] - cells[i]) <= across:
                total += values[j]
        summed[i] = total


@kernel
def waves_kernel(
    along: _Floats,
    cells: _Integers,
    votes: Votes,
    scales: _Floats,
    pitches: _Floats,
    window: Windows,
    waves: NDArray[np.complex128],
    weights: _Floats,
) -> None:
    """Sum of the unit vectors whose angles are the notches' phases at some spacing.

    Parameters
    ----------
    along : (n,) float64
        Stations of the notches, m, rising.
    cells : (n,) int64
        Number of each across the road; −1: left out.
    votes : Votes
    scales : (w, c) float64
        How much longer than the station a metre is in that cell, at bends.
    pitches : (p,) float64
        Spacings to try, m.
    window : Windows
    waves : (w, c, p) complex128
        Result, zeros before.
    weights : (w, c) float64
        Result: sum of the joints' squared weights, which is what chance makes of the squared
        waves; zeros before.
    """
    step, half = window.step_m, window.half_m
    worth, abreast = votes
    for i in range(along.shape[0]):
        c = cells[i]
        if c < 0:
            continue
        first = max(0, math.ceil((along[i] - half) / step))
        last = min(waves.shape[0] - 1, math.floor((along[i] + half) / step))
        for w in range(first, last + 1):
            away = (along[i] - w * step) * scales[w, c]
            weights[w, c] += worth[i] * abreast[i]
            for p in range(pitches.shape[0]):
                turn = 2 * math.pi * away / pitches[p]
                waves[w, c, p] += worth[i] * complex(math.cos(turn), math.sin(turn))


@kernel
def joints_kernel(
    evidence: _Floats,
    steps: _Integers,
    costs: _Floats,
    gap: GapCost,
    inside: OpenPlaces,
    best: BestRows,
) -> None:
    """The dearest row of joints up to each place of an evenly divided line.

    Parameters
    ----------
    evidence : (n,) float64
        What a joint at each place is worth.
    steps, costs : (k,)
        Lengths of covers with their joint, in places, and what each costs.
    gap : GapCost
    inside : OpenPlaces
    best : BestRows
        Filled.
    """
    summed, is_grating, worth = inside
    value, before, taken = best
    lead, lead_at = -math.inf, -1
    for i in range(evidence.shape[0]):
        value[i], before[i], taken[i] = evidence[i], -1, -1
        for k in range(steps.shape[0]):
            j = i - steps[k]
            if j < 0:
                continue
            full = summed[i] - summed[j]
            gain = full - worth * steps[k] if is_grating[k] else -_OPEN_COST * full
            total = value[j] + evidence[i] - costs[k] + gain
            if total > value[i]:
                value[i], before[i], taken[i] = total, j, k
        enters = i - gap.least
        if enters >= 0 and (lead_at < i - gap.most or value[enters] > lead):
            lead, lead_at = -math.inf, -1
            for j in range(max(0, i - gap.most), enters + 1):
                if value[j] >= lead:
                    lead, lead_at = value[j], j
        if lead_at >= 0:
            total = lead + evidence[i] - gap.cost
            if total > value[i]:
                value[i], before[i], taken[i] = total, lead_at, -1


def warm_up() -> None:
    """Compile the kernels."""
    zeros = np.zeros(2)
    near_kernel(Notched(zeros, np.zeros(2, np.int64), zeros), Nearness(0.3, 2), np.empty(2))
    waves_kernel(
        zeros,
        np.zeros(2, np.int64),
        Votes(zeros, zeros),
        np.ones((1, 1)),
        np.ones(1),
        Windows(1.0, 3.0),
        np.zeros((1, 1, 1), np.complex128),
        np.zeros((1, 1)),
    )
    joints_kernel(
        zeros,
        np.ones(1, np.int64),
        np.zeros(1),
        GapCost(1, 2, 1.0),
        OpenPlaces(np.zeros(3), np.zeros(1, np.int64), 1.0),
        BestRows(np.zeros(2), np.zeros(2, np.int64), np.zeros(2, np.int64)),
    )

"""Loops of the search for gutters: regular spacing about every place, the best row of joints."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]


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
    of_lids : float
        What an open place costs on a lid, against what it is worth for a grating.
    """

    summed: _Floats
    is_grating: _Integers
    worth: float
    of_lids: float


class Steps(NamedTuple):
    """Steps from joint to joint.

    Attributes
    ----------
    places : (k,) int64
        Lengths of covers with their joint.
    costs : (m, k) float64
        What each costs a row in each mix of lids.
    change : float
        What it costs that lids of another mix follow.
    """

    places: _Integers
    costs: _Floats
    change: float


class BestRows(NamedTuple):
    """The best row of joints that ends at each place in each mix of lids, mix by mix.

    Attributes
    ----------
    value : (m, n) float64
    before : (m, n) int64
        Where its last joint before is, as a place of all mixes; −1: none.
    taken : (m, n) int64
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
    evidence: _Floats, steps: Steps, gap: GapCost, inside: OpenPlaces, best: BestRows
) -> None:
    """The dearest row of joints up to each place of an evenly divided line.

    Parameters
    ----------
    evidence : (n,) float64
        What a joint at each place is worth.
    steps : Steps
    gap : GapCost
    inside : OpenPlaces
    best : BestRows
        Filled.
    """
    mixes, count = best.value.shape
    lead, lead_at = np.full(mixes, -math.inf), np.full(mixes, -1, np.int64)
    for i in range(count):
        top = 0
        for mix in range(mixes):
            _best_at_kernel(evidence[i], (mix, i), steps, inside, best)
            _gap_kernel(evidence[i], (mix, i), gap, (lead, lead_at), best)
            if best.value[mix, i] > best.value[top, i]:
                top = mix
        for mix in range(mixes):
            if best.value[top, i] - steps.change > best.value[mix, i]:
                best.value[mix, i] = best.value[top, i] - steps.change
                best.before[mix, i] = best.before[top, i]
                best.taken[mix, i] = best.taken[top, i]


@kernel
def _best_at_kernel(
    evidence: float, at: tuple[int, int], steps: Steps, inside: OpenPlaces, best: BestRows
) -> None:
    """The dearest row that ends at a place with a cover of a mix."""
    mix, i = at
    value, count = best.value[mix], best.value.shape[1]
    summed, is_grating, worth, of_lids = inside
    most, before, taken = evidence, -1, -1
    for k in range(steps.places.shape[0]):
        j = i - steps.places[k]
        if j < 0:
            continue
        full = summed[i] - summed[j]
        gain = full - worth * steps.places[k] if is_grating[k] else -of_lids * full
        total = value[j] + evidence - steps.costs[mix, k] + gain
        if total > most:
            most, before, taken = total, mix * count + j, k
    value[i], best.before[mix, i], best.taken[mix, i] = most, before, taken


@kernel
def _gap_kernel(
    evidence: float,
    at: tuple[int, int],
    gap: GapCost,
    leads: tuple[_Floats, _Integers],
    best: BestRows,
) -> None:
    """The dearest row that goes on at a place behind a stretch without covers, if dearer."""
    mix, i = at
    value, (lead, lead_at) = best.value[mix], leads
    enters = i - gap.least
    if enters >= 0 and (lead_at[mix] < i - gap.most or value[enters] > lead[mix]):
        lead[mix], lead_at[mix] = -math.inf, -1
        for j in range(max(0, i - gap.most), enters + 1):
            if value[j] >= lead[mix]:
                lead[mix], lead_at[mix] = value[j], j
    if lead_at[mix] >= 0 and lead[mix] + evidence - gap.cost > value[i]:
        value[i] = lead[mix] + evidence - gap.cost
        best.before[mix, i] = mix * best.value.shape[1] + lead_at[mix]
        best.taken[mix, i] = -1


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
        Steps(np.ones(1, np.int64), np.zeros((1, 1)), 1.0),
        GapCost(1, 2, 1.0),
        OpenPlaces(np.zeros(3), np.zeros(1, np.int64), 1.0, 0.25),
        BestRows(np.zeros((1, 2)), np.zeros((1, 2), np.int64), np.zeros((1, 2), np.int64)),
    )

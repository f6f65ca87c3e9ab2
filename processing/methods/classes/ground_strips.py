"""How far the ground goes on in one tone: a road is a long strip, a field is a patch.

How bright asphalt, soil or grass is differs from flight to flight; that a road is of one tone along
its length and of another beside it does not.

1. The brightness of ground returns is laid out in plan and freed of single odd values.
2. From each place the ground is followed in directions all around until its tone changes. The
   shortest way through is the width of what it lies in, the longest its length; beyond the ends of
   the shortest lies what it is told from.
3. Where in the order of the flight's own ground a tone stands says whether it is among its darkest.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.noise.neighbours.sharing import share_out

STRIP_COLUMNS = 12
"""Tone and its rank, then for each of two tolerances what :func:`_strips_kernel` tells."""

RANKS = 41
"""Steps of the order of a flight's tones."""

_SIDE = 1.5
"""Of a place in plan, in distances between points: two or so lie in each."""

_STEPS = 32
"""Places that are walked through each way: with those above, as far as parts have surroundings."""

_TOLERANCES = (0.25, 0.5)
"""Doublings of brightness within which a tone is the same: 1.2 and 1.4 times."""

_DIRECTIONS = 16
_GAP = 6
"""Places without ground that are passed over: crowns over a road, vehicles on it."""

_ODD = 1
"""Places of another tone in a row that do not end a strip: paint, or the edge of a beam."""

_PLACES_AT_ONCE = 4_096
_TOLD = 5


def strip_columns(
    xy: Floats,
    tones: NDArray[np.float32],
    is_told: NDArray[np.bool_],
    ranks: Floats,
    *,
    cell_m: float,
    monitor: Monitor,
) -> NDArray[np.float32]:
    """What the ground's tones around each point look like in plan.

    Parameters
    ----------
    xy : (n, 2) float64
        m about an origin near by, none below 0.
    tones : (n,) float32
        log2 of brightness over that of the flight's ground.
    is_told : (n,) bool
        Whether a point tells the ground's tone: returns on the ground that are their pulse's only.
    ranks : (:data:`RANKS`,) float64
        Tones of the flight's ground, rising, in even steps of their order.
    cell_m : float
        How far apart points lie.

    Returns
    -------
    (n, :data:`STRIP_COLUMNS`) float32
        Lengths in m; 0 where no ground is near.
    """
    side = _SIDE * cell_m
    place = (xy / side).astype(np.int64)
    shape = tuple((place.max(axis=0) + 1).tolist())
    flat = place[:, 0] * shape[1] + place[:, 1]
    used, where = np.unique(flat, return_inverse=True)
    means = _mean_tones(where, tones, is_told)
    smooth = _smoothed_plan(shape, used, means)
    found = np.zeros((used.size, STRIP_COLUMNS), np.float32)
    own = smooth.reshape(-1)[used]
    known = np.isfinite(own)
    found[known, 0] = own[known]
    found[known, 1] = np.interp(own[known], ranks, np.linspace(0.0, 1.0, RANKS))
    places = used[known]
    for number, tolerance in enumerate(_TOLERANCES):
        part = np.zeros((places.size, _TOLD), np.float32)

        def look(
            start: int,
            stop: int,
            part: NDArray[np.float32] = part,
            tolerance: float = tolerance,
        ) -> None:
            _strips_kernel(smooth, places[start:stop], tolerance, part[start:stop])

        share_out(look, places.size, _PLACES_AT_ONCE, monitor)
        part[:, :3] *= side
        first = 2 + number * _TOLD
        found[known, first : first + _TOLD] = part
    return np.asarray(found[where], np.float32)


def _mean_tones(
    where: Integers, tones: NDArray[np.float32], is_told: NDArray[np.bool_]
) -> NDArray[np.float32]:
    """Mean tone of the points that tell one, for each place from 0 up; NaN where none does."""
    places = int(where.max()) + 1
    count = np.bincount(where[is_told], minlength=places)
    total = np.bincount(where[is_told], tones[is_told], minlength=places)
    means = np.where(count > 0, total / np.maximum(count, 1), np.nan)
    return np.asarray(means, np.float32)


def _smoothed_plan(
    shape: tuple[int, int], used: Integers, means: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Tones in plan, freed of single odd values; NaN where no place is used."""
    plan = np.full(shape, np.nan, np.float32)
    plan.reshape(-1)[used] = means
    smooth = np.empty_like(plan)
    _middle_kernel(plan, smooth)
    return smooth


@kernel
def _middle_kernel(plan: NDArray[np.float32], smooth: NDArray[np.float32]) -> None:
    """The median of the nine places about each; NaN where fewer than two are known."""
    rows, columns = plan.shape
    values = np.empty(9)
    for row in range(rows):
        for column in range(columns):
            count = 0
            for r in range(max(0, row - 1), min(rows, row + 2)):
                for c in range(max(0, column - 1), min(columns, column + 2)):
                    if not math.isnan(plan[r, c]):
                        values[count] = plan[r, c]
                        count += 1
            smooth[row, column] = np.nan
            if count > 1:
                smooth[row, column] = np.median(values[:count])


@kernel
def _walk(
    plan: NDArray[np.float32], at: tuple[int, int], ahead: tuple[float, float], tolerance: float
) -> tuple[int, float]:
    """Places of one tone that way, and the tone behind its end less its own; 0 where none is."""
    row, column = at
    own = plan[row, column]
    run, odd, unknown = 0, 0, 0
    for step in range(1, _STEPS + 1):
        r = round(row + step * ahead[0])
        c = round(column + step * ahead[1])
        if r < 0 or c < 0 or r >= plan.shape[0] or c >= plan.shape[1]:
            break
        tone = plan[r, c]
        if math.isnan(tone):
            unknown += 1
            if unknown > _GAP:
                break
            continue
        unknown = 0
        if abs(tone - own) <= tolerance:
            run, odd = step, 0
        else:
            odd += 1
            if odd > _ODD:
                return run, tone - own
    return run, 0.0


@kernel
def _strips_kernel(
    plan: NDArray[np.float32], places: Integers, tolerance: float, found: NDArray[np.float32]
) -> None:
    """Ways through places of one tone.

    ``found`` (k, 5): shortest, its second next, and longest way, places; of the tones at both ends
    of the shortest, less the own, the lower and the higher.
    """
    ways = np.empty(_DIRECTIONS)
    for i in range(places.size):
        at = (places[i] // plan.shape[1], places[i] % plan.shape[1])
        shortest, low, high = 4.0 * _STEPS, 0.0, 0.0
        for direction in range(_DIRECTIONS):
            turn = math.pi * direction / _DIRECTIONS
            ahead = (math.sin(turn), math.cos(turn))
            run, tone = _walk(plan, at, ahead, tolerance)
            back, other = _walk(plan, at, (-ahead[0], -ahead[1]), tolerance)
            ways[direction] = run + back + 1
            if ways[direction] < shortest:
                shortest = ways[direction]
                low, high = min(tone, other), max(tone, other)
        ways.sort()
        found[i, 0], found[i, 1], found[i, 2] = ways[0], ways[2], ways[_DIRECTIONS - 1]
        found[i, 3], found[i, 4] = low, high


def warm_up() -> None:
    """Compile the kernels."""
    plan = np.zeros((2, 2), np.float32)
    _middle_kernel(plan, plan.copy())
    _strips_kernel(plan, np.zeros(1, np.int64), 1.0, np.zeros((1, _TOLD), np.float32))

"""Which places of a line may go without moving it by more than a tolerance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.map.drafting.crossings import crosses_itself
from processing.map.drafting.needed_positions import from_chord, needed_positions
from processing.map.drafting.polyline import Polyline
from processing.map.feature import Position

Kept = NDArray[np.int64]

_MOST_TRIES = 40


def kept_positions(
    positions: Sequence[Position], tolerance_m: float, *, is_closed: bool = False
) -> Kept:
    """The places that a simpler line needs.

    1. Douglas-Peucker in space between fixed places: the ends of a line; of a ring two places
       far from each other.
    2. A ring keeps at least three places.
    3. Where the simpler line crosses itself in plan and the given one doesn't, the tolerance is
       halved until it doesn't either.

    Returns
    -------
    (k,) int64
        Indices, rising. Every place lies within the tolerance of the simpler line.

    References
    ----------
    Douglas, Peucker 1973, Algorithms for the reduction of the number of points required to
    represent a digitized line or its caricature, https://doi.org/10.3138/FM57-6770-U75U-7727
    """
    everything = np.arange(len(positions))
    if len(positions) < (4 if is_closed else 3) or tolerance_m < 0:
        return everything
    line = Polyline.of(positions, is_closed=is_closed)
    crosses = crosses_itself(positions, is_closed=is_closed) is not None
    for _ in range(_MOST_TRIES):
        kept = (
            _ring(line.xyz, tolerance_m) if is_closed else needed_positions(line.xyz, tolerance_m)
        )
        simpler = [positions[position] for position in kept]
        if crosses or crosses_itself(simpler, is_closed=is_closed) is None:
            return kept
        tolerance_m /= 2
    return everything


def _ring(xyz: Floats, tolerance_m: float) -> Kept:
    first = _farthest(xyz, 0)
    second = _farthest(xyz, first)
    start, stop = min(first, second), max(first, second)
    if start == stop:
        return np.arange(len(xyz))
    order = np.roll(np.arange(len(xyz)), -start)
    there = needed_positions(xyz[start : stop + 1], tolerance_m) + start
    back = order[
        needed_positions(xyz[np.append(order[stop - start :], start)], tolerance_m)[:-1]
        + stop
        - start
    ]
    kept = np.union1d(there, back)
    if kept.size < 3:
        # A ring has an inside: the place furthest from the line through the other two stays.
        distances = from_chord(xyz, xyz[start], xyz[stop])
        kept = np.union1d(kept, [int(distances.argmax())])
    return kept if kept.size >= 3 else np.arange(len(xyz))


def _farthest(xyz: Floats, position: int) -> int:
    return int(((xyz - xyz[position]) ** 2).sum(axis=1).argmax())

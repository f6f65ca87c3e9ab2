"""The road below a vehicle as its own rows show it: how far down it is, how even it was measured.

Heads are mounted 1.5 to 3.5 m above the road, look ahead, back or down, and a trajectory may be
that of the head, of an antenna or of the wheels. So neither a height nor an angle is assumed: a row
crosses the vehicle's path somewhere, metres ahead or behind, and there the road lies below it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.recording.passes import Pass

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

_NEAR_M, _FARTHEST_M = 1.5, 12.0
"""So near to the vehicle's path ground is road: half of a lane of 3 m. Where a head sees nothing
there the width is doubled, up to a road's whole."""

_HIGHEST_M = 6.0
"""No trajectory is farther above its road: the roof of a lorry (3.8 m) with a mast."""

_LEAST_M = -1.0
"""Nor below it: a reference point on the ground, and a road that rises between row and vehicle."""

_BIN_M, _ABOUT_M = 0.1, 0.25
"""Heights are looked through in bins of so much for the one that most points share, and the road
is all within so much of it: half of its cross fall over the width, and its bumps."""

_SAMPLED_ROWS = 40
"""Rows of a block that are asked: some thousand points."""

_FEWEST = 60
"""Points from which a height is told: a lane as a slow scanner sees it in some rows."""

_LEAST_NOISE_M, _MOST_NOISE_M = 0.0005, 0.02
"""Bounds of noise: that of the best phase scanners; what would hide every hole."""

_OF_SECOND_DIFFERENCE = 6.0
"""Variance of the second difference of white noise in variances (1 + 4 + 1)."""

_KEPT, _CLIP, _ROUNDS = 0.9, 3.0, 4
"""Second differences that a spread is taken of: at first all but the largest tenth, which steps and
mixed pixels make, then those within three spreads, in rounds. A median would step with the files'
millimetres."""


@dataclass(frozen=True)
class RoadBelow:
    """What rows say of the road below the vehicle.

    Attributes
    ----------
    height_m : float
        How far the trajectory is above it.
    noise_m : float
        Standard deviation of heights about a smooth row: the scanner's noise as it shows in the
        height, and the pavement's texture.
    """

    height_m: float
    noise_m: float


@dataclass(frozen=True)
class RowsOfBlock:
    """Rows, their points, and where the vehicle was.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, about the origin of the pass.
    pulse : (n,) int64
    spans : (s, 2) int64
        First point and end of each row.
    stations : (s,) float64
        Of the vehicle when it measured the row, m.
    """

    xyz: Floats
    pulse: Integers
    spans: Integers
    stations: Floats


def road_below(rows: RowsOfBlock, way: Pass) -> RoadBelow | None:
    """The road below the vehicle; None where no row of the block crosses the vehicle's path."""
    parts = [*_below_path(rows, way)]
    if not parts:
        return None
    across, height, second = (np.concatenate([one[k] for one in parts]) for k in range(3))
    near_m = _NEAR_M
    while near_m <= _FARTHEST_M and (across <= near_m).sum() < _FEWEST:
        near_m *= 2.0
    is_near = across <= near_m
    if is_near.sum() < _FEWEST:
        return None
    bins = np.floor((height[is_near] - _LEAST_M) / _BIN_M).astype(np.int64)
    usual = _LEAST_M + (int(np.bincount(bins).argmax()) + 0.5) * _BIN_M
    is_road = is_near & (np.abs(height - usual) <= _ABOUT_M)
    noise = _spread(second[is_road & np.isfinite(second)]) / np.sqrt(_OF_SECOND_DIFFERENCE)
    return RoadBelow(
        float(np.median(height[is_road])), float(np.clip(noise, _LEAST_NOISE_M, _MOST_NOISE_M))
    )


def _spread(values: Floats) -> float:
    """Standard deviation of most of some values about 0."""
    if not values.size:
        return 0.0
    limit, found = float(np.quantile(np.abs(values), _KEPT)), 0.0
    for _ in range(_ROUNDS):
        found = float(np.sqrt(np.mean(values[np.abs(values) <= limit] ** 2)))
        limit = max(_CLIP * found, _LEAST_NOISE_M)
    return found


def _below_path(rows: RowsOfBlock, way: Pass) -> Iterator[tuple[Floats, Floats, Floats]]:
    """Of points about the path: how far beside it and below it, and their second differences."""
    stations = rows.stations
    positions, rights = way.positions_at(stations) - way.origin, way.rights_at(stations)
    for row in range(0, stations.size, max(1, stations.size // _SAMPLED_ROWS)):
        part = slice(*rows.spans[row])
        xyz, number = rows.xyz[part], rows.pulse[part]
        if len(xyz) < 3:
            continue
        off = xyz[:, :2] - positions[row, :2]
        right = rights[row]
        across, ahead = np.abs(off @ right), off @ np.array([-right[1], right[0]])
        below = way.positions_at(stations[row] + ahead)[:, 2] - way.origin[2] - xyz[:, 2]
        second = np.full(len(xyz), np.nan)
        is_whole = number[2:] - number[:-2] == 2
        bent = xyz[2:, 2] - 2 * xyz[1:-1, 2] + xyz[:-2, 2]
        second[1:-1][is_whole] = bent[is_whole]
        chosen = (across <= _FARTHEST_M) & (below >= _LEAST_M) & (below <= _HIGHEST_M)
        chosen &= np.abs(ahead) <= _FARTHEST_M
        yield across[chosen], below[chosen], second[chosen]

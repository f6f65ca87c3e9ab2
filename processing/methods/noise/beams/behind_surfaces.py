"""Points behind a surface that the same scanner saw: echoes that came back by way of a mirror.

Seen from where a scanner stood, ground and walls are closed: a beam that went on through them did
not. A point is such an echo where the beams next above it and next below it all ended clearly
nearer. Ground beyond a crest has open air above it, ground beneath a boom has ground below it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.noise.beams.scanner_positions import scanner_position_of
from processing.recording.drive import Drive

Floats = NDArray[np.float64]

_POINTS_AT_ONCE = 1 << 22
"""Points judged together: some 200 MB, and of a recording in its order enough to lie densely."""

_FINEST_RAD, _COARSEST_RAD = np.radians(0.1), np.radians(1.5)
"""Angles that a bin may span: from what tripod scanners step to what still is one surface beside
another at some ten metres (26 cm). By trial."""

_WIDENING = np.sqrt(2.0)
"""From one size of bin to the next: twice as many points in each."""

_POINTS_IN_BIN = 3
"""Points in the bin of a point, in the median, for which bins are made wide enough; by trial, so
that the nine bins on one side hold more than ``_FEWEST``."""

_ROWS_BESIDE, _COLUMNS_BESIDE = 3, 1
"""Bins above or below a point's own, and to either side of those, that are asked; by trial."""

_MARGIN_M = 0.05
"""By how much a beam has to end nearer: several times a scanner's noise and the ground's roughness.
By trial."""

_FEWEST = 8
"""Beams on either side, at least, so that shares and deviations say something; by trial."""

_FARTHER_SHARE = 0.15
"""Of these beams that may end as far or farther, as through holes in a surface; by trial."""

_DEVIATIONS = 3.0
"""By how many times as much as they differ among themselves the beams must end nearer: what is seen
through grass or a hedge lies behind beams that differ widely. By trial."""

_ROUNDS = 2
"""The second no longer counts what the first found, which stood beside echoes of its kind.

On five dense simulated sites echoes had sunk the ground by 46 m³; left out with these values it is
3 m³, and 0.01 % of the true ground goes with them."""


class _Limits(NamedTuple):
    """The constants above, as the kernel takes them."""

    margin_m: float
    farther_share: float
    deviations: float
    fewest: int


class _BinGrid(NamedTuple):
    """Bins row by row: how many in a row, where each begins, and the bin of every beam."""

    columns: int
    starts: NDArray[np.int64]
    bins: NDArray[np.int64]


class _Beam(NamedTuple):
    """The bin of a beam, the side to look to (1 up, −1 down), and its range, m."""

    row: int
    column: int
    side: int
    away: float


def echoes_of(drive: Drive, monitor: Monitor) -> NDArray[np.bool_] | None:
    """Which points of a drive lie behind a surface: (n,) bool; None where nobody knows.

    That is so where the scanner moved, and where nothing tells its position.

    Raises
    ------
    Cancelled
    """
    stand = scanner_position_of(drive)
    if stand is None:
        return None
    behind = np.zeros(drive.count, np.bool_)
    for start in range(0, drive.count, _POINTS_AT_ONCE):
        monitor.check()
        part = slice(start, min(start + _POINTS_AT_ONCE, drive.count))
        behind[part] = behind_surfaces(drive.xyz(part), stand)
    return behind


def behind_surfaces(xyz: Floats, stand: Floats) -> NDArray[np.bool_]:
    """Which points lie behind a surface as seen from where they were measured: (n,) bool.

    Parameters
    ----------
    xyz : (n, 3) float64
        Measured from one position, in the order of the recording, m; rows with NaN are passed over.
    stand : (3,) float64
        Where the scanner stood, m, in the same frame.

    Notes
    -----
    Beams are kept in bins of equal angles, about three in each; those next to a point are the
    three bins above and below it and their neighbours. At least eight beams on either side have
    to end nearer than the point, all but 15 % of them by more than 5 cm, and by more than three
    times as much as they differ among themselves: ground seen through grass or a hedge is not
    behind a surface. What was found no longer counts in a second round.
    """
    xyz = np.ascontiguousarray(xyz)
    beams = _beams(xyz, stand, _FINEST_RAD)
    size = _FINEST_RAD
    while size < _COARSEST_RAD and _middle_count(beams) < _POINTS_IN_BIN:
        size *= _WIDENING
        beams = _beams(xyz, stand, size)
    limits = _Limits(_MARGIN_M, _FARTHER_SHARE, _DEVIATIONS, _FEWEST)
    grid = _BinGrid(beams.columns, beams.starts, beams.bins)
    found = np.zeros(beams.bins.size, np.bool_)
    for _ in range(_ROUNDS):
        _behind_kernel(grid, beams.ranges, limits, found.copy(), found)
    behind = np.zeros(len(xyz), np.bool_)
    behind[beams.order[found]] = True
    return behind


@dataclass(frozen=True)
class _Beams:
    """Beams in bins of equal angles, row by row from below; ``order`` sorts points by bin."""

    columns: int
    starts: NDArray[np.int64]
    order: NDArray[np.int64]
    bins: NDArray[np.int64]
    ranges: NDArray[np.float32]


def _middle_count(beams: _Beams) -> float:
    """How many points the bin of a point holds, in the median of all points."""
    of_points = np.diff(beams.starts)[beams.bins]
    return float(np.median(of_points)) if of_points.size else np.inf


def _beams(xyz: Floats, stand: Floats, size: float) -> _Beams:
    columns = int(np.ceil(2 * np.pi / size))
    rows = int(np.ceil(np.pi / size)) + 1
    bins = np.empty(len(xyz), np.int64)
    ranges = np.empty(len(xyz), np.float32)
    frame = (float(stand[0]), float(stand[1]), float(stand[2]))
    _bins_kernel(xyz, frame, (rows, columns), bins, ranges)
    counts = np.bincount(bins + 1, minlength=rows * columns + 1)
    # Bin 0 of the counts holds what isn't finite, and is left out.
    starts = np.cumsum(counts) - counts[0]
    order = np.empty(int(starts[-1]), np.int64)
    _order_kernel(bins, starts[:-1].copy(), order)
    return _Beams(columns, starts, order, bins[order], ranges[order])


@kernel
def _bins_kernel(
    xyz: Floats,
    stand: tuple[float, float, float],
    grid: tuple[int, int],
    bins: NDArray[np.int64],
    ranges: NDArray[np.float32],
) -> None:
    rows, columns = grid
    for point in range(xyz.shape[0]):
        x, y = xyz[point, 0] - stand[0], xyz[point, 1] - stand[1]
        z = xyz[point, 2] - stand[2]
        away = np.sqrt(x * x + y * y + z * z)
        ranges[point] = away
        bins[point] = -1
        if np.isfinite(away):
            share = np.arctan2(y, x) / (2 * np.pi)
            column = min(int((share - np.floor(share)) * columns), columns - 1)
            rise = np.arctan2(z, np.hypot(x, y)) / np.pi + 0.5
            bins[point] = min(int(rise * (rows - 1)), rows - 1) * columns + column


@kernel
def _order_kernel(
    bins: NDArray[np.int64], following: NDArray[np.int64], order: NDArray[np.int64]
) -> None:
    for point in range(bins.size):
        own = bins[point]
        if own >= 0:
            order[following[own]] = point
            following[own] += 1


@kernel
def _behind_kernel(
    grid: _BinGrid,
    ranges: NDArray[np.float32],
    limits: _Limits,
    gone: NDArray[np.bool_],
    found: NDArray[np.bool_],
) -> None:
    columns, bins = grid.columns, grid.bins
    for point in range(ranges.size):
        if not found[point]:
            row, column = bins[point] // columns, bins[point] % columns
            above = _Beam(row, column, 1, ranges[point])
            below = _Beam(row, column, -1, ranges[point])
            found[point] = _ends_nearer(grid, ranges, limits, gone, above) and _ends_nearer(
                grid, ranges, limits, gone, below
            )


@kernel
def _ends_nearer(
    grid: _BinGrid,
    ranges: NDArray[np.float32],
    limits: _Limits,
    gone: NDArray[np.bool_],
    beam: _Beam,
) -> bool:
    """Whether the beams to one side of another ended nearer, and together."""
    columns, starts = grid.columns, grid.starts
    count, farther, total, squares = 0, 0, 0.0, 0.0
    for step in range(1, _ROWS_BESIDE + 1):
        first = (beam.row + beam.side * step) * columns
        if first < 0 or first + columns >= starts.size:
            continue
        for beside in range(-_COLUMNS_BESIDE, _COLUMNS_BESIDE + 1):
            own = first + (beam.column + beside) % columns
            for other in range(starts[own], starts[own + 1]):
                if gone[other]:
                    continue
                count += 1
                nearer = beam.away - ranges[other]
                if nearer <= limits.margin_m:
                    farther += 1
                else:
                    total += nearer
                    squares += nearer * nearer
    if count < limits.fewest or farther > limits.farther_share * count:
        return False
    mean = total / (count - farther)
    spread = max(squares / (count - farther) - mean * mean, 0.0)
    return mean * mean >= limits.deviations * limits.deviations * spread


def warm_up() -> None:
    """Compile the kernels of this file."""
    behind_surfaces(np.ones((2, 3)), np.zeros(3))

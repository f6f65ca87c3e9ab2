"""Cells of space about trunks with what the points of each tell of its shape.

Crowns of neighbours touch, so cells are of the survey and not of a tree; of a cell only counts,
sums and extents are kept, so that memory follows the plants beside the road and not their points.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.core.scratch_arrays import nameless_array
from processing.methods.road.objects.drive_chunks import chunks_of
from processing.methods.road.objects.sparse_plan import TILE, SparsePlan, cell_of
from processing.recording.drive import Drive

_Number = TypeVar("_Number", np.float32, np.int64)

CELL_M = 0.4
"""Cells in which a crown hangs together: the gaps between its twigs are smaller, and houses and
wires keep farther away."""

LOW_M = 0.6
"""Above the foot: what is lower is grass, shoots and the ground of a bank."""

_FEWEST = 6
"""Points of a cell from which its shape is told."""

_FLAT = 0.15
"""Extent square to a cell's plane over its longest one. Over a plane it is the noise, 1 cm over
12 cm; twigs and leaves fill a cell to a third."""

_LINE = 0.25
"""The middle extent over the longest one of a line: a branch of 5 cm in a cell."""

_STEEP = 0.35
"""Sine of 20 degrees: branches rise more, arms of lamps and signs and wires don't."""

_UPRIGHT = 0.985
"""Sine of 80 degrees: edges of houses, pipes and poles stand so, branches seldom."""

_FILLED, _LEVEL, _BOUGH = range(3)
"""Shapes of cells."""

_STRAY = 0.05
"""Of the points of the fullest cell about: fewer are noise beside a plate that shines or twigs
before a wall, which say nothing about its shape."""

_SUMS = 10
"""Of a cell: number, sums and sums of products of its points about its middle."""

_BITS = 20
"""Of a key for each direction: 400 km of cells."""

_HALF = 1 << (_BITS - 1)

_EMPTY_KEY = -1

_FIRST_SLOTS = 1 << 15
"""Of the table: 20 m of street; it doubles when it is half full."""

_MOST_IN_MEMORY = 1 << 20
"""Rows of a table; wider ones lie in files without a name beside the drive, so that memory doesn't
grow with it."""


class StandingStems(NamedTuple):
    """The stems whose points are left out of the cells, m about the plan's origin.

    ``starts``: of each trunk's stems; ``axes``: (n, 7) east and north of the axis at the foot, its
    lean to east and north, radius beyond which a point is not of the stem, height above the foot
    that it reaches, number of the trunk; ``feet``: (k,) heights of the trunks' feet.
    """

    starts: Integers
    axes: Floats
    feet: Floats


@dataclass(frozen=True)
class CrownCells:
    """Cells about trunks that hold points of no stem.

    Attributes
    ----------
    places : (n, 3) int64
        Of each cell, in cells from the plan's origin.
    trunks : (n,) int64
        The trunk nearest to it.
    counts : (n,) int64
        Points of each.
    lowest, highest : (n, 3) float32
        Of its points, m about the plan's origin.
    is_told : (n,) bool
        Whether it and the cells about it have points enough to tell a shape.
    is_flat : (n,) bool
        Whether that is a plane or a level or upright line: a wall, a sign, an arm, a wire, a pipe.
    is_bough : (n,) bool
        Whether it is a line that rises as boughs do.
    """

    places: Integers
    trunks: Integers
    counts: Integers
    lowest: NDArray[np.float32]
    highest: NDArray[np.float32]
    is_told: NDArray[np.bool_]
    is_flat: NDArray[np.bool_]
    is_bough: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.counts)

    @property
    def middles(self) -> Floats:
        """(n, 3) float64, m about the plan's origin."""
        middles: Floats = (self.places + np.float64(0.5)) * CELL_M
        return middles

    def are_above(self, some: Integers, filled: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Whether right below some cells, by their number, lies one that is marked as filled."""
        return np.isin(_keys_of(self.places[some]) - 1, _keys_of(self.places[filled]))

    def components(self, is_open: NDArray[np.bool_], link: int) -> Integers:
        """(n,) int64: which cells hang together with each other; −1: not open.

        Parameters
        ----------
        link : int
            Cells from one to the next at most: 1 where they touch.
        """
        parts = np.full(len(self), -1, np.int64)
        cells = np.flatnonzero(is_open)
        keys = _keys_of(self.places[cells])
        order = np.argsort(keys, kind="stable")
        roots = np.empty(len(cells), np.int64)
        components_kernel(keys[order], link, roots)
        root_of = np.empty(len(cells), np.int64)
        root_of[order] = roots
        # Parts are numbered by the first of their cells.
        _, first, part = np.unique(root_of, return_index=True, return_inverse=True)
        parts[cells] = np.argsort(np.argsort(first))[part]
        return parts


def crown_cells(
    drives: Sequence[Drive],
    plan: SparsePlan,
    owners: NDArray[np.int32],
    stems: StandingStems,
    monitor: Monitor,
) -> CrownCells:
    """Fill the cells with the points about trunks.

    Parameters
    ----------
    owners : (tiles, 64, 64) int32
        The trunk nearest to each cell of the plan; −1: none is near.

    Notes
    -----
    1. Each point above the foot of the trunk nearest to it that lies on none of its stems is
       counted in its cell of 0.4 m.
    2. A cell is flat if its points and those of the cells about it lie in a plane or on a line that
       rises less or more than branches do. One scan line through a crown is a plane too, hence the
       cells about it.
    """
    slots = np.full((2, _FIRST_SLOTS), _EMPTY_KEY, np.int64)
    sums: NDArray[np.float32] = np.zeros((_FIRST_SLOTS // 2, _SUMS), np.float32)
    boxes: NDArray[np.float32] = np.zeros((_FIRST_SLOTS // 2, 6), np.float32)
    places = np.zeros((_FIRST_SLOTS // 2, 4), np.int64)
    folder = drives[0].folder
    used = 0
    for chunk in chunks_of(drives, plan.origin, monitor):
        begin = 0
        while begin < len(chunk.local):
            begin, used = fill_kernel(
                chunk.local,
                chunk.is_noise,
                (begin, used),
                (plan.table, owners.reshape(-1)),
                stems,
                (slots, places, sums, boxes),
            )
            if begin < len(chunk.local):
                slots, places = _doubled(slots, folder), _wider(places, folder)
                sums, boxes = _wider(sums, folder), _wider(boxes, folder)
    sums, boxes, trunks, places = sums[:used], boxes[:used], places[:used, 3], places[:used, :3]
    is_told, is_flat, is_bough = np.zeros((3, used), np.bool_)
    keys = _keys_of(places)
    order = np.argsort(keys, kind="stable")
    shapes_kernel(keys[order], order, sums, (is_told, is_flat, is_bough))
    counts = sums[:, 0].astype(np.int64)
    return CrownCells(
        places, trunks, counts, boxes[:, :3], boxes[:, 3:], is_told, is_flat, is_bough
    )


def _doubled(slots: Integers, folder: Path) -> Integers:
    """The table with twice as much room."""
    wider = _room_for((2, 2 * slots.shape[1]), slots.dtype, folder)
    wider[:] = _EMPTY_KEY
    rehash_kernel(slots, wider)
    return wider


def _wider(rows: NDArray[_Number], folder: Path) -> NDArray[_Number]:
    wider: NDArray[_Number] = _room_for((2 * len(rows), rows.shape[1]), rows.dtype, folder)
    wider[: len(rows)] = rows
    return wider


# The type of the values is the caller's.
def _room_for(shape: tuple[int, int], dtype: np.dtype[Any], folder: Path) -> NDArray[Any]:
    """Zeros in memory, or many of them on the disk of a folder."""
    if max(shape) <= _MOST_IN_MEMORY:
        return np.zeros(shape, dtype)
    return nameless_array(folder, dtype, shape)


@kernel
def _key(i: int, j: int, k: int) -> int:
    return (((i + _HALF) << _BITS) + (j + _HALF) << _BITS) + (k + _HALF)


def _keys_of(places: Integers) -> Integers:
    """(n,) int64: the keys of cells; of neighbours the one farther east, north or up is greater."""
    i, j, k = (places + _HALF).T
    return np.asarray((((i << _BITS) + j) << _BITS) + k)


@kernel
def _slot_of(key: int, slots: Integers) -> int:
    """Where a key is in the table, or would be."""
    size = slots.shape[1]
    # Fibonacci hashing (Knuth, The Art of Computer Programming 3, 6.4), on 32 bits of the key.
    folded = (key ^ (key >> 29)) & 0xFFFFFFFF
    slot = ((folded * 2_654_435_769) & 0xFFFFFFFF) % size
    while slots[0, slot] != _EMPTY_KEY and slots[0, slot] != key:
        slot = slot + 1 if slot + 1 < size else 0
    return int(slot)


@kernel
def rehash_kernel(slots: Integers, wider: Integers) -> None:
    """Put all keys of a table into a wider one."""
    for old in range(slots.shape[1]):
        if slots[0, old] != _EMPTY_KEY:
            slot = _slot_of(slots[0, old], wider)
            wider[0, slot] = slots[0, old]
            wider[1, slot] = slots[1, old]


@kernel
def fill_kernel(
    local: Floats,
    is_noise: NDArray[np.bool_],
    at: tuple[int, int],
    plan: tuple[NDArray[np.int32], NDArray[np.int32]],
    stems: StandingStems,
    cells: tuple[Integers, Integers, NDArray[np.float32], NDArray[np.float32]],
) -> tuple[int, int]:
    """Count points in cells, from one on, until there is no more room for new cells.

    Parameters
    ----------
    at : (int, int)
        The first point, and how many cells there are.

    Returns
    -------
    int, int
        The first point that was not counted, and how many cells there are then.
    """
    begin, used = at
    table, owners = plan
    slots, places, sums, boxes = cells
    for point in range(begin, len(local)):
        if is_noise[point]:
            continue
        east, north, up = local[point, 0], local[point, 1], local[point, 2]
        below = cell_of(east, north, table, TILE)
        trunk = owners[below] if below >= 0 else -1
        if trunk < 0 or up < stems.feet[trunk] + LOW_M or _is_on(east, north, up, trunk, stems):
            continue
        i, j, k = math.floor(east / CELL_M), math.floor(north / CELL_M), math.floor(up / CELL_M)
        key = _key(i, j, k)
        slot = _slot_of(key, slots)
        if slots[0, slot] == _EMPTY_KEY:
            if used == len(sums):
                return point, used
            slots[0, slot] = key
            slots[1, slot] = used
            places[used, 0], places[used, 1], places[used, 2], places[used, 3] = i, j, k, trunk
            boxes[used, :3] = 1e9
            boxes[used, 3:] = -1e9
            used += 1
        cell = slots[1, slot]
        x, y, z = east - (i + 0.5) * CELL_M, north - (j + 0.5) * CELL_M, up - (k + 0.5) * CELL_M
        row = sums[cell]
        row[0] += 1
        row[1] += x
        row[2] += y
        row[3] += z
        row[4] += x * x
        row[5] += x * y
        row[6] += y * y
        row[7] += x * z
        row[8] += y * z
        row[9] += z * z
        box = boxes[cell]
        box[0], box[1], box[2] = min(box[0], east), min(box[1], north), min(box[2], up)
        box[3], box[4], box[5] = max(box[3], east), max(box[4], north), max(box[5], up)
    return len(local), used


@kernel
def _is_on(east: float, north: float, up: float, trunk: int, stems: StandingStems) -> bool:
    for number in range(stems.starts[trunk], stems.starts[trunk + 1]):
        axis = stems.axes[number]
        above = up - stems.feet[trunk]
        if above < axis[5]:
            beside = math.hypot(east - axis[0] - axis[2] * above, north - axis[1] - axis[3] * above)
            if beside < axis[4]:
                return True
    return False


@kernel
def shapes_kernel(
    keys: Integers,
    order: Integers,
    sums: NDArray[np.float32],
    told: tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]],
) -> None:
    """Tell of each cell whether its shape is known, whether it is flat, whether a bough.

    Parameters
    ----------
    keys : (n,) int64
        Of the cells, rising.
    order : (n,) int64
        The cell of each.
    """
    is_told, is_flat, is_bough = told
    wide = np.zeros(_SUMS)
    # Of each of nine upright rows, the first cell that is not below: keys rise, so these do.
    firsts = np.zeros((3, 3), np.int64)
    near, moves = np.zeros(27, np.int64), np.zeros((27, 3))
    for at in range(len(keys)):
        cell = order[at]
        count = _cells_about(keys, at, firsts, near, moves)
        richest = np.float32(0.0)
        for one in near[:count]:
            richest = max(richest, sums[order[one], 0])
        wide[:] = 0.0
        for one in range(count):
            row = sums[order[near[one]]]
            if row[0] >= _STRAY * richest:
                _add_moved(wide, row, moves[one, 0], moves[one, 1], moves[one, 2])
        if wide[0] < _FEWEST:
            continue
        is_told[cell] = True
        shape = _shape(wide)
        if shape != _FILLED and sums[cell, 0] >= _FEWEST:
            wide[:] = 0.0
            _add_moved(wide, sums[cell], 0.0, 0.0, 0.0)
            shape = _shape(wide)
        is_flat[cell] = shape == _LEVEL
        is_bough[cell] = shape == _BOUGH


@kernel
def _cells_about(keys: Integers, at: int, firsts: Integers, near: Integers, moves: Floats) -> int:
    """A cell and those that touch it, and where their middles lie from its own; how many."""
    count = 0
    for di in range(-1, 2):
        for dj in range(-1, 2):
            key = keys[at] + (di << 2 * _BITS) + (dj << _BITS)
            one = firsts[di + 1, dj + 1]
            while one < len(keys) and keys[one] < key - 1:
                one += 1
            firsts[di + 1, dj + 1] = one
            while one < len(keys) and keys[one] <= key + 1:
                near[count] = one
                moves[count] = di * CELL_M, dj * CELL_M, (keys[one] - key) * CELL_M
                count += 1
                one += 1
    return count


@kernel
def _add_moved(wide: Floats, row: NDArray[np.float32], x: float, y: float, z: float) -> None:
    """Add the sums of a cell whose middle lies so far from where they are wanted."""
    n, sx, sy, sz = row[0], row[1], row[2], row[3]
    wide[0] += n
    wide[1] += sx + n * x
    wide[2] += sy + n * y
    wide[3] += sz + n * z
    wide[4] += row[4] + 2 * x * sx + n * x * x
    wide[5] += row[5] + x * sy + y * sx + n * x * y
    wide[6] += row[6] + 2 * y * sy + n * y * y
    wide[7] += row[7] + x * sz + z * sx + n * x * z
    wide[8] += row[8] + y * sz + z * sy + n * y * z
    wide[9] += row[9] + 2 * z * sz + n * z * z


@kernel
def _shape(sums: Floats) -> int:
    """Whether points lie in a plane or on a line that doesn't rise as branches do, or on one.

    References
    ----------
    Smith 1961: Eigenvalues of a symmetric 3 × 3 matrix, Communications of the ACM 4, 168.
    """
    n = sums[0]
    x, y, z = sums[1] / n, sums[2] / n, sums[3] / n
    xx, xy, yy = sums[4] / n - x * x, sums[5] / n - x * y, sums[6] / n - y * y
    xz, yz, zz = sums[7] / n - x * z, sums[8] / n - y * z, sums[9] / n - z * z
    third = (xx + yy + zz) / 3
    a, b, c = xx - third, yy - third, zz - third
    size = math.sqrt(max((a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6, 1e-18))
    determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
    turn = math.acos(max(-1.0, min(1.0, determinant / (2 * size**3)))) / 3
    most = max(third + 2 * size * math.cos(turn), 1e-12)
    least = max(third + 2 * size * math.cos(turn + 2 * math.pi / 3), 1e-12)
    middle = max(3 * third - most - least, 1e-12)
    if least >= _FLAT**2 * most:
        return _FILLED
    if middle >= _LINE**2 * most:
        return _LEVEL
    # The square of the direction's height: of (A - middle)(A - least), which leaves the longest.
    square = xz * xz + yz * yz + zz * zz
    rise = (square - (middle + least) * zz + middle * least) / ((most - middle) * (most - least))
    return _BOUGH if _STEEP**2 <= rise <= _UPRIGHT**2 else _LEVEL


@kernel
def components_kernel(keys: Integers, link: int, roots: Integers) -> None:
    """Find the components of cells.

    Parameters
    ----------
    keys : (n,) int64
        Of the cells, rising.
    link : int
        Cells from one to the next at most.
    roots : (n,) int64
        Written: one cell of its component for each, the same for all of them.
    """
    for at in range(len(keys)):
        roots[at] = at
    for di in range(link + 1):
        # Pairs are met once: the other cell is the farther one.
        for dj in range(-link if di > 0 else 0, link + 1):
            low = -link if di > 0 or dj > 0 else 1
            step = (di << 2 * _BITS) + (dj << _BITS)
            first = 0
            for at in range(len(keys)):
                while first < len(keys) and keys[first] < keys[at] + step + low:
                    first += 1
                near = first
                while near < len(keys) and keys[near] <= keys[at] + step + link:
                    one, other = _root(roots, at), _root(roots, near)
                    roots[max(one, other)] = min(one, other)
                    near += 1
    for at in range(len(keys)):
        roots[at] = _root(roots, at)


@kernel
def _root(roots: Integers, cell: int) -> int:
    while roots[cell] != cell:
        roots[cell] = roots[roots[cell]]
        cell = roots[cell]
    return cell

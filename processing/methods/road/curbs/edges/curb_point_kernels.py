"""Loops that find the points about rough curb lines: by cells of the plan, then by segments."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

ALONG, ACROSS, ABOVE = range(3)
"""Values of a point about a line: stations along it, m towards the higher ground, m above it."""

_X_KEY = 0x100000000
"""Factor of a cell's column in its key, 2 to the power of 32: rows of any place on earth fit."""

_COLUMN_HASH, _ROW_HASH = 73856093, 19349663
"""Primes that spread cells over the table (Teschner et al. 2003, Optimized spatial hashing for
collision detection of deformable objects, section 3.1)."""

_BEYOND = 0.5
"""How far beyond the ends of a segment, in its own lengths, a point may be nearest to it: as far as
its neighbours are looked at too."""

_HALF_CELL = 0.5
"""Quarters of a cell begin at its middle."""


class CellFrame(NamedTuple):
    """What makes metres about an origin of integers: scales and offsets; the size of a cell, m."""

    scale_x: float
    scale_y: float
    scale_z: float
    offset_x: float
    offset_y: float
    offset_z: float
    cell_m: float


class LineReach(NamedTuple):
    """How far across, below and above a line a point may lie, m."""

    across_m: float
    below_m: float
    above_m: float


class CellTable(NamedTuple):
    """Cells of the plan: slots, keys, where each cell's segments start, the segments."""

    slots: _Integers
    keys: _Integers
    starts: _Integers
    segments: _Integers


class PlanLines(NamedTuple):
    """Lines: places (m, 3), unit vectors to the higher ground (m, 2), number of each line (m,)."""

    xyz: _Floats
    outwards: _Floats
    line_of: _Integers


@kernel
def slot_of(key: int, slots: _Integers, keys: _Integers) -> int:
    """Where a cell is in the table, or where it would be: open addressing, size a power of two."""
    mask = slots.shape[0] - 1
    slot: int = ((key >> 32) * _COLUMN_HASH ^ key * _ROW_HASH) & mask
    while slots[slot] >= 0 and keys[slots[slot]] != key:
        slot = (slot + 1) & mask
    return slot


@kernel
def fill_slots_kernel(keys: _Integers, slots: _Integers) -> None:
    """Enter every cell in the table; ``slots`` comes filled with −1."""
    for i in range(keys.shape[0]):
        slots[slot_of(keys[i], slots, keys)] = i


@kernel
def about_lines_kernel(
    integers: NDArray[np.int32],
    frame: CellFrame,
    table: CellTable,
    lines: PlanLines,
    reach: LineReach,
    found: tuple[_Integers, _Integers, _Floats],
) -> int:
    """Points near lines, each once per line; gives their number, −1 where there is no room.

    ``integers``: (n, 3) of a block; ``frame`` is about the lines' origin; ``found``: point of the
    block, line, and (k, 3) along, across and above.
    """
    slots, keys, starts, segments = table
    xyz, outwards, line_of = lines
    size = frame.cell_m
    points, owners, values = found
    count = 0
    for i in range(integers.shape[0]):
        x = integers[i, 0] * frame.scale_x + frame.offset_x
        y = integers[i, 1] * frame.scale_y + frame.offset_y
        key = math.floor(x / size) * _X_KEY + math.floor(y / size)
        cell = slots[slot_of(key, slots, keys)]
        if cell < 0:
            continue
        z = integers[i, 2] * frame.scale_z + frame.offset_z
        line, nearest = -1, math.inf
        for k in range(starts[cell], starts[cell + 1]):
            s = segments[k]
            wide, high = xyz[s + 1, 0] - xyz[s, 0], xyz[s + 1, 1] - xyz[s, 1]
            along = ((x - xyz[s, 0]) * wide + (y - xyz[s, 1]) * high) / (wide**2 + high**2)
            if along < -_BEYOND or along > 1 + _BEYOND:
                continue
            inside = min(max(along, 0.0), 1.0)
            off_x = x - xyz[s, 0] - inside * wide
            off_y = y - xyz[s, 1] - inside * high
            away = math.hypot(off_x, off_y)
            above = z - xyz[s, 2] - inside * (xyz[s + 1, 2] - xyz[s, 2])
            if away > reach.across_m or above < -reach.below_m or above > reach.above_m:
                continue
            if line_of[s] == line and away >= nearest:
                continue
            if line_of[s] != line:
                if count == points.shape[0]:
                    return -1
                count += 1
            line, nearest = line_of[s], away
            out_x = outwards[s, 0] + inside * (outwards[s + 1, 0] - outwards[s, 0])
            out_y = outwards[s, 1] + inside * (outwards[s + 1, 1] - outwards[s, 1])
            points[count - 1] = i
            owners[count - 1] = line
            values[count - 1, ALONG] = s + inside
            values[count - 1, ACROSS] = math.copysign(away, off_x * out_x + off_y * out_y)
            values[count - 1, ABOVE] = above
    return count


@kernel
def in_cells_kernel(
    integers: NDArray[np.int32],
    frame: CellFrame,
    table: tuple[_Integers, _Integers],
    heights: _Floats,
    found: tuple[_Integers, _Integers],
) -> int:
    """Points in some cells of the plan and between the heights of each; gives their number.

    ``heights``: (cells, 2) lowest and highest;
    ``found``: the points, and which quarter of which cell each is in, four to a cell.
    """
    slots, keys = table
    points, quarters = found
    count = 0
    for i in range(integers.shape[0]):
        x = (integers[i, 0] * frame.scale_x + frame.offset_x) / frame.cell_m
        y = (integers[i, 1] * frame.scale_y + frame.offset_y) / frame.cell_m
        column, row = math.floor(x), math.floor(y)
        key = column * _X_KEY + row
        cell = slots[slot_of(key, slots, keys)]
        if cell >= 0:
            z = integers[i, 2] * frame.scale_z + frame.offset_z
            if heights[cell, 0] <= z <= heights[cell, 1]:
                quarter = 2 * (x - column >= _HALF_CELL) + (y - row >= _HALF_CELL)
                points[count] = i
                quarters[count] = 4 * cell + quarter
                count += 1
    return count


@kernel
def order_kernel(groups: _Integers, begins: _Integers, order: _Integers) -> None:
    """Numbers of values group by group, each group's rising.

    Parameters
    ----------
    groups : (n,)
        Of each value.
    begins : (g,)
        Where each group begins in ``order``; changed.
    order : (n,)
        Filled.
    """
    for i in range(groups.size):
        order[begins[groups[i]]] = i
        begins[groups[i]] += 1


def warm_up() -> None:
    """Compile the kernels."""
    keys = np.zeros(1, np.int64)
    slots = np.full(4, -1)
    fill_slots_kernel(keys, slots)
    order_kernel(keys, keys.copy(), keys.copy())
    integers = np.zeros((1, 3), np.int32)
    integers.flags.writeable = False
    frame = CellFrame(1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.5)
    for one in (np.zeros((1, 3), np.int32), integers):
        in_cells_kernel(one, frame, (slots, keys), np.zeros((1, 2)), (keys.copy(), keys.copy()))
        about_lines_kernel(
            one,
            frame,
            CellTable(slots, keys, np.array([0, 1]), np.array([0])),
            PlanLines(
                np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
                np.array([[0.0, 1.0]] * 2),
                np.zeros(2, np.int64),
            ),
            LineReach(1.0, 1.0, 1.0),
            (np.empty(4, np.int64), np.empty(4, np.int64), np.empty((4, 3))),
        )

"""Loops that find the points about rough curb lines: by cells of the plan, then by segments."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

ALONG, ACROSS, ABOVE = range(3)
"""Values of a point about a line: stations along it, m towards the higher ground, m above it."""


@kernel
def slot_of(key: int, slots: _Integers, keys: _Integers) -> int:
    """Where a cell is in the table, or where it would be: open addressing, size a power of two."""
    mask = slots.shape[0] - 1
    slot: int = ((key >> 32) * 73856093 ^ key * 19349663) & mask  # Teschner et al. 2003
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
    position: _Floats,
    table: tuple[_Integers, _Integers, _Integers, _Integers],
    lines: tuple[_Floats, _Floats, _Integers],
    limits: _Floats,
    found: tuple[_Integers, _Integers, _Floats],
) -> int:
    """Points near lines, each once per line; gives their number, −1 where there is no room.

    ``integers``: (n, 3) of a block; ``position``: scale and offset about the lines' origin, size of
    a cell; ``table``: slots, keys of cells, where each cell's segments start, the segments;
    ``lines``: places (m, 3), unit vectors to the higher ground (m, 2), number of each line (m,);
    ``limits``: how far across, below and above; ``found``: point of the block, line, and (k, 3)
    along, across and above.
    """
    slots, keys, starts, segments = table
    xyz, outwards, line_of = lines
    size = position[6]
    count = 0
    for i in range(integers.shape[0]):
        x = integers[i, 0] * position[0] + position[3]
        y = integers[i, 1] * position[1] + position[4]
        key = math.floor(x / size) * 0x100000000 + math.floor(y / size)
        cell = slots[slot_of(key, slots, keys)]
        if cell < 0:
            continue
        z = integers[i, 2] * position[2] + position[5]
        line, nearest = -1, math.inf
        for k in range(starts[cell], starts[cell + 1]):
            s = segments[k]
            wide, high = xyz[s + 1, 0] - xyz[s, 0], xyz[s + 1, 1] - xyz[s, 1]
            along = ((x - xyz[s, 0]) * wide + (y - xyz[s, 1]) * high) / (wide**2 + high**2)
            if along < -0.5 or along > 1.5:
                continue
            inside = min(max(along, 0.0), 1.0)
            off_x = x - xyz[s, 0] - inside * wide
            off_y = y - xyz[s, 1] - inside * high
            away = math.hypot(off_x, off_y)
            above = z - xyz[s, 2] - inside * (xyz[s + 1, 2] - xyz[s, 2])
            if away > limits[0] or above < -limits[1] or above > limits[2]:
                continue
            if line_of[s] == line and away >= nearest:
                continue
            if line_of[s] != line:
                if count == found[0].shape[0]:
                    return -1
                count += 1
            line, nearest = line_of[s], away
            out_x = outwards[s, 0] + inside * (outwards[s + 1, 0] - outwards[s, 0])
            out_y = outwards[s, 1] + inside * (outwards[s + 1, 1] - outwards[s, 1])
            found[0][count - 1] = i
            found[1][count - 1] = line
            found[2][count - 1, ALONG] = s + inside
            found[2][count - 1, ACROSS] = math.copysign(away, off_x * out_x + off_y * out_y)
            found[2][count - 1, ABOVE] = above
    return count


@kernel
def in_cells_kernel(
    integers: NDArray[np.int32],
    position: _Floats,
    table: tuple[_Integers, _Integers],
    heights: _Floats,
    found: tuple[_Integers, _Integers],
) -> int:
    """Points in some cells of the plan and between the heights of each; gives their number.

    ``position`` is as in :func:`about_lines_kernel`; ``heights``: (cells, 2) lowest and highest;
    ``found``: the points, and which quarter of which cell each is in, four to a cell.
    """
    slots, keys = table
    count = 0
    for i in range(integers.shape[0]):
        x = (integers[i, 0] * position[0] + position[3]) / position[6]
        y = (integers[i, 1] * position[1] + position[4]) / position[6]
        column, row = math.floor(x), math.floor(y)
        key = column * 0x100000000 + row
        cell = slots[slot_of(key, slots, keys)]
        if cell >= 0:
            z = integers[i, 2] * position[2] + position[5]
            if heights[cell, 0] <= z <= heights[cell, 1]:
                found[0][count] = i
                found[1][count] = 4 * cell + 2 * (x - column >= 0.5) + (y - row >= 0.5)
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
    position = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.5])
    for one in (np.zeros((1, 3), np.int32), integers):
        in_cells_kernel(one, position, (slots, keys), np.zeros((1, 2)), (keys.copy(), keys.copy()))
        about_lines_kernel(
            one,
            position,
            (slots, keys, np.array([0, 1]), np.array([0])),
            (
                np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
                np.array([[0.0, 1.0]] * 2),
                np.zeros(2, np.int64),
            ),
            np.ones(3),
            (np.empty(4, np.int64), np.empty(4, np.int64), np.empty((4, 3))),
        )

"""Kernels that look for long thin strips of raised cells and follow them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.barriers.raised_cells import FINE, FINE_M
from processing.methods.road.objects.sparse_plan import cell_of

_BLOCK = 4
"""Fine cells along the side of the block of which one place is looked at."""

_BINS, _BIN_M = 10, 0.3
"""A strip is looked at over 3 m, in parts that are as long as scan lines may lie apart."""

_FLANK_M = 0.35
"""Beside a strip that is 0.3 m wide."""

STEP_M = 0.5
"""Between the nodes of a followed strip."""

_REACH_CELLS, _WIDE_CELLS = 9, 2
"""Cells ahead and behind, and to both sides, from which a node's place and direction come."""

_OWN_CELLS = 4
"""To both sides of a followed strip, in which no other begins: beam and posts are one."""

_MOST_TURN = 0.12
"""From node to node, rise over run: a curve of 5 m radius turns by 0.1."""

_LEAST_CELLS = 3
"""Along the reach of a node, below which nothing is seen there."""

_LONGEST_GAP = 3
"""Nodes without anything that are passed over: what a post or a parked car hides is longer, and
pieces are joined later."""


class StripCells(NamedTuple):
    """The raster that strips are followed on; all but the table flat, a value for each fine cell.

    ``raised``: 1 where something stands; ``near``: within a cell of one that is; ``used``: 1 where
    a strip was followed already.
    """

    table: NDArray[np.int32]
    raised: NDArray[np.uint8]
    near: NDArray[np.uint8]
    used: NDArray[np.uint8]


@kernel
def near_kernel(
    raised: NDArray[np.uint8],
    corners: Floats,
    table: NDArray[np.int32],
    near: NDArray[np.uint8],
) -> None:
    """Mark cells within a cell of a raised one: all flat but (tiles, 2) corners."""
    for cell in range(raised.size):
        if raised[cell] == 0:
            continue
        tile, i, j = cell // (FINE * FINE), cell // FINE % FINE, cell % FINE
        if 0 < i < FINE - 1 and 0 < j < FINE - 1:
            for u in range(-1, 2):
                for v in range(-1, 2):
                    near[cell + u * FINE + v] = 1
            continue
        for u in range(-1, 2):
            for v in range(-1, 2):
                east = corners[tile, 0] + (i + u + 0.5) * FINE_M
                north = corners[tile, 1] + (j + v + 0.5) * FINE_M
                other = cell_of(east, north, table, FINE)
                if other >= 0:
                    near[other] = 1


@kernel
def places_kernel(raised: NDArray[np.uint8], corners: Floats, places: Floats) -> int:
    """The middle of the raised cells of each block that has any; how many there are."""
    count = 0
    per = FINE // _BLOCK
    for tile in range(len(corners)):
        for block in range(per * per):
            i, j = block // per * _BLOCK, block % per * _BLOCK
            found, east, north = 0, 0.0, 0.0
            for u in range(i, i + _BLOCK):
                for v in range(j, j + _BLOCK):
                    if raised[(tile * FINE + u) * FINE + v]:
                        found += 1
                        east += u + 0.5
                        north += v + 0.5
            if found:
                places[count, 0] = corners[tile, 0] + east / found * FINE_M
                places[count, 1] = corners[tile, 1] + north / found * FINE_M
                count += 1
    return count


@kernel
def directions_kernel(
    places: Floats,
    directions: Floats,
    cells: StripCells,
    best: NDArray[np.int32],
    scores: NDArray[np.float32],
) -> None:
    """The direction of each place in which a strip through it is longest and freest beside.

    Scores are bins of the strip that something stands in, less half of those of its freer flank.
    """
    for place in range(len(places)):
        east, north = places[place, 0], places[place, 1]
        for number in range(len(directions)):
            x, y = directions[number, 0], directions[number, 1]
            core = left = right = 0
            for k in range(_BINS):
                t = (k - (_BINS - 1) / 2) * _BIN_M
                e, n = east + t * x, north + t * y
                core += _value(cells.near, e, n, cells.table)
                left += _value(cells.near, e - _FLANK_M * y, n + _FLANK_M * x, cells.table)
                right += _value(cells.near, e + _FLANK_M * y, n - _FLANK_M * x, cells.table)
            score = core - 0.5 * min(left, right)
            if score > scores[place]:
                scores[place] = score
                best[place] = number


@kernel
def follow_kernel(
    place: Floats,
    direction: Floats,
    cells: StripCells,
    nodes: Floats,
) -> int:
    """Follow a strip from a place to one side, and mark what was followed; how many nodes.

    Parameters
    ----------
    direction : (2,) float64
        Of length 1; turned as the strip turns.
    nodes : (n, 2) float64
        Filled; ends at the last node where something stands.
    """
    east, north = place[0], place[1]
    x, y = direction[0], direction[1]
    count = last = 0
    while count < len(nodes) and count - last <= _LONGEST_GAP:
        found, aside, turn = _fit(east, north, x, y, cells)
        if found >= _LEAST_CELLS:
            # Half of the way: a node's own cells say no more than its neighbours'.
            east -= aside * y
            north += aside * x
            turn = min(max(turn, -_MOST_TURN), _MOST_TURN)
            long = np.sqrt(1 + turn * turn)
            x, y = (x - turn * y) / long, (y + turn * x) / long
        nodes[count, 0] = east
        nodes[count, 1] = north
        count += 1
        if found >= _LEAST_CELLS:
            last = count
        if count > 1 and _is_used(east + x * STEP_M, north + y * STEP_M, cells):
            break
        east += x * STEP_M
        north += y * STEP_M
    return last


@kernel
def mark_kernel(nodes: Floats, cells: StripCells) -> None:
    """Mark the cells about a followed strip as used."""
    for node in range(len(nodes) - 1):
        x = nodes[node + 1, 0] - nodes[node, 0]
        y = nodes[node + 1, 1] - nodes[node, 1]
        long = np.sqrt(x * x + y * y)
        if long < 1e-6:
            continue
        for k in range(-1, int(long / FINE_M) + 2):
            for w in range(-_OWN_CELLS, _OWN_CELLS + 1):
                t, aside = k * FINE_M / long, w * FINE_M / long
                e = nodes[node, 0] + t * x - aside * y
                n = nodes[node, 1] + t * y + aside * x
                cell = cell_of(e, n, cells.table, FINE)
                if cell >= 0:
                    cells.used[cell] = 1


@kernel
def _value(values: NDArray[np.uint8], east: float, north: float, table: NDArray[np.int32]) -> int:
    cell = cell_of(east, north, table, FINE)
    return int(values[cell]) if cell >= 0 else 0


@kernel
def _is_used(east: float, north: float, cells: StripCells) -> bool:
    return _value(cells.used, east, north, cells.table) > 0


@kernel
def _fit(
    east: float, north: float, x: float, y: float, cells: StripCells
) -> tuple[int, float, float]:
    """Parts along a direction with raised cells beside a place, how far aside, and the turn."""
    parts = 0
    n = st = sw = stt = stw = 0.0
    for k in range(-_REACH_CELLS, _REACH_CELLS + 1):
        t, has = k * FINE_M, False
        for side in range(-_WIDE_CELLS, _WIDE_CELLS + 1):
            w = side * FINE_M
            cell = cell_of(east + t * x - w * y, north + t * y + w * x, cells.table, FINE)
            if cell >= 0 and cells.raised[cell]:
                has = True
                n += 1.0
                st += t
                sw += w
                stt += t * t
                stw += t * w
        parts += has
    if parts < _LEAST_CELLS:
        return parts, 0.0, 0.0
    spread = n * stt - st * st
    turn = (n * stw - st * sw) / spread if spread > 0.05 * n * n else 0.0
    return parts, (sw - turn * st) / n, 0.5 * turn


def unused(places: Floats, cells: StripCells) -> Integers:
    """Numbers of places that no strip passes."""
    return np.array(
        [
            number
            for number, (east, north) in enumerate(places.tolist())
            if not _is_used(east, north, cells)
        ],
        np.int64,
    )

"""SectionMesh: the mesh of neighbouring pixels as it grows row by row, its sections in order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.image.scan_lines.scanline_arrays import (
    CROSSING,
    PIXEL,
    ChainArrays,
    Crossings,
    MeshLimits,
    MeshRows,
    PointArrays,
    RowPair,
)
from processing.image.scan_lines.scanline_chains import chains_kernel, gather_kernel, kept_kernel
from processing.image.scan_lines.scanline_kernels import mesh_rows
from processing.image.scan_lines.scanline_rows import RowPoints

_ROOM, _MOST_ROOM = 1 << 13, 1 << 20
"""For crossings: so many for each section at first, and no more in all, 48 MB, before they are
needed. Room is doubled when it runs out, so no result depends on them."""

_ROW, _OLD, _COUNT = 0, 1, 2
"""Of the state: see `scanline_kernels`."""


@dataclass(frozen=True)
class SectionVertices:
    """Vertices of sections, section by section, each from left to right.

    Attributes
    ----------
    levels : (n,) int64
        The section of each vertex, by multiples of the spacing; not falling.
    across, height, time : (n,) float64
        Heights are about the origin of the pass.
    intensity : (n,) float32
    point : (n,) int64
    is_break : (n,) bool
    """

    levels: Integers
    across: Floats
    height: Floats
    time: Floats
    intensity: NDArray[np.float32]
    point: Integers
    is_break: NDArray[np.bool_]


class SectionMesh:
    """Takes rows in the order of time and gives the sections that no later row can reach.

    Parameters
    ----------
    width : int
        Columns of a row.
    band : MeshLimits
        What counts, and which sections are asked for.
    """

    def __init__(self, width: int, band: MeshLimits) -> None:
        self._band = band
        self._pixels = np.zeros((2, width), PIXEL)
        self._pixels["point"] = -1
        self._pixels["crossing"] = -1
        self._extents = np.zeros((2, 2), np.int64)
        self._state = np.zeros(4, np.int64)
        self._last_station = 0.0
        room = min(_ROOM * (band.last - band.first + 1), _MOST_ROOM)
        self._crossings: Crossings = np.empty(room, CROSSING)

    def add(self, points: RowPoints, stations: Floats) -> None:
        """Mesh some more rows.

        Parameters
        ----------
        stations : (k,) float64
            Of the vehicle at each row, m.
        """
        passed = np.concatenate([[self._last_station], stations])
        self._state[_ROW] = 0
        while True:
            mesh_rows(
                RowPair(self._pixels, self._extents),
                self._state,
                points.arrays,
                MeshRows(points.rows, passed),
                self._band,
                self._crossings,
            )
            if self._state[_ROW] == len(points.rows):
                break
            self._make_room()
        self._last_station = float(stations[-1])

    def finished(self, last_level: int) -> SectionVertices:
        """The sections up to one, which are given away; the mesh goes on without them."""
        count = int(self._state[_COUNT])
        held = self._crossings[:count]
        order = np.empty(count, np.int64)
        chains = np.empty((count + 1, 2), np.int64)
        found = chains_kernel(held, last_level, order, chains)
        vertices = _in_order(held, order, chains[: found + 1])
        moved = np.empty(count + 1, np.int64)
        self._state[_COUNT] = kept_kernel(self._crossings, count, last_level, moved)
        # An edge without crossings has the number that came next, which need not be there.
        moved[count] = self._state[_COUNT]
        bases = self._pixels["crossing"]
        bases[bases >= 0] = moved[bases[bases >= 0]]
        return vertices

    def _make_room(self) -> None:
        count = int(self._state[_COUNT])
        larger = np.empty(2 * self._crossings.size, CROSSING)
        larger[:count] = self._crossings[:count]
        self._crossings = larger


def _in_order(held: Crossings, order: Integers, chains: Integers) -> SectionVertices:
    starts, levels = chains[:-1, 0], chains[:-1, 1]
    ranks = np.lexsort((held["across"][order[starts]], levels))
    ends = np.column_stack([starts, chains[1:, 0]])[ranks]
    count = int((ends[:, 1] - ends[:, 0]).sum())
    given = ChainArrays(
        np.empty(count, np.int64),
        np.empty(count),
        np.empty(count),
        np.empty(count),
        np.empty(count, np.float32),
        np.empty(count, np.int64),
        np.empty(count, np.bool_),
    )
    gather_kernel(held, order, ends, given)
    return SectionVertices(*given)


def warm_up() -> None:
    """Compile the kernels of the mesh and of its chains."""
    band = MeshLimits(9.0, 9.0, -9.0, 9.0, 0.5, -9, 9, 5.0)
    mesh = SectionMesh(4, band)
    pulses = np.array([0, 1, 10, 11])
    positions = np.array([[0.0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]])
    arrays = PointArrays(
        pulses,
        positions,
        positions,
        np.arange(4.0),
        np.zeros(4, np.uint16),
        np.zeros(4, np.bool_),
    )
    rows = np.array([[0, 2, 0, 0, 1], [2, 4, 0, 10, 0]])
    mesh.add(RowPoints(arrays, rows), np.array([0.0, 1.0]))
    mesh.finished(0)

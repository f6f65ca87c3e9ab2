"""What is known about points that may be noise where nothing tells the beams, only places.

Sizes and limits here shape what the trees are told (see :mod:`processing.methods.noise.combined`):
they learned with these values, so that a change asks for new training. They were set by trial, on
simulated scenes; no measurement varied one alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.noise.features.cell_kernels import AROUND
from processing.methods.noise.features.features import Candidates
from processing.methods.noise.features.local_spacing import local_spacings
from processing.methods.noise.features.surroundings import (
    PART_SIZES,
    PER_SCALE,
    SCALES,
    CloudNeighbourhood,
)
from processing.methods.noise.neighbours.morton import nested_cells
from processing.methods.noise.neighbours.sharing import share_out

_Flags = NDArray[np.bool_]
_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_FINEST_M = 0.02
"""Least spacing: closer points of several passes are as far apart as a scanner measures."""

_CURVE_CELLS = 2**20
"""Cells along an axis that the numbers of nested cells hold (20 binary digits)."""

_GROUND_BAND_M = 0.3
"""Height about the ground within which points of a plane are kept."""

_PLANE_SCALE = 1
"""Points of a plane are looked for in 27 cells of two spacings, each wide 2 ** scale spacings."""

_PLANE_POINTS = 24
"""More than so many of some 36 that a full plane holds there (six by six spacings)."""

_PLANE_SHARE = 0.4
"""Planarity from which points lie in a plane, 0 to 1."""

_PLANE_THICKNESS = 0.12
"""Of such a plane, in its cells of two spacings; a point may be twice as far from it."""

_OFF_PLANE_THICKNESSES = 2

_POINTS_AT_ONCE = 65_536
"""Points of a share of a core's work."""

_POINTS, _PLANARITY, _THICKNESS, _NORMAL, _DISTANCE = 0, 3, 4, 5, 8
"""Columns of ``CloudNeighbourhood.around``; the normal has three."""


@dataclass(frozen=True)
class SpaceSearch:
    """Points of a cloud that may be noise, before anything dear is asked.

    Attributes
    ----------
    order : (n,) int64
        The cloud's points along a curve through it. Everything else here counts them in this
        order, in which neighbours in space are neighbours in memory.
    is_sure : (n,) bool
        In the middle of a densely measured plane.
    around : CloudNeighbourhood
    points : (k,) int64
        Those that may be noise.
    """

    order: _Integers
    is_sure: _Flags
    around: CloudNeighbourhood
    points: _Integers

    def cheap_features(self, monitor: Monitor) -> NDArray[np.float32]:
        """(k, f): how points lie in the cells that show planes, connection, height."""
        around = self.around
        blocks = [
            around.scale_features(self.points, None, monitor, (_PLANE_SCALE,)),
            around.place_features(self.points),
        ]
        return np.concatenate(blocks, axis=1)

    def candidates(
        self, cheap: NDArray[np.float32], is_doubtful: _Flags, monitor: Monitor
    ) -> Candidates:
        """Everything about those of the points that remain doubtful, (k,) bool.

        ``cheap`` (k, f) are the cheap features.
        """
        around, points, cheap = self.around, self.points[is_doubtful], cheap[is_doubtful]
        levels = [around.level_of(size * around.middle_m) for size in PART_SIZES]
        finer, wider = range(_PLANE_SCALE), range(_PLANE_SCALE + 1, SCALES)
        blocks = [
            around.scale_features(points, None, monitor, finer),
            cheap[:, :PER_SCALE],
            around.scale_features(points, None, monitor, wider),
            cheap[:, PER_SCALE:],
            around.column_features(points),
            *(around.part_features(points, level) for level in levels),
            np.full((points.size, 1), self.is_sure.mean(), np.float32),
            around.ground.features(points),
        ]
        return Candidates(points, np.concatenate(blocks, axis=1), around, levels)


def search_in_space(xyz: _Floats, monitor: Monitor) -> SpaceSearch:
    """Set aside what lies in a plane near the ground.

    How many points lie on surfaces is a feature, too: in woods seen from the air, or in a
    single tree, leaves look like noise to whoever knows streets only.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, finite.
    """
    fine = nested_cells(xyz, float(np.ptp(xyz, axis=0).max(initial=0.0)) / _CURVE_CELLS)
    local_xyz = fine.local_xyz
    spacings = np.clip(local_spacings(fine), _FINEST_M, None)
    bare = CloudNeighbourhood.bare(local_xyz, spacings)
    is_sure = _planar_points(bare, monitor)
    around = bare.completed(local_xyz, is_sure)
    is_ground = np.abs(around.heights) < _GROUND_BAND_M
    points = np.flatnonzero(~(is_sure & around.is_main & is_ground))
    return SpaceSearch(fine.order, is_sure, around, points)


def _planar_points(around: CloudNeighbourhood, monitor: Monitor) -> _Flags:
    """Points in the middle of a densely measured plane, six spacings wide."""
    count = around.position.size
    found, everything = np.zeros(count, np.bool_), np.arange(count)
    levels = around.level_at(around.own_levels(everything), _PLANE_SCALE)
    held = around.cells_at(levels, everything)
    for level in np.unique(levels):
        chosen = np.flatnonzero(levels == level)
        found[chosen] = _planar_at(around, int(level), chosen, held[chosen], monitor)
    return found


def _planar_at(
    around: CloudNeighbourhood,
    level: int,
    points: _Integers,
    cells: NDArray[np.int32],
    monitor: Monitor,
) -> _Flags:
    """(k,): whether points, each in one of the ``cells`` of a level, lie in a plane."""
    rows, (of_points,) = around.around(level, [cells], monitor)
    positions, side = around.position[points], around.levels[level].side
    found = np.empty(points.size, np.bool_)

    def look(start: int, stop: int) -> None:
        part = slice(start, stop)
        xyz = around.cells.local_xyz
        planar_kernel(rows, of_points[part], xyz, positions[part], side, found[part])

    share_out(look, points.size, _POINTS_AT_ONCE, monitor)
    return found


@kernel
def planar_kernel(
    around: _Floats,
    rows: _Integers,
    local_xyz: _Floats,
    positions: _Integers,
    side: float,
    found: _Flags,
) -> None:
    """Whether points lie in the plane that the cells around theirs show.

    ``rows`` (k,) of ``around``, ``positions`` (k,) of ``local_xyz``; ``side`` of a cell, m.
    """
    for i in range(rows.size):
        mine, xyz = around[rows[i]], local_xyz[positions[i]]
        off = -mine[_DISTANCE]
        for axis in range(3):
            off += mine[_NORMAL + axis] * xyz[axis]
        found[i] = (
            mine[_POINTS] > _PLANE_POINTS
            and mine[_PLANARITY] > _PLANE_SHARE
            and mine[_THICKNESS] < _PLANE_THICKNESS
            and abs(off) < _OFF_PLANE_THICKNESSES * _PLANE_THICKNESS * side
        )


def warm_up() -> None:
    """Compile the kernel."""
    none = np.zeros(1, np.int64)
    planar_kernel(np.zeros((1, AROUND)), none, np.zeros((1, 3)), none, 1.0, np.empty(1, np.bool_))

"""SightLines: over what a standing scanner's beams went on, and how low.

Whatever a beam hit, there was nothing between it and the scanner. So ground that was not measured
lies below the lowest beam that passed over it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

Floats = NDArray[np.float64]

_SECTORS = 1440
"""A quarter of a degree each: 26 cm at 60 m, half a cell of a hole."""

_RING_M, _RINGS = 0.25, 400
"""Half a cell of a hole, up to 100 m from the scanner; beyond, beams are not asked."""

_NEAREST_M = 0.5
"""Points nearer than this are on the tripod."""


class _Ground(NamedTuple):
    """A floor as the kernel takes it: heights, and the side of its cells, m."""

    heights: Floats
    size_m: float


@dataclass(frozen=True)
class Floor:
    """Heights on cells that nothing which was measured lies below.

    Attributes
    ----------
    heights : (rows, columns) float64
        m, in the frame of the scanners; -inf where anything may be.
    size_m : float
    """

    heights: Floats
    size_m: float


@dataclass(frozen=True)
class SightLines:
    """The lowest beams of each position where a scanner stood.

    Attributes
    ----------
    stands : (k, 3) float64
        m, in one frame with the positions asked for.
    rises : (k, 1440, 400) float32
        Lowest rise, m per m, of the beams that went on beyond a ring of 0.25 m in a sector of a
        quarter of a degree; inf where none did.
    """

    stands: Floats
    rises: NDArray[np.float32]

    @staticmethod
    def without_beams(stands: Floats) -> SightLines:
        """Positions where a scanner stood, before anything was measured."""
        rises = np.full((len(stands), _SECTORS, _RINGS), np.inf, np.float32)
        return SightLines(stands, rises)

    def add(self, stand: int, xyz: Floats, origin: Floats, floor: Floor | None = None) -> None:
        """Take in points that were measured from one position.

        Parameters
        ----------
        xyz : (n, 3) float64
            m; NaN is passed over.
        origin : (3,) float64
            Of the frame in which the scanners' positions are, m.
        floor : Floor or None
            No beam went to what lies below it.
        """
        floor = floor or Floor(np.empty((0, 0)), 1.0)
        frame = (float(origin[0]), float(origin[1]), float(origin[2]))
        held = _Ground(floor.heights, floor.size_m)
        _rise_kernel(np.ascontiguousarray(xyz), frame, held, self.stands[stand], self.rises[stand])

    def finished(self) -> SightLines:
        """The same once all points are in: beams that went farther passed over what is nearer."""
        beyond = np.minimum.accumulate(self.rises[:, :, ::-1], axis=2)[:, :, ::-1]
        return SightLines(self.stands, np.ascontiguousarray(beyond))

    def highest_at(self, stand: int, xy: Floats) -> Floats:
        """How high unmeasured ground can be: (n,) float64, m; inf where no beam went on.

        Parameters
        ----------
        xy : (n, 2) float64
        """
        x, y = (xy - self.stands[stand, :2]).T
        away = np.hypot(x, y)
        sector = (np.arctan2(y, x) % (2 * np.pi) / (2 * np.pi) * _SECTORS).astype(np.int64)
        ring = (away / _RING_M).astype(np.int64) + 1
        seen = ring < _RINGS
        rises = np.full(len(xy), np.inf)
        rises[seen] = self.rises[stand, sector[seen] % _SECTORS, ring[seen]]
        highest: Floats = self.stands[stand, 2] + away * rises
        return highest


@kernel
def _rise_kernel(
    xyz: Floats,
    origin: tuple[float, float, float],
    ground: _Ground,
    stand: Floats,
    rises: NDArray[np.float32],
) -> None:
    floor, size_m = ground.heights, ground.size_m
    sectors, rings = rises.shape
    for point in range(xyz.shape[0]):
        east, north = xyz[point, 0] - origin[0], xyz[point, 1] - origin[1]
        up = xyz[point, 2] - origin[2]
        x, y = east - stand[0], north - stand[1]
        away = np.hypot(x, y)
        # NaN fails the test.
        if not (away > _NEAREST_M and away < rings * _RING_M):
            continue
        row, column = int(np.floor(north / size_m)), int(np.floor(east / size_m))
        is_in = row >= 0 and column >= 0 and row < floor.shape[0] and column < floor.shape[1]
        if is_in and not up >= floor[row, column]:
            continue
        turn = np.arctan2(y, x) / (2 * np.pi)
        sector = int((turn - np.floor(turn)) * sectors) % sectors
        ring = int(away / _RING_M)
        rises[sector, ring] = min(rises[sector, ring], (up - stand[2]) / away)


def warm_up() -> None:
    """Compile the kernel of this file."""
    lines = SightLines(np.zeros((1, 3)), np.zeros((1, 1, 1), np.float32))
    lines.add(0, np.ones((1, 3)), np.zeros(3))

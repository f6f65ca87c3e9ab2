"""Ground as a triangulated surface over nodes: the very surface that beams hit and volumes use."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape, grid


@dataclass(frozen=True)
class HeightGrid:
    """Heights on nodes; every cell is cut from its lower left to its upper right node.

    Attributes
    ----------
    z : (rows, columns) float32
        m; a row runs east, rows follow each other to the north. Single precision, as the truth's
        file has it: volumes and beams take just these values.
    res : float
        Between nodes, m. The first node is the site frame's origin (x east, y north).
    """

    z: NDArray[np.float32]
    res: float

    @property
    def size_m(self) -> tuple[float, float]:
        """Extent to the east and to the north."""
        return (self.z.shape[1] - 1) * self.res, (self.z.shape[0] - 1) * self.res

    @property
    def nodes(self) -> tuple[Floats, Floats]:
        """Places of the nodes: x (columns,) and y (rows,), m."""
        x: Floats = np.arange(self.z.shape[1], dtype=np.float64) * self.res
        y: Floats = np.arange(self.z.shape[0], dtype=np.float64) * self.res
        return x, y

    def height(self, x: ArrayLike, y: ArrayLike) -> Floats:
        """Height of the surface at places of the site's frame; outside, that of its edge."""
        column = np.clip(np.asarray(x, np.float64) / self.res, 0, self.z.shape[1] - 1)
        row = np.clip(np.asarray(y, np.float64) / self.res, 0, self.z.shape[0] - 1)
        i = np.minimum(column.astype(np.int64), self.z.shape[1] - 2)
        j = np.minimum(row.astype(np.int64), self.z.shape[0] - 2)
        east, north = column - i, row - j
        low, high = self.z[j, i].astype(np.float64), self.z[j + 1, i + 1].astype(np.float64)
        right, up = self.z[j, i + 1].astype(np.float64), self.z[j + 1, i].astype(np.float64)
        below = low + east * (right - low) + north * (high - right)
        above = low + north * (up - low) + east * (high - up)
        height: Floats = np.where(east >= north, below, above)
        return height

    def slope(self, x: ArrayLike, y: ArrayLike, over_m: float) -> tuple[Floats, Floats]:
        """Rise per metre to the east and to the north over a base of some metres."""
        x, y = np.asarray(x, np.float64), np.asarray(y, np.float64)
        east = self.height(x + over_m / 2, y) - self.height(x - over_m / 2, y)
        north = self.height(x, y + over_m / 2) - self.height(x, y - over_m / 2)
        return east / over_m, north / over_m

    def shape(self) -> TriangleShape:
        """Its triangles; number ``2 * cell`` is the lower right one of a cell."""
        x, y = self.nodes
        columns, rows = np.meshgrid(x, y)
        vertices, _ = grid(np.stack([columns, rows, self.z.astype(np.float64)], axis=-1))
        count, width = self.z.shape
        first = (np.arange(count - 1)[:, None] * width + np.arange(width - 1)).ravel()
        lower = np.column_stack([first, first + 1, first + width + 1])
        upper = np.column_stack([first, first + width + 1, first + width])
        return vertices, np.stack([lower, upper], axis=1).reshape(-1, 3)


def nodes_apart(length_m: float) -> float:
    """Distance between nodes of a site: coarser for a large one, so that memory stays bounded.

    A site of 100 m has a node every 0.1 m; larger ones have at most some 1.5 million triangles.
    """
    return 0.1 if length_m <= 100 else 0.25 if length_m <= 250 else 0.5

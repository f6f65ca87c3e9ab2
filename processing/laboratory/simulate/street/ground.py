"""The ground of a section: its surfaces from side to side, and how high they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats


@dataclass(frozen=True)
class Strip:
    """The surface between two lines of the ground: what it is, and the class of its points.

    Attributes
    ----------
    kind : str
        In a word: ``road``, ``curb``, ``walk``, ``apron``.
    has_surface : bool
        False where other bodies take its place (the lids of a gutter, an apron's
        blocks, an island).
    """

    kind: str
    material: Material
    label: int
    has_surface: bool = True


@dataclass(frozen=True)
class StreetGround:
    """Lines along the road, from right to left, and the strips between them.

    Attributes
    ----------
    nodes : (n,) float64
        Chainages, rising.
    offsets : (n, k) float64
        Of the lines at each node, m to the left of the centre, rising or equal (a face).
    heights : (n, k) float64
        z, m, the street's frame.
    strips : tuple of Strip
        k − 1 of them.
    """

    nodes: Floats
    offsets: Floats
    heights: Floats
    strips: tuple[Strip, ...]

    def height(self, chainage: ArrayLike, offset: ArrayLike) -> Floats:
        """Height of the ground, z in m; beyond its ends and sides that of the nearest line.

        Parameters
        ----------
        chainage, offset : (...) float64
            Broadcast against each other.

        Returns
        -------
        (...) float64
        """
        s, o = np.broadcast_arrays(np.asarray(chainage, np.float64), np.asarray(offset, np.float64))
        flat_s, flat_o = s.ravel(), o.ravel()
        at = np.clip(flat_s, self.nodes[0], self.nodes[-1])
        row = np.clip(np.searchsorted(self.nodes, at, "right") - 1, 0, self.nodes.size - 2)
        share = (at - self.nodes[row]) / (self.nodes[row + 1] - self.nodes[row])
        lines = self.offsets[row] + share[:, None] * (self.offsets[row + 1] - self.offsets[row])
        levels = self.heights[row] + share[:, None] * (self.heights[row + 1] - self.heights[row])
        position = np.clip((lines <= flat_o[:, None]).sum(axis=1) - 1, 0, lines.shape[1] - 2)
        each = np.arange(flat_s.size)
        low, high = lines[each, position], lines[each, position + 1]
        wide = np.maximum(high - low, 1e-9)
        across = np.clip((flat_o - low) / wide, 0.0, 1.0)
        first, second = levels[each, position], levels[each, position + 1]
        levels_there: Floats = first + across * (second - first)
        return levels_there.reshape(s.shape)

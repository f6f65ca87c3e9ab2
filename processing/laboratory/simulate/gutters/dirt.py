"""What lies on a covered gutter and in its holes: soil, leaves and grass that hide the lids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.gutters.beds import Bed
from processing.laboratory.simulate.gutters.lid_shapes import quads
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, grid
from processing.laboratory.simulate.scene.things import SectionBuilder

_ALONG_M, _ACROSS_M = 0.15, 0.08
_BESIDE_M = 0.12  # how far it spills beyond the bed
_KINDS = (
    ("soil", Material.SOIL, 2),
    ("litter", Material.LEAVES, 2),
    ("weeds", Material.GRASS, 3),
)


@dataclass(frozen=True)
class Heap:
    """A thin body on the gutter.

    Attributes
    ----------
    along, across : (r,), (c,) float64
        m along the lids' middle line, and from the bed's inner edge.
    thick : (r, c) float64
        Its height above the bed, m; negative where there is none.
    """

    along: Floats
    across: Floats
    thick: Floats

    def thickness_at(self, along: Floats, across: Floats) -> Floats:
        """Height above the bed at places, m; −1 outside."""
        row = np.clip(np.searchsorted(self.along, along) - 1, 0, self.along.size - 2)
        column = np.clip(np.searchsorted(self.across, across) - 1, 0, self.across.size - 2)
        u = (along - self.along[row]) / (self.along[row + 1] - self.along[row])
        v = (across - self.across[column]) / (self.across[column + 1] - self.across[column])
        low = self.thick[row, column] * (1 - v) + self.thick[row, column + 1] * v
        high = self.thick[row + 1, column] * (1 - v) + self.thick[row + 1, column + 1] * v
        is_inside = (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1)
        return np.where(is_inside, low * (1 - u) + high * u, -1.0)


def add_heaps(random: Generator, built: SectionBuilder, bed: Bed, arcs: Floats) -> list[Heap]:
    """Add soil, leaves and grass over some stretches of a bed.

    Parameters
    ----------
    arcs : (n,) float64
        m along the lids' middle line at the bed's nodes.
    """
    dirt = float(random.random()) ** 2
    heaps: list[Heap] = []
    at = float(random.exponential(12.0))
    while at < arcs[-1] - 0.5:
        long = float(min(random.uniform(0.5, 1.0 + 7.0 * dirt), arcs[-1] - at))
        if random.random() < 0.2 + 0.7 * dirt:
            heaps.append(_add_heap(random, built, bed, arcs, (at, long)))
        at += long + float(random.exponential(5.0 + 20.0 * (1 - dirt)))
    return heaps


def _add_heap(
    random: Generator, built: SectionBuilder, bed: Bed, arcs: Floats, stretch: tuple[float, float]
) -> Heap:
    kind, material, label = _KINDS[int(random.choice(3, p=[0.45, 0.25, 0.3]))]
    start, long = stretch
    wide = bed.least_width_m
    along = start + np.linspace(0, long, max(3, int(long / _ALONG_M) + 1))
    across = np.linspace(
        -_BESIDE_M, wide + _BESIDE_M, max(4, int((wide + 2 * _BESIDE_M) / _ACROSS_M) + 1)
    )
    # Dirt comes from behind or from the road: thickest at one edge, thin at its ends.
    edge = float(random.choice([0.0, wide]))
    reach = float(random.uniform(0.4, 1.2)) * wide
    falls = 1 - np.abs(across - edge) / reach
    ends = np.minimum(1.0, 4 * np.minimum(along - start, start + long - along) / long)
    noise = random.uniform(-0.9, 0.5, (along.size, across.size))
    noise[1:-1] = (noise[:-2] + noise[1:-1] + noise[2:]) / 2
    deepest = float(random.uniform(0.01, 0.06))
    thick = deepest * (ends[:, None] * (0.7 + falls[None, :]) / 1.7 + 0.5 * noise)
    thick[[0, -1]] = -0.01
    thick[:, [0, -1]] = -0.01
    thick = np.clip(thick, -0.01, 0.06)
    lines = np.stack([bed.line(float(one)) for one in across], axis=1)
    row = np.clip(np.searchsorted(arcs, along) - 1, 0, arcs.size - 2)
    share = ((along - arcs[row]) / (arcs[row + 1] - arcs[row]))[:, None, None]
    positions = lines[row] * (1 - share) + lines[row + 1] * share
    positions[..., 2] += thick
    vertices, triangles = grid(positions)
    stands = (thick.ravel()[triangles] > 0).any(axis=1)
    built.mesh.add((vertices, triangles[stands]), material, label, built.thing(kind))
    return Heap(along, across, thick)


def add_plugs(built: SectionBuilder, corners: Floats) -> None:
    """Add soil that fills holes.

    Parameters
    ----------
    corners : (n, 4, 3) float64
        Of each plug's level top, in order around it, m, the street's frame.
    """
    shape = corners.reshape(-1, 3), quads(len(corners))
    built.mesh.add(shape, Material.SOIL, 2, built.thing("soil"))

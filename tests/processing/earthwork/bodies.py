"""Surfaces and bodies of earth whose volumes are known by formula."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import Delaunay

from processing.earthwork.triangle_surface import TriangleSurface

Floats = NDArray[np.float64]
Height = Callable[[Floats, Floats], Floats]

SURVEYED = np.array([-36_000.0, -12_000.0, 40.0])
"""Coordinates as a survey has them."""


def surface_of(triangles: Sequence[ArrayLike], origin: ArrayLike = (0, 0, 0)) -> TriangleSurface:
    """Triangles given one by one."""
    xyz = np.asarray(triangles, np.float64).reshape(-1, 3) + np.asarray(origin, np.float64)
    return TriangleSurface(xyz, np.arange(len(xyz)).reshape(-1, 3))


def meshed(plan: Floats, height: Height, origin: ArrayLike = SURVEYED) -> TriangleSurface:
    """Delaunay triangles over places."""
    z = height(plan[:, 0], plan[:, 1]) + np.zeros(len(plan))
    xyz = np.column_stack([plan, z]) + np.asarray(origin, np.float64)
    return TriangleSurface(xyz, Delaunay(plan).simplices.astype(np.int64))


def scattered_surface(
    count: int, seed: int, height: Height, size_m: float = 20.0
) -> TriangleSurface:
    """Triangles over places scattered in a square whose corners are among them."""
    random = np.random.default_rng(seed)
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    return meshed(np.concatenate([corners, random.uniform(0, 1, (count, 2))]) * size_m, height)


def frustum(
    bottom_m: float, top_m: float, tall_m: float, sides: int, origin: ArrayLike = SURVEYED
) -> TriangleSurface:
    """A heap with regular bottom and top, given by the radii of their corners."""
    ways = np.arange(sides) * (2 * np.pi / sides)
    ring = np.column_stack([np.cos(ways), np.sin(ways), np.zeros(sides)])
    foot, crest = ring * bottom_m, ring * top_m + np.array([0.0, 0.0, tall_m])
    xyz = np.concatenate([foot, crest, [[0.0, 0.0, tall_m]]]) + np.asarray(origin, np.float64)
    one = np.arange(sides)
    other = (one + 1) % sides
    corners = np.concatenate(
        [
            np.column_stack([one, other, sides + other]),
            np.column_stack([one, sides + other, sides + one]),
            np.column_stack([sides + one, sides + other, np.full(sides, 2 * sides)]),
        ]
    )
    return TriangleSurface(xyz, corners)


def frustum_m3(bottom_m: float, top_m: float, tall_m: float, sides: int) -> float:
    """Volume of :func:`frustum`: h / 3 (A + a + sqrt(A a))."""
    bottom, top = (sides / 2 * r**2 * np.sin(2 * np.pi / sides) for r in (bottom_m, top_m))
    return float(tall_m / 3 * (bottom + top + np.sqrt(bottom * top)))

"""Surfaces and bodies of earth whose volumes are known by formula."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import Delaunay

from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface

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


EMBANKMENT_LONG_M, CREST_M, BATTER = 60.0, 6.0, 1.5
LOW_M, HIGH_M = 1.0, 5.0


def embankment_lines() -> list[Floats]:
    """Crests, toes and ends of an embankment along easting 0 to 60, that grows from 1 to 5 m.

    Its crest is 6 m wide and level across, its sides go 1.5 m out for each metre down.
    """
    half = CREST_M / 2
    lines = []
    for side in (-1.0, 1.0):
        for out, rises in ((0.0, 1.0), (1.0, 0.0)):
            line = [
                [along, side * (half + out * BATTER * tall), rises * tall]
                for along, tall in ((0.0, LOW_M), (EMBANKMENT_LONG_M, HIGH_M))
            ]
            lines.append(np.array(line))
    return [line + SURVEYED for line in lines]


def embankment_m3() -> float:
    """Volume of that embankment: the area w h + m h² of its sections, integrated."""
    areas = CREST_M * (LOW_M + HIGH_M) / 2
    areas += BATTER * (LOW_M**2 + LOW_M * HIGH_M + HIGH_M**2) / 3
    return EMBANKMENT_LONG_M * areas

"""A made-up embankment: its design, and ground measured on it that deviates as one likes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.surfaces.sides import EpochGround, GroundBlock

WEST, SOUTH, LEVEL = -12_380.0, -36_690.0, 20.0
TOP_M, LENGTH_M, TALL_M, GRADE = 20.0, 50.0, 4.0, 1 / 1.5
SLOPE_M = TALL_M / GRADE
Deviation = Callable[[NDArray[np.float64]], NDArray[np.float64]]


def embankment(
    *, berm_m: float = 0.0, length_m: float = LENGTH_M, top_m: float = TOP_M, parts: int = 10
) -> TriangleSurface:
    """A bank that runs north: toe, slope (with a berm at half its height), top, slope, toe.

    Its western toe is at ``WEST``; the toes are at the height ``LEVEL``.
    """
    half = SLOPE_M / 2
    offsets = [0.0, half, half + berm_m, 2 * half + berm_m]
    heights = [0.0, TALL_M / 2, TALL_M / 2, TALL_M]
    if not berm_m:
        offsets, heights = [0.0, 2 * half], [0.0, TALL_M]
    width = 2 * offsets[-1] + top_m
    profile = list(zip(offsets, heights, strict=True))
    profile += [(width - offset, height) for offset, height in reversed(profile)]
    stations = np.linspace(0.0, length_m, parts + 1)
    xyz = np.array(
        [
            (WEST + offset, SOUTH + station, LEVEL + height)
            for station in stations
            for offset, height in profile
        ]
    )
    across = len(profile)
    corners = []
    for row in range(parts):
        for column in range(across - 1):
            at = row * across + column
            corners += [(at, at + 1, at + across), (at + 1, at + across + 1, at + across)]
    return TriangleSurface(xyz, np.array(corners, np.int64), "design_road.xml")


def measured_on(
    design: TriangleSurface, deviation: Deviation, *, per_m2: float = 12.0, seed: int = 0
) -> EpochGround:
    """Ground points on a design, and somewhat beyond, where they lie at its toe.

    Parameters
    ----------
    deviation : callable
        From places (n, 2) to how much higher the ground was built there, m.
    """
    random = np.random.default_rng(seed)
    west, south, east, north = design.extent()
    count = round((east - west + 4) * (north - south + 4) * per_m2)
    xy = random.uniform((west - 2, south - 2), (east + 2, north + 2), (count, 2))
    heights = design.heights_at(xy)
    heights[np.isnan(heights)] = LEVEL
    xyz = np.column_stack([xy, heights + deviation(xy)])

    def blocks() -> list[GroundBlock]:
        half = len(xyz) // 2
        return [GroundBlock(xyz[:half], 1), GroundBlock(xyz[half:], 2)]

    stands = np.empty((0, 3))
    return EpochGround("after.laz", blocks, xyz.min(axis=0), xyz.max(axis=0), stands)

"""The classes that noise gets: below the ground, or elsewhere."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.methods.noise.features.ground_heights import ground_of, low_heights
from processing.methods.noise.tiles_of_space import POINTS_PER_PART, TiledCloud

LOW_NOISE, HIGH_NOISE = 7, 18
"""Classes, as LAS 1.4 numbers them."""

_POINTS_AT_ONCE = 4_000_000
"""Codes read at a time: 4 MB."""


def codes_by_height(heights: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Classes of noise by its height above the ground.

    Parameters
    ----------
    heights : (n,) float64
        m; NaN where no ground is known, which is noise elsewhere.

    Returns
    -------
    (n,) uint8
        7 or 18.
    """
    return np.where(heights < 0, LOW_NOISE, HIGH_NOISE).astype(np.uint8)


def part_noise_by_ground(
    cloud: TiledCloud,
    codes: NDArray[np.uint8],
    *,
    monitor: Monitor,
    points_per_part: int = POINTS_PER_PART,
) -> None:
    """Give the noise of a whole cloud its classes, by the ground that the other points show.

    Parameters
    ----------
    codes : (n,) uint8
        0 for points that are kept; any other becomes 7 or 18, in place.
    """
    grid = np.full(cloud.shape, np.nan)
    for part in cloud.parts(0.0, points_per_part):
        monitor.check()
        kept = part.own[codes[part.own] == 0]
        xyz = cloud.read(kept)
        xyz = xyz[np.isfinite(xyz).all(axis=1)]
        if xyz.size:
            cells, low = low_heights(xyz[:, 2], cloud.tiles_of(xyz))
            grid.ravel()[cells] = low
    ground = ground_of(grid).ravel()
    for start in range(0, cloud.count, _POINTS_AT_ONCE):
        monitor.check()
        noise = start + np.flatnonzero(codes[start : start + _POINTS_AT_ONCE])
        if noise.size:
            xyz = cloud.read(noise)
            codes[noise] = codes_by_height(xyz[:, 2] - ground[cloud.tiles_of(xyz)])

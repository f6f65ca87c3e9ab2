"""Grounds made of formulas, as scans of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from datetime import date

import numpy as np
from numpy.typing import NDArray

from processing.methods.earthwork.surfaces.sides import EpochGround, GroundBlock

Floats = NDArray[np.float64]

ORIGIN = np.array([-12_400.0, -36_700.0, 20.0])
"""Where survey coordinates are large."""


def scan_of(
    height: Callable[[Floats, Floats], Floats],
    *,
    name: str = "scan",
    size_m: tuple[float, float] = (20.0, 20.0),
    per_m2: float = 100.0,
    noise_m: float = 0.0,
    seed: int = 1,
    keep: Callable[[Floats, Floats], NDArray[np.bool_]] | None = None,
    shift_m: tuple[float, float, float] = (0.0, 0.0, 0.0),
    crs: str = "EPSG:6677",
    stands: Floats | None = None,
) -> EpochGround:
    """Points of a ground at random places, from the origin to the north-east."""
    chance = np.random.default_rng(seed)
    count = int(per_m2 * size_m[0] * size_m[1])
    x, y = (chance.uniform(0.0, side, count) for side in size_m)
    z = height(x, y) + noise_m * chance.normal(size=count)
    kept = np.ones(count, np.bool_) if keep is None else keep(x, y)
    xyz = np.column_stack([x, y, z])[kept] + ORIGIN + np.asarray(shift_m)

    def blocks() -> Iterator[GroundBlock]:
        for part in np.array_split(xyz, 3):
            yield GroundBlock(part, 0)

    positions = np.empty((0, 3)) if stands is None else stands + ORIGIN
    return EpochGround(
        name,
        blocks,
        xyz.min(axis=0),
        xyz.max(axis=0),
        positions,
        stations=tuple(range(len(positions)))[:1],
        measured=blocks,
        crs=crs,
        measured_on=date(2026, 4, 1),
    )


def flat(x: Floats, _y: Floats) -> Floats:
    """Level ground at the origin's height."""
    return np.zeros_like(x)


def rolling(x: Floats, y: Floats) -> Floats:
    """Ground with slopes in every direction."""
    return 0.6 * np.sin(x / 3.0) + 0.5 * np.cos(y / 4.0)

"""Lengths and areas of features, in metres, as a ledger states them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.map.feature import Position


def length_m(positions: Sequence[Position]) -> float:
    """Length of a line along its slope."""
    xyz = _about_first(positions)
    return float(np.linalg.norm(np.diff(xyz, axis=0), axis=1).sum())


def plan_length_m(positions: Sequence[Position]) -> float:
    """Length of a line seen from above."""
    xyz = _about_first(positions)
    return float(np.linalg.norm(np.diff(xyz[:, :2], axis=0), axis=1).sum())


def plan_area_m2(positions: Sequence[Position]) -> float:
    """Area of a ring seen from above; its first vertex is not repeated; never negative."""
    x, y = _about_first(positions)[:, :2].T
    return abs(float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())) / 2


def _about_first(
    positions: Sequence[Position],
) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """(n, 3) about the first vertex: products of plane coordinates would lose the millimetres."""
    xyz = np.array(positions, dtype=np.float64).reshape(-1, 3)
    return xyz - xyz[:1]

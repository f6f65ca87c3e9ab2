"""Stretches of an order of points in which profile follows profile along a way."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.recording.measurement_order.sweep_fit import normal_of_steps

WINDOW_POINTS = 2_000
"""Points from which a plane and a centre follow: two turns of a common scanner, some twenty
profiles of a slow one."""

_FARTHEST_ALONG_M = 1.0
"""Rows farther apart show no surface, so such a step along the way goes to another thing."""

_ASKEW = 0.1
"""Share of its length that such a step goes along the way: a long one across it does so already
where profiles turn with the vehicle."""

_OFF_PLANE = 0.15
"""Share of its length by which a step of a profile leaves the profile's plane: a vehicle moves on
by some millimetres while the beam moves by centimetres, and angles between planes are larger."""

_LEAST_IN_PLANE = 0.8
"""Share of steps that must stay in the plane: others cross from one profile to the next, or end at
edges that rounding moves. Orders by cell or by a coordinate keep under 0.6, real profiles over
0.9."""


def normals_of_order(xyz: Floats) -> tuple[NDArray[np.int64], Floats]:
    """Normals of the profiles, window after window.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, in order, about a local origin.

    Returns
    -------
    middles : (w,) int64
        Point in the middle of each window.
    normals : (w, 3) float64
        Unit length; each on the side of the one before.
    """
    starts = np.arange(0, max(xyz.shape[0] - WINDOW_POINTS, 0) + 1, WINDOW_POINTS)
    normals = np.zeros((starts.size, 3))
    before = np.array([0.0, 0.0, 1.0])
    for number, start in enumerate(starts):
        normal = normal_of_steps(xyz[start : start + WINDOW_POINTS])
        normal = before if normal is None else normal
        normals[number] = before = normal if normal @ before >= 0 else -normal
    return starts + WINDOW_POINTS // 2, normals


def cut_stretches(
    xyz: Floats, middles: NDArray[np.int64], normals: Floats
) -> list[tuple[int, int]]:
    """Start and stop of the stretches between jumps along the way, the longest first."""
    window = np.minimum(np.arange(xyz.shape[0] - 1) // WINDOW_POINTS, middles.size - 1)
    steps = np.diff(xyz, axis=0)
    along = np.abs(np.einsum("ij,ij->i", steps, normals[window]))
    is_askew = along > _ASKEW * np.linalg.norm(steps, axis=1)
    cuts = np.flatnonzero((along > _FARTHEST_ALONG_M) & is_askew) + 1
    edges = np.concatenate([[0], cuts, [xyz.shape[0]]])
    found = [(int(a), int(b)) for a, b in pairwise(edges)]
    return sorted(found, key=lambda one: one[0] - one[1])


def is_in_planes(xyz: Floats, normal: Floats, quantum_m: float) -> bool:
    """Whether points of a window that follow one another stay in planes of the normal."""
    steps = np.diff(xyz, axis=0)
    off = np.abs(steps @ normal)
    allowed = _OFF_PLANE * np.linalg.norm(steps, axis=1) + quantum_m
    return float(np.mean(off <= allowed)) >= _LEAST_IN_PLANE

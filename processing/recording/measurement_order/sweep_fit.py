"""SweepFit: plane, centre and angular step of a beam that swept a stretch of points in order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.recording.measurement_order.sweep_kernels import (
    NEAR_RAD,
    increments_kernel,
    refined_step_kernel,
    search_kernel,
)

_BEYOND_M, _FARTHEST_M = 6.0, 30.0
"""A scanner is searched for so far beyond the points of a stretch, and so far from their middle:
no vehicle carries it higher over the road it measures."""

_AT_EDGE_M = 0.5
"""A centre so near to the edge of what is searched is farther away: lines of a raster, or a scan
from the air, are explained the better the farther it is."""

_FIRST_GRID, _GRID = 21, 5
"""Places a side that are tried: at first over all, then in the cells about the best of them."""

_LEVELS, _NEAR_LEVELS = 8, 5
"""Grids from coarse to fine, each with half the cells of the one before: 3 m become 2 cm."""

_COARSE_POINTS = 800
"""Of a stretch, from which the first grid is judged: a few turns of any scanner."""

_NEAR_M = 0.5
"""A centre is no farther in its plane from where it is expected by the way it went before: what a
car changes in a tenth of a second."""

_ROUNDED = 4.0
"""Steps of so many quanta of the coordinates have half their weight: rounding turns them."""


@dataclass(frozen=True)
class SweepFit:
    """How the points of a stretch were swept.

    Attributes
    ----------
    normal : (3,) float64
        Of the planes of the profiles, unit length.
    centre : (3,) float64
        Of the beams, in the middle of the stretch, m.
    sense : float
        1 where angles grow from `right` to `up`.
    step_rad : float
        From pulse to pulse.
    coherence : float
        −1..1: how well increments are whole steps forward.
    following : float
        Share of points that the beam reached next after the point before.
    is_near : bool
        Whether the centre is inside of what was searched, not at its edge.
    """

    normal: Floats
    centre: Floats
    sense: float
    step_rad: float
    coherence: float
    following: float
    is_near: bool


def plane_axes(normal: Floats) -> tuple[Floats, Floats]:
    """Unit vectors to the right and up in the plane of a normal that is not upright."""
    up = np.array([0.0, 0.0, 1.0]) - normal * normal[2]
    length = float(np.linalg.norm(up))
    up = up / length if length > 1e-6 else np.array([1.0, 0.0, 0.0])
    return np.cross(normal, up), up


def normal_of_steps(xyz: Floats) -> Floats | None:
    """The direction in which steps from point to point go least; None without any step.

    Points of a profile follow one another in its plane.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, in order.
    """
    steps = np.diff(xyz, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    units = steps[lengths > 0] / lengths[lengths > 0, None]
    if units.shape[0] < 3:
        return None
    return np.asarray(np.linalg.eigh(units.T @ units)[1][:, 0])


def fit_sweep(
    xyz: Floats, quantum_m: float, step_rad: float = 0.0, near: SweepFit | None = None
) -> SweepFit | None:
    """The sweep that explains a stretch of points best; None where nothing can be told.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, in order, about a local origin.
    quantum_m : float
        What the coordinates are rounded to.
    step_rad : float
        From pulse to pulse; 0 where it is to be found.
    near : SweepFit, optional
        What is expected by the stretch before: the centre is searched for beside its centre.

    Notes
    -----
    1. The plane is that in which points follow one another.
    2. A beam that turns steadily goes forward by whole steps. The centre is where, seen from it,
       the increments of the angle are nearest to that; grids from coarse to fine find it.
    """
    normal = normal_of_steps(xyz)
    if normal is None:
        return None
    if near is not None and float(normal @ near.normal) < 0:
        normal = -normal
    middle = np.asarray(xyz.mean(axis=0))
    right, up = plane_axes(normal)
    plane = np.column_stack([(xyz - middle) @ right, (xyz - middle) @ up])
    squared = (np.diff(plane, axis=0) ** 2).sum(axis=1)
    weights = squared / (squared + (_ROUNDED * quantum_m) ** 2 + 1e-12)
    found = np.array([0.0, 0.0, 1.0, step_rad, -2.0])
    if near is None:
        low = np.maximum(plane.min(axis=0) - _BEYOND_M, -_FARTHEST_M)
        high = np.minimum(plane.max(axis=0) + _BEYOND_M, _FARTHEST_M)
        senses: tuple[float, ...] = (1.0, -1.0)
        levels, size = _LEVELS, _FIRST_GRID
    else:
        before = np.array([(near.centre - middle) @ right, (near.centre - middle) @ up])
        low, high = before - _NEAR_M, before + _NEAR_M
        senses, levels, size = (near.sense,), _NEAR_LEVELS, _GRID
    edges = low + _AT_EDGE_M, high - _AT_EDGE_M
    for level in range(levels):
        few = _COARSE_POINTS if level == 0 and near is None else len(plane)
        places = _grid(low, high, size, senses)
        search_kernel(plane[:few], weights[: few - 1], places, step_rad, found)
        found[4] = -2.0 if few < len(plane) else found[4]
        cell = (high - low) / (size - 1)
        low, high = found[:2] - cell, found[:2] + cell
        senses, size = (float(found[2]),), _GRID
    increments = np.empty(len(plane) - 1)
    increments_kernel(plane, found[0], found[1], found[2], increments)
    back = increments < -0.5 * found[3]
    following = float(np.mean((np.abs(increments) < NEAR_RAD) & ~back))
    centre = middle + right * found[0] + up * found[1]
    is_near = bool((found[:2] > edges[0]).all() and (found[:2] < edges[1]).all())
    sense, step, coherence = found[2:].tolist()
    step = refined_step_kernel(increments, weights, step) if step > 0 and not step_rad else step
    return SweepFit(normal, centre, sense, step, coherence, following, is_near)


def _grid(low: Floats, high: Floats, size: int, senses: tuple[float, ...]) -> Floats:
    """(places, 3): x, y and sense."""
    x, y = (np.linspace(a, b, size) for a, b in zip(low, high, strict=True))
    places = np.array(np.meshgrid(x, y, np.array(senses), indexing="ij"))
    return np.asarray(places.reshape(3, -1).T.copy())

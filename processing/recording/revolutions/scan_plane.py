"""The plane in which a line scanner's beams turn, and the angle of a point in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats

_ROUNDS = 8
"""Of the robust fit. By trial; no measurement is recorded."""

_TRIED_PLANES = 200
"""Planes through three points each: with half of the points on the plane (1/2)³ of them are good,
so that one in 10¹¹ searches finds none."""

_CLEAR_MISS = 0.1
"""As a share of the distance: a point farther off counts no more. By trial; no measurement is
recorded."""

_NEAREST_M = 0.5
"""Nearer points weigh no more than one at this distance, m: weights go with 1 / distance². By
trial; no measurement is recorded."""

_MISSES = 3.0
"""Points off the plane by more than so many times the median (two standard deviations of normal
noise) weigh less."""

_LEAST_MISS_M = 1e-3
"""Limit of what weighs less, where the median is less: coordinates are delivered in millimetres."""

_REFERENCE_WEIGHT = 1e-6
"""Of the reference beside all points: it decides only what they leave open."""

_SAMPLE_POINTS = 500
"""Points by which the planes through three are compared, for the time."""

_LEAST_AREA_M2 = 1e-6
"""Twice the area of a triangle: below it the three points lie on a line."""

_LEAST_SINE = 0.3
"""Of the angle between the plane and the level, from which a direction in it is down: 17°. By
trial; no measurement is recorded."""

_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class ScanPlane:
    """A plane with axes.

    Attributes
    ----------
    axes : (2, 3) float64
        Unit vectors in the plane; the first points as far down as the plane allows.
    normal : (3,) float64
        The spin axis.
    flatness : float
        Median distance of points from the plane, as a share of their median distance from each
        other's middle.
    knows_down : bool
        False for a plane so level that no direction in it is down.
    """

    axes: Floats
    normal: Floats
    flatness: float
    knows_down: bool

    def project(self, positions: Floats) -> Floats:
        """(n, 3) to (n, 2) coordinates in the plane, m."""
        flat: Floats = positions @ self.axes.T
        return flat


def find_plane(positions: Floats, along: Floats, *, reference: Floats | None = None) -> ScanPlane:
    """The plane of points that may move steadily along its normal.

    Parameters
    ----------
    positions : (n, 3) float64
    along : (n, k) float64
        What the plane may shift with, one column each: the constant, and time if it moves.
    reference : (3,) float64, optional
        A position near the plane, which decides where points on a line leave the plane open.

    Notes
    -----
    1. Of many planes through three points, the one that most points lie on is the start: least
       squares alone would take a wide road for the plane.
    2. Least squares with points weighted by 1 / distance², so that far ones don't rule, trimmed and
       repeated.
    """
    distance = np.maximum(
        np.linalg.norm(positions - np.median(positions, axis=0), axis=1), _NEAREST_M
    )
    centred = positions - along @ np.linalg.lstsq(along, positions)[0]
    normal = _normal_of_most(centred, distance)
    offset = centred @ normal
    miss = np.abs(offset - np.median(offset))
    for _ in range(_ROUNDS):
        limit = max(_MISSES * float(np.median(miss)), _LEAST_MISS_M)
        weight = np.where(miss < limit, 1.0, (limit / np.maximum(miss, 1e-12)) ** 2) / distance**2
        trend = np.linalg.lstsq(
            (along * weight[:, None]).T @ along, (along * weight[:, None]).T @ positions
        )[0]
        centred = positions - along @ trend
        moments = (centred * weight[:, None]).T @ centred
        if reference is not None:
            aside = reference - trend[0]
            moments += _REFERENCE_WEIGHT * float(weight.sum()) * np.outer(aside, aside)
        normal = np.linalg.eigh(moments)[1][:, 0]
        miss = np.abs(centred @ normal)
    normal = normal if normal[np.argmax(np.abs(normal))] > 0 else -normal
    return _with_axes(normal, float(np.median(miss / distance)))


def _normal_of_most(centred: Floats, distance: Floats) -> Floats:
    random = np.random.default_rng(0)
    every = max(1, centred.shape[0] // _SAMPLE_POINTS)
    some, reach = centred[::every], distance[::every]
    corners = some[random.integers(0, some.shape[0], (_TRIED_PLANES, 3))]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1)
    is_wide = length > _LEAST_AREA_M2
    normals = normals[is_wide] / length[is_wide, None]
    if normals.shape[0] == 0:
        return _UP
    offsets = some @ normals.T
    misses = np.abs(offsets - np.median(offsets, axis=0)) / reach[:, None]
    best: Floats = normals[np.argmin(np.minimum(misses, _CLEAR_MISS).mean(axis=0))]
    return best


def _with_axes(normal: Floats, flatness: float) -> ScanPlane:
    down = -_UP + normal * normal[2]
    steep = float(np.linalg.norm(down))
    knows_down = steep > _LEAST_SINE
    if not knows_down:
        down = np.cross(normal, [0.0, 1.0, 0.0])
        steep = float(np.linalg.norm(down))
    first = down / steep
    return ScanPlane(np.stack([first, np.cross(normal, first)]), normal, flatness, knows_down)

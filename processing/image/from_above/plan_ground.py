"""The road's height along a drive, from which one tells what stands above it."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats
from processing.image.images_of_drives import image_of
from processing.image.search.nearest import nearest_point
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind

_POINTS_A_ROW = 8
"""Points below the vehicle that stand for a row: their median passes over a single stray. By trial;
no measurement is recorded."""

_MOST_ROWS = 4_000
"""Rows that are asked, over a whole drive: one every 2.5 m of 10 km, read in a moment."""

_BESIDE_M = 3.0
"""What lies so near to the vehicle's path in plan is road: a lane."""

_SMOOTHED = 9
"""Rows of a running median: a parked car beside the path stands out of it. By trial; no measurement
is recorded."""

_SAMPLES = 24
"""Places along a path at which its height above the ground is asked; their median counts."""

_USUAL_DROP_M = 2.0
"""Of a vehicle's reference point above the road, where nothing was measured below it: on a car's
roof."""

_FARTHEST_M = 100.0
"""Farther from the path no height of the ground is known, and nothing is cut off above it."""


def ground_along(drive: Drive) -> Floats:
    """Places of the road below the vehicle.

    With revolutions they are the points with which rows begin: the laser looked straight down
    there. Without, the height of the trajectory above the points below it is taken from some
    samples.

    Returns
    -------
    (m, 3) float64
        Easting, northing and the road's height, m, project CRS; empty without trajectory.
    """
    trajectory = drive.trajectory
    if trajectory is None or drive.count == 0 or not len(trajectory.xyz):
        return np.empty((0, 3))
    if drive.revolutions is not None:
        found = _below_rows(drive, trajectory.xyz)
        if len(found):
            return found
    return _below_samples(drive, trajectory.xyz)


def ceilings_above(ground: Floats, positions: Floats, limit_m: float) -> Floats:
    """Heights up to which points are shown.

    Parameters
    ----------
    ground : (m, 3) float64
        The road's places; not empty.
    positions : (..., 2) float64
        Easting and northing.
    limit_m : float
        Above the nearest place of the road.

    Returns
    -------
    (...) float64
        m, project CRS; infinite further than 100 m from the road.
    """
    from scipy.spatial import cKDTree

    beside_m, nearest = cKDTree(ground[:, :2]).query(positions)
    ceilings: Floats = np.where(beside_m <= _FARTHEST_M, ground[nearest, 2] + limit_m, np.inf)
    return ceilings


def _below_rows(drive: Drive, vehicle_path: Floats) -> Floats:
    image = image_of(drive, ImageKind.TRAJECTORY_CENTER)
    filled = np.flatnonzero(np.diff(image.row_starts) >= _POINTS_A_ROW)
    rows = filled[:: max(1, len(filled) // _MOST_ROWS)]
    points = image.row_starts[rows][:, None] + np.arange(_POINTS_A_ROW)
    positions = np.median(drive.xyz(points.ravel()).reshape(*points.shape, 3), axis=1)
    # Where nothing came back from below the vehicle a row begins with something else.
    from scipy.spatial import cKDTree

    beside_m, nearest = cKDTree(vehicle_path[:, :2]).query(positions[:, :2])
    is_below = (beside_m <= _BESIDE_M) & (positions[:, 2] < vehicle_path[nearest, 2])
    return _smooth_heights(positions[is_below])


def _smooth_heights(positions: Floats) -> Floats:
    """Heights as medians of neighbours: a car below the beam is no road."""
    if len(positions) < _SMOOTHED:
        return positions
    padded = np.pad(positions[:, 2], _SMOOTHED // 2, mode="edge")
    heights = np.median(np.lib.stride_tricks.sliding_window_view(padded, _SMOOTHED), axis=1)
    return np.column_stack([positions[:, :2], heights])


def _below_samples(drive: Drive, vehicle_path: Floats) -> Floats:
    low, high = np.array(drive.info.lowest), np.array(drive.info.highest)
    inside = vehicle_path[((vehicle_path >= low) & (vehicle_path <= high))[:, :2].all(axis=1)]
    if not len(inside):
        return np.empty((0, 3))
    chosen = np.linspace(0, len(inside) - 1, min(_SAMPLES, len(inside))).astype(np.int64)
    drops = []
    for position in inside[chosen]:
        point = nearest_point(drive, position - [0.0, 0.0, _USUAL_DROP_M], _BESIDE_M)
        if point >= 0:
            drops.append(float(position[2] - drive.xyz(np.array([point]))[0, 2]))
    drop_m = float(np.median(drops)) if drops else _USUAL_DROP_M
    return inside - [0.0, 0.0, drop_m]

"""Working planes: level through the cursor, or fitted to measured points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.image.images_of_drives import image_of
from processing.map.feature import PointReference
from processing.recording.drive import Drive
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState
from widgets.shared.snap_state import WorkingPlane

_NEAR_M = 1.0
_MOST_POINTS = 200_000
_FLATTEST = 1e-6
_STEEPEST_UP = 0.05


def level_plane(shared: SharedState) -> WorkingPlane | None:
    """A level plane at the cursor's height; None before anything was clicked."""
    position = shared.cursor.position
    return None if position is None else WorkingPlane(position.xyz)


def plane_of_points(source: MapSource, shared: SharedState) -> WorkingPlane | None:
    """A plane fitted to the chosen points, or to those near the cursor.

    Returns
    -------
    WorkingPlane or None
        None where the points are fewer than three, lie in one line or on a wall.
    """
    parts = [
        source.drive(drive).xyz(points[:: max(1, points.size // _MOST_POINTS)])
        for drive, points in shared.selection.points.items()
    ]
    position = shared.cursor.position
    if not parts and position is not None and position.measured is not None:
        parts = [_points_near(source.drive(position.measured.drive), position.measured)]
    return _fit_plane(np.concatenate(parts)) if parts else None


def _points_near(drive: Drive, at: PointReference) -> NDArray[np.float64]:
    """(n, 3): measured points within a metre, found by the rows of the image about the point."""
    image = image_of(drive, drive.pixel_kind)
    middle = drive.xyz(np.array([at.point]))[0]
    row = int(image.pixel_of(np.array([at.point]))[0][0])
    found: list[NDArray[np.float64]] = []
    for step in (1, -1):
        at_row = row if step > 0 else row - 1
        while 0 <= at_row < image.rows:
            xyz = drive.xyz(slice(int(image.row_starts[at_row]), int(image.row_starts[at_row + 1])))
            near = xyz[np.linalg.norm(xyz - middle, axis=1) <= _NEAR_M]
            if not near.size:
                break
            found.append(near)
            at_row += step
    return np.concatenate(found) if found else np.empty((0, 3))


def _fit_plane(xyz: NDArray[np.float64]) -> WorkingPlane | None:
    if len(xyz) < 3:
        return None
    middle = xyz.mean(axis=0)
    _, spread, axes = np.linalg.svd(xyz - middle, full_matrices=False)
    normal = axes[2] * (1.0 if axes[2, 2] >= 0 else -1.0)
    if spread[1] < _FLATTEST * max(spread[0], 1.0) or normal[2] < _STEEPEST_UP:
        return None
    x, y, z = middle.tolist()
    east, north, up = normal.tolist()
    return WorkingPlane((x, y, z), (east, north, up))

"""All measured points inside an outline on the map, whatever lies above or below them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.image.from_above.plan_ground import ceilings_above
from processing.image.images_of_drives import image_of
from processing.image.search.enclosed_points import Sight, points_enclosed
from processing.recording.columns.counted_classes import seen_points
from widgets.map_view.plan_feed import ShownPlan


def points_below(
    shown: ShownPlan, outline: Floats, px_per_m: float
) -> dict[str, NDArray[np.int64]]:
    """The points of an outline, hidden ones too, but for those above the map's limit and noise.

    For any thread; takes about as long as the points of the rows it touches.

    Parameters
    ----------
    shown : ShownPlan
        The picture that it was drawn on.
    outline : (k, 2) float64
        Corners on the plane of the map: easting and negative northing, m.
    px_per_m : float
        How large the map was when it was drawn.

    Returns
    -------
    dict of str to (n,) int64
        Drive id to rising indices; noise is left out where it is hidden.
    """
    request = shown.request
    origin = np.array([request.origin[0], request.origin[1], 0.0])
    matrix = np.array([[px_per_m, 0, 0, 0], [0, -px_per_m, 0, 0], [0, 0, 0, 1]], np.float64)
    corners = (outline - origin[:2] * (1.0, -1.0)) * px_per_m
    found = {}
    for drive, kind in request.drives:
        image = image_of(drive, kind)
        if not image.pyramid.is_ready:
            continue
        points = points_enclosed(drive, image, Sight(matrix, origin, 0.0), corners)
        points = seen_points(drive.columns, points, hides_noise=request.look.hides_noise)
        if request.limit_m is not None and len(shown.ground) and points.size:
            xyz = drive.xyz(points)
            points = points[xyz[:, 2] <= ceilings_above(shown.ground, xyz[:, :2], request.limit_m)]
        if points.size:
            found[drive.id] = points
    return found

"""Which measured point is under a pixel: tiles by their bounds, then all points of those tiles."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from processing.core.arrays import Floats
from processing.image.search.ray_hits import TOLERANCE_PX, RayHit, RayHits, RaySight
from processing.image.tiles.tile_descent import entry_depth
from widgets.scene_view.rendering.projection import NEAR_M, SceneProjection


def pick(entries: Floats, search: Callable[[int, RayHits], None], sight: RaySight) -> RayHit | None:
    """The front-most measured point under a pixel; see `processing.image.search.ray_hits`.

    Parameters
    ----------
    entries : (n,) float64
        Where the cone about the pixel enters tiles, metres in front of the camera; infinite where
        it misses them.
    search : callable
        Given a tile's number, looks through its points.
    """
    hits = RayHits(sight)
    near = np.flatnonzero(np.isfinite(entries))
    for number in near[np.argsort(entries[near], kind="stable")].tolist():
        # Nothing in the tiles that follow can lie in front of what was hit already.
        if entries[number] > hits.front_m:
            break
        search(number, hits)
    return hits.best()


def sight_at(projection: SceneProjection, origin: Floats, x: float, y: float) -> RaySight:
    """What is seen at a pixel of the widget.

    Parameters
    ----------
    origin : (3,) float64
        The view's, m, project CRS.
    """
    nearest = -np.inf if projection.camera.is_parallel else NEAR_M
    return RaySight(projection.matrix_with_depth, origin, nearest, (x, y))


def ray_at(projection: SceneProjection, origin: Floats, x: float, y: float) -> Floats:
    """(9,): the cone within reach of a pixel; see :mod:`processing.image.tiles.tile_descent`.

    Without perspective it is a tube, which begins far behind the camera.
    """
    reach = TOLERANCE_PX / projection.point_px
    cone = (reach, 0.0, -np.inf) if projection.camera.is_parallel else (0.0, reach, 0.0)
    return np.array([*(projection.eye(x, y) + origin), *projection.ray(x, y), *cone])


def entry_depths(low: Floats, high: Floats, ray: Floats) -> Floats:
    """Where a cone enters boxes, (n, 3) float64 corners: (n,) m; infinite where it misses one."""
    return np.array([entry_depth(box, ray) for box in np.column_stack([low, high])])

"""Which measured point is under a pixel: tiles by their bounds, then all points of those tiles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from widgets.scene_view.projection import Projection

Floats = NDArray[np.float64]
TOLERANCE_PX = 6.0
_CLOSE_PX = 2.0
_MOST_TILES = 64
_SAME_SURFACE = 0.02


@dataclass(frozen=True)
class TilePoints:
    """The points of a tile that may be hit.

    Attributes
    ----------
    points : (n,) int64
        Indices in the drive.
    local_xyz : (n, 3) float32
        Metres from the view's origin.
    """

    drive_id: str
    points: NDArray[np.int64]
    local_xyz: NDArray[np.float32]


@dataclass(frozen=True)
class Pickable:
    """Tiles by their bounds; points are asked for only where the ray comes near.

    Attributes
    ----------
    low, high : (n, 3) float64
        Bounds, metres from the view's origin.
    points_of : callable
        From a tile's number to its points.
    """

    low: Floats
    high: Floats
    points_of: Callable[[int], TilePoints]


@dataclass(frozen=True)
class Picked:
    """A measured point that was hit.

    Attributes
    ----------
    depth_m : float
        In front of the camera.
    offset_px : float
        From the pixel that was asked for.
    """

    drive_id: str
    point: int
    depth_m: float
    offset_px: float


def pick(tiles: Pickable, projection: Projection, x: float, y: float) -> Picked | None:
    """The front-most measured point under a pixel.

    A point is hit within 2 px; only where there is none, within 6 px. Among those on the surface
    that is in front, the one nearest to the pixel is taken.

    Parameters
    ----------
    x, y : float
        Pixel of the widget.
    """
    entries = entry_depths(tiles.low, tiles.high, projection, x, y)
    near = np.flatnonzero(np.isfinite(entries))
    found = _Found()
    for number in near[np.argsort(entries[near])][:_MOST_TILES].tolist():
        # Nothing in the tiles that follow can lie in front of what was hit already.
        if entries[number] > found.front_m:
            break
        found.search(tiles.points_of(number), projection, x, y)
    return found.best()


def entry_depths(low: Floats, high: Floats, projection: Projection, x: float, y: float) -> Floats:
    """Where the cone around a pixel enters boxes.

    Parameters
    ----------
    low, high : (n, 3) float64
        Metres from the view's origin.

    Returns
    -------
    (n,) float64
        Metres in front of the camera, 0 from inside, infinite where the cone misses the box.
        Without perspective the cone is a tube, which begins far behind the camera.
    """
    position, is_parallel = projection.eye(x, y), projection.camera.is_parallel
    reach = np.linalg.norm(np.maximum(np.abs(low - position), np.abs(high - position)), axis=1)
    reach = np.ones_like(reach) if is_parallel else reach
    margin = (reach * TOLERANCE_PX / projection.point_px)[:, None]
    direction = projection.ray(x, y)
    direction = np.where(np.abs(direction) < 1e-12, 1e-12, direction)
    first = (low - margin - position) / direction
    second = (high + margin - position) / direction
    enter = np.minimum(first, second).max(axis=1)
    leave = np.maximum(first, second).min(axis=1)
    if is_parallel:  # what lies behind the camera is seen as well
        return np.where(leave >= enter, enter, np.inf)
    is_hit = (leave >= enter) & (leave > 0)
    return np.where(is_hit, np.maximum(enter, 0.0), np.inf)


class _Found:
    """What was hit so far, in any tile."""

    def __init__(self) -> None:
        self.front_m = np.inf
        self._hits: list[tuple[str, NDArray[np.int64], Floats, Floats]] = []

    def search(self, tile: TilePoints, projection: Projection, x: float, y: float) -> None:
        near = _near_ray(tile.local_xyz, projection, x, y)
        pixels, depth = projection.to_screen(tile.local_xyz[near])
        offset = np.hypot(*(pixels - [x, y]).T)
        hit = np.flatnonzero(offset <= TOLERANCE_PX)  # NaN, behind the camera, isn't
        if not hit.size:
            return
        near, offset, depth = near[hit], offset[hit], depth[hit]
        self._hits.append((tile.drive_id, tile.points[near], depth, offset))
        close = depth[offset <= _CLOSE_PX]
        if close.size:
            self.front_m = min(self.front_m, _behind(float(close.min())))

    def best(self) -> Picked | None:
        if not self._hits:
            return None
        depth = np.concatenate([hit[2] for hit in self._hits])
        offset = np.concatenate([hit[3] for hit in self._hits])
        point = np.concatenate([hit[1] for hit in self._hits])
        hit_of = np.repeat(np.arange(len(self._hits)), [hit[1].size for hit in self._hits])
        within = offset <= _CLOSE_PX
        if not within.any():
            within = np.ones_like(within)
        surface = np.flatnonzero(within & (depth <= _behind(float(depth[within].min()))))
        chosen = int(surface[offset[surface].argmin()])
        return Picked(
            self._hits[hit_of[chosen]][0],
            int(point[chosen]),
            float(depth[chosen]),
            float(offset[chosen]),
        )


def _near_ray(
    local_xyz: NDArray[np.float32], projection: Projection, x: float, y: float
) -> NDArray[np.int64]:
    """Points that may be within reach: float32 and no roots, since a tile has many points."""
    right, up, forward = projection.camera.axes
    if projection.camera.is_parallel:
        offset = local_xyz - projection.eye(x, y).astype(np.float32)
        seen = np.stack([right, up]).astype(np.float32) @ offset.T
        tube = np.float32(1.05 * TOLERANCE_PX / projection.point_px + 1e-3)
        return np.flatnonzero((np.abs(seen) <= tube).all(axis=0))
    across = (x - projection.width_px / 2) / projection.focal_px
    upwards = (projection.height_px / 2 - y) / projection.focal_px
    # Distances from the ray's two planes, measured square to the forward axis.
    axes = np.stack([right - across * forward, up - upwards * forward, forward])
    seen = (
        axes.astype(np.float32)
        @ (local_xyz - np.array(projection.camera.position, dtype=np.float32)).T
    )
    reach = np.float32(1.05 * TOLERANCE_PX / projection.focal_px) * seen[2] + np.float32(1e-3)
    return np.flatnonzero((np.abs(seen[0]) <= reach) & (np.abs(seen[1]) <= reach))


def _behind(depth_m: float) -> float:
    """How far behind its front-most point a surface still is the same one."""
    return depth_m + max(0.1, _SAME_SURFACE * depth_m)

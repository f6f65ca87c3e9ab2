"""RayHits: the measured point that one sees at a pixel, among any number of points.

Every point is looked at as it was delivered, not a stand-in; of those near the ray only the few
are kept that may be the one in the end.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.image.point_image import PointCloudImage
from processing.image.search.clip import Clip
from processing.image.tiles.tiles import TileKey
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive

TOLERANCE_PX = 6.0
"""How near to a pixel a point must be drawn to be meant: about what a hand misses by. By trial; no
measurement is recorded."""

CLOSE_PX = 2.0
"""Points so near are preferred, and hide what lies behind: a drawn point is 2 to 4 pixels wide. By
trial; no measurement is recorded."""

_DEPTH, _OFFSET, _POINT, _CLOUD = range(4)
"""Columns of what is found: depth, m; offset, px; index of the point; number of its cloud."""

_SURFACE_M = 0.1
"""So far behind its front-most point a surface still is the same one: what scatters on rough ground
and grass. By trial; no measurement is recorded."""

_SURFACE_SHARE = 0.02
"""The same as a share of the depth, where points lie farther apart. By trial; no measurement is
recorded."""


class HitLimits(NamedTuple):
    """What counts as a hit.

    Attributes
    ----------
    x, y : float
        The pixel.
    nearest : float
        What has a smaller w isn't seen.
    tolerance_px, close_px : float
        How near to the pixel points must be, and from where on they hide others.
    front_m : float
        Depth of the deepest point that counts.
    surface_m, surface_share : float
        How thick a surface is: at least, and as a share of the depth.
    """

    x: float
    y: float
    nearest: float
    tolerance_px: float
    close_px: float
    front_m: float
    surface_m: float
    surface_share: float


@dataclass(frozen=True, eq=False)
class RaySight:
    """What is seen at a pixel.

    Attributes
    ----------
    matrix : (4, 4) float64
        From metres about the origin, and 1, to x·w, y·w, w and the depth in metres: pixels times
        what they are divided by, which is the depth in perspective and 1 without.
    origin : (3,) float64
        m, project CRS.
    nearest : float
        What has a smaller w isn't seen.
    pixel : tuple of float
    """

    matrix: Floats
    origin: Floats
    nearest: float
    pixel: tuple[float, float]


@dataclass(frozen=True)
class RayHit:
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


class RayHits:
    """What was hit so far, in any cloud.

    A point is hit within 2 px; only where there is none, within 6 px. Among those on the surface
    that is in front, the one nearest to the pixel is taken: a surface is as thick as 0.1 m, and
    far away as 2 % of the distance.

    Attributes
    ----------
    front_m : float
        Nothing that is deeper can be taken any more.
    """

    def __init__(self, sight: RaySight) -> None:
        self.front_m = np.inf
        self._sight = sight
        self._clouds: list[str] = []
        # What is deeper is nearer to the pixel: all else is never taken.
        self._kept: Floats = np.empty((0, 4))

    def search_tile(
        self,
        drive: Drive,
        image: PointCloudImage,
        key: TileKey,
        clip: Clip | None,
        *,
        hides_noise: bool = False,
    ) -> None:
        """Look through all points of the recording in the area of a tile.

        Parameters
        ----------
        clip : Clip or None
            Points outside don't count.
        hides_noise : bool
            Points whose class is noise don't either.
        """
        rows, columns = image.pyramid.rows_columns(key)
        window = np.array([[rows.start, rows.stop, columns.start, columns.stop]])
        stretches = image.stretches_in(window)
        room = int((stretches[:, 1] - stretches[:, 0]).sum())
        part = drive.coordinates.stretched(stretches)
        matrix = drive.coordinates.quantisation.of_integers(self._sight.matrix, self._sight.origin)
        found = np.empty((room, 4))
        limits = self._limits(is_clipped=clip is not None or hides_noise)
        count = hits_kernel(part.integers, part.stretches, matrix, limits, found)
        found = found[:count]
        found[:, _POINT] = part.points(found[:, _POINT].astype(np.int64))
        if clip is not None:
            points = found[:, _POINT].astype(np.int64)
            found = found[clip.holds(drive.xyz(points))]
        if hides_noise and len(found):
            points = found[:, _POINT].astype(np.int64)
            found = found[~class_columns(drive.columns).are_noise(points)]
        self._keep(drive.id, found)

    def search_cloud(self, drive_id: str, points: Integers, local_xyz: NDArray[np.float32]) -> None:
        """Look through places in memory.

        Parameters
        ----------
        points : (n,) int64
            Their indices in the drive.
        local_xyz : (n, 3) float32
            Metres from the sight's origin.
        """
        found = np.empty((points.size, 4))
        whole = np.array([[0, points.size]])
        limits = self._limits(is_clipped=False)
        count = hits_kernel(local_xyz, whole, self._sight.matrix, limits, found)
        found = found[:count]
        found[:, _POINT] = points[found[:, _POINT].astype(np.int64)]
        self._keep(drive_id, found)

    def best(self) -> RayHit | None:
        """The point that is seen; None where nothing was near."""
        kept = self._kept
        if not len(kept):
            return None
        close = kept[kept[:, _OFFSET] <= CLOSE_PX]
        within = close if len(close) else kept
        surface = within[within[:, _DEPTH] <= _behind(float(within[0, _DEPTH]))]
        depth, offset, point, cloud = surface[-1].tolist()
        return RayHit(self._clouds[int(cloud)], int(point), depth, offset)

    def _keep(self, drive_id: str, found: Floats) -> None:
        if not len(found):
            return
        found[:, _CLOUD] = len(self._clouds)
        self._clouds.append(drive_id)
        kept = np.empty((len(self._kept) + len(found), 4))
        kept[: len(self._kept)] = self._kept
        self._kept = kept[: merge_kernel(found, kept, len(self._kept))].copy()
        close = self._kept[self._kept[:, _OFFSET] <= CLOSE_PX]
        if len(close):
            self.front_m = _behind(float(close[0, _DEPTH]))

    def _limits(self, *, is_clipped: bool) -> HitLimits:
        # What is clipped off must not hide what lies behind.
        close_px = -1.0 if is_clipped else CLOSE_PX
        x, y = self._sight.pixel
        return HitLimits(
            float(x),
            float(y),
            float(self._sight.nearest),
            TOLERANCE_PX,
            close_px,
            float(self.front_m),
            _SURFACE_M,
            _SURFACE_SHARE,
        )


def _behind(depth_m: float) -> float:
    """How far behind its front-most point a surface still is the same one."""
    return depth_m + max(_SURFACE_M, _SURFACE_SHARE * depth_m)


@kernel
def hits_kernel(
    xyz: NDArray[np.int32] | NDArray[np.float32],
    stretches: NDArray[np.int64],
    matrix: NDArray[np.float64],
    limits: HitLimits,
    found: NDArray[np.float64],
) -> int:
    """Points of stretches of a recording, or of places in memory, near a pixel; says how many.

    Each close point brings the deepest that counts nearer. ``found``: depth, offset, point.
    """
    x, y, nearest, tolerance = limits.x, limits.y, limits.nearest, limits.tolerance_px
    front, count = limits.front_m, 0
    for k in range(stretches.shape[0]):
        for i in range(stretches[k, 0], stretches[k, 1]):
            a, b, c = float(xyz[i, 0]), float(xyz[i, 1]), float(xyz[i, 2])
            w = matrix[2, 0] * a + matrix[2, 1] * b + matrix[2, 2] * c + matrix[2, 3]
            if w <= nearest:
                continue
            across = matrix[0, 0] * a + matrix[0, 1] * b + matrix[0, 2] * c + matrix[0, 3] - x * w
            if abs(across) > tolerance * w:
                continue
            down = matrix[1, 0] * a + matrix[1, 1] * b + matrix[1, 2] * c + matrix[1, 3] - y * w
            if abs(down) > tolerance * w:
                continue
            offset = np.sqrt(across * across + down * down) / w
            depth = matrix[3, 0] * a + matrix[3, 1] * b + matrix[3, 2] * c + matrix[3, 3]
            if offset <= tolerance and depth <= front:
                found[count, _DEPTH], found[count, _OFFSET], found[count, _POINT] = depth, offset, i
                count += 1
                if offset <= limits.close_px:
                    thick = max(limits.surface_m, limits.surface_share * depth)
                    front = min(front, depth + thick)
    return count


@kernel
def merge_kernel(found: NDArray[np.float64], kept: NDArray[np.float64], kept_count: int) -> int:
    """Add what was found to what is kept, rising in depth and falling in offset; says how many.

    What is neither nearer to the eye nor to the pixel than another is dropped.
    """
    for i in range(found.shape[0]):
        depth, offset = found[i, _DEPTH], found[i, _OFFSET]
        low, high = 0, kept_count
        while low < high:
            middle = (low + high) // 2
            if kept[middle, _DEPTH] <= depth:
                low = middle + 1
            else:
                high = middle
        if low > 0 and kept[low - 1, _OFFSET] <= offset:
            continue
        if low > 0 and kept[low - 1, _DEPTH] == depth:
            low -= 1
        end = low
        while end < kept_count and kept[end, _OFFSET] >= offset:
            end += 1
        moved = low + 1 - end
        _move(kept, end, kept_count, moved)
        kept_count += moved
        kept[low] = found[i]
    return kept_count


@kernel
def _move(values: NDArray[np.float64], first: int, end: int, by: int) -> None:
    """Move the lines ``first … end − 1``."""
    for k in range(end - first):
        line = end - 1 - k if by > 0 else first + k
        values[line + by] = values[line]


def warm_up() -> None:
    """Compile the kernels for mapped columns, which are read-only."""
    xyz, found = np.zeros((1, 3), np.int32), np.zeros((1, 4))
    xyz.flags.writeable = False
    matrix, limits = np.eye(4), HitLimits(*[0.0] * 8)
    hits_kernel(xyz, np.array([[0, 1]]), matrix, limits, found)
    hits_kernel(np.zeros((1, 3), np.float32), np.array([[0, 1]]), matrix, limits, found)
    merge_kernel(found, np.zeros((2, 4)), 0)

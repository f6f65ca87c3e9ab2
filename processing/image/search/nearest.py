"""The measured points nearest to places in space, found stretch by stretch by their bounds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.image.images_of_drives import image_of
from processing.image.point_image import PointCloudImage
from processing.image.tiles.tile_kernels import HIGHEST, LOWEST
from processing.image.tiles.tiles import TILE
from processing.recording.columns.coordinates import Coordinates
from processing.recording.drive import Drive

NONE = -1
"""No point."""

_FEW_POSITIONS = 8
"""So few places are looked for one by one; a tree of the points about more is made once. By trial;
no measurement is recorded."""

_POSITIONS_TOGETHER = 128
"""So few that the points about them are looked through while a window waits."""
_SLACK_M = 2.0
"""How far points may lie outside of bounds that were only sketched."""


class NearestSearch:
    """Looks for the nearest points of many places at once, a stretch of the recording at a time.

    Places that lie together cost little more than one of them, however long the recording.

    Parameters
    ----------
    image : PointCloudImage
    coordinates : Coordinates
        Of the image's recording.
    xyz : (n, 3) float64
        m, project CRS.
    within_m : float
        Points further away don't count.

    Attributes
    ----------
    points : (n,) int64
        The nearest point of each place so far, −1 without; final once :meth:`step` says so.
    """

    def __init__(
        self, image: PointCloudImage, coordinates: Coordinates, xyz: Floats, within_m: float
    ) -> None:
        self._image = image
        self._coordinates = coordinates
        self._xyz = xyz
        self._best = np.full(len(xyz), within_m)
        self.points: Integers = np.full(len(xyz), NONE, dtype=np.int64)
        self._lowest, self._highest = _bounds_of_stretches(image)
        self._waiting = self._in_reach(within_m) if len(xyz) else []
        self._parts: list[Integers] = []
        self._stretch = self._start = 0
        self._integers: NDArray[np.int32] = np.empty((0, 3), np.int32)

    def step(self) -> bool:
        """Search a moment longer; says whether more is to follow."""
        while not self._parts and self._waiting:
            self._begin(self._waiting.pop())
        if self._parts:
            mine = self._parts.pop()
            self._look(mine[self._reaches(self._stretch, mine)])
        return bool(self._parts or self._waiting)

    def _begin(self, chunk: int) -> None:
        """Take up the places that come near a stretch, some at a time."""
        mine = np.flatnonzero(self._reaches(chunk, np.arange(len(self._xyz))))
        if not mine.size:
            return
        self._stretch = chunk
        first, starts = chunk * TILE, self._image.row_starts
        self._start = int(starts[first])
        stop = int(starts[min(first + TILE, self._image.rows)])
        self._integers = self._coordinates.chunk(self._start, stop)
        self._parts = np.array_split(mine, -(-mine.size // _POSITIONS_TOGETHER))

    def _reaches(self, chunk: int, positions: Integers) -> NDArray[np.bool_]:
        """Whether points of a stretch may be nearer to places than what was found."""
        xyz = self._xyz[positions]
        outside = np.maximum(np.maximum(self._lowest[chunk] - xyz, xyz - self._highest[chunk]), 0)
        is_near: NDArray[np.bool_] = (outside**2).sum(axis=1) <= self._best[positions] ** 2
        return is_near

    def _in_reach(self, within_m: float) -> list[int]:
        """Stretches that come near any of the places, the nearest one last."""
        low, high = self._xyz.min(axis=0), self._xyz.max(axis=0)
        apart = np.maximum(np.maximum(self._lowest - high, low - self._highest), 0.0)
        away = np.sqrt((apart**2).sum(axis=1))
        near = np.flatnonzero(away <= within_m)
        chunks: list[int] = near[np.argsort(-away[near], kind="stable")].tolist()
        return chunks

    def _look(self, mine: Integers) -> None:
        if not mine.size:
            return
        positions, limit = self._xyz[mine], float(self._best[mine].max())
        found, xyz = self._points_about(positions, limit)
        if not found.size:
            return
        if mine.size <= _FEW_POSITIONS:
            squares = ((positions[:, None, :] - xyz) ** 2).sum(axis=2)
            nearest = squares.argmin(axis=1)
            away = np.sqrt(squares[np.arange(mine.size), nearest])
        else:
            from scipy.spatial import cKDTree

            away, nearest = cKDTree(xyz).query(positions, distance_upper_bound=limit * (1 + 1e-9))
        has_none = self.points[mine] == NONE
        is_nearer = (away < self._best[mine]) | (has_none & (away <= self._best[mine]))
        chosen = mine[is_nearer]
        self.points[chosen] = found[nearest[is_nearer]]
        self._best[chosen] = away[is_nearer]

    def _points_about(self, positions: Floats, limit: float) -> tuple[Integers, Floats]:
        """Points of the stretch in the box about places, and where they are."""
        quantisation = self._coordinates.quantisation
        low, high = quantisation.box(positions.min(axis=0) - limit, positions.max(axis=0) + limit)
        easting = self._integers[:, 0]
        chosen = np.flatnonzero((easting >= low[0]) & (easting <= high[0]))
        for axis in (1, 2):
            values = self._integers[chosen, axis]
            chosen = chosen[(values >= low[axis]) & (values <= high[axis])]
        return chosen + self._start, quantisation.metres(self._integers[chosen])


def nearest_point(drive: Drive, xyz: Floats, within_m: float) -> int:
    """The measured point of a drive nearest to a place.

    Parameters
    ----------
    xyz : (3,) float64
        m, project CRS.

    Returns
    -------
    int
        Index of the point; −1 where none is within the distance.
    """
    if drive.count == 0:
        return -1
    search = nearest_points(drive, np.reshape(xyz, (1, 3)), within_m)
    while search.step():
        pass
    return int(search.points[0])


def nearest_points(drive: Drive, xyz: Floats, within_m: float) -> NearestSearch:
    """Begin to look for the measured points nearest to many places.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, project CRS.
    """
    # Any kind will do: to make another one takes seconds where there are many points.
    made = [image_of(drive, kind) for kind in drive.image_kinds if drive.has_kept(kind)]
    made.sort(key=lambda one: not one.pyramid.is_ready)
    image = made[0] if made else image_of(drive, drive.image_kinds[0])
    positions = np.asarray(xyz, dtype=np.float64)
    return NearestSearch(image, drive.coordinates, positions, within_m)


def _bounds_of_stretches(image: PointCloudImage) -> tuple[Floats, Floats]:
    """Lowest and highest coordinates of all rows of tiles: (stretches, 3) each, m."""
    pyramid = image.pyramid
    pyramid.sketch()
    rows, columns = pyramid.shape(0)
    facts = pyramid.facts[: rows * columns].reshape(rows, columns, -1)
    slack = 0.0 if pyramid.is_ready else _SLACK_M
    lowest: Floats = facts[:, :, LOWEST].min(axis=1) - slack
    highest: Floats = facts[:, :, HIGHEST].max(axis=1) + slack
    return lowest, highest

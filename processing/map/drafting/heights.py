"""Heights from the measured points, for all places of a line at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.image.images_of_drives import image_of
from processing.image.point_image import PointCloudImage
from processing.image.tiles.tile_kernels import COUNT, HIGHEST, LOWEST
from processing.image.tiles.tiles import TILE
from processing.map.drafting.height_kernels import near_points_kernel
from processing.map.drafting.polyline import Polyline
from processing.map.feature import Position, Vertex
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive

_MOST_CELLS = 250_000
_PAIRS_AT_FIRST = 400_000
_MOST_GROUPS = 512
# Chosen on curb edges of a simulated street whose truth is known: fits that follow slopes freely,
# or forgive more than 2 cm, lean towards the curb's face.
_CUTOFFS_M = (0.05, 0.04, 0.03, 0.025, 0.02, 0.02)
_LEVEL_M = 0.02
_PREFERENCE_M = 0.20
_LEAST_FOR_PLANE = 3
_LEAST_WEIGHT = 1e-6
_NOISE_M = 0.01
_LIKELY_SLOPE = 0.1
_CUTOFFS_OF_BANK_M = (1.0, 0.15, 0.08, 0.05, 0.03, 0.02)
_SLOPE_OF_BANK = 0.7
_MOST_OF_THEM = 0.85
_NEARLY_ALL = 0.92
_ON_PLANE_M = 0.03
_CLOSER = 0.7


def set_on_ground(
    positions: Sequence[Position],
    drives: Sequence[Drive],
    *,
    reach_m: float = 0.15,
    step_m: float = 0.5,
) -> tuple[Vertex, ...]:
    """The places of a line at the heights of the measured surface.

    1. Tiles whose bounds come near any place name the rows to look at; one pass over the points
       of those finds all near all places.
    2. At each place the level about which most of its points lie starts a plane; points off it
       count less and less, then nothing, so that one surface is met and not a mean of two. Where
       two surfaces hold equally many points, as on the edge of a curb, the one nearer to the
       given height is taken. Steep banks start from a tilted plane.
    3. Where there are no points, heights are those between the neighbours that have some.

    Parameters
    ----------
    positions : sequence of Position
        m, project CRS.
    reach_m : float
        How far from a place in plan points count.
    step_m : float
        How far above or below the given height.

    Returns
    -------
    tuple of Vertex
        Easting and northing as given. ``is_occluded`` where no point was near: between two
        places with points the height is interpolated along the line; beyond the last one, the
        given height is moved as much as the neighbour's was; without any, it is kept.
    """
    if not positions:
        return ()
    line = Polyline.of(positions)
    search = _Search.of(line, reach_m, step_m)
    pairs = _unite_pairs([search.pairs_in(drive) for drive in drives if drive.count])
    heights, is_found = _fit_heights(pairs, len(positions), reach_m)
    rises = _fill_heights(line, heights, is_found)
    return tuple(
        Vertex((position[0], position[1], position[2] + rise), is_occluded=not found)
        for position, rise, found in zip(positions, rises.tolist(), is_found.tolist(), strict=True)
    )


@dataclass(frozen=True)
class _Pairs:
    """Points near places: index of the place, and what leads from it to the point."""

    owners: NDArray[np.int64]
    offsets: Floats


@dataclass(frozen=True)
class _Search:
    """The places of a line sorted into square cells in plan.

    Attributes
    ----------
    corner : (3,) float64
        The grid's corner, m, project CRS.
    positions : (p, 3) float64
        About the corner.
    cell_m : float
    near : (rows, columns) uint8
        Cells with a place in them or beside them.
    cell_starts, order : int64
        Places by cell; see :func:`near_points_kernel`.
    """

    corner: Floats
    positions: Floats
    reach: Floats
    cell_m: float
    near: NDArray[np.uint8]
    cell_starts: NDArray[np.int64]
    order: NDArray[np.int64]

    @staticmethod
    def of(line: Polyline, reach_m: float, step_m: float) -> _Search:
        """Sort the places of a line into cells no smaller than the reach."""
        low, high = line.xyz.min(axis=0), line.xyz.max(axis=0)
        extent = high[:2] - low[:2]
        # A long line gets larger cells, so that the grid stays small.
        cell = max(reach_m, float(np.sqrt(extent.prod() / _MOST_CELLS)), extent.max() / _MOST_CELLS)
        columns, rows = (np.floor(extent / cell).astype(np.int64) + 3).tolist()
        corner = np.append(low[:2] - cell, low[2])
        positions = line.xyz - corner
        east, north = np.floor(positions[:, :2] / cell).astype(np.int64).T
        cells = north * columns + east
        near = np.zeros((rows, columns), np.uint8)
        for up in (-1, 0, 1):
            for right in (-1, 0, 1):
                near[north + up, east + right] = 1
        counts = np.bincount(cells, minlength=rows * columns)
        return _Search(
            corner=line.origin + corner,
            positions=positions,
            reach=np.array([reach_m, step_m]),
            cell_m=cell,
            near=near,
            cell_starts=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
            order=np.argsort(cells, kind="stable").astype(np.int64),
        )

    def pairs_in(self, drive: Drive) -> _Pairs:
        """All points of a drive that are near a place, but for noise."""
        classes = class_columns(drive.columns)
        coordinates, (starts, stops) = drive.coordinates, self._stretches(_image_of(drive))
        scale, shift = coordinates.quantisation.about(self.corner)
        frame = np.array([*scale, *shift, self.cell_m])
        found = [
            self._pairs_among(
                _without(
                    classes.noise_between(start, stop), coordinates.integers(slice(start, stop))
                ),
                frame,
            )
            for start, stop in zip(starts.tolist(), stops.tolist(), strict=True)
        ]
        return _unite_pairs(found)

    def _pairs_among(self, xyz: NDArray[np.int32], frame: Floats) -> _Pairs:
        room = _PAIRS_AT_FIRST
        while True:
            owners, offsets = np.empty(room, np.int64), np.empty((room, 3))
            cells = (self.near, self.cell_starts, self.order)
            count = near_points_kernel(
                xyz, frame, *cells, self.positions, self.reach, owners, offsets
            )
            if count <= room:
                return _Pairs(owners[:count].copy(), offsets[:count].copy())
            room = count

    def _stretches(self, image: PointCloudImage) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """First and end points of the rows whose tiles come near a place."""
        rows, columns = image.pyramid.shape(0)
        tiles = image.pyramid.table[: rows * columns]
        lowest, highest = tiles[:, LOWEST] - self.corner, tiles[:, HIGHEST] - self.corner
        margin = np.array([self.reach[0], self.reach[0], self.reach[1]])
        # Thousands of places are looked up by groups of neighbours.
        groups = np.array_split(self.positions, min(len(self.positions), _MOST_GROUPS))
        low = np.array([group.min(axis=0) for group in groups]) - margin
        high = np.array([group.max(axis=0) for group in groups]) + margin
        whole = (lowest <= high.max(axis=0)) & (highest >= low.min(axis=0))
        chosen = np.flatnonzero((tiles[:, COUNT] > 0) & whole.all(axis=1))
        meets = (lowest[chosen, None] <= high) & (highest[chosen, None] >= low)
        tile_rows = np.unique(chosen[meets.all(axis=2).any(axis=1)] // columns)
        first = tile_rows[np.diff(tile_rows, prepend=-2) > 1]
        last = tile_rows[np.diff(tile_rows, append=rows + 1) > 1]
        ends = np.minimum((last + 1) * TILE, image.rows)
        return image.row_starts[first * TILE], image.row_starts[ends]


def _without(noise: NDArray[np.bool_], xyz: NDArray[np.int32]) -> NDArray[np.int32]:
    """The points that are no noise: as they are where there is none, which costs nothing."""
    return np.asarray(xyz)[~noise] if noise.any() else np.asarray(xyz)


def _image_of(drive: Drive) -> PointCloudImage:
    """An image of the drive whose tiles are known already, if there is one."""
    images = (image_of(drive, kind) for kind in drive.image_kinds)
    ready = next((image for image in images if image.pyramid.is_ready), None)
    return ready or image_of(drive, drive.image_kinds[0])


def _unite_pairs(pairs: Sequence[_Pairs]) -> _Pairs:
    if not pairs:
        return _Pairs(np.empty(0, np.int64), np.empty((0, 3)))
    return _Pairs(
        np.concatenate([one.owners for one in pairs]),
        np.concatenate([one.offsets for one in pairs]),
    )


def _fit_heights(pairs: _Pairs, count: int, reach_m: float) -> tuple[Floats, NDArray[np.bool_]]:
    """Heights of the surface above the given ones, (count,), and where there is any."""
    order = np.lexsort([pairs.offsets[:, 2], pairs.owners])
    owners, offsets = pairs.owners[order], pairs.offsets[order]
    numbers = np.bincount(owners, minlength=count)
    away = (offsets[:, :2] ** 2).sum(axis=1) / reach_m**2
    closeness = np.exp(-_CLOSER * away)
    levels = np.zeros((count, 3))
    levels[:, 0] = _levels(owners, offsets[:, 2], closeness, count)
    near = _Near(owners, offsets, closeness)
    planes = _settle_planes(near, levels, _CUTOFFS_M, _LIKELY_SLOPE)
    # On a steep bank no level holds many points, but one tilted plane nearly all of them. What a
    # tilted plane holds of a curb is less: its foot, its top and some of its face.
    is_steep = near.share_on(planes) < _MOST_OF_THEM
    some = near.of(is_steep)
    tilted = _settle_planes(some, planes, _CUTOFFS_OF_BANK_M, _SLOPE_OF_BANK)
    is_better = is_steep & (some.share_on(tilted) > _NEARLY_ALL)
    planes[is_better] = tilted[is_better]
    heights = planes[:, 0]
    few = np.flatnonzero((numbers > 0) & (numbers < _LEAST_FOR_PLANE))
    starts, ends = np.searchsorted(owners, few), np.searchsorted(owners, few, side="right")
    for position, start, end in zip(few, starts, ends, strict=True):
        heights[position] = offsets[start + away[start:end].argmin(), 2]
    return heights, numbers > 0


def _levels(owners: NDArray[np.int64], heights: Floats, closeness: Floats, count: int) -> Floats:
    """The height about which most points of each place lie; of two, the one nearer to the given.

    ``owners`` rise, and ``heights`` within each.
    """
    levels = np.zeros(count)
    if not owners.size:
        return levels
    weights = closeness * np.exp(-((heights / _PREFERENCE_M) ** 2))
    sums = np.concatenate([[0.0], np.cumsum(weights)])
    # One rising key for all places: windows of different places don't overlap.
    spread = 2 * (np.abs(heights).max() + 2 * _LEVEL_M)
    key = owners * spread + heights
    score = sums[np.searchsorted(key, key + _LEVEL_M)] - sums[np.searchsorted(key, key - _LEVEL_M)]
    best = np.lexsort([-score, owners])
    starts = np.flatnonzero(np.diff(owners, prepend=-1))
    levels[owners[starts]] = heights[best[starts]]
    return levels


@dataclass(frozen=True)
class _Near:
    """The points near all places, sorted by place: see `_Pairs`; and how much each counts."""

    owners: NDArray[np.int64]
    offsets: Floats
    closeness: Floats

    def of(self, is_chosen: NDArray[np.bool_]) -> _Near:
        """The points near some of the places."""
        kept = is_chosen[self.owners]
        return _Near(self.owners[kept], self.offsets[kept], self.closeness[kept])

    def residuals(self, planes: Floats) -> Floats:
        """(k,): how far points lie above the planes of their places, (count, 3)."""
        own = planes[self.owners]
        residuals: Floats = (
            self.offsets[:, 2] - own[:, 0] - (own[:, 1:] * self.offsets[:, :2]).sum(axis=1)
        )
        return residuals

    def share_on(self, planes: Floats) -> Floats:
        """(count,): which share of the points lies on each plane; 1 where there are none."""
        is_on = np.abs(self.residuals(planes)) < _ON_PLANE_M
        all_of_them = np.bincount(self.owners, self.closeness, len(planes))
        on_it = np.bincount(self.owners, self.closeness * is_on, len(planes))
        return np.divide(on_it, all_of_them, out=np.ones(len(planes)), where=all_of_them > 0)


def _settle_planes(near: _Near, planes: Floats, cutoffs_m: Sequence[float], slope: float) -> Floats:
    """Planes (height at the place and two slopes), fitted again while points off them drop out."""
    for cutoff in cutoffs_m:
        off = np.clip(np.abs(near.residuals(planes)) / cutoff, 0, 1)
        planes = _planes(near, near.closeness * (1 - off**2) ** 2, planes, slope)
    return planes


def _planes(near: _Near, weights: Floats, before: Floats, slope: float) -> Floats:
    """(count, 3): weighted planes; the one before where there is no point."""
    count, heights = len(before), near.offsets[:, 2]
    terms = (np.ones(len(heights)), near.offsets[:, 0], near.offsets[:, 1])
    matrices, sides = np.empty((count, 3, 3)), np.empty((count, 3))
    for i in range(3):
        weighted = weights * terms[i]
        sides[:, i] = np.bincount(near.owners, weighted * heights, count)
        for j in range(i, 3):
            sums = np.bincount(near.owners, weighted * terms[j], count)
            matrices[:, i, j] = matrices[:, j, i] = sums
    # A likely slope instead of none known: few points, or points in a row, don't tilt the plane.
    matrices[:, [1, 2], [1, 2]] += (_NOISE_M / slope) ** 2
    solvable = matrices[:, 0, 0] > _LEAST_WEIGHT
    planes = before.copy()
    planes[solvable] = np.linalg.solve(matrices[solvable], sides[solvable, :, None])[:, :, 0]
    return planes


def _fill_heights(line: Polyline, heights: Floats, is_found: NDArray[np.bool_]) -> Floats:
    """Rises of all places: between found ones the line's heights are interpolated."""
    if is_found.all() or not is_found.any():
        return heights
    along = line.plan_distances
    found, given = np.flatnonzero(is_found), line.xyz[:, 2]
    between = np.interp(along, along[found], given[found] + heights[found]) - given
    positions = np.arange(len(heights))
    beyond = (positions < found[0]) | (positions > found[-1])
    moved = np.where(positions < found[0], heights[found[0]], heights[found[-1]])
    return np.where(is_found, heights, np.where(beyond, moved, between))

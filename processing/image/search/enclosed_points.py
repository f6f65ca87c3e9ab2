"""All measured points whose picture lies inside an outline on the screen, hidden ones included.

A lasso in 3D is drawn over the points that a budget lets be drawn; what it means are all of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.image.point_image import PointCloudImage
from processing.image.tiles.tile_kernels import COUNT, HIGHEST, LOWEST
from processing.image.tiles.tiles import TILE
from processing.recording.drive import Drive

_POINTS_AT_ONCE = 2_000_000
"""24 MB of coordinates, and short enough for a cancel to be felt at once."""

_MOST_BANDS = 8192
"""Bands of a drawn outline, by pixel rows of the screen: more than any screen has."""


@dataclass(frozen=True, eq=False)
class Sight:
    """How space is seen on a screen.

    Attributes
    ----------
    matrix : (3, 4) float64
        From metres about the origin, and 1, to x·w, y·w and w: pixels times what they are divided
        by, which is the depth in perspective and 1 without.
    origin : (3,) float64
        m, project CRS.
    nearest : float
        What has a smaller w isn't seen.
    """

    matrix: Floats
    origin: Floats
    nearest: float


def points_enclosed(
    drive: Drive, image: PointCloudImage, sight: Sight, outline: Floats
) -> NDArray[np.int64]:
    """The points of a drive that are seen inside an outline, whatever lies in front of them.

    1. Tiles whose bounds lie wholly beside the outline's rectangle are left out.
    2. Of the rows of the others every point is projected; a point is inside when a line from it
       to the left crosses the outline an odd number of times.

    Parameters
    ----------
    image : PointCloudImage
        Of this drive; its tiles are used.
    outline : (k, 2) float64
        Corners, pixels; closed by itself, and may cross itself.

    Returns
    -------
    (n,) int64
        Rising.
    """
    found = [np.empty(0, np.int64)]
    if outline.shape[0] < 3 or not drive.count:
        return found[0]
    bands = _Bands.of(outline)
    coordinates = drive.coordinates
    matrix = coordinates.quantisation.of_integers(sight.matrix, sight.origin)
    for start, stop in _stretches(image, sight, bands.limits):
        inside = np.empty(stop - start, np.bool_)
        enclosed_kernel(
            coordinates.chunk(start, stop),
            matrix,
            sight.nearest,
            bands.limits,
            bands.edges,
            bands.starts,
            inside,
        )
        found.append(start + np.flatnonzero(inside))
    return np.concatenate(found)


@dataclass(frozen=True, eq=False)
class _Bands:
    """An outline's edges by the strips of the screen that they pass.

    Attributes
    ----------
    limits : (4,) float64
        Left, top, right, bottom.
    edges : (m, 4) float64
        x, y of both ends; an edge is there once for each strip that it passes.
    starts : (strips + 1,) int64
        Where the edges of each strip begin.
    """

    limits: Floats
    edges: Floats
    starts: NDArray[np.int64]

    @staticmethod
    def of(outline: Floats) -> _Bands:
        low, high = outline.min(axis=0), outline.max(axis=0)
        count = int(np.clip(np.ceil(high[1] - low[1]), 1, _MOST_BANDS))
        edges = np.concatenate([outline, np.roll(outline, -1, axis=0)], axis=1)
        per_px = count / max(high[1] - low[1], 1e-9)
        ends = np.sort(edges[:, [1, 3]], axis=1)
        strips = np.clip(np.floor((ends - low[1]) * per_px), 0, count - 1).astype(np.int64)
        passed = strips[:, 1] - strips[:, 0] + 1
        of_edge = np.repeat(np.arange(len(edges)), passed)
        first = np.repeat(np.cumsum(passed) - passed, passed)
        strip = np.repeat(strips[:, 0], passed) + np.arange(of_edge.size) - first
        order = np.argsort(strip, kind="stable")
        starts = np.searchsorted(strip[order], np.arange(count + 1)).astype(np.int64)
        limits = np.array([low[0], low[1], high[0], high[1]])
        return _Bands(limits, np.ascontiguousarray(edges[of_edge[order]]), starts)


def _stretches(image: PointCloudImage, sight: Sight, limits: Floats) -> list[tuple[int, int]]:
    """First and last point + 1 of the rows whose tiles may have something inside."""
    pyramid = image.pyramid
    tile_rows, tile_columns = pyramid.shape(0)
    table = pyramid.table[: tile_rows * tile_columns]
    filled = np.flatnonzero(table[:, COUNT] > 0)
    bounds = np.stack([table[filled, LOWEST], table[filled, HIGHEST]]) - sight.origin
    corners = np.stack(
        [
            np.column_stack([bounds[x, :, 0], bounds[y, :, 1], bounds[z, :, 2]])
            for x, y, z in np.ndindex(2, 2, 2)
        ]
    )
    seen = corners @ sight.matrix[:, :3].T + sight.matrix[:, 3]
    # Linear in space, so what holds at all corners holds in the box; no division by depth.
    beside = np.zeros(filled.size, np.bool_)
    for axis in range(2):
        beside |= (seen[:, :, axis] < limits[axis] * seen[:, :, 2]).all(axis=0)
        beside |= (seen[:, :, axis] > limits[axis + 2] * seen[:, :, 2]).all(axis=0)
    beside |= (seen[:, :, 2] <= sight.nearest).all(axis=0)
    found: list[tuple[int, int]] = []
    for tile_row in np.unique(filled[~beside] // tile_columns).tolist():
        end = min((tile_row + 1) * TILE, image.rows)
        start, stop = int(image.row_starts[tile_row * TILE]), int(image.row_starts[end])
        if found and found[-1][1] == start and stop - found[-1][0] <= _POINTS_AT_ONCE:
            start, _ = found.pop()
        found.append((start, stop))
    return [part for start, stop in found for part in _parts(start, stop)]


def _parts(start: int, stop: int) -> list[tuple[int, int]]:
    return [
        (first, min(first + _POINTS_AT_ONCE, stop)) for first in range(start, stop, _POINTS_AT_ONCE)
    ]


@kernel
def enclosed_kernel(
    integers: NDArray[np.int32],
    matrix: NDArray[np.float64],
    nearest: float,
    limits: NDArray[np.float64],
    edges: NDArray[np.float64],
    starts: NDArray[np.int64],
    inside: NDArray[np.bool_],
) -> None:
    """Whether points are seen inside an outline, given by the edges of each strip of it."""
    strips = starts.size - 1
    left, top, right, bottom = limits[0], limits[1], limits[2], limits[3]
    per_px = strips / max(bottom - top, 1e-9)
    for i in range(integers.shape[0]):
        inside[i] = False
        a, b, c = float(integers[i, 0]), float(integers[i, 1]), float(integers[i, 2])
        w = matrix[2, 0] * a + matrix[2, 1] * b + matrix[2, 2] * c + matrix[2, 3]
        if w <= nearest:
            continue
        x = (matrix[0, 0] * a + matrix[0, 1] * b + matrix[0, 2] * c + matrix[0, 3]) / w
        y = (matrix[1, 0] * a + matrix[1, 1] * b + matrix[1, 2] * c + matrix[1, 3]) / w
        if not (left <= x <= right and top <= y <= bottom):
            continue
        strip = min(int((y - top) * per_px), strips - 1)
        is_odd = False
        for edge in range(starts[strip], starts[strip + 1]):
            first, second = edges[edge, 1], edges[edge, 3]
            if (first > y) != (second > y):
                share = (y - first) / (second - first)
                if edges[edge, 0] + share * (edges[edge, 2] - edges[edge, 0]) < x:
                    is_odd = not is_odd
        inside[i] = is_odd


def warm_up() -> None:
    """Compile the kernel."""
    bands = _Bands.of(np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]]))
    matrix = np.zeros((3, 4))
    enclosed_kernel(
        np.zeros((2, 3), np.int32),
        matrix,
        0.05,
        bands.limits,
        bands.edges,
        bands.starts,
        np.empty(2, np.bool_),
    )

"""Which tiles a view needs: by window for the image, by frustum and budget for 3D."""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.image.clip import Clip
from processing.image.tile_kernels import COUNT, HIGHEST, LOWEST, STEPS
from processing.image.tiles import TILE, TileKey, TilePyramid

Triple = tuple[float, float, float]

FINE_ENOUGH_PX = 1.0
"""Tiles whose points are closer than this on the screen need no finer ones."""


@dataclass(frozen=True)
class Camera3D:
    """Where a 3D view looks from.

    Attributes
    ----------
    origin : tuple of float
        The view's local origin, m, project CRS.
    position : tuple of float
        m, from the origin.
    direction, up : tuple of float
        Any lengths, not parallel.
    angle_deg : float
        Vertical opening; has no meaning with parallel projection.
    parallel_height_m : float or None
        Height of the view in metres; None for perspective.
    width_px, height_px : int
        Size of the view.
    """

    origin: Triple
    position: Triple
    direction: Triple
    up: Triple
    width_px: int
    height_px: int
    angle_deg: float = 30.0
    parallel_height_m: float | None = None


def tiles_in_window(
    pyramid: TilePyramid, rows: range, columns: range, pixels_per_row: float
) -> list[TileKey]:
    """The tiles that paint a window of the image, the middle ones first.

    Parameters
    ----------
    rows, columns : range
        The window; parts outside the image are ignored.
    pixels_per_row : float
        Screen pixels per pixel of the image. A tile of the level given back has one to two of
        its pixels on one of the screen, so the picture is sharp.
    """
    level = math.floor(math.log2(1 / pixels_per_row)) if pixels_per_row < 1 else 0
    level = min(max(level, 0), pyramid.levels - 1)
    size = TILE << level
    tile_rows, tile_columns = pyramid.shape(level)
    middle_row, middle_column = (rows.start + rows.stop) / 2, (columns.start + columns.stop) / 2
    keys = [
        TileKey(level, row, column)
        for row in range(max(0, rows.start // size), min(tile_rows, -(-rows.stop // size)))
        for column in range(
            max(0, columns.start // size), min(tile_columns, -(-columns.stop // size))
        )
    ]

    def from_middle(key: TileKey) -> float:
        return math.hypot(
            (key.row + 0.5) * size - middle_row, (key.column + 0.5) * size - middle_column
        )

    return sorted(keys, key=from_middle)


def tiles_in_view(
    pyramids: Sequence[TilePyramid],
    camera: Camera3D,
    budget_points: int,
    *,
    clip: Clip | None = None,
) -> list[tuple[int, TileKey]]:
    """The tiles that a 3D view draws, coarse ones first; each point of a street in one tile.

    The tile with the widest gaps on the screen is replaced by its children until all are fine
    enough or the budget is spent. A tile stays until all its children in view are chosen, so
    there are no holes.

    Parameters
    ----------
    clip : Clip, optional
        Tiles that lie wholly outside are left out.

    Returns
    -------
    list of (index of the pyramid, tile)
    """
    views = [_seen(pyramid, camera, clip) for pyramid in pyramids]
    gaps: list[tuple[float, int, TileKey]] = []
    chosen: list[tuple[int, TileKey]] = []
    spent = 0
    for number, (pyramid, seen) in enumerate(zip(pyramids, views, strict=True)):
        top = pyramid.top
        line = pyramid.index(top)
        if seen.is_visible[line]:
            spent += int(seen.counts[line])
            heapq.heappush(gaps, (-float(seen.gap_px[line]), number, top))
    while gaps:
        gap, number, key = heapq.heappop(gaps)
        pyramid, seen = pyramids[number], views[number]
        children = [
            child for child in pyramid.children(key) if seen.is_visible[pyramid.index(child)]
        ]
        more = sum(int(seen.counts[pyramid.index(child)]) for child in children)
        more -= int(seen.counts[pyramid.index(key)])
        if -gap <= FINE_ENOUGH_PX or not children or spent + more > budget_points:
            chosen.append((number, key))
            continue
        spent += more
        for child in children:
            heapq.heappush(gaps, (-float(seen.gap_px[pyramid.index(child)]), number, child))
    return sorted(chosen, key=lambda choice: -choice[1].level)


@dataclass(frozen=True)
class _Seen:
    """What a camera sees of the tiles of a pyramid; each (tiles,) in the table's order."""

    is_visible: NDArray[np.bool_]
    gap_px: NDArray[np.float64]
    counts: NDArray[np.float64]


def _seen(pyramid: TilePyramid, camera: Camera3D, clip: Clip | None) -> _Seen:
    table = pyramid.table
    # An empty tile's bounds are infinite, from which no arithmetic may start.
    is_filled = table[:, COUNT] > 0
    low = np.where(is_filled[:, None], table[:, LOWEST], 0.0) - np.array(camera.origin)
    high = np.where(is_filled[:, None], table[:, HIGHEST], 0.0) - np.array(camera.origin)
    position = np.array(camera.position)
    distance = np.linalg.norm(np.maximum(0, np.maximum(low - position, position - high)), axis=1)
    # Gaps across rows are the wider ones nearly everywhere, and the ones that show.
    spacing = table[:, STEPS].max(axis=1)
    for level in range(pyramid.levels):
        rows, columns = pyramid.shape(level)
        start = pyramid.index(TileKey(level, 0, 0))
        spacing[start : start + rows * columns] *= 1 << level
    spacing = np.where(spacing, spacing, np.linalg.norm(high - low, axis=1) / TILE)
    if camera.parallel_height_m is not None:
        gap_px = spacing * camera.height_px / camera.parallel_height_m
    else:
        across = 2 * np.tan(np.radians(camera.angle_deg) / 2)
        gap_px = spacing * camera.height_px / (across * np.maximum(distance, 1e-3))
    is_visible = is_filled & _in_frustum(low, high, camera)
    if clip is not None:
        places = np.flatnonzero(is_visible)
        is_visible[places] = clip.may_hold(table[places, LOWEST], table[places, HIGHEST])
    return _Seen(is_visible, gap_px, table[:, COUNT])


def _in_frustum(
    low: NDArray[np.float64], high: NDArray[np.float64], camera: Camera3D
) -> NDArray[np.bool_]:
    """Which boxes are not wholly outside one of the planes of the view."""
    position = np.array(camera.position)
    forward = np.array(camera.direction) / np.linalg.norm(camera.direction)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    inside = np.ones(low.shape[0], dtype=np.bool_)
    aspect = camera.width_px / max(camera.height_px, 1)
    for side, share in ((right, aspect), (-right, aspect), (up, 1.0), (-up, 1.0)):
        if camera.parallel_height_m is not None:
            normal, offset = side, share * camera.parallel_height_m / 2
        else:
            slope = share * math.tan(math.radians(camera.angle_deg) / 2)
            normal, offset = side - slope * forward, 0.0
        # The box's corner that is farthest inside.
        corner = np.where(normal > 0, low, high)
        inside &= (corner - position) @ normal <= offset
    if camera.parallel_height_m is None:
        inside &= (np.where(forward > 0, high, low) - position) @ forward > 0
    return inside

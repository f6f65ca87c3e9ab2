"""Which tiles a view needs: by window for the image, by frustum and budget for 3D."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.image.search.clip import Clip
from processing.image.tiles.tile_descent import (
    COLUMN,
    END,
    FIRST,
    LEVEL,
    LINE,
    MET_VALUES,
    ROW,
    SpendingLimits,
    choice_kernel,
    descent_kernel,
)
from processing.image.tiles.tile_kernels import HIGHEST, LOWEST
from processing.image.tiles.tiles import TILE, TileKey, TilePyramid

Triple = tuple[float, float, float]

FINE_ENOUGH_PX = 1.0
"""Tiles whose points are closer than this on the screen need no finer ones: no pixel would show
more."""


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
    has_all: bool = False,
) -> list[tuple[int, TileKey]]:
    """The tiles that a 3D view draws, coarse ones first; each point of a street in one tile.

    The tile with the widest gaps on the screen is replaced by its children until all are fine
    enough or the budget is spent. A tile stays until all its children in view are chosen, so
    there are no holes. Pyramids whose bounds aren't all exact yet are taken as they are sketched.

    Parameters
    ----------
    clip : Clip, optional
        Tiles that lie wholly outside are left out.
    has_all : bool
        Whether tiles may be wanted with all their points: a wall seen from above is one pixel.

    Returns
    -------
    list of (index of the pyramid, tile)
    """
    planes, eye = _frustum(camera), np.append(_eye(camera), float(has_all))
    if clip is not None:
        # What a clip shows has a·x + b·y + c·z ≥ d.
        planes = np.concatenate([planes, -np.array(clip.planes).reshape(-1, 4)])
    met = [_find_tiles(pyramid, eye, planes) for pyramid in pyramids]
    ends = np.cumsum([0, *(len(one) for one in met)])
    for one, first in zip(met, ends[:-1], strict=True):
        one[:, [FIRST, END]] += first
    tiles = np.concatenate([np.empty((0, MET_VALUES)), *met])
    of_pyramid = np.repeat(np.arange(len(met)), np.diff(ends))
    is_shown = np.ones(len(tiles), np.bool_)
    if clip is not None and clip.corridor is not None:
        for number, pyramid in enumerate(pyramids):
            own = slice(int(ends[number]), int(ends[number + 1]))
            facts = pyramid.facts[tiles[own, LINE].astype(np.int64)]
            is_shown[own] = clip.corridor.may_hold(facts[:, LOWEST], facts[:, HIGHEST])
    is_chosen = np.zeros(len(tiles), np.bool_)
    roots = ends[:-1][np.diff(ends) > 0].astype(np.int64)
    limits = SpendingLimits(FINE_ENOUGH_PX, float(budget_points))
    choice_kernel(tiles, roots, is_shown, limits, is_chosen)
    chosen = np.flatnonzero(is_chosen)
    chosen = chosen[np.argsort(-tiles[chosen, LEVEL], kind="stable")]
    keys = tiles[chosen][:, [LEVEL, ROW, COLUMN]].astype(np.int64).tolist()
    return [
        (number, TileKey(max(level, 0), row, column, level < 0))
        for number, (level, row, column) in zip(of_pyramid[chosen].tolist(), keys, strict=True)
    ]


def _find_tiles(pyramid: TilePyramid, eye: Floats, planes: Floats) -> Floats:
    """The tiles of a pyramid that a view may want; see `processing.image.tiles.tile_descent`."""
    facts = pyramid.facts
    rows, columns = pyramid.shape(0)
    met = np.empty((len(facts) + rows * columns, MET_VALUES))
    return met[: descent_kernel(facts, pyramid.shapes, eye, planes, met)].copy()


def _eye(camera: Camera3D) -> Floats:
    is_parallel = camera.parallel_height_m is not None
    across = camera.parallel_height_m or 2 * math.tan(math.radians(camera.angle_deg) / 2)
    position = np.array(camera.origin) + np.array(camera.position)
    return np.array([*position, camera.height_px / across, float(is_parallel), FINE_ENOUGH_PX])


def _frustum(camera: Camera3D) -> Floats:
    """(k, 4): planes a, b, c, d about what is seen, where a·x + b·y + c·z ≤ d."""
    position = np.array(camera.origin) + np.array(camera.position)
    forward = np.array(camera.direction) / np.linalg.norm(camera.direction)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    aspect = camera.width_px / max(camera.height_px, 1)
    planes = []
    for side, share in ((right, aspect), (-right, aspect), (up, 1.0), (-up, 1.0)):
        if camera.parallel_height_m is not None:
            normal, offset = side, share * camera.parallel_height_m / 2
        else:
            slope = share * math.tan(math.radians(camera.angle_deg) / 2)
            normal, offset = side - slope * forward, 0.0
        planes.append([*normal, offset + float(position @ normal)])
    if camera.parallel_height_m is None:
        planes.append([*-forward, -float(position @ forward)])
    return np.array(planes)

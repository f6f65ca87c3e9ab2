"""Surface normals and local shape from the neighbours that the image gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, SilentMonitor
from processing.image.neighbourhoods.neighbourhood_kernels import (
    MOST_ROWS_ASIDE,
    PointRows,
    Surfaces,
    neighbourhood_kernel,
)
from processing.image.rows.grid import PixelGrid

VOTING_ROWS = 8
"""Rows on either side that have a say in which side of a surface the scanner saw: as many as
neighbours come from."""

_POINTS_AT_ONCE = 65_536
"""Some 30 MB with all that is worked out, and short enough for a cancel to be felt at once."""

OVERLAP_ROWS = VOTING_ROWS + MOST_ROWS_ASIDE + 1
"""Rows beyond its own that a block needs to give the same normals as the whole recording."""


@dataclass(frozen=True)
class SurfaceShapes:
    """Normals and shapes of points.

    Attributes
    ----------
    normals : (n, 3) float32
        Unit vectors; zero where too few neighbours are near or they lie on a line.
    shapes : (n, 3) float32
        Linearity, planarity, scattering: they sum to 1; zero where too few are near.
    """

    normals: NDArray[np.float32]
    shapes: NDArray[np.float32]


@dataclass(frozen=True)
class RowLayout:
    """Which point lies in which row and column, for a whole recording or a block.

    Attributes
    ----------
    clocks : (n,) integer
        A point's column is ``clocks[point] − origins[row]``.
    row_starts : (rows + 1,) int64
    origins : (rows,) int64
    segments : (rows,) int32
    is_regular : bool
        Whether points follow each other as a scanner measured them; False seen from above.
    """

    clocks: NDArray[Any]
    row_starts: NDArray[np.int64]
    origins: NDArray[np.int64]
    segments: NDArray[np.int32]
    is_regular: bool = True


def surface_shapes(
    xyz: NDArray[Any],
    scale: tuple[float, float, float],
    layout: RowLayout,
    points: NDArray[np.int64],
    radius_m: float,
) -> SurfaceShapes:
    """Normals, of either sign, and shapes of some points.

    Parameters
    ----------
    xyz : (n, 3) int32 or float64
        Of all points; times ``scale`` it is metres.
    points : (k,) int64
        −1 gives zeros.
    radius_m : float
        Neighbours within this distance count, within more where points lie farther apart.

    Notes
    -----
    1. The spacing along the row and across rows is taken from the next pixels.
    2. Some four points on each side in the row, and as many in two rows as far away as the
       radius, are the neighbourhood: spread evenly along and across, within the radius.
    3. Eigenvalues λ1 ≥ λ2 ≥ λ3 of its covariance: linearity (λ1−λ2)/λ1, planarity (λ2−λ3)/λ1,
       scattering λ3/λ1; the normal belongs to λ3.

    References
    ----------
    Takahashi 2022, equations (4-1) to (4-3).
    """
    found = _surfaces(
        xyz, np.array(scale), layout, points.ravel(), radius_m, monitor=SilentMonitor()
    )
    return SurfaceShapes(found.normals, found.shapes)


def oriented_surface_shapes(
    xyz: NDArray[np.float64],
    grid: PixelGrid,
    radius_m: float,
    monitor: Monitor | None = None,
    *,
    seen_from: NDArray[np.float64] | None = None,
) -> SurfaceShapes:
    """Normals towards the scanner, and shapes, of all points of a grid.

    A scanner that turns one way while it moves one way sees every surface with the same sense of
    (along the row) × (across rows). Which sense that is, is decided by the lower points of the
    rows around: they are road and ground, seen from above. Where the sense isn't known,
    normals point upwards. Where a standing scanner was is known, nothing need be decided.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.
    seen_from : (3,) float64 or None
        Where the scanner was, m.
    """
    rows = grid.row_starts.size - 1
    origins = np.zeros(rows, dtype=np.int64)
    layout = RowLayout(
        grid.columns, grid.row_starts, origins, grid.segments, is_regular=grid.is_regular
    )
    everything = np.arange(xyz.shape[0], dtype=np.int64)
    normals, shapes, meshes = _surfaces(
        xyz, np.ones(3), layout, everything, radius_m, monitor=monitor or SilentMonitor()
    )
    if seen_from is not None:
        normals[np.einsum("ij,ij->i", normals, seen_from - xyz) < 0] *= -1
        return SurfaceShapes(normals, shapes)
    row_of_point = np.repeat(np.arange(rows), np.diff(grid.row_starts))
    senses = _senses(xyz[:, 2], meshes[:, 2].astype(np.float64), row_of_point, rows)
    towards = senses[row_of_point] * np.einsum("ij,ij->i", normals, meshes)
    is_away = np.where(towards != 0, towards < 0, normals[:, 2] < 0)
    normals[is_away] *= -1
    return SurfaceShapes(normals, shapes)


def warm_up() -> None:
    """Compile the kernels."""
    scale = (0.001, 0.001, 0.001)
    grid = PixelGrid(np.array([0, 2]), np.array([0, 1], np.int32), np.zeros(1, np.int32), 2)
    oriented_surface_shapes(np.zeros((2, 3)), grid, 0.1)
    for clocks in (np.array([0, 1]), grid.columns):
        layout = RowLayout(clocks, grid.row_starts, np.zeros(1, np.int64), grid.segments)
        surface_shapes(np.zeros((2, 3), np.int32), scale, layout, np.array([0, 1]), 0.1)


def _surfaces(
    xyz: NDArray[Any],
    scale: NDArray[np.float64],
    layout: RowLayout,
    points: NDArray[np.int64],
    radius_m: float,
    *,
    monitor: Monitor,
) -> Surfaces:
    surfaces = Surfaces(*(np.empty((points.size, 3), np.float32) for _ in range(3)))
    rows = PointRows(
        xyz=_read_only(xyz),
        scale=scale,
        clocks=_read_only(layout.clocks),
        row_starts=_read_only(layout.row_starts),
        origins=_read_only(layout.origins),
        segments=_read_only(layout.segments),
        is_regular=layout.is_regular,
    )
    for start in range(0, points.size, _POINTS_AT_ONCE):
        monitor.check()
        part = slice(start, start + _POINTS_AT_ONCE)
        found = Surfaces(surfaces.normals[part], surfaces.shapes[part], surfaces.meshes[part])
        neighbourhood_kernel(rows, _read_only(points[part]), radius_m, found)
    return surfaces


def _senses(
    heights: NDArray[np.float64],
    upward: NDArray[np.float64],
    row_of_point: NDArray[np.int64],
    rows: int,
) -> NDArray[np.float64]:
    """(rows,) −1, 0 or 1: the factor that turns mesh vectors towards the scanner."""
    counts = np.maximum(np.bincount(row_of_point, minlength=rows), 1)
    means = np.bincount(row_of_point, weights=heights, minlength=rows) / counts
    is_low = heights < means[row_of_point]
    votes = np.bincount(row_of_point[is_low], weights=np.sign(upward[is_low]), minlength=rows)
    # Whole numbers, so that the sum doesn't depend on where a block begins.
    window = np.ones(2 * VOTING_ROWS + 1)
    return np.asarray(np.sign(np.convolve(votes, window)[VOTING_ROWS : VOTING_ROWS + rows]))


def _read_only(values: NDArray[Any]) -> NDArray[Any]:
    view = np.ascontiguousarray(values).view(np.ndarray)
    view.flags.writeable = False
    return view

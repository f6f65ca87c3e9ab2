"""Triangles cut off at a boundary: exactly, with their planes kept."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.monitor import Monitor, SilentMonitor
from processing.methods.earthwork.geometry.boundary import inside_shares
from processing.methods.earthwork.geometry.overlay_kernels import pieces_kernel
from processing.methods.ground.filters.cells import CellGrid

Floats = NDArray[np.float64]

_CELLS_EACH = 2.0
_FEWEST_CELLS_ALONG, _MOST_CELLS_ALONG = 16, 700
"""Cells that tell which triangles a boundary can meet: two for each triangle, within limits. By
timing; they change the time only."""

_CUT_AT_ONCE = 10_000
"""Triangles cut between two questions whether to go on."""

_SAME_SHARE = 1e-8
"""Cells by which sums of shares may be off by rounding."""


def clip_triangles(triangles: Floats, boundary: shapely.Geometry, monitor: Monitor) -> Floats:
    """What of triangles lies within a boundary: (k, 3, 3) float64, counterclockwise.

    Those that the boundary doesn't touch come first, unchanged; what is left of the others is cut
    into triangles on their planes.

    Parameters
    ----------
    triangles : (t, 3, 3) float64
        Counterclockwise in plan, in any frame, m.
    boundary : shapely.Polygon or shapely.MultiPolygon
        In the same frame.
    """
    if not len(triangles):
        return triangles
    inside, on_edge = _sorted_out(triangles, boundary)
    return np.concatenate([triangles[inside], *_cut(triangles[on_edge], boundary, monitor)])


def _sorted_out(
    triangles: Floats, boundary: shapely.Geometry
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Triangles wholly inside, and those that may be cut, told by cells around them: (t,) bool."""
    plan = triangles[:, :, :2]
    low, high = plan.min(axis=1), plan.max(axis=1)
    corner = low.min(axis=0)
    wanted = int(np.sqrt(_CELLS_EACH * len(triangles)))
    along = min(max(wanted, _FEWEST_CELLS_ALONG), _MOST_CELLS_ALONG)
    size = float((high.max(axis=0) - corner).max()) / along
    last = np.floor((high - corner) / size).astype(np.int64) + 1
    first = np.floor((low - corner) / size).astype(np.int64)
    columns, rows = last.max(axis=0).tolist()
    shares = inside_shares(boundary, CellGrid(np.array([*corner, 0.0]), size, rows, columns))
    sums = np.zeros((rows + 1, columns + 1))
    np.cumsum(np.cumsum(shares, axis=0, dtype=np.float64), axis=1, out=sums[1:, 1:])
    (west, south), (east, north) = first.T, last.T
    found = sums[north, east] - sums[south, east] - sums[north, west] + sums[south, west]
    cells = ((last - first).prod(axis=1)).astype(np.float64)
    is_outside = _is_near(found, 0.0)
    is_inside = _is_near(found, cells)
    return is_inside, ~is_inside & ~is_outside


def _is_near(found: Floats, wanted: Floats | float) -> NDArray[np.bool_]:
    """Sums over many cells, whose rounding is far below what a boundary takes of one of them."""
    is_near: NDArray[np.bool_] = np.abs(found - wanted) < _SAME_SHARE
    return is_near


def _cut(triangles: Floats, boundary: shapely.Geometry, monitor: Monitor) -> Iterator[Floats]:
    """What is left of triangles on the edge of the boundary, in blocks of (k, 3, 3) float64.

    The boundary is cut into triangles first: then a boundary of a thousand corners costs each
    triangle only what is near it.
    """
    figures = shapely.get_parts(shapely.constrained_delaunay_triangles(boundary))
    rings = shapely.get_coordinates(shapely.orient_polygons(figures)).reshape(-1, 4, 2)
    others = np.zeros((len(rings), 3, 3))
    others[:, :, :2] = rings[:, :3]
    tree = shapely.STRtree(figures)
    for start in range(0, len(triangles), _CUT_AT_ONCE):
        monitor.check()
        block = triangles[start : start + _CUT_AT_ONCE]
        low, high = block[:, :, :2].min(axis=1), block[:, :, :2].max(axis=1)
        of_triangle, numbers = tree.query(shapely.box(*low.T, *high.T))
        firsts = np.searchsorted(of_triangle, np.arange(len(block) + 1))
        held = (firsts.astype(np.int64), numbers.astype(np.int64))
        pieces = np.empty((pieces_kernel(block, others, held, np.empty((0, 3, 3))), 3, 3))
        pieces_kernel(block, others, held, pieces)
        yield pieces


def warm_up() -> None:
    """Compile the kernel."""
    triangle = np.array([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]])
    clip_triangles(triangle, shapely.box(0.0, 0.0, 0.5, 0.5), SilentMonitor())

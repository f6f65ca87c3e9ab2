"""The ground of drives recorded together, of any size: found tile by tile, written as columns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Text
from processing.methods.ground.drive_points import DrivePoints
from processing.methods.ground.filters.adaptive import GroundAssumptions, GroundSurface, find_ground
from processing.methods.ground.filters.band import heights_at
from processing.methods.ground.filters.cells import CellGrid, choose_cells
from processing.methods.ground.filters.plan_tiles import PlanTile, plan_tiles
from processing.methods.ground.ground_columns import GroundColumns
from processing.methods.ground.stored_surface import SurfaceTile, SurfaceWriter

_MARGIN_WIDTHS = 1.05
"""Margin of a tile in widths of the largest thing: the thing and a little of the ground around it,
so that neighbours see it alike."""

_WORKERS = 2
"""Tiles worked on at a time: each takes some 0.4 GiB (``plan_tiles.MOST_CELLS``)."""

_CHOOSING_SHARE = 0.1
"""Of the progress bar, for choosing cells and tiles: a few of the twenty passes."""

_LOOKING = Text("Looking for the ground", "地面を探しています")


def adaptive_ground(
    points: DrivePoints,
    habits: GroundAssumptions,
    folders: Sequence[Path],
    surface: Path,
    monitor: Monitor,
) -> CellGrid:
    """Find the ground of all drives together, and say of each point whether it belongs to it.

    Parameters
    ----------
    points : DrivePoints
        Of drives recorded together.
    folders : sequence of Path
        Where the columns ``classification`` and ``height_above_ground`` of each drive come to lie.
    surface : Path
        The file of the surface.

    Returns
    -------
    CellGrid
        The cells that were used.

    Raises
    ------
    OutOfRange
        Points that are no noise at fewer than three positions.
    NoSpace, Cancelled
    """
    monitor.report(0.0, _LOOKING)
    grid = choose_cells(points.blocks, habits.grid_m, None)
    tiles = plan_tiles(points.blocks, grid, _MARGIN_WIDTHS * habits.widest_in(grid.size_m))
    habits = replace(habits, grid_m=grid.size_m)
    crs = next((drive.info.crs for drive in points.drives if drive.info.crs), "")
    finding = PartMonitor(monitor, _CHOOSING_SHARE, 1.0)
    with (
        GroundColumns(points, folders, monitor) as columns,
        SurfaceWriter(surface, grid, crs) as writer,
    ):
        search = _TileSearch(points, habits, grid, columns)
        for done, tile in enumerate(_surface_tiles(search, tiles, finding), 1):
            writer.add(tile)
            finding.report(done / len(tiles), _LOOKING)
    return grid


def _surface_tiles(
    search: _TileSearch, tiles: tuple[PlanTile, ...], monitor: Monitor
) -> Iterator[SurfaceTile]:
    """The surface of each tile in their order; two are worked on at a time."""
    if len(tiles) == 1:
        yield search.search(tiles[0], monitor)
        return
    quiet = _OnlyChecks(monitor)
    with _one_thread_of_opencv(), ThreadPoolExecutor(max_workers=_WORKERS) as pool:
        coming: list[Future[SurfaceTile]] = []
        for tile in tiles:
            coming.append(pool.submit(search.search, tile, quiet))
            if len(coming) > _WORKERS:
                yield coming.pop(0).result()
        for future in coming:
            yield future.result()


@contextmanager
def _one_thread_of_opencv() -> Iterator[None]:
    """Keep OpenCV from waiting for its own threads where each core has a tile to work on."""
    import cv2

    before = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        yield
    finally:
        cv2.setNumThreads(before)


class _OnlyChecks:
    """Asks another monitor whether to go on, and reports nothing: several tiles are at work."""

    def __init__(self, whole: Monitor) -> None:
        self._whole = whole

    def report(self, fraction: float, text: Text | None = None) -> None:
        """Keep it."""

    def check(self) -> None:
        """Ask the whole job."""
        self._whole.check()


class _TileSearch:
    """Looks for the ground of tiles; threads may share it."""

    def __init__(
        self, points: DrivePoints, habits: GroundAssumptions, grid: CellGrid, columns: GroundColumns
    ) -> None:
        self._points = points
        self._habits = habits
        self._grid = grid
        self._columns = columns

    def search(self, tile: PlanTile, monitor: Monitor) -> SurfaceTile:
        """The surface of a tile; what is said of its points goes into the columns."""
        grid = tile.grid
        high = grid.origin[:2] + grid.size_m * np.array([grid.columns, grid.rows])
        chunks = self._points.chunks_in(grid.origin[:2], high)
        found = find_ground(lambda: self._points.blocks(chunks), self._habits, monitor, grid)
        heights = self._within_reach(found)
        low = self._grid.origin[:2] + grid.size_m * np.array([tile.columns.start, tile.rows.start])
        high = self._grid.origin[:2] + grid.size_m * np.array([tile.columns.stop, tile.rows.stop])
        for chunk in self._points.chunks_in(low, high):
            monitor.check()
            xyz = self._points.measured_xyz(chunk)
            own = self._owned(xyz, tile)
            if own.any():
                above = xyz[:, 2] - heights_at(xyz[:, :2], grid, heights)
                is_ground = found.is_ground(xyz) & ~self._points.is_echo(chunk)
                self._columns.put(chunk, own, is_ground, above)
        return _own_part(tile, heights, ~found.measured)

    def _owned(self, xyz: NDArray[np.float64], tile: PlanTile) -> NDArray[np.bool_]:
        """Points in a tile's own cells, each point in one tile's only."""
        column, row = ((xyz[:, :2] - self._grid.origin[:2]) / self._grid.size_m).T
        in_rows = (row >= tile.rows.start) & (row < tile.rows.stop)
        owned: NDArray[np.bool_] = in_rows & (column >= tile.columns.start)
        owned &= column < tile.columns.stop
        return owned

    def _within_reach(self, found: GroundSurface) -> NDArray[np.float32]:
        """Heights; NaN farther from measured ground than the largest thing on it is wide."""
        import cv2

        away = cv2.distanceTransform((~found.measured).view(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
        heights = found.band.heights.copy()
        size_m = found.grid.size_m
        heights[away * size_m > self._habits.widest_in(size_m)] = np.nan
        return heights


def _own_part(
    tile: PlanTile, heights: NDArray[np.float32], filled: NDArray[np.bool_]
) -> SurfaceTile:
    """A tile's own cells and those next to them."""
    rows = _with_neighbours(tile.rows, tile.first_row, heights.shape[0])
    columns = _with_neighbours(tile.columns, tile.first_column, heights.shape[1])
    part = np.s_[rows.start : rows.stop, columns.start : columns.stop]
    return SurfaceTile(
        tile.first_row + rows.start,
        tile.first_column + columns.start,
        np.ascontiguousarray(heights[part]),
        np.ascontiguousarray(filled[part]),
    )


def _with_neighbours(cells: range, first: int, count: int) -> range:
    return range(max(0, cells.start - first - 1), min(count, cells.stop - first + 1))

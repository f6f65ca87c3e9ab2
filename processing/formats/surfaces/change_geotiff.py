"""The map of change between two grounds as GeoTIFF: what GIS programs and other offices take."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, SilentMonitor
from processing.core.safe_write import write_safely
from processing.formats.surfaces.geotiff import TILE, Raster, write_geotiff
from processing.methods.earthwork.maps.change_grid import ChangeGrid

CHANGE_BANDS = ("change_m", "before_m", "after_m", "measured")
"""Later less earlier height within the boundary; both heights wherever there is ground; 1 where
both were measured and 0 where one is filled in, within the boundary."""


def write_change_geotiff(
    path: Path,
    change: ChangeGrid,
    *,
    crs: str,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Write a map of change: four bands of float32, NaN for “no data”, north up.

    Heights are those of the project, so they keep a quarter of a millimetre.

    Parameters
    ----------
    crs : str
        ``EPSG:n``, or empty when unknown.
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.
    """
    grid = change.grid
    west, south, lowest = grid.origin.tolist()
    raster = Raster(
        rows=grid.rows,
        columns=grid.columns,
        west=west,
        north=south + grid.rows * grid.size_m,
        cell_m=grid.size_m,
        crs=crs,
        bands=CHANGE_BANDS,
    )

    def window(rows: range, columns: range) -> NDArray[np.float32]:
        # Rows of the grid count from the south, those of the file from the north.
        part = (
            slice(grid.rows - rows.stop, grid.rows - rows.start),
            slice(columns.start, columns.stop),
        )
        difference = change.change_m[part]
        measured = np.where(np.isnan(difference), np.nan, change.is_measured[part])
        heights = [side[part] + lowest for side in (change.before, change.after)]
        return np.stack([difference, *heights, measured]).astype(np.float32)[:, ::-1]

    down, across = -(-grid.rows // TILE), -(-grid.columns // TILE)
    tiles = [(row, column) for row in range(down) for column in range(across)]
    with write_safely(path, never=never) as temporary:
        write_geotiff(temporary, raster, window, tiles, monitor or SilentMonitor())

"""Surfaces that runs found, as GeoTIFF for other programs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.formats.surfaces.geotiff import TILE, Raster, write_geotiff
from processing.methods.ground.stored_surface import StoredSurface
from processing.recording.drive import Drive

_BANDS = ("ground height (m)", "filled in: 1, measured: 0")
_WRITING = Text("Writing {name}", "{name} を書き込み中")


def surface_file_of(parameters: object) -> Path | None:
    """Where a tool's parameters want its surface; None where they don't, or can't.

    Raises
    ------
    OutOfRange
        The name doesn't end as a GeoTIFF's.
    """
    given = getattr(parameters, "surface", "")
    if not given:
        return None
    path = Path(given)
    FORMATS.format_to_write(path, Content.RASTER)
    return path


def surface_beside(path: Path, drive: Drive) -> Path:
    """The surface of a drive, where there are several: the drive's name is added."""
    return path.with_name(f"{path.stem}-{drive.info.name}{path.suffix}")


def delivered_files(*groups: Sequence[Drive]) -> list[Path]:
    """The files that drives came from, which nothing may overwrite."""
    return [path for drives in groups for drive in drives for path in drive.delivered_files]


def write_surface(
    surface: StoredSurface, path: Path, never: Sequence[Path], monitor: Monitor
) -> None:
    """Write a surface as GeoTIFF: heights, and where they are filled in; NaN outside.

    Parameters
    ----------
    path : Path
        Whole in the end, or as it was.
    never : sequence of Path
        Files that must not be overwritten.

    Raises
    ------
    InUse, NoSpace, Cancelled
    """
    monitor.report(0.0, _WRITING.filled(name=path.name))
    with write_safely(path, never=never) as temporary:
        write_surface_content(surface, temporary, monitor)


def write_surface_content(surface: StoredSurface, path: Path, monitor: Monitor) -> None:
    """The content of :func:`write_surface`, for who gives the file its name."""
    grid = surface.grid
    north = float(grid.origin[1]) + grid.rows * grid.size_m
    west = float(grid.origin[0])
    raster = Raster(grid.rows, grid.columns, west, north, grid.size_m, surface.crs, _BANDS)

    def window(rows: range, columns: range) -> NDArray[np.float32]:
        # Rows of a surface count north, those of a picture south.
        southern = range(grid.rows - rows.stop, grid.rows - rows.start)
        heights, filled = surface.window(southern, columns)
        return np.stack([heights, filled])[:, ::-1]

    write_geotiff(path, raster, window, _find_touched_tiles(surface), monitor)


def _find_touched_tiles(surface: StoredSurface) -> set[tuple[int, int]]:
    """Tiles of the picture that tiles of the surface reach into."""
    last = surface.grid.rows - 1
    return {
        (row, column)
        for rows, columns in surface.extents
        for row in range((last - rows.stop + 1) // TILE, (last - rows.start) // TILE + 1)
        for column in range(columns.start // TILE, (columns.stop - 1) // TILE + 1)
    }

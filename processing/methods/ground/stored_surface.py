"""StoredSurface: the ground of a recording as a file of tiles, for volumes, sections and views.

``ground_surface.tiles`` lies in the folder of each drive that it was found from; it may be deleted
at any time. Only tiles that hold points are there, so a road of many kilometres stays small.
"""

from __future__ import annotations

import json
import os
import shutil
import struct
from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import refuse_damaged
from processing.core.errors import BadFile, report_as_user_error
from processing.core.stored_json import json_of
from processing.core.text import Text
from processing.methods.ground.filters.band import heights_at
from processing.methods.ground.filters.cells import CellGrid
from processing.recording.drive import Drive

FILE_NAME = "ground_surface.tiles"
_START = struct.Struct("<8sQ")
_CHECKED_AT_ONCE = 1 << 26  # bytes: a moment, before a section is drawn
_MAGIC = b"ZUKAGND1"
_KEPT_TILES = 8
"""Tiles held in memory, of 10 MB at most each: a section or a view crosses a few."""

_BYTES_PER_CELL = 5
"""A height in single precision and a byte that says whether it is filled in."""


@dataclass(frozen=True)
class SurfaceTile:
    """A rectangle of cells; neighbours overlap by a cell or two, so that heights go on.

    Attributes
    ----------
    row, column : int
        Its first cell in the grid of the whole surface.
    heights : (rows, columns) float32
        Ground at the cells' centres, m above the grid's origin; NaN where there is no surface.
    filled : (rows, columns) bool
        Where the height is filled in and not measured.
    """

    row: int
    column: int
    heights: NDArray[np.float32]
    filled: NDArray[np.bool_]


@dataclass(frozen=True)
class _TilePosition:
    """Where a tile lies: its cells in the whole grid, and its first byte in the file."""

    row: int
    column: int
    rows: int
    columns: int
    at: int


class SurfaceWriter:
    """Writes a surface tile by tile; the caller gives the file its name when it is whole.

    Parameters
    ----------
    path : Path
    grid : CellGrid
        Of the whole surface.
    crs : str
        ``EPSG:n``, or empty when unknown.

    Raises
    ------
    NoSpace
    """

    def __init__(self, path: Path, grid: CellGrid, crs: str) -> None:
        self._path = path
        self._grid = grid
        self._crs = crs
        self._tiles: list[list[int]] = []
        with report_as_user_error(path):
            self._file = path.open("wb")
            self._file.write(_START.pack(_MAGIC, 0))

    def add(self, tile: SurfaceTile) -> None:
        """Append a tile."""
        with report_as_user_error(self._path):
            position = [tile.row, tile.column, *tile.heights.shape, self._file.tell()]
            self._file.write(np.ascontiguousarray(tile.heights, "<f4").data)
            self._file.write(np.ascontiguousarray(tile.filled, np.uint8).data)
        self._tiles.append(position)

    def close(self) -> None:
        """Write what the tiles are and close the file."""
        grid = self._grid
        facts = {
            "origin": grid.origin.tolist(),
            "cell_m": grid.size_m,
            "rows": grid.rows,
            "columns": grid.columns,
            "crs": self._crs,
            "tiles": self._tiles,
        }
        with report_as_user_error(self._path), self._file as file:
            at = file.tell()
            file.write(json.dumps(facts).encode())
            file.seek(0)
            file.write(_START.pack(_MAGIC, at))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if error is None:
            self.close()
        else:
            self._file.close()


class StoredSurface:
    """Ground that a run found, measured and filled in; a few tiles are held in memory.

    Parameters
    ----------
    path : Path
        As :class:`SurfaceWriter` wrote it.

    Attributes
    ----------
    grid : CellGrid
        Cells of the whole surface; ``origin`` in m, project CRS.
    crs : str
        ``EPSG:n``, or empty when unknown.

    Raises
    ------
    MissingInput, BadFile
        There is no such file, or it isn't what was written.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        refuse_damaged(path, 0, _CHECKED_AT_ONCE)
        with report_as_user_error(path), path.open("rb") as file:
            start = file.read(_START.size)
            size = os.fstat(file.fileno()).st_size
            magic, at = _START.unpack(start) if len(start) == _START.size else (b"", 0)
            if magic != _MAGIC or not _START.size <= at < size:
                raise _damaged(path, 0)
            file.seek(at)
            text = file.read()
        try:
            self._take(json_of(text))
        except (ValueError, TypeError, KeyError) as error:
            raise _damaged(path, at) from error
        if any(one.at + _BYTES_PER_CELL * one.rows * one.columns > at for one in self._positions):
            raise _damaged(path, at)
        self._held: OrderedDict[int, SurfaceTile] = OrderedDict()

    # The values come from JSON, whose types only the field names tell.
    def _take(self, facts: dict[str, Any]) -> None:
        origin = np.array(facts["origin"], np.float64)
        size_m = float(facts["cell_m"])
        self.grid = CellGrid(origin, size_m, int(facts["rows"]), int(facts["columns"]))
        self.crs = str(facts["crs"])
        self._positions = [
            _TilePosition(*(int(value) for value in tile)) for tile in facts["tiles"]
        ]

    def heights_at(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        """Ground height at positions, m: (n,) float64; NaN where there is no surface.

        Parameters
        ----------
        xy : (n, 2) float64
            m, project CRS.
        """
        heights = np.full(len(xy), np.nan)
        for number, inside in self._by_tile(xy):
            tile = self._tile(number)
            heights[inside] = heights_at(xy[inside], self._grid_of(tile), tile.heights)
        return heights

    def is_filled_at(self, xy: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether a height is filled in and not measured: (n,) bool; true without a surface."""
        filled = np.ones(len(xy), np.bool_)
        for number, inside in self._by_tile(xy):
            tile = self._tile(number)
            grid = self._grid_of(tile)
            column, row = np.floor((xy[inside] - grid.origin[:2]) / grid.size_m).astype(np.int64).T
            row, column = np.minimum(row, grid.rows - 1), np.minimum(column, grid.columns - 1)
            filled[inside] = tile.filled[row, column] | np.isnan(tile.heights[row, column])
        return filled

    @property
    def extents(self) -> tuple[tuple[range, range], ...]:
        """Rows and columns of each tile."""
        return tuple(
            (range(one.row, one.row + one.rows), range(one.column, one.column + one.columns))
            for one in self._positions
        )

    def window(
        self, rows: range, columns: range
    ) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """The cells of a rectangle: heights, and 1 where they are filled in and 0 where measured.

        Returns
        -------
        heights, filled : (rows, columns) float32
            Project heights, m; both NaN where there is no surface.
        """
        heights = np.full((len(rows), len(columns)), np.nan, np.float32)
        filled = heights.copy()
        for number, (own_rows, own_columns) in enumerate(self.extents):
            shared_rows = range(max(rows.start, own_rows.start), min(rows.stop, own_rows.stop))
            shared = range(
                max(columns.start, own_columns.start), min(columns.stop, own_columns.stop)
            )
            if not shared_rows or not shared:
                continue
            tile = self._tile(number)
            here = _part(shared_rows, shared, rows, columns)
            there = _part(shared_rows, shared, own_rows, own_columns)
            above = tile.heights[there].astype(np.float64) + float(self.grid.origin[2])
            is_new = np.isnan(heights[here]) & ~np.isnan(above)
            heights[here] = np.where(is_new, above, heights[here])
            filled[here] = np.where(is_new, tile.filled[there], filled[here])
        return heights, filled

    def _by_tile(self, xy: NDArray[np.float64]) -> Iterator[tuple[int, NDArray[np.int64]]]:
        """Tiles that hold positions, and which ones; each position goes to one tile."""
        column, row = ((xy - self.grid.origin[:2]) / self.grid.size_m).T
        is_free = np.isfinite(column) & np.isfinite(row)
        if not is_free.any():
            return
        low = row[is_free].min(), column[is_free].min()
        high = row[is_free].max(), column[is_free].max()
        # Tiles overlap by a cell on either side: where two hold a position, the inner knows more.
        for edge in (1, 0):
            for number, tile in enumerate(self._positions):
                top, right = tile.row + tile.rows, tile.column + tile.columns
                if low[0] >= top or low[1] >= right:
                    continue
                if high[0] < tile.row or high[1] < tile.column:
                    continue
                in_rows = (row >= tile.row + edge) & (row < top - edge)
                in_columns = (column >= tile.column + edge) & (column < right - edge)
                inside = np.flatnonzero(is_free & in_rows & in_columns)
                if inside.size:
                    is_free[inside] = False
                    yield number, inside

    def _grid_of(self, tile: SurfaceTile) -> CellGrid:
        shift = self.grid.size_m * np.array([tile.column, tile.row, 0.0])
        return CellGrid(self.grid.origin + shift, self.grid.size_m, *tile.heights.shape)

    def _tile(self, number: int) -> SurfaceTile:
        if number not in self._held:
            self._held[number] = self._read(number)
            while len(self._held) > _KEPT_TILES:
                self._held.popitem(last=False)
        self._held.move_to_end(number)
        return self._held[number]

    def _read(self, number: int) -> SurfaceTile:
        position = self._positions[number]
        shape, count = (position.rows, position.columns), position.rows * position.columns
        with report_as_user_error(self._path), self._path.open("rb") as file:
            file.seek(position.at)
            heights = np.fromfile(file, "<f4", count)
            filled = np.fromfile(file, np.uint8, count)
        if filled.size != count:
            raise _damaged(self._path, position.at)
        return SurfaceTile(
            position.row,
            position.column,
            heights.astype(np.float32, copy=False).reshape(shape),
            filled.astype(np.bool_).reshape(shape),
        )


def _part(
    rows: range, columns: range, from_rows: range, from_columns: range
) -> tuple[slice, slice]:
    """Where some rows and columns lie in an array that begins at others."""
    return (
        slice(rows.start - from_rows.start, rows.stop - from_rows.start),
        slice(columns.start - from_columns.start, columns.stop - from_columns.start),
    )


def ground_surface_of(drive: Drive) -> StoredSurface | None:
    """The ground that the last run of ``ground`` found for a drive; None without one.

    Raises
    ------
    BadFile
        The file is damaged; it can be deleted.
    """
    path = drive.folder / FILE_NAME
    return StoredSurface(path) if path.is_file() else None


def copy_surface(path: Path, target: Path) -> None:
    """Let a new file be a surface too; one copy on the disk serves all drives of a recording.

    Raises
    ------
    NoSpace, InUse
    """
    with report_as_user_error(target):
        try:
            os.link(path, target)
        except OSError:
            shutil.copyfile(path, target)


def _damaged(path: Path, byte: int) -> BadFile:
    return BadFile(
        Text("The stored ground surface is damaged.", "保存された地表面データが壊れています。"),
        Text.same(f"{path}, byte {byte}"),
        Text(
            "Delete the file and run the tool “Ground” again; nothing else needs it.",
            "このファイルを削除し、「地面抽出」をもう一度実行してください。"
            "ほかのデータには影響しません。",
        ),
    )

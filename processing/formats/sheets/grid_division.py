"""The map divided by a grid: that of the public survey's map sheets, or a plain one."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import shapely

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.formats.sheets.drawing_sheet import DrawingSheet
from processing.formats.survey.map_sheets import MapSheet, sheet_at, zone_for_sheets

MAP_WINDOW_MM = (800.0, 600.0)
"""Of a sheet of the map grid, at every scale."""

MOST_SHEETS = 999

_NORTH_M, _WEST_M = 300_000.0, -160_000.0
_STEP_MM = 50.0
_EVEN_M = 1e-6
"""Places so near to an edge are on it."""

Shapes = Sequence[shapely.Geometry]


def plain_grid(shapes: Shapes, scale: int, window_mm: tuple[float, float]) -> list[DrawingSheet]:
    """Sheets of a grid that begins at round coordinates; those with anything on them.

    They go from west to east, and from north to south.

    Parameters
    ----------
    shapes : sequence of shapely.Geometry
        What is on the map, m; at least one.

    Raises
    ------
    Unsuitable
        There would be more than :data:`MOST_SHEETS`.
    """
    width, height = (side * scale / 1000 for side in window_mm)
    step = _STEP_MM * scale / 1000
    low, high = _extent(shapes)
    west, south = (math.floor(one / step) * step for one in low)
    across, up = (
        max(1, math.ceil((end - start) / side - _EVEN_M))
        for start, end, side in ((west, high[0], width), (south, high[1], height))
    )
    # What is left over is on both sides of the map.
    west -= (across * width - (high[0] - west)) / 2 // step * step
    south -= (up * height - (high[1] - south)) / 2 // step * step
    north = south + up * height
    cells = _cells(shapes, (west, north), (width, height))
    return [
        DrawingSheet(
            f"{row + 1}-{column + 1}",
            (west + (column + 0.5) * width, north - (row + 0.5) * height),
            (width, height), scale,
        )
        for row, column in cells
    ]  # fmt: skip


def map_grid(shapes: Shapes, scale: int, crs: str) -> list[DrawingSheet]:
    """Sheets of the public survey's grid with their identifiers; those with anything on them.

    Raises
    ------
    Unsuitable
        No plane rectangular system of Japan; more sheets than :data:`MOST_SHEETS`.
    OutOfRange
        The map leaves the sheets of the zone.

    References
    ----------
    作業規程の準則, 国土基本図図郭. Level 1000: row digit and column letter within a sheet of level
    5000; level 250: quarters of level 500, 1 upper left to 4 lower right.
    """
    zone = zone_for_sheets(crs)
    low, high = _extent(shapes)
    for east, north in (low, high):
        sheet_at(zone, north * 1000, east * 1000)
    width, height = (side * scale / 1000 for side in MAP_WINDOW_MM)
    return [
        DrawingSheet(
            _identifier(zone, row, column, scale),
            (_WEST_M + (column + 0.5) * width, _NORTH_M - (row + 0.5) * height),
            (width, height), scale,
        )
        for row, column in _cells(shapes, (_WEST_M, _NORTH_M), (width, height))
    ]  # fmt: skip


def _identifier(zone: int, row: int, column: int, scale: int) -> str:
    if scale == 1000:
        outer = MapSheet(zone, row * 2, column * 2).identifier[:-2]
        return f"{outer}{row % 5}{'ABCDE'[column % 5]}"
    if scale == 250:
        quarter = 1 + column % 2 + 2 * (row % 2)
        return f"{MapSheet(zone, row // 2, column // 2).identifier}{quarter}"
    return MapSheet(zone, row, column).identifier


def _extent(shapes: Shapes) -> tuple[tuple[float, float], tuple[float, float]]:
    west, south, east, north = shapely.total_bounds(np.array(shapes, dtype=object)).tolist()
    return (west, south), (east, north)


def _cells(
    shapes: Shapes, corner: tuple[float, float], size: tuple[float, float]
) -> list[tuple[int, int]]:
    """Rows from the north and columns from the west of cells that have a part of a shape."""
    found: set[tuple[int, int]] = set()
    for shape in shapes:
        found.update(_cells_of(shape, corner, size))
        check_sheet_count(len(found))
    return sorted(found)


def _cells_of(
    shape: shapely.Geometry, corner: tuple[float, float], size: tuple[float, float]
) -> Iterator[tuple[int, int]]:
    west, south, east, north = shape.bounds
    columns = _between(west - corner[0], east - corner[0], size[0])
    rows = _between(corner[1] - north, corner[1] - south, size[1])
    check_sheet_count((columns.stop - columns.start) * (rows.stop - rows.start) // 100)
    is_one = len(columns) == 1 and len(rows) == 1
    for row in rows:
        for column in columns:
            low = (corner[0] + column * size[0], corner[1] - (row + 1) * size[1])
            cell = shapely.box(low[0], low[1], low[0] + size[0], low[1] + size[1])
            if is_one or cell.intersects(shape):
                yield row, column


def _between(low: float, high: float, size: float) -> range:
    """The cells of a stretch; one that ends on an edge does not go on behind it."""
    first = math.floor(low / size + _EVEN_M)
    return range(first, max(first + 1, math.ceil(high / size - _EVEN_M)))


def check_sheet_count(count: int) -> None:
    """Refuse more sheets than anyone would print.

    Raises
    ------
    Unsuitable
    """
    if count > MOST_SHEETS:
        raise Unsuitable(
            Text(
                f"The map would take more than {MOST_SHEETS} sheets.",
                f"図面が{MOST_SHEETS}枚を超えます。",
            ),
            Text("drawing sheets", "図面"),
            Text(
                "Look for features far from the others, or choose a smaller scale or a larger"
                " paper; nothing was written.",
                "離れた位置にある地物を確認するか、縮尺や用紙の大きさを変更してください。"
                "何も書き込まれていません。",
            ),
        )

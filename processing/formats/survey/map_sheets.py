"""The sheets of the public survey's map at level 500: 300 m by 400 m, and their identifiers.

Their edges are lines of the plane rectangular coordinate system, whose X is northing here, as on
the sheets themselves. Lengths are whole millimetres, the unit in which level 500 is written.
"""

from __future__ import annotations

from dataclasses import dataclass

from processing.core.errors import OutOfRange, Unsuitable
from processing.core.text import Text
from processing.formats.surfaces.landxml_systems import zone_of_system

SHEET_X_MM, SHEET_Y_MM = 300_000, 400_000
"""South to north, west to east (level 500)."""

_NORTH_X_MM, _WEST_Y_MM = 300_000_000, -160_000_000
"""Corner of block AA: 300 km north, 160 km west of the system's origin."""

_ROWS, _COLUMNS = 20 * 100, 8 * 100
"""Sheets of a zone: blocks A to T and A to H of 30 km by 40 km, of 100 by 100 sheets."""


@dataclass(frozen=True, order=True)
class MapSheet:
    """A sheet of level 500.

    Attributes
    ----------
    zone : int
        Of the plane rectangular coordinate system, 1 to 19.
    row, column : int
        From the zone's north-western corner, southwards and eastwards.

    References
    ----------
    作業規程の準則, map sheets: block of 30 km × 40 km, tenths of it (level 5000), tenths of those.
    """

    zone: int
    row: int
    column: int

    @property
    def identifier(self) -> str:
        """``09LD2800``: zone, letters of the block, cell of level 5000, cell of level 500."""
        letters = chr(ord("A") + self.row // 100) + chr(ord("A") + self.column // 100)
        outer = f"{self.row // 10 % 10}{self.column // 10 % 10}"
        return f"{self.zone:02d}{letters}{outer}{self.row % 10}{self.column % 10}"

    @property
    def south_west_mm(self) -> tuple[int, int]:
        """X and Y of the lower left corner."""
        x = _NORTH_X_MM - (self.row + 1) * SHEET_X_MM
        return x, _WEST_Y_MM + self.column * SHEET_Y_MM

    @property
    def neighbours(self) -> tuple[MapSheet, ...]:
        """The eight around it, clockwise from the upper left."""
        around = ((-1, -1), (-1, 0), (-1, 1), (0, 1), (1, 1), (1, 0), (1, -1), (0, -1))
        return tuple(MapSheet(self.zone, self.row + r, self.column + c) for r, c in around)


def sheet_at(zone: int, x_mm: float, y_mm: float) -> MapSheet:
    """The sheet on which a place is; one on an edge is on the northern and eastern sheet.

    Raises
    ------
    OutOfRange
        No sheet of the zone is there.
    """
    row = _ROWS // 2 - 1 - int(x_mm // SHEET_X_MM)
    column = int((y_mm - _WEST_Y_MM) // SHEET_Y_MM)
    if not (0 <= row < _ROWS and 0 <= column < _COLUMNS):
        raise OutOfRange(
            Text(
                f"No map sheet of zone {zone} has this place.",
                f"この位置は第{zone}系の図郭の範囲外です。",
            ),
            Text.same(f"X {x_mm / 1000:.3f}, Y {y_mm / 1000:.3f}"),
            Text(
                "Check the project's reference system, or delete the feature; nothing was written.",
                "プロジェクトの座標参照系を確認するか、地物を削除してください。"
                "何も書き込まれていません。",
            ),
        )
    return MapSheet(zone, row, column)


def zone_for_sheets(crs: str) -> int:
    """The zone whose sheets a reference system has.

    Raises
    ------
    Unsuitable
        It is no plane rectangular coordinate system of Japan.
    """
    zone = zone_of_system(crs)
    if not zone:
        raise Unsuitable(
            Text(
                "Map sheets are those of a plane rectangular coordinate system of Japan.",
                "図郭には平面直角座標系が必要です。",
            ),
            Text.same(crs or "–"),
            Text(
                "Give the project one of EPSG:6669 to EPSG:6687; nothing was written.",
                "プロジェクトにEPSG:6669～6687のいずれかを設定してください。"
                "何も書き込まれていません。",
            ),
        )
    return zone

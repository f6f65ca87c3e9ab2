"""Where signs are said to be: a table of rough positions, measured in images or kept in a ledger.

Takahashi 2022, 8.3: an initial position lies within some 2 m of its sign, and may come with the
sign's shape and size. A table of pixels says instead where images show signs (`image_positions`).
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.japanese_text import read_lines
from processing.core.text import Text
from processing.methods.road.signs.sign_shapes import RECTANGLE, STANDARD_M

FARTHEST_M = 2.5
"""Between a position and its sign in plan: errors of 2 m (Takahashi 2022, 8.3), and the plate's
own width."""

_SHAPES = (*STANDARD_M, RECTANGLE)
_LARGEST_BYTES = 16 << 20
_PLACE = ("easting_m", "northing_m")
_PIXEL = ("image", "column_px", "row_px")
_NUMBERS = (*_PLACE, "height_m", "size_m")
_MOST_NAMED = 8
"""Rows that a note names; the others are counted."""


@dataclass(frozen=True)
class InitialPosition:
    """A row of the table.

    Attributes
    ----------
    line : int
        Of the file, from 1.
    easting_m, northing_m : float
        Project CRS.
    height_m : float
        Of the plate's centre; NaN where it isn't known.
    shape : str
        Empty where it isn't known.
    size_m : float
        NaN where it isn't known.
    """

    line: int
    easting_m: float
    northing_m: float
    height_m: float = math.nan
    shape: str = ""
    size_m: float = math.nan


@dataclass(frozen=True)
class SignPixel:
    """A row of a table of pixels.

    Attributes
    ----------
    line : int
        Of the file, from 1.
    image : str
        Name of the image's file.
    column_px, row_px : float
        Of the plate's middle.
    sign : str
        What other rows call the same sign; empty where it is in this row alone.
    shape : str
        Empty where it isn't known.
    size_m : float
        NaN where it isn't known.
    """

    line: int
    image: str
    column_px: float
    row_px: float
    sign: str = ""
    shape: str = ""
    size_m: float = math.nan


def read_positions(path: Path) -> tuple[InitialPosition | SignPixel, ...]:
    """The rows of a CSV file: all of positions, or all of pixels.

    Raises
    ------
    BadFile
        It isn't such a table; says which line.
    UserError
        The file can't be read.
    """
    with report_as_user_error(path):
        size = path.stat().st_size
    if size > _LARGEST_BYTES:
        raise _bad(path, Text("The file is too large for a table of positions.",
                              "位置の一覧としてはファイルが大きすぎます。"), 1)  # fmt: skip
    lines = read_lines(path)
    rows = [(number, row) for number, row in enumerate(csv.reader(lines), 1) if any(row)]
    names = [one.strip().lower() for one in rows[0][1]] if rows else []
    if {*_PIXEL} <= {*names}:
        return tuple(_pixel(path, number, names, row) for number, row in rows[1:])
    if not {*_PLACE} <= {*names}:
        raise _bad(
            path,
            Text(
                "The header line must name easting_m and northing_m, or image, column_px and "
                "row_px.",
                "見出し行にeasting_mとnorthing_m、またはimageとcolumn_pxとrow_pxの列が必要です。",
            ),
            1,
        )
    return tuple(_position(path, number, names, row) for number, row in rows[1:])


def _position(path: Path, line: int, names: list[str], row: list[str]) -> InitialPosition:
    cells = {name: cell.strip() for name, cell in zip(names, row, strict=False)}
    numbers = _numbers(path, line, cells, _NUMBERS, needed=_PLACE)
    return InitialPosition(
        line,
        numbers["easting_m"],
        numbers["northing_m"],
        numbers["height_m"],
        _shape(path, line, cells),
        numbers["size_m"],
    )


def _pixel(path: Path, line: int, names: list[str], row: list[str]) -> SignPixel:
    cells = {name: cell.strip() for name, cell in zip(names, row, strict=False)}
    needed = _PIXEL[1:]
    numbers = _numbers(path, line, cells, (*needed, "size_m"), needed=needed)
    # A list made on another machine may name images with their folders, in either way of writing.
    image = cells.get("image", "").replace("\\", "/").rpartition("/")[2]
    if not image:
        raise _bad(path, Text("No image is named.", "画像名がありません。"), line)
    return SignPixel(
        line,
        image,
        numbers["column_px"],
        numbers["row_px"],
        cells.get("sign", ""),
        _shape(path, line, cells),
        numbers["size_m"],
    )


def _numbers(
    path: Path, line: int, cells: dict[str, str], names: Sequence[str], *, needed: Sequence[str]
) -> dict[str, float]:
    """The numbers of a row by name; NaN where a cell is empty that may be."""
    numbers: dict[str, float] = {}
    for name in names:
        text = cells.get(name, "")
        try:
            numbers[name] = float(text) if text else math.nan
        except ValueError:
            numbers[name] = math.inf
        if math.isinf(numbers[name]) or (name in needed and math.isnan(numbers[name])):
            raise _bad(
                path,
                Text(
                    "{name} is no number: “{text}”.", "{name}が数値ではありません:「{text}」"
                ).filled(name=name, text=text[:40]),
                line,
            )
    return numbers


def _shape(path: Path, line: int, cells: dict[str, str]) -> str:
    shape = cells.get("shape", "").lower()
    if shape and shape not in _SHAPES:
        raise _bad(
            path,
            Text(
                "“{shape}” is no shape of a sign.", "「{shape}」は標識の板形状ではありません。"
            ).filled(shape=shape[:40]),
            line,
        )
    return shape


def _bad(path: Path, what: Text, line: int) -> BadFile:
    where = Text("{path}, line {line}", "{path} {line}行目").filled(path=path, line=line)
    return BadFile(what, where, UNCHANGED)


@dataclass(frozen=True)
class MissedPositions:
    """Rows for which no sign was found, and why; and those whose heights tell nothing.

    Attributes
    ----------
    outside, swapped, degrees, nothing : tuple of int
        Lines of the file: outside of the points; inside them if easting and northing are swapped;
        longitude and latitude; where nothing like a plate was measured.
    unknown, unmet : tuple of int
        Of pixels: of an image that isn't there; whose line of sight meets nothing.
    heights : tuple of int
        Lines whose sign was found, far above or below the given height.
    """

    outside: tuple[int, ...] = ()
    swapped: tuple[int, ...] = ()
    degrees: tuple[int, ...] = ()
    nothing: tuple[int, ...] = ()
    unknown: tuple[int, ...] = ()
    unmet: tuple[int, ...] = ()
    heights: tuple[int, ...] = ()

    def note(self) -> Text:
        """Sentences that name them; empty where all were found."""
        parts = [
            what.filled(lines=_named(lines))
            for lines, what in (
                (self.degrees, _DEGREES),
                (self.swapped, _SWAPPED),
                (self.outside, _OUTSIDE),
                (self.nothing, _NOTHING),
                (self.unknown, _UNKNOWN),
                (self.unmet, _UNMET),
                (self.heights, _HEIGHTS),
            )
            if lines
        ]
        return Text(" ".join(one.en for one in parts), "".join(one.ja for one in parts))


_DEGREES = Text(
    "These lines hold degrees, not metres of the project's reference system: {lines}.",
    "次の行は平面直角座標ではなく経緯度のようです: {lines}。",
)
_SWAPPED = Text(
    "In these lines easting and northing seem to be swapped: {lines}.",
    "次の行は東距と北距が逆のようです: {lines}。",
)
_OUTSIDE = Text(
    "These lines lie outside the points, or in another reference system: {lines}.",
    "次の行は点群の範囲外か、別の座標系の位置です: {lines}。",
)
_NOTHING = Text(
    "No plate was measured near these lines: {lines}.",
    "次の行の付近には、標識板とみなせるものが計測されていません: {lines}。",
)


_HEIGHTS = Text(
    "The heights of these lines are metres off the signs found there, and were not used: {lines}.",
    "次の行の高さは、見つかった標識の高さと数メートル以上異なるため使用していません: {lines}。",
)
_UNKNOWN = Text(
    "These lines name images that the drives don't have: {lines}.",
    "次の行の画像は走行データにありません: {lines}。",
)
_UNMET = Text(
    "Nothing was measured where these lines look: {lines}.",
    "次の行の画素の方向には、計測された点がありません: {lines}。",
)


def _named(lines: Sequence[int]) -> str:
    text = ", ".join(str(one) for one in lines[:_MOST_NAMED])
    return text + (f" … (+{len(lines) - _MOST_NAMED})" if len(lines) > _MOST_NAMED else "")


def misplaced(
    positions: Sequence[InitialPosition], lowest: Floats, highest: Floats
) -> MissedPositions:
    """Rows that can't be of a survey's points.

    Parameters
    ----------
    lowest, highest : (3,) float64
        Extent of the points, m, project CRS.
    """
    outside, swapped, degrees = [], [], []
    low, high = lowest[:2] - FARTHEST_M, highest[:2] + FARTHEST_M
    for one in positions:
        place = np.array([one.easting_m, one.northing_m])
        if ((place >= low) & (place <= high)).all():
            continue
        if ((place[::-1] >= low) & (place[::-1] <= high)).all():
            swapped.append(one.line)
        elif abs(place[0]) <= 180 and abs(place[1]) <= 90:
            degrees.append(one.line)
        else:
            outside.append(one.line)
    return MissedPositions(tuple(outside), tuple(swapped), tuple(degrees))

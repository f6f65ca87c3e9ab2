"""Failures of curbs and gutters as small pictures on sheets that one can look through.

Left the place from above by intensity with what is true (green) and what was found (orange, and
red where it is wrong); right the points of a slab across it, in height six times as large, and the
normalised scanlines of each drive.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.formats.pictures.png import write_png
from processing.image.scan_lines.scanlines import ScanlineSettings, scanline_through
from processing.laboratory.accuracy.road.road_surroundings import Failure, StreetSurroundings
from processing.recording.drive import Drive
from processing.scoring.features.mapped_features import MappedFile

Picture = NDArray[np.uint8]

_PLAN_PX, _SECTION_PX, _CAPTION_PX = 250, 300, 46
_PX_PER_M = 50.0
_UP_PX_PER_M = 300.0
_SLAB_M = 0.12
_ROOM_M = 4.0
_SHEET_PX, _ROWS = 1700, 5
_SCANLINE = (204, 121, 167)
BACKGROUND, INK = (20, 20, 28), (235, 235, 235)
TRUE, FOUND, _WRONG = (0, 200, 120), (230, 159, 0), (255, 70, 40)
_HEIGHT_COLOURS = ((86, 180, 233), (200, 200, 200))  # of moving things, of all else
_MOVING = 64
_INTENSITY_PERCENT = (2.0, 98.0)


@dataclass(frozen=True)
class RoadMaps:
    """What is drawn over the points of a street.

    Attributes
    ----------
    truth, result : MappedFile
    """

    truth: MappedFile
    result: MappedFile


def paint_failure(failure: Failure, maps: RoadMaps, around: StreetSurroundings) -> Picture:
    """One failure: (rows, columns, 3) uint8."""
    middle, across = failure.middle, _across(failure, around)
    plan = _plan(failure, maps, around)
    section = _section(middle, across, maps, around)
    return np.vstack([caption_of(failure, _PLAN_PX + _SECTION_PX), np.hstack([plan, section])])


def caption_of(failure: Failure, width_px: int) -> Picture:
    """What went wrong where, in two lines: (rows, width, 3) uint8."""
    import cv2

    middle = failure.middle
    caption = np.full((_CAPTION_PX, width_px, 3), BACKGROUND, np.uint8)
    words = (
        f"{failure.what}: {failure.type}",
        f"{failure.street}  {middle[0]:.1f} {middle[1]:.1f}  {failure.detail}",
    )
    for row, text in enumerate(words):
        colour = INK if row else _WRONG
        position = (4, 16 + 20 * row)
        cv2.putText(caption, text, position, cv2.FONT_HERSHEY_SIMPLEX, 0.42, colour, 1, cv2.LINE_AA)
    return caption


def write_sheets(
    pictures: Iterable[tuple[Failure, Picture]], folder: Path
) -> dict[tuple[str, str, str], list[Path]]:
    """Contact sheets by tool, what went wrong and type; the files of each.

    Raises
    ------
    NoSpace
    """
    folder.mkdir(parents=True, exist_ok=True)
    grouped: dict[tuple[str, str, str], list[Picture]] = defaultdict(list)
    for failure, picture in pictures:
        grouped[failure.tool, failure.what, failure.type].append(picture)
    written: dict[tuple[str, str, str], list[Path]] = {}
    for key, group in sorted(grouped.items()):
        stem = "-".join(key).replace(",", "").replace(" ", "_")
        written[key] = []
        columns = max(_SHEET_PX // group[0].shape[1], 1)
        for number, start in enumerate(range(0, len(group), columns * _ROWS), 1):
            sheet = _sheet(group[start : start + columns * _ROWS], columns)
            path = folder / f"{stem}-{number:02d}.png"
            write_png(path, (sheet.shape[0], sheet.shape[1]), [sheet])
            written[key].append(path)
    return written


def _sheet(pictures: Sequence[Picture], columns: int) -> Picture:
    high, wide = pictures[0].shape[:2]
    rows = -(-len(pictures) // columns)
    sheet = np.zeros((rows * (high + 4), columns * (wide + 4), 3), np.uint8)
    for number, picture in enumerate(pictures):
        row, column = divmod(number, columns)
        top, left = row * (high + 4), column * (wide + 4)
        sheet[top : top + high, left : left + wide] = picture
    return sheet


def _across(failure: Failure, around: StreetSurroundings) -> Floats:
    """Unit vector in plan along which the section lies: square to the line, or to the way."""
    if len(failure.xyz) > 1:
        along = (failure.xyz[-1] - failure.xyz[0])[:2]
        across = np.array([along[1], -along[0]])
    else:
        across = (failure.middle - around.paths.nearest(failure.xyz, 100.0).xyz[0])[:2]
    long = float(np.hypot(*across))
    return np.asarray(across / long) if long > 0 and np.isfinite(long) else np.array([1.0, 0.0])


def _plan(failure: Failure, maps: RoadMaps, around: StreetSurroundings) -> Picture:
    middle = failure.middle
    picture = np.full((_PLAN_PX, _PLAN_PX, 3), BACKGROUND, np.uint8)
    points = around.near(middle[None], _ROOM_M)
    xyz = around.cloud.xyz[points]
    # The highest are drawn last; crowns and wires would hide the road.
    low = xyz[:, 2] < (np.median(xyz[:, 2]) if points.size else 0.0) + 1.5
    xyz, points = xyz[low], points[low]
    pixels = _plan_pixels(xyz, middle).astype(np.int64)
    inside = ((pixels >= 0) & (pixels < _PLAN_PX)).all(axis=1)
    order = np.flatnonzero(inside)[np.argsort(xyz[inside, 2], kind="stable")]
    strength = around.cloud.intensity[points].astype(np.float64)
    dark, bright = np.percentile(strength, _INTENSITY_PERCENT) if points.size else (0.0, 1.0)
    grey = np.clip((strength - dark) / max(bright - dark, 1.0), 0, 1) * 190 + 30
    picture[pixels[order, 1], pixels[order, 0]] = grey[order, None].astype(np.uint8)
    _draw_map(picture, maps.truth, middle, TRUE)
    _draw_map(picture, maps.result, middle, FOUND)
    _draw_line(picture, failure.xyz, middle, _WRONG, thick=3)
    return picture


def _draw_map(
    picture: Picture, file: MappedFile, middle: Floats, colour: tuple[int, int, int]
) -> None:
    for one in file.features:
        line = one.xyz if one.shape == "line" else np.vstack([one.xyz, one.xyz[:1]])
        if (np.abs(line[:, :2] - middle[:2]).min(axis=0) < _ROOM_M + 2.0).all():
            _draw_line(picture, line, middle, colour, thick=1)


def _draw_line(
    picture: Picture, xyz: Floats, middle: Floats, colour: tuple[int, int, int], *, thick: int
) -> None:
    import cv2

    pixels = np.rint(_plan_pixels(xyz, middle)).astype(np.int32)
    if len(pixels) == 1:
        cv2.circle(picture, tuple(pixels[0].tolist()), 8, colour, 1, cv2.LINE_AA)
    else:
        cv2.polylines(picture, [pixels], False, colour, thick, cv2.LINE_AA)  # noqa: FBT003 - cv2's own order


def _plan_pixels(xyz: Floats, middle: Floats) -> Floats:
    off = (xyz - middle)[:, :2] * _PX_PER_M
    return np.column_stack([_PLAN_PX / 2 + off[:, 0], _PLAN_PX / 2 - off[:, 1]])


def _section(middle: Floats, across: Floats, maps: RoadMaps, around: StreetSurroundings) -> Picture:
    picture = np.full((_PLAN_PX, _SECTION_PX, 3), BACKGROUND, np.uint8)
    picture[:, ::50] = 45  # a line each metre
    picture[::30] = 45  # and every ten centimetres up
    points = around.near(middle[None], _ROOM_M)
    off = around.cloud.xyz[points] - middle
    along = off[:, 0] * -across[1] + off[:, 1] * across[0]
    inside = np.abs(along) < _SLAB_M
    positions = np.column_stack([off[inside, :2] @ across, off[inside, 2]])
    colours = np.array(_HEIGHT_COLOURS, np.uint8)
    is_moving = around.cloud.label[points][inside] == _MOVING
    _dots(picture, positions, colours[np.where(is_moving, 0, 1)], size=2)
    for drive in around.drives:
        _draw_scanline(picture, drive, middle, across)
    for file, colour in ((maps.truth, TRUE), (maps.result, FOUND)):
        crossed = _crossings(file, middle, across)
        _dots(picture, crossed, np.tile(np.array(colour, np.uint8), (len(crossed), 1)), size=6)
    return picture


def _draw_scanline(picture: Picture, drive: Drive, middle: Floats, across: Floats) -> None:
    import cv2

    section = scanline_through(drive, middle, ScanlineSettings())
    if section is None or section.point.size == 0:
        return
    off = section.xyz(np.arange(section.point.size)) - middle
    near = np.hypot(*off[:, :2].T) < _ROOM_M
    positions = np.column_stack([off[:, :2] @ across, off[:, 2]])
    pixels = np.rint(_section_pixels(positions, picture)).astype(np.int32)
    for number in np.flatnonzero(near[1:] & near[:-1] & ~section.is_break[1:]).tolist():
        first, second = (tuple(one.tolist()) for one in pixels[number : number + 2])
        cv2.line(picture, first, second, _SCANLINE, 1, cv2.LINE_AA)


def _crossings(file: MappedFile, middle: Floats, across: Floats) -> Floats:
    """Where outlines and lines cross the section: across and up, (n, 2) m."""
    found = [np.empty((0, 2))]
    for one in file.features:
        line = one.xyz if one.shape == "line" else np.vstack([one.xyz, one.xyz[:1]])
        off = line - middle
        along = off[:, 0] * -across[1] + off[:, 1] * across[0]
        positions = np.column_stack([off[:, :2] @ across, off[:, 2]])
        crossing = np.flatnonzero(np.diff(np.sign(along)) != 0)
        share = along[crossing] / (along[crossing] - along[crossing + 1])
        found.append(positions[crossing] + share[:, None] * np.diff(positions, axis=0)[crossing])
    return np.vstack(found)


def _dots(picture: Picture, positions: Floats, colours: Picture, *, size: int) -> None:
    high, wide = picture.shape[:2]
    columns, rows = np.rint(_section_pixels(positions, picture)).T
    inside = (columns >= 0) & (columns < wide - size) & (rows >= 0) & (rows < high - size)
    chosen = np.flatnonzero(inside & np.isfinite(columns) & np.isfinite(rows))
    for right in range(size):
        for down in range(size):
            at = rows[chosen].astype(np.int64) + down, columns[chosen].astype(np.int64) + right
            picture[at] = colours[chosen]


def _section_pixels(positions: Floats, picture: Picture) -> Floats:
    """Columns and rows of places (across, up) in m."""
    high, wide = picture.shape[:2]
    return np.column_stack(
        [wide / 2 + positions[:, 0] * _PX_PER_M, high / 2 - positions[:, 1] * _UP_PX_PER_M]
    )

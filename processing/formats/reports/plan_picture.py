"""Maps on paper: a grid in colours, in a frame with coordinates, a round scale, bar and north."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from processing.core.text import Text
from processing.formats.reports.pdf_page import GREY, Paper, Rgb
from processing.methods.earthwork.as_built.as_built import AsBuiltResult
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.heat_map import (
    SHARE_CLASSES,
    ColourClass,
    class_colours,
    on_paper,
)
from processing.methods.ground.filters.cells import CellGrid

_MOST_PX = 1600
_WANTED_PX = 900
_LEFT_MM, _BELOW_MM, _FOOT_MM = 4.5, 4.5, 8.5
_TICK_APART_MM = 24.0
_BAR_MM = 36.0
_ROOM = 1.04
_TYPE = 6.5
_LEGIBLE = 2500
"""Of smaller scales a cell of a metre is hardly seen."""
_PART_SCALES = (500, 1000, 2000, 2500, 5000)
_MOST_PARTS, _MOST_LOOKED_AT = 12, 2000
_LEGEND_ROW_MM, _LEGEND_BOX_MM = 4.8, 7.0

OUTLINE: Rgb = (176, 0, 96)
"""Colour of the edge of what was counted: none of the map's own, and dark in grey print."""

_OUTLINE_MM = 0.45

NO_VALUE: Rgb = (228, 228, 228)
"""Colour of cells that ought to have a value and have none."""


@dataclass(frozen=True)
class PlanPicture:
    """A picture of ground, north above.

    Attributes
    ----------
    rgb : (rows, columns, 3) uint8
        Its first row is the northernmost.
    west, south, east, north : float
        Edges of the picture, m, project CRS.
    """

    rgb: NDArray[np.uint8]
    west: float
    south: float
    east: float
    north: float


def as_built_plan(result: AsBuiltResult) -> PlanPicture:
    """Deviation ÷ limit of every cell; grey under lines where a cell has no data."""
    is_measured = np.ones(result.percent.shape, np.bool_)
    shares = (is_measured, result.is_judged)
    return _plan(result.grid, result.percent, SHARE_CLASSES, shares)


def change_plan(change: ChangeGrid, classes: tuple[ColourClass, ...]) -> PlanPicture:
    """Change of every cell; under lines where a ground was not measured but filled in."""
    held = np.isfinite(change.change_m)
    return _plan(change.grid, change.change_m, classes, (change.is_measured, held))


def _plan(
    grid: CellGrid,
    values: NDArray[np.float32],
    classes: tuple[ColourClass, ...],
    shares: tuple[NDArray[np.bool_], NDArray[np.bool_]],
) -> PlanPicture:
    """Values as they are printed, cut to what they hold.

    Parameters
    ----------
    values : (rows, columns) float32
        Rows count north; NaN where there is none.
    shares : two of (rows, columns) bool
        Cells that were measured, elsewhere slanting lines are drawn; cells that ought to have a
        value: without one they are grey under the lines.
    """
    is_measured, is_judged = shares
    has_value = np.isfinite(values)
    shown = has_value | is_judged
    rows, columns = _span(shown.sum(axis=1)), _span(shown.sum(axis=0))
    part = (slice(rows[0], rows[1]), slice(columns[0], columns[1]))
    values, is_measured, shown = values[part], (is_measured & has_value)[part], shown[part]
    step = max(-(-max(values.shape) // _MOST_PX), 1)
    if step > 1:
        values, is_measured, shown = _reduced(values, is_measured, shown, step)
    colours = class_colours(values, classes)
    colours[shown & np.isnan(values)] = (*NO_VALUE, 255)
    # One pixel a cell would leave no room for lines within small grids.
    times = max(_WANTED_PX // max(values.shape), 1)
    colours = colours[::-1].repeat(times, axis=0).repeat(times, axis=1)
    measured = is_measured[::-1].repeat(times, axis=0).repeat(times, axis=1)
    west, south = grid.origin[:2] + np.array([columns[0], rows[0]]) * grid.size_m
    size_m = grid.size_m * step
    return PlanPicture(
        on_paper(colours, measured),
        float(west),
        float(south),
        float(west) + values.shape[1] * size_m,
        float(south) + values.shape[0] * size_m,
    )


def draw_plan(
    paper: Paper,
    corner: tuple[float, float],
    size_mm: tuple[float, float],
    plan: PlanPicture,
    scale: int | None = None,
    *,
    outline: BaseGeometry | None = None,
) -> None:
    """Draw a map with its frame, coordinates, scale bar and north arrow within a rectangle.

    Parameters
    ----------
    scale : int, optional
        Denominator; without, that of :func:`scale_of`.
    outline : shapely geometry, optional
        An area whose edge is drawn, m, project CRS.
    """
    frame = (corner[0] + _LEFT_MM, corner[1])
    frame_mm = frame_of(size_mm)
    scale = scale or scale_of(plan, size_mm)
    wide, high = (plan.east - plan.west), (plan.north - plan.south)
    picture_mm = (wide * 1000 / scale, high * 1000 / scale)
    left = frame[0] + 0.5 * (frame_mm[0] - picture_mm[0])
    top = frame[1] + 0.5 * (frame_mm[1] - picture_mm[1])
    paper.picture((left, top), picture_mm, plan.rgb)
    lower_left = left, top + picture_mm[1]
    if outline is not None:
        _draw_outline(paper, (frame, frame_mm), lower_left, (plan, scale), outline)
    _draw_ticks(paper, (frame, frame_mm), lower_left, plan, scale)
    paper.box(frame, frame_mm)
    foot = frame[1] + frame_mm[1] + _BELOW_MM + 0.5 * _FOOT_MM
    _draw_bar(paper, (frame[0], foot), scale)
    _draw_north(paper, (frame[0] + frame_mm[0] - 4.0, foot))


def frame_of(size_mm: tuple[float, float]) -> tuple[float, float]:
    """Size of the frame of a map that is drawn within a rectangle, mm."""
    return size_mm[0] - _LEFT_MM, size_mm[1] - _BELOW_MM - _FOOT_MM


def scale_of(plan: PlanPicture, size_mm: tuple[float, float]) -> int:
    """The largest round scale at which a map fits into a rectangle: its denominator."""
    frame_mm = frame_of(size_mm)
    wide, high = plan.east - plan.west, plan.north - plan.south
    needed = 1000 * max(wide / frame_mm[0], high / frame_mm[1]) * _ROOM
    return next(
        round(step * 10.0**power)
        for power in range(1, 9)
        for step in (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8)
        if step * 10.0**power >= needed
    )


def plan_parts(
    plan: PlanPicture, size_mm: tuple[float, float]
) -> tuple[int, tuple[PlanPicture, ...]]:
    """A map in parts at a legible scale, from the north-west on: the scale and the parts.

    Where the whole is legible in the rectangle, or many parts would be needed, there are none.
    Parts without a value are left out.
    """
    whole = scale_of(plan, size_mm)
    for scale in _PART_SCALES if whole > _LEGIBLE else ():
        parts = _parts_at(plan, size_mm, scale) if scale < whole else ()
        if 0 < len(parts) <= _MOST_PARTS:
            return scale, parts
    return whole, ()


def draw_legend(
    paper: Paper,
    corner: tuple[float, float],
    classes: tuple[ColourClass, ...],
    unit: tuple[int, str],
    extra: tuple[tuple[Text, Rgb | None], ...] = (),
    *,
    width: float = 44.0,
) -> float:
    """Draw a legend, highest class first; gives where it ends.

    Parameters
    ----------
    unit : (int, str)
        Digits behind the point, and the unit.
    extra : tuple of (Text, colour or None)
        What else the map shows, under slanting lines; None: lines over any colour.
    """
    x, y = corner
    entries: list[tuple[Text, Rgb | None, bool]] = [
        (one.label(*unit), one.rgb, False) for one in reversed(classes)
    ]
    entries += [(name, colour, True) for name, colour in extra]
    for name, colour, has_lines in entries:
        size = (_LEGEND_BOX_MM, _LEGEND_ROW_MM - 1.0)
        paper.box((x, y), size, fill=colour or (255, 255, 255))
        if has_lines:
            _draw_hatch(paper, (x, y), size)
        paper.text(x + size[0] + 1.6, y + 0.5 * size[1], name, 7.0, width=width - size[0] - 1.6)
        y += _LEGEND_ROW_MM
    return y


def _parts_at(
    plan: PlanPicture, size_mm: tuple[float, float], scale: int
) -> tuple[PlanPicture, ...]:
    rows, columns = plan.rgb.shape[:2]
    pixel_m = (plan.east - plan.west) / columns
    wide, high = (int(length * scale / 1000 / _ROOM / pixel_m) for length in frame_of(size_mm))
    if wide < 1 or high < 1 or (rows // high + 1) * (columns // wide + 1) > _MOST_LOOKED_AT:
        return ()
    parts = []
    for top in range(0, rows, high):
        for left in range(0, columns, wide):
            rgb = plan.rgb[top : top + high, left : left + wide]
            if (rgb < 255).any():
                west, north = plan.west + left * pixel_m, plan.north - top * pixel_m
                east, south = west + rgb.shape[1] * pixel_m, north - rgb.shape[0] * pixel_m
                parts.append(PlanPicture(rgb, west, south, east, north))
    return tuple(parts)


def _span(held: NDArray[np.int64]) -> tuple[int, int]:
    """First and one after the last; all where nothing is held."""
    positions = np.flatnonzero(held)
    return (int(positions[0]), int(positions[-1]) + 1) if len(positions) else (0, len(held))


def _reduced(
    values: NDArray[np.float32],
    is_measured: NDArray[np.bool_],
    shown: NDArray[np.bool_],
    step: int,
) -> tuple[NDArray[np.float32], NDArray[np.bool_], NDArray[np.bool_]]:
    """Blocks of cells as one: of each the value farthest from zero, so that none is hidden."""
    rows, columns = (-(-length // step) for length in values.shape)
    blocks = np.zeros((3, rows * step, columns * step), np.float32)
    blocks[0] = np.nan
    blocks[:, : values.shape[0], : values.shape[1]] = values, is_measured, shown
    of_block = blocks.reshape(3, rows, step, columns, step).swapaxes(2, 3)
    of_block = of_block.reshape(3, rows, columns, step * step)
    farthest = np.argmax(np.nan_to_num(np.abs(of_block[0]), nan=-1.0), axis=2)[..., None]
    kept = np.take_along_axis(of_block[0], farthest, axis=2)[..., 0]
    measured = np.take_along_axis(of_block[1], farthest, axis=2)[..., 0]
    return kept, measured > 0.0, of_block[2].max(axis=2) > 0.0


def _round_step(least_m: float) -> float:
    power = 10.0 ** math.floor(math.log10(least_m))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= least_m * (1 - 1e-9))


def _draw_ticks(
    paper: Paper,
    frame: tuple[tuple[float, float], tuple[float, float]],
    lower_left: tuple[float, float],
    plan: PlanPicture,
    scale: int,
) -> None:
    """Coordinates along the frame, and crosses where they meet."""
    (x, y), (width, height) = frame
    step = _round_step(_TICK_APART_MM * scale / 1000)
    mm = 1000 / scale
    eastings = _within(plan.west, (x - lower_left[0]) / mm, (x + width - lower_left[0]) / mm, step)
    northings = _within(
        plan.south, (lower_left[1] - y - height) / mm, (lower_left[1] - y) / mm, step
    )
    digits = max(-math.floor(math.log10(step)), 0)
    names = ("Y", "X") if paper.language == "ja" else ("E", "N")
    across = [lower_left[0] + (easting - plan.west) * mm for easting in eastings]
    down = [lower_left[1] - (northing - plan.south) * mm for northing in northings]
    for position, easting in zip(across, eastings, strict=True):
        paper.line([(position, y + height), (position, y + height + 1.2)])
        at = min(max(position, x + 9.0), x + width - 9.0)
        words = f"{names[0]} {easting:,.{digits}f}".replace("-", "−")
        paper.text(at, y + height + 3.2, words, _TYPE, "centre")
    for position, northing in zip(down, northings, strict=True):
        paper.line([(x, position), (x - 1.2, position)])
        at = min(max(position, y + 9.0), y + height - 9.0)
        words = f"{names[1]} {northing:,.{digits}f}".replace("-", "−")
        paper.turned_text(x - 2.8, at, words, _TYPE)
    for position in across:
        for other in down:
            paper.line([(position - 1.2, other), (position + 1.2, other)], colour=GREY)
            paper.line([(position, other - 1.2), (position, other + 1.2)], colour=GREY)


def _draw_outline(
    paper: Paper,
    frame: tuple[tuple[float, float], tuple[float, float]],
    lower_left: tuple[float, float],
    placed: tuple[PlanPicture, int],
    outline: BaseGeometry,
) -> None:
    """The edge of an area, as far as it lies within the frame."""
    (x, y), (width, height) = frame
    (plan, scale), (left, low) = placed, lower_left
    mm = 1000 / scale
    on_paper_mm = shapely.transform(
        shapely.boundary(outline),
        lambda xy: np.column_stack(
            [left + (xy[:, 0] - plan.west) * mm, low - (xy[:, 1] - plan.south) * mm]
        ),
    )
    seen = shapely.clip_by_rect(on_paper_mm, x, y, x + width, y + height)
    for part in shapely.get_parts(shapely.line_merge(seen)):
        paper.line(shapely.get_coordinates(part).tolist(), _OUTLINE_MM, OUTLINE)


def _within(origin: float, low: float, high: float, step: float) -> list[float]:
    first = math.ceil((origin + low) / step - 1e-9)
    last = math.floor((origin + high) / step + 1e-9)
    return [number * step for number in range(first, last + 1)]


def _draw_bar(paper: Paper, at: tuple[float, float], scale: int) -> None:
    longest = _BAR_MM * scale / 1000
    step = _round_step(longest / 4)
    parts = max(int(longest / step), 1)
    part_mm = step * 1000 / scale
    x, y = at[0] + 2.0, at[1] - 1.2
    for number in range(parts):
        fill: Rgb = (0, 0, 0) if number % 2 == 0 else (255, 255, 255)
        paper.box((x + number * part_mm, y), (part_mm, 1.4), fill=fill)
    for number in range(0, parts + 1, 1 if part_mm > 8.0 else parts):
        words = f"{number * step:g}"
        paper.text(x + number * part_mm, y + 3.0, words, _TYPE, "centre")
    end = x + parts * part_mm
    paper.text(end + 3.2, y + 3.0, "m", _TYPE)
    paper.text(end + 9.0, y + 1.4, Text(f"Scale 1:{scale:,}", f"縮尺 1:{scale:,}"), 8.0)


def _draw_north(paper: Paper, at: tuple[float, float]) -> None:
    x, y = at
    paper.area([(x, y - 3.6), (x, y + 2.6), (x - 1.6, y + 3.6)], (0, 0, 0))
    paper.line([(x, y - 3.6), (x + 1.6, y + 3.6), (x, y + 2.6)])
    paper.text(x - 3.2, y - 2.2, "N", 8.0, "centre")


def _draw_hatch(paper: Paper, corner: tuple[float, float], size: tuple[float, float]) -> None:
    """Slanting lines as the map has them, within a box."""
    (x, y), (width, height) = corner, size
    for number in range(1, int((width + height) / 1.2) + 1):
        off = number * 1.2
        start = (x + max(off - height, 0.0), y + min(off, height))
        end = (x + min(off, width), y + max(off - width, 0.0))
        paper.line([start, end], 0.2, (120, 120, 120))

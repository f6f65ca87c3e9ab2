"""Sections on paper: both grounds, what was cut and filled between them, offsets and heights."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.text import Text
from processing.formats.reports.pdf_page import BLACK, GREY, THIN_MM, Paper, Rgb
from processing.methods.earthwork.maps.heat_map import CUT_RGB, FILL_RGB
from processing.methods.earthwork.sections.drawing_parts import (
    DrawnSection,
    earth_moved,
    parts_with_ground,
)

Floats = NDArray[np.float64]

_LEFT_MM, _TOP_MM, _BELOW_MM = 9.0, 5.5, 4.5
_TYPE = 6.0
_LEAST_TALL_M = 0.5
_MOST_TICKS = 6
_GRID_RGB: Rgb = (200, 200, 200)
_TITLE = Text("{name}   cut {cut} m²   fill {fill} m²", "{name}　切土 {cut} m²　盛土 {fill} m²")


def draw_section(
    paper: Paper, corner: tuple[float, float], size_mm: tuple[float, float], section: DrawnSection
) -> None:
    """Draw a section within a rectangle; heights and offsets have scales of their own.

    The earlier ground is a dashed grey line, the later one a black line.
    """
    frame = (corner[0] + _LEFT_MM, corner[1] + _TOP_MM)
    frame_mm = (size_mm[0] - _LEFT_MM, size_mm[1] - _TOP_MM - _BELOW_MM)
    title = _TITLE.filled(
        name=section.name, cut=f"{section.cut_m2:,.2f}", fill=f"{section.fill_m2:,.2f}"
    )
    paper.text(corner[0] + _LEFT_MM, corner[1] + 2.6, title, 8.0, width=frame_mm[0])
    heights = np.concatenate([section.before, section.after])
    heights = heights[np.isfinite(heights)]
    if not len(heights) or len(section.offsets) < 2:
        paper.box(frame, frame_mm)
        return
    low, high = float(heights.min()), float(heights.max())
    spare = 0.06 * max(high - low, _LEAST_TALL_M) + 0.5 * max(_LEAST_TALL_M - (high - low), 0.0)
    spans = ((float(section.offsets[0]), float(section.offsets[-1])), (low - spare, high + spare))
    _draw_ticks(paper, frame, frame_mm, spans)

    def placed(positions: Floats) -> list[tuple[float, float]]:
        (left, right), (bottom, top) = spans
        x = frame[0] + (positions[:, 0] - left) / (right - left) * frame_mm[0]
        y = frame[1] + (top - positions[:, 1]) / (top - bottom) * frame_mm[1]
        return list(zip(x.tolist(), y.tolist(), strict=True))

    for is_cut, outline in earth_moved(section):
        paper.area(placed(outline), CUT_RGB if is_cut else FILL_RGB)
    for part in parts_with_ground(section.offsets, section.before):
        paper.line(placed(part), 0.2, GREY, dash_mm=(1.2, 0.8))
    for part in parts_with_ground(section.offsets, section.after):
        paper.line(placed(part), 0.25, BLACK)
    paper.box(frame, frame_mm, THIN_MM)


def _draw_ticks(
    paper: Paper,
    frame: tuple[float, float],
    frame_mm: tuple[float, float],
    spans: tuple[tuple[float, float], tuple[float, float]],
) -> None:
    (x, y), (width, height) = frame, frame_mm
    (left, right), (bottom, top) = spans
    for offset, words in _ticks(left, right):
        position = x + (offset - left) / (right - left) * width
        paper.line([(position, y), (position, y + height)], 0.05, _GRID_RGB)
        paper.text(position, y + height + 2.2, words, _TYPE, "centre")
    for level, words in _ticks(bottom, top):
        position = y + (top - level) / (top - bottom) * height
        paper.line([(x, position), (x + width, position)], 0.05, _GRID_RGB)
        paper.text(x - 1.0, position, words, _TYPE, "right")


def _ticks(low: float, high: float) -> list[tuple[float, str]]:
    """Round numbers from low to high, and how they are written."""
    rough = (high - low) / _MOST_TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(one * power for one in (1, 2, 5, 10) if one * power >= rough * (1 - 1e-9))
    digits = max(-math.floor(math.log10(step) + 1e-9), 0)
    numbers = range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)
    return [(number * step, f"{number * step:.{digits}f}".replace("-", "−")) for number in numbers]

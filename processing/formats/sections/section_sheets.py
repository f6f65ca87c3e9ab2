"""Sections laid out on sheets of paper: stretches of the longitudinal one, then cross sections."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from processing.core.errors import Unsuitable
from processing.core.text import Language, Text
from processing.formats.sections.route_sections import RouteSection
from processing.formats.sections.section_drawing import (
    LEFT_MM,
    RIGHT_MM,
    SectionBlock,
    SectionScale,
    cross_block,
    profile_block,
)
from processing.formats.sheets.grid_division import check_sheet_count
from processing.formats.sheets.paper_shapes import PaperShape
from processing.formats.sheets.sheet_layout import SheetLayout
from processing.map.catalogue import FeatureKind
from processing.map.routes.route import station_words

_BETWEEN_MM, _EDGE_MM = 6.0, 4.0


@dataclass(frozen=True)
class SectionSheet:
    """A sheet with sections.

    Attributes
    ----------
    title : Text
        Longitudinal or cross sections.
    part : str
        Route and stations.
    shapes : tuple of PaperShape
        In the window.
    kinds : tuple of FeatureKind
        Those that its sections cross.
    """

    title: Text
    part: str
    scale: SectionScale
    shapes: tuple[PaperShape, ...]
    kinds: tuple[FeatureKind, ...]


@dataclass(frozen=True)
class _Placed:
    """A block, the section in it and its stations."""

    block: SectionBlock
    section: RouteSection
    ends: tuple[float, float]


def cross_sheets(
    sections: Sequence[RouteSection],
    reach_m: float,
    scale: SectionScale,
    layout: SheetLayout,
    language: Language,
) -> list[SectionSheet]:
    """Cross sections of one route, up a column, then on in the next one to the right.

    Raises
    ------
    Unsuitable
        A section is larger than the window.
    """
    placed = [
        _Placed(cross_block(one, reach_m, scale, language), one, (one.station_m or 0.0,) * 2)
        for one in sections
    ]
    # As road offices lay them out: the first one is lowest.
    return _filled(Text("Cross sections", "横断図"), placed, scale, layout, lambda y, _: y)


def profile_sheets(
    section: RouteSection,
    stations: Sequence[float],
    scale: SectionScale,
    layout: SheetLayout,
    language: Language,
) -> list[SectionSheet]:
    """The longitudinal section of a route in stretches that have room in the window.

    Raises
    ------
    Unsuitable
        Not even from one station to the next is there room.
    """
    width, height = layout.window_size
    most = (width - 2 * _EDGE_MM - LEFT_MM - RIGHT_MM) * scale.along / 1000
    placed: list[_Placed] = []
    first = 0
    while first < len(stations) - 1:
        last = first + 1
        while last + 1 < len(stations) and stations[last + 1] - stations[first] <= most:
            last += 1
        while True:
            ends = stations[first], stations[last]
            part = section.between(*ends)
            block = profile_block(part, ends, stations[first : last + 1], scale, language)
            if block.size[1] <= height - 2 * _EDGE_MM or last == first + 1:
                break
            last -= 1
        placed.append(_Placed(block, part, ends))
        first = last
    return _filled(
        Text("Longitudinal section", "縦断図"),
        placed,
        scale,
        layout,
        lambda y, tall: height - y - tall,
    )


def _filled(
    title: Text,
    placed: Sequence[_Placed],
    scale: SectionScale,
    layout: SheetLayout,
    low_of: Callable[[float, float], float],
) -> list[SectionSheet]:
    (left, low), (width, height) = layout.window_low, layout.window_size
    sheets: list[list[_Placed]] = []
    shapes: list[list[PaperShape]] = []
    x = y = column = 0.0
    for one in placed:
        wide, tall = one.block.size
        if wide > width - 2 * _EDGE_MM or tall > height - 2 * _EDGE_MM:
            raise _no_room(one, scale)
        if sheets and y + tall > height - _EDGE_MM:
            x, y, column = x + column + _BETWEEN_MM, _EDGE_MM, 0.0
        if not sheets or x + wide > width - _EDGE_MM:
            sheets.append([])
            shapes.append([])
            check_sheet_count(len(sheets))
            x, y, column = _EDGE_MM, _EDGE_MM, 0.0
        shapes[-1] += one.block.moved(left + x, low + low_of(y, tall))
        sheets[-1].append(one)
        y += tall + _BETWEEN_MM
        column = max(column, wide)
    return [
        SectionSheet(title, _part_of(those), scale, tuple(drawn), _kinds_of(those))
        for those, drawn in zip(sheets, shapes, strict=True)
    ]


def _part_of(placed: Sequence[_Placed]) -> str:
    first, last = placed[0].ends[0], placed[-1].ends[1]
    words = station_words(first)
    if last != first:
        words += f"～{station_words(last)}"
    return f"{placed[0].section.route.name} {words}".strip()


def _kinds_of(placed: Sequence[_Placed]) -> tuple[FeatureKind, ...]:
    found = {one.kind.id: one.kind for those in placed for one in those.section.crossed}
    return tuple(sorted(found.values(), key=lambda kind: (kind.dm_code or "9999", kind.id)))


def _no_room(one: _Placed, scale: SectionScale) -> Unsuitable:
    wide, tall = one.block.size
    return Unsuitable(
        Text("A section is larger than the sheet.", "断面が図面に収まりません。"),
        Text(
            f"{station_words(one.ends[0])} at {scale.words.en}: {wide:.0f} × {tall:.0f} mm",
            f"{station_words(one.ends[0])}（{scale.words.ja}）: {wide:.0f} × {tall:.0f} mm",
        ),
        Text(
            "Choose a smaller scale, a larger paper, or a shorter reach; nothing was written.",
            "縮尺を小さくするか、用紙を大きくするか、片側の幅を狭くしてください。"
            "何も書き込まれていません。",
        ),
    )

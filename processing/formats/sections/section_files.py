"""Sections of routes as ``sections.pdf``, ``sections/*.dxf`` and two tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from processing.core.monitor import Monitor
from processing.core.text import Language, Text
from processing.formats.map_delivery import MapDelivery, Position, SectionOptions
from processing.formats.sections.cut_routes import cut_routes
from processing.formats.sections.route_sections import (
    RouteSection,
    stations_in_words,
    stations_to_cut,
)
from processing.formats.sections.section_drawing import AXIS_PEN, GROUND_PEN, SectionScale
from processing.formats.sections.section_dxf import (
    DrawnSections,
    write_flat_sections_dxf,
    write_section_layouts_dxf,
)
from processing.formats.sections.section_sheets import SectionSheet, cross_sheets, profile_sheets
from processing.formats.sections.section_tables import section_table
from processing.formats.sheets.map_looks import map_pen
from processing.formats.sheets.paper_layers import on_cad_layers
from processing.formats.sheets.paper_shapes import (
    PaperCircle,
    PaperLine,
    PaperPlace,
    PaperShape,
    Pen,
)
from processing.formats.sheets.sheet_column import LegendRow, plain_column
from processing.formats.sheets.sheet_frame import border_shapes
from processing.formats.sheets.sheet_layout import SheetLayout, layout_of
from processing.formats.sheets.sheets_pdf import write_sheets_pdf
from processing.formats.sheets.title_block import SheetPart, title_block

_SAMPLE_MM = 12.0


def write_sections_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write ``sections.pdf``, drawings, ``long_sections.csv`` and ``cross_sections.csv``.

    Stations without ground are left out, and told.

    Raises
    ------
    Unsuitable
        The map has no such route, no ground was measured along it, or a section has no room.
    OutOfRange
        A station that can't be read; a character that the tables' encoding lacks.
    """
    options = delivery.options_of(SectionOptions)
    layout = layout_of(options.sheet_paper)
    language: Language = delivery.language or "ja"
    along, across = cut_routes(delivery, options, monitor)
    sheets = _sheets(along, across, options, layout, language)
    drawn = []
    for number, sheet in enumerate(sheets, 1):
        scale = sheet.scale.words.in_language(language)
        title = sheet.title.in_language(language)
        part = SheetPart(f"{title}　{sheet.part}", scale, number, len(sheets))
        block = title_block(delivery, options, part)
        column = plain_column(_legend(sheet, language), block, sheet.scale.along, language, layout)
        around = on_cad_layers((*border_shapes(layout), *column))
        drawn.append(DrawnSections(sheet, around))
    pages = [(*one.sheet.shapes, *one.around) for one in drawn]
    title = options.sheet_title or delivery.name
    write_sheets_pdf(position("sections.pdf"), pages, layout.paper, language, title)
    whole = position(f"sections/{delivery.name}_sections_layouts.dxf")
    write_section_layouts_dxf(whole, drawn, layout, delivery.crs, monitor)
    for number, one in enumerate(drawn, 1):
        monitor.check()
        path = position(f"sections/{delivery.name}_sections_{number:03d}.dxf")
        write_flat_sections_dxf(path, one, layout, delivery.crs, monitor)
    for name, sections in (("long_sections.csv", along), ("cross_sections.csv", across)):
        position(name).write_bytes(section_table(sections, delivery, options))


def _sheets(
    along: Sequence[RouteSection],
    across: Sequence[RouteSection],
    options: SectionOptions,
    layout: SheetLayout,
    language: Language,
) -> list[SectionSheet]:
    sheets: list[SectionSheet] = []
    scale = SectionScale(int(options.profile_scale), int(options.profile_height_scale))
    further = stations_in_words(options.section_stations)
    for section in along:
        stations = stations_to_cut(section.route, options.section_pitch, further)
        sheets += profile_sheets(section, stations, scale, layout, language)
    scale = SectionScale(int(options.section_scale), int(options.section_height_scale))
    for route in dict.fromkeys(id(one.route) for one in across):
        those = [one for one in across if id(one.route) == route]
        sheets += cross_sheets(those, options.section_reach, scale, layout, language)
    return sheets


def _legend(sheet: SectionSheet, language: Language) -> list[LegendRow]:
    """Ground and centre line, and a mark for each kind that is crossed."""
    ground, centre = Text("Ground line", "地盤線"), Text("Centre line", "中心線")
    rows = [LegendRow(ground.in_language(language), partial(_line, GROUND_PEN))]
    rows.append(LegendRow(centre.in_language(language), partial(_line, AXIS_PEN)))
    for kind in sheet.kinds:
        name = kind.name.in_language(language)
        words = f"{kind.dm_code}　{name}" if kind.dm_code else name
        rows.append(LegendRow(words, partial(_mark, map_pen(kind))))
    return rows


def _mark(pen: Pen, place: PaperPlace, _step: float) -> tuple[PaperShape, ...]:
    solid = replace(pen, dash_mm=(), line_type="continuous", width_mm=0.25)
    return (PaperCircle(solid, (place[0] + _SAMPLE_MM / 2, place[1]), 0.5),)


def _line(pen: Pen, place: PaperPlace, _step: float) -> tuple[PaperShape, ...]:
    return (PaperLine(pen, (place, (place[0] + _SAMPLE_MM, place[1]))),)

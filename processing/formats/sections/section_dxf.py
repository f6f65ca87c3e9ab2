"""Sheets of sections as DXF: one drawing with a layout for each, and a flat drawing for each.

Sections are in metres at their scale along: a metre of heights is longer where heights have a
larger scale. In the drawing with layouts they lie side by side in the model space.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from processing.core.monitor import Monitor
from processing.formats.drawings.dxf_document import DxfDocument, DxfVersion
from processing.formats.sections.section_sheets import SectionSheet
from processing.formats.sheets.dxf_shapes import ON_PAPER, Placing, draw_shape
from processing.formats.sheets.paper_layers import VIEWPORT
from processing.formats.sheets.paper_shapes import PaperPlace, PaperShape
from processing.formats.sheets.sheet_layout import SheetLayout

_PATTERN_SCALE = 500
"""Patterns of lines are metres on the ground at this scale."""
_ROOM = 1.2


@dataclass(frozen=True)
class DrawnSections:
    """A sheet of sections, and what surrounds them on it."""

    sheet: SectionSheet
    around: Sequence[PaperShape]


def write_section_layouts_dxf(
    path: Path,
    sheets: Sequence[DrawnSections],
    layout: SheetLayout,
    crs: str,
    monitor: Monitor,
) -> None:
    """Write all sections once, with a layout for each sheet (R2010)."""
    document = _document("R2010", crs, 1.0)
    document.doc.header["$PSLTSCALE"] = 0  # patterns are metres
    document.doc.layers.add(VIEWPORT, plot=False)
    width, height = layout.window_size
    left = top = 0.0
    for number, one in enumerate(sheets, 1):
        monitor.check()
        scale = one.sheet.scale.along
        unit = scale / 1000
        _draw_all(document, document.space, one.sheet.shapes, _placing(layout, unit, left))
        space = document.doc.layouts.new(f"{number:03d}")
        space.page_setup(size=layout.paper, margins=(0, 0, 0, 0), units="mm")
        view = space.add_viewport(
            center=layout.window_centre,
            size=layout.window_size,
            view_center_point=(left + width * unit / 2, height * unit / 2),
            view_height=height * unit,
        )
        view.dxf.layer = VIEWPORT
        _draw_all(document, space, one.around, ON_PAPER.with_pattern(1000 / _PATTERN_SCALE))
        left += width * unit * _ROOM
        top = max(top, height * unit)
    document.doc.layouts.delete("Layout1")
    document.show((0.0, 0.0), (left, top))
    document.write(path, monitor)


def write_flat_sections_dxf(
    path: Path, drawn: DrawnSections, layout: SheetLayout, crs: str, monitor: Monitor
) -> None:
    """Write one sheet with all that is on it, in metres (R12, cp932)."""
    scale = drawn.sheet.scale.along
    document = _document("R12", crs, scale / _PATTERN_SCALE)
    unit = scale / 1000
    _draw_all(document, document.space, (*drawn.sheet.shapes, *drawn.around),
              _placing(layout, unit, 0.0))  # fmt: skip
    (x, y), (wide, tall) = layout.window_low, layout.paper
    document.show((-x * unit, -y * unit), ((wide - x) * unit, (tall - y) * unit))
    document.write(path, monitor)


def _document(version: DxfVersion, crs: str, pattern: float) -> DxfDocument:
    document = DxfDocument(version)
    document.tell_system(crs)
    document.add_line_types()
    document.doc.header["$LTSCALE"] = pattern
    return document


def _placing(layout: SheetLayout, unit: float, left: float) -> Placing:
    """Metres from the window's lower left corner."""
    x, y = layout.window_low

    def place(places: Sequence[PaperPlace]) -> Sequence[PaperPlace]:
        return [((a - x) * unit + left, (b - y) * unit) for a, b in places]

    return Placing(place, unit, 0.0, unit * 1000 / _PATTERN_SCALE)


def _draw_all(
    document: DxfDocument, space: object, shapes: Iterable[PaperShape], placing: Placing
) -> None:
    for shape in shapes:
        draw_shape(document, space, shape, placing)

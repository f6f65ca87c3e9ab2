"""Sheets as DXF: one drawing with a layout for each, and a flat drawing for each.

The map is in metres in the model space of both, with ids and attributes as extended data. A layout
is in millimetres on paper and looks at the map through a viewport at the sheet's scale. A flat
drawing has the sheet around the map in metres on the ground, to be plotted at the scale.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from processing.core.monitor import Monitor
from processing.formats.drawings.dxf import DrawnSize, MapDrawing
from processing.formats.drawings.dxf_document import APP_ID, SHEET_MARK, DxfVersion
from processing.formats.drawings.sxf_looks import pen_mm_of
from processing.formats.map_delivery import MapDelivery
from processing.formats.sheets.drawing_sheet import DrawingSheet
from processing.formats.sheets.dxf_shapes import (
    ON_PAPER,
    Placing,
    draw_shape,
    weight_of,
)
from processing.formats.sheets.paper_layers import VIEWPORT
from processing.formats.sheets.paper_shapes import PaperPlace, PaperShape
from processing.formats.sheets.sheet_layout import SheetLayout
from processing.map.feature import Feature


@dataclass(frozen=True)
class DrawnSheet:
    """A sheet and what is drawn on it beside the map's lines and symbols."""

    sheet: DrawingSheet
    shapes: Sequence[PaperShape]


def write_layouts_dxf(
    path: Path,
    delivery: MapDelivery,
    sheets: Sequence[DrawnSheet],
    layout: SheetLayout,
    monitor: Monitor,
) -> None:
    """Write the whole map once, with a layout for each sheet (R2010)."""
    drawing = _map_drawing(delivery, delivery.features, sheets[0].sheet.scale, "R2010", monitor)
    doc = drawing.document.doc
    doc.header["$PSLTSCALE"] = 0  # patterns are metres on the ground
    doc.layers.add(VIEWPORT, plot=False)
    for number, one in enumerate(sheets, 1):
        monitor.check()
        space = doc.layouts.new(f"{number:03d}")
        space.page_setup(size=layout.paper, margins=(0, 0, 0, 0), units="mm")
        (width, height), scale = layout.window_size, one.sheet.scale
        view = space.add_viewport(
            center=layout.window_centre,
            size=(width, height),
            view_center_point=(0, 0),
            view_height=height * scale / 1000,
        )
        view.dxf.layer = VIEWPORT
        view.dxf.view_target_point = (*one.sheet.centre, 0.0)
        view.dxf.view_twist_angle = -one.sheet.turned_deg
        for shape in one.shapes:
            draw_shape(drawing.document, space, shape, ON_PAPER.with_pattern(1000 / scale))
    doc.layouts.delete("Layout1")
    _set_weights(drawing, delivery)
    drawing.document.write(path, monitor)


def write_flat_dxf(
    path: Path,
    delivery: MapDelivery,
    features: Sequence[Feature],
    drawn: DrawnSheet,
    layout: SheetLayout,
    *,
    monitor: Monitor,
) -> None:
    """Write one sheet with the features cut at its window (R12, cp932)."""
    sheet = drawn.sheet
    drawing = _map_drawing(delivery, features, sheet.scale, "R12", monitor)

    def on_ground(places: Sequence[PaperPlace]) -> Sequence[PaperPlace]:
        return [(x, y) for x, y in sheet.on_ground(places, layout).tolist()]

    placing = Placing(on_ground, sheet.scale / 1000, sheet.turned_deg)
    space = drawing.document.space
    count = len(space)
    for shape in drawn.shapes:
        draw_shape(drawing.document, space, shape, placing)
    for entity in list(space)[count:]:
        # The legend's samples lie on the layers of the map: whoever reads it takes them for things.
        entity.set_xdata(APP_ID, [(1000, SHEET_MARK)])
    corners = on_ground([(0.0, 0.0), (layout.paper[0], 0.0), layout.paper, (0.0, layout.paper[1])])
    xs, ys = zip(*corners, strict=True)
    drawing.document.show((min(xs), min(ys)), (max(xs), max(ys)))
    drawing.document.write(path, monitor)


def _map_drawing(
    delivery: MapDelivery,
    features: Iterable[Feature],
    scale: int,
    version: DxfVersion,
    monitor: Monitor,
) -> MapDrawing:
    size = DrawnSize(scale, has_labels=False, is_flat=True)
    drawing = MapDrawing(delivery.catalogue, version, delivery.crs, delivery.language, size=size)
    for feature in features:
        monitor.check()
        drawing.add(feature)
    drawing.finish()
    return drawing


def _set_weights(drawing: MapDrawing, delivery: MapDelivery) -> None:
    kinds = reversed(delivery.catalogue.kinds)
    pens: Mapping[str, float] = {kind.layer: pen_mm_of(kind) for kind in kinds}
    for layer in drawing.document.doc.layers:
        if layer.dxf.name in pens:
            layer.dxf.lineweight = weight_of(pens[layer.dxf.name])

"""Sheets as DXF: one drawing with a layout for each, and a flat drawing for each.

The map is in metres in the model space of both, with ids and attributes as extended data. A layout
is in millimetres on paper and looks at the map through a viewport at the sheet's scale. A flat
drawing has the sheet around the map in metres on the ground, to be plotted at the scale.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from processing.core.monitor import Monitor
from processing.formats.drawings.dxf import LABEL_SUFFIX, DrawnSize, MapDrawing
from processing.formats.drawings.dxf_document import DxfVersion
from processing.formats.drawings.dxf_text import label_text
from processing.formats.drawings.sxf_looks import pen_mm_of
from processing.formats.map_delivery import MapDelivery
from processing.formats.sheets.drawing_sheet import DrawingSheet
from processing.formats.sheets.paper_shapes import (
    FRAME_LAYER,
    PaperCircle,
    PaperLine,
    PaperPlace,
    PaperShape,
    PaperWords,
    Pen,
)
from processing.formats.sheets.sheet_layout import SheetLayout
from processing.map.feature import Feature

_VIEWPORT_LAYER = f"{FRAME_LAYER}-VPRT"
_WEIGHTS = (0, 5, 9, 13, 15, 18, 20, 25, 30, 35, 40, 50, 53, 60, 70, 80, 90, 100)
"""Line widths that drawings know, hundredths of a millimetre (DXF reference, group 370)."""
_BLACK_ACI = 7


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
    doc.layers.add(_VIEWPORT_LAYER, plot=False)
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
        view.dxf.layer = _VIEWPORT_LAYER
        view.dxf.view_target_point = (*one.sheet.centre, 0.0)
        view.dxf.view_twist_angle = -one.sheet.turned_deg
        for shape in one.shapes:
            _draw(drawing, space, shape, _Placing(lambda places: places, 1.0, 0.0, 1000 / scale))
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

    placing = _Placing(on_ground, sheet.scale / 1000, sheet.turned_deg)
    for shape in drawn.shapes:
        _draw(drawing, drawing.document.space, shape, placing)
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
    size = DrawnSize(scale, has_labels=False)
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
            layer.dxf.lineweight = _weight(pens[layer.dxf.name])


def _weight(width_mm: float) -> int:
    return min(_WEIGHTS, key=lambda weight: abs(weight - width_mm * 100))


@dataclass(frozen=True)
class _Placing:
    """How paper lies in a space: places, millimetres, direction, scale of patterns."""

    place: Any  # a function of places
    unit: float
    turned_deg: float
    pattern: float = 1.0


def _draw(drawing: MapDrawing, space: Any, shape: PaperShape, placing: _Placing) -> None:
    attributes = _attributes(drawing, shape.pen, placing)
    match shape:
        case PaperLine():
            places = placing.place(shape.places)
            if shape.is_filled:
                _fill(space, places, attributes)
            elif drawing.document.has_light_polylines:
                space.add_lwpolyline(places, dxfattribs=attributes)
            else:
                space.add_polyline2d(places, dxfattribs=attributes)
        case PaperCircle():
            (centre,) = placing.place([shape.centre])
            space.add_circle(centre, shape.radius * placing.unit, dxfattribs=attributes)
        case PaperWords():
            _write(drawing, space, shape, placing, attributes)


def _fill(space: Any, places: Sequence[PaperPlace], attributes: Mapping[str, Any]) -> None:
    """Fill a triangle or a rectangle, as every version can."""
    corners = list(places[:-1] if places[0] == places[-1] else places)
    last, before = corners[-1], corners[-2]
    # The corners of a solid go zigzag.
    ordered = [*corners[:2], last, before] if len(corners) == 4 else corners
    space.add_solid(ordered, dxfattribs=dict(attributes))


def _write(
    drawing: MapDrawing,
    space: Any,
    shape: PaperWords,
    placing: _Placing,
    attributes: Mapping[str, Any],
) -> None:
    from ezdxf.enums import TextEntityAlignment

    written = label_text(shape.words, drawing.document.encoding)
    if not written:
        return
    (place,) = placing.place([shape.place])
    looks = {
        **attributes,
        "style": "JAPANESE",
        "height": shape.height * placing.unit,
        "rotation": (shape.angle_deg + placing.turned_deg) % 360.0,
    }
    text = space.add_text(written, dxfattribs=looks)
    text.set_placement(place, align=TextEntityAlignment[f"MIDDLE_{shape.align}"])


def _attributes(drawing: MapDrawing, pen: Pen, placing: _Placing) -> dict[str, Any]:
    from ezdxf.colors import rgb2int

    document = drawing.document
    if pen.layer not in document.doc.layers:
        document.require_encodable(pen.layer)
        base = pen.layer.removesuffix(LABEL_SUFFIX)
        has_base = base in document.doc.layers
        aci = document.doc.layers.get(base).color if has_base else _BLACK_ACI
        document.doc.layers.add(pen.layer, color=aci)
    attributes: dict[str, Any] = {"layer": pen.layer}
    if pen.dash_mm:
        attributes["linetype"] = pen.line_type.upper()
        if drawing.document.has_light_polylines:  # R12 has the drawing's own scale alone
            attributes["ltscale"] = placing.pattern
    is_black = pen.colour == (0, 0, 0)
    if document.has_true_colours:
        if not is_black:
            attributes["true_color"] = rgb2int(pen.colour)
        attributes["lineweight"] = _weight(pen.width_mm)
    elif not is_black and pen.layer.startswith(FRAME_LAYER):
        attributes["color"] = 1 if pen.colour[0] > 180 and pen.colour[1] < 100 else 8
    return attributes

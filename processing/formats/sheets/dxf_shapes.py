"""What is drawn on paper as entities of a DXF: in millimetres on a layout, or in metres."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from processing.formats.drawings.dxf_document import DxfDocument
from processing.formats.drawings.dxf_text import label_text
from processing.formats.drawings.sxf_looks import LABEL_SUFFIX
from processing.formats.sheets.paper_layers import is_of_paper
from processing.formats.sheets.paper_shapes import (
    PaperCircle,
    PaperLine,
    PaperPlace,
    PaperShape,
    PaperWords,
    Pen,
)

_WEIGHTS = (0, 5, 9, 13, 15, 18, 20, 25, 30, 35, 40, 50, 53, 60, 70, 80, 90, 100)
"""Line widths that drawings know, hundredths of a millimetre (DXF reference, group 370)."""
_BLACK_ACI = 7


@dataclass(frozen=True)
class Placing:
    """How paper lies in a space: places, millimetres, direction, scale of patterns."""

    place: Callable[[Sequence[PaperPlace]], Sequence[PaperPlace]]
    unit: float
    turned_deg: float
    pattern: float = 1.0

    def with_pattern(self, pattern: float) -> Placing:
        """The same with patterns of another scale."""
        return replace(self, pattern=pattern)


ON_PAPER = Placing(lambda places: places, 1.0, 0.0)
"""In millimetres on paper."""


def weight_of(width_mm: float) -> int:
    """The line weight that is nearest to a width, 1/100 mm."""
    return min(_WEIGHTS, key=lambda weight: abs(weight - width_mm * 100))


def draw_shape(document: DxfDocument, space: Any, shape: PaperShape, placing: Placing) -> None:
    """Draw a shape in a space of a drawing, on the layer of its pen."""
    attributes = _attributes(document, shape.pen, placing)
    match shape:
        case PaperLine():
            places = placing.place(shape.places)
            if shape.is_filled:
                _fill(space, places, attributes)
            elif document.has_light_polylines:
                space.add_lwpolyline(places, dxfattribs=attributes)
            else:
                space.add_polyline2d(places, dxfattribs=attributes)
        case PaperCircle():
            (centre,) = placing.place([shape.centre])
            space.add_circle(centre, shape.radius * placing.unit, dxfattribs=attributes)
        case PaperWords():
            _write(document, space, shape, placing, attributes)


def _fill(space: Any, places: Sequence[PaperPlace], attributes: Mapping[str, Any]) -> None:
    """Fill a triangle or a rectangle, as every version can."""
    corners = list(places[:-1] if places[0] == places[-1] else places)
    last, before = corners[-1], corners[-2]
    # The corners of a solid go zigzag.
    ordered = [*corners[:2], last, before] if len(corners) == 4 else corners
    space.add_solid(ordered, dxfattribs=dict(attributes))


def _write(
    document: DxfDocument,
    space: Any,
    shape: PaperWords,
    placing: Placing,
    attributes: Mapping[str, Any],
) -> None:
    from ezdxf.enums import TextEntityAlignment

    written = label_text(shape.words, document.encoding)
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


def _attributes(document: DxfDocument, pen: Pen, placing: Placing) -> dict[str, Any]:
    from ezdxf.colors import rgb2int

    if pen.layer not in document.doc.layers:
        document.require_encodable(pen.layer)
        base = pen.layer.removesuffix(LABEL_SUFFIX)
        has_base = base in document.doc.layers
        aci = document.doc.layers.get(base).color if has_base else _BLACK_ACI
        document.doc.layers.add(pen.layer, color=aci)
    attributes: dict[str, Any] = {"layer": pen.layer}
    if pen.dash_mm:
        attributes["linetype"] = pen.line_type.upper()
        if document.has_light_polylines:  # R12 has the drawing's own scale alone
            attributes["ltscale"] = placing.pattern
    is_black = pen.colour == (0, 0, 0)
    if document.has_true_colours:
        if not is_black:
            attributes["true_color"] = rgb2int(pen.colour)
        attributes["lineweight"] = weight_of(pen.width_mm)
    elif not is_black and is_of_paper(pen.layer):
        attributes["color"] = 1 if pen.colour[0] > 180 and pen.colour[1] < 100 else 8
    return attributes

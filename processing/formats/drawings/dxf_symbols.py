"""The survey symbols as blocks of a DXF: the lines and circles of the bundled SVG, in metres."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree as ET

from resources import path_of

_SVG = "{http://www.w3.org/2000/svg}"


def add_symbol_block(doc: Any, symbol: str) -> str:  # an ezdxf drawing; ezdxf is not typed here
    """Give the name of the block for a symbol; it is made if the drawing lacks it.

    The SVG's unit is a metre on the ground at 1:500, its y axis looks south; what has a direction
    looks north. Lines, polylines, polygons and circles are drawn, by the layer's colour.
    """
    name = f"ZUKA_{symbol.upper()}"
    if name in doc.blocks:
        return name
    block = doc.blocks.new(name)
    # The file comes with the program.
    root = ET.parse(path_of(f"symbols/{symbol}.svg")).getroot()  # noqa: S314
    looks = {"layer": "0", "color": 0, "linetype": "BYBLOCK"}
    for shape in root.iter():
        match shape.tag.removeprefix(_SVG):
            case "circle":
                x, y, radius = (float(shape.attrib[key]) for key in ("cx", "cy", "r"))
                block.add_circle((x, -y), radius, dxfattribs=looks)
            case "line":
                x1, y1, x2, y2 = (float(shape.attrib[key]) for key in ("x1", "y1", "x2", "y2"))
                block.add_line((x1, -y1), (x2, -y2), dxfattribs=looks)
            case "polyline" | "polygon" as tag:
                pairs = [pair.split(",") for pair in shape.attrib["points"].split()]
                points = [(float(x), -float(y)) for x, y in pairs]
                block.add_lwpolyline(points, close=tag == "polygon", dxfattribs=looks)
    return name

"""How layers of a GeoPackage look in QGIS: styles that it loads with the layer, one for each kind.

A style says colour, width, pattern and symbol at 1:500, and the columns' names in Japanese. What
nobody has judged is drawn paler.

References
----------
QGIS keeps styles in the table ``layer_styles`` of a GeoPackage; QML as QGIS 3 writes it.
"""

from __future__ import annotations

import base64
import re
import sqlite3
from collections.abc import Iterable, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as ET

from processing.formats.drawings.sxf_looks import pen_mm_of
from processing.map.catalogue import LINE_TYPES, AttributeField, FeatureKind, Geometry
from processing.map.feature import Status
from resources import path_of

_MM_PER_M = 2.0  # at 1:500
_SYMBOL_MM = 4.0  # the symbols' 2 m
_DOT_MM = 1.0
_FILL_ALPHA = 40
_PALE, _WHOLE = "0.45", "1"
_TURNED_BY = ("direction_deg", "facing_deg")
_TYPES = {Geometry.POINT: "marker", Geometry.LINE: "line", Geometry.AREA: "fill"}

_TABLE = """
CREATE TABLE layer_styles (
 id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, f_table_catalog TEXT(256),
 f_table_schema TEXT(256), f_table_name TEXT(256), f_geometry_column TEXT(256),
 styleName TEXT(30), styleQML TEXT, styleSLD TEXT, useAsDefault BOOLEAN, description TEXT,
 owner TEXT(30), ui TEXT(30), update_time DATETIME DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')))
"""


@dataclass(frozen=True)
class StyledLayer:
    """A layer of the file, and what its features are.

    Attributes
    ----------
    columns : sequence of str
        Those of the layer, of which attributes get their names.
    """

    name: str
    kind: FeatureKind
    geometry: Geometry
    columns: Sequence[str]


def add_layer_styles(path: Path, layers: Iterable[StyledLayer]) -> None:
    """Put a default style for each layer into a GeoPackage.

    Parameters
    ----------
    path : Path
        A GeoPackage without styles.
    """
    with closing(sqlite3.connect(path)) as database, database:
        database.execute(_TABLE)
        database.execute(
            "INSERT INTO gpkg_contents (table_name, data_type, identifier)"
            " VALUES ('layer_styles', 'attributes', 'layer_styles')"
        )
        for layer in layers:
            database.execute(
                "INSERT INTO layer_styles (f_table_catalog, f_table_schema, f_table_name,"
                " f_geometry_column, styleName, styleQML, styleSLD, useAsDefault, description,"
                " owner) VALUES ('', '', ?, 'geom', ?, ?, '', 1, ?, '')",
                (layer.name, layer.kind.name.ja[:30], style_of_layer(layer), layer.kind.name.en),
            )


def style_of_layer(layer: StyledLayer) -> str:
    """A layer's style as QML."""
    root = ET.Element("qgis", {"version": "3.22.0", "styleCategories": "Symbology|Fields"})
    renderer = ET.SubElement(
        root, "renderer-v2", {"type": "categorizedSymbol", "attr": "status", "symbollevels": "0"}
    )
    categories = ET.SubElement(renderer, "categories")
    symbols = ET.SubElement(renderer, "symbols")
    for number, status in enumerate((Status.ACCEPTED, Status.CANDIDATE)):
        label = layer.kind.name.ja
        if status is not Status.ACCEPTED:
            label = f"{label}（候補）"
        ET.SubElement(
            categories,
            "category",
            {"symbol": str(number), "value": status.value, "label": label, "render": "true"},
        )
        alpha = _WHOLE if status is Status.ACCEPTED else _PALE
        symbol = ET.SubElement(
            symbols,
            "symbol",
            {"name": str(number), "type": _TYPES[layer.geometry], "alpha": alpha},
        )
        _add_look(symbol, layer)
    aliases = ET.SubElement(root, "aliases")
    for number, column in enumerate(layer.columns):
        ET.SubElement(
            aliases,
            "alias",
            {"index": str(number), "field": column, "name": _alias(column, layer.kind)},
        )
    return "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n" + ET.tostring(
        root, encoding="unicode"
    )


def _alias(column: str, kind: FeatureKind) -> str:
    own = {
        "kind": "種別ID",
        "status": "状態",
        "confidence": "信頼度",
        "tool": "作成方法",
    }
    found: AttributeField | None = kind.attribute(column)
    if found is None:
        return own.get(column, "")
    return f"{found.name.ja} [{found.unit}]" if found.unit else found.name.ja


def _add_look(symbol: ET.Element, layer: StyledLayer) -> None:
    kind = layer.kind
    red, green, blue = (int(kind.colour[at : at + 2], 16) for at in (1, 3, 5))
    colour, fill = f"{red},{green},{blue},255", f"{red},{green},{blue},{_FILL_ALPHA}"
    match layer.geometry:
        case Geometry.LINE:
            dashes = [abs(one) * _MM_PER_M for one in LINE_TYPES[kind.line_type]]
            options = {
                "line_color": colour,
                "line_width": f"{pen_mm_of(kind):g}",
                "line_width_unit": "MM",
                "capstyle": "flat",
                "joinstyle": "round",
                "use_custom_dash": "1" if dashes else "0",
                "customdash": ";".join(f"{one:g}" for one in dashes) or "5;2",
                "customdash_unit": "MM",
            }
            _add_layer(symbol, "SimpleLine", options)
        case Geometry.AREA:
            options = {
                "color": fill,
                "style": "solid",
                "outline_color": colour,
                "outline_width": f"{pen_mm_of(kind):g}",
                "outline_width_unit": "MM",
                "outline_style": "solid",
            }
            _add_layer(symbol, "SimpleFill", options)
        case Geometry.POINT if kind.symbol:
            options = {
                "name": _embedded(kind),
                "size": f"{_SYMBOL_MM:g}",
                "size_unit": "MM",
                "color": colour,
                "outline_color": colour,
                "outline_width": "0",
                "angle": "0",
            }
            made = _add_layer(symbol, "SvgMarker", options)
            _turn(made, layer)
        case Geometry.POINT:
            options = {
                "name": "circle",
                "size": f"{_DOT_MM:g}",
                "size_unit": "MM",
                "color": colour,
                "outline_color": colour,
            }
            _add_layer(symbol, "SimpleMarker", options)


def _add_layer(symbol: ET.Element, class_: str, options: dict[str, str]) -> ET.Element:
    layer = ET.SubElement(
        symbol, "layer", {"class": class_, "pass": "0", "locked": "0", "enabled": "1"}
    )
    parent = ET.SubElement(layer, "Option", {"type": "Map"})
    for name, value in options.items():
        ET.SubElement(parent, "Option", {"type": "QString", "name": name, "value": value})
        # What QGIS before 3.26 reads.
        ET.SubElement(layer, "prop", {"k": name, "v": value})
    return layer


def _turn(made: ET.Element, layer: StyledLayer) -> None:
    """Turn a symbol to where its feature faces, clockwise from north in both."""
    field = next((one for one in _TURNED_BY if one in layer.columns), None)
    if field is None:
        return
    own = ET.SubElement(ET.SubElement(made, "data_defined_properties"), "Option", {"type": "Map"})
    ET.SubElement(own, "Option", {"type": "QString", "name": "name", "value": ""})
    every = ET.SubElement(own, "Option", {"type": "Map", "name": "properties"})
    angle = ET.SubElement(every, "Option", {"type": "Map", "name": "angle"})
    ET.SubElement(angle, "Option", {"type": "bool", "name": "active", "value": "true"})
    ET.SubElement(
        angle,
        "Option",
        {"type": "QString", "name": "expression", "value": f'coalesce("{field}",0)'},
    )
    ET.SubElement(angle, "Option", {"type": "int", "name": "type", "value": "3"})
    ET.SubElement(own, "Option", {"type": "QString", "name": "type", "value": "collection"})


def _embedded(kind: FeatureKind) -> str:
    """The symbol's drawing in the kind's colour, inside the style: no file to lose."""
    drawing = path_of(f"symbols/{kind.symbol}.svg").read_text(encoding="utf-8")
    coloured = re.sub("currentColor", kind.colour, drawing)
    return "base64:" + base64.b64encode(coloured.encode("utf-8")).decode("ascii")

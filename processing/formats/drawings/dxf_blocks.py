"""Blocks of symbols, and the attributes that their references carry."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from processing.core.text import Language
from processing.formats.drawings.dxf_document import DxfDocument
from processing.formats.drawings.dxf_text import dxf_text
from processing.formats.drawings.symbol_shapes import symbol_shapes
from processing.map.catalogue import AttributeField, FeatureKind
from processing.map.feature import AttributeValue, Feature

_INVISIBLE = 1  # DXF reference, ATTDEF and ATTRIB, group 70
_HEIGHT_M = 1.0
_LONGEST_BYTES = 250  # of a text in DXF; the extended data hold longer ones whole


# Any: ezdxf is not typed here.
def need_symbol_block(document: DxfDocument, symbol: str) -> Any:
    """Give the block of a symbol; it is made if the drawing lacks it.

    It is drawn by the layer's colour.
    """
    name = f"ZUKA_{symbol.upper()}"
    if name in document.doc.blocks:
        return document.doc.blocks.get(name)
    block = document.doc.blocks.new(name)
    draw_outline = block.add_lwpolyline if document.has_light_polylines else block.add_polyline2d
    looks = {"layer": "0", "color": 0, "linetype": "BYBLOCK"}
    for shape in symbol_shapes(symbol):
        if shape.radius:
            block.add_circle(shape.points[0], shape.radius, dxfattribs=looks)
        elif len(shape.points) == 2:
            block.add_line(*shape.points, dxfattribs=looks)
        else:
            draw_outline(shape.points, close=shape.is_closed, dxfattribs=looks)
    return block


def define_attributes(block: Any, fields: Mapping[str, AttributeField]) -> None:
    """Say in a block what its references can know, once; nothing of it is drawn.

    Parameters
    ----------
    fields : mapping of str to AttributeField
        By id, of all kinds that have the symbol.
    """
    if any(True for _ in block.query("ATTDEF")):
        return
    for one in fields.values():
        looks = {"layer": "0", "height": _HEIGHT_M, "flags": _INVISIBLE, "prompt": one.name.en}
        block.add_attdef(_tag(one.id), (0.0, 0.0), dxfattribs=looks)


def block_values(kind: FeatureKind, feature: Feature, language: Language | None) -> dict[str, str]:
    """What is known about a feature of a kind as texts, by id; empty values are left out."""
    values: dict[str, str] = {}
    for field in kind.attributes:
        value = feature.attributes.get(field.id)
        if value not in (None, ""):
            values[field.id] = _words(field, value, language)
    return values


def add_attributes(insert: Any, values: Mapping[str, str], encoding: str) -> None:
    """Give a block reference its attributes, which are not drawn."""
    place = insert.dxf.insert
    looks = {"layer": insert.dxf.layer, "height": _HEIGHT_M, "flags": _INVISIBLE}
    for id_, words in values.items():
        written = dxf_text(words, encoding)
        if len(written.encode(encoding)) <= _LONGEST_BYTES:
            insert.add_attrib(_tag(id_), written, place, dxfattribs=looks)


def _tag(id_: str) -> str:
    """As CAD programs ask for it: upper case, without blanks."""
    return dxf_text(id_.upper().replace(" ", "_"), "ascii")


def _words(field: AttributeField, value: AttributeValue, language: Language | None) -> str:
    if isinstance(value, bool):
        return str(int(value))
    if isinstance(value, float):
        return f"{value:.3f}" if math.isfinite(value) else ""
    words = str(value)
    return words if language is None else field.name_of_choice(words).in_language(language)

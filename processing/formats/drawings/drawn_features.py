"""A drawing (DXF) read as a map: points, lines and areas with their layers.

Drawings of this program say more in their extended data: kind, attributes, status, id.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from processing.core.arrays import Floats
from processing.formats.drawings.drawn_outlines import opened_drawing, system_of_drawing
from processing.formats.drawings.dxf_document import APP_ID, SHEET_MARK
from processing.scoring.features.mapped_features import GeometryType, MappedFeature, MappedFile

LAYER = "layer"
"""Fact of a drawn feature: the layer it lies on."""

_ARC_M = 1e-3  # as of outlines
_CLOSED_M = 1e-3
_DRAWN = "POINT INSERT LINE LWPOLYLINE POLYLINE"
_APP_CODE = 1001
_OWN = ("id", "kind", "status", "confidence", "tool")
_GROUP = (1002, "{")


def read_dxf_features(path: Path) -> MappedFile:
    """The points, block references, lines and polylines of a drawing's model space.

    Numbers are metres whatever the drawing says of its units. Polylines that are closed, or end
    where they begin, are areas. Light polylines lie at their elevation; meshes, texts and what is
    inside blocks are passed over, and so is the paper around the map on this program's sheets.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, or is no DXF.
    """
    features: list[MappedFeature] = []
    with opened_drawing(path) as drawing:
        for entity in drawing.modelspace().query(_DRAWN):
            found = None if _is_of_sheet(entity) else _shape_of(entity)
            if found is not None and np.isfinite(found[1]).all():
                facts = {LAYER: entity.dxf.layer, **_said(entity)}
                features.append(MappedFeature(len(features) + 1, *found, facts))
        return MappedFile(path, system_of_drawing(drawing), tuple(features))


# Any: as of _shape_of.
def _is_of_sheet(entity: Any) -> bool:
    """Whether it belongs to the paper around the map, as the legend's samples do."""
    tags = entity.get_xdata(APP_ID) if entity.has_xdata(APP_ID) else []
    return [tag.value for tag in tags if tag.code != _APP_CODE] == [SHEET_MARK]


# Any: an entity of ezdxf, which is not typed here.
def _shape_of(entity: Any) -> tuple[GeometryType, Floats] | None:
    match entity.dxftype():
        case "POINT":
            return "point", _places([entity.dxf.location])
        case "INSERT":
            return "point", _places([entity.dxf.insert])
        case "LINE":
            return "line", _places([entity.dxf.start, entity.dxf.end])
    return _polyline(entity)


# Any: as of _shape_of.
def _polyline(entity: Any) -> tuple[GeometryType, Floats] | None:
    from ezdxf.path import make_path

    if entity.dxftype() == "POLYLINE" and not (entity.is_2d_polyline or entity.is_3d_polyline):
        return None
    xyz = _places(make_path(entity).flattening(_ARC_M) if len(entity) > 1 else ())
    is_closed = len(xyz) > 1 and float(np.linalg.norm(xyz[0] - xyz[-1])) <= _CLOSED_M
    if is_closed:
        xyz = xyz[:-1]
    if (is_closed or entity.is_closed) and len(xyz) > 2:
        return "area", xyz
    return ("line", xyz) if len(xyz) > 1 else None


# Any: vectors of ezdxf.
def _places(vectors: Any) -> Floats:
    return np.array([(one.x, one.y, one.z) for one in vectors], np.float64).reshape(-1, 3)


# Any: as of _shape_of.
def _said(entity: Any) -> dict[str, object]:
    """What the extended data of this program says."""
    if not entity.has_xdata(APP_ID):
        return {}
    tags = [(tag.code, tag.value) for tag in entity.get_xdata(APP_ID) if tag.code != _APP_CODE]
    first = tags.index(_GROUP) if _GROUP in tags else len(tags)
    said: dict[str, object] = dict(zip(_OWN, (value for _, value in tags[:first]), strict=False))
    said.update(_attributes(tags[first:]))
    return said


def _attributes(tags: list[tuple[int, Any]]) -> Iterator[tuple[str, object]]:
    """Lists of a name and a value, texts in pieces."""
    group: list[tuple[int, Any]] = []
    for code, value in tags:
        if (code, value) == _GROUP:
            group = []
        elif (code, value) == (1002, "}") and len(group) > 1:
            name, values = str(group[0][1]), group[1:]
            is_text = values[0][0] == 1000
            whole = "".join(str(one) for _, one in values) if is_text else values[0][1]
            yield name, bool(whole) if values[0][0] == 1070 else whole
        else:
            group.append((code, value))

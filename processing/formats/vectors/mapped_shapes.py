"""Maps as tools and exports write them, read back for scores: GeoJSON and GeoPackage."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import BadFile, report_as_user_error
from processing.core.japanese_text import read_text
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.formats.vectors.geojson_shapes import WHERE, read_collection, shapes_of, system_of
from processing.scoring.features.mapped_features import GeometryType, MappedFeature, MappedFile

_GEOPACKAGE_SHAPES: dict[str, GeometryType] = {
    "Point": "point",
    "LineString": "line",
    "Polygon": "area",
}
_AGAIN = Text(
    "Write the file again with the tool, or copy it again.",
    "ツールで出力し直すか、ファイルをコピーし直してください。",
)


def read_mapped(path: Path) -> MappedFile:
    """The features of a map file, by the ending of its name.

    Parameters
    ----------
    path : Path
        ``.geojson`` (or ``.json``) or ``.gpkg``. Parts of a multi-geometry are features of their
        own with the same facts; holes of polygons are left out.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, is damaged, or is no map.
    OutOfRange
        The ending says another format.
    """
    found: MappedFile = FORMATS.format_to_read(path, Content.FEATURES).reader(Content.FEATURES)(
        path
    )
    return found


def read_geojson_features(path: Path) -> MappedFile:
    """Read a GeoJSON, as :func:`read_mapped`."""
    text = read_text(path)
    if not text.lstrip("\ufeff \t\r\n").startswith("{"):
        raise BadFile(
            Text("The file is no GeoJSON.", "GeoJSONではありません。"),
            Text.same(str(path)),
            _AGAIN,
        )
    try:
        whole, members = read_collection(text)
        shapes, features = [], []
        for number, member in enumerate(members, 1):
            facts = member.get("properties")
            for shape in shapes_of(member.get("geometry"), number):
                shapes.append(shape)
                if shape.is_hole:
                    continue
                xyz = np.array(shape.positions, dtype=np.float64)
                if shape.heightless:
                    xyz[:, 2] = np.nan
                features.append(
                    MappedFeature(
                        number,
                        shape.geometry.value,
                        xyz,
                        facts if isinstance(facts, dict) else {},
                    )
                )
        return MappedFile(path, system_of(whole, shapes), tuple(features))
    except BadFile as error:
        # The reader speaks of a clipboard and a map to paste into.
        position = Text(
            error.where.en.removeprefix(WHERE.en), error.where.ja.removeprefix(WHERE.ja)
        )
        raise BadFile(
            error.what, Text(f"{path}{position.en}", f"{path}{position.ja}"), _AGAIN
        ) from error


def read_geopackage_features(path: Path) -> MappedFile:
    """Read a GeoPackage, as :func:`read_mapped`."""
    import pyogrio
    import pyogrio.raw
    from pyogrio.errors import DataLayerError, DataSourceError

    with report_as_user_error(path), path.open("rb"):
        # The library's own words for a missing file, or a name that is no text, help nobody.
        str(path).encode()
    features: list[MappedFeature] = []
    systems: set[str] = set()
    try:
        for layer, shape_type in pyogrio.list_layers(path):
            if shape_type is None:  # a table, such as that of styles
                continue
            reported, _, shapes, columns = pyogrio.raw.read(path, layer=layer)
            systems.add(reported["crs"] or "")
            rows = zip(shapes, *columns, strict=True)
            for shape, *values in rows:
                facts = dict(zip(reported["fields"], map(_plain, values), strict=True))
                features += _of_wkb(shape, facts, len(features) + 1)
    except (DataLayerError, DataSourceError) as error:
        raise BadFile(
            Text("The file is no GeoPackage.", "GeoPackageではありません。"),
            Text.same(str(path)),
            _AGAIN,
        ) from error
    return MappedFile(path, systems.pop() if len(systems) == 1 else "", tuple(features))


# Any: a value of a column of whatever type the file has.
def _plain(value: Any) -> object:
    plain = value.item() if isinstance(value, np.generic) else value
    return None if isinstance(plain, float) and np.isnan(plain) else plain


def _of_wkb(shape: bytes | None, facts: dict[str, object], number: int) -> Iterator[MappedFeature]:
    import shapely

    if shape is None:
        return
    for part in shapely.get_parts(shapely.from_wkb(shape)):
        kind = _GEOPACKAGE_SHAPES.get(part.geom_type)
        if kind is None or part.is_empty:
            continue
        outline = part.exterior if kind == "area" else part
        xyz: Floats = shapely.get_coordinates(outline, include_z=True)
        yield MappedFeature(number, kind, xyz[:-1] if kind == "area" else xyz, facts)

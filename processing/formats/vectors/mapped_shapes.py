"""Maps as tools and exports write them, read back for scores: GeoJSON, GeoPackage, Shapefile."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import BadFile, Unsuitable, report_as_user_error
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
_SURE = 25
"""Names and parameters agree (PROJ): the .prj of ESRI's programs says no code."""

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
    with report_as_user_error(path), path.open("rb"):
        # The library's own words for a missing file, or a name that is no text, help nobody.
        str(path).encode()
    return read_layers(path, Text.same("GeoPackage"))


def read_layers(path: Path, name: Text, *, encoding: str = "", layer: str = "") -> MappedFile:
    """The features of all layers of a file that GDAL reads, as :func:`read_mapped`.

    Parameters
    ----------
    name : Text
        What such a file is called, for messages.
    encoding : str
        Of its texts; empty where the format says it.
    layer : str
        The layer of features that name none; empty: as the file calls it.

    Raises
    ------
    BadFile
        It can't be read as such a file.
    Unsuitable
        Its layers are in different reference systems.
    """
    import pyogrio
    import pyogrio.raw
    import shapely
    from pyogrio.errors import CRSError, DataLayerError, DataSourceError, FeatureError

    features: list[MappedFeature] = []
    systems: dict[str, str] = {}
    try:
        for own, shape_type in pyogrio.list_layers(path):
            if shape_type is None:  # a table, such as that of styles
                continue
            reported, _, shapes, columns = pyogrio.raw.read(
                path, layer=own, encoding=encoding or None
            )
            systems[own] = _code_of(reported["crs"] or "")
            rows = zip(shapes, *columns, strict=True)
            for shape, *values in rows:
                facts = dict(zip(reported["fields"], map(_plain, values), strict=True))
                facts.setdefault("layer", layer or own)
                features += _of_wkb(shape, facts, len(features) + 1, path)
    except (
        CRSError, DataLayerError, DataSourceError, FeatureError, UnicodeError,
        shapely.GEOSException,
    ) as error:  # fmt: skip
        raise BadFile(
            Text("The file is no {name}.", "{name}ではありません。").filled(name=name),
            Text.same(str(path)),
            _AGAIN,
        ) from error
    return MappedFile(path, _one_system(path, systems), tuple(features))


def _one_system(path: Path, systems: dict[str, str]) -> str:
    if len(set(systems.values())) > 1:
        raise Unsuitable(
            Text(
                "The layers of the file are in different reference systems.",
                "レイヤの座標参照系が統一されていません。",
            ),
            Text.same(f"{path}: " + ", ".join(f"{n} {c or '?'}" for n, c in systems.items())),
            Text(
                "Write all of them in one reference system.",
                "1つの座標参照系にそろえて出力し直してください。",
            ),
        )
    return next(iter(systems.values()), "")


def _code_of(crs: str) -> str:
    """``EPSG:n`` of a system as the library gives it; empty where it has no code."""
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    if not crs or crs.startswith("EPSG:"):
        return crs
    try:
        found = CRS.from_user_input(crs).to_authority(min_confidence=_SURE)
    except CRSError:
        return ""
    return ":".join(found) if found else ""


# Any: a value of a column of whatever type the file has.
def _plain(value: Any) -> object:
    plain = value.item() if isinstance(value, np.generic) else value
    return None if isinstance(plain, float) and np.isnan(plain) else plain


def _of_wkb(
    shape: bytes | None, facts: dict[str, object], number: int, path: Path
) -> Iterator[MappedFeature]:
    import shapely

    if shape is None:
        return
    with np.errstate(invalid="ignore"):  # coordinates that are no numbers: told below
        parts = shapely.get_parts(shapely.from_wkb(shape))
    for part in parts:
        kind = _GEOPACKAGE_SHAPES.get(part.geom_type)
        if kind is None or part.is_empty:
            continue
        outline = part.exterior if kind == "area" else part
        xyz: Floats = shapely.get_coordinates(outline, include_z=True)
        if not np.isfinite(xyz[:, :2]).all():
            raise BadFile(
                Text("A coordinate is no number.", "座標が数値ではありません。"),
                Text("{path}, feature {number}", "{path}、地物{number}").filled(
                    path=path, number=number
                ),
                _AGAIN,
            )
        yield MappedFeature(number, kind, xyz[:-1] if kind == "area" else xyz, facts)

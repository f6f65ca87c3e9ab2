"""GeoPackage: one layer for each kind, 3D, in the project's reference system."""

from __future__ import annotations

import math
import sqlite3
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import NoSpace
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.formats.map_delivery import MapDelivery, Position
from processing.formats.vectors.layer_styles import StyledLayer, add_layer_styles
from processing.map.catalogue import (
    RESERVED_ATTRIBUTES,
    AttributeField,
    AttributeType,
    Catalogue,
    Geometry,
)
from processing.map.feature import AttributeValue, Feature

GEOMETRY_TYPES = {
    Geometry.POINT: "Point Z",
    Geometry.LINE: "LineString Z",
    Geometry.AREA: "Polygon Z",
}
"""As the library calls them."""

_INT64 = 1 << 63


def write_geopackage(
    path: Path,
    features: Iterable[Feature],
    catalogue: Catalogue,
    *,
    crs: str,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Write features, a layer for each kind named by its id.

    Parameters
    ----------
    features : iterable of Feature
        Written in their order; coordinates are kept to the last bit (easting, northing, height).
        A kind that is drawn in a shape other than the catalogue's gets a second layer
        (``kerb_line``) for it.
    catalogue : Catalogue
        Gives the layers' descriptions and the order of their columns.
    crs : str
        ``EPSG:n``; empty where it is not known: the layers then name none.
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    NoSpace
        The library can't write the file.
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.
    """
    with write_safely(path, never=never) as temporary:
        _write_layers(temporary, features, catalogue, crs, monitor or SilentMonitor())


def _write_layers(
    path: Path, features: Iterable[Feature], catalogue: Catalogue, crs: str, monitor: Monitor
) -> list[StyledLayer]:
    """Write features, a layer for each kind; gives those of the catalogue's kinds."""
    layers: dict[tuple[str, Geometry], list[Feature]] = {}
    for feature in features:
        layers.setdefault((feature.kind, feature.geometry), []).append(feature)
    styled: list[StyledLayer] = []
    for number, ((kind, geometry), members) in enumerate(layers.items()):
        monitor.check()
        monitor.report(number / len(layers))
        is_usual = kind not in catalogue or catalogue[kind].geometry is geometry
        layer = _Layer(
            name=_storable(kind if is_usual else f"{kind}_{geometry.value}"),
            title=catalogue[kind].name.ja if kind in catalogue else "",
            geometry_type=GEOMETRY_TYPES[geometry],
            fields=catalogue[kind].attributes if kind in catalogue else (),
        )
        columns = _write_layer(path, layer, members, crs)
        if kind in catalogue:
            styled.append(StyledLayer(layer.name, catalogue[kind], geometry, columns))
    if not layers:  # a GeoPackage without any layer is none
        _write_layer(path, _Layer("features", "", "Unknown", ()), (), crs)
    return styled


def write_geopackage_features(
    path: Path, delivery: MapDelivery, monitor: Monitor, *, never: Iterable[Path] = ()
) -> None:
    """Write a map that is handed in, as :func:`write_geopackage`."""
    write_geopackage(
        path,
        delivery.features,
        delivery.catalogue,
        crs=delivery.crs,
        monitor=monitor,
        never=never,
    )


def write_geopackage_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write a map that is handed in, as :func:`write_geopackage`, with styles for QGIS.

    Raises
    ------
    NoSpace, Cancelled
    """
    with write_safely(position(f"{delivery.name}.gpkg")) as temporary:
        layers = _write_layers(
            temporary, delivery.features, delivery.catalogue, delivery.crs, monitor
        )
        try:
            add_layer_styles(temporary, layers)
        except sqlite3.Error as error:
            raise _make_refusal(temporary, error) from error


@dataclass(frozen=True)
class _Layer:
    """A layer of the file: its name, what it is called, its shape, its attributes."""

    name: str
    title: str
    geometry_type: str
    fields: tuple[AttributeField, ...]


def _write_layer(
    path: Path, layer: _Layer, features: Sequence[Feature], crs: str
) -> tuple[str, ...]:
    """Write a layer; gives the names of its columns."""
    import pyogrio.raw
    from pyogrio.errors import DataLayerError, DataSourceError

    columns = feature_columns(features, layer.fields)
    with warnings.catch_warnings():
        # Said by the export itself, once: the reference system is not known.
        warnings.filterwarnings("ignore", "'crs' was not provided", UserWarning)
        try:
            pyogrio.raw.write(
                str(path),
                feature_shapes(features),
                [values for values, _ in columns.values()],
                list(columns),
                field_mask=[missing for _, missing in columns.values()],
                layer=layer.name,
                driver="GPKG",
                geometry_type=layer.geometry_type,
                crs=crs or None,
                nan_as_null=True,
                layer_options={"DESCRIPTION": layer.title},
            )
        except (DataLayerError, DataSourceError) as error:
            raise _make_refusal(path, error) from error
    return tuple(columns)


def _make_refusal(path: Path, error: Exception) -> NoSpace:
    # Before its reason the library quotes pages of what it wanted to do.
    reason = " ".join(str(error).rsplit("failed: ", 1)[-1].split()).rstrip(".")
    return NoSpace(
        Text(
            f"The GeoPackage can't be written: {reason}.",
            f"GeoPackageを書き込めません（{reason}）。",
        ),
        Text.same(str(path.parent)),
        Text(
            "Check that the disk has space and allows writing; nothing is half written.",
            "ディスクの空き容量と書き込みの可否を確認してください。書きかけのファイルは残りません。",
        ),
    )


ColumnValues = tuple[NDArray[Any], NDArray[np.bool_]]  # text, float64 or int64; True where missing


def feature_columns(
    features: Sequence[Feature], fields: Sequence[AttributeField]
) -> Mapping[str, ColumnValues]:
    """The columns of a layer: what every feature has, then attributes as the catalogue has them."""
    columns: dict[str, ColumnValues] = {
        "id": _text([feature.id for feature in features]),
        "kind": _text([feature.kind for feature in features]),
        "status": _text([feature.status.value for feature in features]),
        "confidence": _column(
            [float(feature.provenance.confidence) for feature in features], "number"
        ),
        "tool": _text([feature.provenance.tool for feature in features]),
    }
    types = {one.id: one.type for one in fields}
    found = [name for feature in features for name in feature.attributes]
    taken = {name.lower() for name in columns} | RESERVED_ATTRIBUTES
    for name in dict.fromkeys((*types, *found)):
        own = _free_name(name, taken)
        taken.add(own.lower())
        columns[own] = _column(
            [feature.attributes.get(name) for feature in features], types.get(name, "text")
        )
    return columns


def _free_name(name: str, taken: set[str]) -> str:
    """A column's name: SQLite takes “Height” and “height” for the same."""
    own = _storable(name).strip() or "attribute"
    number = 2
    candidate = own if own.lower() not in taken else f"attribute_{own}"
    while candidate.lower() in taken:
        candidate = f"{own}_{number}"
        number += 1
    return candidate


def _column(values: Sequence[AttributeValue], type_: AttributeType) -> ColumnValues:
    """Whole numbers, numbers, or text, whichever holds all values; by ``type_`` if empty."""
    kept = [None if isinstance(one, float) and math.isnan(one) else one for one in values]
    present = [one for one in kept if one is not None]
    missing = np.array([one is None for one in kept], dtype=np.bool_)
    numbers = [one for one in present if isinstance(one, (int, float))]
    if len(numbers) == len(present) and (present or type_ in ("number", "count")):
        is_whole = all(isinstance(one, int) and -_INT64 <= one < _INT64 for one in numbers)
        is_whole = is_whole and type_ != "number"
        if is_whole:
            return np.array([one or 0 for one in kept], dtype=np.int64), missing
        if all(isinstance(one, float) or abs(one) <= 1 << 53 for one in numbers):
            return np.array([math.nan if one is None else one for one in kept], float), missing
    return _text(kept)


def _text(values: Sequence[AttributeValue]) -> ColumnValues:
    texts = [None if one is None else _storable(str(one)) for one in values]
    return np.array(texts, dtype=object), np.array([one is None for one in texts], dtype=np.bool_)


def _storable(text: str) -> str:
    """Text that SQLite and UTF-8 can hold: a NUL would end it early."""
    return text.replace("\0", "\ufffd").encode("utf-8", "replace").decode("utf-8")


def feature_shapes(features: Sequence[Feature]) -> NDArray[Any]:
    """Well-known binary of each feature, with heights."""
    import shapely

    shapes = []
    for feature in features:
        xyz = np.array([vertex.xyz for vertex in feature.vertices], dtype=np.float64)
        match feature.geometry:
            case Geometry.POINT:
                shapes.append(shapely.Point(xyz[0]))
            case Geometry.LINE:
                shapes.append(shapely.LineString(xyz))
            case Geometry.AREA:
                shapes.append(shapely.Polygon(xyz))
    return np.asarray(shapely.to_wkb(np.array(shapes, dtype=object), output_dimension=3))

"""GeoJSON in the project's reference system: what GIS programs and scripts read.

RFC 7946 knows only WGS 84; the older ``crs`` member, which GDAL and QGIS read, names ours.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from processing.core.monitor import Monitor, SilentMonitor
from processing.core.safe_write import write_safely
from processing.formats.map_delivery import MapDelivery
from processing.formats.vectors.geojson_shapes import JsonObject, crs_member
from processing.map.catalogue import RESERVED_ATTRIBUTES, Geometry
from processing.map.feature import AttributeValue, Feature

_CHECK_EVERY = 256

ESCAPE = "attribute_"
"""Before the name of an attribute that is a property's."""


def write_geojson(
    path: Path,
    features: Iterable[Feature],
    *,
    crs: str,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Write features with all their attributes, one on a line.

    Parameters
    ----------
    features : iterable of Feature
        Written in their order; coordinates are kept to the last bit (easting, northing, height).
    crs : str
        ``EPSG:n``; empty where it is not known, which the file then says (``"crs": null``).
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.

    References
    ----------
    RFC 7946; GeoJSON format specification 2008, section 3 (crs).
    """
    members = map(member_of, features)
    write_members(path, members, crs=crs, monitor=monitor, never=never)


def write_geojson_features(
    path: Path, delivery: MapDelivery, monitor: Monitor, *, never: Iterable[Path] = ()
) -> None:
    """Write a map that is handed in, as :func:`write_geojson`."""
    write_geojson(path, delivery.features, crs=delivery.crs, monitor=monitor, never=never)


def write_members(
    path: Path,
    members: Iterable[dict[str, Any]],
    *,
    crs: str,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Write features that are GeoJSON members already (properties may be nested), one on a line.

    Raises
    ------
    UserError
        As `write_geojson`.
    """
    monitor = monitor or SilentMonitor()
    with (
        write_safely(path, never=never) as temporary,
        temporary.open("w", encoding="utf-8", errors="backslashreplace", newline="\n") as file,
    ):
        file.write(f'{{"type": "FeatureCollection",\n"crs": {_line(crs_member(crs))},\n')
        file.write('"features": [')
        for number, member in enumerate(members):
            if number % _CHECK_EVERY == 0:
                monitor.check()
            file.write((",\n" if number else "\n") + _line(member))
        file.write("\n]}\n")


def _line(value: Any) -> str:  # whatever JSON can hold
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def member_of(feature: Feature) -> JsonObject:
    """A feature with its attributes as properties; one that has a property's name is escaped."""
    properties: dict[str, AttributeValue] = {
        "kind": feature.kind,
        "confidence": _finite(feature.provenance.confidence),
        "status": feature.status.value,
        "tool": feature.provenance.tool,
    }
    for name, value in feature.attributes.items():
        properties[ESCAPE + name if is_reserved(name) else name] = _finite(value)
    return {
        "type": "Feature",
        "id": feature.id,
        "geometry": _geometry(feature),
        "properties": properties,
    }


def is_reserved(name: str) -> bool:
    """Whether a property has this name, or it is one that was escaped."""
    while name.startswith(ESCAPE):
        name = name.removeprefix(ESCAPE)
    return name in RESERVED_ATTRIBUTES


def _geometry(feature: Feature) -> JsonObject:
    positions = [vertex.xyz for vertex in feature.vertices]
    match feature.geometry:
        case Geometry.POINT:
            return {"type": "Point", "coordinates": positions[0]}
        case Geometry.LINE:
            return {"type": "LineString", "coordinates": positions}
        case Geometry.AREA:
            return {"type": "Polygon", "coordinates": [[*positions, positions[0]]]}


def _finite(value: AttributeValue) -> AttributeValue:
    """JSON has no number for what is not finite."""
    return None if isinstance(value, float) and not math.isfinite(value) else value

"""Features as one file, by the ending of its name: what ``zuka run`` gives for tools that find."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from processing.core.errors import OutOfRange
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.drawings.dxf import write_dxf
from processing.formats.ledgers.ledger_columns import TableStyle
from processing.formats.ledgers.ledger_csv import write_features
from processing.formats.vectors.geojson import write_geojson
from processing.formats.vectors.geopackage import write_geopackage
from processing.map.catalogue import Catalogue
from processing.map.feature import Feature

ENDINGS = (".geojson", ".gpkg", ".csv", ".dxf")
"""What a file of features may be called."""

_DIGITS = 3


def check_ending(path: Path) -> None:
    """Refuse a name whose ending says no known format.

    Raises
    ------
    OutOfRange
    """
    if path.suffix.lower() not in ENDINGS:
        raise OutOfRange(
            Text(
                "What this tool finds is written as GeoJSON, GeoPackage, CSV or DXF.",
                "このツールの結果はGeoJSON・GeoPackage・CSV・DXFで出力します。",
            ),
            Text.same(str(path)),
            Text(
                "Give a name ending in .geojson, .gpkg, .csv or .dxf.",
                ".geojson・.gpkg・.csv・.dxf のいずれかで終わる名前にしてください。",
            ),
        )


def write_feature_file(
    path: Path,
    features: Sequence[Feature],
    catalogue: Catalogue,
    crs: str,
    monitor: Monitor,
    *,
    never: Iterable[Path] = (),
) -> None:
    """Write features with kind, confidence, status and attributes.

    Parameters
    ----------
    path : Path
        Its ending says the format.
    crs : str
        ``EPSG:n``; empty where it is not known, which the file then says.
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    OutOfRange
        The ending says no known format.
    UserError
        What stands against writing; `Cancelled`.
    """
    check_ending(path)
    match path.suffix.lower():
        case ".geojson":
            write_geojson(path, features, crs=crs, monitor=monitor, never=never)
        case ".gpkg":
            write_geopackage(path, features, catalogue, crs=crs, monitor=monitor, never=never)
        case ".csv":
            style = TableStyle(None, "utf-8", _DIGITS, crs)
            write_features(path, features, catalogue, style, monitor=monitor, never=never)
        case _:
            write_dxf(path, features, catalogue, crs=crs, monitor=monitor, never=never)

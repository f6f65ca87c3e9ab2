"""Reference systems: as users name them, and as a GeoPackage wants them."""

from __future__ import annotations

import re
import sqlite3

from processing.core.errors import UNCHANGED, OutOfRange
from processing.core.text import Text

CRS = "crs"
"""Setting: ``EPSG:n`` of a project; empty when unknown."""

UNKNOWN_SRS = -1
"""The number of coordinates in metres whose reference system nobody knows."""


def reference_system(words: str) -> str:
    """A reference system's code in one spelling.

    Parameters
    ----------
    words : str
        ``EPSG:6677``, ``epsg:6677`` or ``6677``.

    Returns
    -------
    str
        ``EPSG:6677``.

    Raises
    ------
    OutOfRange
        It is no code, or there is no such projected system in metres.
    """
    found = re.fullmatch(r"(?:EPSG:)?\s*([0-9]{4,6})", words.strip(), flags=re.IGNORECASE)
    if found is None:
        raise _unknown(words)
    import pyproj
    from pyproj.exceptions import CRSError

    code = f"EPSG:{found.group(1)}"
    try:
        system = pyproj.CRS.from_user_input(code)
    except CRSError as error:
        raise _unknown(words) from error
    plan = system.sub_crs_list[0] if system.is_compound else system
    if not plan.is_projected or any(axis.unit_name != "metre" for axis in plan.axis_info):
        raise OutOfRange(
            Text(
                "The reference system {name} is not a plane one in metres.",
                "座標参照系 {name} はメートル単位の平面直角座標系ではありません。",
            ).filled(name=system.name),
            Text.same(words),
            Text(
                "Give that of the drawing, such as EPSG:6677 for zone IX of Japan.",
                "図面の座標系を指定してください（例: 第9系は EPSG:6677）。",
            ),
        )
    return code


def srs_number(crs: str) -> int:
    """``EPSG:n`` as a GeoPackage's number; that of the unknown for an empty text."""
    return int(crs.partition(":")[2]) if crs else UNKNOWN_SRS


def write_reference_system(connection: sqlite3.Connection, crs: str) -> None:
    """Say in a GeoPackage's tables, in the caller's transaction, what ``features`` is in.

    Parameters
    ----------
    crs : str
        Of :func:`reference_system`; empty for an unknown one.
    """
    number = srs_number(crs)
    if crs:
        import pyproj

        system = pyproj.CRS.from_user_input(crs)
        plan = system.sub_crs_list[0] if system.is_compound else system
        connection.execute(
            "INSERT OR REPLACE INTO gpkg_spatial_ref_sys VALUES (?, ?, 'EPSG', ?, ?, NULL)",
            (system.name, number, number, plan.to_wkt("WKT1_GDAL")),
        )
    for table in ("gpkg_contents", "gpkg_geometry_columns"):
        connection.execute(
            f"UPDATE {table} SET srs_id = ? WHERE table_name = 'features'",  # noqa: S608 - constants
            (number,),
        )


def other_system(drive: str, theirs: str, ours: str) -> OutOfRange:
    """A drive, by its name, is in another system than the project."""
    return OutOfRange(
        Text(
            "The drive's reference system {theirs} is not the project's {ours}.",
            "走行データの座標参照系 {theirs} がプロジェクトの {ours} と異なります。",
        ).filled(theirs=theirs, ours=ours),
        Text.same(drive),
        Text(
            "Import it into a project of its own. {unchanged}",
            "別のプロジェクトにインポートしてください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def _unknown(words: str) -> OutOfRange:
    return OutOfRange(
        Text("There is no such reference system.", "そのような座標参照系はありません。"),
        Text.same(words),
        Text(
            "Give an EPSG code such as EPSG:6677.",
            "EPSG:6677 のようなEPSGコードを指定してください。",
        ),
    )

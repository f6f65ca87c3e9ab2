"""How LandXML names plane coordinate systems, heights and units, and what we call them.

LandXML leaves the names open; those of J-LandXML are the zone's number with ``(X,Y)``, the datum,
and the letters of the height's zero. Also codes of EPSG are met.
"""

from __future__ import annotations

import re
import unicodedata

ZONES = 19
"""Plane rectangular coordinate systems of Japan, numbered from 1."""

_FIRST_ZONE = {"JGD2011": 6668, "JGD2000": 2442, "TOKYO": 30160}
"""A zone's EPSG code less its number."""

_DATUMS = {
    "JGD2011": "JGD2011",
    "JGD2024": "JGD2011",  # of 2025; heights changed, plane coordinates did not
    "JGD2000": "JGD2000",
    "TD": "TOKYO",
    "TOKYO": "TOKYO",
    "TOKYODATUM": "TOKYO",
}
_ZONE = re.compile(r"(?:第)?([0-9]{1,2})(?:系|\(X,?Y\)|$)")
_CODE = re.compile(r"(?:EPSG:*)?([0-9]{4,6})")

_US_FOOT = 1200.0 / 3937.0
METRES = {
    "meter": 1.0,
    "millimeter": 1e-3,
    "centimeter": 1e-2,
    "decimeter": 1e-1,
    "kilometer": 1e3,
    "foot": 0.3048,
    "feet": 0.3048,
    "ussurveyfoot": _US_FOOT,
    "inch": 0.0254,
    "mile": 1609.344,
    "miles": 1609.344,
}
"""A unit of length, in small letters, in metres."""


def system_of_names(names: dict[str, str]) -> str:
    """The reference system that attributes of ``CoordinateSystem`` name.

    Returns
    -------
    str
        ``EPSG:n``, or empty where they name none that is known.

    References
    ----------
    LandXML 1.2 (epsgCode); J-LandXML 1.7 (horizontalDatum, horizontalCoordinateSystemName); EPSG:
    zone n is 6668 + n (JGD2011), 2442 + n (JGD2000), 30160 + n (Tokyo).
    """
    code = _CODE.fullmatch(names.get("epsgCode", "").strip())
    if code is not None:
        return f"EPSG:{code[1]}"
    words = unicodedata.normalize("NFKC", names.get("horizontalCoordinateSystemName", ""))
    zone = _ZONE.match(re.sub(r"\s", "", words).upper())
    spelt = re.sub(r"[\s_-]", "", names.get("horizontalDatum", "")).upper()
    datum = _DATUMS.get(spelt or "JGD2011", "")
    if zone is None or not datum or not 1 <= int(zone[1]) <= ZONES:
        return ""
    return f"EPSG:{_FIRST_ZONE[datum] + int(zone[1])}"


def names_of_system(crs: str) -> dict[str, str]:
    """A plane system of Japan as attributes of ``CoordinateSystem``; empty for any other.

    Parameters
    ----------
    crs : str
        ``EPSG:n``.
    """
    number = int(crs.partition(":")[2]) if re.fullmatch("EPSG:[0-9]+", crs) else 0
    for datum, first in _FIRST_ZONE.items():
        if 1 <= number - first <= ZONES:
            name = "TD" if datum == "TOKYO" else datum
            zone = f"{number - first}(X,Y)"
            return {"horizontalDatum": name, "horizontalCoordinateSystemName": zone}
    return {}


def zone_of_system(crs: str) -> int:
    """The zone of a plane system of Japan, 1 to 19; 0 for any other."""
    zone = names_of_system(crs).get("horizontalCoordinateSystemName", "0(")
    return int(zone.partition("(")[0])

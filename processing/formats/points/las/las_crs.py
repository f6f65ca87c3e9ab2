"""The reference system that a LAS file names: WKT, or GeoTIFF keys in the older files."""

from __future__ import annotations

import struct
from functools import lru_cache

from processing.formats.points.las.las_header import LasHeader

_USER = "LASF_Projection"
_WKT, _KEYS, _WORDS = 2112, 34735, 34737
_MODEL_KEY, _GEODETIC_KEY, _PROJECTED_KEY = 1024, 2048, 3072
_NAME_KEYS = (3073, 1026)
_GEOCENTRIC_MODEL = 3
_WGS84, _WGS84_GEOCENTRIC = 4326, 4978
_LOWEST_CODE, _USER_DEFINED = 1024, 32767


def crs_of(header: LasHeader) -> str:
    """The horizontal reference system of a LAS file.

    Returns
    -------
    str
        ``EPSG:n``; empty when none is named, or none that EPSG lists.
    """
    found = (header.vlr(_USER, number) for number in (_WKT, _KEYS, _WORDS))
    return crs_in_records(*(None if one is None else one.data for one in found))


def crs_in_records(wkt: bytes | None, keys: bytes | None, words: bytes | None) -> str:
    """The same of the records that LAS and PulseWaves have for it; None for one that isn't there.

    Parameters
    ----------
    wkt, keys, words : bytes or None
        WKT; the GeoTIFF directory; its words.
    """
    if wkt is not None:
        text = wkt.split(b"\0", 1)[0].decode("utf-8", "replace").strip()
        found = _from_wkt(text) if text else ""
        if found:
            return found
    return "" if keys is None else _from_geotiff(keys, words or b"")


@lru_cache(maxsize=64)
def _from_wkt(wkt: str) -> str:
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        system = CRS.from_wkt(wkt)
    except CRSError:
        return ""
    horizontal = system.sub_crs_list[0] if system.is_compound else system
    code = horizontal.to_epsg()
    # Writers nest and order WKT in ways that match no definition, and still give its right name.
    return f"EPSG:{code}" if code is not None else _from_name(horizontal.name)


def _from_geotiff(data: bytes, words: bytes) -> str:
    """By the directory: four numbers (version, revision, minor, count), then four for each key."""
    numbers = struct.unpack(f"<{len(data) // 2}H", data[: len(data) // 2 * 2])
    keys = dict(zip(numbers[4::4], numbers[7::4], strict=False))
    code = int(keys.get(_PROJECTED_KEY) or keys.get(_GEODETIC_KEY) or 0)
    if keys.get(_MODEL_KEY) == _GEOCENTRIC_MODEL:
        return f"EPSG:{_WGS84_GEOCENTRIC}" if code == _WGS84 else ""
    if _LOWEST_CODE <= code < _USER_DEFINED:
        return _from_name(f"EPSG:{code}")
    starts = {key: (numbers[i + 2], numbers[i + 3]) for i, key in _names_in(numbers)}
    for key in _NAME_KEYS:
        length, start = starts.get(key, (0, 0))
        name = (
            words[start : start + length].split(b"\0", 1)[0].decode("ascii", "replace").strip("| ")
        )
        found = _from_name(name) if name else ""
        if found:
            return found
    return ""


def _names_in(numbers: tuple[int, ...]) -> list[tuple[int, int]]:
    """Places of the keys whose value is a name, and the keys."""
    last = len(numbers) - 3
    return [(i, numbers[i]) for i in range(4, last, 4) if numbers[i + 1] == _WORDS]


@lru_cache(maxsize=64)
def _from_name(name: str) -> str:
    """The system of this very name or code; empty when the library knows none or several."""
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        system = CRS.from_user_input(name)
    except CRSError:
        return ""
    code = system.to_epsg()
    return "" if code is None else f"EPSG:{code}"

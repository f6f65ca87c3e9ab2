"""GeoPackage geometries: a header and well-known binary with heights, to and from vertices."""

from __future__ import annotations

import struct

from processing.project.catalogue import Geometry
from processing.project.feature import Position

_HEADER = struct.Struct("<2sBBi")
_LITTLE_ENDIAN_NO_ENVELOPE = 1
_WKB_TYPES = {Geometry.POINT: 1001, Geometry.LINE: 1002, Geometry.AREA: 1003}
_GEOMETRIES = {code: geometry for geometry, code in _WKB_TYPES.items()}


def blob_of(geometry: Geometry, places: tuple[Position, ...], srs_id: int) -> bytes:
    """A geometry as GeoPackage keeps it: GP header, then ISO WKB with Z.

    Parameters
    ----------
    places : tuple of Position
        One for a point; a ring without its first place repeated for an area.

    References
    ----------
    OGC 12-128r18, clause 2.1.3.
    """
    ring = (*places, places[0]) if geometry is Geometry.AREA else places
    head = _HEADER.pack(b"GP", 0, _LITTLE_ENDIAN_NO_ENVELOPE, srs_id)
    kind = struct.pack("<BI", 1, _WKB_TYPES[geometry])
    numbers = [number for place in ring for number in place]
    body = struct.pack(f"<{len(numbers)}d", *numbers)
    if geometry is Geometry.POINT:
        return head + kind + body
    rings = struct.pack("<I", 1) if geometry is Geometry.AREA else b""
    return head + kind + rings + struct.pack("<I", len(ring)) + body


def places_of(blob: bytes) -> tuple[Geometry, tuple[Position, ...]]:
    """The geometry in a blob that :func:`blob_of` made.

    Raises
    ------
    ValueError
        It is another one's: an envelope, several rings, no heights.
    """
    try:
        magic, _, flags, _ = _HEADER.unpack_from(blob)
        order, code = struct.unpack_from("<BI", blob, _HEADER.size)
        geometry = _GEOMETRIES.get(code)
        if (magic, flags, order) != (b"GP", 1, 1) or geometry is None:
            message = "a geometry that Zuka did not write"
            raise ValueError(message)
        at = _HEADER.size + 5 + (4 if geometry is Geometry.AREA else 0)
        count = 1
        if geometry is not Geometry.POINT:
            (count,) = struct.unpack_from("<I", blob, at)
            at += 4
        numbers = struct.unpack_from(f"<{3 * count}d", blob, at)
    except struct.error as error:
        message = "a geometry that is cut off"
        raise ValueError(message) from error
    places = tuple((numbers[i], numbers[i + 1], numbers[i + 2]) for i in range(0, 3 * count, 3))
    return geometry, places[:-1] if geometry is Geometry.AREA else places

"""GeoPackage geometries: a header and well-known binary with heights, to and from vertices."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable

from processing.map.catalogue import Geometry
from processing.map.feature import Position

_HEADER = struct.Struct("<2sBBi")
_LITTLE_ENDIAN_NO_ENVELOPE = 1
_ENVELOPE_BYTES = (0, 32, 48, 48, 64)
_WKB_TYPES = {Geometry.POINT: 1001, Geometry.LINE: 1002, Geometry.AREA: 1003}
_GEOMETRIES = {code: geometry for geometry, code in _WKB_TYPES.items()}
_FEWEST = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}


def blob_of(geometry: Geometry, positions: tuple[Position, ...], srs_id: int) -> bytes:
    """A geometry as GeoPackage keeps it: GP header, then ISO WKB with Z.

    Parameters
    ----------
    positions : tuple of Position
        One for a point; a ring without its first place repeated for an area.

    Raises
    ------
    ValueError
        Too few places, several for a point, or one that is not finite.

    References
    ----------
    OGC 12-128r18, clause 2.1.3.
    """
    is_enough = len(positions) >= _FEWEST[geometry]
    if not is_enough or (geometry is Geometry.POINT and len(positions) > 1):
        message = f"{len(positions)} vertices for a {geometry.value}"
        raise ValueError(message)
    ring = (*positions, positions[0]) if geometry is Geometry.AREA else positions
    numbers = [number for position in ring for number in position]
    if not all(map(math.isfinite, numbers)):
        message = f"a coordinate that is not finite: {positions}"
        raise ValueError(message)
    head = _HEADER.pack(b"GP", 0, _LITTLE_ENDIAN_NO_ENVELOPE, srs_id)
    kind = struct.pack("<BI", 1, _WKB_TYPES[geometry])
    body = struct.pack(f"<{len(numbers)}d", *numbers)
    if geometry is Geometry.POINT:
        return head + kind + body
    rings = struct.pack("<I", 1) if geometry is Geometry.AREA else b""
    return head + kind + rings + struct.pack("<I", len(ring)) + body


def positions_of(blob: bytes) -> tuple[Geometry, tuple[Position, ...]]:
    """The geometry in a blob of :func:`blob_of`, or of a GIS program that moved it.

    Raises
    ------
    ValueError
        It is no point, line or single ring with heights, or not little-endian.
    """
    try:
        magic, _, flags, _ = _HEADER.unpack_from(blob)
        envelope = (flags >> 1) & 7
        if magic != b"GP" or flags & ~0b1110 != 1 or envelope >= len(_ENVELOPE_BYTES):
            message = "a geometry in a form that Zuka does not write"
            raise ValueError(message)
        at = _HEADER.size + _ENVELOPE_BYTES[envelope]
        order, code = struct.unpack_from("<BI", blob, at)
        geometry = _GEOMETRIES.get(code)
        if order != 1 or geometry is None:
            message = f"a geometry of the type {code}"
            raise ValueError(message)
        positions = _read_positions(blob, at + 5, geometry)
    except struct.error as error:
        message = "a geometry that is cut off"
        raise ValueError(message) from error
    return geometry, positions


def _read_positions(blob: bytes, at: int, geometry: Geometry) -> tuple[Position, ...]:
    if geometry is Geometry.POINT:
        return (struct.unpack_from("<3d", blob, at),)
    if geometry is Geometry.AREA:
        (rings,) = struct.unpack_from("<I", blob, at)
        if rings != 1:
            message = f"an area of {rings} rings"
            raise ValueError(message)
        at += 4
    (count,) = struct.unpack_from("<I", blob, at)
    body = blob[at + 4 :]
    if len(body) != 24 * count or count < _FEWEST[geometry]:
        message = f"a {geometry.value} of {count} vertices in {len(body)} bytes"
        raise ValueError(message)
    positions = tuple(struct.iter_unpack("<3d", body))
    return positions[:-1] if geometry is Geometry.AREA else positions


def _lowest(axis: int) -> Callable[[bytes], float | None]:
    def lowest(blob: bytes) -> float | None:
        return None if blob is None else min(position[axis] for position in positions_of(blob)[1])

    return lowest


def _highest(axis: int) -> Callable[[bytes], float | None]:
    def highest(blob: bytes) -> float | None:
        return None if blob is None else max(position[axis] for position in positions_of(blob)[1])

    return highest


def _is_empty(blob: bytes) -> int | None:
    return None if blob is None else 0


SQL_FUNCTIONS: tuple[tuple[str, int, Callable[[bytes], float | int | None]], ...] = (
    ("ST_MinX", 1, _lowest(0)),
    ("ST_MaxX", 1, _highest(0)),
    ("ST_MinY", 1, _lowest(1)),
    ("ST_MaxY", 1, _highest(1)),
    ("ST_IsEmpty", 1, _is_empty),
)
"""What the triggers of a spatial index ask, should a GIS program have added one.

Name, number of arguments, function of a geometry blob.
"""

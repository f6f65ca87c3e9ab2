"""What stands around the points of a LAS file that is written: header and length-coded records.

They are taken over as bytes, so that nothing in them changes that need not.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.formats.points.delivered.point_chunk import PointFileInfo
from processing.formats.points.las.las_crs import crs_of
from processing.formats.points.las.las_header import HEADER_SIZES, LasHeader
from processing.formats.points.las.las_records import PROMOTED
from processing.recording.columns.quantisation import Quantisation

_VLR_HEAD, _EVLR_HEAD = 54, 60
_WKT_BIT, _ADJUSTED_BIT, _INTERNAL_WAVEFORMS_BIT = 16, 1, 2
_NOT_TAKEN_OVER = (b"laszip encoded", b"copc")
_PROJECTION, _SPEC = b"LASF_Projection", b"LASF_Spec"
_WKT, _EXTRA_BYTES = 2112, 4
_LONGEST_VLR = 65535


@dataclass(frozen=True)
class LasFrame:
    """Header and records of an output file.

    Attributes
    ----------
    head : bytes
        The header, with what the source has behind its standard part.
    vlrs : tuple of bytes
        Whole records, their headers included.
    evlrs : tuple of (int, int)
        Byte and length of extended records in the source, to be copied behind the points.
    """

    head: bytes
    point_format: int
    vlrs: tuple[bytes, ...]
    evlrs: tuple[tuple[int, int], ...] = ()

    def start(self, point_size: int, laszip_record: bytes | None) -> bytes:
        """Everything before the points.

        Parameters
        ----------
        laszip_record : bytes or None
            The compressor's own record; None for LAS.
        """
        vlrs = list(self.vlrs)
        compression = 0
        if laszip_record is not None:
            vlrs.append(vlr_bytes(b"laszip encoded", 22204, laszip_record))
            compression = 0x80
        head = bytearray(self.head)
        size = len(head) + sum(len(vlr) for vlr in vlrs)
        struct.pack_into("<HII", head, 94, len(head), size, len(vlrs))
        struct.pack_into("<BH", head, 104, self.point_format | compression, point_size)
        return bytes(head) + b"".join(vlrs)

    def finish(self, file: BinaryIO, source: BinaryIO) -> None:
        """Copy the extended records behind the points and note in the header where they are."""
        positions = {}
        file.seek(0, 2)
        for byte, length in self.evlrs:
            positions[byte] = file.tell()
            source.seek(byte)
            _copy(source, file, length)
        minor = self.head[25]
        if minor >= 3:
            waveforms = struct.unpack_from("<Q", self.head, 227)[0]
            file.seek(227)
            file.write(struct.pack("<Q", positions.get(waveforms, 0)))
        if minor == 4:
            file.seek(235)
            file.write(struct.pack("<QI", min(positions.values(), default=0), len(positions)))

    @property
    def quantisation(self) -> Quantisation:
        """What makes metres of the integers of its points."""
        a, b, c, d, e, f = struct.unpack_from("<6d", self.head, 131)
        return Quantisation((a, b, c), (d, e, f))

    def note_extent(self, file: BinaryIO, low: NDArray[np.int64], high: NDArray[np.int64]) -> None:
        """Note the lowest and highest coordinates of the points, (3,) integers each."""
        metres = self.quantisation.metres
        file.seek(179)
        file.write(np.column_stack([metres(high), metres(low)]).astype("<f8").tobytes())

    def note_returns(self, file: BinaryIO, of_return: NDArray[np.int64]) -> None:
        """Note how many points there are of each return, (16,), number 0 first."""
        file.seek(255)
        file.write(of_return[1:].astype("<u8").tobytes())

    def extra_bytes(self) -> bytes:
        """What describes the extra bytes of the points; empty when nothing does."""
        found = next((v for v in self.vlrs if _is(v, _SPEC, _EXTRA_BYTES)), b"")
        return found[_VLR_HEAD:]

    def with_extra_bytes(self, described: bytes) -> LasFrame:
        """The same frame with another description of the extra bytes."""
        others = tuple(v for v in self.vlrs if not _is(v, _SPEC, _EXTRA_BYTES))
        new = (vlr_bytes(_SPEC, _EXTRA_BYTES, described),) if described else ()
        return LasFrame(self.head, self.point_format, others + new, self.evlrs)


def frame_of(header: LasHeader, *, promote: bool) -> LasFrame:
    """The frame of a LAS file, for an output with its points.

    Parameters
    ----------
    promote : bool
        Whether the points become those of a LAS 1.4 format. A reference system that only GeoTIFF
        keys name is then named in WKT too, as that version wants it.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        The file can't be read.
    """
    with report_as_user_error(header.path), header.path.open("rb") as file:
        head = file.read(header.header_size)
        vlrs = _vlrs_in(file.read(header.points_at - header.header_size), head)
        evlrs = _evlrs_in(file, header, head)
    if not promote:
        return LasFrame(head, header.point_format, vlrs, evlrs)
    new = _promoted_head(head, header)
    if not any(_is(vlr, _PROJECTION, _WKT) for vlr in vlrs):
        vlrs += _wkt_vlr(crs_of(header))
    if any(_is(vlr, _PROJECTION, _WKT) for vlr in vlrs):
        new[6] |= _WKT_BIT
    return LasFrame(bytes(new), PROMOTED[header.point_format], vlrs, evlrs)


def new_frame(info: PointFileInfo) -> LasFrame:
    """The frame of a LAS 1.4 file for the points of a file that is not LAS."""
    head = bytearray(HEADER_SIZES[4])
    now = datetime.now(UTC)
    vlrs = _wkt_vlr(info.crs)
    encoding = (_ADJUSTED_BIT if info.is_adjusted_standard else 0) | (_WKT_BIT if vlrs else 0)
    struct.pack_into("<4sHH", head, 0, b"LASF", 0, encoding)
    struct.pack_into("<BB32s32s", head, 24, 1, 4, b"OTHER", b"Zuka")
    struct.pack_into("<HH", head, 90, now.timetuple().tm_yday, now.year)
    struct.pack_into("<6d", head, 131, *info.scale, *info.offset)
    corners = zip(info.highest, info.lowest, strict=True)
    bounds = [value for pair in corners for value in pair] if info.count else [0.0] * 6
    struct.pack_into("<6d", head, 179, *bounds)
    struct.pack_into("<Q", head, 247, info.count)
    return LasFrame(bytes(head), 7 if info.has_color else 6, vlrs)


def vlr_bytes(user: bytes, number: int, data: bytes) -> bytes:
    """A variable length record with its header."""
    return struct.pack("<H16sHH32s", 0, user, number, len(data), b"") + data


def _promoted_head(head: bytes, header: LasHeader) -> bytearray:
    old_size = HEADER_SIZES[header.minor]
    new = bytearray(HEADER_SIZES[4])
    new[:old_size] = head[:old_size]
    new[25] = 4
    struct.pack_into("<Q", new, 247, header.count)
    if header.minor < 4 or not any(new[255:375]):
        struct.pack_into("<5Q", new, 255, *struct.unpack_from("<5I", head, 111))
    # From format 6 on, the fields of the older versions must be 0.
    new[107:131] = bytes(24)
    return new + head[old_size:]


def _vlrs_in(data: bytes, head: bytes) -> tuple[bytes, ...]:
    vlrs = []
    position = 0
    for _ in range(struct.unpack_from("<I", head, 100)[0]):
        size = _VLR_HEAD + struct.unpack_from("<H", data, position + 20)[0]
        vlr = data[position : position + size]
        if vlr[2:18].rstrip(b"\0 ") not in _NOT_TAKEN_OVER:
            vlrs.append(vlr)
        position += size
    return tuple(vlrs)


def _evlrs_in(file: BinaryIO, header: LasHeader, head: bytes) -> tuple[tuple[int, int], ...]:
    """Extended records; LAS 1.3 has at most one, the waveforms, and notes only where it is."""
    count, position = header.evlr_count, header.evlrs_at
    if header.minor == 3 and header.encoding & _INTERNAL_WAVEFORMS_BIT:
        position = struct.unpack_from("<Q", head, 227)[0]
        count = 1 if header.points_at <= position <= header.file_size - _EVLR_HEAD else 0
    evlrs = []
    for _ in range(count):
        file.seek(position)
        start = file.read(_EVLR_HEAD)
        size = _EVLR_HEAD + struct.unpack_from("<Q", start, 20)[0]
        size = min(size, header.file_size - position)
        if start[2:18].rstrip(b"\0 ") not in _NOT_TAKEN_OVER:
            evlrs.append((position, size))
        position += size
    return tuple(evlrs)


def _wkt_vlr(crs: str) -> tuple[bytes, ...]:
    if not crs:
        return ()
    from pyproj import CRS

    wkt = CRS.from_user_input(crs).to_wkt("WKT1_GDAL").encode("utf-8") + b"\0"
    return (vlr_bytes(_PROJECTION, _WKT, wkt),) if len(wkt) <= _LONGEST_VLR else ()


def _is(vlr: bytes, user: bytes, number: int) -> bool:
    own_user, own_number = struct.unpack_from("<16sH", vlr, 2)
    return bool(own_user.rstrip(b"\0 ") == user and own_number == number)


def _copy(source: BinaryIO, target: BinaryIO, length: int) -> None:
    while length > 0:
        data = source.read(min(length, 1 << 20))
        if not data:
            return
        target.write(data)
        length -= len(data)

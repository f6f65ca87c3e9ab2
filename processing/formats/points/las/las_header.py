"""The header of LAS and LAZ: read and checked before anything is believed.

A damaged header must not make the decoder allocate what it claims, so every count, offset and
size is held against the file's length first. Reference: LAS 1.4 R15 (ASPRS 2019), 1.0 to 1.3.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.text import Text
from processing.formats.points.delivered.point_chunk import Vector3

HEADER_SIZES = {0: 227, 1: 227, 2: 227, 3: 235, 4: 375}
"""Bytes of the header by minor version, without what a writer may put behind it."""

RECORD_SIZES = (20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67)
"""Bytes of a point of formats 0 to 10, without extra bytes."""

_VLR_HEADER = struct.Struct("<H16sHH32s")
_EVLR_HEADER = struct.Struct("<H16sHQ32s")
_LARGEST_EVLR_READ = 16 << 20
_FARTHEST_M = 1e9
_WAVEFORM_PACKETS = 65535


@dataclass(frozen=True)
class Vlr:
    """One variable length record."""

    user: str
    id: int
    data: bytes


@dataclass(frozen=True)
class LasHeader:
    """What a LAS or LAZ header says, checked against the file's size.

    Attributes
    ----------
    header_size, points_at : int
        Bytes of the header; where point data start.
    point_size : int
        Bytes of a decoded point.
    vlrs : tuple of Vlr
        Extended ones (if not larger than 16 MiB) after the ordinary ones.
    evlrs_at, evlr_count : int
        Where extended records start; 0 without.
    waveforms_at : int
        Where the record of waveform packets starts in the file; 0 where the header names none.
    """

    path: Path
    file_size: int
    minor: int
    encoding: int
    header_size: int
    points_at: int
    point_format: int
    point_size: int
    is_compressed: bool
    count: int
    scale: Vector3
    offset: Vector3
    lowest: Vector3
    highest: Vector3
    vlrs: tuple[Vlr, ...]
    evlrs_at: int
    evlr_count: int
    waveforms_at: int = 0

    def vlr(self, user: str, number: int) -> Vlr | None:
        """The first record of this user and id."""
        return next((v for v in self.vlrs if v.user == user and v.id == number), None)

    @property
    def points_end(self) -> int:
        """Byte before which point data end: the extended records', or the file's."""
        after = self.evlr_count > 0 and self.evlrs_at >= self.points_at
        return self.evlrs_at if after else self.file_size


def damaged(path: Path, what: Text, byte: int | None = None) -> BadFile:
    """The error for a file whose content is not what LAS says."""
    position = (
        Text.same(str(path))
        if byte is None
        else Text(f"{path}, byte {byte:,}", f"{path}、{byte:,}バイト目")
    )
    return BadFile(
        what,
        position,
        Text(
            "Copy the file again from the delivery. {unchanged}",
            "納品データからファイルをコピーし直してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def read_header(path: Path) -> LasHeader:
    """Read the header and the variable length records, not the points.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read; it is not LAS; it contradicts itself or the file's size: names the byte.
    """
    with report_as_user_error(path), path.open("rb") as file:
        file_size = path.stat().st_size
        start = file.read(375)
        _check_start(path, start, file_size)
        header_size, points_at, vlr_count = struct.unpack_from("<HII", start, 94)
        minor = start[25]
        point_format, point_size, count = _point_facts(path, start, minor)
        if not HEADER_SIZES[minor] <= header_size <= points_at <= file_size:
            raise damaged(path, _CONTRADICTS.filled(field="offset to point data"), 94)
        evlrs_at, evlr_count = struct.unpack_from("<QI", start, 235) if minor == 4 else (0, 0)
        vlrs = _read_vlrs(file, path, vlr_count, (header_size, points_at))
        if evlr_count:
            vlrs += _read_evlrs(file, path, evlr_count, (evlrs_at, file_size))
    scale, offset = _placement(path, start)
    bounds = np.array(struct.unpack_from("<6d", start, 179)).reshape(3, 2)
    header = LasHeader(
        path=path,
        file_size=file_size,
        minor=minor,
        encoding=struct.unpack_from("<H", start, 6)[0],
        header_size=header_size,
        points_at=points_at,
        point_format=point_format & 0x7F,
        point_size=point_size,
        is_compressed=bool(point_format & 0x80),
        count=count,
        scale=scale,
        offset=offset,
        lowest=_extent(bounds, 1),
        highest=_extent(bounds, 0),
        vlrs=tuple(vlrs),
        evlrs_at=evlrs_at if evlr_count else 0,
        evlr_count=evlr_count,
        waveforms_at=struct.unpack_from("<Q", start, 227)[0] if minor >= 3 else 0,
    )
    _check_length(header)
    return header


_CONTRADICTS = Text(
    "The header contradicts the file: {field}.",
    "ヘッダーの内容がファイルと矛盾しています（{field}）。",
)


def _check_start(path: Path, start: bytes, file_size: int) -> None:
    if not start:
        raise damaged(path, Text("The file is empty.", "ファイルが空です。"))
    if not start.startswith(b"LASF"):
        raise damaged(
            path, Text("It is not a LAS or LAZ file.", "LAS/LAZファイルではありません。"), 0
        )
    if len(start) < 26 or len(start) < HEADER_SIZES.get(start[25], 227):
        raise damaged(
            path,
            Text("The file ends inside its header.", "ヘッダーの途中でファイルが終わっています。"),
            file_size,
        )
    if start[24] != 1 or start[25] not in HEADER_SIZES:
        raise damaged(
            path,
            Text(
                f"LAS version {start[24]}.{start[25]} is unknown; 1.0 to 1.4 can be read.",
                f"LASバージョン {start[24]}.{start[25]} には対応していません（1.0～1.4）。",
            ),
            24,
        )


def _point_facts(path: Path, start: bytes, minor: int) -> tuple[int, int, int]:
    """Point format with the compression bits, bytes of a point, number of points."""
    point_format, point_size, count = struct.unpack_from("<BHI", start, 104)
    if minor == 4:
        count = struct.unpack_from("<Q", start, 247)[0] or count
    known = point_format & 0x7F
    if known >= len(RECORD_SIZES):
        raise damaged(
            path,
            Text(
                f"Point format {known} is unknown.",
                f"点フォーマット {known} には対応していません。",
            ),
            104,
        )
    if point_size < RECORD_SIZES[known]:
        raise damaged(path, _CONTRADICTS.filled(field="point data record length"), 105)
    return point_format, point_size, count


def _placement(path: Path, start: bytes) -> tuple[Vector3, Vector3]:
    numbers = struct.unpack_from("<6d", start, 131)
    for i, number in enumerate(numbers):
        is_possible = 0 < number < 1e6 if i < 3 else abs(number) <= _FARTHEST_M
        if not is_possible:
            what = Text(
                "{number:g} can't be a {field} of coordinates.",
                "座標の{field_ja}として {number:g} は使えません。",
            )
            fields = ("scale", "スケール") if i < 3 else ("offset", "オフセット")
            raise damaged(
                path,
                what.filled(number=number, field=fields[0], field_ja=fields[1]),
                131 + 8 * i,
            )
    return numbers[:3], numbers[3:]


@np.errstate(invalid="ignore")
def _extent(bounds: np.ndarray[tuple[int, int], np.dtype[np.float64]], side: int) -> Vector3:
    """One corner of the box in the header; NaN when no box was ever entered there."""
    high, low = bounds[:, 0], bounds[:, 1]
    is_box = np.isfinite(bounds).all() and (low <= high).all() and bounds.any()
    if not is_box or np.abs(bounds).max() > _FARTHEST_M:
        return (np.nan, np.nan, np.nan)
    x, y, z = (float(value) for value in bounds[:, side])
    return (x, y, z)


def _read_vlrs(file: BinaryIO, path: Path, count: int, span: tuple[int, int]) -> list[Vlr]:
    file.seek(span[0])
    data = file.read(span[1] - span[0])
    vlrs = []
    position = 0
    for number in range(count):
        end = position + _VLR_HEADER.size
        if end > len(data):
            raise _bad_vlr(path, number, count, span[0] + position)
        _, user, record_id, length, _ = _VLR_HEADER.unpack_from(data, position)
        if end + length > len(data):
            raise _bad_vlr(path, number, count, span[0] + position)
        vlrs.append(Vlr(_name(user), record_id, data[end : end + length]))
        position = end + length
    return vlrs


def _read_evlrs(file: BinaryIO, path: Path, count: int, span: tuple[int, int]) -> list[Vlr]:
    vlrs = []
    position, file_size = span
    for number in range(count):
        file.seek(min(position, file_size))
        head = file.read(_EVLR_HEADER.size)
        if len(head) < _EVLR_HEADER.size:
            raise _bad_vlr(path, number, count, position)
        _, user, record_id, length, _ = _EVLR_HEADER.unpack(head)
        position += _EVLR_HEADER.size
        # What lacks of waveforms is told of the points that name it; the points are all there.
        is_packets = _name(user) == "LASF_Spec" and record_id == _WAVEFORM_PACKETS
        if position + length > file_size and not is_packets:
            raise _bad_vlr(path, number, count, position - _EVLR_HEADER.size)
        data = file.read(length) if length <= _LARGEST_EVLR_READ else b""
        vlrs.append(Vlr(_name(user), record_id, data))
        position += length
    return vlrs


def _bad_vlr(path: Path, number: int, count: int, byte: int) -> BadFile:
    return damaged(
        path,
        Text(
            f"Variable length record {number + 1:,} of {count:,} does not fit into the file.",
            f"可変長レコード {number + 1:,}／{count:,} がファイルに収まりません。",
        ),
        byte,
    )


def _name(user: bytes) -> str:
    return user.split(b"\0", 1)[0].decode("ascii", "replace").strip()


def _check_length(header: LasHeader) -> None:
    if header.is_compressed or header.count == 0:
        return
    whole = (header.file_size - header.points_at) // header.point_size
    if whole < header.count:
        raise damaged(
            header.path,
            Text(
                f"The file ends in the middle of point {whole + 1:,} of {header.count:,}.",
                f"{header.count:,}点のうち{whole + 1:,}点目の途中でファイルが終わっています。",
            ),
            header.file_size,
        )

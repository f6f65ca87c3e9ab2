"""The head of a PulseWaves file (``.pls``): where pulses lie, and how their waveforms are sampled.

A damaged head must not make anybody allocate what it claims, so every count, offset and size is
held against the file's length first. Reference: PulseWaves 0.3 revision 11 (Isenburg, 2011 to 2016,
github.com/PulseWaves/Specification).
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.text import Text
from processing.formats.points.delivered.point_chunk import Vector3
from processing.formats.points.las.las_crs import crs_in_records
from processing.formats.points.las.las_header import damaged
from processing.formats.points.pulsewaves.pulse_composition import PulseComposition, composition_of

_SIGNATURE = b"PulseWavesPulse\0"
_HEADER = struct.Struct("<16sIIIHH8s64s64sHHBBHqqIIIIqIi2d2q12d")
_RECORD = struct.Struct("<16sIIq64s")
_LARGEST_RECORD = 16 << 20
_LARGEST_PULSE = 65_536
_SPEC, _PROJECTION = "PulseWaves_Spec", "PulseWaves_Proj"
_END, _PACKED = 0xFFFFFFFF, 5
_FIRST_COMPOSITION, _COMPOSITIONS = 200_000, range(1, 256)
_KEYS, _WORDS, _WKT = 34735, 34737, 2112
_LARGEST_SCALE_M, _FARTHEST_M, _LONGEST_S = 1e3, 1e9, 1e11
SHORTEST_PULSE = 48
"""Bytes of a pulse record of type 0 without attributes."""


@dataclass(frozen=True)
class PulseWavesHeader:
    """What the head of a file says, checked against the file's size.

    Attributes
    ----------
    pulses_at, count, pulse_size : int
        Byte of the first pulse, how many there are, and the bytes of each.
    attributes : int
        Bits: 1 for a pulse source id of 16 bits behind each record, 2 for one of 32 bits.
    source : int
        Number of the flight line or scan; 0 where pulses are of several.
    time_scale, time_offset : float
        s = integers x scale + offset.
    scale, offset : tuple of float
        Metres = integers x scale + offset.
    crs : str
        ``EPSG:n``; empty where none is named, or none that EPSG lists.
    compositions : mapping of int to PulseComposition
        By the number that pulses name.
    """

    path: Path
    pulses_at: int
    count: int
    pulse_size: int
    attributes: int
    source: int
    time_scale: float
    time_offset: float
    scale: Vector3
    offset: Vector3
    crs: str
    compositions: Mapping[int, PulseComposition]


def read_pulse_header(path: Path) -> PulseWavesHeader:
    """Read the head and the records that describe waveforms, not the pulses.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read; it is packed, or of a version that no public description covers; it
        contradicts itself or the file's size.
    """
    with report_as_user_error(path), path.open("rb") as file:
        size = path.stat().st_size
        start = file.read(_HEADER.size)
        if not start.startswith(_SIGNATURE):
            raise _no_pulses(path, start)
        if len(start) < _HEADER.size:
            raise damaged(
                path,
                Text(
                    "The file ends inside its header.", "ヘッダの途中でファイルが終わっています。"
                ),
                len(start),
            )
        values = _HEADER.unpack(start)
        _check_version(path, values)
        pulses_at, count, pulse_size = values[14], values[15], values[18]
        _check_places(path, values, size)
        records = dict(_records_before(path, file, values[13], pulses_at, values[21]))
        if values[19] or (_SPEC, _PACKED) in records:
            raise packed(path)
        _check_count(path, values, size)
        records.update(_records_behind(path, file, pulses_at + count * pulse_size, values[22]))
    scales, offsets = values[27:30], values[30:33]
    _check_numbers(path, values)
    return PulseWavesHeader(
        path=path,
        pulses_at=pulses_at,
        count=count,
        pulse_size=pulse_size,
        attributes=values[17],
        source=values[2],
        time_scale=values[23],
        time_offset=values[24],
        scale=(scales[0], scales[1], scales[2]),
        offset=(offsets[0], offsets[1], offsets[2]),
        crs=crs_in_records(*(records.get((_PROJECTION, one)) for one in (_WKT, _KEYS, _WORDS))),
        compositions={
            number: composition_of(records[_SPEC, _FIRST_COMPOSITION + number])
            for number in _COMPOSITIONS
            if (_SPEC, _FIRST_COMPOSITION + number) in records
        },
    )


def packed(path: Path) -> BadFile:
    """What is said of compressed pulses or samples: how they are packed was never described."""
    return BadFile(
        Text(
            "The file is compressed in a way that no public description covers.",
            "公開仕様のない方式で圧縮されています。",
        ),
        Text.same(str(path)),
        Text(
            "Unpack it with PulseTools (pulse2pulse -i FILE.plz -o FILE.pls), or ask the provider "
            "for .pls with .wvs. {unchanged}",
            "PulseTools（pulse2pulse -i FILE.plz -o FILE.pls）で展開するか、"
            ".pls と .wvs を納品元に依頼してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def _no_pulses(path: Path, start: bytes) -> BadFile:
    if not start.startswith(b"PulseWavesWaves"):
        return damaged(
            path,
            Text(
                "This is not a PulseWaves file: it doesn't begin with “PulseWavesPulse”.",
                "PulseWavesファイルではありません（先頭が「PulseWavesPulse」ではありません）。",
            ),
            0,
        )
    pulses = path.with_suffix(".pls").name
    return BadFile(
        Text(
            "These are the samples of a PulseWaves file; where they lie is told by its pulses.",
            "PulseWavesの波形サンプルだけのファイルです。位置の情報はパルスのファイルにあります。",
        ),
        Text.same(str(path)),
        Text("Choose {name}. {unchanged}", "{name} を指定してください。{unchanged}").filled(
            name=pulses, unchanged=UNCHANGED
        ),
    )


# The values of a header differ in type: Any would say no more than their place in the standard.
def _check_version(path: Path, values: tuple[object, ...]) -> None:
    major, minor, pulse_format = values[11], values[12], values[16]
    if major == 0 and isinstance(minor, int) and minor >= 3 and pulse_format == 0:
        return
    raise BadFile(
        Text(
            "This is PulseWaves {major}.{minor} with pulses of format {format}; 0.3 with format 0 "
            "is publicly described.",
            "PulseWaves {major}.{minor}、パルスフォーマット{format}のファイルです。"
            "公開されている仕様は0.3、フォーマット0です。",
        ).filled(major=major, minor=minor, format=pulse_format),
        Text(f"{path}, byte 172", f"{path}、172バイト目"),
        Text(
            "Ask the provider for PulseWaves 0.3 or LAS 1.4 with waveforms. {unchanged}",
            "PulseWaves 0.3または波形付きのLAS 1.4を納品元に依頼してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def _check_places(path: Path, values: tuple[int, ...], size: int) -> None:
    header_size, pulses_at, count, pulse_size = values[13], values[14], values[15], values[18]
    if header_size < _HEADER.size or not header_size <= pulses_at <= size:
        raise damaged(
            path,
            Text(
                f"The pulses can't begin at byte {pulses_at:,}.",
                f"パルスの開始位置（{pulses_at:,}バイト目）が正しくありません。",
            ),
            176,
        )
    needed = SHORTEST_PULSE + 2 * (values[17] & 1) + 2 * (values[17] & 2)
    if not needed <= pulse_size <= _LARGEST_PULSE or count < 0:
        raise damaged(
            path,
            Text(
                f"{count:,} pulses of {pulse_size:,} bytes each are no pulses.",
                f"パルスの数（{count:,}）か大きさ（{pulse_size:,}バイト）が正しくありません。",
            ),
            184,
        )


def _check_count(path: Path, values: tuple[int, ...], size: int) -> None:
    pulses_at, count, pulse_size = values[14], values[15], values[18]
    whole = (size - pulses_at) // pulse_size
    if count > whole:
        raise damaged(
            path,
            Text(
                f"The file ends in pulse {whole + 1:,} of {count:,}.",
                f"{count:,}パルス中{whole + 1:,}番目でファイルが終わっています。",
            ),
            size,
        )


def _check_numbers(path: Path, values: tuple[float, ...]) -> None:
    limits = (
        (223, values[23:24], _LONGEST_S),
        (232, values[24:25], _LONGEST_S),
        (256, values[27:30], _LARGEST_SCALE_M),
        (280, values[30:33], _FARTHEST_M),
    )
    for byte, numbers, most in limits:
        bad = next((one for one in numbers if not abs(one) <= most), None)
        if bad is not None:
            raise damaged(
                path,
                Text(
                    f"A scale or offset of {bad:g} can't belong to a survey.",
                    f"スケールまたはオフセットの値 {bad:g} が正しくありません。",
                ),
                byte,
            )


_Record = tuple[tuple[str, int], bytes]


def _records_before(
    path: Path, file: BinaryIO, first: int, end: int, count: int
) -> Iterator[_Record]:
    """The records between header and pulses."""
    place = first
    for _ in range(count):
        file.seek(place)
        head = file.read(_RECORD.size)
        if place + _RECORD.size > end:
            raise _bad_record(path, place)
        user, number, _, length, _ = _RECORD.unpack(head)
        if not 0 <= length <= end - place - _RECORD.size:
            raise _bad_record(path, place)
        if length <= _LARGEST_RECORD:
            yield (_name_of(user), number), file.read(length)
        place += _RECORD.size + length


def _records_behind(path: Path, file: BinaryIO, first: int, count: int) -> list[_Record]:
    """The records behind the pulses, in their order; they are found from the end of the file.

    Each one's head stands behind its content. Writers count the empty one that ends the list, or
    don't.
    """
    end = file.seek(0, 2)
    found: list[_Record] = []
    while end - _RECORD.size >= first:
        file.seek(end - _RECORD.size)
        user, number, _, length, _ = _RECORD.unpack(file.read(_RECORD.size))
        if (_name_of(user), number) == (_SPEC, _END):
            break
        if not 0 <= length <= end - _RECORD.size - first:
            if count <= 0:  # What stands there was never said to be records.
                return []
            raise _bad_record(path, end - _RECORD.size)
        end -= _RECORD.size + length
        if length <= _LARGEST_RECORD:
            file.seek(end)
            found.append(((_name_of(user), number), file.read(length)))
    return found[::-1]


def _name_of(user: bytes) -> str:
    return user.split(b"\0", 1)[0].decode("ascii", "replace").strip()


def _bad_record(path: Path, place: int) -> BadFile:
    return damaged(
        path,
        Text(
            "A record of the header reaches beyond its place.",
            "ヘッダのレコードが範囲を超えています。",
        ),
        place,
    )

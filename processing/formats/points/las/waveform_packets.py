"""Waveform packets of LAS point formats 4, 5, 9 and 10: where they lie, and which a point names.

Reference: LAS 1.4 R15 (ASPRS 2019), waveform packet descriptors (records 100 to 354 of LASF_Spec)
and waveform data packets (record 65535); LASlib (LAStools) for what writers do beside it.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.core.text import Text
from processing.formats.points.delivered.delivered_waveforms import DeliveredWaveforms
from processing.formats.points.las.las_header import LasHeader
from processing.formats.points.las.las_output import vlr_bytes
from processing.recording.waveform_packets.descriptors import (
    DESCRIPTOR,
    DIRECTION,
    LOCATION,
    PACKET,
    NoPacket,
    WaveformDescriptor,
)

WAVEFORM_FIELDS_AT = {4: 28, 5: 34, 9: 30, 10: 38}
"""Byte of a point where the 29 bytes of the wave packet begin."""

WAVEFORM_FIELDS = np.dtype(
    [
        ("descriptor", "u1"),
        ("byte", "<u8"),
        ("size", "<u4"),
        ("location", "<f4"),
        ("direction", "<f4", (3,)),
    ]
)
"""The 29 bytes as the standard lays them out."""

_DESCRIPTOR = struct.Struct("<BBIIdd")
_FIRST_DESCRIPTOR, _DESCRIPTORS = 99, range(1, 256)
_SPEC, _PACKETS_RECORD = "LASF_Spec", 65535
_EVLR_HEAD = struct.Struct("<H16sHQ32s")

PACKETS_HEAD_BYTES = _EVLR_HEAD.size
"""What stands before packets in a file of their own, and is counted with them."""

EXTERNAL_BIT = 4
"""Of the global encoding: packets are in a file beside the points."""

_INTERNAL_BIT = 2
_PLAIN_ENDING, _PACKED_ENDING = ".wdp", ".wdz"


@dataclass(frozen=True)
class LasPackets:
    """What the packets of a LAS file are, as far as its header tells.

    Attributes
    ----------
    delivered : DeliveredWaveforms
    shift : int
        To be added to the bytes that points name: 60 where a writer did not count the record's
        header, as the standard wants it.
    """

    delivered: DeliveredWaveforms
    shift: int = 0
    _sizes: NDArray[np.int64] = field(default_factory=lambda: np.zeros(256, np.int64))

    def columns_of(
        self, records: NDArray[np.uint8], point_format: int
    ) -> dict[str, NDArray[np.generic]]:
        """The columns of :data:`WAVE_COLUMNS` for points.

        Parameters
        ----------
        records : (n, point size) uint8
        """
        fields = wave_fields(records, point_format)
        number = fields["descriptor"]
        byte = fields["byte"].astype(np.int64) + self.shift
        size = fields["size"].astype(np.int64)
        packet = np.where(byte >= 0, byte, np.int64(0))
        wanted = self._sizes[number]
        first = _EVLR_HEAD.size if self.delivered.has_head else 0
        is_beyond = (byte < first) | (byte + size > self.delivered.size)
        packet[is_beyond] = NoPacket.BEYOND_FILE
        packet[(wanted > 0) & (size != wanted)] = NoPacket.OTHER_SIZE
        packet[wanted == 0] = NoPacket.BAD_DESCRIPTOR
        packet[wanted < 0] = NoPacket.UNKNOWN_DESCRIPTOR
        packet[number == 0] = NoPacket.NONE_GIVEN
        location = np.nan_to_num(fields["location"], posinf=0.0, neginf=0.0)
        direction = np.nan_to_num(fields["direction"], posinf=0.0, neginf=0.0)
        return {PACKET: packet, DESCRIPTOR: number, LOCATION: location, DIRECTION: direction}


def wave_fields(records: NDArray[np.uint8], point_format: int) -> NDArray[np.void]:
    """The wave packet fields of points as they are in the file, a copy."""
    at = WAVEFORM_FIELDS_AT[point_format]
    own = np.ascontiguousarray(records[:, at : at + WAVEFORM_FIELDS.itemsize])
    return np.asarray(own.view(WAVEFORM_FIELDS)).reshape(-1)


def wave_fields_of(
    columns: Mapping[str, NDArray[Any]], descriptors: Mapping[int, WaveformDescriptor]
) -> NDArray[np.void]:
    """The wave packet fields of points, as a file is to have them.

    Parameters
    ----------
    columns : mapping
        :data:`WAVE_COLUMNS`; a packet is its byte alone.
    """
    fields = np.zeros(columns[PACKET].size, WAVEFORM_FIELDS)
    has_packet = columns[PACKET] >= 0
    sizes = np.zeros(256, np.int64)
    for number, one in descriptors.items():
        sizes[number] = one.packet_bytes
    named = np.where(has_packet, columns[DESCRIPTOR], 0)
    fields["descriptor"] = named
    fields["byte"] = np.where(has_packet, columns[PACKET], 0)
    fields["size"] = sizes[named]
    fields["location"] = np.where(has_packet, columns[LOCATION], 0)
    fields["direction"] = np.where(has_packet[:, None], columns[DIRECTION], 0)
    return fields


def set_wave_fields(
    records: NDArray[np.uint8], fields: NDArray[np.void], point_format: int
) -> NDArray[np.uint8]:
    """The records, changed in place, with these wave packet fields."""
    at = WAVEFORM_FIELDS_AT[point_format]
    own = np.ascontiguousarray(fields).view(np.uint8).reshape(len(records), -1)
    records[:, at : at + own.shape[1]] = own
    return records


def descriptor_record(number: int, one: WaveformDescriptor) -> bytes:
    """The record of the header that says how packets are coded."""
    described = _DESCRIPTOR.pack(
        one.bits, one.compression, one.samples, one.spacing_ps, one.gain, one.offset
    )
    return vlr_bytes(_SPEC.encode(), _FIRST_DESCRIPTOR + number, described)


def packets_head(length: int) -> bytes:
    """What stands before so many bytes of packets in a file of their own."""
    return _EVLR_HEAD.pack(0, _SPEC.encode(), _PACKETS_RECORD, length, b"")


def packets_of(header: LasHeader, sample: NDArray[np.uint8] | None = None) -> LasPackets | None:
    """The packets that the points of a file name; None for formats without.

    Parameters
    ----------
    sample : (n, point size) uint8, optional
        Some points, which tell how the writer counted bytes.

    Raises
    ------
    MissingInput, NoSpace
        The file can't be read.
    """
    if header.point_format not in WAVEFORM_FIELDS_AT:
        return None
    descriptors = _descriptors_of(header)
    delivered = _find_packets(header, descriptors)
    if not delivered.is_readable:
        return LasPackets(delivered)
    sizes = np.full(256, -1, np.int64)
    for number, one in descriptors.items():
        sizes[number] = one.packet_bytes if one.is_readable else 0
    shift = 0
    if delivered.has_head and sample is not None and len(sample):
        fields = wave_fields(sample, header.point_format)
        bytes_named = fields["byte"][fields["descriptor"] > 0]
        if bytes_named.size and int(bytes_named.min()) == 0:
            shift = _EVLR_HEAD.size
    return LasPackets(delivered, shift, sizes)


def _descriptors_of(header: LasHeader) -> dict[int, WaveformDescriptor]:
    found = {}
    for number in _DESCRIPTORS:
        vlr = header.vlr(_SPEC, _FIRST_DESCRIPTOR + number)
        if vlr is None or len(vlr.data) < _DESCRIPTOR.size:
            continue
        bits, compression, samples, spacing, gain, offset = _DESCRIPTOR.unpack_from(vlr.data)
        found[number] = WaveformDescriptor(bits, samples, spacing, gain, offset, compression)
    return found


def _find_packets(
    header: LasHeader, descriptors: dict[int, WaveformDescriptor]
) -> DeliveredWaveforms:
    """Where the packets are: in the file where it says so, else beside it."""
    readable = {number: one for number, one in descriptors.items() if one.is_readable}
    if not descriptors:
        return DeliveredWaveforms(
            reason=Text(
                "the file has no waveform packet descriptors",
                "波形パケット記述子がファイルにありません",
            )
        )
    start = header.waveforms_at
    is_internal = bool(header.encoding & _INTERNAL_BIT) and start >= header.header_size
    if is_internal:
        found = _inside(header, start)
    else:
        found = _beside(header, is_packed=any(one.compression for one in readable.values()))
    return DeliveredWaveforms(
        path=found.path,
        first_byte=found.first_byte,
        size=found.size,
        has_head=found.has_head,
        descriptors=descriptors,
        reason=found.reason,
    )


def _inside(header: LasHeader, start: int) -> DeliveredWaveforms:
    if start + _EVLR_HEAD.size > header.file_size:
        return DeliveredWaveforms(
            path=header.path,
            reason=Text(
                f"the file ends before its waveforms, at byte {header.file_size:,}",
                f"波形データの前でファイルが終わっています（{header.file_size:,}バイト目）",
            ),
        )
    with report_as_user_error(header.path), header.path.open("rb") as file:
        file.seek(start)
        length = _EVLR_HEAD.unpack(file.read(_EVLR_HEAD.size))[3]
    # Writers that could not go back leave the length 0: then the packets end where the file does.
    end = start + _EVLR_HEAD.size + length if length else header.file_size
    size = min(end, header.file_size) - start
    return DeliveredWaveforms(path=header.path, first_byte=start, size=size, has_head=True)


def _beside(header: LasHeader, *, is_packed: bool) -> DeliveredWaveforms:
    wanted = _PACKED_ENDING if is_packed else _PLAIN_ENDING
    path = _file_beside(header.path, wanted)
    if path is None:
        missing = header.path.with_suffix(wanted)
        return DeliveredWaveforms(
            path=missing,
            reason=Text(
                f"{missing.name}, the file of its waveforms, is not beside it",
                f"波形ファイル {missing.name} が同じフォルダにありません",
            ),
        )
    if is_packed:
        return DeliveredWaveforms(
            path=path,
            reason=Text(
                f"the samples in {path.name} are compressed; unpack them with LAStools (las2las)",
                f"{path.name} のサンプルは圧縮されています。LAStools（las2las）で展開してください",
            ),
        )
    with report_as_user_error(path):
        size = path.stat().st_size
    return DeliveredWaveforms(path=path, size=size, has_head=has_packets_head(path))


def has_packets_head(path: Path) -> bool:
    """Whether a file of packets begins with the head of a record, as the standard wants it.

    Raises
    ------
    MissingInput, NoSpace
    """
    with report_as_user_error(path), path.open("rb") as file:
        start = file.read(_EVLR_HEAD.size)
    if len(start) < _EVLR_HEAD.size:
        return False
    _, user, record, _, _ = _EVLR_HEAD.unpack(start)
    return bool(user.rstrip(b"\0 ") == _SPEC.encode() and record == _PACKETS_RECORD)


def _file_beside(path: Path, ending: str) -> Path | None:
    """A file of the same name with another ending, in small or large letters."""
    for one in (ending, ending.upper()):
        beside = path.with_suffix(one)
        if beside.is_file():
            return beside
    return None

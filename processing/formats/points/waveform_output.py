"""Waveforms written: a LAS file's packets copied beside a new one, or new points with packets."""

from __future__ import annotations

import dataclasses
import struct
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor
from processing.core.safe_write import write_safely
from processing.formats.points.delivered.point_chunk import PointChunk, PointFileInfo, Vector3
from processing.formats.points.las.las_header import RECORD_SIZES, read_header
from processing.formats.points.las.las_output import LasFrame, new_frame
from processing.formats.points.las.las_records import positions_in, records_of
from processing.formats.points.las.waveform_packets import (
    EXTERNAL_BIT,
    PACKETS_HEAD_BYTES,
    descriptor_record,
    has_packets_head,
    packets_head,
    packets_of,
    set_wave_fields,
    wave_fields_of,
)
from processing.formats.points.point_files import is_las
from processing.recording.waveform_packets.descriptors import (
    DESCRIPTOR,
    DIRECTION,
    LOCATION,
    PACKET,
    WaveformDescriptor,
)

_FORMAT, _NUMBER = 9, 1
_COPIED_BYTES = 8 << 20
PACKETS_ENDING = ".wdp"
"""Of a file of packets beside its points."""


@dataclass(frozen=True)
class WaveformLas:
    """What all points of a new file with waveforms have in common.

    Attributes
    ----------
    crs : str
        ``EPSG:n``, or empty.
    scale, offset : tuple of float
        Metres = integers x scale + offset.
    descriptor : WaveformDescriptor
        Of all packets.
    is_adjusted_standard : bool
        Whether times are GPS seconds less 1e9.
    system, software : str
        What measured, and what wrote: 32 bytes of ASCII at most.
    day : date or None
        The header's; None for today.
    """

    crs: str
    scale: Vector3
    offset: Vector3
    descriptor: WaveformDescriptor
    is_adjusted_standard: bool = True
    system: str = "OTHER"
    software: str = "Zuka"
    day: date | None = None


@dataclass(frozen=True, eq=False)
class WaveformRecords:
    """Consecutive points, and the packets that come with them.

    Attributes
    ----------
    columns : mapping
        As :class:`PointChunk` has them: ``xyz``, ``intensity``, ``return_number``,
        ``number_of_returns``, ``classification``, ``scanner``, ``user_data``, ``time`` and, where
        known, ``scan_angle_deg``.
    packet : (n,) int64
        Row in ``samples`` of each point's packet; −1 for a point without.
    location_ps : (n,) float32
        The return's time after the packet's first sample.
    direction : (n, 3) float32
        m/ps, to the sensor.
    samples : (k, m) unsigned
        Counts; m as the descriptor says.
    """

    # Any: the columns differ in type.
    columns: Mapping[str, NDArray[Any]]
    packet: Integers
    location_ps: NDArray[np.float32]
    direction: NDArray[np.float32]
    samples: NDArray[Any]


def write_waveform_las(
    path: Path,
    records: Iterable[WaveformRecords],
    description: WaveformLas,
    monitor: Monitor,
    *,
    never: Collection[Path] = (),
) -> None:
    """Write points of format 9 (LAS 1.4) and their packets in a ``.wdp`` beside them.

    Parameters
    ----------
    path : Path
        ``.las``; the other file has the same name.
    records : iterable of WaveformRecords
        Some points at a time.
    never : collection of Path
        Files that must not be overwritten: the inputs of the work.

    Raises
    ------
    NoSpace, InUse, Cancelled
        Nothing is left behind.
    """
    with (
        write_safely(path, never=never) as points,
        write_safely(path.with_suffix(PACKETS_ENDING), never=never) as packets,
        points.open("wb+") as file,
        packets.open("wb+") as beside,
    ):
        made = WaveformLasFile(file, beside, description)
        for some in records:
            monitor.check()
            made.write(some)
        made.finish()


class WaveformLasFile:
    """Points of format 9 and their packets, written some at a time; nothing else writes them.

    Parameters
    ----------
    points, packets : BinaryIO
        Empty files open for writing, which can be gone back in; they are not closed.
    description : WaveformLas
    """

    def __init__(self, points: BinaryIO, packets: BinaryIO, description: WaveformLas) -> None:
        self._points, self._packets = points, packets
        self._descriptor = description.descriptor
        self._frame, self._written = _frame_of(description), _Written()
        self._packets.write(packets_head(0))
        self._points.write(self._frame.start(RECORD_SIZES[_FORMAT], None))

    def write(self, some: WaveformRecords) -> None:
        """Add points and packets behind those that are there.

        Raises
        ------
        OSError
        """
        first = self._packets.tell()
        width = f"<u{self._descriptor.bits // 8}"
        self._packets.write(np.ascontiguousarray(some.samples, width).data)
        own = _records_with_packets(some, first, self._descriptor)
        self._written.add(own)
        self._points.write(own.data)

    def finish(self) -> None:
        """Note in both heads what was written.

        Raises
        ------
        OSError
        """
        length = self._packets.tell() - PACKETS_HEAD_BYTES
        self._packets.seek(0)
        self._packets.write(packets_head(length))
        self._written.note(self._points, self._frame)


def packets_beside(source: Path, kept: Path | None = None) -> Path | None:
    """The file of packets that goes with the points of a file, to be copied beside new ones.

    Parameters
    ----------
    source : Path
        A point file of any format.
    kept : Path, optional
        A copy of the packets, for where the delivered ones are gone.

    Returns
    -------
    Path or None
        None where there is none: no waveforms, those inside the file, or no file left; then the
        points name packets that are elsewhere, as they did.

    Raises
    ------
    MissingInput, NoSpace, BadFile
    """
    if not is_las(source):
        # What a file of another format has instead of packets was made into them by the import.
        return kept if kept is not None and kept.is_file() and has_packets_head(kept) else None
    packets = packets_of(read_header(source))
    if packets is None or packets.delivered.path in (Path(), source):
        return None
    found = (one for one in (packets.delivered.path, kept) if one is not None and one.is_file())
    return next(found, None)


def copy_packets(packets: Path, target: Path, monitor: Monitor) -> None:
    """Copy a file of packets byte for byte.

    Raises
    ------
    NoSpace, MissingInput, Cancelled
    """
    with report_as_user_error(packets), packets.open("rb") as file, target.open("wb") as copy:
        while data := file.read(_COPIED_BYTES):
            monitor.check()
            copy.write(data)


class _Written:
    """What the header says of points once they are written."""

    def __init__(self) -> None:
        self._count = 0
        self._of_return = np.zeros(16, np.int64)
        self._low, self._high = np.full(3, 2**31), np.full(3, -(2**31))

    def add(self, records: NDArray[np.uint8]) -> None:
        """Count some records more."""
        if len(records):
            xyz = positions_in(records)
            self._count += len(records)
            self._of_return += np.bincount(records[:, 14] & 15, minlength=16)
            self._low = np.minimum(self._low, xyz.min(axis=0))
            self._high = np.maximum(self._high, xyz.max(axis=0))

    def note(self, file: BinaryIO, frame: LasFrame) -> None:
        """Write it into the header."""
        file.seek(247)
        file.write(struct.pack("<Q", self._count))
        frame.note_returns(file, self._of_return)
        if self._count:
            frame.note_extent(file, self._low, self._high)


def _frame_of(description: WaveformLas) -> LasFrame:
    nowhere = (0.0, 0.0, 0.0)
    frame = new_frame(
        PointFileInfo(
            path=Path(),
            format="LAS",
            count=0,
            scale=description.scale,
            offset=description.offset,
            lowest=nowhere,
            highest=nowhere,
            crs=description.crs,
            has_time=True,
            has_color=False,
            is_adjusted_standard=description.is_adjusted_standard or None,
        )
    )
    head = bytearray(frame.head)
    head[6] |= EXTERNAL_BIT
    names = (description.system.encode("ascii"), description.software.encode("ascii"))
    struct.pack_into("<32s32s", head, 26, *names)
    if description.day is not None:
        day = description.day
        struct.pack_into("<HH", head, 90, day.timetuple().tm_yday, day.year)
    vlr = descriptor_record(_NUMBER, dataclasses.replace(description.descriptor, compression=0))
    return dataclasses.replace(
        frame, head=bytes(head), point_format=_FORMAT, vlrs=(*frame.vlrs, vlr)
    )


def _records_with_packets(
    some: WaveformRecords, first: int, descriptor: WaveformDescriptor
) -> NDArray[np.uint8]:
    records = records_of(PointChunk(dict(some.columns)), _FORMAT)
    has_packet = some.packet >= 0
    waves = {
        PACKET: np.where(has_packet, first + some.packet * descriptor.packet_bytes, -1),
        DESCRIPTOR: np.full(some.packet.size, _NUMBER, np.uint8),
        LOCATION: some.location_ps,
        DIRECTION: some.direction,
    }
    return set_wave_fields(records, wave_fields_of(waves, {_NUMBER: descriptor}), _FORMAT)

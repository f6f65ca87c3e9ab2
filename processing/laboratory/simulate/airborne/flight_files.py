"""A flight's files: points with waveforms beside them, the points alone, and the truth."""

from __future__ import annotations

import struct
import zipfile
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType

import laspy
import numpy as np
from laspy.vlrs.known import WaveformPacketStruct, WaveformPacketVlr
from numpy.typing import ArrayLike, NDArray

from processing.formats.points.reported_writes import ReportedWrites, report_write_failures
from processing.laboratory.simulate.airborne.flight_sensors import FlightSensor
from processing.laboratory.simulate.airborne.landscapes import Floats
from processing.laboratory.simulate.scanning.delivered_files import (
    ArrayFile,
    DeliveredPoints,
    delivered_header,
    point_records,
)

_PACKETS_BEGIN = 60
"""Bytes of the record's head that a file of packets begins with, LAS 1.4, table 24."""

_PACKET_RECORD, _FIRST_DESCRIPTOR = 65535, 100
_SCAN_ANGLE_UNIT_DEG = 0.006


class WaveformFile:
    """A LAS 1.4 file of point format 9 and its ``.wdp``, written chunk by chunk."""

    def __init__(self, path: Path, offset: Floats, sensor: FlightSensor) -> None:
        self._header, self._bits = delivered_header(9, offset), sensor.bits
        self._header.global_encoding.waveform_data_packets_external = True
        described = WaveformPacketStruct(
            sensor.bits, 0, sensor.samples, round(sensor.interval_ns * 1000), 1.0, -sensor.baseline
        )
        descriptor = WaveformPacketVlr(_FIRST_DESCRIPTOR)
        descriptor.parsed_record = described
        self._header.vlrs.append(descriptor)
        self._file = ReportedWrites(path.open("wb"))
        self._writer = laspy.LasWriter(self._file, self._header, do_compress=False)
        self._packets = path.with_suffix(".wdp").open("wb")
        self._packets.write(_packets_head(0))
        self._at = _PACKETS_BEGIN

    def write(
        self,
        points: DeliveredPoints,
        packet: NDArray[np.int64],
        ray: tuple[Floats, Floats, Floats],
        samples: NDArray[np.float32],
    ) -> None:
        """Add points and the packets that they bring.

        Parameters
        ----------
        packet : (n,) int64
            Row of each point's packet in ``samples``.
        ray : (n,), (n, 3), (n,) float64
            Location in ps; m/ps towards the aircraft; scan angle in degrees.
        samples : (k, m) float32
            Whole counts.
        """
        location, direction, angle_deg = ray
        size = samples.shape[1] * self._bits // 8
        record = point_records(points, self._header)
        record["scan_angle"] = np.rint(angle_deg / _SCAN_ANGLE_UNIT_DEG).astype(np.int16)
        record["wavepacket_index"] = np.ones(packet.size, np.uint8)
        record["wavepacket_offset"] = (self._at + packet * size).astype(np.uint64)
        record["wavepacket_size"] = np.full(packet.size, size, np.uint32)
        record["return_point_wave_location"] = location.astype(np.float32)
        record["x_t"], record["y_t"], record["z_t"] = direction.astype(np.float32).T
        with report_write_failures(self._file):
            self._writer.write_points(record)
        self._packets.write(samples.astype("<u1" if self._bits == 8 else "<u2").tobytes())
        self._at += size * len(samples)

    def __enter__(self) -> WaveformFile:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is None:
            with report_write_failures(self._file):
                self._writer.close()
            self._packets.seek(0)
            self._packets.write(_packets_head(self._at - _PACKETS_BEGIN))
        self._file.close()
        self._packets.close()


def _packets_head(size: int) -> bytes:
    return struct.pack("<H16sHQ32s", 0, b"LASF_Spec", _PACKET_RECORD, size, b"Waveform packets")


Columns = Mapping[str, tuple[type[np.generic], int]]
"""Type and width of each array by its name; width 0 is an array of one dimension."""


class ArrayArchive:
    """A ``.npz`` whose arrays grow together; closed by ``with``.

    Parameters
    ----------
    columns : Columns
    """

    def __init__(self, path: Path, columns: Columns) -> None:
        self._path, self._open = path, ExitStack()
        self._parts = {name: path.with_name(f"{path.stem}.{name}.npy") for name in columns}
        self._files = {
            name: self._open.enter_context(ArrayFile(self._parts[name], dtype, width))
            for name, (dtype, width) in columns.items()
        }

    def write(self, **values: ArrayLike) -> None:
        """Add rows to some of the arrays."""
        for name, rows in values.items():
            self._files[name].write(rows)

    def __enter__(self) -> ArrayArchive:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._open.__exit__(kind, error, trace)
        if error is not None:
            return
        with zipfile.ZipFile(self._path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
            for name, part in self._parts.items():
                # A fixed date: the same seed gives the same bytes.
                entry = zipfile.ZipInfo(f"{name}.npy")
                entry.compress_type = zipfile.ZIP_DEFLATED
                with part.open("rb") as source, archive.open(entry, "w", force_zip64=True) as into:
                    while block := source.read(1 << 20):
                        into.write(block)
        for part in self._parts.values():
            part.unlink()

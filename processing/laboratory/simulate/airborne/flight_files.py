"""A flight's files: points with waveforms beside them, the points alone, and the truth."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.formats.points.waveform_output import (
    PACKETS_ENDING,
    WaveformLas,
    WaveformLasFile,
    WaveformRecords,
)
from processing.laboratory.simulate.airborne.flight_sensors import FlightSensor
from processing.laboratory.simulate.airborne.landscapes import Floats
from processing.laboratory.simulate.scanning.delivered_files import (
    CRS_NAME,
    SCALE_M,
    SOFTWARE,
    SURVEYED,
    SYSTEM,
    ArrayFile,
    DeliveredPoints,
)
from processing.recording.waveform_packets.descriptors import WaveformDescriptor

_PS_IN_NS = 1000


class WaveformFile:
    """A LAS 1.4 file of point format 9 and its ``.wdp``, written chunk by chunk.

    Parameters
    ----------
    offset : (3,) float64
        Near the points, m; coordinates are whole millimetres from it.
    """

    def __init__(self, path: Path, offset: Floats, sensor: FlightSensor) -> None:
        self._offset, self._bits = np.floor(offset), sensor.bits
        east, north, height = (float(one) for one in self._offset)
        description = WaveformLas(
            CRS_NAME,
            (SCALE_M,) * 3,
            (east, north, height),
            WaveformDescriptor(
                sensor.bits,
                sensor.samples,
                round(sensor.interval_ns * _PS_IN_NS),
                1.0,
                -sensor.baseline,
            ),
            system=SYSTEM,
            software=SOFTWARE,
            day=SURVEYED,
        )
        with ExitStack() as opening:
            points = opening.enter_context(path.open("wb+"))
            packets = opening.enter_context(path.with_suffix(PACKETS_ENDING).open("wb+"))
            self._file = WaveformLasFile(points, packets, description)
            self._open = opening.pop_all()

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
        if not packet.size:  # pulses that nothing answered, over water
            return
        location, direction, angle_deg = ray
        nothing = np.zeros(packet.size, np.uint8)
        columns: dict[str, NDArray[Any]] = {  # Any: they differ in type
            "xyz": np.rint((points.xyz - self._offset) / SCALE_M).astype(np.int32),
            "intensity": points.intensity,
            "return_number": points.number,
            "number_of_returns": points.count,
            "classification": nothing,
            "user_data": nothing,
            "scanner": np.full(packet.size, points.source_id, np.uint16),
            "scan_angle_deg": angle_deg,
            "time": points.time_s,
        }
        self._file.write(
            WaveformRecords(
                columns,
                packet,
                location.astype(np.float32),
                direction.astype(np.float32),
                samples.astype(f"<u{self._bits // 8}"),
            )
        )

    def __enter__(self) -> WaveformFile:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        with self._open:
            if error is None:
                self._file.finish()


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

"""A small flight with waveforms whose truth is known, and ways to spoil its files."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.formats.points.las.las_header import read_header
from processing.formats.points.las.waveform_packets import (
    WAVEFORM_FIELDS,
    WAVEFORM_FIELDS_AT,
)
from processing.formats.points.waveform_output import (
    WaveformLas,
    WaveformRecords,
    write_waveform_las,
)
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.drive import Drive
from processing.recording.waveform_packets.descriptors import WaveformDescriptor

METRES_IN_PS = 299_792_458.0 / 2 * 1e-12
FLYING_HEIGHT_M = 500.0
FIRST_AT_NS = 12.5
SAMPLES = 80


@dataclass(frozen=True)
class Flight:
    """What was written.

    Attributes
    ----------
    xyz : (n, 3) float64
        Of the points, in the file's order.
    pulse : (n,) int64
        The pulse of each point.
    place_ns : (n,) float64
        Where in its packet.
    counts : (k, SAMPLES)
    """

    path: Path
    xyz: NDArray[np.float64]
    pulse: NDArray[np.int64]
    place_ns: NDArray[np.float64]
    counts: NDArray[np.int64]


def write_flight(
    path: Path, pulses: int = 60, *, bits: int = 8, spacing_ps: int = 1000, flipped: bool = False
) -> Flight:
    """Write a flight: every third pulse meets a crown 3 m above the ground before the ground.

    Parameters
    ----------
    flipped : bool
        Whether the file's directions lead away from the sensor.
    """
    rng = np.random.default_rng(1)
    foot = np.column_stack([rng.uniform(-20, 20, pulses), rng.uniform(0, 40, pulses)])
    sensor = np.column_stack([np.zeros(pulses), foot[:, 1], np.full(pulses, FLYING_HEIGHT_M)])
    down = np.column_stack([foot[:, 0], foot[:, 1], np.zeros(pulses)]) - sensor
    down /= np.linalg.norm(down, axis=1)[:, None]
    has_crown = np.arange(pulses) % 3 == 0
    of_crown = np.flatnonzero(has_crown)
    pulse = np.concatenate([np.arange(pulses), of_crown])
    above = np.concatenate([np.zeros(pulses), np.full(of_crown.size, 3.0)])
    order = np.lexsort((-above, pulse))
    pulse, above = pulse[order], above[order]
    range_m = (FLYING_HEIGHT_M - above) / -down[pulse, 2]
    xyz = np.round(sensor[pulse] + range_m[:, None] * down[pulse], 3)
    is_first = np.diff(pulse, prepend=-1) > 0
    first_range = range_m[is_first][pulse]
    place_ns = FIRST_AT_NS + (range_m - first_range) / METRES_IN_PS / 1000
    time_ns = np.arange(SAMPLES) * spacing_ps / 1000
    echoes = 100 * np.exp(-((time_ns - place_ns[:, None]) ** 2) / (2 * 1.7**2))
    counts = np.zeros((pulses, SAMPLES))
    np.add.at(counts, pulse, echoes)
    counts = np.rint(counts + 5).astype(np.int64)
    returns = 1 + has_crown[pulse].astype(np.uint8)
    columns = {
        "xyz": np.rint(xyz * 1000).astype(np.int32),
        "intensity": np.full(pulse.size, 100, np.uint16),
        "return_number": np.where(is_first, 1, 2).astype(np.uint8),
        "number_of_returns": returns,
        "classification": np.ones(pulse.size, np.uint8),
        "scanner": np.full(pulse.size, 7, np.uint16),
        "user_data": np.zeros(pulse.size, np.uint8),
        "time": 1000.0 + pulse * 1e-5,
    }
    sign = 1.0 if flipped else -1.0
    records = WaveformRecords(
        columns=columns,
        packet=pulse,
        location_ps=(place_ns * 1000).astype(np.float32),
        direction=(sign * METRES_IN_PS * down[pulse]).astype(np.float32),
        samples=counts.astype(f"<u{bits // 8}"),
    )
    descriptor = WaveformDescriptor(bits, SAMPLES, spacing_ps, 0.5, -2.0)
    description = WaveformLas("EPSG:6677", (0.001,) * 3, (0.0,) * 3, descriptor)
    write_waveform_las(path, [records], description, SilentMonitor())
    return Flight(path, np.asarray(xyz), pulse, np.asarray(place_ns), np.asarray(counts))


def change_points(path: Path, change: Callable[[NDArray[np.void]], None]) -> None:
    """Change the wave packet fields of a file's points in place."""
    header = read_header(path)
    data = bytearray(path.read_bytes())
    size = header.count * header.point_size
    points = np.frombuffer(data, np.uint8, size, header.points_at)
    records = points.reshape(header.count, header.point_size)
    at = WAVEFORM_FIELDS_AT[header.point_format]
    own = np.ascontiguousarray(records[:, at : at + WAVEFORM_FIELDS.itemsize])
    fields = own.view(WAVEFORM_FIELDS).reshape(-1)
    change(fields)
    records[:, at : at + own.shape[1]] = fields.view(np.uint8).reshape(own.shape)
    path.write_bytes(data)


def change_descriptor(
    path: Path, *, samples: int, compression: int = 0, bits: int = 8, spacing_ps: int = 1000
) -> None:
    """Let the file's only descriptor say something else."""
    data = bytearray(path.read_bytes())
    at = data.index(struct.pack("<16sH", b"LASF_Spec", 100)) + 18 + 2 + 32
    data[at : at + 10] = struct.pack("<BBII", bits, compression, samples, spacing_ps)
    path.write_bytes(data)


def put_packets_inside(path: Path) -> None:
    """Let the packets be an extended record of the point file; the file beside it goes."""
    beside = path.with_suffix(".wdp")
    data = bytearray(path.read_bytes())
    struct.pack_into("<Q", data, 227, len(data))
    struct.pack_into("<QI", data, 235, len(data), 1)
    data[6] = data[6] & ~4 | 2
    path.write_bytes(bytes(data) + beside.read_bytes())
    beside.unlink()


def import_flight(path: Path, into: Path) -> Drive:
    """Import one file as one drive."""
    (made,) = import_drives(ImportRequest((path,)), into, SilentMonitor())
    return Drive(made)

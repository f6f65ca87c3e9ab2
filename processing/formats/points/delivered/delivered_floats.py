"""Point files that hold metres as floating point: turned into integers as LAS has them.

PLY, PCD, E57 and text all come through here. One pass over the file finds the extent and the range
of the intensity; the second one gives the chunks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.text import Text
from processing.formats.points.delivered.delivered_waveforms import DeliveredWaveforms
from processing.formats.points.delivered.point_chunk import PointChunk, PointFileInfo, Vector3
from processing.recording.columns.quantisation import Quantisation
from processing.recording.waveform_packets.descriptors import WAVE_COLUMNS

# Any numeric type as the file has it; what must come is said in FloatFile.
ColumnBlock = dict[str, NDArray[np.generic]]

_SCALES_M = (0.0001, 0.001)
_LARGEST_INTEGER = 2_000_000_000
_FARTHEST_M = 1e9
_LONGEST_TIME_S = 1e11
_LARGEST_INDEX = 2**31 - 1
_FULL = 65535.0
_INTENSITY_RANGES = ((0.0, 1.0), (0.0, 255.0), (0.0, _FULL), (-100.0, 100.0), (-2048.0, 2047.0))
_SMALL_COLUMNS = ("return_number", "number_of_returns", "classification")
_OF_SCANS = ("scan", "scanner_position")


@dataclass(frozen=True)
class FloatFile:
    """A point file as its reader sees it.

    Attributes
    ----------
    format : str
        Name for :class:`PointFileInfo`.
    blocks : callable
        Gives the points in the file's order, as often as asked: dicts with ``xyz`` (n, 3) float64
        and, the same ones in every block, ``time``, ``intensity``, ``return_number``,
        ``number_of_returns``, ``classification``, ``scan_angle_deg`` (n,), ``color`` (n, 3)
        uint16, ``origin`` (n, 3) float64. NaN or infinite coordinates: no point. Scans of a
        standing scanner have ``grid`` (n, 2) int64: sweep and place in it, −1 where unknown;
        ``scan`` (n,): number in the file from 1; ``scanner_position`` (n, 3) float64: where the
        scanner stood, m. A block is of one scan, and scans follow one another. Rows with waveforms
        have :data:`WAVE_COLUMNS`, a packet for each row, also for those that are no point.
        ``scanner`` (n,): the scanner's number, where scans don't tell it.
    columns_taken : tuple of str
        As :class:`PointFileInfo` says.
    waveforms : DeliveredWaveforms or None
        Of rows with waveforms; without a size they are of one descriptor, a packet for each row.
    crs : str
        ``EPSG:n``, or empty.
    is_adjusted_standard : bool or None
        As :class:`PointFileInfo` says.
    beside : tuple of Path
        Other files that belong to it.
    """

    path: Path
    format: str
    blocks: Callable[[], Iterator[ColumnBlock]]
    columns_taken: tuple[str, ...] = ()
    waveforms: DeliveredWaveforms | None = None
    crs: str = ""
    is_adjusted_standard: bool | None = None
    beside: tuple[Path, ...] = ()


@dataclass(frozen=True)
class _Summary:
    rows: int
    count: int
    lowest: Vector3
    highest: Vector3
    names: tuple[str, ...]
    first_time: float
    intensity_low: float
    intensity_high: float
    is_intensity_integral: bool
    scanner_positions: tuple[tuple[int, Vector3], ...]


def info_of(file: FloatFile) -> PointFileInfo:
    """What a file of floating point coordinates holds; reads it once.

    Raises
    ------
    BadFile
        A coordinate is impossible, or the points lie too far apart.
    """
    summary = _summary_of(file)
    scale, offset = _lattice(file.path, summary)
    return PointFileInfo(
        path=file.path,
        format=file.format,
        count=summary.count,
        scale=(scale, scale, scale),
        offset=offset,
        lowest=summary.lowest,
        highest=summary.highest,
        crs=file.crs,
        has_time="time" in summary.names,
        has_color="color" in summary.names,
        is_adjusted_standard=file.is_adjusted_standard,
        first_time=summary.first_time,
        attributes=tuple(name for name in summary.names if name not in _OF_SCANS),
        scanner_positions=summary.scanner_positions,
        columns_taken=file.columns_taken,
        waveforms=_waveforms(file, summary.rows),
    )


def _waveforms(file: FloatFile, rows: int) -> DeliveredWaveforms | None:
    if file.waveforms is None or file.waveforms.size:
        return file.waveforms
    (descriptor,) = file.waveforms.descriptors.values()
    return replace(file.waveforms, size=rows * descriptor.packet_bytes)


def chunks_of(file: FloatFile, chunk_points: int) -> Iterator[PointChunk]:
    """The points, a chunk at a time.

    Coordinates become integers of 0.1 mm (1 mm where the points lie more than 200 km apart) from
    an offset of whole metres. Intensities that are whole numbers of 16 bits stay; others are
    mapped linearly to 0 to 65535 from the customary range they lie in. Where a file has several
    scans, the scan's number is the scanner's.

    Raises
    ------
    BadFile
        As :func:`info_of`.
    """
    summary = _summary_of(file)
    scale, offset = _lattice(file.path, summary)
    for block in file.blocks():
        good = _usable(block["xyz"])
        for start in range(0, good.size, chunk_points):
            part = slice(start, start + chunk_points)
            kept = good[part]
            values = {
                name: column[part] if kept.all() else column[part][kept]
                for name, column in block.items()
            }
            if values["xyz"].shape[0]:
                yield PointChunk(_chunk_columns(values, summary, scale, offset))


@np.errstate(invalid="ignore")
def _chunk_columns(
    values: ColumnBlock, summary: _Summary, scale: float, offset: Vector3
) -> dict[str, NDArray[np.generic]]:
    count = values["xyz"].shape[0]
    quantisation = Quantisation((scale, scale, scale), offset)
    integers = quantisation.rounded(values["xyz"].astype(np.float64))
    columns: dict[str, NDArray[np.generic]] = {
        "xyz": integers.astype(np.int32),
        "intensity": _intensity(values, summary),
        "scanner": _scanners(values, summary),
        "user_data": np.zeros(count, dtype=np.uint8),
    }
    for name in _SMALL_COLUMNS:
        lowest = 0 if name == "classification" else 1
        given = values.get(name)
        column = np.full(count, lowest) if given is None else _clip_values(given, lowest, 255)
        columns[name] = column.astype(np.uint8)
    if "time" in values:
        time = values["time"].astype(np.float64)
        columns["time"] = np.where(np.abs(time) < _LONGEST_TIME_S, time, np.nan)
    if "scan_angle_deg" in values:
        columns["scan_angle_deg"] = values["scan_angle_deg"].astype(np.float32)
    for name in ("color", "origin", *WAVE_COLUMNS):
        if name in values:
            columns[name] = values[name]
    if "grid" in values:
        indices = values["grid"].astype(np.int64)
        is_index = (indices >= 0) & (indices <= _LARGEST_INDEX)
        columns["grid"] = np.where(is_index, indices, -1).astype(np.int32)
    return columns


def _scanners(values: ColumnBlock, summary: _Summary) -> NDArray[np.uint16]:
    if "scanner" in values:
        return _clip_values(values["scanner"], 0, _FULL).astype(np.uint16)
    if len(summary.scanner_positions) < 2:
        return np.zeros(values["xyz"].shape[0], dtype=np.uint16)
    return _clip_values(values["scan"], 0, _FULL).astype(np.uint16)


def _intensity(values: ColumnBlock, summary: _Summary) -> NDArray[np.uint16]:
    given = values.get("intensity")
    if given is None:
        return np.zeros(values["xyz"].shape[0], dtype=np.uint16)
    low, high = summary.intensity_low, summary.intensity_high
    if summary.is_intensity_integral and low >= 0 and high <= _FULL:
        return _clip_values(given, 0, _FULL).astype(np.uint16)
    low, high = _intensity_range(low, high)
    if not high > low:
        return np.zeros(given.size, dtype=np.uint16)
    share = (given.astype(np.float64) - low) / (high - low)
    return np.rint(_clip_values(share, 0, 1) * _FULL).astype(np.uint16)


def _intensity_range(low: float, high: float) -> tuple[float, float]:
    """The customary range in which a file's intensities lie; its own where they lie in none.

    The files of one drive must come to one brightness, so their own extremes won't do: shares,
    bytes, 16 bits, decibels, the twelve bits with sign of some scanners.
    """
    for least, most in _INTENSITY_RANGES:
        if least <= low and high <= most:
            return least, most
    return low, high


def _clip_values(values: NDArray[np.generic], low: float, high: float) -> NDArray[np.float64]:
    """Values within bounds; what is no number becomes the lower one."""
    numbers = values.astype(np.float64)
    return np.asarray(np.clip(np.nan_to_num(numbers, nan=low), low, high), dtype=np.float64)


@np.errstate(invalid="ignore")
def _usable(xyz: NDArray[np.generic]) -> NDArray[np.bool_]:
    return np.asarray(np.isfinite(xyz).all(axis=1))


def _summary_of(file: FloatFile) -> _Summary:
    states = []
    for path in (file.path, *file.beside):
        with report_as_user_error(path):
            status = path.stat()
        states.append((status.st_size, status.st_mtime_ns))
    return _read_summary(_Key(file, tuple(states)))


@dataclass(frozen=True)
class _Key:
    """A file in a certain state; equal for the same path, columns, sizes and times of change."""

    file: FloatFile
    states: tuple[tuple[int, int], ...]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Key) and self._state() == other._state()

    def __hash__(self) -> int:
        return hash(self._state())

    def _state(self) -> tuple[Path, tuple[str, ...], tuple[tuple[int, int], ...]]:
        return (self.file.path, self.file.columns_taken, self.states)


@lru_cache(maxsize=256)
@np.errstate(invalid="ignore")
def _read_summary(key: _Key) -> _Summary:
    """One pass; kept, as the same file is asked for its facts, a sample and its points."""
    count = rows = 0
    lowest, highest = np.full(3, np.inf), np.full(3, -np.inf)
    low, high, is_integral = np.inf, -np.inf, True
    names: tuple[str, ...] = ()
    first_time = np.nan
    positions: dict[int, Vector3] = {}
    for block in key.file.blocks():
        names = tuple(name for name in block if name != "xyz")
        rows += len(block["xyz"])
        good = _usable(block["xyz"])
        xyz = block["xyz"][good].astype(np.float64)
        if xyz.shape[0] == 0:
            continue
        if np.abs(xyz).max() > _FARTHEST_M:
            raise _too_far(key.file.path, float(np.abs(xyz).max()))
        lowest, highest = np.minimum(lowest, xyz.min(axis=0)), np.maximum(highest, xyz.max(axis=0))
        if "intensity" in block:
            values = block["intensity"][good].astype(np.float64)
            values = values[np.isfinite(values)]
            if values.size:
                low, high = min(low, float(values.min())), max(high, float(values.max()))
                is_integral = is_integral and bool((values == np.rint(values)).all())
        if "scan" in block:
            positions[int(block["scan"][good][0])] = _vector(block["scanner_position"][0])
        if "time" in block and count == 0:
            first_time = float(block["time"][good][0])
        count += xyz.shape[0]
    return _Summary(
        rows=rows,
        count=count,
        lowest=_vector(lowest if count else np.full(3, np.nan)),
        highest=_vector(highest if count else np.full(3, np.nan)),
        names=names,
        first_time=first_time,
        intensity_low=low,
        intensity_high=high,
        is_intensity_integral=is_integral,
        scanner_positions=tuple(positions.items()),
    )


def _vector(values: NDArray[np.generic]) -> Vector3:
    x, y, z = (float(value) for value in values)
    return (x, y, z)


def _lattice(path: Path, summary: _Summary) -> tuple[float, Vector3]:
    """The scale, and whole metres in the middle of the points as offset."""
    if summary.count == 0:
        return _SCALES_M[0], (0.0, 0.0, 0.0)
    lowest, highest = np.array(summary.lowest), np.array(summary.highest)
    offset = np.floor((lowest + highest) / 2)
    reach = float(np.maximum(highest - offset, offset - lowest).max())
    for scale in _SCALES_M:
        if reach / scale <= _LARGEST_INTEGER:
            return scale, _vector(offset)
    raise _too_far(path, reach)


def _too_far(path: Path, distance_m: float) -> BadFile:
    return BadFile(
        Text(
            f"A coordinate of {distance_m:g} m can't belong to a survey.",
            f"座標値 {distance_m:g} m は測量データとして大きすぎます。",
        ),
        Text.same(str(path)),
        Text(
            "Copy the file again from the delivery. {unchanged}",
            "納品データからファイルをコピーし直してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )

"""LAS, LAZ and COPC: points as delivered, streamed, with the integers that the file holds."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from io import BufferedReader
from pathlib import Path

import lazrs
import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.core.text import Text
from processing.formats.points.delivered.field_names import GRID_NAMES, plain_name, whole_numbers
from processing.formats.points.delivered.point_chunk import PointChunk, PointFileInfo
from processing.formats.points.las.las_crs import crs_of
from processing.formats.points.las.las_header import RECORD_SIZES, LasHeader, damaged, read_header
from processing.formats.points.las.las_records import ExtraDimension, extra_dimensions
from processing.formats.points.las.laz_chunks import read_chunk_table
from processing.formats.points.las.waveform_packets import LasPackets, packets_of
from processing.recording.waveform_packets.descriptors import WAVE_COLUMNS

__all__ = ["PointChunk", "PointFileInfo", "read_chunks", "read_info", "read_records"]

_TIME_AT = {1: 20, 3: 20, 4: 20, 5: 20, 6: 22, 7: 22, 8: 22, 9: 22, 10: 22}
_COLOR_AT = {2: 20, 3: 28, 5: 28, 7: 30, 8: 30, 10: 30}
_ALWAYS = (
    "intensity",
    "return_number",
    "number_of_returns",
    "classification",
    "scanner",
    "user_data",
    "scan_angle_deg",
)
_EXTRA_BYTES_SIZE = 192
_LABEL = "label"
_ANGLE_STEP_DEG = 0.006
_LONGEST_TIME_S = 1e11
_FAR_OUTSIDE_M = 10_000.0
_IS_ADJUSTED_BIT = 1
_NEEDED_LAYERS = (
    lazrs.SELECTIVE_DECOMPRESS_XY_RETURNS_CHANNEL
    | lazrs.SELECTIVE_DECOMPRESS_Z
    | lazrs.SELECTIVE_DECOMPRESS_CLASSIFICATION
    | lazrs.SELECTIVE_DECOMPRESS_INTENSITY
    | lazrs.SELECTIVE_DECOMPRESS_SCAN_ANGLE
    | lazrs.SELECTIVE_DECOMPRESS_USER_DATA
    | lazrs.SELECTIVE_DECOMPRESS_POINT_SOURCE_ID
    | lazrs.SELECTIVE_DECOMPRESS_GPS_TIME
    | lazrs.SELECTIVE_DECOMPRESS_RGB
    | lazrs.SELECTIVE_DECOMPRESS_WAVEPACKET
)
_PACKET_SAMPLE = 1_000


def read_info(path: Path) -> PointFileInfo:
    """What a LAS, LAZ or COPC file says in its header, and the time of its first point.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, or its header is damaged or contradicts the file's size.
    """
    header = read_header(path)
    has_time = header.point_format in _TIME_AT
    has_color = header.point_format in _COLOR_AT
    columns = (("time",) if has_time else ()) + _ALWAYS + (("color",) if has_color else ())
    packets = _packets_of(header)
    if packets is not None and packets.delivered.is_readable:
        columns += WAVE_COLUMNS
    is_adjusted = bool(header.encoding & _IS_ADJUSTED_BIT)
    return PointFileInfo(
        path=path,
        format=_format_name(header),
        count=header.count,
        scale=header.scale,
        offset=header.offset,
        lowest=header.lowest,
        highest=header.highest,
        crs=crs_of(header),
        has_time=has_time,
        has_color=has_color,
        is_adjusted_standard=True if has_time and is_adjusted else None,
        first_time=_first_time(header) if has_time else float("nan"),
        version=f"1.{header.minor}",
        point_format=header.point_format,
        waveforms=None if packets is None else packets.delivered,
        attributes=columns + _extra_dimensions(header),
    )


def read_chunks(
    path: Path, chunk_points: int = 1_000_000, *, after: int = 0
) -> Iterator[PointChunk]:
    """The points of a LAS, LAZ or COPC file, in the file's order.

    Parameters
    ----------
    chunk_points : int
        Points in a chunk at most, unless one compressed chunk of the file is larger.
    after : int
        Points to leave out, the end of a chunk of an earlier reading.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        The file can't be read or is damaged: names the points or the byte. A coordinate at the
        limits of its integers, or 10 km and ten extents outside the header's box, is damage.
    """
    header = read_header(path)
    packets = _packets_of(header)
    first = after
    for records in read_records(header, chunk_points, _layers(header), after=after):
        chunk = _chunk(records, header, first, packets)
        yield chunk
        first += chunk.count


def read_ends(path: Path, points: int) -> list[PointChunk]:
    """The first and the last points of a file, without reading what lies between.

    Parameters
    ----------
    points : int
        About how many of either end.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        As :func:`read_chunks`.
    """
    header = read_header(path)
    packets = _packets_of(header)
    spans = _end_spans(header.count, points)
    records = _records_of(header, spans)
    return [
        _chunk(own, header, start, packets) for own, (start, _) in zip(records, spans, strict=True)
    ]


def _records_of(header: LasHeader, spans: list[tuple[int, int]]) -> list[NDArray[np.uint8]]:
    """The records of some stretches of points."""
    with report_as_user_error(header.path), header.path.open("rb") as file:
        if not header.is_compressed:
            return [_plain_records(header, file, start, end) for start, end in spans]
        chunks = read_chunk_table(header, file)
        return [chunks.decoded_span(file, start, end, _layers(header)) for start, end in spans]


def _packets_of(header: LasHeader) -> LasPackets | None:
    """The file's waveform packets; its first and last points tell how their bytes are counted."""
    packets = packets_of(header)
    if packets is None or not packets.delivered.has_head:
        return packets
    spans = _end_spans(header.count, _PACKET_SAMPLE)
    sample = _records_of(header, spans)
    return packets_of(header, np.concatenate(sample)) if sample else packets


def _layers(header: LasHeader) -> int:
    """What must be decoded of formats 6 to 10."""
    has_extra = _label_of(header) is not None or _grid_of(header) is not None
    extra = lazrs.SELECTIVE_DECOMPRESS_ALL_EXTRA_BYTES if has_extra else 0
    return int(_NEEDED_LAYERS | extra)


def _chunk(
    records: NDArray[np.uint8], header: LasHeader, first: int, packets: LasPackets | None
) -> PointChunk:
    """The columns of records, of which the first one is point ``first`` of the file."""
    chunk = PointChunk(_columns(records, header.point_format))
    if packets is not None and packets.delivered.is_readable:
        chunk.columns.update(packets.columns_of(records, header.point_format))
    label, grid = _label_of(header), _grid_of(header)
    if label is not None:
        chunk.columns[_LABEL] = _extra(records, header, label)
    if grid is not None:
        indices = [whole_numbers(_extra(records, header, one)) for one in grid]
        chunk.columns["grid"] = np.column_stack(indices).astype(np.int32)
    _check_positions(chunk.columns["xyz"], header, first)
    return chunk


def _end_spans(count: int, points: int) -> list[tuple[int, int]]:
    if count <= 2 * points:
        return [(0, count)] if count else []
    return [(0, points), (count - points, count)]


def read_records(
    header: LasHeader, chunk_points: int, selection: int | None = None, *, after: int = 0
) -> Iterator[NDArray[np.uint8]]:
    """The point records, decoded.

    Parameters
    ----------
    selection : int or None
        Layers to decode of formats 6 to 10, as lazrs counts them; None for all.
    after : int
        As :func:`read_chunks`.

    Yields
    ------
    (n, point_size) uint8
        Bytes as LAS lays them out; the caller may change them.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        As :func:`read_chunks`.
    """
    with report_as_user_error(header.path), header.path.open("rb") as file:
        if header.is_compressed:
            chunks = read_chunk_table(header, file)
            for begin, end in chunks.groups(chunk_points):
                if chunks.first[begin] >= after:
                    yield chunks.decoded(file, begin, end, selection)
            return
        for start in range(after, header.count, chunk_points):
            yield _plain_records(header, file, start, min(start + chunk_points, header.count))


def _plain_records(
    header: LasHeader, file: BufferedReader, start: int, end: int
) -> NDArray[np.uint8]:
    records = np.empty((end - start, header.point_size), dtype=np.uint8)
    file.seek(header.points_at + start * header.point_size)
    # A file on a network may become shorter after its size was asked for.
    if file.readinto(records.reshape(-1).data) < records.size:
        raise damaged(
            header.path,
            Text(
                "The file became shorter while it was read.",
                "読み込み中にファイルが短くなりました。",
            ),
        )
    return records


def _columns(records: NDArray[np.uint8], point_format: int) -> dict[str, NDArray[np.generic]]:
    """Columns out of the records' bytes; each is a copy of its own."""
    returns = records[:, 14]
    columns: dict[str, NDArray[np.generic]] = {"xyz": _field(records, 0, "<i4", 3)}
    columns["intensity"] = _field(records, 12, "<u2")
    if point_format < 6:
        columns["return_number"] = returns & 7
        columns["number_of_returns"] = (returns >> 3) & 7
        columns["classification"] = records[:, 15] & 31
        columns["user_data"] = records[:, 17].copy()
        columns["scanner"] = _field(records, 18, "<u2")
        columns["scan_angle_deg"] = records[:, 16].view(np.int8).astype(np.float32)
    else:
        columns["return_number"] = returns & 15
        columns["number_of_returns"] = returns >> 4
        columns["classification"] = records[:, 16].copy()
        columns["user_data"] = records[:, 17].copy()
        columns["scanner"] = _field(records, 20, "<u2")
        angle = _field(records, 18, "<i2").astype(np.float32)
        columns["scan_angle_deg"] = np.multiply(angle, np.float32(_ANGLE_STEP_DEG), out=angle)
    # Some writers leave 0, where the format counts from 1.
    for name in ("return_number", "number_of_returns"):
        np.maximum(columns[name], 1, out=columns[name])
    if point_format in _TIME_AT:
        columns["time"] = _times(_field(records, _TIME_AT[point_format], "<f8"))
    if point_format in _COLOR_AT:
        columns["color"] = _field(records, _COLOR_AT[point_format], "<u2", 3)
    return columns


def _field(
    records: NDArray[np.uint8], byte: int, dtype: str, width: int = 1
) -> NDArray[np.generic]:
    """A copy of one field of all records; several values of one type in a row as (n, width)."""
    count, record_size = records.shape
    shape = (count, width) if width > 1 else (count,)
    strides = (record_size, np.dtype(dtype).itemsize)[: len(shape)]
    return np.ndarray(shape, dtype, records.data, byte, strides).copy()


@np.errstate(invalid="ignore")
def _times(times: NDArray[np.generic]) -> NDArray[np.generic]:
    """Times with NaN for what no clock can say; one comparison in the usual case."""
    good = np.abs(times) < _LONGEST_TIME_S
    return times if good.all() else np.where(good, times, np.nan)


def _check_positions(xyz: NDArray[np.int32], header: LasHeader, first: int) -> None:
    limits = np.iinfo(np.int32)
    for axis, name in enumerate(("X", "Y", "Z")):
        own = xyz[:, axis]
        scale, offset = header.scale[axis], header.offset[axis]
        lowest, highest = header.lowest[axis], header.highest[axis]
        low, high = limits.min + 1, limits.max - 1
        if np.isfinite(lowest):
            margin = _FAR_OUTSIDE_M + 10 * (highest - lowest)
            low = max(low, int(max((lowest - margin - offset) / scale, low)))
            high = min(high, int(min((highest + margin - offset) / scale, high)))
        if own.min() >= low and own.max() <= high:
            continue
        bad = int(np.argmax((own < low) | (own > high)))
        what = Text(
            "{name} of point {point:,} is {value:.3f} m, far outside the extent in the header.",
            "{point:,}点目の{name}座標 {value:.3f} m は、ヘッダーの範囲から大きく外れています。",
        )
        raise damaged(
            header.path,
            what.filled(name=name, point=first + bad + 1, value=float(own[bad]) * scale + offset),
        )


def _format_name(header: LasHeader) -> str:
    if header.vlr("copc", 1) is not None:
        return "COPC"
    return "LAZ" if header.is_compressed else "LAS"


def _first_time(header: LasHeader) -> float:
    """A chunk's first point is not compressed, so LAZ holds it where LAS does, 8 bytes later."""
    if header.count == 0:
        return float("nan")
    position = header.points_at + (8 if header.is_compressed else 0) + _TIME_AT[header.point_format]
    with report_as_user_error(header.path), header.path.open("rb") as file:
        file.seek(position)
        data = file.read(8)
    time = struct.unpack("<d", data)[0] if len(data) == 8 else float("nan")
    return float(time) if abs(time) < _LONGEST_TIME_S else float("nan")


def _read_dimensions(header: LasHeader) -> tuple[ExtraDimension, ...]:
    vlr, standard = header.vlr("LASF_Spec", 4), RECORD_SIZES[header.point_format]
    return extra_dimensions(b"" if vlr is None else vlr.data, header.point_size - standard)


def _label_of(header: LasHeader) -> ExtraDimension | None:
    """The extra dimension for labels of one byte, as exporting writes it."""
    own = (one for one in _read_dimensions(header) if (one.name, one.dtype) == (_LABEL, "u1"))
    return next(own, None)


def _grid_of(header: LasHeader) -> tuple[ExtraDimension, ExtraDimension] | None:
    """The extra dimensions that say a point's column and row in a structured scan."""
    plain = {plain_name(one.name): one for one in _read_dimensions(header) if one.dtype}
    found = [next((plain[name] for name in names if name in plain), None) for names in GRID_NAMES]
    column, row = found
    return None if column is None or row is None else (column, row)


def _extra(
    records: NDArray[np.uint8], header: LasHeader, dimension: ExtraDimension
) -> NDArray[np.generic]:
    at = RECORD_SIZES[header.point_format] + dimension.at
    values: NDArray[np.generic] = _field(records, at, f"<{dimension.dtype}")
    return values


def _extra_dimensions(header: LasHeader) -> tuple[str, ...]:
    vlr = header.vlr("LASF_Spec", 4)
    data = b"" if vlr is None else vlr.data
    names = []
    for start in range(0, len(data) - _EXTRA_BYTES_SIZE + 1, _EXTRA_BYTES_SIZE):
        name = data[start + 4 : start + 36].split(b"\0", 1)[0].decode("utf-8", "replace").strip()
        if name:
            names.append(name)
    return tuple(names)

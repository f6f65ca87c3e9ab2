"""Results for points, as LAS or LAZ: the input's points as they were, with classes and more.

Made of the delivered bytes, not by laspy: laspy 2.7 turns points of formats 0 to 5 into those with
8 bits of class with scan angles of 0, and takes as long (4.4 million points with a new dimension
as LAZ, two cores: 21.6 and 23.5 s, here 19.7 and 22.6 s).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import lazrs
import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.map_delivery import MapDelivery, Position
from processing.formats.points.las.las import read_records
from processing.formats.points.las.las_header import RECORD_SIZES, read_header
from processing.formats.points.las.las_output import LasFrame, frame_of, new_frame
from processing.formats.points.las.las_records import (
    COLORED,
    HIGHEST_OLD_CLASS,
    PROMOTED,
    ExtraDimension,
    add_color_fields,
    description_of,
    extra_dimensions,
    move_records,
    positions_in,
    promote_records,
    records_of,
    set_classes,
    set_colors,
)
from processing.formats.points.las.waveform_packets import (
    EXTERNAL_BIT,
    descriptor_record,
    set_wave_fields,
    wave_fields_of,
)
from processing.formats.points.point_files import (
    PointChunk,
    PointFileInfo,
    is_las,
    read_chunks,
    read_info,
)
from processing.formats.points.reported_writes import ReportedWrites, report_write_failures
from processing.formats.registry import FORMATS

# Any: each column has its own type.
ResultColumns = Mapping[str, NDArray[Any]]
Results = ResultColumns | Callable[[int, int], ResultColumns]

_CHUNK_POINTS = 1_000_000
MOVED = "moved_m"
"""A result: how far points are to be moved, (n, 3) float64, m."""

_CLASS, _COLOR = "classification", "color"
_OF_RECORDS = (_CLASS, _COLOR, MOVED)
_FIRST_COLORED_MINOR = 2
_WITH_WAVEFORMS = 9


@dataclass(frozen=True)
class _Plan:
    """How the points of one file become those of another.

    Attributes
    ----------
    promoted_from : int
        Point format of the source to be promoted; -1: stays.
    room_in : int
        Point format, after that, whose records get room for a colour; -1: none is needed.
    dimensions : tuple of ExtraDimension
        Those of the results, placed behind the standard part of the output's records.
    """

    frame: LasFrame
    count: int
    point_size: int
    records: Iterator[NDArray[np.uint8]]
    promoted_from: int
    room_in: int
    dimensions: tuple[ExtraDimension, ...]
    is_las: bool


class _Written:
    """What is known of points once they are written.

    Attributes
    ----------
    of_return : (16,) int64
        Points of each return.
    low, high : (3,) int64
        The lowest and highest integers.
    """

    def __init__(self) -> None:
        self.of_return = np.zeros(16, np.int64)
        self.low, self.high = np.full(3, 2**31), np.full(3, -(2**31))

    def add(self, records: NDArray[np.uint8]) -> None:
        """Count some records more."""
        self.of_return += np.bincount(records[:, 14] & 15, minlength=16)

    def reach(self, records: NDArray[np.uint8]) -> None:
        """Let the extent hold some records more."""
        if len(records):
            xyz = positions_in(records)
            self.low = np.minimum(self.low, xyz.min(axis=0))
            self.high = np.maximum(self.high, xyz.max(axis=0))


def write_results(
    source: Path,
    output: Path,
    results: Results,
    monitor: Monitor,
    *,
    columns: tuple[str, ...] = (),
) -> None:
    """Write the points of a file with results added.

    Parameters
    ----------
    source : Path
        A point file. Of LAS, LAZ and COPC everything is kept: order, coordinates, attributes,
        records; but formats 0 to 5 become 6 to 10 where a class is above 31, and an output is
        never COPC, as its points stay in the input's order. Waveforms beside the file are copied by
        :func:`processing.formats.points.waveform_output.copy_packets`. Of other formats what
        :func:`processing.formats.points.point_files.read_chunks` gives is written.
    output : Path
        ``.las`` or ``.laz``.
    results : mapping, or callable
        ``classification`` (n,) uint8 replaces the classes, ``color`` (n, 3) uint16 the colours,
        for which the next point format that has them is taken; :data:`MOVED` moves the points to
        the nearest places that the file's scale and offset can tell; any other name (n,) of an
        integer or floating type becomes an extra dimension, or replaces the one of this name and
        type.
        Arrays are in the file's order; or a function of ``start, stop`` that gives the part of
        these points, of length 0 when both are 0.
    columns : tuple of str
        What the columns of a text file are, as
        :func:`processing.formats.points.point_files.read_info`.

    Raises
    ------
    InUse
        ``output`` is ``source``.
    OutOfRange
        ``output`` ends with neither ``.las`` nor ``.laz``.
    MissingInput, NoSpace, BadFile
        As the reader and the disk say; nothing is left behind then.
    """
    is_compressed = FORMATS.format_to_write(output, Content.POINTS).id == "laz"
    part = results if callable(results) else _parts_of(results)
    with write_safely(output, never=(source,)) as temporary:
        plan = _plan_of(source, part, columns)
        with temporary.open("wb+") as file, source.open("rb") as source_file:
            written = _write_points(file, plan, part, monitor, is_compressed=is_compressed)
            plan.frame.finish(file, source_file)
            if not plan.is_las:
                plan.frame.note_returns(file, written.of_return)
            if MOVED in part(0, 0) and plan.count:
                plan.frame.note_extent(file, written.low, written.high)


def write_points_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write the points that a map is handed in with, a file for each delivered one."""
    delivery.write_points(position, monitor)


def _parts_of(results: ResultColumns) -> Callable[[int, int], ResultColumns]:
    return lambda start, stop: {name: values[start:stop] for name, values in results.items()}


def _plan_of(
    source: Path, part: Callable[[int, int], ResultColumns], columns: tuple[str, ...]
) -> _Plan:
    records: Iterator[NDArray[np.uint8]]
    if not is_las(source):
        info = read_info(source, columns=columns)
        frame = _frame_with_waveforms(info)
        size, count = RECORD_SIZES[frame.point_format], info.count
        own = frame.point_format
        chunks = read_chunks(source, _CHUNK_POINTS, columns=columns)
        records = (_records_with_waveforms(chunk, own, info) for chunk in chunks)
        promoted_from = -1
    else:
        header = read_header(source)
        is_too_old = _COLOR in part(0, 0) and header.minor < _FIRST_COLORED_MINOR
        promote = header.point_format in PROMOTED and (
            is_too_old or _needs_promotion(part, header.count)
        )
        frame = frame_of(header, promote=promote)
        promoted_from = header.point_format if promote else -1
        extra = header.point_size - RECORD_SIZES[header.point_format]
        size, count = RECORD_SIZES[frame.point_format] + extra, header.count
        records = read_records(header, _CHUNK_POINTS)
    room_in = -1
    if _COLOR in part(0, 0) and frame.point_format in COLORED:
        room_in = frame.point_format
        frame = dataclasses.replace(frame, point_format=COLORED[room_in])
        size += RECORD_SIZES[frame.point_format] - RECORD_SIZES[room_in]
    given = {name: values for name, values in part(0, 0).items() if name not in _OF_RECORDS}
    old = extra_dimensions(frame.extra_bytes(), size - RECORD_SIZES[frame.point_format])
    new, dimensions = _place_dimensions(given, old)
    if len(new) > len(old):
        frame = frame.with_extra_bytes(b"".join(_write_descriptions(frame, old, new)))
    size = RECORD_SIZES[frame.point_format] + sum(dimension.size for dimension in new)
    return _Plan(frame, count, size, records, promoted_from, room_in, dimensions, is_las(source))


def _frame_with_waveforms(info: PointFileInfo) -> LasFrame:
    """The frame for points of another format, which name packets where packets were made."""
    frame = new_frame(info)
    if not _has_packets(info) or info.waveforms is None:
        return frame
    head = bytearray(frame.head)
    head[6] |= EXTERNAL_BIT
    vlrs = (descriptor_record(*one) for one in info.waveforms.descriptors.items())
    return dataclasses.replace(
        frame, head=bytes(head), point_format=_WITH_WAVEFORMS, vlrs=(*frame.vlrs, *vlrs)
    )


def _has_packets(info: PointFileInfo) -> bool:
    """Whether the file's waveforms go beside LAS; points with colours have no such format here."""
    waveforms = info.waveforms
    is_kept = waveforms is not None and waveforms.is_readable and waveforms.has_head
    return is_kept and not info.has_color


def _records_with_waveforms(
    chunk: PointChunk, point_format: int, info: PointFileInfo
) -> NDArray[np.uint8]:
    records = records_of(chunk, point_format)
    if point_format != _WITH_WAVEFORMS or info.waveforms is None:
        return records
    fields = wave_fields_of(chunk.columns, info.waveforms.descriptors)
    return set_wave_fields(records, fields, point_format)


def _needs_promotion(part: Callable[[int, int], ResultColumns], count: int) -> bool:
    for start in range(0, count, _CHUNK_POINTS):
        classes = part(start, min(start + _CHUNK_POINTS, count)).get(_CLASS)
        if classes is None:
            return False
        if classes.size and classes.max() > HIGHEST_OLD_CLASS:
            return True
    return False


def _place_dimensions(
    given: ResultColumns, old: tuple[ExtraDimension, ...]
) -> tuple[tuple[ExtraDimension, ...], tuple[ExtraDimension, ...]]:
    """All extra dimensions of the output, and those among them that the results fill."""
    dimensions = list(old)
    filled = []
    for name, values in given.items():
        dtype = values.dtype.str.lstrip("<>|=")
        same = next((d for d in old if (d.name, d.dtype) == (name, dtype)), None)
        if same is None:
            taken = {dimension.name for dimension in dimensions}
            free = name if name not in taken else f"{name}_2"
            end = sum(dimension.size for dimension in dimensions)
            same = ExtraDimension(free, end, values.dtype.itemsize, dtype)
            dimensions.append(same)
        filled.append(same)
    return tuple(dimensions), tuple(filled)


def _write_descriptions(
    frame: LasFrame, old: tuple[ExtraDimension, ...], new: tuple[ExtraDimension, ...]
) -> Iterator[bytes]:
    """The source's own description as it is, then undescribed bytes, then the new dimensions."""
    known = [dimension for dimension in old if dimension.name or dimension.dtype]
    yield frame.extra_bytes()[: 192 * len(known)]
    for dimension in new[len(known) :]:
        yield description_of(dimension)


def _write_points(
    file: BinaryIO,
    plan: _Plan,
    part: Callable[[int, int], ResultColumns],
    monitor: Monitor,
    *,
    is_compressed: bool,
) -> _Written:
    """Write everything but the extended records."""
    standard = RECORD_SIZES[plan.frame.point_format]
    laz = lazrs.LazVlr.new_for_compression(plan.frame.point_format, plan.point_size - standard)
    file.write(
        plan.frame.start(plan.point_size, bytes(laz.record_data()) if is_compressed else None)
    )
    reported = ReportedWrites(file)
    compressor = lazrs.ParLasZipCompressor(reported, laz) if is_compressed else None
    written = _Written()
    start = 0
    for source_records in plan.records:
        monitor.check()
        stop = start + source_records.shape[0]
        results = part(start, stop)
        records = _with_results(source_records, plan, results)
        written.add(records)
        if MOVED in results:
            written.reach(records)
        if compressor is None:
            file.write(records.data)
        else:
            with report_write_failures(reported):
                compressor.compress_many(records.reshape(-1))
        start = stop
        monitor.report(start / plan.count, Text("Writing the points", "点群を書き込み中"))
    if compressor is not None:
        with report_write_failures(reported):
            compressor.done()
    return written


def _with_results(
    source: NDArray[np.uint8], plan: _Plan, results: ResultColumns
) -> NDArray[np.uint8]:
    kept = source if plan.promoted_from < 0 else promote_records(source, plan.promoted_from)
    if plan.room_in >= 0:
        kept = add_color_fields(kept, plan.room_in)
    records = np.zeros((kept.shape[0], plan.point_size), dtype=np.uint8)
    records[:, : kept.shape[1]] = kept
    if MOVED in results:
        records = move_records(records, plan.frame.quantisation.steps(results[MOVED]))
    if _CLASS in results:
        classes = np.asarray(results[_CLASS], dtype=np.uint8)
        records = set_classes(records, plan.frame.point_format, classes)
    if _COLOR in results:
        colors = np.asarray(results[_COLOR], dtype=np.uint16)
        records = set_colors(records, plan.frame.point_format, colors)
    standard = RECORD_SIZES[plan.frame.point_format]
    others = [values for name, values in results.items() if name not in _OF_RECORDS]
    for dimension, values in zip(plan.dimensions, others, strict=True):
        own = np.ascontiguousarray(values, dtype=f"<{dimension.dtype}")
        begin = standard + dimension.at
        records[:, begin : begin + dimension.size] = own.view(np.uint8).reshape(own.shape[0], -1)
    return records

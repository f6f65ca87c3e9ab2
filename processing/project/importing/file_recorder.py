"""Reading one delivered file into columns: in this process or in one beside it.

The file's points go straight to their place in the drive's columns where header and ends of the
files tell it beforehand; where scanners are mixed, each scanner's points get a folder of their own,
and they are joined later.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, BadFile, UserError, report_as_user_error
from processing.core.kernels import kernel
from processing.core.text import Text
from processing.formats.points.point_files import PointChunk, read_chunks
from processing.project.importing.file_record import FileJob, FileRecord, Stream
from processing.project.importing.quantisation import shift_between
from processing.recording.columns.offset_columns import OffsetColumnWriter
from processing.recording.columns.source_order import INDEX
from processing.recording.waveform_packets.descriptors import KEY_OF_FILE, PACKET, WAVE_COLUMNS

CHUNK_POINTS = 500_000
ALWAYS = ("xyz", "time", "intensity", "return_number", "number_of_returns", "classification")
_WHERE_DELIVERED = ("color", "origin", "label", "grid", *WAVE_COLUMNS)
_ANGLE = "scan_angle_deg"
_HASHED_BYTES = 1 << 20
_MOST_RUNS = 1_000
_MOST_OPEN = 16
_FEWEST_EMPTY = 1_000

ChunkColumns = dict[str, NDArray[Any]]
RecordListener = Callable[[FileRecord], None]


class NotAsPlanned(Exception):
    """A file holds other points than its header and its ends promised; it must go into parts."""


def record_file(job: FileJob, record: FileRecord, reported: RecordListener) -> FileRecord:
    """Read a file's points into columns, from where its record says.

    Parameters
    ----------
    record : FileRecord
        How far an earlier try came; changed as points are written.
    reported : callable
        Called with the record after each stretch; what it raises ends the work.

    Raises
    ------
    UserError
        The file can't be read, was changed since the import began, or the disk is full.
    NotAsPlanned
    """
    recorder = _Recorder(job, record)
    try:
        with ThreadPoolExecutor(max_workers=1) as pool:
            checksum = pool.submit(checksum_of, Path(job.path))
            for chunk in _read_ahead(_chunks_after(job, record.done)):
                recorder.add(wanted_columns(job, chunk))
                reported(record)
            _check_unchanged(job, record.done)
            record.sha256 = checksum.result()
    finally:
        recorder.close()
    return record


def wanted_columns(job: FileJob, chunk: PointChunk) -> ChunkColumns:
    """The columns of a chunk; points of files without labels have none of them.

    A packet's byte becomes its key, which tells the packets of several files apart.
    """
    columns = chunk.columns
    if PACKET in columns:
        columns[PACKET][columns[PACKET] >= 0] += job.number * KEY_OF_FILE
    if job.labels == "classification":
        columns["label"] = columns["classification"]
    elif job.has_labels and "label" not in columns:
        columns["label"] = np.zeros(chunk.count, np.uint8)
    return columns


def column_names(given: Mapping[str, object], *, keeps_angles: bool) -> tuple[str, ...]:
    """Which columns a drive gets from a chunk's."""
    optional = (*_WHERE_DELIVERED, *((_ANGLE,) if keeps_angles else ()))
    return (*ALWAYS, *(name for name in optional if name in given))


def checksum_of(path: Path) -> str:
    """SHA-256 of a file, or of all files of a folder in the order of their names.

    Raises
    ------
    UserError
        It can't be read.
    """
    files = sorted(file for file in path.rglob("*") if file.is_file()) if path.is_dir() else [path]
    digest = hashlib.sha256()
    with report_as_user_error(path):
        for name in files:
            with name.open("rb") as file:
                while block := file.read(_HASHED_BYTES):
                    digest.update(block)
    return digest.hexdigest()


class _Recorder:
    """Deals the points of a file to its streams and writes them."""

    def __init__(self, job: FileJob, record: FileRecord) -> None:
        self._job = job
        self._record = record
        self._quantisation = (
            job.position.quantisation if job.position is not None else job.quantisation
        )
        self._open: dict[int, OffsetColumnWriter] = {}

    def add(self, columns: ChunkColumns) -> None:
        """Write the next points of the file."""
        count = columns["xyz"].shape[0]
        start = self._record.done
        self._refuse_empty(columns, start)
        indices = np.arange(start, start + count, dtype=np.int64)
        for scanner, chosen in _by_scanner(columns, self._job.scanner_column):
            if chosen is None:
                self._write(scanner, columns, indices)
            else:
                dealt = {name: values[chosen] for name, values in columns.items()}
                self._write(scanner, dealt, indices[chosen])
        self._record.done = start + count

    def close(self) -> None:
        """Close the files."""
        for columns in self._open.values():
            columns.close()

    def _write(self, scanner: int, given: ChunkColumns, indices: NDArray[np.int64]) -> None:
        if indices.size == 0:
            return
        names = column_names(given, keeps_angles=self._job.keeps_angles)
        number = self._stream_of(scanner, names)
        stream = self._record.streams[number]
        columns = {name: given[name] for name in names if name in given}
        columns["xyz"] = self._move_points(given["xyz"])
        columns["time"] = _times_of(stream, given)
        self._note_indices(number, columns, indices)
        self._columns_of(number).write(stream.count, columns)
        low, high = np.array(stream.lowest), np.array(stream.highest)
        _widen_kernel(np.ascontiguousarray(columns["xyz"]), low, high)
        stream.lowest = (int(low[0]), int(low[1]), int(low[2]))
        stream.highest = (int(high[0]), int(high[1]), int(high[2]))
        stream.count += indices.size

    def _stream_of(self, scanner: int, names: tuple[str, ...]) -> int:
        position = self._job.position
        if position is not None and (position.scanner, position.names) != (scanner, names):
            raise NotAsPlanned
        for number, stream in enumerate(self._record.streams):
            if (stream.scanner, stream.names) == (scanner, names):
                return number
        self._record.streams.append(Stream(scanner, names))
        return len(self._record.streams) - 1

    def _move_points(self, xyz: NDArray[np.int32]) -> NDArray[np.int32]:
        if self._quantisation == self._job.quantisation:
            return xyz
        move = shift_between(self._job.quantisation, self._quantisation)
        moved = None if move is None else move.applied(xyz)
        if moved is None:
            raise NotAsPlanned
        return moved

    def _note_indices(self, number: int, columns: ChunkColumns, indices: NDArray[np.int64]) -> None:
        """Note where in the file points were: as runs, or as a column where these are many."""
        stream = self._record.streams[number]
        first = int(indices[0])
        is_run = int(indices[-1]) - first == indices.size - 1
        runs = stream.runs
        if not stream.is_indexed and is_run:
            if runs and runs[-1][2] + runs[-1][1] == first:
                start, count, index = runs[-1]
                runs[-1] = (start, count + indices.size, index)
                return
            if len(runs) < _MOST_RUNS:
                runs.append((stream.count, indices.size, first))
                return
        if not stream.is_indexed:
            write_indices(self._columns_of(number), stream)
            stream.is_indexed = True
            stream.runs = []
        columns[INDEX] = indices

    def _columns_of(self, number: int) -> OffsetColumnWriter:
        if number not in self._open:
            # A file may hold more scans than files may be open at a time; they follow one another.
            if len(self._open) >= _MOST_OPEN:
                self._open.pop(next(iter(self._open))).close()
            self._open[number] = self._open_writer(number)
        return self._open[number]

    def _open_writer(self, number: int) -> OffsetColumnWriter:
        position = self._job.position
        if position is not None:
            return OffsetColumnWriter(Path(position.folder), position.first)
        folder = part_folder(self._job, number)
        with report_as_user_error(folder):
            folder.mkdir(parents=True, exist_ok=True)
        return OffsetColumnWriter(folder)

    def _refuse_empty(self, columns: ChunkColumns, start: int) -> None:
        """Refuse a stretch of nothing but zeros: room that a copying program took, never filled."""
        given = [columns[name] for name in ("xyz", "intensity", "time") if name in columns]
        count = columns["xyz"].shape[0]
        if count < _FEWEST_EMPTY or any(values.any() for values in given):
            return
        raise empty_points(Path(self._job.path), start + 1, start + count)


def empty_points(path: Path, first: int, last: int) -> UserError:
    """What is said of points that were never written."""
    return BadFile(
        Text(
            "Points {first:,} to {last:,} are all zeros: the file was never copied to its end.",
            "{first:,}～{last:,}点目がすべてゼロです。ファイルのコピーが完了していません。",
        ).filled(first=first, last=last),
        Text.same(str(path)),
        Text(
            "Copy the file again from the delivery. {unchanged}",
            "納品データからファイルをコピーし直してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def part_folder(job: FileJob, stream: int) -> Path:
    """Where a stream's points go that have no place of their own yet."""
    return Path(job.parts) / f"{job.number}-{stream}"


def write_indices(columns: OffsetColumnWriter, stream: Stream) -> None:
    """Write as a column what a stream's runs say.

    Raises
    ------
    NoSpace
    """
    for start, count, index in stream.runs:
        for done in range(0, count, CHUNK_POINTS):
            size = min(CHUNK_POINTS, count - done)
            columns.write(start + done, {INDEX: np.arange(index + done, index + done + size)})


def _chunks_after(job: FileJob, done: int) -> Iterator[PointChunk]:
    """The chunks that are still to be read; they end where they ended in an earlier try."""
    return read_chunks(Path(job.path), CHUNK_POINTS, after=done, columns=job.columns)


def _check_unchanged(job: FileJob, points: int) -> None:
    path = Path(job.path)
    with report_as_user_error(path):
        status = path.stat()
    if (status.st_size, status.st_mtime_ns, points) == (job.size, job.modified_ns, job.count):
        return
    raise BadFile(
        Text(
            "The file was changed while it was imported.",
            "インポート中にファイルが変更されました。",
        ),
        Text.same(str(path)),
        Text(
            "Import it again when nothing writes to it any more. {unchanged}",
            "書き込みが終わってから、もう一度インポートしてください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def _by_scanner(columns: ChunkColumns, name: str) -> Iterator[tuple[int, NDArray[np.bool_] | None]]:
    """Each scanner number of a chunk and its points; None for all of them."""
    if name not in columns or columns["xyz"].shape[0] == 0:
        yield 0, None
        return
    numbers = columns[name]
    if numbers.min() == numbers.max():
        yield int(numbers[0]), None
        return
    for number in np.unique(numbers):
        yield int(number), numbers == number


def _read_ahead(chunks: Iterator[PointChunk]) -> Iterator[PointChunk]:
    """The same chunks, the next one being decoded while one is worked on."""
    with ThreadPoolExecutor(max_workers=1) as pool:
        coming: Future[PointChunk | None] = pool.submit(next, chunks, None)
        while (chunk := coming.result()) is not None:
            coming = pool.submit(next, chunks, None)
            yield chunk


def _times_of(stream: Stream, given: ChunkColumns) -> NDArray[np.float64]:
    """Times, with a lost one taken from the point before it; their order is watched."""
    if "time" not in given:
        stream.has_times = False
        return np.full(given["xyz"].shape[0], np.nan)
    times = np.asarray(given["time"], dtype=np.float64)
    # A sum is not finite where any value is not: one quick pass in the usual case.
    if not np.isfinite(times.sum()):
        times = _fill_times(times, stream.last_time)
        if np.isnan(times).any():
            stream.has_times = False
            return times
    before = stream.last_time if np.isfinite(stream.last_time) else -np.inf
    if stream.is_in_time_order:
        stream.is_in_time_order = bool(_rises_kernel(times, before))
    if not np.isfinite(stream.first_time):
        stream.first_time = float(times[0])
    stream.last_time = float(times[-1])
    return times


def _fill_times(times: NDArray[np.float64], before: float) -> NDArray[np.float64]:
    good = np.isfinite(times)
    if not good.any():
        return np.full_like(times, before if np.isfinite(before) else np.nan)
    last_good = np.maximum.accumulate(np.where(good, np.arange(times.size), -1))
    first_good = float(times[np.argmax(good)])
    start = before if np.isfinite(before) else first_good
    return np.where(last_good >= 0, times[np.maximum(last_good, 0)], start)


def warm_up() -> None:
    """Compile the kernels."""
    _widen_kernel(np.zeros((1, 3), np.int32), np.zeros(3, np.int64), np.zeros(3, np.int64))
    _rises_kernel(np.zeros(1), 0.0)


@kernel
def _widen_kernel(
    integers: NDArray[np.int32], lowest: NDArray[np.int64], highest: NDArray[np.int64]
) -> None:
    low_x, low_y, low_z = integers[0]
    high_x, high_y, high_z = integers[0]
    for point in range(1, integers.shape[0]):
        x, y, z = integers[point, 0], integers[point, 1], integers[point, 2]
        low_x, high_x = min(low_x, x), max(high_x, x)
        low_y, high_y = min(low_y, y), max(high_y, y)
        low_z, high_z = min(low_z, z), max(high_z, z)
    lowest[0], highest[0] = min(lowest[0], low_x), max(highest[0], high_x)
    lowest[1], highest[1] = min(lowest[1], low_y), max(highest[1], high_y)
    lowest[2], highest[2] = min(lowest[2], low_z), max(highest[2], high_z)


@kernel
def _rises_kernel(times: NDArray[np.float64], before: float) -> bool:
    for time in times:
        if time < before:
            return False
        before = time
    return True

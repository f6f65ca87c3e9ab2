"""Importing: delivered files become drive folders; nothing in a delivered file is changed.

Files are streamed once: a chunk is decoded while the one before it is written. What is found in
the points afterwards (order, clock, rows, pulses) is :mod:`processing.project.drive_building`.
"""

from __future__ import annotations

import hashlib
import shutil
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from processing.cameras.image_list import ImageList
from processing.errors import UNCHANGED, BadFile, told_as_user_error
from processing.formats.image_list import read_image_list
from processing.formats.point_chunk import Vector3
from processing.formats.point_files import PointChunk, PointFileInfo, read_chunks
from processing.monitor import Monitor, PartMonitor
from processing.points.drive_info import SourceFile
from processing.project.delivery import DeliveredFile, Delivery, read_delivery
from processing.project.drive_building import BuildPlan, build_drive
from processing.project.lattice import Lattice
from processing.project.recording_writer import RecordingWriter
from processing.project.trajectory_choice import NamedTrajectory, read_trajectories
from processing.text import Text

_CHUNK_POINTS = 500_000
_READING = 0.7
_HASHED_BYTES = 1 << 20


Labels = Literal["label", "classification"]


@dataclass(frozen=True)
class ImportRequest:
    """What to import.

    Attributes
    ----------
    inputs : tuple of Path
        Point files.
    trajectories, images : tuple of Path
        Trajectory files; camera image lists.
    crs : str
        ``EPSG:n``; empty to take the files' own.
    labels : "label" or "classification"
        What becomes of the points' labels: the extra dimension of this name, where there is one;
        or the delivered classes.
    """

    inputs: tuple[Path, ...]
    trajectories: tuple[Path, ...] = ()
    images: tuple[Path, ...] = ()
    crs: str = ""
    labels: Labels = "label"


def import_drives(request: ImportRequest, into: Path, monitor: Monitor) -> tuple[Path, ...]:
    """Turn delivered files into drive folders.

    Parameters
    ----------
    into : Path
        A folder for temporary drive folders, of this import alone;
        :meth:`processing.project.project.Project.adopt_drive` takes them from there.

    Returns
    -------
    tuple of Path
        One folder per scanner; whole, or none at all.

    Raises
    ------
    UserError
        For a file that can't be read or doesn't fit; nothing is left behind.
    Cancelled
        Nothing is left behind.
    """
    delivery = read_delivery(request.inputs, request.crs, monitor)
    files = tuple(file.info for group in delivery.recordings for file in group)
    images = _images_of(request.images)
    with told_as_user_error(into):
        into.mkdir(parents=True, exist_ok=True)
    try:
        with ThreadPoolExecutor(max_workers=1) as pool:
            ways = pool.submit(read_trajectories, request.trajectories, delivery.crs)
            checksums = [pool.submit(_checksum, info.path) for info in files]
            reading = _AlsoWatching(PartMonitor(monitor, 0.0, _READING), ways)
            way = _ReadWay(
                keeps_angles=not request.trajectories,
                has_labels=any("label" in info.attributes for info in files),
                labels=request.labels,
            )
            writers = _read_all(delivery, files, into, reading, way=way)
            trajectories = ways.result()
            sources = tuple(
                _source_file(info, checksum)
                for info, checksum in zip(files, checksums, strict=True)
            )
        writers.sort(key=lambda writer: writer.scanner)
        plan = BuildPlan(
            sources,
            delivery.crs,
            trajectories,
            images,
            _is_adjusted_standard(files),
            _shared_sources(writers),
            _scanner_places(files),
        )
        folders = []
        for number, writer in enumerate(writers):
            share = (1 - _READING) / len(writers)
            start = _READING + number * share
            folders.append(build_drive(writer, plan, PartMonitor(monitor, start, start + share)))
    except BaseException:
        shutil.rmtree(into, ignore_errors=True)
        raise
    return tuple(folders)


@dataclass(frozen=True)
class _ReadWay:
    """What is wanted of all files: scan angles, labels; whether a file has labels."""

    keeps_angles: bool
    has_labels: bool
    labels: Labels

    def wanted(self, chunk: PointChunk) -> dict[str, NDArray[Any]]:
        """The columns of a chunk; points of files without labels have none of them."""
        columns = chunk.columns
        if self.labels == "classification":
            columns["label"] = columns["classification"]
        elif self.has_labels and "label" not in columns:
            columns["label"] = np.zeros(chunk.count, np.uint8)
        return columns


@dataclass(frozen=True)
class _ReadPlan:
    """How one file is read: its number, where its drives go, what is wanted."""

    file: DeliveredFile
    source: int
    folder_stem: Path
    way: _ReadWay


class _AlsoWatching:
    """A monitor that stops the reading of points when what is read beside them can't be read."""

    def __init__(self, monitor: Monitor, beside: Future[tuple[NamedTrajectory, ...]]) -> None:
        self._monitor = monitor
        self._beside = beside

    def report(self, fraction: float, text: Text | None = None) -> None:
        self._monitor.report(fraction, text)

    def check(self) -> None:
        self._monitor.check()
        if self._beside.done():
            self._beside.result()


def _read_all(
    delivery: Delivery,
    files: tuple[PointFileInfo, ...],
    into: Path,
    monitor: Monitor,
    *,
    way: _ReadWay,
) -> list[RecordingWriter]:
    total = sum(info.count for info in files)
    if total == 0:
        raise BadFile(
            Text("There are no points in it.", "点が含まれていません。"),
            Text.same(", ".join(str(info.path) for info in files)),
            Text(
                "Choose a file with points. {unchanged}",
                "点のあるファイルを選んでください。{unchanged}",
            ).filled(unchanged=UNCHANGED),
        )
    writers: list[RecordingWriter] = []
    done = 0
    try:
        for group in delivery.recordings:
            own: list[RecordingWriter] = []
            for file in group:
                part = PartMonitor(monitor, done / total, (done + file.info.count) / total)
                plan = _ReadPlan(file, files.index(file.info), into / f"{len(writers)}", way)
                _read_file(plan, own, part)
                done += file.info.count
            writers += own
    finally:
        for writer in writers:
            writer.close()
    return writers


def _read_file(plan: _ReadPlan, writers: list[RecordingWriter], monitor: Monitor) -> None:
    """Deal the points of one file to the writers of its group; new ones are made as needed."""
    info = plan.file.info
    lattice = Lattice(info.scale, info.offset)
    text = Text("Reading {name}", "{name} を読み込み中").filled(name=info.path.name)
    start = 0
    for chunk in _read_ahead(read_chunks(info.path, _CHUNK_POINTS)):
        monitor.check()
        indices = np.arange(start, start + chunk.count, dtype=np.int64)
        wanted = plan.way.wanted(chunk)
        for scanner, chosen in _by_scanner(wanted, plan.file.scanner_column):
            columns, own = wanted, indices
            if chosen is not None:
                columns = {name: values[chosen] for name, values in columns.items()}
                own = indices[chosen]
            taking = (w for w in writers if w.scanner == scanner and w.takes(lattice, columns))
            writer = next(taking, None)
            if writer is None:
                folder = plan.folder_stem.with_name(f"{plan.folder_stem.name}-{len(writers)}")
                angles = plan.way.keeps_angles
                writer = RecordingWriter(folder, lattice, scanner, keeps_angles=angles)
                writers.append(writer)
            writer.add(columns, lattice, plan.source, own)
            if len(info.scanner_places) > 1:
                # Scans follow one another, and a file may have more than may be open at a time.
                for other in writers:
                    if other is not writer:
                        other.close()
        start += chunk.count
        monitor.report(start / max(info.count, 1), text)


def _by_scanner(
    columns: dict[str, NDArray[Any]], name: str
) -> Iterator[tuple[int, NDArray[np.bool_] | None]]:
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


def _images_of(lists: tuple[Path, ...]) -> ImageList | None:
    images = [image for path in lists for image in read_image_list(path)]
    return ImageList(tuple(images)) if images else None


def _is_adjusted_standard(files: tuple[PointFileInfo, ...]) -> bool | None:
    """What the files say of their clock, where they agree."""
    said = {info.is_adjusted_standard for info in files}
    return said.pop() if len(said) == 1 else None


def _shared_sources(writers: list[RecordingWriter]) -> frozenset[int]:
    uses = Counter(source for writer in writers for source in writer.points_of_source)
    return frozenset(source for source, count in uses.items() if count > 1)


def _scanner_places(files: tuple[PointFileInfo, ...]) -> dict[tuple[int, int], Vector3]:
    """By file and scanner number, which is 0 where a file has one scan."""
    return {
        (source, scan if len(info.scanner_places) > 1 else 0): place
        for source, info in enumerate(files)
        for scan, place in info.scanner_places
    }


def _checksum(path: Path) -> str:
    """Of a file, or of all files of a folder in the order of their names."""
    files = sorted(file for file in path.rglob("*") if file.is_file()) if path.is_dir() else [path]
    digest = hashlib.sha256()
    with told_as_user_error(path):
        for name in files:
            with name.open("rb") as file:
                while block := file.read(_HASHED_BYTES):
                    digest.update(block)
    return digest.hexdigest()


def _source_file(info: PointFileInfo, checksum: Future[str]) -> SourceFile:
    with told_as_user_error(info.path):
        status = info.path.stat()
    return SourceFile(
        path=str(info.path.resolve()),
        size=status.st_size,
        modified_ns=status.st_mtime_ns,
        sha256=checksum.result(),
        points=info.count,
    )

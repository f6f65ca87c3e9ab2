"""Where the points of delivered files go: planned from headers and ends, before any is decoded."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from processing.points.columns import COLUMN_TYPES
from processing.project.delivery import DeliveredFile, Delivery
from processing.project.file_record import FileJob, FileRecord, Place
from processing.project.file_recorder import column_names, part_folder
from processing.project.import_request import FileMark, Labels
from processing.project.lattice import Lattice, move_between
from processing.project.recording import Part, Recording

_MADE_LATER_BYTES = 8
_FAR = np.iinfo(np.int32).max


@dataclass(frozen=True)
class ReadWay:
    """What is wanted of all files: scan angles, labels; whether a file has labels."""

    keeps_angles: bool
    has_labels: bool
    labels: Labels

    def names(self, file: DeliveredFile) -> tuple[str, ...]:
        """The columns that a file's points get."""
        labelled = {"label"} if self.has_labels or self.labels == "classification" else set()
        return column_names(
            dict.fromkeys((*file.columns, *labelled)), keeps_angles=self.keeps_angles
        )


@dataclass(frozen=True)
class Layout:
    """Where everything goes.

    Attributes
    ----------
    jobs : tuple of FileJob
        By number of the file.
    groups : tuple of tuple of int
        The files of each group, in their order.
    planned : mapping of int to tuple of Recording
        By number of the group, for groups whose points go straight to their place: the
        recordings, still without points.
    """

    jobs: tuple[FileJob, ...]
    groups: tuple[tuple[int, ...], ...]
    planned: Mapping[int, tuple[Recording, ...]]

    def group_of(self, number: int) -> int:
        """The group of a file."""
        return next(at for at, numbers in enumerate(self.groups) if number in numbers)

    @property
    def column_bytes(self) -> int:
        """What all columns take on the disk, as far as it is known."""
        total = 0
        for job in self.jobs:
            names = (
                job.place.names if job.place is not None else column_names({}, keeps_angles=True)
            )
            total += job.count * (bytes_of(names) + _MADE_LATER_BYTES)
        return total


def bytes_of(names: tuple[str, ...]) -> int:
    """What a point takes in columns."""
    widths = (COLUMN_TYPES[name] for name in names)
    return sum(np.dtype(dtype).itemsize * width for dtype, width in widths)


def layout_of(
    delivery: Delivery,
    marks: Mapping[str, FileMark],
    way: ReadWay,
    into: Path,
    mixed: Collection[int],
) -> Layout:
    """Plan where the points of a delivery go.

    Parameters
    ----------
    marks : mapping of str to FileMark
        By whole path.
    into : Path
        The import's folder.
    mixed : collection of int
        Groups whose points turned out not to be as planned.
    """
    jobs: list[FileJob] = []
    groups: list[tuple[int, ...]] = []
    planned: dict[int, tuple[Recording, ...]] = {}
    for at, group in enumerate(delivery.recordings):
        first = len(jobs)
        groups.append(tuple(range(first, first + len(group))))
        own = [
            _job(file, first + number, marks, way, into / "parts")
            for number, file in enumerate(group)
        ]
        if at not in mixed and all(len(file.scanners) == 1 for file in group):
            own, planned[at] = _placed(own, group, way, into / f"{at}")
        jobs += own
    return Layout(tuple(jobs), tuple(groups), planned)


def _job(
    file: DeliveredFile, number: int, marks: Mapping[str, FileMark], way: ReadWay, parts: Path
) -> FileJob:
    path = file.info.path.resolve()
    mark = marks[str(path)]
    return FileJob(
        number=number,
        path=str(path),
        format=file.info.format,
        count=file.info.count,
        size=mark.size,
        modified_ns=mark.modified_ns,
        lattice=Lattice(file.info.scale, file.info.offset),
        scanner_column=file.scanner_column,
        keeps_angles=way.keeps_angles,
        has_labels=way.has_labels,
        labels=way.labels,
        parts=str(parts),
        columns=file.info.columns_taken,
    )


def _placed(
    jobs: list[FileJob], group: tuple[DeliveredFile, ...], way: ReadWay, stem: Path
) -> tuple[list[FileJob], tuple[Recording, ...]]:
    """The jobs with their places, and the recordings that these make."""
    recordings: list[Recording] = []
    counts: list[int] = []
    placed = []
    for job, file in zip(jobs, group, strict=True):
        names, scanner = way.names(file), next(iter(file.scanners))
        taking = (
            at
            for at, one in enumerate(recordings)
            if (one.scanner, one.delivered_names) == (scanner, names)
            and _fits(job, file, one.lattice)
        )
        at = next(taking, len(recordings))
        if at == len(recordings):
            folder = stem.with_name(f"{stem.name}-{at}")
            recordings.append(Recording(folder, job.lattice, scanner, names))
            counts.append(0)
        recording = recordings[at]
        place = Place(str(recording.folder), counts[at], scanner, names, recording.lattice)
        placed.append(replace(job, place=place))
        counts[at] += job.count
    return placed, tuple(recordings)


def _fits(job: FileJob, file: DeliveredFile, lattice: Lattice) -> bool:
    """Whether a file's points can be moved to a lattice, as far as its header tells."""
    if job.lattice == lattice:
        return True
    corners = np.array([file.info.lowest, file.info.highest])
    if move_between(job.lattice, lattice) is None or not np.isfinite(corners).all():
        return False
    moved = (corners - np.array(lattice.offset)) / np.array(lattice.scale)
    return bool(np.abs(moved).max() < _FAR)


def recordings_of(
    layout: Layout, group: int, records: Mapping[int, FileRecord]
) -> tuple[Recording, ...]:
    """The recordings of a group that was read: as planned, or dealt from the files' parts."""
    numbers = layout.groups[group]
    if group in layout.planned:
        found = layout.planned[group]
        by_folder = {str(one.folder): one for one in found}
        for one in found:
            one.parts.clear()
        for number in numbers:
            place = layout.jobs[number].place
            if place is not None:
                streams = records[number].streams
                parts = [Part(number, at, stream) for at, stream in enumerate(streams)]
                by_folder[place.folder].parts += parts
        return tuple(one for one in found if one.count)
    recordings: list[Recording] = []
    for number in numbers:
        job = layout.jobs[number]
        for at, stream in enumerate(records[number].streams):
            taking = (one for one in recordings if one.takes(job.lattice, stream))
            recording = next(taking, None)
            if recording is None:
                folder = part_folder(job, at)
                recording = Recording(folder, job.lattice, stream.scanner, stream.names)
                recordings.append(recording)
            recording.parts.append(Part(number, at, stream))
    return tuple(recordings)

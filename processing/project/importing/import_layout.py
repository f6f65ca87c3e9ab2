"""Where the points of delivered files go: planned from headers and ends, before any is decoded."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from processing.project.importing.delivery import DeliveredFile, Delivery
from processing.project.importing.file_record import FileJob, FilePlacement, FileRecord
from processing.project.importing.file_recorder import column_names, part_folder
from processing.project.importing.import_request import FileMark, Labels
from processing.project.importing.quantisation import shift_between
from processing.project.importing.recording import Recording, RecordingPart
from processing.recording.columns.columns import COLUMN_TYPES
from processing.recording.columns.quantisation import Quantisation

_MADE_LATER_BYTES = 8
_FAR = np.iinfo(np.int32).max


@dataclass(frozen=True)
class ReadOptions:
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
class ImportLayout:
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
                job.position.names
                if job.position is not None
                else column_names({}, keeps_angles=True)
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
    options: ReadOptions,
    into: Path,
    mixed: Collection[int],
) -> ImportLayout:
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
            _job(file, first + number, marks, options, into / "parts")
            for number, file in enumerate(group)
        ]
        if at not in mixed and all(len(file.scanners) == 1 for file in group):
            own, planned[at] = _place_jobs(own, group, options, into / f"{at}")
        jobs += own
    return ImportLayout(tuple(jobs), tuple(groups), planned)


def _job(
    file: DeliveredFile,
    number: int,
    marks: Mapping[str, FileMark],
    options: ReadOptions,
    parts: Path,
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
        quantisation=Quantisation(file.info.scale, file.info.offset),
        scanner_column=file.scanner_column,
        keeps_angles=options.keeps_angles,
        has_labels=options.has_labels,
        labels=options.labels,
        parts=str(parts),
        columns=file.info.columns_taken,
    )


def _place_jobs(
    jobs: list[FileJob], group: tuple[DeliveredFile, ...], options: ReadOptions, stem: Path
) -> tuple[list[FileJob], tuple[Recording, ...]]:
    """The jobs with their places, and the recordings that these make."""
    recordings: list[Recording] = []
    counts: list[int] = []
    placed = []
    for job, file in zip(jobs, group, strict=True):
        names, scanner = options.names(file), next(iter(file.scanners))
        taking = (
            at
            for at, one in enumerate(recordings)
            if (one.scanner, one.delivered_names) == (scanner, names)
            and _fits(job, file, one.quantisation)
        )
        at = next(taking, len(recordings))
        if at == len(recordings):
            folder = stem.with_name(f"{stem.name}-{at}")
            recordings.append(Recording(folder, job.quantisation, scanner, names))
            counts.append(0)
        recording = recordings[at]
        position = FilePlacement(
            str(recording.folder), counts[at], scanner, names, recording.quantisation
        )
        placed.append(replace(job, position=position))
        counts[at] += job.count
    return placed, tuple(recordings)


def _fits(job: FileJob, file: DeliveredFile, quantisation: Quantisation) -> bool:
    """Whether a file's points can be moved to a lattice, as far as its header tells."""
    if job.quantisation == quantisation:
        return True
    corners = np.array([file.info.lowest, file.info.highest])
    if shift_between(job.quantisation, quantisation) is None or not np.isfinite(corners).all():
        return False
    moved = (corners - np.array(quantisation.offset)) / np.array(quantisation.scale)
    return bool(np.abs(moved).max() < _FAR)


def recordings_of(
    layout: ImportLayout, group: int, records: Mapping[int, FileRecord]
) -> tuple[Recording, ...]:
    """The recordings of a group that was read: as planned, or dealt from the files' parts."""
    numbers = layout.groups[group]
    if group in layout.planned:
        found = layout.planned[group]
        by_folder = {str(one.folder): one for one in found}
        for one in found:
            one.parts.clear()
        for number in numbers:
            position = layout.jobs[number].position
            if position is not None:
                streams = records[number].streams
                parts = [RecordingPart(number, at, stream) for at, stream in enumerate(streams)]
                by_folder[position.folder].parts += parts
        return tuple(one for one in found if one.count)
    recordings: list[Recording] = []
    for number in numbers:
        job = layout.jobs[number]
        for at, stream in enumerate(records[number].streams):
            taking = (one for one in recordings if one.takes(job.quantisation, stream))
            recording = next(taking, None)
            if recording is None:
                folder = part_folder(job, at)
                recording = Recording(folder, job.quantisation, stream.scanner, stream.names)
                recordings.append(recording)
            recording.parts.append(RecordingPart(number, at, stream))
    return tuple(recordings)

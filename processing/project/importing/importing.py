"""Importing: delivered files become drive folders; nothing in a delivered file is changed.

Where the points go is planned from headers and ends
(:mod:`processing.project.importing.import_layout`), the files are read to their places
(:mod:`processing.project.importing.import_processes`), and what is found in the points afterwards
is :mod:`processing.project.importing.drive_building`. What is done is noted, so an import that was
killed goes on where it was.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

from processing.core.disk_room import refuse_small_disk, report_full_disk
from processing.core.errors import (
    UNCHANGED,
    BadFile,
    Cancelled,
    Interrupted,
    InUse,
    UserError,
    report_as_user_error,
)
from processing.core.monitor import Monitor, PartMonitor
from processing.core.owned_files import (
    MARK,
    holds_only,
    is_link,
    is_marked,
    make_marked,
    mark,
    refuse_link,
    remove_folder,
)
from processing.core.text import Text
from processing.formats.points.delivered.delivered_waveforms import DeliveredWaveforms
from processing.formats.points.delivered.point_chunk import Vector3
from processing.formats.points.point_files import PointFileInfo
from processing.formats.trajectories.image_list import read_image_list
from processing.map.reference_system import other_system
from processing.project.importing.build_steps import BuildSteps
from processing.project.importing.delivery import Delivery, read_delivery
from processing.project.importing.drive_building import BuildPlan, build_drive
from processing.project.importing.file_record import FileRecord, record_from
from processing.project.importing.file_recorder import checksum_of
from processing.project.importing.import_journal import ImportJournal
from processing.project.importing.import_layout import (
    ImportLayout,
    ReadOptions,
    layout_of,
    recordings_of,
)
from processing.project.importing.import_processes import MixedFile, record_files
from processing.project.importing.import_request import (
    FileMark,
    ImportRequest,
    Labels,
    describe_request,
    marks_of,
)
from processing.project.importing.part_joining import join_parts
from processing.project.importing.recording import Recording
from processing.project.importing.trajectory_choice import NamedTrajectory, read_trajectories
from processing.project.importing.unfinished_imports import (
    is_import_folder,
    is_own_import,
    remove_import,
)
from processing.recording.camera_images.image_list import ImageList
from processing.recording.drive_info import SourceFile

__all__ = ["ImportRequest", "Labels", "import_drives"]

_READING = 0.7
_READING_FILE = Text("Reading {name}", "{name} を読み込み中")


def import_drives(
    request: ImportRequest,
    into: Path,
    monitor: Monitor,
    *,
    taken: Collection[str] = (),
    system: str = "",
) -> tuple[Path, ...]:
    """Turn delivered files into drive folders.

    Parameters
    ----------
    into : Path
        A folder for temporary drive folders, of this import alone;
        :meth:`processing.project.project.Project.adopt_drive` takes them from there. One by
        :func:`processing.project.importing.unfinished_imports.import_folder` keeps what is done
        when the program is killed or the disk is full; the same call goes on there.
    taken : collection of str
        Ids of drives that there are; a drive that would be called so gets a number.

    system : str
        ``EPSG:n`` of the project: files of another are refused before they are read.

    Returns
    -------
    tuple of Path
        One folder per scanner, whole; what is in them depends on the request alone.

    Raises
    ------
    UserError
        For a file that can't be read or doesn't fit; nothing is left.
    Cancelled
        Nothing is left behind, but for :class:`Interrupted`, which keeps all as a kill does.
    """
    marks = marks_of(request)
    delivery = read_delivery(request.inputs, request.crs, monitor, columns=request.columns)
    _refuse_other_system(request, delivery.crs, system)
    with report_as_user_error(into):
        _make_own(into)
    journal = ImportJournal(into, is_kept=is_import_folder(into))
    running = _Import(request, marks, delivery, journal, monitor)
    try:
        with report_full_disk(running.wanted_bytes, running.keep):
            if is_import_folder(into) and not journal.is_begun:
                _empty(into)
                journal.begin(describe_request(request, marks))
            folders = running.run(tuple(taken))
        journal.finish(folder.name for folder in folders)
    except (UserError, Cancelled, KeyboardInterrupt) as end:
        _end(running, journal, end)
        raise
    except BaseException:
        journal.close()
        if not is_import_folder(into):
            remove_import(into)
        raise
    journal.close()
    return folders


class _Import:
    """One import under way."""

    def __init__(
        self,
        request: ImportRequest,
        marks: tuple[FileMark, ...],
        delivery: Delivery,
        journal: ImportJournal,
        monitor: Monitor,
    ) -> None:
        self.is_kept = False
        self._request = request
        self._delivery = delivery
        self._journal = journal
        self._monitor = monitor
        self._into = journal.folder
        self._files = tuple(file.info for group in delivery.recordings for file in group)
        self._marks = {mark.path: mark for mark in marks}
        self._options = ReadOptions(
            keeps_angles=not request.trajectories,
            has_labels=any("label" in info.attributes for info in self._files),
            labels=request.labels,
        )
        self._layout = self._plan_import()
        self._records: dict[int, FileRecord] = {}

    def run(self, taken: tuple[str, ...]) -> tuple[Path, ...]:
        """Do what is still to be done; gives the drives' folders."""
        if not any(info.count for info in self._files):
            raise _no_points(self._files)
        images = _images_of(self._request.images)
        with ThreadPoolExecutor(max_workers=1) as pool:
            reading = pool.submit(read_trajectories, self._request.trajectories, self._delivery.crs)
            beside = pool.submit(_checksums, (*self._request.trajectories, *self._request.images))
            self._read_all(reading)
            trajectories, checksums = reading.result(), beside.result()
        dated = [
            (date, recording)
            for group, date in enumerate(self._delivery.dates)
            for recording in recordings_of(self._layout, group, self._records)
        ]
        dated.sort(key=lambda one: (one[0], one[1].scanner))
        recordings = [recording for _, recording in dated]
        plan = BuildPlan(
            self._sources(),
            self._delivery.crs,
            trajectories,
            images,
            _is_adjusted_standard(self._files),
            _shared_sources(recordings),
            _scanner_positions(self._files),
            identity=(*checksums, self._request.labels, self._request.crs, *self._request.columns),
            waveforms=_waveforms_of(self._files),
        )
        return self._build_all(recordings, plan, taken)

    def wanted_bytes(self) -> int:
        """What the columns still need on the disk, about."""
        whole = sum(info.count for info in self._files)
        done = sum(record.done for record in self._records.values())
        return self._layout.column_bytes * (whole - done) // max(whole, 1)

    def keep(self) -> bool:
        """Keep what is done: the disk is full or the program ends; says whether it can go on."""
        is_worth_it = self._journal.is_begun or any(one.done for one in self._records.values())
        self.is_kept = is_import_folder(self._into) and is_worth_it
        if self.is_kept:
            self._journal.save()
        return self.is_kept

    def _plan_import(self) -> ImportLayout:
        groups = range(len(self._delivery.recordings))
        mixed = [group for group in groups if self._journal.known(f"mixed {group}") is not None]
        return layout_of(self._delivery, self._marks, self._options, self._into, mixed)

    def _read_all(self, reading: Future[tuple[NamedTrajectory, ...]]) -> None:
        total = sum(info.count for info in self._files)
        monitor = PartMonitor(self._monitor, 0.0, _READING)

        def check() -> None:
            self._monitor.check()
            # A trajectory that can't be read stops the reading of points.
            if reading.done():
                reading.result()

        done: dict[int, int] = {}
        read = 0

        def reported(number: int, record: FileRecord) -> None:
            nonlocal read
            read += record.done - done[number]
            done[number] = record.done
            self._records[number] = record
            self._journal.note(f"file {number}", record.to_json(), self._folders_of(number))
            name = self._files[number].path.name
            monitor.report(read / total, _READING_FILE.filled(name=name))

        while True:
            self._recall()
            done |= {number: record.done for number, record in self._records.items()}
            read = sum(done.values())
            refuse_small_disk(self._into, self.wanted_bytes())
            work = [
                (self._layout.jobs[number], record)
                for number, record in self._records.items()
                if not record.is_whole
            ]
            try:
                record_files(work, reported, check)
            except MixedFile as surprise:
                group = self._layout.group_of(surprise.number)
                self._journal.note(f"mixed {group}", {})
                self._journal.settle()
                for recording in self._layout.planned[group]:
                    remove_folder(recording.folder, self._into)
                self._layout = self._plan_import()
            else:
                return

    def _recall(self) -> None:
        """The records as they were noted, new ones for what goes elsewhere now."""
        for group in range(len(self._layout.groups)):
            for recording in self._layout.planned.get(group, ()):
                with report_as_user_error(recording.folder):
                    recording.folder.mkdir(parents=True, exist_ok=True)
        for job in self._layout.jobs:
            noted = self._journal.known(f"file {job.number}")
            record = None if noted is None else record_from(noted)
            in_parts = job.position is None
            if record is None or record.in_parts != in_parts:
                record = FileRecord(in_parts)
            self._records[job.number] = record

    def _folders_of(self, number: int) -> tuple[Path, ...]:
        job = self._layout.jobs[number]
        if job.position is not None:
            return (Path(job.position.folder),)
        streams = range(len(self._records[number].streams))
        return tuple(Path(job.parts) / f"{number}-{at}" for at in streams)

    def _sources(self) -> tuple[SourceFile, ...]:
        return tuple(
            SourceFile(
                job.path,
                job.size,
                job.modified_ns,
                self._records[job.number].sha256,
                0,
                job.columns,
            )
            for job in self._layout.jobs
        )

    def _build_all(
        self, recordings: Sequence[Recording], plan: BuildPlan, taken: tuple[str, ...]
    ) -> tuple[Path, ...]:
        folders: list[Path] = []
        for number, recording in enumerate(recordings):
            share = (1 - _READING) / len(recordings)
            start = _READING + number * share
            part = PartMonitor(self._monitor, start, start + share)
            steps = BuildSteps(self._journal, number, recording.folder)
            names = (*taken, *(folder.name for folder in folders))
            if steps.final is None and len(recording.parts) > 1 and not self._is_planned(recording):
                join_parts(recording, self._layout, self._journal, PartMonitor(part, 0.0, 0.1))
            folders.append(build_drive(recording, plan, steps, part, taken=names))
        return tuple(folders)

    def _is_planned(self, recording: Recording) -> bool:
        return any(recording in planned for planned in self._layout.planned.values())


def _end(running: _Import, journal: ImportJournal, end: BaseException) -> None:
    """Keep what is done where the import can go on, or leave nothing."""
    if isinstance(end, Interrupted):
        running.keep()
    journal.close()
    if not running.is_kept:
        remove_import(journal.folder)


def _refuse_other_system(request: ImportRequest, crs: str, system: str) -> None:
    if system and crs and crs != system:
        raise other_system(", ".join(path.name for path in request.inputs), crs, system)


def _make_own(into: Path) -> None:
    """Have an import's folder, marked; what a killed one left there stays, others are refused."""
    refuse_link(into)
    if not into.exists():
        make_marked(into)
    elif holds_only(into, _no) or (is_own_import(into) and not is_marked(into)):
        mark(into)
    elif is_import_folder(into) and not is_own_import(into):
        raise InUse(
            Text("There is something else in this place.", "この場所には別のものがあります。"),
            Text.same(str(into)),
            Text(
                "Move it away, then import again.",
                "それを移動してから、もう一度インポートしてください。",
            ),
        )


def _no(_: str) -> bool:
    return False


def _empty(folder: Path) -> None:
    """Remove what a killed import left that had noted nothing."""
    with report_as_user_error(folder):
        for path in folder.iterdir():
            if path.is_dir() and not is_link(path):
                remove_folder(path)
            elif path.name != MARK:
                path.unlink()


def _no_points(files: tuple[PointFileInfo, ...]) -> UserError:
    return BadFile(
        Text("There are no points in it.", "点が含まれていません。"),
        Text.same(", ".join(str(info.path) for info in files)),
        Text(
            "Choose a file with points. {unchanged}",
            "点のあるファイルを選んでください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def _checksums(paths: tuple[Path, ...]) -> tuple[str, ...]:
    return tuple(checksum_of(path) for path in paths)


def _images_of(lists: tuple[Path, ...]) -> ImageList | None:
    images = [image for path in lists for image in read_image_list(path)]
    return ImageList(tuple(images)) if images else None


def _is_adjusted_standard(files: tuple[PointFileInfo, ...]) -> bool | None:
    """What the files say of their clock, where they agree."""
    said = {info.is_adjusted_standard for info in files}
    return said.pop() if len(said) == 1 else None


def _waveforms_of(files: tuple[PointFileInfo, ...]) -> dict[int, DeliveredWaveforms]:
    """By number of the file, of those whose points name packets."""
    named = {number: info.waveforms for number, info in enumerate(files)}
    return {number: one for number, one in named.items() if one is not None}


def _shared_sources(recordings: Sequence[Recording]) -> frozenset[int]:
    uses = Counter(source for recording in recordings for source in recording.sources)
    return frozenset(source for source, count in uses.items() if count > 1)


def _scanner_positions(files: tuple[PointFileInfo, ...]) -> dict[tuple[int, int], Vector3]:
    """By file and scanner number, which is 0 where a file has one scan."""
    return {
        (source, scan if len(info.scanner_positions) > 1 else 0): position
        for source, info in enumerate(files)
        for scan, position in info.scanner_positions
    }

"""Completing a drive that is in a project already: its rows are found anew, with a trajectory.

The points come from the drive's own columns, so the delivered files need not be there. They are
built as an import builds them, in a folder beside; what was labelled and found on them is carried
over to it, and the project takes the folder in place of the old one.
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import refuse_damaged
from processing.core.disk_room import refuse_small_disk
from processing.core.errors import UNCHANGED, OutOfRange, report_as_user_error
from processing.core.monitor import Monitor, PartMonitor
from processing.core.owned_files import remove_folder
from processing.core.text import Text
from processing.project.importing.build_steps import BuildSteps
from processing.project.importing.carried_results import carry_results, results_mark
from processing.project.importing.drive_building import SOURCES, BuildPlan, build_drive
from processing.project.importing.file_record import PointRun, Stream
from processing.project.importing.import_journal import ImportJournal
from processing.project.importing.import_layout import bytes_of
from processing.project.importing.recording import Recording, RecordingPart
from processing.project.importing.trajectory_choice import NamedTrajectory
from processing.recording.camera_images.image_store import write_images
from processing.recording.columns.columns import column_path
from processing.recording.columns.ordering import chunk_ranges, read_chunk, sort_points
from processing.recording.columns.quantisation import Quantisation
from processing.recording.columns.source_order import FILE, INDEX
from processing.recording.drive import Drive
from processing.recording.drive_files import sum_drive
from processing.recording.drive_info import read_drive_info, write_drive_info
from processing.recording.waveform_packets.descriptors import PACKET, WAVE_COLUMNS
from processing.recording.waveform_packets.kept_packets import link_packets
from processing.recording.waveform_packets.pulse_index import make_pulse_index

POSITION = "place_before"
_DELIVERED = (
    "xyz", "time", "intensity", "return_number", "number_of_returns", "classification",
    FILE, INDEX, "color", *WAVE_COLUMNS,
)  # fmt: skip
_SOURCE_BITS = 40
_COPYING = Text("Copying {name}", "{name} をコピー中")
_CARRYING = Text("Taking over labels and results", "ラベルと処理結果を引き継ぎ中")


@dataclass(frozen=True)
class CompletedDrive:
    """A drive that was completed, in a temporary folder.

    Attributes
    ----------
    places_before : Path or None
        Where each point was before, int64; None where all are where they were.
    mark : tuple
        Of the labels and results that were carried over, by :func:`results_mark`.
    """

    id: str
    name: str
    count: int
    folder: Path
    places_before: Path | None
    mark: tuple[tuple[str, int, int], ...]

    def fits(self, drive: Drive) -> bool:
        """Whether what was carried over is what the drive has now."""
        return self.mark == results_mark(drive)

    def remove_rest(self) -> None:
        """Remove what is left where it was made, once its folder is taken over."""
        remove_folder(self.folder.parent)

    def positions(self) -> NDArray[np.int64] | None:
        """(n,) int64 on the disk: where each point is now; None where all are where they were.

        Raises
        ------
        NoSpace, MissingInput
        """
        if self.places_before is None:
            return None
        path = self.places_before.with_suffix(".now")
        with report_as_user_error(path):
            now = np.lib.format.open_memmap(path, "w+", np.int64, (self.count,))
            for start, stop in chunk_ranges(self.count):
                before = _read_positions(self.places_before, start, stop)
                now[before] = np.arange(start, stop)
        return now


def complete_drive(
    drive: Drive, trajectories: tuple[NamedTrajectory, ...], into: Path, monitor: Monitor
) -> CompletedDrive:
    """Build a drive anew with a trajectory; the drive itself stays as it is.

    Parameters
    ----------
    trajectories : tuple of NamedTrajectory
        The one that covers it is taken.
    into : Path
        A new temporary folder.

    Raises
    ------
    OutOfRange
        None of them covers it.
    NoSpace, Cancelled, UserError
        Nothing is left.
    """
    try:
        return _complete_drive_folder(drive, trajectories, into, monitor)
    except BaseException:
        remove_folder(into)
        raise


def carry_results_again(
    completed: CompletedDrive, drive: Drive, monitor: Monitor
) -> CompletedDrive:
    """The same with the labels and results that the drive has now.

    Raises
    ------
    NoSpace, Cancelled
    """
    mark = results_mark(drive)
    carry_results(drive, completed.folder, completed.places_before, monitor)
    sum_drive(completed.folder, monitor.check)
    return replace(completed, mark=mark)


def drive_changed(name: str) -> OutOfRange:
    """What was being done was about a drive that is another now, or gone."""
    return OutOfRange(
        Text(
            "The drive was changed or removed meanwhile.",
            "処理中に走行データが変更または削除されました。",
        ),
        Text.same(name),
        Text("Start it again. {unchanged}", "もう一度実行してください。{unchanged}").filled(
            unchanged=UNCHANGED
        ),
    )


def _complete_drive_folder(
    drive: Drive, trajectories: tuple[NamedTrajectory, ...], into: Path, monitor: Monitor
) -> CompletedDrive:
    folder, names = into / "0", tuple(name for name in _DELIVERED if drive.columns.has(name))
    room = 3 * drive.count * bytes_of((*names, POSITION))
    refuse_small_disk(drive.folder, room)
    with report_as_user_error(folder):
        folder.mkdir(parents=True)
    monitor.report(0.0, _COPYING.filled(name=drive.info.name))
    _copy(drive, folder, names, monitor)
    if drive.revolutions is None and FILE in names:
        # The top view has its points by cells: at first they go where they were delivered.
        part = PartMonitor(monitor, 0.1, 0.3)
        sort_points(folder, (*names, POSITION), drive.count, _by_source, part)
    journal = ImportJournal(into, is_kept=False)
    try:
        steps = BuildSteps(journal, 0, folder)
        if FILE in names:
            steps.note(SOURCES, {})
        plan = BuildPlan(drive.info.sources, drive.info.crs, trajectories, None)
        recording = _recording_of(drive, folder, names)
        built = build_drive(recording, plan, steps, PartMonitor(monitor, 0.3, 0.9))
    finally:
        journal.close()
    _name_as(drive, built)
    link_packets(drive.folder, built)
    if PACKET in names:
        make_pulse_index(built, drive.count, monitor)
    positions = _positions_of(built, into, drive.count)
    monitor.report(0.9, _CARRYING)
    mark = results_mark(drive)
    carry_results(drive, built, positions, PartMonitor(monitor, 0.9, 1.0))
    if drive.noted_images is not None:
        write_images(built, drive.noted_images)
    sum_drive(built, monitor.check)
    return CompletedDrive(drive.id, drive.info.name, drive.count, built, positions, mark)


def _copy(drive: Drive, folder: Path, names: tuple[str, ...], monitor: Monitor) -> None:
    for name in names:
        monitor.check()
        refuse_damaged(column_path(drive.folder, name))
        with report_as_user_error(folder):
            shutil.copyfile(column_path(drive.folder, name), column_path(folder, name))
    with report_as_user_error(folder), column_path(folder, POSITION).open("wb") as file:
        for start, stop in chunk_ranges(drive.count):
            file.write(np.arange(start, stop, dtype="<i8").data)


def _by_source(columns: Mapping[str, NDArray[Any]]) -> tuple[NDArray[Any], NDArray[Any]]:
    # A file has fewer than 2^40 points; as one key it is sampled and parted like a time.
    delivered = (columns[FILE].astype(np.int64) << _SOURCE_BITS) | columns[INDEX]
    return delivered, np.zeros(delivered.size, np.int8)


def _recording_of(drive: Drive, folder: Path, names: tuple[str, ...]) -> Recording:
    """The drive's points as an import has them when they were read."""
    info = drive.info
    quantisation = Quantisation(info.scale, info.offset)
    low, high = (quantisation.rounded(np.array(one)) for one in (info.lowest, info.highest))
    has_times, is_in_order = _times_of(folder, drive.count)
    own = tuple(name for name in (*names, POSITION) if name not in (FILE, INDEX))
    parts, first = [], 0
    for source, count, runs in _parts_of(drive):
        stream = Stream(
            info.scanner,
            own,
            count,
            _integers(low),
            _integers(high),
            float(read_chunk(folder, "time", first, first + 1)[0]),
            float(read_chunk(folder, "time", first + count - 1, first + count)[0]),
            has_times,
            is_in_order,
            runs,
        )
        parts.append(RecordingPart(source, 0, stream))
        first += count
    return Recording(folder, quantisation, info.scanner, own, parts)


def _parts_of(drive: Drive) -> list[tuple[int, int, list[PointRun]]]:
    """Source, points and runs of the stretches that come from one file each."""
    runs = drive.info.source_runs
    if not runs:
        return [(0, drive.count, [])]
    parts = []
    for source, of_source in groupby(runs, key=lambda run: run.source):
        mine = list(of_source)
        first = mine[0].start
        own: list[PointRun] = [(run.start - first, run.count, run.first_index) for run in mine]
        parts.append((source, sum(run.count for run in mine), own))
    return parts


def _integers(values: NDArray[np.float64]) -> tuple[int, int, int]:
    return int(values[0]), int(values[1]), int(values[2])


def _times_of(folder: Path, count: int) -> tuple[bool, bool]:
    """Whether every point has a time, and whether times never go back."""
    has_times, is_in_order, last = True, True, -np.inf
    for start, stop in chunk_ranges(count):
        times = read_chunk(folder, "time", start, stop)
        has_times &= bool(np.isfinite(times).all())
        is_in_order &= bool(times[0] >= last and (np.diff(times) >= 0).all())
        last = times[-1]
    return has_times, has_times and is_in_order


def _name_as(drive: Drive, built: Path) -> None:
    """It is the same drive: only what was found in its points is other."""
    before, found = drive.info, read_drive_info(built)
    info = replace(
        found,
        id=before.id,
        name=before.name,
        sources=before.sources,
        lowest=before.lowest,
        highest=before.highest,
        clock_offset_s=before.clock_offset_s + found.clock_offset_s,
    )
    write_drive_info(built, info)


def _positions_of(built: Path, into: Path, count: int) -> Path | None:
    """Where points were before, as a file; None where the order is the same."""
    path = into / f"{POSITION}.bin"
    with report_as_user_error(path):
        column_path(built, POSITION).replace(path)
    for start, stop in chunk_ranges(count):
        if (_read_positions(path, start, stop) != np.arange(start, stop)).any():
            return path
    return None


def _read_positions(path: Path, start: int, stop: int) -> NDArray[np.int64]:
    with report_as_user_error(path):
        return np.fromfile(path, "<i8", stop - start, offset=start * 8).astype(np.int64)

"""What is found in a recording after it was read: order, clock, trajectory, rows and pulses."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass, field, replace
from itertools import chain
from itertools import count as count_from
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.disk_room import refuse_small_disk
from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Text
from processing.formats.points.delivered.delivered_waveforms import DeliveredWaveforms
from processing.image.images_of_drives import image_of
from processing.project.importing.build_steps import CLOCK, NAMED, SHIFTED, BuildSteps
from processing.project.importing.import_journal import JournalEntries
from processing.project.importing.import_layout import bytes_of
from processing.project.importing.import_request import digest_of
from processing.project.importing.recording import Recording
from processing.project.importing.trajectory_choice import NamedTrajectory, match_trajectory
from processing.project.importing.waveform_keeping import keep_waveforms
from processing.recording.camera_images.image_list import ImageList
from processing.recording.camera_images.image_store import write_images
from processing.recording.columns.columns import Columns, ColumnWriter
from processing.recording.columns.ordering import (
    POINTS_AT_ONCE,
    SortKeys,
    chunk_ranges,
    read_chunk,
    sample_column,
    sort_points,
)
from processing.recording.columns.replacing import new_columns, replace_columns
from processing.recording.drive import SCAN, Drive, write_trajectory
from processing.recording.drive_files import sum_drive
from processing.recording.drive_info import BY_ORDER, DriveInfo, SourceFile, write_drive_info
from processing.recording.measurement_order.rows_by_order import NoOrder, find_rows_by_order
from processing.recording.revolutions.revolutions import (
    NoRevolutions,
    RecordedPoints,
    find_revolutions,
    trajectory_from_origins,
)
from processing.recording.revolutions.revolutions_file import write_revolutions
from processing.recording.vehicle_path.trajectory import Trajectory
from processing.recording.waveform_packets.descriptors import DIRECTION
from processing.recording.waveform_packets.ray_signs import is_from_air
from processing.recording.without_revolutions.scan_grid import (
    COLUMN,
    ScanGrid,
    order_by_grid,
    remove_grid_column,
)
from processing.recording.without_revolutions.scanner_position import (
    ScannerPosition,
    check_scanner_position,
)
from processing.recording.without_revolutions.top_view import TopView, top_view_of

_SAMPLE_POINTS = 200_000
SOURCES, _SORTED, _ROWS, _SORTED_BY_CELL = "sources", "sorted", "rows", "sorted by cell"
_ORDERED = "rows by order"
_FINDING = Text("Finding revolutions and pulses of {name}", "{name} の回転とパルスを推定中")
_SORTING = Text("Restoring the time order of {name}", "{name} の時刻順を復元中")
_LEAST_FILLED = 0.02
_NEARLY_EMPTY = Text(
    "The points would fill less than one pixel in fifty of rows, as a piece that was cut out or a "
    "narrow strip from the air does; the top view is shown.",
    "切り出した点群や航空計測などで、行の画像では画素の50分の1も埋まらないため、上面画像で表示します。",
)
_FROM_AIR = Text(
    "The rays of its waveforms come down from the air: a flight is shown from above.",
    "波形の照射方向から航空計測と判断したため、上面画像で表示します。",
)
_GRID = Text("Reading the grid of the scan {name}", "{name} のスキャン格子を確認中")
_CELLS = Text("Ordering {name} for the top view", "{name} を上面画像用に並べ替え中")


@dataclass(frozen=True)
class BuildPlan:
    """What all recordings of an import have in common.

    Attributes
    ----------
    is_adjusted_standard : bool or None
        What the files say of their clock; None when they don't.
    images : ImageList or None
        Camera images, noted in each drive.
    shared_sources : frozenset of int
        Files that hold the points of several recordings.
    scanner_positions : mapping
        By file and scanner: where a standing scanner was, m, as the file says.
    identity : tuple of str
        What else of the request makes its drives what they are.
    waveforms : mapping of int to DeliveredWaveforms
        By number of the file, for those that have some.
    """

    sources: tuple[SourceFile, ...]
    crs: str
    trajectories: tuple[NamedTrajectory, ...]
    images: ImageList | None
    is_adjusted_standard: bool | None = None
    shared_sources: frozenset[int] = frozenset()
    scanner_positions: Mapping[tuple[int, int], ScannerPosition] = field(default_factory=dict)
    identity: tuple[str, ...] = ()
    waveforms: Mapping[int, DeliveredWaveforms] = field(default_factory=dict)


def build_drive(
    recording: Recording,
    plan: BuildPlan,
    steps: BuildSteps,
    monitor: Monitor,
    *,
    taken: Collection[str] = (),
) -> Path:
    """Complete the folder of a recording that was read; goes on where a killed import stopped.

    Steps
    -----
    1. Points go into time order if the files lost it.
    2. The trajectory is chosen and the points' clock set to its; origins per point make their own.
    3. A standing scanner's grid is taken as it is, else revolutions and pulses are found, by times
       or by the order of the points; where there are none, points are ordered for the top view.
    4. Packets of waveforms are taken over, and the facts are written.

    Each step may be begun again; what can't be done to its own result is noted.

    Parameters
    ----------
    taken : collection of str
        Ids that other drives have.

    Returns
    -------
    Path
        The folder; its name is the drive's id.

    Raises
    ------
    UserError, Cancelled
    """
    if steps.final is not None:
        return steps.final
    steps.go_on()
    name = _name_of(recording, plan)
    recording.has_source_columns = steps.known(SOURCES) is not None
    if recording.needs_source_columns:
        _names_to_sort(recording, steps)
    if (rows_known := steps.known(_ROWS)) is None:
        if recording.has_times and not recording.is_in_time_order:
            _restore_time_order(recording, steps, name, PartMonitor(monitor, 0.0, 0.4))
        trajectory, offset = _trajectory_of(recording, plan, steps, name)
        if trajectory is not None:
            write_trajectory(recording.folder, trajectory)
        monitor.report(0.4, _FINDING.filled(name=name))
        finding = PartMonitor(monitor, 0.4, 1.0)
        found = _rows_of(recording, trajectory, steps, name, finding)
        found = replace(found, offset_s=offset, position=_scanner_position(recording, plan, found))
        steps.note(_ROWS, asdict(found))
    else:
        found = _found_from(rows_known)
    if found.view is not None:
        monitor.report(0.7, _CELLS.filled(name=name))
        _order_for_top_view(recording, found.view, steps, PartMonitor(monitor, 0.7, 1.0))
    remove_grid_column(recording.folder)
    keep_waveforms(recording, plan.waveforms, name, monitor)
    return _finish_folder(recording, plan, found, steps, taken=taken, monitor=monitor)


def _finish_folder(
    recording: Recording,
    plan: BuildPlan,
    found: _FoundRows,
    steps: BuildSteps,
    *,
    taken: Collection[str],
    monitor: Monitor,
) -> Path:
    """Write the facts down and give the folder its name."""
    folder = recording.folder
    if plan.images is not None:
        write_images(folder, plan.images)
    scale, shift = np.array(recording.quantisation.scale), np.array(recording.quantisation.offset)
    points = recording.points_of_source
    name = _name_of(recording, plan)
    info = DriveInfo(
        id=_free_id(f"{_plain(name)}-{_identity(recording, plan)}", taken),
        name=name,
        scanner=recording.scanner,
        count=recording.count,
        scale=recording.quantisation.scale,
        offset=recording.quantisation.offset,
        lowest=_triple(recording.lowest * scale + shift),
        highest=_triple(recording.highest * scale + shift),
        crs=plan.crs,
        sources=tuple(replace(plan.sources[one], points=points[one]) for one in recording.sources),
        clock_offset_s=found.offset_s,
        rows_by=found.rows_by,
        rows_reason=found.reason,
        cell_m=found.view.cell_m if found.view is not None else 0.0,
        cells_per_row=found.cells_per_row,
        source_runs=recording.source_runs,
        scanner_position=found.position,
    )
    write_drive_info(folder, info)
    _find_rows_of_first_image(folder)
    sum_drive(folder, monitor.check)
    steps.note(NAMED, {"id": info.id})
    final = steps.home / info.id
    with report_as_user_error(final):
        folder.rename(final)
    return final


def _find_rows_of_first_image(folder: Path) -> None:
    """Keep where the rows of the image begin that is shown first, so that it opens at once."""
    with report_as_user_error(folder):
        for unfinished in folder.glob("image_rows_*.part"):
            unfinished.unlink()
    drive = Drive(folder)
    image_of(drive, drive.image_kinds[0])


def _identity(recording: Recording, plan: BuildPlan) -> str:
    """Eight letters by which a drive is known: the same whenever the same is imported."""
    parts = [(plan.sources[part.source].sha256, part.at) for part in recording.parts]
    facts = [
        parts,
        recording.scanner,
        recording.count,
        asdict(recording.quantisation),
        *plan.identity,
    ]
    return digest_of(facts)[:8]


def _free_id(wanted: str, taken: Collection[str]) -> str:
    """The id, with a number where there is a drive of that id."""
    numbered = (f"{wanted}-{number}" for number in count_from(2))
    return next(one for one in chain((wanted,), numbered) if one not in taken)


def _name_of(recording: Recording, plan: BuildPlan) -> str:
    """The file's name; with the scanner's number where the files tell several scanners apart."""
    sources = recording.sources
    stem = Path(plan.sources[sources[0]].path).stem
    stem = stem.encode("utf-8", "replace").decode()  # a file's name may be no text
    is_shared = any(source in plan.shared_sources for source in sources)
    return f"{stem} ({recording.scanner})" if is_shared else stem


def _plain(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9]+", "-", name).strip("-").lower()[:40] or "drive"


def _triple(values: NDArray[np.float64]) -> tuple[float, float, float]:
    return float(values[0]), float(values[1]), float(values[2])


def _by_time(columns: Mapping[str, NDArray[Any]]) -> tuple[NDArray[Any], NDArray[Any]]:
    return columns["time"], np.zeros(columns["time"].size, dtype=np.int8)


def _by_pulse(columns: Mapping[str, NDArray[Any]]) -> tuple[NDArray[Any], NDArray[Any]]:
    return columns["pulse"], np.zeros(columns["pulse"].size, dtype=np.int8)


def _restore_time_order(
    recording: Recording, steps: BuildSteps, name: str, monitor: Monitor
) -> None:
    if steps.known(_SORTED) is not None:
        return
    monitor.report(0.0, _SORTING.filled(name=name))
    _sort(recording, steps, _by_time, monitor)
    steps.note(_SORTED, {})


def _sort(recording: Recording, steps: BuildSteps, keys: SortKeys, monitor: Monitor) -> None:
    names = _names_to_sort(recording, steps)
    if keys is _by_pulse:
        names = (*names, "pulse")
    room = 2 * recording.count * bytes_of(names)
    refuse_small_disk(recording.folder, room)
    sort_points(recording.folder, names, recording.count, keys, monitor)


def _names_to_sort(recording: Recording, steps: BuildSteps) -> tuple[str, ...]:
    """All columns; those that say where points were delivered are among them."""
    if not recording.has_source_columns:
        recording.write_source_columns()
        steps.note(SOURCES, {})
    return recording.names


def _trajectory_of(
    recording: Recording, plan: BuildPlan, steps: BuildSteps, name: str
) -> tuple[Trajectory | None, float]:
    if not recording.has_times:
        return None, 0.0
    if "origin" in recording.names:
        return trajectory_from_origins(Columns(recording.folder, recording.count)), 0.0
    clock = steps.known(CLOCK)
    if clock is None:
        matched = match_trajectory(
            _sampled_times(recording.folder, recording.count),
            plan.trajectories,
            name,
            is_adjusted_standard=plan.is_adjusted_standard,
        )
        if matched is None:
            return None, 0.0
        known = [named.trajectory for named in plan.trajectories]
        at = next(at for at, one in enumerate(known) if one is matched.trajectory)
        clock = {"trajectory": at, "offset_s": matched.clock_offset_s}
        steps.note(CLOCK, clock)
    offset = float(clock["offset_s"])
    if offset != 0.0 and steps.known(SHIFTED) is None:
        _shift_times(recording, steps, offset)
    return plan.trajectories[int(clock["trajectory"])].trajectory, offset


def _sampled_times(folder: Path, count: int) -> NDArray[np.float64]:
    times = sample_column(folder, "time", count, max(1, count // _SAMPLE_POINTS))
    return np.append(times, read_chunk(folder, "time", count - 1, count))


def _shift_times(recording: Recording, steps: BuildSteps, offset_s: float) -> None:
    folder = recording.folder
    with ColumnWriter(new_columns(folder)) as writer:
        for start, stop in chunk_ranges(recording.count):
            writer.append({"time": read_chunk(folder, "time", start, stop) + offset_s})
    replace_columns(folder, steps.note_shifted, is_flushed=steps.is_on_disk)


@dataclass(frozen=True)
class _FoundRows:
    """What `DriveInfo` says of rows and clock."""

    reason: Text
    rows_by: str
    cells_per_row: int = 0
    view: TopView | None = None
    offset_s: float = 0.0
    position: ScannerPosition | None = None


def _found_from(values: JournalEntries) -> _FoundRows:
    """What was found, as it was noted."""
    view, position = values["view"], values["position"]
    read = {
        "reason": Text(**values["reason"]),
        "view": None if view is None else TopView(**view),
        "position": None if position is None else tuple(position),
    }
    return _FoundRows(**{**values, **read})


def _rows_of(
    recording: Recording,
    trajectory: Trajectory | None,
    steps: BuildSteps,
    name: str,
    monitor: Monitor,
) -> _FoundRows:
    folder, count = recording.folder, recording.count
    if DIRECTION in recording.names and is_from_air(
        sample_column(folder, DIRECTION, count, max(1, count // _SAMPLE_POINTS))
    ):
        view = _top_view_of(recording)
        return _FoundRows(_FROM_AIR, "top-view", view.cells_per_row, view)
    contradiction: Text | None = None
    if COLUMN in recording.names and trajectory is None:
        monitor.report(0.0, _GRID.filled(name=name))
        grid = order_by_grid(folder, count, lambda: _names_to_sort(recording, steps), monitor)
        if isinstance(grid, ScanGrid):
            return _FoundRows(grid.reported, SCAN, cells_per_row=grid.sweep_length)
        contradiction = grid.reason
    points = RecordedPoints(
        folder, count, recording.quantisation.scale, recording.quantisation.offset
    )
    if recording.times_differ:
        found = find_revolutions(points, trajectory, monitor)
        if isinstance(found, NoRevolutions):
            reason = found.reason
        elif trajectory is None and count < _LEAST_FILLED * int(np.ptp(found.fold_pulses)):
            reason = _NEARLY_EMPTY
        else:
            write_revolutions(folder, found)
            return _FoundRows(Text("", ""), found.method)
    else:
        ordered = _rows_by_order(recording, points, steps, monitor)
        if ordered.rows_by == BY_ORDER:
            return ordered
        reason = ordered.reason
    view = _top_view_of(recording)
    return _FoundRows(contradiction or reason, "top-view", view.cells_per_row, view)


def _rows_by_order(
    recording: Recording, points: RecordedPoints, steps: BuildSteps, monitor: Monitor
) -> _FoundRows:
    """Rows from the order of the points; with the reason for a top view where it tells none."""
    known = steps.known(_ORDERED)
    if known is None:
        found = find_rows_by_order(points, PartMonitor(monitor, 0.0, 0.8))
        if isinstance(found, NoOrder):
            return _FoundRows(found.reason, "top-view")
        with ColumnWriter(recording.folder) as columns:
            for start, stop in chunk_ranges(recording.count):
                pulses = found.pulses[start:stop]
                columns.append({"pulse": pulses, "time": found.times_of(pulses)})
        write_trajectory(recording.folder, found.trajectory)
        write_revolutions(recording.folder, found.revolutions)
        is_in_order = bool((np.diff(found.pulses) >= 0).all())
        known = {"reason": asdict(found.reported), "is_in_order": is_in_order}
        steps.note(_ORDERED, known)
    if not known["is_in_order"]:
        _sort(recording, steps, _by_pulse, PartMonitor(monitor, 0.8, 1.0))
    return _FoundRows(Text(**known["reason"]), BY_ORDER)


def _scanner_position(
    recording: Recording, plan: BuildPlan, found: _FoundRows
) -> ScannerPosition | None:
    if found.rows_by != SCAN or len(recording.sources) != 1:
        return None
    source = recording.sources[0]
    return check_scanner_position(
        Columns(recording.folder, recording.count),
        recording.quantisation,
        found.cells_per_row,
        plan.scanner_positions.get((source, recording.scanner)),
    )


def _top_view_of(recording: Recording) -> TopView:
    count, metres = recording.count, recording.quantisation.metres
    integers = sample_column(recording.folder, "xyz", count, max(1, count // _SAMPLE_POINTS))
    lowest, highest = metres(recording.lowest), metres(recording.highest)
    return top_view_of(metres(integers), count, lowest, highest)


def _order_for_top_view(
    recording: Recording, view: TopView, steps: BuildSteps, monitor: Monitor
) -> None:
    metres = recording.quantisation.metres

    def by_cell(columns: Mapping[str, NDArray[Any]]) -> tuple[NDArray[Any], NDArray[Any]]:
        integers = columns["xyz"]
        return view.cells_of(metres(integers)), -integers[:, 2].astype(np.int64)

    if steps.known(_SORTED_BY_CELL) is None:
        _sort(recording, steps, by_cell, PartMonitor(monitor, 0.0, 0.8))
        steps.note(_SORTED_BY_CELL, {})
    with ColumnWriter(recording.folder) as cells:
        for start, stop in chunk_ranges(recording.count, POINTS_AT_ONCE // 4):
            monitor.check()
            integers = read_chunk(recording.folder, "xyz", start, stop)
            cells.append({"pulse": view.cells_of(metres(integers))})

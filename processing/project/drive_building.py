"""What is found in a recording after it was read: order, clock, trajectory, rows and pulses."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from processing.cameras.image_list import ImageList
from processing.cameras.image_store import write_images
from processing.errors import told_as_user_error
from processing.monitor import Monitor, PartMonitor
from processing.points.columns import Columns, ColumnWriter, column_path
from processing.points.drive import SCAN, write_trajectory
from processing.points.drive_info import DriveInfo, SourceFile, write_drive_info
from processing.points.ordering import POINTS_AT_ONCE, read_stretch, sort_points, stretches
from processing.points.scan_grid import COLUMN, ScanGrid, order_by_grid, remove_grid_column
from processing.points.scan_place import Place, checked_place
from processing.points.top_view import TopView, top_view_of
from processing.points.trajectory import Trajectory
from processing.points.turns import NoTurns, RecordedPoints, find_turns, trajectory_from_origins
from processing.points.turns_file import write_turns
from processing.project.recording_writer import RecordingWriter
from processing.project.trajectory_choice import NamedTrajectory, match_trajectory
from processing.text import Text

_SAMPLE_POINTS = 200_000
_FINDING = Text("Finding turns and pulses of {name}", "{name} の回転とパルスを推定中")
_SORTING = Text("Restoring the time order of {name}", "{name} の時刻順を復元中")
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
    scanner_places : mapping
        By file and scanner: where a standing scanner was, m, as the file says.
    """

    sources: tuple[SourceFile, ...]
    crs: str
    trajectories: tuple[NamedTrajectory, ...]
    images: ImageList | None
    is_adjusted_standard: bool | None = None
    shared_sources: frozenset[int] = frozenset()
    scanner_places: Mapping[tuple[int, int], Place] = field(default_factory=dict)


def build_drive(writer: RecordingWriter, plan: BuildPlan, monitor: Monitor) -> Path:
    """Complete the folder of a recording that was read.

    Steps
    -----
    1. Points go into time order if the files lost it.
    2. The trajectory is chosen and the points' clock set to its; origins per point make their own.
    3. A standing scanner's grid is taken as it is, else turns and pulses are found; where there
       are neither, points are ordered for the top view.
    4. The facts are written.

    Returns
    -------
    Path
        The folder; its name is the drive's id.

    Raises
    ------
    UserError, Cancelled
    """
    name = _name_of(writer, plan)
    folder = writer.folder
    if writer.has_times and not writer.is_in_time_order:
        monitor.report(0.0, _SORTING.filled(name=name))
        writer.write_source_columns()
        sort_points(folder, writer.names, writer.count, _by_time, PartMonitor(monitor, 0.0, 0.4))
    trajectory, offset = _trajectory_of(writer, plan, name)
    monitor.report(0.4, _FINDING.filled(name=name))
    finding = PartMonitor(monitor, 0.4, 1.0)
    found = _rows_of(writer, trajectory, name, finding)
    if trajectory is not None:
        write_trajectory(folder, trajectory)
    if plan.images is not None:
        write_images(folder, plan.images)
    scale, shift = np.array(writer.lattice.scale), np.array(writer.lattice.offset)
    info = DriveInfo(
        id=f"{_plain(name)}-{uuid4().hex[:8]}",
        name=name,
        scanner=writer.scanner,
        count=writer.count,
        scale=writer.lattice.scale,
        offset=writer.lattice.offset,
        lowest=_triple(writer.lowest * scale + shift),
        highest=_triple(writer.highest * scale + shift),
        crs=plan.crs,
        sources=tuple(
            SourceFile(s.path, s.size, s.modified_ns, s.sha256, writer.points_of_source.get(i, 0))
            for i, s in enumerate(plan.sources)
        ),
        clock_offset_s=offset,
        rows_by=found.rows_by,
        rows_reason=found.reason,
        cell_m=found.cell_m,
        cells_per_row=found.cells_per_row,
        source_runs=writer.sources.runs,
        scanner_place=_scanner_place(writer, plan, found),
    )
    remove_grid_column(folder)
    write_drive_info(folder, info)
    final = folder.with_name(info.id)
    with told_as_user_error(final):
        folder.rename(final)
    return final


def _name_of(writer: RecordingWriter, plan: BuildPlan) -> str:
    """The file's name; with the scanner's number where the files tell several scanners apart."""
    sources = sorted(writer.points_of_source)
    stem = Path(plan.sources[sources[0]].path).stem
    is_shared = any(source in plan.shared_sources for source in sources)
    return f"{stem} ({writer.scanner})" if is_shared else stem


def _plain(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9]+", "-", name).strip("-").lower()[:40] or "drive"


def _triple(values: NDArray[np.float64]) -> tuple[float, float, float]:
    return float(values[0]), float(values[1]), float(values[2])


def _by_time(columns: Mapping[str, NDArray[Any]]) -> tuple[NDArray[Any], NDArray[Any]]:
    return columns["time"], np.zeros(columns["time"].size, dtype=np.int8)


def _trajectory_of(
    writer: RecordingWriter, plan: BuildPlan, name: str
) -> tuple[Trajectory | None, float]:
    if not writer.has_times:
        return None, 0.0
    if "origin" in writer.names:
        return trajectory_from_origins(Columns(writer.folder, writer.count)), 0.0
    matched = match_trajectory(
        _sampled_times(writer.folder, writer.count),
        plan.trajectories,
        name,
        is_adjusted_standard=plan.is_adjusted_standard,
    )
    if matched is None:
        return None, 0.0
    if matched.clock_offset_s != 0.0:
        _shift_times(writer.folder, writer.count, matched.clock_offset_s)
    return matched.trajectory, matched.clock_offset_s


def _sampled_times(folder: Path, count: int) -> NDArray[np.float64]:
    times: NDArray[np.float64] = Columns(folder, count)["time"]
    step = max(1, count // _SAMPLE_POINTS)
    return np.append(times[::step], times[-1])


def _shift_times(folder: Path, count: int, offset_s: float) -> None:
    shifted = folder / "shifted"
    with told_as_user_error(folder):
        shifted.mkdir()
    with ColumnWriter(shifted) as writer:
        for start, stop in stretches(count):
            writer.append({"time": read_stretch(folder, "time", start, stop) + offset_s})
    with told_as_user_error(folder):
        column_path(shifted, "time").replace(column_path(folder, "time"))
        shifted.rmdir()


@dataclass(frozen=True)
class _FoundRows:
    """What `DriveInfo` says of rows."""

    reason: Text
    rows_by: str
    cell_m: float = 0.0
    cells_per_row: int = 0


def _rows_of(
    writer: RecordingWriter, trajectory: Trajectory | None, name: str, monitor: Monitor
) -> _FoundRows:
    folder = writer.folder
    contradiction: Text | None = None
    if COLUMN in writer.names and trajectory is None:
        monitor.report(0.0, _GRID.filled(name=name))
        grid = order_by_grid(folder, writer.count, lambda: _names_to_sort(writer), monitor)
        if isinstance(grid, ScanGrid):
            return _FoundRows(grid.told, SCAN, cells_per_row=grid.sweep_length)
        contradiction = grid.reason
    if writer.has_times:
        points = RecordedPoints(folder, writer.count, writer.lattice.scale, writer.lattice.offset)
        found = find_turns(points, trajectory, monitor)
        if not isinstance(found, NoTurns):
            write_turns(folder, found)
            return _FoundRows(Text("", ""), found.method)
        reason = found.reason
    else:
        reason = Text(
            "The points have no times, so there are no rows; the top view is shown.",
            "点に時刻がないため行を決められません。上面画像で表示します。",
        )
    monitor.report(0.5, _CELLS.filled(name=name))
    view = _order_for_top_view(writer, monitor)
    return _FoundRows(contradiction or reason, "top-view", view.cell_m, view.cells_per_row)


def _names_to_sort(writer: RecordingWriter) -> tuple[str, ...]:
    """All columns; those that say where points were delivered are among them."""
    writer.write_source_columns()
    return writer.names


def _scanner_place(writer: RecordingWriter, plan: BuildPlan, found: _FoundRows) -> Place | None:
    if found.rows_by != SCAN or len(writer.points_of_source) != 1:
        return None
    source = next(iter(writer.points_of_source))
    return checked_place(
        Columns(writer.folder, writer.count),
        writer.lattice.scale,
        writer.lattice.offset,
        found.cells_per_row,
        plan.scanner_places.get((source, writer.scanner)),
    )


def _order_for_top_view(writer: RecordingWriter, monitor: Monitor) -> TopView:
    folder, count = writer.folder, writer.count
    scale, offset = np.array(writer.lattice.scale), np.array(writer.lattice.offset)
    sample = Columns(folder, count)["xyz"][:: max(1, count // _SAMPLE_POINTS)] * scale + offset
    view = top_view_of(
        sample, count, writer.lowest * scale + offset, writer.highest * scale + offset
    )

    def by_cell(columns: Mapping[str, NDArray[Any]]) -> tuple[NDArray[Any], NDArray[Any]]:
        integers = columns["xyz"]
        return view.cells_of(integers * scale + offset), -integers[:, 2].astype(np.int64)

    sort_points(folder, _names_to_sort(writer), count, by_cell, PartMonitor(monitor, 0.5, 0.9))
    with ColumnWriter(folder) as cells:
        for start, stop in stretches(count, POINTS_AT_ONCE // 4):
            monitor.check()
            integers = read_stretch(folder, "xyz", start, stop)
            cells.append({"pulse": view.cells_of(integers * scale + offset)})
    return view

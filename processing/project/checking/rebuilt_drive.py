"""A drive imported again from the files that it was delivered in, beside the one that it had."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import sums_of
from processing.core.errors import MissingInput, UserError, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.project.sources.source_check import require_delivered
from processing.recording.columns.columns import COLUMN_TYPES, Columns, column_path
from processing.recording.columns.ordering import chunk_ranges, read_chunk
from processing.recording.columns.source_order import sources_of
from processing.recording.drive import read_kept_trajectory
from processing.recording.drive_info import read_drive_info
from processing.recording.file_locations import FolderMove, path_now
from processing.recording.vehicle_path.trajectory import Trajectory

_SOURCE_BITS = 40
_ORDER = ("xyz", "time", "intensity")
_TABLE = (
    "time_s", "easting_m", "northing_m", "height_m", "roll_deg", "pitch_deg", "heading_deg",
)  # fmt: skip


class RebuiltDrive:
    """What the delivered files give anew.

    Parameters
    ----------
    before : Path
        The damaged drive's folder.
    folder : Path
        That of the drive imported again.

    Attributes
    ----------
    has_same_order : bool
        Whether the points of both are in the same order, as far as whole columns tell.
    """

    def __init__(self, before: Path, folder: Path) -> None:
        self._before = before
        self.folder = folder
        self._count = read_drive_info(folder).count
        self.has_same_order = self._compare_order()

    def bytes_at_old_places(self, name: str, start: int, stop: int) -> bytes | None:
        """Bytes of a column as the damaged drive has its points, by where they were delivered.

        Parameters
        ----------
        start, stop : int
            Bytes of the column's file.

        Returns
        -------
        bytes or None
            None where the rebuilt drive lacks the column, or one of the points.
        """
        dtype, width = COLUMN_TYPES[name]
        item = np.dtype(dtype).itemsize * width
        if not column_path(self.folder, name).is_file():
            return None
        first, last = start // item, -(-stop // item)
        try:
            wanted = _keys(self._before, first, last)
        except UserError:
            return None
        if self.has_same_order:
            values = read_chunk(self.folder, name, first, last)
        else:
            found = self._values_of(name, wanted)
            if found is None:
                return None
            values = found
        content = values.astype(dtype, copy=False).tobytes()
        return content[start - first * item : stop - first * item]

    def _values_of(self, name: str, wanted: NDArray[np.int64]) -> NDArray[np.generic] | None:
        dtype, width = COLUMN_TYPES[name]
        order = np.argsort(wanted)
        rising = wanted[order]
        values = np.zeros((wanted.size, width), dtype)
        has = np.zeros(wanted.size, np.bool_)
        for start, stop in chunk_ranges(self._count):
            keys = _keys(self.folder, start, stop)
            places = np.searchsorted(rising, keys)
            places[places == rising.size] = 0
            is_one = rising[places] == keys
            chosen = order[places[is_one]]
            read = read_chunk(self.folder, name, start, stop).reshape(-1, width)
            values[chosen] = read[is_one]
            has[chosen] = True
        return values if has.all() else None

    def _compare_order(self) -> bool:
        is_known = False
        for name in _ORDER:
            mine, theirs = column_path(self.folder, name), column_path(self._before, name)
            if mine.is_file() and theirs.is_file():
                with report_as_user_error(theirs):
                    if sums_of(mine).sums == sums_of(theirs).sums:
                        # One column of many values is enough; a damaged one can't say anything.
                        is_known |= name in ("xyz", "time")
        return is_known


@dataclass(frozen=True)
class Rebuilding:
    """What it takes to rebuild a drive.

    Attributes
    ----------
    folder : Path
        The drive's.
    moves : tuple of FolderMove
        Where folders of delivered files are now.
    """

    folder: Path
    moves: tuple[FolderMove, ...]
    monitor: Monitor


def rebuild_drive(rebuilding: Rebuilding, into: Path) -> RebuiltDrive:
    """Import the delivered files of a damaged drive again.

    Parameters
    ----------
    into : Path
        A new folder on the project's disk.

    Raises
    ------
    MissingInput, BadFile, UserError
        A delivered file is gone or another one, or the drive no longer tells which it was.
    Cancelled
    """
    folder, monitor = rebuilding.folder, rebuilding.monitor
    # The drive itself may not open: what it was made from is what counts.
    info, trajectory = read_drive_info(folder), read_kept_trajectory(folder)
    sources = [source for source in info.sources if source.points]
    paths = [path_now(source.path, rebuilding.moves) for source in sources]
    for source, path in zip(sources, paths, strict=True):
        require_delivered(source, path, monitor.check)
    if not paths:
        raise _no_sources(folder)
    tables: tuple[Path, ...] = ()
    if trajectory is not None:
        tables = (into.parent / "trajectory.csv",)
        _write_table(tables[0], trajectory)
    columns = next((one.columns for one in sources if one.columns), ())
    request = ImportRequest(tuple(paths), tables, crs=info.crs, columns=columns)
    for made in import_drives(request, into, monitor):
        found = read_drive_info(made)
        if (found.scanner, found.count) == (info.scanner, info.count):
            return RebuiltDrive(folder, made)
    raise _no_sources(folder)


def _keys(folder: Path, start: int, stop: int) -> NDArray[np.int64]:
    """Where points of a drive were delivered, as one number each; files are told by their names."""
    info = read_drive_info(folder)
    files, indices = sources_of(
        Columns(folder, info.count), info.source_runs, start, stop, sources=len(info.sources)
    )
    names = sorted({source.sha256 or source.path for source in info.sources})
    numbers = np.array([names.index(one.sha256 or one.path) for one in info.sources], np.int64)
    return (numbers[files] << _SOURCE_BITS) | indices


def _write_table(path: Path, trajectory: Trajectory) -> None:
    rows = np.column_stack([trajectory.time, trajectory.xyz, trajectory.roll_pitch_heading_deg])
    with report_as_user_error(path), path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(_TABLE)
        # A float's own words are read back to the same float.
        writer.writerows([repr(float(value)) for value in row] for row in rows)


def _no_sources(folder: Path) -> MissingInput:
    return MissingInput(
        Text(
            "The delivered files no longer give this drive.",
            "納品ファイルからこの走行データを作り直せません。",
        ),
        Text.same(folder.name),
        Text(
            "Import them again as a new drive, and remove this one.",
            "新しい走行データとしてインポートし直し、この走行データを削除してください。",
        ),
    )

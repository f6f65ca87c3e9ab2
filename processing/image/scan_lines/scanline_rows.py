"""The rows of a pass that are meshed, and their points, some hundred thousand at a time.

A row here is a revolution about the moment at which the beam points at the road below the vehicle,
so the road isn't cut, and the pulses counted from that moment are the columns: the same column of
two rows looks the same way.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.image.scan_lines.scanline_arrays import PointArrays
from processing.recording.columns.counted_classes import class_columns
from processing.recording.columns.damaged_pulses import damaged_pulses
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive
from processing.recording.passes import Pass, PathSurroundings
from processing.recording.revolutions.revolutions import Revolutions
from processing.recording.vehicle_path.pass_kernels import advanced_kernel

PULSES_AT_ONCE = 600_000
"""Rows of one to some seconds, some 30 MB, and short enough for a cancel to be felt."""

_SHARE_OF_REVOLUTION = 1 / 3
"""To either side: what is nearer to the zenith hangs above the vehicle."""


@dataclass(frozen=True)
class ScanRows:
    """Rows in the order of time.

    Attributes
    ----------
    folds : (k,) int64
        The pulse that was sent when the beam pointed at the road below the vehicle.
    ends : (k, 2) int64
        The first pulse of each row and the one behind its last.
    stations_m : (k,) float64
        Of the vehicle, rising.
    are_breaks : (k,) bool
        No surface goes on from the row before: the laser rested between them.
    """

    folds: Integers
    ends: Integers
    stations_m: Floats
    are_breaks: NDArray[np.bool_]

    def __len__(self) -> int:
        return self.folds.size

    @property
    def width(self) -> int:
        """Columns that hold every pulse of every row."""
        return self.half_width + int((self.ends[:, 1] - self.folds).max(initial=0))

    @property
    def half_width(self) -> int:
        """The column of the fold."""
        return int((self.folds - self.ends[:, 0]).max(initial=0))

    def between(self, low_m: float, high_m: float) -> ScanRows:
        """The rows passed between two stations."""
        first = int(np.searchsorted(self.stations_m, low_m))
        end = int(np.searchsorted(self.stations_m, high_m, side="right"))
        return self.part(first, end)

    def part(self, first: int, end: int) -> ScanRows:
        """Some rows that follow each other."""
        rows = slice(first, end)
        return ScanRows(
            self.folds[rows], self.ends[rows], self.stations_m[rows], self.are_breaks[rows]
        )

    def batches(self, pulses_at_once: int) -> Iterator[tuple[int, int]]:
        """First and end row of stretches that are read at once; a standstill is stepped over."""
        first = 0
        while first < len(self):
            most = self.ends[first, 0] + pulses_at_once
            end = max(first + 1, int(np.searchsorted(self.ends[:, 1], most, side="right")))
            yield first, end
            first = end


@dataclass(frozen=True)
class RowPoints:
    """The points of some rows.

    Attributes
    ----------
    arrays : PointArrays
    rows : (k, 5) int64
        As `MeshRows.ends`.
    """

    arrays: PointArrays
    rows: Integers


def scan_rows(revolutions: Revolutions, vehicle_path: Pass, least_advance_m: float) -> ScanRows:
    """The rows of a pass in which the vehicle has gone on since the row before.

    Parameters
    ----------
    least_advance_m : float
        How far; rows between are left out.
    """
    folds, times = revolutions.fold_pulses, revolutions.reference_times
    inside = np.flatnonzero((times >= vehicle_path.times[0]) & (times <= vehicle_path.times[-1]))
    if not inside.size:
        inside = np.empty(0, np.int64)
    stations = vehicle_path.station_at(times[inside])
    marked = np.zeros(inside.size, np.bool_)
    advanced_kernel(stations, least_advance_m, marked)
    kept = inside[marked]
    aside = int(revolutions.pulses_per_revolution * _SHARE_OF_REVOLUTION)
    middles = (folds[:-1] + folds[1:]) // 2
    lows = np.maximum(folds - aside, np.concatenate([[folds[0] - aside], middles]))
    highs = np.minimum(folds + aside, np.concatenate([middles, [folds[-1] + aside]]))
    segments = revolutions.segments[np.minimum(kept, revolutions.segments.size - 1)]
    are_breaks = np.concatenate([[True], np.diff(segments) != 0])[: kept.size]
    return ScanRows(folds[kept], np.column_stack([lows, highs])[kept], stations[marked], are_breaks)


def read_rows(
    drive: Drive,
    vehicle_path: Pass,
    rows: ScanRows,
    half_width: int,
    asked: PathSurroundings | None = None,
) -> RowPoints:
    """The points of rows that follow each other.

    Parameters
    ----------
    half_width : int
        The column of the fold.
    asked : PathSurroundings, optional
        Of what lies elsewhere nothing need be known.
    """
    pulses = drive.columns["pulse"]
    bounds = [int(rows.ends[0, 0]), int(rows.ends[:, 1].max())]
    start, stop = (int(end) for end in np.searchsorted(pulses, bounds))
    if start > stop:
        raise damaged_pulses(drive.folder)
    read = {
        name: read_chunk(drive.folder, name, start, stop) for name in ("pulse", "time", "intensity")
    }
    local = drive.coordinates.chunk_about(start, stop, vehicle_path.origin)
    ends = np.searchsorted(read["pulse"], rows.ends)
    found = vehicle_path.stations_of_local(local, read["time"], asked)
    is_noise = class_columns(drive.columns).noise_between(start, stop)
    count = len(rows)
    table = np.column_stack(
        [ends, np.full(count, start), rows.folds - half_width, rows.are_breaks]
    ).astype(np.int64)
    arrays = PointArrays(read["pulse"], local, found, read["time"], read["intensity"], is_noise)
    return RowPoints(arrays, table)

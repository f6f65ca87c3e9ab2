"""Delivery: which of the delivered files belong to which scanner, and in what order."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, MissingInput, OutOfRange
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.points.point_files import PointFileInfo, read_info, read_sample
from processing.map.reference_system import reference_system
from processing.project.importing.file_recorder import empty_points
from processing.recording.vehicle_path.clock import are_within_days
from processing.recording.waveform_packets.descriptors import DIRECTION
from processing.recording.waveform_packets.ray_signs import is_from_air

_SAMPLE_POINTS = 2_000
_TRANSFORM = Text(
    "Transform the points to a plane system in metres first; if only the file's note of it is "
    "wrong, name the right one with --crs. {unchanged}",
    "点群をメートル単位の平面直角座標系に変換してから読み込んでください。"
    "ファイルの座標系の記録だけが誤っている場合は、"
    "正しい座標系を --crs で指定してください。{unchanged}",
).filled(unchanged=UNCHANGED)
_FIRST_FLIGHT_LINE = 16
_BETWEEN_FLIGHT_LINES_S = 20.0


@dataclass(frozen=True)
class DeliveredFile:
    """One point file, as far as its header and two samples tell.

    Attributes
    ----------
    first_time, last_time : float
        Of the sampled points, delivered clock; NaN without times.
    scanner_column : str
        The column that tells scanners apart: ``scanner`` or ``user_data``; empty for none.
    scanners : frozenset of int
        Scanner numbers in the samples.
    columns : tuple of str
        What each point comes with.
    """

    info: PointFileInfo
    first_time: float
    last_time: float
    scanner_column: str
    scanners: frozenset[int]
    columns: tuple[str, ...]

    @property
    def has_origins(self) -> bool:
        """Whether every point says where the scanner was."""
        return "origin" in self.columns

    @property
    def has_times(self) -> bool:
        """Whether the samples have times."""
        return bool(np.isfinite(self.first_time))


@dataclass(frozen=True)
class Delivery:
    """All point files of one import.

    Attributes
    ----------
    recordings : tuple of tuple of DeliveredFile
        Files that follow one another within a day; a scanner number within one group is one
        scanner.
    dates : tuple of int
        For each of these, which date it is of, in their order: groups more than a day apart.
    crs : str
        ``EPSG:n``, or empty when neither the files nor the user know it.
    """

    recordings: tuple[tuple[DeliveredFile, ...], ...]
    dates: tuple[int, ...]
    crs: str


def read_delivery(
    inputs: tuple[Path, ...], crs: str, monitor: Monitor, *, columns: tuple[str, ...] = ()
) -> Delivery:
    """Look at the headers and at the ends of all files, and sort them out.

    Parameters
    ----------
    crs : str
        What the user says; empty to take the files'.
    columns : tuple of str
        Of text files, as the user says; empty to go by the files.

    Raises
    ------
    UserError
        For a file that can't be read, no files at all, or files of different reference systems.
    """
    if not inputs:
        raise MissingInput(
            Text("No point files were given.", "点群ファイルが指定されていません。"),
            Text.same("zuka import"),
            Text("Name one or more point files.", "点群ファイルを1つ以上指定してください。"),
        )
    files = []
    for path in inputs:
        monitor.check()
        files.append(_looked_at(path, columns))
    groups = _group_files(files)
    recordings = tuple(tuple(group.files) for group in groups)
    return Delivery(recordings, _dates_of(groups), _plane_system(crs or _common_crs(files), files))


def _looked_at(path: Path, columns: tuple[str, ...]) -> DeliveredFile:
    info = read_info(path, columns=columns)
    sample = read_sample(path, _SAMPLE_POINTS, columns=columns)
    _refuse_empty_end(info, sample)
    times = sample.get("time", np.empty(0))
    times = times[np.isfinite(times)]
    column = _scanner_column(sample)
    return DeliveredFile(
        info=info,
        first_time=float(times.min()) if times.size else float("nan"),
        last_time=float(times.max()) if times.size else float("nan"),
        scanner_column=column,
        scanners=frozenset(int(number) for number in np.unique(sample.get(column, np.zeros(1)))),
        columns=tuple(sample),
    )


def _scanner_column(sample: dict[str, NDArray[np.generic]]) -> str:
    """``user_data`` only where the source id says nothing and it holds a few small numbers.

    No column where the source ids are those of flight lines, which are one cloud.
    """
    scanners = sample.get("scanner")
    marks = sample.get("user_data")
    rays = sample.get(DIRECTION)
    first_line = (
        _FIRST_FLIGHT_LINE if rays is None or not is_from_air(rays.astype(np.float32)) else 0
    )
    if scanners is not None and _are_flight_lines(scanners, sample.get("time"), first_line):
        return ""
    if scanners is None or marks is None or np.unique(scanners).size > 1:
        return "scanner"
    found = np.unique(marks)
    is_scanner_number = 2 <= found.size <= 4 and found.min() >= 1 and found.max() <= 8
    return "user_data" if is_scanner_number else "scanner"


def _are_flight_lines(
    scanners: NDArray[np.generic], times: NDArray[np.generic] | None, first_line: int
) -> bool:
    """Whether large source ids follow one another: heads of a vehicle count from 1 and go along."""
    numbers = np.unique(scanners)
    if times is None or numbers.size < 2 or numbers[0] < first_line:
        return False
    passes = [times[scanners == number] for number in numbers]
    if not all(np.isfinite(one).all() for one in passes):
        return False
    spans = sorted((float(one.min()), float(one.max())) for one in passes)
    gaps = [later[0] - earlier[1] for earlier, later in itertools.pairwise(spans)]
    return min(gaps) > _BETWEEN_FLIGHT_LINES_S


def _common_crs(files: list[DeliveredFile]) -> str:
    named = {file.info.crs: file for file in files if file.info.crs}
    if len(named) > 1:
        first, second = list(named.items())[:2]
        raise OutOfRange(
            Text(
                "The files have different reference systems, {first} and {second}.",
                "ファイルの座標参照系が異なります（{first} と {second}）。",
            ).filled(first=first[0], second=second[0]),
            Text.same(f"{first[1].info.path.name}, {second[1].info.path.name}"),
            Text(
                "Import them one by one, or say which one is right with --crs. {unchanged}",
                "1つずつインポートするか、正しい座標系を --crs で指定してください。{unchanged}",
            ).filled(unchanged=UNCHANGED),
        )
    return next(iter(named), "")


def _plane_system(crs: str, files: list[DeliveredFile]) -> str:
    """The system if a drawing can be made in it; said before anything is read."""
    if not (crs and any(file.info.count for file in files)):
        return ""
    try:
        return reference_system(crs)
    except OutOfRange as error:
        names = ", ".join(file.info.path.name for file in files if file.info.crs == crs)
        where = Text.same(f"{names}: {crs}" if names else crs)
        raise OutOfRange(error.what, where, _TRANSFORM if names else error.remedy) from error


def _refuse_empty_end(info: PointFileInfo, sample: dict[str, NDArray[np.generic]]) -> None:
    """Refuse a file whose last points are zeros: room was taken for it, but never filled."""
    if info.count <= 2 * _SAMPLE_POINTS:
        return
    ends = [
        sample[name][-_SAMPLE_POINTS:] for name in ("xyz", "intensity", "time") if name in sample
    ]
    if not any(values.any() for values in ends):
        raise empty_points(info.path, info.count - _SAMPLE_POINTS + 1, info.count)


@dataclass
class _Group:
    """Files of scanners that follow one another, and those that still reach into what comes."""

    files: list[DeliveredFile]
    reaching: list[DeliveredFile]
    span: tuple[float, float]

    def takes(self, file: DeliveredFile) -> bool:
        """Whether a file, which does not begin before any of these, goes on where they end."""
        first = self.files[0]
        if (file.scanner_column, file.has_origins) != (first.scanner_column, first.has_origins):
            return False
        # Numbers that come again on another date are other scanners, or other stations.
        if not are_within_days(self.span, _span(file)):
            return False
        self.reaching = [one for one in self.reaching if one.last_time > file.first_time]
        return not any(
            one.scanners & file.scanners and _overlap(one, file) for one in self.reaching
        )

    def add(self, file: DeliveredFile) -> None:
        """Take a file."""
        self.files.append(file)
        self.reaching.append(file)
        self.span = self.span[0], max(self.span[1], file.last_time)


def _group_files(files: list[DeliveredFile]) -> list[_Group]:
    """Files of the same scanners that overlap in time, or are days apart, are other scanners'."""
    timeless = [_Group([file], [], _span(file)) for file in files if not file.has_times]
    groups: list[_Group] = []
    for file in sorted((file for file in files if file.has_times), key=_by_time):
        group = next((group for group in groups if group.takes(file)), None)
        if group is None:
            group = _Group([], [], _span(file))
            groups.append(group)
        group.add(file)
    timeless.sort(key=lambda group: str(group.files[0].info.path))
    return [*groups, *timeless]


def _dates_of(groups: Sequence[_Group]) -> tuple[int, ...]:
    """The date of each group, which are in the order of time; no times come with the first."""
    dates: list[int] = []
    date, reached = 0, groups[0].span
    for group in groups:
        first, last = group.span
        if not np.isfinite(first):
            dates.append(0)
            continue
        date += not are_within_days(reached, group.span)
        reached = reached[0], max(reached[1], last)
        dates.append(date)
    return tuple(dates)


def _span(file: DeliveredFile) -> tuple[float, float]:
    return file.first_time, file.last_time


def _by_time(file: DeliveredFile) -> tuple[float, str]:
    return file.first_time, str(file.info.path)


def _overlap(one: DeliveredFile, other: DeliveredFile) -> bool:
    """Whether two files have more than half of the shorter one's time in common."""
    together = min(one.last_time, other.last_time) - max(one.first_time, other.first_time)
    shorter = min(one.last_time - one.first_time, other.last_time - other.first_time)
    return together > 0.5 * max(shorter, 1e-9)

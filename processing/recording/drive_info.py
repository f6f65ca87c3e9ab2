"""DriveInfo: what is written down about one scanner's recording."""

from __future__ import annotations

import dataclasses
import json
import math
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

from processing.core.block_sums import refuse_damaged, write_with_sums
from processing.core.errors import BadFile, report_as_user_error
from processing.core.stored_json import json_of
from processing.core.text import Text
from processing.recording.columns.source_order import SourceRun

Triple = tuple[float, float, float]

FILE_NAME = "drive.json"

BY_ORDER = "order"
"""What is said of rows that come from the order of the points, of a drive without any time."""


@dataclass(frozen=True)
class SourceFile:
    """A delivered file, as it was when it was imported.

    Attributes
    ----------
    sha256 : str
        Checksum of the whole file; empty when it wasn't taken.
    points : int
        Points that the drive has of it.
    columns : tuple of str
        What the columns of text were taken for, ``-`` for one that was passed over; empty where
        the file says it.
    """

    path: str
    size: int
    modified_ns: int
    sha256: str
    points: int
    columns: tuple[str, ...] = ()


@dataclass(frozen=True)
class DriveInfo:
    """Facts about one scanner's recording.

    Attributes
    ----------
    scale, offset : tuple of float
        Metres = integers × scale + offset.
    lowest, highest : tuple of float
        Extent in metres, project CRS.
    crs : str
        ``EPSG:n``, or empty when unknown.
    clock_offset_s : float
        What was added to the delivered times to bring them to the trajectory's clock.
    rows_by : str
        How rows were found: ``trajectory``, ``origins``, ``scan-angle``, ``periodicity``,
        ``order``; ``scan`` for the sweeps of a standing scanner's own grid; or ``top-view`` where
        there are none.
    rows_reason : Text
        Why there are no revolutions, or how sure those are that come from the order of the points;
        empty for others.
    cell_m, cells_per_row
        Without revolutions only: size of a cell of the top view, 0 for a scan; cells in a row or
        sweep.
    source_runs : tuple of SourceRun
        Where in the files the points were; empty where the columns ``source_file`` and
        ``source_index`` say it.
    scanner_position : tuple of float or None
        Where a standing scanner was, m, project CRS; None for others and where it is not known.
    measured_on : str
        Day that somebody said it was measured on, as ``2026-04-01``; empty where the times count.
    """

    id: str
    name: str
    scanner: int
    count: int
    scale: Triple
    offset: Triple
    lowest: Triple
    highest: Triple
    crs: str
    sources: tuple[SourceFile, ...]
    clock_offset_s: float
    rows_by: str
    rows_reason: Text = Text("", "")
    cell_m: float = 0.0
    cells_per_row: int = 0
    source_runs: tuple[SourceRun, ...] = ()
    scanner_position: Triple | None = None
    measured_on: str = ""

    @property
    def has_measured_times(self) -> bool:
        """Whether the column ``time`` tells times: with rows by order it only orders the points."""
        return self.rows_by != BY_ORDER

    def widened(self, by_m: float) -> DriveInfo:
        """The same with an extent that reaches farther to all sides."""
        (a, b, c), (d, e, f) = self.lowest, self.highest
        return dataclasses.replace(
            self,
            lowest=(a - by_m, b - by_m, c - by_m),
            highest=(d + by_m, e + by_m, f + by_m),
        )


def write_drive_info(folder: Path, info: DriveInfo) -> None:
    """Write a drive's facts into its folder, whole or not at all."""
    path = folder / FILE_NAME
    with report_as_user_error(path):
        text = json.dumps(dataclasses.asdict(info), ensure_ascii=False, indent=1)
        # Names of files may be no text; JSON reads them back.
        write_with_sums(path, text.encode("utf-8", errors="backslashreplace"))


def read_drive_info(folder: Path) -> DriveInfo:
    """Read a drive's facts.

    Raises
    ------
    MissingInput, BadFile
        There is no such file, or it isn't what was written.
    """
    path = folder / FILE_NAME
    refuse_damaged(path)
    with report_as_user_error(path):
        text = path.read_bytes()
    try:
        return _from_json(json_of(text))
    except (ValueError, TypeError, KeyError) as error:
        raise BadFile(
            Text(
                "The description of a drive is damaged.", "走行データの記述ファイルが壊れています。"
            ),
            Text.same(f"{path}: {error}"),
            Text(
                "Import the drive again from the delivered files.",
                "納品ファイルから走行データを再インポートしてください。",
            ),
        ) from error


# The values come from JSON, whose types only the field names tell.
def _from_json(values: dict[str, Any]) -> DriveInfo:
    triples = {
        name: (float(values[name][0]), float(values[name][1]), float(values[name][2]))
        for name in ("scale", "offset", "lowest", "highest")
    }
    sources = tuple(
        SourceFile(**{**source, "columns": tuple(source.get("columns", ()))})
        for source in values["sources"]
    )
    runs = tuple(SourceRun(**run) for run in values["source_runs"])
    reason = Text(**values["rows_reason"])
    position = values.get("scanner_position")
    stood = (
        None if position is None else (float(position[0]), float(position[1]), float(position[2]))
    )
    read = {
        "sources": sources,
        "rows_reason": reason,
        "source_runs": runs,
        "scanner_position": stood,
    }
    rest = {**values, **triples, **read}
    _check(rest)
    return DriveInfo(**rest)


def _check(values: dict[str, Any]) -> None:
    """Refuse by a ValueError numbers that arrays and places in them can't be made from."""
    for name in ("count", "cells_per_row", "scanner"):
        if not isinstance(values.get(name, 0), int) or values.get(name, 0) < 0:
            raise ValueError(name)
    for name in ("scale", "offset", "lowest", "highest"):
        # The extent of no points is none.
        if not all(map(math.isfinite, values[name])) and values["count"]:
            raise ValueError(name)
    if values.get("measured_on"):
        date.fromisoformat(values["measured_on"])
    for run in values["source_runs"]:
        if not 0 <= run.source < len(values["sources"]) or min(run.start, run.first_index) < 0:
            message = "source_runs"
            raise ValueError(message)

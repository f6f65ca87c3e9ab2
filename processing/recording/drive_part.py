"""Some points of a recording as a drive of its own, for trying things out where it is quick.

Points keep their order, times and pulse numbers, so rows and columns of the image are those of the
whole recording; pixels of points that are left out are empty.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor
from processing.recording.columns.columns import COLUMN_TYPES, ColumnWriter
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import TRAJECTORY_FILE, Drive
from processing.recording.drive_info import write_drive_info
from processing.recording.revolutions.revolutions_file import write_revolutions
from processing.recording.waveform_packets.kept_packets import link_packets

_AT_ONCE = 1_000_000
"""Points copied at a time: short enough for a cancel to be felt at once."""

PointFilter = Callable[[int, int], NDArray[np.bool_]]
"""Which of the points ``start … stop − 1`` are wanted: (k,) bool."""


ExtraColumns = Callable[[int, int], Mapping[str, NDArray[Any]]]
"""More columns of the points ``start … stop − 1``, by name; each of a type of its own."""


def write_part(
    drive: Drive, chosen: PointFilter, into: Path, monitor: Monitor, *, beside: ExtraColumns
) -> Drive:
    """Write chosen points of a drive as a drive folder, and open it.

    Parameters
    ----------
    chosen : callable
    into : Path
        A new folder.
    beside : callable
        Columns that the part has besides those of the drive.

    Returns
    -------
    Drive
        Without the places in delivered files: it is not to be exported.

    Raises
    ------
    NoSpace, Cancelled
    """
    with report_as_user_error(into):
        into.mkdir(parents=True)
    names = [name for name in COLUMN_TYPES if name != "xyz" and drive.columns.has(name)]
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    with ColumnWriter(into) as writer:
        for start in range(0, max(drive.count, 1), _AT_ONCE):
            monitor.check()
            stop = min(start + _AT_ONCE, drive.count)
            wanted = chosen(start, stop)
            read = {name: read_chunk(drive.folder, name, start, stop)[wanted] for name in names}
            read["xyz"] = drive.coordinates.chunk(start, stop)[wanted]
            more = {name: values[wanted] for name, values in beside(start, stop).items()}
            writer.append({**read, **more})
            if len(read["xyz"]):
                low = np.minimum(low, read["xyz"].min(axis=0))
                high = np.maximum(high, read["xyz"].max(axis=0))
            monitor.report(stop / max(drive.count, 1))
        count = writer.count
    info = drive.info
    metres = drive.coordinates.quantisation.metres
    if count:
        lowest, highest = metres(low).tolist(), metres(high).tolist()
        info = replace(info, lowest=tuple(lowest), highest=tuple(highest))
    write_drive_info(into, replace(info, count=count, source_runs=()))
    if drive.revolutions is not None:
        write_revolutions(into, drive.revolutions)
    trajectory = drive.folder / TRAJECTORY_FILE
    if trajectory.is_file():
        with report_as_user_error(into):
            shutil.copyfile(trajectory, into / TRAJECTORY_FILE)
    link_packets(drive.folder, into)
    return Drive(into)

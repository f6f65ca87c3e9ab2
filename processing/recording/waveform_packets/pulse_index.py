"""Which points lie on which packet: made of the points' columns, and made again when it is gone.

Three files in the drive folder: the packets' keys in rising order, where each packet's points begin
among those of all packets, and the points, a packet's owner first. Keys rise as packets lie in
their files, so that whoever goes through them reads the files from front to back.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor
from processing.core.owned_files import remove_folder
from processing.recording.columns.columns import ColumnWriter
from processing.recording.columns.ordering import chunk_ranges, read_chunk, sort_points
from processing.recording.columns.source_order import INDEX
from processing.recording.waveform_packets.descriptors import LOCATION, PACKET

KEYS, STARTS, POINTS = "pulse_keys.bin", "pulse_starts.bin", "pulse_points.bin"
INDEX_FILES = (KEYS, STARTS, POINTS)

_RETURN = "return_number"
_WORK = "pulses.part"
_LONGEST_PS = 1e9


def has_pulse_index(folder: Path) -> bool:
    """Whether a drive folder has the index."""
    return all((folder / name).is_file() for name in INDEX_FILES)


def make_pulse_index(folder: Path, count: int, monitor: Monitor) -> None:
    """Make the index from the columns of a drive folder; replaces an older one.

    Parameters
    ----------
    count : int
        Points of the drive.

    Raises
    ------
    NoSpace, Cancelled
    """
    work = folder / _WORK
    with report_as_user_error(work):
        remove_folder(work)
        work.mkdir()
    try:
        linked = _write_linked_points(folder, work, count, monitor)
        if linked:
            sort_points(work, (PACKET, LOCATION, _RETURN, INDEX), linked, _by_packet, monitor)
        _write_index(work, linked, monitor)
        with report_as_user_error(folder):
            for name in INDEX_FILES:
                (work / name).replace(folder / name)
    finally:
        remove_folder(work)


def _write_linked_points(folder: Path, work: Path, count: int, monitor: Monitor) -> int:
    """The points that have a packet, as columns of their own; how many there are."""
    linked = 0
    with ColumnWriter(work) as writer:
        for start, stop in chunk_ranges(count):
            monitor.check()
            packets = read_chunk(folder, PACKET, start, stop)
            chosen = np.flatnonzero(packets >= 0)
            writer.append(
                {
                    PACKET: packets[chosen],
                    LOCATION: read_chunk(folder, LOCATION, start, stop)[chosen],
                    _RETURN: read_chunk(folder, _RETURN, start, stop)[chosen],
                    INDEX: chosen + start,
                }
            )
            linked += chosen.size
    return linked


def _by_packet(columns: Mapping[str, NDArray[Any]]) -> tuple[NDArray[Any], NDArray[Any]]:
    # The owner is the first return; of equal ones the nearest.
    location = np.clip(columns[LOCATION].astype(np.float64), 0, _LONGEST_PS - 1)
    return columns[PACKET], columns[_RETURN] * _LONGEST_PS + location


def _write_index(work: Path, linked: int, monitor: Monitor) -> None:
    last = -1
    with (
        report_as_user_error(work),
        (work / KEYS).open("wb") as keys,
        (work / STARTS).open("wb") as starts,
        (work / POINTS).open("wb") as points,
    ):
        for start, stop in chunk_ranges(linked):
            monitor.check()
            packets = read_chunk(work, PACKET, start, stop)
            begins = np.flatnonzero(np.diff(packets, prepend=np.int64(last)))
            keys.write(np.ascontiguousarray(packets[begins], "<i8").data)
            starts.write(np.ascontiguousarray(begins + start, "<i8").data)
            points.write(np.ascontiguousarray(read_chunk(work, INDEX, start, stop), "<i8").data)
            last = int(packets[-1])
        starts.write(np.array([linked], "<i8").data)

"""Joining the parts of a recording whose place was not known before they were decoded."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from processing.core.monitor import Monitor
from processing.core.owned_files import remove_folder
from processing.project.importing.file_record import Stream
from processing.project.importing.file_recorder import part_folder
from processing.project.importing.import_journal import ImportJournal
from processing.project.importing.import_layout import ImportLayout
from processing.project.importing.quantisation import QuantisationShift, shift_between
from processing.project.importing.recording import Recording
from processing.recording.columns.offset_columns import OffsetColumnWriter
from processing.recording.columns.ordering import chunk_ranges, read_chunk
from processing.recording.columns.quantisation import Quantisation
from processing.recording.columns.source_order import INDEX

_POINTS = 1_000_000


def join_parts(
    recording: Recording, layout: ImportLayout, journal: ImportJournal, monitor: Monitor
) -> None:
    """Bring all parts of a recording into its folder, which is the first part's.

    Points on another lattice are moved to the recording's; the extents of the parts follow. Goes
    on where a killed import stopped.

    Raises
    ------
    NoSpace, Cancelled
    """
    name = f"joined {recording.folder.name}"
    known = journal.known(name)
    joined = 1 if known is None else int(known["parts"])
    first = 0
    for number, part in enumerate(recording.parts):
        job = layout.jobs[part.source]
        move = _move_to(recording.quantisation, job.quantisation)
        if number >= joined:
            folder = part_folder(job, part.at)
            _copy(folder, part.stream, OffsetColumnWriter(recording.folder, first), move, monitor)
            journal.note(name, {"parts": number + 1}, (recording.folder,))
            journal.settle()
            remove_folder(folder)
        elif number:
            remove_folder(part_folder(job, part.at))
        if move is not None:
            recording.parts[number] = replace(part, stream=_move_stream(part.stream, move))
        first += part.stream.count
        monitor.report(first / recording.count)


def _move_to(target: Quantisation, quantisation: Quantisation) -> QuantisationShift | None:
    """None where nothing is to be moved."""
    return None if quantisation == target else shift_between(quantisation, target)


def _copy(
    folder: Path,
    stream: Stream,
    to: OffsetColumnWriter,
    move: QuantisationShift | None,
    monitor: Monitor,
) -> None:
    names = (*stream.names, *((INDEX,) if stream.is_indexed else ()))
    try:
        for start, stop in chunk_ranges(stream.count, _POINTS):
            monitor.check()
            columns = {name: read_chunk(folder, name, start, stop) for name in names}
            moved = None if move is None else move.applied(columns["xyz"])
            to.write(start, columns if moved is None else {**columns, "xyz": moved})
    finally:
        to.close()


def _move_stream(stream: Stream, move: QuantisationShift) -> Stream:
    corners = np.array([stream.lowest, stream.highest], dtype=np.int32)
    with_move = move.applied(corners)
    low, high = (corners if with_move is None else with_move).tolist()
    return replace(stream, lowest=tuple(low), highest=tuple(high))

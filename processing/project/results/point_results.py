"""Per-point results from acquisition order back to the delivered files' own order."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, PartMonitor
from processing.core.safe_write import refuse_inputs, write_safely
from processing.core.scratch_folder import scratch_folder
from processing.core.text import Text
from processing.formats.points.las_results import MOVED, write_results
from processing.formats.points.waveform_output import copy_packets
from processing.project.results.delivered_order import DeliveredOrder, Values
from processing.project.results.delivered_packets import DeliveredPackets, refuse_others_packets
from processing.project.sources.source_check import require_delivered
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive
from processing.tools.tool import FinishedColumns

_DEALING = 0.2
_PARTS = {
    "normal": (("normal_x", "normal_y", "normal_z"), 127.0),
    "shape": (("linearity", "planarity", "scattering"), 255.0),
}
"""Columns of three small integers: the names of their parts in files, and what makes them 1."""

_COLOR, _SEEN_COLOR, _SEEN = "color", "seen_color", "is_seen"
_SIXTEEN_BITS = np.uint16(257)
"""Makes the brightest of 8 bits the brightest of 16."""


def check_point_output(
    drives: Sequence[Drive], output: Path, monitor: Monitor
) -> tuple[tuple[Path, Path], ...]:
    """Look at what an output of points needs, before any work is spent on it.

    Parameters
    ----------
    drives : sequence of Drive
        All drives of the input.
    output : Path
        LAS or LAZ; where there are several files, their names are added to its own.

    Returns
    -------
    tuple of (Path, Path)
        Each delivered file, and where its points are written.

    Raises
    ------
    MissingInput
        A delivered file is no longer where it was.
    BadFile
        It is another one now.
    InUse
        The output would overwrite a delivered file.
    """
    found = set()
    for drive in drives:
        for source in drive.info.sources:
            if source.points:
                require_delivered(source, drive.source_path(source), monitor.check)
                found.add(drive.source_path(source))
    sources = sorted(found)
    paths = _paths_of(sources, output)
    for path in paths:
        refuse_inputs(path, _delivered_files(drives))
    return tuple(zip(sources, paths, strict=True))


def write_point_results(
    results: Sequence[tuple[Drive, FinishedColumns]], output: Path, monitor: Monitor
) -> tuple[Path, ...]:
    """Write results beside the points of the files that the drives came from.

    Parameters
    ----------
    results : sequence of (Drive, FinishedColumns)
        All drives of the input.
    output : Path
        As :func:`check_point_output`.

    Returns
    -------
    tuple of Path
        One for each delivered file, its points in its order; all are written, or none.

    Raises
    ------
    MissingInput, BadFile, InUse
        As :func:`check_point_output`.
    NoSpace, Cancelled
    """
    drives = [drive for drive, _ in results]
    noted = {drive.source_path(one): one for drive in drives for one in drive.info.sources}
    files = check_point_output(drives, output, monitor)
    packets = DeliveredPackets(drives)
    with ExitStack() as whole:
        scratch = whole.enter_context(scratch_folder(output.parent))
        order = DeliveredOrder(drives, _reader_of(results), scratch)
        order.prepare(PartMonitor(monitor, 0.0, _DEALING))
        share = (1.0 - _DEALING) / max(1, len(files))
        for number, (source, path) in enumerate(files):
            first = _DEALING + number * share
            monitor.report(first, _WRITING.filled(name=path.name))
            part = PartMonitor(monitor, first, first + share)
            temporary = whole.enter_context(write_safely(path, never=_delivered_files(drives)))
            found, columns = _results_of(order, source), noted[source].columns
            write_results(source, temporary, found, part, columns=columns)
            beside = packets.to_copy(source, path)
            if beside is not None:
                refuse_others_packets(beside[1], path)
                target = whole.enter_context(
                    write_safely(beside[1], never=_delivered_files(drives))
                )
                copy_packets(beside[0], target, part)
    return tuple(path for _, path in files)


_WRITING = Text("Writing {name}", "{name} を書き込み中")


def _delivered_files(drives: Sequence[Drive]) -> list[Path]:
    return [path for drive in drives for path in drive.delivered_files]


def _paths_of(sources: Sequence[Path], output: Path) -> list[Path]:
    """A path of its own for each, numbered where files of several folders have one name."""
    if len(sources) == 1:
        return [output]
    paths: list[Path] = []
    taken: set[str] = set()
    for source in sources:
        name, number = f"{output.stem}-{source.stem}{output.suffix}", 2
        while name.lower() in taken:
            name = f"{output.stem}-{source.stem}-{number}{output.suffix}"
            number += 1
        taken.add(name.lower())
        paths.append(output.with_name(name))
    return paths


def _reader_of(
    results: Sequence[tuple[Drive, FinishedColumns]],
) -> Callable[[Drive, int, int], Values]:
    of_drive = {drive.id: result for drive, result in results}
    is_moved = any(drive.coordinates.correction is not None for drive, _ in results)

    def read(drive: Drive, start: int, stop: int) -> Values:
        result = of_drive[drive.id]
        values = {name: result.read(name, start, stop) for name in result.names}
        if is_moved:
            values[MOVED] = drive.coordinates.moved_m(start, stop)
        if _SEEN_COLOR in values:
            seen = values.pop(_SEEN_COLOR).astype(np.uint16) * _SIXTEEN_BITS
            if drive.columns.has(_COLOR):
                # Where no camera saw a point it keeps the colour that it was delivered with.
                is_unseen = values[_SEEN] == 0
                delivered = read_chunk(drive.folder, _COLOR, start, stop)
                seen[is_unseen] = delivered[is_unseen]
            values[_COLOR] = seen
        return values

    return read


def _results_of(order: DeliveredOrder, source: Path) -> Callable[[int, int], Values]:
    def part(start: int, stop: int) -> Values:
        found = order.values(source, start, stop)
        return dict(one for name, values in found.items() for one in _spread_vectors(name, values))

    return part


def _spread_vectors(name: str, values: NDArray[Any]) -> list[tuple[str, NDArray[Any]]]:
    if name not in _PARTS:
        return [(name, values)]
    parts, one = _PARTS[name]
    return [(part, (values[:, axis] / one).astype(np.float32)) for axis, part in enumerate(parts)]

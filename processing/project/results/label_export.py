"""Labels as they are handed in: the delivered points in their order, classes replaced."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, PartMonitor
from processing.core.scratch_folder import scratch_folder
from processing.formats.format import Content
from processing.formats.points.las_results import write_results
from processing.formats.points.waveform_output import copy_packets
from processing.formats.registry import FORMATS
from processing.labels.label_column import LABEL
from processing.project.results.delivered_order import DeliveredOrder, Values
from processing.project.results.delivered_packets import DeliveredPackets
from processing.project.sources.source_check import require_delivered
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive

_DEALING = 0.2
_CLASS = "classification"
_COMPRESSED = ".laz"
_Codes = NDArray[np.uint8]


def write_labelled_points(
    drives: Sequence[Drive], position: Callable[[str], Path], monitor: Monitor
) -> None:
    """Write the points of every delivered file, with the labels that were painted on them.

    ``classification`` is the label where there is one, and the delivered class elsewhere; an extra
    dimension ``label`` holds the labels alone. All else is as delivered, in the delivered order;
    waveforms go with the points.

    Parameters
    ----------
    position : callable
        From a file's name to where it is written; delivered files are never that.

    Raises
    ------
    MissingInput
        A delivered file is no longer where it was.
    BadFile
        It is another one now; a column of labels is damaged.
    NoSpace, InUse, Cancelled
    """
    noted = [(drive, one) for drive in drives for one in drive.info.sources if one.points]
    columns = {drive.source_path(one): one.columns for drive, one in noted}
    for drive, one in noted:
        require_delivered(one, drive.source_path(one), monitor.check)
    for drive in drives:
        _check_codes(drive)
    packets = DeliveredPackets(drives)
    sources = sorted(columns)
    names = names_of_outputs(sources)
    paths = [position(name) for name in names]
    if not paths:
        return
    with scratch_folder(paths[0].parent) as scratch:
        order = DeliveredOrder(drives, _codes_of, scratch)
        order.prepare(PartMonitor(monitor, 0.0, _DEALING))
        share = (1.0 - _DEALING) / len(paths)
        for number, (source, path) in enumerate(zip(sources, paths, strict=True)):
            first = _DEALING + number * share
            part = PartMonitor(monitor, first, first + share)
            results = _results_of(order, source)
            write_results(source, path, results, part, columns=columns[source])
            beside = packets.to_copy(source, Path(names[number]))
            if beside is not None:
                copy_packets(beside[0], position(beside[1].name), part)


def _check_codes(drive: Drive) -> None:
    """Refuse columns of another length than the drive's before anything is written."""
    for name in (LABEL, _CLASS):
        if drive.columns.has(name):
            _ = drive.columns[name]


def _codes_of(drive: Drive, start: int, stop: int) -> Values:
    """Labels of points, and the classes they have with them."""
    labels = _column(drive, LABEL, start, stop)
    classes = _column(drive, _CLASS, start, stop)
    return {_CLASS: np.where(labels > 0, labels, classes), LABEL: labels}


def _column(drive: Drive, name: str, start: int, stop: int) -> _Codes:
    held = drive.columns.held(name)
    if held is not None:
        return np.asarray(held[start:stop])
    if not drive.columns.has(name):
        return np.zeros(stop - start, np.uint8)
    return np.asarray(read_chunk(drive.folder, name, start, stop))


def _results_of(order: DeliveredOrder, source: Path) -> Callable[[int, int], Values]:
    return lambda start, stop: order.values(source, start, stop)


def names_of_outputs(sources: Sequence[Path]) -> list[str]:
    """Names of files with the points of delivered ones.

    A name of its own for each: as delivered, numbered where folders have the same names.
    """
    names: list[str] = []
    for source in sources:
        ending = source.suffix.lower()
        if ending not in FORMATS.endings_written(Content.POINTS):
            ending = _COMPRESSED
        name, number = f"{source.stem}{ending}", 2
        while name.lower() in {one.lower() for one in names}:
            name, number = f"{source.stem}-{number}{ending}", number + 1
        names.append(name)
    return names

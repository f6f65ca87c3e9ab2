"""Labels as they are handed in: the delivered points in their order, classes replaced."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.formats.las_results import write_results
from processing.labels.label_column import labels_of
from processing.monitor import Monitor, PartMonitor
from processing.points.drive import Drive
from processing.project.source_check import require_delivered

_STRETCH = 4_000_000
_ENDINGS = (".las", ".laz")
_Codes = NDArray[np.uint8]


def write_labelled_points(
    drives: Sequence[Drive], place: Callable[[str], Path], monitor: Monitor
) -> None:
    """Write the points of every delivered file, with the labels that were painted on them.

    ``classification`` is the label where there is one, and the delivered class elsewhere; an extra
    dimension ``label`` holds the labels alone. All else is as delivered, in the delivered order.

    Parameters
    ----------
    place : callable
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
    for drive, one in noted:
        require_delivered(one, drive.source_path(one), monitor.check)
    sources = sorted({drive.source_path(one) for drive, one in noted})
    names = _names_of(sources)
    for number, (source, name) in enumerate(zip(sources, names, strict=True)):
        part = PartMonitor(monitor, number / len(sources), (number + 1) / len(sources))
        labels, classes = _in_file_order(drives, source, part)
        results = {"classification": np.where(labels > 0, labels, classes), "label": labels}
        write_results(source, place(name), results, part)


def _names_of(sources: Sequence[Path]) -> list[str]:
    """A name of its own for each: as delivered, numbered where folders have the same names."""
    names: list[str] = []
    for source in sources:
        ending = source.suffix.lower() if source.suffix.lower() in _ENDINGS else ".laz"
        name, number = f"{source.stem}{ending}", 2
        while name.lower() in {one.lower() for one in names}:
            name, number = f"{source.stem}-{number}{ending}", number + 1
        names.append(name)
    return names


def _in_file_order(
    drives: Sequence[Drive], source: Path, monitor: Monitor
) -> tuple[_Codes, _Codes]:
    """Labels and delivered classes of all points of a file, in its order."""
    mine = [
        (drive, number, one.points)
        for drive in drives
        for number, one in enumerate(drive.info.sources)
        if drive.source_path(one) == source
    ]
    labels = np.zeros(sum(points for _, _, points in mine), np.uint8)
    classes = np.zeros_like(labels)
    for drive, number, _ in mine:
        for start in range(0, drive.count, _STRETCH):
            monitor.check()
            points = np.arange(start, min(start + _STRETCH, drive.count))
            files, indices = drive.sources(start, int(points[-1]) + 1)
            own = files == number
            labels[indices[own]] = labels_of(drive, points[own])
            classes[indices[own]] = drive.columns["classification"][points[own]]
    return labels, classes

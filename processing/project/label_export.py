"""Labels as they are handed in: the delivered points in their order, classes replaced."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.errors import BadFile, MissingInput
from processing.formats.las_results import write_results
from processing.labels.label_column import labels_of
from processing.monitor import Monitor, PartMonitor
from processing.points.drive import Drive
from processing.text import Text

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
    sources = sorted({s.path for drive in drives for s in drive.info.sources if s.points})
    for source in sources:
        _check(Path(source), drives)
    names = _names_of([Path(source) for source in sources])
    for number, (source, name) in enumerate(zip(sources, names, strict=True)):
        part = PartMonitor(monitor, number / len(sources), (number + 1) / len(sources))
        labels, classes = _in_file_order(drives, source, part)
        results = {"classification": np.where(labels > 0, labels, classes), "label": labels}
        write_results(Path(source), place(name), results, part)


def _check(source: Path, drives: Sequence[Drive]) -> None:
    sizes = {s.size for drive in drives for s in drive.info.sources if Path(s.path) == source}
    if not source.is_file():
        raise MissingInput(
            Text("The delivered file is no longer there.", "納品ファイルが元の場所にありません。"),
            Text.same(str(source)),
            Text(
                "Put it back; its points are needed for the output.",
                "出力に必要なため、元の場所に戻してください。",
            ),
        )
    if {source.stat().st_size} != sizes:
        raise BadFile(
            Text(
                "The delivered file has changed since it was imported.",
                "納品ファイルがインポート後に変更されています。",
            ),
            Text.same(str(source)),
            Text(
                "Put the delivered one back; its points are needed for the output.",
                "出力に必要なため、納品されたファイルに戻してください。",
            ),
        )


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


def _in_file_order(drives: Sequence[Drive], source: str, monitor: Monitor) -> tuple[_Codes, _Codes]:
    """Labels and delivered classes of all points of a file, in its order."""
    mine = [
        (drive, number, one.points)
        for drive in drives
        for number, one in enumerate(drive.info.sources)
        if one.path == source
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

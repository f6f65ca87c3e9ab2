"""Per-point results from acquisition order back to the delivered files' own order."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.formats.las_results import write_results
from processing.monitor import Monitor
from processing.points.drive import Drive
from processing.project.source_check import require_delivered
from processing.text import Text
from processing.tools.tool import PointResult

_STRETCH = 4_000_000
_PARTS = {
    "normal": (("normal_x", "normal_y", "normal_z"), 127.0),
    "shape": (("linearity", "planarity", "scattering"), 255.0),
}
"""Columns of three small integers: the names of their parts in files, and what makes them 1."""

_COLOR, _SEEN = "color", "is_seen"
_SIXTEEN_BITS = np.uint16(257)
"""Makes the brightest of 8 bits the brightest of 16."""


def write_point_results(
    results: Sequence[tuple[Drive, PointResult]], output: Path, monitor: Monitor
) -> tuple[Path, ...]:
    """Write results beside the points of the files that the drives came from.

    Parameters
    ----------
    results : sequence of (Drive, PointResult)
        All drives of the input.
    output : Path
        LAS or LAZ; where there are several files, their names are added to its own.

    Returns
    -------
    tuple of Path
        One for each delivered file, its points in its order.

    Raises
    ------
    MissingInput
        A delivered file is no longer where it was.
    BadFile
        It is another one now.
    NoSpace, Cancelled
    """
    sources = _sources(results, monitor)
    paths = []
    for number, source in enumerate(sources):
        path = output
        if len(sources) > 1:
            path = output.with_name(f"{output.stem}-{source.stem}{output.suffix}")
        monitor.report(number / len(sources), _WRITING.filled(name=path.name))
        write_results(source, path, _in_file_order(results, source), monitor)
        paths.append(path)
    return tuple(paths)


_WRITING = Text("Writing {name}", "{name} を書き込み中")


def _sources(results: Sequence[tuple[Drive, PointResult]], monitor: Monitor) -> list[Path]:
    found = set()
    for drive, _ in results:
        for source in drive.info.sources:
            if source.points:
                require_delivered(source, drive.source_path(source), monitor.check)
                found.add(drive.source_path(source))
    return sorted(found)


def _in_file_order(
    results: Sequence[tuple[Drive, PointResult]], source: Path
) -> dict[str, NDArray[Any]]:
    found: dict[str, NDArray[Any]] = {}
    count = _points_of_file(results, source)
    for drive, result in results:
        paths = [drive.source_path(s) for s in drive.info.sources]
        if source not in paths:
            continue
        number = paths.index(source)
        for start in range(0, drive.count, _STRETCH):
            stretch = slice(start, min(start + _STRETCH, drive.count))
            files, indices = drive.sources(stretch.start, stretch.stop)
            own = files == number
            places = indices[own]
            for name, values in result.columns.items():
                for part, part_values in _spread(name, values[stretch][own]):
                    shape = (count, *part_values.shape[1:])
                    whole = found.setdefault(part, np.zeros(shape, part_values.dtype))
                    whole[places] = part_values
            _keep_delivered(found, drive, stretch, (own, places))
    return found


def _keep_delivered(
    found: dict[str, NDArray[Any]],
    drive: Drive,
    stretch: slice,
    chosen: tuple[NDArray[np.bool_], NDArray[np.int64]],
) -> None:
    """Where no camera saw a point it keeps the colour that it was delivered with."""
    if _COLOR not in found or not drive.columns.has(_COLOR):
        return
    own, places = chosen
    is_unseen = found[_SEEN][places] == 0
    found[_COLOR][places[is_unseen]] = drive.columns[_COLOR][stretch][own][is_unseen]


def _points_of_file(results: Sequence[tuple[Drive, PointResult]], source: Path) -> int:
    return sum(
        s.points
        for drive, _ in results
        for s in drive.info.sources
        if drive.source_path(s) == source
    )


def _spread(name: str, values: NDArray[Any]) -> list[tuple[str, NDArray[Any]]]:
    if name == "seen_color":
        return [(_COLOR, values.astype(np.uint16) * _SIXTEEN_BITS)]
    if name not in _PARTS:
        return [(name, values)]
    parts, one = _PARTS[name]
    return [(part, (values[:, axis] / one).astype(np.float32)) for axis, part in enumerate(parts)]

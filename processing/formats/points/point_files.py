"""The one door to point files: picks the reader by what a file holds, not by its name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, BadFile, UserError, report_as_user_error
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.points.delivered.delivered_floats import FloatFile, chunks_of, info_of
from processing.formats.points.delivered.point_chunk import PointChunk, PointFileInfo
from processing.formats.points.las import las
from processing.formats.points.text.text_header import ColumnsNeeded, read_heading
from processing.formats.points.text.text_points import open_text_points
from processing.formats.registry import FORMATS

__all__ = [
    "PointChunk",
    "PointFileInfo",
    "columns_needed",
    "is_las",
    "read_chunks",
    "read_info",
    "read_sample",
]

_LOOKED_AT = 4096
_LAS = "las"


def read_info(path: Path, *, columns: tuple[str, ...] = ()) -> PointFileInfo:
    """What a point file holds.

    Parameters
    ----------
    path : Path
        LAS, LAZ, COPC (only the header is read); PLY, PCD, E57, PTX, PulseWaves, text (read whole,
        as their headers don't say where the points lie).
    columns : tuple of str
        What the columns of text are, whatever it says itself; ``-`` for one to be passed over.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, is none of these, or is damaged.
    ColumnsNeeded, OutOfRange
        It is text: the file doesn't say for certain what its columns are; ``columns`` don't fit.
    """
    opener = _opener(path, columns)
    return las.read_info(path) if opener is None else info_of(opener(path))


def read_chunks(
    path: Path,
    chunk_points: int = 1_000_000,
    *,
    after: int = 0,
    columns: tuple[str, ...] = (),
) -> Iterator[PointChunk]:
    """The points of a file in its order, a chunk at a time; memory does not grow with the file.

    Parameters
    ----------
    chunk_points : int
        Points in a chunk, about.
    after : int
        Points to leave out: the first chunks of an earlier reading. Of LAS they are not decoded.
    columns : tuple of str
        As :func:`read_info`.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        As :func:`read_info`, and where the points themselves are damaged.
    """
    opener = _opener(path, columns)
    if opener is None:
        yield from las.read_chunks(path, chunk_points, after=after)
        return
    for chunk in chunks_of(opener(path), chunk_points):
        if after <= 0:
            yield chunk
        after -= chunk.count


def read_sample(
    path: Path, points: int, *, columns: tuple[str, ...] = ()
) -> dict[str, NDArray[Any]]:
    """The columns of a file's first and last points, without reading what lies between.

    Parameters
    ----------
    points : int
        About how many of either end; all points of a file that has fewer than twice as many.
        Of floating point files without times and with one scan, the first ones alone: their last
        points say no more.
    columns : tuple of str
        As :func:`read_info`.

    Returns
    -------
    dict of str to array
        Columns as :class:`PointChunk` says, in the file's order.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        As :func:`read_chunks`.
    """
    opener = _opener(path, columns)
    if opener is None:
        ends = las.read_ends(path, points)
    else:
        file = opener(path)
        info, chunks = info_of(file), chunks_of(file, points)
        is_told_by_first = not info.has_time and len(info.scanner_positions) < 2
        ends = list(islice(chunks, 2)) if is_told_by_first else _ends_of(chunks, points)
    names = ends[0].columns if ends else ()
    return {name: np.concatenate([end.columns[name] for end in ends]) for name in names}


def is_las(path: Path) -> bool:
    """Whether the file begins as LAS, LAZ and COPC do.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, or is empty.
    """
    return _opener(path) is None


def columns_needed(paths: Iterable[Path], columns: tuple[str, ...] = ()) -> ColumnsNeeded | None:
    """Why somebody must name the columns of the first text file that is not understood.

    Only beginnings are read. None where all are understood; a file that can't be read is left to
    who reads it.
    """
    for path in paths:
        try:
            if isinstance(_opener(path), partial):
                read_heading(path, columns)
        except ColumnsNeeded as needed:
            return needed
        except UserError:
            continue
    return None


def _ends_of(chunks: Iterator[PointChunk], points: int) -> list[PointChunk]:
    first = next(chunks, None)
    last: list[PointChunk] = []
    for chunk in chunks:
        last = [*last, chunk]
        while sum(c.count for c in last[1:]) >= points:
            last = last[1:]
    return [] if first is None else [first, *last]


def _opener(path: Path, columns: tuple[str, ...] = ()) -> Callable[[Path], FloatFile] | None:
    """What opens the file; None for LAS, which needs no turning into integers."""
    folder = FORMATS.folder_format(path)
    if folder is not None:
        return folder.reader(Content.POINTS)
    with report_as_user_error(path), path.open("rb") as file:
        start = file.read(_LOOKED_AT)
    if not start:
        raise BadFile(
            Text("The file is empty.", "ファイルが空です。"),
            Text.same(str(path)),
            Text(
                "Copy the file again from the delivery. {unchanged}",
                "納品データからファイルをコピーし直してください。{unchanged}",
            ).filled(unchanged=UNCHANGED),
        )
    found = FORMATS.recognised(start, Content.POINTS)
    if found is None:
        return partial(open_text_points, columns=columns)
    return None if found[0].id == _LAS else found[0].reader(Content.POINTS)

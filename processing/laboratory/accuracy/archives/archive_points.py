"""Points of an archive as the thesis takes them: first returns, thinned, their truth out of sight.

References
----------
Shinohara 2022, sections 5.2 and 5.3: first returns only, thinned to about 15 points/m².
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import laspy
import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.errors import MissingInput, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.formats.points.point_files import is_las, read_info
from processing.labels.label_column import LABEL
from processing.methods.classes.aerial_cells import spacing_m
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.columns.source_order import sources_of
from processing.recording.drive import Drive
from processing.recording.drive_part import ExtraColumns, PointFilter, write_part

CLASS = "classification"
_UNKNOWN = 1
_MOST_CODE = 255


@dataclass(frozen=True)
class ArchiveRequest:
    """Which points of a file are classified.

    Attributes
    ----------
    path : Path
        Any point file that the program imports.
    column : str
        Where its true classes are: ``classification``, or an extra dimension of LAS.
    density : float
        Points/m² that it is thinned to; 0 leaves it as it is.
    first_only : bool
        Whether later returns are left out.
    crs : str
        ``EPSG:n``; empty for the file's own.
    columns : tuple of str
        What the columns of a text file are; empty to go by the file.
    """

    path: Path
    column: str = CLASS
    density: float = 15.0
    first_only: bool = True
    crs: str = ""
    columns: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class ArchivePoints:
    """What of an archive is classified, and the rest of it.

    Attributes
    ----------
    drives : tuple of Drive
        The chosen points, all of class 1.
    truth : (n,) uint8
        Codes of the archive's own, drive after drive.
    all_xyz, all_truth : (m, 3) float64, (m,) uint8
        Of every delivered point.
    """

    drives: tuple[Drive, ...]
    truth: NDArray[np.uint8]
    all_xyz: Floats
    all_truth: NDArray[np.uint8]

    @property
    def xyz(self) -> Floats:
        """(n, 3) places of the chosen points, m."""
        return np.concatenate([one.xyz(slice(0, one.count)) for one in self.drives])


def archive_points(
    request: ArchiveRequest, into: Path, truth: NDArray[np.uint8] | None = None
) -> ArchivePoints:
    """Import an archive, choose its points and hide what they are.

    Parameters
    ----------
    into : Path
        A folder for the drives.
    truth : (m,) uint8, optional
        Of every point by the file's order, where it is not in the file.

    Raises
    ------
    UserError
        It can't be imported, has no points, or no such column.
    """
    delivered = ImportRequest((request.path,), crs=request.crs, columns=request.columns)
    imported = import_drives(delivered, into / "drives", SilentMonitor())
    drives = [one for one in map(Drive, imported) if one.count]
    if not drives:
        raise Unsuitable(
            Text("The file has no points.", "点がありません。"),
            Text.same(str(request.path)),
            Text("Choose another file.", "別のファイルを指定してください。"),
        )
    truths = _truths(request, drives, truth)
    kept = [_returns_kept(one, first_only=request.first_only) for one in drives]
    parts = _parts(drives, kept, into / "returns")
    share = _share_kept(parts, request.density)
    if share < 1.0:
        kept = [own & _drawn(one, share) for own, one in zip(kept, drives, strict=True)]
        parts = _parts(drives, kept, into / "thinned")
    return ArchivePoints(
        tuple(parts),
        np.concatenate([one[own] for one, own in zip(truths, kept, strict=True)]),
        np.concatenate([one.xyz(slice(0, one.count)) for one in drives]),
        np.concatenate(truths),
    )


def _truths(
    request: ArchiveRequest, drives: Sequence[Drive], truth: NDArray[np.uint8] | None
) -> list[NDArray[np.uint8]]:
    if truth is None and request.column == CLASS:
        _check_classes(request)
        return [np.array(one.columns[CLASS], np.uint8) for one in drives]
    if truth is None:
        truth = _las_column(request)
    found = []
    for one in drives:
        _, indices = sources_of(one.columns, one.info.source_runs, 0, one.count, sources=1)
        found.append(truth[indices])
    return found


def _check_classes(request: ArchiveRequest) -> None:
    """Refuse a file without classes: all points of its drives have the code 0."""
    attributes = read_info(request.path).attributes
    if CLASS not in attributes and CLASS not in request.columns:
        raise MissingInput(
            Text("The file has no classes of points.", "点のクラスがありません。"),
            Text.same(f"{request.path}: {', '.join(attributes)}"),
            Text(
                "Name its column with --column; of text all with --columns x,y,z,classification.",
                "--column で列を、テキストでは --columns x,y,z,classification のように"
                "全列を指定してください。",
            ),
        )


def _las_column(request: ArchiveRequest) -> NDArray[np.uint8]:
    """(m,) a column of a LAS file, in its order; what is no code becomes 0."""
    names: list[str] = []
    if is_las(request.path):
        with laspy.open(request.path) as file:
            names = list(file.header.point_format.dimension_names)
            if request.column in names:
                values = [
                    np.asarray(one[request.column], float) for one in file.chunk_iterator(10**6)
                ]
                codes = np.nan_to_num(np.concatenate(values), nan=0.0)
                return np.where((codes >= 0) & (codes <= _MOST_CODE), codes, 0).astype(np.uint8)
    raise MissingInput(
        Text(
            f"The file has no column “{request.column}”.",
            f"列「{request.column}」がありません。",
        ),
        Text.same(str(request.path)),
        Text(
            f"Use one of: {', '.join(names or [CLASS])}.",
            f"使用できる列：{', '.join(names or [CLASS])}",
        ),
    )


def _returns_kept(drive: Drive, *, first_only: bool) -> NDArray[np.bool_]:
    """(n,) which points' returns are classified; without numbers all are first ones."""
    if not (first_only and drive.columns.has("return_number")):
        return np.ones(drive.count, np.bool_)
    kept: NDArray[np.bool_] = np.asarray(drive.columns["return_number"]) <= 1
    return kept


def _share_kept(parts: Sequence[Drive], density: float) -> float:
    """Of the pulses, so that the points come to a density."""
    apart_m = spacing_m(parts)
    return density * apart_m**2 if density > 0.0 else 1.0


def _drawn(drive: Drive, share: float) -> NDArray[np.bool_]:
    """(n,) a share of the pulses by lot; the points of one time are drawn together."""
    time = np.asarray(drive.columns["time"], np.float64)
    pulse = np.arange(drive.count)
    if np.isfinite(time).all():
        pulse = np.unique(time, return_inverse=True)[1]
    taken = np.random.default_rng(0).random(int(pulse.max()) + 1) < share
    drawn: NDArray[np.bool_] = taken[pulse]
    return drawn


def _parts(drives: Sequence[Drive], kept: Sequence[NDArray[np.bool_]], into: Path) -> list[Drive]:
    return [
        write_part(
            drive,
            _filter(own),
            into / str(number),
            SilentMonitor(),
            beside=_hidden_truth(drive),
        )
        for number, (drive, own) in enumerate(zip(drives, kept, strict=True))
        if own.any()
    ]


def _filter(kept: NDArray[np.bool_]) -> PointFilter:
    def chosen(start: int, stop: int) -> NDArray[np.bool_]:
        return kept[start:stop]

    return chosen


def _hidden_truth(drive: Drive) -> ExtraColumns:
    """Columns in which no class is told: noise by its truth would be left out of the work."""

    def beside(start: int, stop: int) -> Mapping[str, NDArray[np.uint8]]:
        hidden = {CLASS: np.full(stop - start, _UNKNOWN, np.uint8)}
        if drive.columns.has(LABEL):
            hidden[LABEL] = np.zeros(stop - start, np.uint8)
        return hidden

    return beside


def in_same_order(wanted: Floats, given: Floats) -> Integers:
    """(n,) where each of some places is among others, which are the same in another order.

    Raises
    ------
    ValueError
        They are not the same.
    """
    ours, theirs = (np.lexsort(one.T) for one in (wanted, given))
    if wanted.shape != given.shape or not np.array_equal(wanted[ours], given[theirs]):
        message = f"{len(given)} places that are not the {len(wanted)} asked for"
        raise ValueError(message)
    found = np.empty(len(wanted), np.int64)
    found[ours] = theirs
    return found

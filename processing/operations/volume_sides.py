"""The two sides that ``--before`` and ``--after`` name: points, a design, or a level."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from processing.core.errors import MissingInput, Unsuitable
from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.formats.surfaces.design import read_design
from processing.methods.earthwork.surfaces.epoch_ground import ground_of_drives, has_ground
from processing.methods.earthwork.surfaces.sides import Level, Side
from processing.operations.inputs import OpenedInputs, inputs_of_paths, opened_inputs
from processing.project.project import is_project
from processing.project.work_store import WorkStore
from processing.recording.drive import Drive
from processing.recording.recorded_together import recordings_of
from processing.tools.ground import GROUND_TOOL
from processing.tools.running.run_shares import mark_all

_NAME_MARK = "#"
_FOUND = 0.7


@dataclass(frozen=True)
class VolumeSide:
    """One of the two grounds, as it is asked for: a level, or what a path names.

    Attributes
    ----------
    path : Path or None
        Point file, project with one epoch, or LandXML design; None for a level.
    surface : str
        Which surface of a design, where there are several.
    drives : tuple of str
        Ids of a project's drives that are the epoch; empty where it has one epoch only.
    level_m : float or None
        Height of a level; None for others.
    """

    path: Path | None = None
    surface: str = ""
    drives: tuple[str, ...] = ()
    level_m: float | None = None

    @staticmethod
    def of_words(words: str) -> VolumeSide:
        """What the command line says: a number is a level, ``FILE.xml#NAME`` one of several."""
        try:
            level = float(words)
        except ValueError:
            level = np.nan
        if np.isfinite(level):
            return VolumeSide(level_m=level)
        for ending in FORMATS.endings_read(Content.SURFACE):
            file, mark, name = words.rpartition(f"{ending}{_NAME_MARK}")
            if mark:
                return VolumeSide(Path(file + ending), name)
        return VolumeSide(Path(words))

    @property
    def is_design(self) -> bool:
        """Whether it is a design."""
        endings = FORMATS.endings_read(Content.SURFACE)
        return self.path is not None and self.path.suffix.lower() in endings

    @property
    def is_project(self) -> bool:
        """Whether it is an epoch of a project."""
        return self.path is not None and is_project(self.path)

    @property
    def words(self) -> str:
        """The level or the path, as it is told."""
        return str(self.path) if self.level_m is None else f"{self.level_m:g} m"


@dataclass(frozen=True)
class SideReading:
    """How points of a side are read.

    Attributes
    ----------
    crs : str
        ``EPSG:n`` where files don't name it.
    columns : tuple of str
        What the columns of text files are; empty to go by the files.
    beside : Path
        A folder on the disk that points are imported to.
    scratch : Path
        A folder for what is looked for in them.
    """

    crs: str
    columns: tuple[str, ...]
    beside: Path
    scratch: Path


@dataclass(frozen=True)
class NamedSide:
    """A side as it was given.

    Attributes
    ----------
    side : Side
    source : str
        Its file, or its level in words.
    files : tuple of Path
        What must not be overwritten.
    points : int
        Of an epoch; 0 for others.
    crs : str
        ``EPSG:n``, or empty when unknown.
    work : WorkStore or None
        What a project has for its papers; None of other sides.
    """

    side: Side
    source: str
    files: tuple[Path, ...]
    points: int
    crs: str
    work: WorkStore | None = None


@contextmanager
def named_side(asked: VolumeSide, reading: SideReading, monitor: Monitor) -> Iterator[NamedSide]:
    """The side that is asked for, opened.

    Ground is looked for in points that have none yet.

    Raises
    ------
    UserError
        It can't be read; a design without triangles; a project that holds several epochs.
    """
    path = asked.path
    if asked.level_m is not None:
        yield NamedSide(Level(asked.level_m), asked.words, (), 0, "")
    elif path is None:
        raise MissingInput(
            Text("A ground is missing.", "地盤が指定されていません。"),
            Text.same("–"),
            Text("Name a path or a level.", "ファイルまたは標高を指定してください。"),
        )
    elif asked.is_design:
        yield _read_design(path, asked.surface, monitor)
    else:
        inputs = inputs_of_paths([path], crs=reading.crs, columns=reading.columns)
        inputs = replace(inputs, drives=asked.drives)
        opening, finding = PartMonitor(monitor, 0.0, _FOUND), PartMonitor(monitor, _FOUND, 1.0)
        with opened_inputs(inputs, opening, beside=reading.beside) as opened:
            drives = _epoch(asked, path, opened)
            if not has_ground(drives):
                _find_ground(drives, reading.scratch, finding, is_kept=asked.is_project)
            ground = ground_of_drives(drives, finding, name=path.stem)
            delivered = tuple(path for drive in drives for path in drive.delivered_files)
            points = sum(drive.count for drive in drives)
            yield NamedSide(ground, str(path), delivered, points, ground.crs, opened.work)


def _read_design(path: Path, name: str, monitor: Monitor) -> NamedSide:
    design = read_design(path, name, monitor)
    return NamedSide(design.surface, str(path), (path,), 0, design.crs)


def _epoch(asked: VolumeSide, path: Path, opened: OpenedInputs) -> tuple[Drive, ...]:
    """The drives of an input; of a project those named, or the only recording."""
    if asked.drives or not asked.is_project:
        return opened.chosen
    recordings = recordings_of(opened.drives)
    if len(recordings) != 1:
        names = "; ".join(", ".join(drive.info.name for drive in one) for one in recordings)
        raise Unsuitable(
            Text("The project holds several epochs.", "プロジェクトに複数の時期があります。"),
            Text.same(f"{path}: {names}" if names else str(path)),
            Text(
                "Compare them in the window, or give the point files.",
                "画面上で比較するか、点群ファイルを指定してください。",
            ),
        )
    return recordings[0]


def _find_ground(
    drives: tuple[Drive, ...], scratch: Path, monitor: Monitor, *, is_kept: bool
) -> None:
    """Classes of points imported for the moment; a project is not changed by a command."""
    if is_kept:
        raise MissingInput(
            Text("No point is classified as ground.", "地面に分類された点がありません。"),
            Text.same(", ".join(drive.info.name for drive in drives)),
            Text(
                "Run the tool “Ground” in the project first.",
                "先にプロジェクトで「地面抽出」を実行してください。",
            ),
        )
    mark_all(GROUND_TOOL.id, drives, monitor, into=scratch / drives[0].id)

"""The two sides that ``--before`` and ``--after`` name: points, a design, or a level."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.cli.opened import opened_input
from processing.core.errors import MissingInput, Unsuitable
from processing.core.monitor import Monitor, PartMonitor
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.formats.surfaces.design import read_design
from processing.methods.earthwork.surfaces.epoch_ground import ground_of_drives, has_ground
from processing.methods.earthwork.surfaces.sides import Level, Side
from processing.operations.inputs import OpenedInputs
from processing.project.project import is_project
from processing.project.work_store import WorkStore
from processing.recording.drive import Drive
from processing.recording.recorded_together import recordings_of
from processing.tools.ground import GROUND_TOOL
from processing.tools.run_shares import mark_all

_NAME_MARK = "#"
_FOUND = 0.7


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


def is_level(words: Path) -> bool:
    """Whether a side is a level."""
    return _level_of(str(words)) is not None


def is_design(words: Path) -> bool:
    """Whether a side is a design."""
    return _design_of(words) is not None


@contextmanager
def named_side(
    words: Path, arguments: argparse.Namespace, scratch: Path, monitor: Monitor
) -> Iterator[NamedSide]:
    """The side that some words name: a number is a level, ``.xml`` a design, else points.

    Of a design with several surfaces the one is taken whose name stands behind ``#``. Ground
    is looked for in points that have none yet.

    Raises
    ------
    UserError
        It can't be read; a design without triangles; a project that holds several epochs.
    """
    level = _level_of(str(words))
    if level is not None:
        yield NamedSide(Level(level), f"{level:g} m", (), 0, "")
    elif (design := _design_of(words)) is not None:
        yield _read_design(*design, monitor)
    else:
        one = argparse.Namespace(
            inputs=[words],
            trajectory=[],
            images=[],
            crs=arguments.crs,
            columns=arguments.columns,
            output=arguments.output,
        )
        opening, finding = PartMonitor(monitor, 0.0, _FOUND), PartMonitor(monitor, _FOUND, 1.0)
        with opened_input(one, opening) as opened:
            drives = _epoch(words, opened)
            if not has_ground(drives):
                _find_ground(drives, scratch, finding, is_kept=is_project(words))
            ground = ground_of_drives(drives, finding, name=words.stem)
            delivered = tuple(path for drive in drives for path in drive.delivered_files)
            points = sum(drive.count for drive in drives)
            yield NamedSide(ground, str(words), delivered, points, ground.crs, opened.work)


def _level_of(words: str) -> float | None:
    try:
        level = float(words)
    except ValueError:
        return None
    return level if np.isfinite(level) else None


def _design_of(words: Path) -> tuple[Path, str] | None:
    """A design's file and the name of its surface, empty for the only one."""
    endings = FORMATS.endings_read(Content.SURFACE)
    if words.suffix.lower() in endings:
        return words, ""
    for ending in endings:
        file, mark, name = str(words).rpartition(f"{ending}{_NAME_MARK}")
        if mark:
            return Path(file + ending), name
    return None


def _read_design(path: Path, name: str, monitor: Monitor) -> NamedSide:
    design = read_design(path, name, monitor)
    return NamedSide(design.surface, str(path), (path,), 0, design.crs)


def _epoch(words: Path, opened: OpenedInputs) -> tuple[Drive, ...]:
    """The drives of an input; of a project the only recording."""
    if not is_project(words):
        return opened.drives
    recordings = recordings_of(opened.drives)
    if len(recordings) != 1:
        names = "; ".join(", ".join(drive.info.name for drive in one) for one in recordings)
        raise Unsuitable(
            Text("The project holds several epochs.", "プロジェクトに複数の時期があります。"),
            Text.same(f"{words}: {names}" if names else str(words)),
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

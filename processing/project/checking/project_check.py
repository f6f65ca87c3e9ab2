"""A whole project checked, and repaired where that is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack, closing, suppress
from pathlib import Path

from processing.core.errors import BadFile, MissingInput, UserError
from processing.core.monitor import Monitor, PartMonitor, parts_of
from processing.core.owned_files import is_link
from processing.core.text import Text
from processing.project.checking.drive_check import (
    check_files,
    opening_findings,
    unknown_findings,
)
from processing.project.checking.drive_repair import repair_drive
from processing.project.checking.findings import CheckReport, FileFinding
from processing.project.checking.map_check import map_findings
from processing.project.checking.rebuilt_drive import Rebuilding
from processing.project.project import OWN, Project, is_project
from processing.project.store.drive_folders import DRIVES
from processing.project.store.no_links import refuse_links
from processing.project.store.project_lock import ProjectLock
from processing.recording.drive import Drive
from processing.recording.drive_files import sum_drive
from processing.recording.file_locations import FolderMove

_CHECKING = Text("Checking {name}", "{name} を検査中")
_MAKING = Text("Repairing {name}", "{name} を修復中")


def check_project(folder: Path, monitor: Monitor, *, is_repairing: bool = False) -> CheckReport:
    """Say what is damaged in a project, and make again what can be made again.

    The map is read, never changed.

    Parameters
    ----------
    is_repairing : bool
        Files that can be made again are, and files without checksums get some.

    Raises
    ------
    MissingInput
        There is no project.
    InUse
        It is to be repaired and is open elsewhere, or there is a link in it.
    Cancelled, NoSpace
        What was repaired so far is whole.
    """
    folder = folder.absolute()
    if not (is_project(folder) or (folder / DRIVES).is_dir()):
        raise _no_project(folder)
    refuse_links(folder, OWN)
    findings: list[FileFinding] = []
    with ExitStack() as stack:
        if is_repairing:
            _settle(folder)
            stack.callback(ProjectLock(folder).release)
        drives = _drive_folders(folder)
        moves = _moves(folder, drives, monitor) if is_repairing else ()
        files = 1
        for drive, part in zip(drives, parts_of(monitor, [1.0] * len(drives)), strict=True):
            part.report(0.0, _CHECKING.filled(name=drive.name))
            checked = check_files(drive, PartMonitor(part, 0.0, 0.4 if is_repairing else 1.0))
            files += checked.files
            if is_repairing:
                part.report(0.4, _MAKING.filled(name=drive.name))
                rebuilding = Rebuilding(drive, moves, PartMonitor(part, 0.4, 1.0))
                findings += repair_drive(folder, checked.damaged, rebuilding)
                sum_drive(drive, part.check)
            else:
                findings += (one.finding(folder) for one in checked.damaged)
                findings += unknown_findings(checked, folder)
            if is_repairing or not checked.damaged:
                findings += opening_findings(drive, folder)
        monitor.check()
        findings += map_findings(folder)
    return CheckReport(tuple(findings), files)


def _drive_folders(folder: Path) -> list[Path]:
    """The folders of the project's drives; all there are where the database doesn't tell."""
    home = folder / DRIVES
    try:
        with closing(Project.open(folder, writing=False)) as project:
            return [path for path in project.drive_folders if path.is_dir()]
    except UserError:
        found = home.iterdir() if home.is_dir() and not is_link(home) else ()
        return sorted(path for path in found if path.is_dir() and not is_link(path))


def _settle(folder: Path) -> None:
    """Do what opening the project does after a kill; what is damaged is told later."""
    try:
        Project.open(folder).close()
    except (BadFile, MissingInput):
        return


def _moves(folder: Path, drives: Sequence[Path], monitor: Monitor) -> tuple[FolderMove, ...]:
    """Where the folders of delivered files are now."""
    opened = []
    for path in drives:
        with suppress(UserError):
            opened.append(Drive(path))
    try:
        with closing(Project.open(folder, writing=False)) as project:
            return project.sources.survey(opened).moves_found(monitor.check)
    except UserError:
        return ()


def _no_project(folder: Path) -> MissingInput:
    return MissingInput(
        Text("There is no project here.", "ここにプロジェクトはありません。"),
        Text.same(str(folder)),
        Text("Choose a project's folder.", "プロジェクトのフォルダを選んでください。"),
    )

"""What the document has done in the background: the work itself, and what is said of it.

Each function gives a job's title and its work; the work touches neither the project nor a widget.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from pathlib import Path

from app.document.import_words import adding_words
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.image.images_of_drives import image_of
from processing.operations.export import ExportRequest, export
from processing.operations.finished_runs import FinishedRun
from processing.operations.inputs import OpenedInputs
from processing.operations.run import RunFolders, RunOperation, finish_runs
from processing.project.additions import Additions, bring_in, home_of
from processing.project.importing.import_request import ImportRequest
from processing.project.project import Project
from processing.recording.drive import Drive
from processing.tools.runner import tool_of

_LONG_POINTS = 10_000_000


def import_work(
    request: ImportRequest, project: Project, only: Collection[str]
) -> tuple[Text, Callable[[Monitor], Additions]]:
    """Delivered files become drives of a project or complete them; what was killed goes on.

    Parameters
    ----------
    only : collection of str
        As of :func:`processing.project.additions.bring_in`.
    """
    home = home_of(project)

    def work(monitor: Monitor) -> Additions:
        brought = bring_in(request, home, monitor, only=only)
        for folder in (*brought.folders, *(one.folder for one in brought.completed)):
            drive = Drive(folder)
            prepare_images(drive, monitor)
            _prepare_tiles(drive, monitor)
        return brought

    return adding_words(request), work


def run_work(
    operation: RunOperation,
    opened: OpenedInputs,
    folders: Sequence[RunFolders],
    begin: Callable[[], None],
) -> tuple[Text, Callable[[Monitor], tuple[FinishedRun, ...]]]:
    """A tool is run on drives of a project.

    Parameters
    ----------
    folders, begin
        As of :func:`processing.operations.run.finish_runs`.
    """
    title = Text("{tool}: {name}", "{tool}: {name}").filled(
        tool=tool_of(operation.tool).name, name=", ".join(one.info.name for one in opened.chosen)
    )
    return title, lambda monitor: finish_runs(operation, opened, folders, monitor, begin=begin)


def export_work(
    project: Project, request: ExportRequest
) -> tuple[Text, Callable[[Monitor], tuple[Path, ...]]]:
    """The map as it is now is written to files."""
    features = tuple(project.features.all())
    catalogue, crs = project.catalogue, project.crs
    delivered = tuple(path for drive in project.drives for path in drive.delivered_files)
    request, drives = replace(request, never=delivered), project.drives

    def work(monitor: Monitor) -> tuple[Path, ...]:
        return export(features, catalogue, crs, request, monitor, drives=drives)

    return Text("Export", "書き出し"), work


def exported_words(paths: Sequence[Path], folder: Path) -> Text:
    """What is said after an export."""
    reported = Text(
        "Exported {count} files to {folder}", "{folder} に{count}個のファイルを書き出しました"
    )
    return reported.filled(count=len(paths), folder=folder)


def prepare_images(drive: Drive, monitor: Monitor) -> None:
    """Note the rows of all images of a long drive, which a window would have to look for.

    They are found while the recording is still in the system's memory; those of a short drive are
    found before anybody notices.
    """
    if drive.count < _LONG_POINTS:
        return
    for kind in drive.image_kinds:
        monitor.check()
        monitor.report(1.0, kind.title)
        image_of(drive, kind)


def _prepare_tiles(drive: Drive, monitor: Monitor) -> None:
    """Note where the tiles of the first image are, so that the window need not look for them."""
    if drive.count:
        image_of(drive, drive.image_kinds[0]).pyramid.prepare(monitor)

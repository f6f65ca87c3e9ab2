"""What the document has done in the background: the work itself, and what is said of it.

Each function gives a job's title and its work; the work touches neither the project nor a widget.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from pathlib import Path

from app.document.import_words import adding_words
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.image.images_of_drives import image_of
from processing.operations.import_files import bring_prepared
from processing.operations.inputs import OpenedInputs
from processing.operations.new_points import NewPointsOperation, make_points
from processing.operations.project_export import WrittenFiles
from processing.operations.run import RunFolders, RunOperation, finish_runs
from processing.operations.runs.finished_runs import FinishedRun
from processing.project.additions import Additions, home_of
from processing.project.importing.import_request import ImportRequest
from processing.project.project import Project
from processing.recording.drive import Drive
from processing.tools.listed.registry import POINT_MAKERS
from processing.tools.running.runner import tool_of

_TOOL_AND_DRIVE = Text("{tool}: {name}", "{tool}: {name}")


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
        brought = bring_prepared(request, home, monitor, only=only)
        for folder in (*brought.folders, *(one.folder for one in brought.completed)):
            _prepare_tiles(Drive(folder), monitor)
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
    title = _TOOL_AND_DRIVE.filled(
        tool=tool_of(operation.tool).name, name=", ".join(one.info.name for one in opened.chosen)
    )
    return title, lambda monitor: finish_runs(operation, opened, folders, monitor, begin=begin)


def points_work(
    operation: NewPointsOperation, drive: Drive
) -> tuple[Text, Callable[[Monitor], Path]]:
    """A tool writes points of its own to a file."""
    title = _TOOL_AND_DRIVE.filled(tool=POINT_MAKERS[operation.tool].name, name=drive.info.name)
    return title, lambda monitor: make_points(operation, monitor)


def written_words(path: Path) -> Text:
    """What is said after points were written to a file."""
    return Text("Wrote {path}", "{path} を書き出しました").filled(path=path)


def exported_words(written: WrittenFiles, folder: Path) -> Text:
    """What is said after an export: how many files, and what they hold otherwise than the map."""
    reported = Text(
        "Exported {count} files to {folder}", "{folder} に{count}個のファイルを書き出しました"
    )
    reported = reported.filled(count=len(written.paths), folder=folder)
    for note in written.notes:
        reported = Text("{told}. {note}", "{told}。{note}").filled(told=reported, note=note)
    return reported


def _prepare_tiles(drive: Drive, monitor: Monitor) -> None:
    """Note where the tiles of the first image are, so that the window need not look for them."""
    if drive.count:
        image_of(drive, drive.image_kinds[0]).pyramid.prepare(monitor)

"""What a tool's run gave, on its way from a worker's thread into a project."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

from processing.core.block_sums import keep_sums
from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor
from processing.core.owned_files import make_marked, remove_folder
from processing.core.safe_write import refuse_inputs
from processing.methods.ground.stored_surface import FILE_NAME as SURFACE
from processing.methods.ground.stored_surface import StoredSurface, copy_surface
from processing.project.photos import photo_folder, write_photos
from processing.project.results.found_classes import found_classes
from processing.project.results.found_features import FoundFeatures, found_features
from processing.project.results.run_findings import adopt_finding, write_finding, write_given
from processing.project.results.surface_files import delivered_files, surface_file_of, write_surface
from processing.project.store.exchanged_files import NewStepFiles
from processing.recording.columns.columns import column_path
from processing.recording.drive import Drive
from processing.tools.running.runner import RunRequest, drives_of, run, run_together, tool_of
from processing.tools.tool import CandidateResult, FinishedColumns

_CLASS = "classification"
_PHOTOS = "photos"
_BESIDE = "+"
"""Between a drive's id and the name of a column that it is to have."""


@dataclass(frozen=True)
class FinishedRun:
    """Columns for the drive, or candidates for the map and labels for points.

    Attributes
    ----------
    columns : FinishedColumns or None
        In a folder on the drive's disk; None for a tool that finds candidates or classes.
    found : FoundFeatures or None
        The run with its candidates or labels; None for a tool that makes columns.
    kept : Path or None
        A folder with what the drives keep of the run beside its labels.
    drive : str
        Id of the drive that the columns are of.
    """

    columns: FinishedColumns | None = None
    found: FoundFeatures | None = None
    kept: Path | None = None
    drive: str = ""

    def keep_with(self, drive_of: Callable[[str], Drive], files: NewStepFiles) -> None:
        """Keep what the run said of its drives' points, columns, the surface it found, pictures.

        Parameters
        ----------
        files : NewStepFiles
            Gets the surface and the columns, which take the places of older ones, and pictures.

        Raises
        ------
        NoSpace, InUse
        """
        if self.found is None or self.kept is None:
            return
        try:
            photos, surface = self.kept / _PHOTOS, self.kept / SURFACE
            if photos.is_dir():
                files.give(photos, photo_folder(self.found.run.id))
            for drive in (drive_of(id_) for id_ in self.found.run.drives):
                said = self.kept / drive.id
                if said.is_file():
                    adopt_finding(drive, self.found.tool, self.found.run.id, said)
                for column in sorted(self.kept.glob(f"{drive.id}{_BESIDE}*.bin")):
                    name = column.name.removeprefix(f"{drive.id}{_BESIDE}")
                    files.give(column, name, drive.id)
                if surface.is_file():
                    copied = files.expect(SURFACE, drive.id)
                    copy_surface(surface, copied)
                    with report_as_user_error(copied):
                        keep_sums(copied)
        finally:
            remove_folder(self.kept)

    def remove(self) -> None:
        """Nothing comes of it: its files go."""
        if self.columns is not None:
            self.columns.remove()
        folders = [] if self.kept is None else [self.kept]
        if self.found is not None and self.found.change.filed is not None:
            folders.append(self.found.change.filed.folder)
        for folder in folders:
            remove_folder(folder)


def finish_run(
    request: RunRequest,
    into: Path,
    monitor: Monitor,
    *,
    labels_into: Path,
    begin: Callable[[], None],
) -> FinishedRun:
    """Run a tool and make of what it gives what the project stores; for a worker's thread.

    Parameters
    ----------
    into : Path
        A new folder on the drive's disk, for columns.
    labels_into : Path
        A new folder of the project, for labels of many points.
    begin : callable
        Called when labels are looked at first: what is painted later counts more than the run.

    Raises
    ------
    UserError
        As :func:`processing.tools.running.runner.run`; `Cancelled`.
    """
    started = datetime.now(UTC)
    tool, parameters = tool_of(request.tool), request.parameters
    if tool.gives_classes:
        return _classes(request, into, monitor, started, _Labels(labels_into, begin))
    result = run(request, monitor, into=into)
    if isinstance(result, CandidateResult):
        times = {"started": started, "finished": datetime.now(UTC)}
        drives = [drive.id for drive in drives_of(request)]
        return with_photos(found_features(result, tool, parameters, drives, **times), into)
    return FinishedRun(columns=result, drive=request.drive.id)


def with_photos(found: FoundFeatures, into: Path) -> FinishedRun:
    """Candidates, their pictures written to files beside a folder on the project's disk.

    Raises
    ------
    NoSpace
    """
    if not found.pictures:
        return FinishedRun(found=found)
    kept = into.with_name(f"{into.name}-kept")
    try:
        with report_as_user_error(kept):
            make_marked(kept)
            (kept / _PHOTOS).mkdir()
        write_photos(found.pictures, kept / _PHOTOS)
    except BaseException:
        remove_folder(kept)
        raise
    return FinishedRun(found=replace(found, pictures={}), kept=kept)


@dataclass(frozen=True)
class _Labels:
    into: Path
    begin: Callable[[], None]


def _classes(
    request: RunRequest, into: Path, monitor: Monitor, started: datetime, labels: _Labels
) -> FinishedRun:
    """Labels for the points of all drives that the run is about."""
    tool, drives = tool_of(request.tool), drives_of(request)
    surface_file = surface_file_of(request.parameters)
    if surface_file is not None:
        refuse_inputs(surface_file, delivered_files(drives, request.beside))
    together = run_together(request, monitor, into=into)
    kept = into.with_name(f"{into.name}-kept")
    try:
        with report_as_user_error(kept):
            make_marked(kept)
            for file in together.kept:
                file.replace(kept / file.name)
        results = list(zip(drives, together.columns, strict=True))
        if tool.asked is not None:
            for drive, result in results:
                write_finding(result, tool.asked.codes, kept / drive.id)
        if surface_file is not None:
            write_surface(
                StoredSurface(kept / SURFACE), surface_file, delivered_files(drives), monitor
            )
        labels.begin()
        if tool.asked is None:
            for drive, result in results:
                write_given(drive, result, kept / drive.id)
                _keep_columns(drive, result, kept)
        found = found_classes(
            results,
            tool,
            request.parameters,
            labels.into,
            monitor,
            started=started,
            finished=datetime.now(UTC),
            note=together.note,
        )
    except BaseException:
        remove_folder(kept)
        raise
    finally:
        remove_folder(into)
    return FinishedRun(found=found, kept=kept)


def _keep_columns(drive: Drive, result: FinishedColumns, kept: Path) -> None:
    """Keep what a tool says of points beside their classes, for the drive to have as columns."""
    for name in result.names:
        if name != _CLASS:
            file = column_path(result.folder, name)
            place = kept / f"{drive.id}{_BESIDE}{file.name}"
            with report_as_user_error(place):
                file.replace(place)
                keep_sums(place)

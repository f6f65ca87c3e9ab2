"""What an operation works on, by path and identity: a project's drives, or delivered files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from processing.core.errors import MissingInput, OutOfRange, use_one_of
from processing.core.monitor import Monitor
from processing.core.scratch_folder import scratch_folder
from processing.core.text import Text
from processing.map.catalogue import Catalogue
from processing.map.catalogue_file import read_catalogue
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.project.project import Project, is_project
from processing.project.work_store import WorkStore
from processing.recording.drive import Drive
from resources import path_of


@dataclass(frozen=True)
class OperationInputs:
    """A project, or delivered files.

    Attributes
    ----------
    project : Path or None
        A project's folder; None for delivered files.
    drives : tuple of str
        Ids of the project's drives that it is for; empty for all of them.
    points : tuple of Path
        Point files, where no project is named.
    trajectories, images : tuple of Path
    crs : str
        ``EPSG:n`` of the files; empty to take their own.
    columns : tuple of str
        What the columns of text files are; empty to go by the files.
    """

    project: Path | None = None
    drives: tuple[str, ...] = ()
    points: tuple[Path, ...] = ()
    trajectories: tuple[Path, ...] = ()
    images: tuple[Path, ...] = ()
    crs: str = ""
    columns: tuple[str, ...] = ()

    @property
    def request(self) -> ImportRequest:
        """The import of the delivered files."""
        return ImportRequest(
            self.points, self.trajectories, self.images, self.crs, columns=self.columns
        )


@dataclass(frozen=True)
class OpenedInputs:
    """What an operation works on, opened.

    Attributes
    ----------
    drives : tuple of Drive
        All there are.
    chosen : tuple of Drive
        Those that the operation is for.
    crs : str
        ``EPSG:n``, or empty when unknown.
    catalogue : Catalogue
        The project's own, or the one that comes with the program.
    work : WorkStore or None
        What a project has for its papers; None without one.
    project : Path or None
        Its folder; None for delivered files.
    """

    drives: tuple[Drive, ...]
    chosen: tuple[Drive, ...]
    crs: str
    catalogue: Catalogue
    work: WorkStore | None = None
    project: Path | None = None

    @property
    def beside(self) -> tuple[Drive, ...]:
        """The drives that the operation isn't for."""
        return tuple(drive for drive in self.drives if drive not in self.chosen)

    @property
    def delivered(self) -> list[Path]:
        """The files that the drives came from, which nothing may overwrite."""
        return [path for drive in self.drives for path in drive.delivered_files]


def inputs_of_paths(
    paths: Sequence[Path],
    *,
    trajectories: Sequence[Path] = (),
    images: Sequence[Path] = (),
    crs: str = "",
    columns: Sequence[str] = (),
) -> OperationInputs:
    """What paths name: one project's folder, or point files.

    Raises
    ------
    MissingInput
        A project is among several paths.
    """
    if not any(is_project(path) for path in paths):
        return OperationInputs(
            points=tuple(paths),
            trajectories=tuple(trajectories),
            images=tuple(images),
            crs=crs,
            columns=tuple(columns),
        )
    if len(paths) > 1:
        raise MissingInput(
            Text("A project can only be given alone.", "プロジェクトは単独で指定してください。"),
            Text.same(", ".join(str(path) for path in paths)),
            Text(
                "Name one project, or point files.",
                "1つのプロジェクトか点群ファイルを指定してください。",
            ),
        )
    return OperationInputs(project=paths[0])


@contextmanager
def opened_inputs(
    inputs: OperationInputs, monitor: Monitor, *, beside: Path
) -> Iterator[OpenedInputs]:
    """The drives that an operation works on; what is imported for it is removed afterwards.

    A project is read only.

    Parameters
    ----------
    beside : Path
        A folder on the disk that files are imported to: a system's temporary folder is often small.

    Raises
    ------
    UserError
        For inputs that can't be read.
    """
    if inputs.project is not None:
        with opened_project(inputs.project, writing=False) as project:
            work = WorkStore(project.settings)
            yield inputs_in(project, inputs.drives, work=work)
        return
    with scratch_folder(beside) as folder:
        folders = import_drives(inputs.request, folder / "drives", monitor)
        drives = tuple(Drive(path) for path in folders)
        crs = next((drive.info.crs for drive in drives if drive.info.crs), "")
        catalogue = read_catalogue(path_of("catalogue/level500.toml"))
        yield OpenedInputs(drives, drives, crs, catalogue)


@contextmanager
def opened_project(folder: Path, *, writing: bool) -> Iterator[Project]:
    """A project whose delivered files were looked for; closed afterwards.

    Raises
    ------
    MissingInput, BadFile, InUse, NoSpace
        As :meth:`Project.open`.
    """
    project = Project.open(folder, writing=writing)
    try:
        project.find_sources()
        yield project
    finally:
        project.close()


def inputs_in(
    project: Project, ids: Sequence[str] = (), *, work: WorkStore | None = None
) -> OpenedInputs:
    """The drives of an open project, and those that an operation is for.

    Raises
    ------
    OutOfRange
        The project has no drive of an id.
    MissingInput, BadFile
        All are asked for, and one of them can't be opened.
    """
    known = {drive.id: drive for drive in project.drives}
    # What is found on some drives only would look like all there is.
    for error in () if ids else project.damaged_drives.values():
        raise error
    for id_ in ids:
        if id_ not in known:
            raise OutOfRange(
                Text("The project has no such drive.", "プロジェクトにない走行データです。"),
                Text.same(f"{project.folder}: {id_}"),
                use_one_of(known),
            )
    chosen = tuple(known[id_] for id_ in ids) or project.drives
    return OpenedInputs(
        project.drives, chosen, project.crs, project.catalogue, work, project.folder
    )

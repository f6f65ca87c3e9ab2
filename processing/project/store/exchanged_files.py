"""ExchangedFiles: files of an open project that steps of its history exchange for others.

The database is written first; the files follow, each by a rename or two. After a kill between
the two, opening the project goes on with them: to do it twice does no harm.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import replace
from pathlib import Path
from uuid import uuid4

from processing.core.block_sums import bring_sums, place_with_sums
from processing.core.errors import UserError, report_as_user_error
from processing.core.owned_files import is_link, make_marked, refuse_link, remove_marked
from processing.map.step_files import STEP_FILES, StepFile, StepFiles
from processing.recording.columns.columns import column_path
from processing.recording.columns.replacing import flush_names
from processing.recording.drive import Drive


class NewStepFiles:
    """A step's folder that is being filled.

    Parameters
    ----------
    folder : Path
        New; on the project's disk.
    place_of : callable
        Where a file is that counts.
    """

    def __init__(self, folder: Path, place_of: Callable[[StepFile], Path]) -> None:
        self._folder = folder
        self._place_of = place_of
        self._files: list[StepFile] = []

    def expect(self, name: str, drive: str = "") -> Path:
        """Where to put a file that is to have a name of its drive's, or of the project's, folder.

        Raises
        ------
        NoSpace
        """
        path = self._listed(StepFile(name, drive))
        with report_as_user_error(path):
            if not self._folder.exists():
                make_marked(self._folder)
            path.parent.mkdir(parents=True, exist_ok=True)
        return path

    def give(self, file: Path, name: str, drive: str = "") -> None:
        """Move a file or a folder here that is to have a name of its drive's, or the project's.

        Raises
        ------
        NoSpace, MissingInput, InUse
        """
        path = self.expect(name, drive)
        with report_as_user_error(path):
            file.rename(path)
            bring_sums(file, path)

    def take_away(self, name: str, drive: str = "") -> None:
        """Let there be no file of a name any more.

        Raises
        ------
        NoSpace
        """
        with report_as_user_error(self._folder):
            if not self._folder.exists():
                make_marked(self._folder)
        self._listed(StepFile(name, drive, is_after=False))

    def files(self) -> StepFiles | None:
        """For a change; None where there are none."""
        return StepFiles(self._folder, tuple(self._files)) if self._files else None

    def _listed(self, file: StepFile) -> Path:
        place = self._place_of(file)
        is_before = place.exists() and not is_link(place)
        self._files.append(replace(file, is_before=is_before))
        return StepFiles(self._folder, ()).coming(file)


class ExchangedFiles:
    """Moves files of steps to their places and back.

    Parameters
    ----------
    project : Path
        Its folder.
    drive_of : callable
        From an id to the open drive; KeyError when there is none.
    """

    def __init__(self, project: Path, drive_of: Callable[[str], Drive]) -> None:
        self._project = project
        self._drive_of = drive_of

    def new(self) -> NewStepFiles:
        """For the files of a new step; what no step names goes when the project is closed."""
        return NewStepFiles(self._project / STEP_FILES / uuid4().hex, self._place_of)

    def exchange(self, files: StepFiles) -> None:
        """Let files take the places of others, which are kept.

        Raises
        ------
        NoSpace, InUse, MissingInput
            All are where they were, as far as the system still moves anything.
        """
        done: list[StepFile] = []
        try:
            for file in files.files:
                self._exchange(files, file)
                done.append(file)
        except UserError:
            back = replace(files.inverse(), files=tuple(reversed(done)))
            with suppress(UserError):
                for file in back.files:
                    self._exchange(back, file)
            raise

    def follow(self, files: StepFiles) -> None:
        """Exchange what a killed program left where it was; a drive that is gone is left out."""
        for file in files.files:
            with suppress(UserError, KeyError):
                self._exchange(files, file)

    def remove_unlisted(self, listed: Collection[str]) -> None:
        """Remove the folders that no step names which could be taken back or done again."""
        steps = self._project / STEP_FILES
        with suppress(OSError):
            for folder in () if is_link(steps) else tuple(steps.iterdir()):
                if folder.name not in listed:
                    remove_marked(folder, self._project)

    def _exchange(self, files: StepFiles, file: StepFile) -> None:
        place, coming, leaving = self._place_of(file), files.coming(file), files.leaving(file)
        with report_as_user_error(place):
            comes = coming.exists()
            # What is kept already went before a kill; what has the place now came later.
            leaves = place.exists() and (comes or not files.comes(file)) and not leaving.exists()
            if leaves or comes:
                self._refuse_links(coming, leaving, place)
                with self._replacing(file):
                    _exchange_files(place, coming if comes else None, leaving if leaves else None)
                # The next step's note replaces this one's: by then the new names must be safe.
                flush_names(place.parent)

    def _refuse_links(self, *paths: Path) -> None:
        """Nothing is moved through a link; a column may be one itself."""
        for path in paths:
            if path.is_dir():
                refuse_link(path)
            for folder in path.parents[: len(path.relative_to(self._project).parts) - 1]:
                refuse_link(folder)

    def _place_of(self, file: StepFile) -> Path:
        home = self._drive_of(file.drive).folder if file.drive else self._project
        return home / file.name

    def _replacing(self, file: StepFile) -> AbstractContextManager[None]:
        if file.drive:
            drive, name = self._drive_of(file.drive), Path(file.name).stem
            if column_path(drive.folder, name).name == file.name:
                return drive.columns.replacing(name)
        return nullcontext()


def _exchange_files(place: Path, coming: Path | None, leaving: Path | None) -> None:
    """Move the file that has a place away, or another one there; or both, or neither of them."""
    if leaving is not None:
        if is_link(place):
            # A column that somebody keeps on another disk stays there.
            if coming is None:
                place.unlink()
        else:
            leaving.parent.mkdir(parents=True, exist_ok=True)
            bring_sums(place, leaving)
            place.rename(leaving)
    if coming is None:
        return
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        place_with_sums(coming, place)
    except OSError:
        if leaving is not None and leaving.exists():
            leaving.rename(place)
            bring_sums(leaving, place)
        raise

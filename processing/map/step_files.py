"""StepFiles: files of a project that a step exchanges for others, both kept beside it.

Columns that a tool made, a list of images or the folder of a volume are too large for the database:
it names them, and those that don't count lie in the step's folder until undo or redo wants them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Any

STEP_FILES = "step_files"
"""Folder of a project: a folder for each step."""

_PROJECT = "project"


@dataclass(frozen=True)
class StepFile:
    """A file, or a folder, that is another one before and after.

    Attributes
    ----------
    name : str
        Its way from the folder of its drive, or of the project, with slashes.
    drive : str
        Id of the drive that it belongs to; empty for the project itself.
    is_before, is_after : bool
        Whether there is one before, and after.
    """

    name: str
    drive: str = ""
    is_before: bool = False
    is_after: bool = True


@dataclass(frozen=True)
class StepFiles:
    """The files that a step exchanges.

    Attributes
    ----------
    folder : Path
        Where those lie that don't count.
    files : tuple of StepFile
    is_inverse : bool
        Whether those before take the places of those after.
    """

    folder: Path
    files: tuple[StepFile, ...]
    is_inverse: bool = False

    @property
    def drives(self) -> tuple[str, ...]:
        """Ids of the drives to which files belong."""
        return tuple(dict.fromkeys(one.drive for one in self.files if one.drive))

    def names_of(self, drive: str) -> tuple[str, ...]:
        """Names of the files of one drive; of the project itself where it is empty."""
        return tuple(one.name for one in self.files if one.drive == drive)

    def coming(self, file: StepFile) -> Path:
        """Where a file lies that takes its place."""
        return _path_in(self.folder, file, is_after=not self.is_inverse)

    def leaving(self, file: StepFile) -> Path:
        """Where the file goes that has its place now."""
        return _path_in(self.folder, file, is_after=self.is_inverse)

    def comes(self, file: StepFile) -> bool:
        """Whether there is one once this is done."""
        return file.is_before if self.is_inverse else file.is_after

    def inverse(self) -> StepFiles:
        """What takes this back."""
        return replace(self, is_inverse=not self.is_inverse)


def step_files_to_plain(files: StepFiles) -> dict[str, object]:
    """What the history remembers: the folder's name, and what is exchanged."""
    listed = [[one.drive, one.name, one.is_before, one.is_after] for one in files.files]
    return {"folder": files.folder.name, "listed": listed}


def step_files_of_plain(stored: Mapping[str, Any], steps: Path) -> StepFiles:
    """The files of :func:`step_files_to_plain`; ``Any`` since it is JSON.

    Parameters
    ----------
    steps : Path
        The project's folder of such folders.

    Raises
    ------
    ValueError, KeyError, TypeError
        It is damaged.
    """
    folder = str(stored["folder"])
    listed = tuple(
        StepFile(str(name), str(drive), bool(is_before), bool(is_after))
        for drive, name, is_before, is_after in stored["listed"]
    )
    ways = [PurePosixPath(one.name) for one in listed]
    names = [folder, *(one.drive for one in listed if one.drive)]
    leads_out = any(way.is_absolute() or ".." in way.parts or not way.parts for way in ways)
    if leads_out or any(Path(name).name != name for name in names):
        message = f"files {stored}"
        raise ValueError(message)
    return StepFiles(steps / folder, listed)


def _path_in(folder: Path, file: StepFile, *, is_after: bool) -> Path:
    side = folder / ("after" if is_after else "before")
    return side / (f"drive-{file.drive}" if file.drive else _PROJECT) / file.name

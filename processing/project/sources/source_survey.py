"""SourceSurvey: looks where delivered files and camera images are; touches no project.

File systems may take their time, so this runs beside the window's thread.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from processing.core.errors import UserError
from processing.project.sources.source_check import CancelCheck, FileState, state_of
from processing.recording.drive_info import SourceFile
from processing.recording.file_locations import FolderMove, below, beside, folder_of, name_of

_ALIKE = 2
FileStamp = tuple[int, int]
"""Size and date (ns) of a file that was read whole and found to be the delivered one."""


@dataclass(frozen=True)
class NotedDrive:
    """What a drive notes of files outside the project.

    Attributes
    ----------
    sources : tuple of SourceFile
        Those that points came from.
    images : tuple of str
        Paths as noted.
    home : str
        Where the project was when it got the drive; empty when that isn't known.
    """

    id: str
    name: str
    sources: tuple[SourceFile, ...]
    images: tuple[str, ...]
    home: str


@dataclass(frozen=True)
class FileProblem:
    """A noted file that is missing or is another one now.

    Attributes
    ----------
    drives : tuple of str
        Ids of those that note it.
    noted, path : str, Path
        As noted, and where it was looked for.
    is_image : bool
        A camera image; else a file of points.
    """

    drives: tuple[str, ...]
    noted: str
    path: Path
    state: FileState
    is_image: bool = False


@dataclass(frozen=True)
class SurveyResult:
    """Where folders are now, and what isn't there.

    Attributes
    ----------
    moves : tuple of FolderMove
        For folders that are elsewhere than noted.
    stamps : mapping of str to FileStamp
        Files that were compared by their checksum and are the delivered ones, by checksum and
        path.
    """

    moves: tuple[FolderMove, ...] = ()
    troubles: tuple[FileProblem, ...] = ()
    stamps: Mapping[str, FileStamp] = field(default_factory=dict)


@dataclass(frozen=True)
class SourceSurvey:
    """A question to the file system.

    Attributes
    ----------
    drives : tuple of NotedDrive
    folder : Path
        Where the project is.
    moves : tuple of FolderMove
        What the user has said before.
    chosen : Path or None
        A folder in which the user says the files are.
    stamps : mapping of str to FileStamp
        Of earlier surveys.
    """

    drives: tuple[NotedDrive, ...]
    folder: Path
    moves: tuple[FolderMove, ...]
    stamps: Mapping[str, FileStamp]
    chosen: Path | None = None

    def look(self, check: CancelCheck) -> SurveyResult:
        """Look for all files; some of them may have to be read whole.

        Parameters
        ----------
        check : callable
            Called now and then; raises to stop.
        """
        moves = self.moves_found(check)
        positions = {move.noted: Path(move.now) for move in moves}
        troubles: list[FileProblem] = []
        stamps = dict(self.stamps)
        for folder, noted_files in self._by_folder().items():
            position = positions.get(folder, Path(folder))
            names = _names_in(position)
            for noted in noted_files:
                check()
                state = _state(noted, position, names, stamps, check)
                if state is not FileState.AS_DELIVERED:
                    troubles.append(noted.trouble(position, state))
        return SurveyResult(moves, tuple(troubles), stamps)

    def moves_found(self, check: CancelCheck) -> tuple[FolderMove, ...]:
        """Look only where folders are; no file is read."""
        positions = {
            folder: self._position_of(folder, noted_files, check)
            for folder, noted_files in self._by_folder().items()
        }
        return tuple(
            FolderMove(folder, str(position))
            for folder, position in positions.items()
            if position != Path(folder)
        )

    def _by_folder(self) -> dict[str, list[_Noted]]:
        """Every noted file once, whichever drives note it."""
        files: dict[str, dict[tuple[str, str], _Noted]] = {}
        for drive in self.drives:
            noted: list[tuple[str, SourceFile | None]] = [(one.path, one) for one in drive.sources]
            noted += [(image, None) for image in drive.images]
            for path, source in noted:
                key = (path, "" if source is None else source.sha256)
                own = files.setdefault(folder_of(path), {}).setdefault(key, _Noted(path, source))
                own.drives.append(drive)
        return {folder: list(own.values()) for folder, own in files.items()}

    def _position_of(self, folder: str, files: list[_Noted], check: CancelCheck) -> Path:
        """The first place that has all of a folder's files, or else the one that has most."""
        best, most = Path(folder), 0
        for position in dict.fromkeys(self._candidates(folder, files)):
            check()
            names = _names_in(position)
            count = sum(_likeness(noted, position, names) for noted in files)
            if count > most:
                best, most = position, count
            if count == len(files) * _ALIKE:
                break
        return best

    def _candidates(self, folder: str, files: list[_Noted]) -> Iterable[Path]:
        if self.chosen is not None:
            yield from below(folder, self.chosen)
        yield from (Path(move.now) for move in self.moves if move.noted == folder)
        yield Path(folder)
        for home in dict.fromkeys(drive.home for noted in files for drive in noted.drives):
            position = beside(folder, home, self.folder) if home else None
            if position is not None:
                yield position


@dataclass(frozen=True)
class _Noted:
    """One noted file and the drives that note it; without a source it is a camera image."""

    path: str
    source: SourceFile | None
    drives: list[NotedDrive] = field(default_factory=list)

    @property
    def name(self) -> str:
        return name_of(self.path)

    def trouble(self, position: Path, state: FileState) -> FileProblem:
        """What is to be said of it."""
        ids = tuple(drive.id for drive in self.drives)
        return FileProblem(ids, self.path, position / self.name, state, self.source is None)


def _names_in(position: Path) -> frozenset[str]:
    """One look at a folder in place of one at each of its thousands of images."""
    try:
        return frozenset(entry.name for entry in position.iterdir())
    except OSError:
        return frozenset()


def _is_there(noted: _Noted, position: Path, names: frozenset[str]) -> bool:
    # Systems that take small letters for capitals know more names than they list.
    return noted.name in names or (bool(names) and (position / noted.name).is_file())


def _likeness(noted: _Noted, position: Path, names: frozenset[str]) -> int:
    """A file of the same name is better than none, one of the same size is the one meant."""
    if not _is_there(noted, position, names):
        return 0
    if noted.source is None:
        return _ALIKE
    try:
        return _ALIKE if (position / noted.name).stat().st_size == noted.source.size else 1
    except OSError:
        return 0


def _state(
    noted: _Noted,
    position: Path,
    names: frozenset[str],
    stamps: dict[str, FileStamp],
    check: CancelCheck,
) -> FileState:
    if not _is_there(noted, position, names):
        return FileState.MISSING
    if noted.source is None:
        return FileState.AS_DELIVERED
    path, key = position / noted.name, f"{noted.source.sha256} {position / noted.name}"
    try:
        status = path.stat()
        stamp = (status.st_size, status.st_mtime_ns)
        if stamps.get(key) == stamp:
            return FileState.AS_DELIVERED
        state = state_of(noted.source, path, check)
    except (OSError, UserError):
        return FileState.MISSING
    if state is FileState.AS_DELIVERED and stamp[1] != noted.source.modified_ns:
        stamps[key] = stamp
    return state

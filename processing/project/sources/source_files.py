"""SourceFiles: what a project knows of the files outside of it, and where they are now."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from processing.project.sources.source_survey import (
    FileProblem,
    FileStamp,
    NotedDrive,
    SourceSurvey,
    SurveyResult,
)
from processing.project.store.project_settings import JsonValue, ProjectSettings
from processing.recording.drive import Drive
from processing.recording.file_locations import FolderMove, beside, folder_of

HOMES = "drive_homes"
"""Setting: by drive, the project's folder at the time when its paths were noted."""

_MOVES, _STAMPS = "file_moves", "file_stamps"


class SourceFiles:
    """Asks for delivered files and camera images, and keeps the answers with the project.

    Drives note absolute paths. Beside them the project keeps where it was itself then, so that
    files that were moved together with it are found by their way from one to the other.

    Parameters
    ----------
    folder : Path
        Where the project is.
    settings : ProjectSettings
    writing : bool
        False: what is found is used, not kept.

    Attributes
    ----------
    troubles : tuple of FileProblem
        What wasn't there, or was another file, when somebody looked last.
    """

    def __init__(self, folder: Path, settings: ProjectSettings, *, writing: bool) -> None:
        self._folder = folder
        self._settings = settings
        self._writing = writing
        self.troubles: tuple[FileProblem, ...] = ()

    def homes_with(self, ids: Iterable[str]) -> dict[str, JsonValue]:
        """The setting `HOMES` once drives are in the project."""
        return {**self._table(HOMES), **dict.fromkeys(ids, str(self._folder))}

    def use_known(self, drives: Iterable[Drive]) -> None:
        """Let drives look for their files where these were found last, without looking."""
        moves = self._known_moves()
        if moves:
            for drive in drives:
                drive.use_moves(moves)

    def survey(self, drives: Iterable[Drive], chosen: Path | None = None) -> SourceSurvey:
        """The question where the files of drives are; it may be asked in any thread.

        Parameters
        ----------
        chosen : Path, optional
            A folder in which the user says the files are now.
        """
        homes = self._table(HOMES)
        noted = tuple(
            NotedDrive(
                id=drive.id,
                name=drive.info.name,
                sources=tuple(one for one in drive.info.sources if one.points),
                images=tuple(str(image.path) for image in drive.noted_images or ()),
                home=str(homes.get(drive.id, "")),
            )
            for drive in drives
        )
        return SourceSurvey(noted, self._folder, self._known_moves(), self._stamps(), chosen)

    def take(self, result: SurveyResult, drives: tuple[Drive, ...]) -> bool:
        """Use what a survey found; says whether any file is elsewhere than it seemed.

        Raises
        ------
        NoSpace, InUse
            It is used, but the next opening has to look again.
        """
        self.troubles = result.troubles
        is_new = False
        for drive in drives:
            is_new |= drive.use_moves(result.moves)
        if self._writing:
            self._keep(result, drives)
        return is_new

    def _keep(self, result: SurveyResult, drives: Iterable[Drive]) -> None:
        moves: list[JsonValue] = [
            {"noted": move.noted, "now": move.now, "home": str(self._folder)}
            for move in result.moves
        ]
        # What isn't there today, as on a disk that is unplugged, may be again where it was found.
        found = {move.noted for move in result.moves}
        gone = {folder_of(trouble.noted) for trouble in result.troubles} - found
        moves += [
            {"noted": move.noted, "now": move.now, "home": str(self._folder)}
            for move in self._known_moves()
            if move.noted in gone
        ]
        homes = self._table(HOMES)
        elsewhere = found | gone
        for drive in drives:
            folders = {folder_of(one.path) for one in drive.info.sources if one.points}
            if drive.id not in homes and folders and not folders & elsewhere:
                homes[drive.id] = str(self._folder)
        stamps: dict[str, JsonValue] = {key: list(stamp) for key, stamp in result.stamps.items()}
        for name, value in ((_MOVES, moves), (_STAMPS, stamps), (HOMES, homes)):
            if value != (self._settings.get(name) or type(value)()):
                self._settings.put(name, value)

    def _known_moves(self) -> tuple[FolderMove, ...]:
        """Moves that were found before; also if the project has gone elsewhere with the files."""
        stored = self._settings.get(_MOVES)
        found = []
        for one in stored if isinstance(stored, list) else []:
            if not isinstance(one, dict):
                continue
            noted, now, home = (str(one.get(name, "")) for name in ("noted", "now", "home"))
            if home != str(self._folder):
                position = beside(now, home, self._folder)
                if position is not None:
                    found.append(FolderMove(noted, str(position)))
            found.append(FolderMove(noted, now))
        return tuple(found)

    def _stamps(self) -> Mapping[str, FileStamp]:
        found = {}
        for key, stamp in self._table(_STAMPS).items():
            match stamp:
                case [int(size), int(modified_ns)]:
                    found[key] = (size, modified_ns)
        return found

    def _table(self, name: str) -> dict[str, JsonValue]:
        stored = self._settings.get(name)
        return dict(stored) if isinstance(stored, dict) else {}

"""Truths: what points really are, as a person says, kept with the project under a name.

A truth is a column of class codes for each drive it is about; 0 where nobody knows. It lies beside
the drive's own columns, in a folder of its own, and the project's settings list it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import keep_sums, record_of
from processing.core.errors import report_as_user_error
from processing.core.owned_files import holds_only, remove_emptied, remove_folder
from processing.core.text import Text
from processing.project.store.project_settings import JsonValue, ProjectSettings
from processing.recording.columns.columns import column_path
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive

TRUTH = "truth"
"""The column's name."""

_KEY, _FOLDER = "truths", "truths"


@dataclass(frozen=True)
class Truth:
    """One truth.

    Attributes
    ----------
    id : str
        Unique for ever.
    name : Text
        As people call it.
    known : mapping of str to int
        By drive, of how many of its points the truth is known.
    made : datetime
        With its time zone.
    """

    id: str
    name: Text
    known: Mapping[str, int]
    made: datetime

    @property
    def points(self) -> int:
        """Points whose truth is known, on all drives."""
        return sum(self.known.values())


def new_truth_id() -> str:
    """An id that no other truth has."""
    return uuid4().hex


def truth_folder(drive: Drive, id_: str) -> Path:
    """Where a truth of a drive lies."""
    return drive.folder / _FOLDER / id_


def read_truth(drive: Drive, id_: str, start: int, stop: int) -> NDArray[np.uint8]:
    """True classes of the points ``start … stop − 1``.

    Returns
    -------
    (k,) uint8
        0 where nobody knows.

    Raises
    ------
    MissingInput
        The column is gone.
    """
    return np.asarray(read_chunk(truth_folder(drive, id_), TRUTH, start, stop))


class TruthStore:
    """The truths of a project, in the order in which they were made.

    Parameters
    ----------
    settings : ProjectSettings
        Of the open project.
    """

    def __init__(self, settings: ProjectSettings) -> None:
        self._settings = settings

    def all(self) -> tuple[Truth, ...]:
        """All truths; an entry that isn't one is left out."""
        stored = self._settings.get(_KEY)
        found = (_truth_of(one) for one in (stored if isinstance(stored, list) else []))
        return tuple(one for one in found if one is not None)

    def get(self, id_: str) -> Truth | None:
        """One truth, or None."""
        return next((one for one in self.all() if one.id == id_), None)

    def add(
        self, truth: Truth, folders: Mapping[str, Path], drive_of: Callable[[str], Drive]
    ) -> None:
        """Keep a truth; its finished columns are moved to the drives.

        Parameters
        ----------
        folders : mapping of str to Path
            By drive, a folder on its disk that holds the column and nothing else.

        Raises
        ------
        NoSpace, InUse, MissingInput
            The project is as it was.
        """
        moved: list[Path] = []
        try:
            for drive_id, folder in folders.items():
                target = truth_folder(drive_of(drive_id), truth.id)
                with report_as_user_error(target):
                    keep_sums(column_path(folder, TRUTH))
                    target.parent.mkdir(exist_ok=True)
                    folder.rename(target)
                moved.append(target)
            self._put((*self.all(), truth))
        except BaseException:
            for target in moved:
                remove_folder(target)
            raise
        for home in {folder.parent for folder in folders.values()}:
            remove_emptied(home)

    def remove(self, id_: str, drive_of: Callable[[str], Drive]) -> None:
        """Forget a truth for good.

        Raises
        ------
        NoSpace, InUse
            It is still there.
        """
        truth = self.get(id_)
        if truth is None:
            return
        self._put(tuple(one for one in self.all() if one.id != id_))
        for drive_id in truth.known:
            with suppress(KeyError):
                drive = drive_of(drive_id)
                remove_folder(truth_folder(drive, id_), drive.folder)

    def remove_unlisted(self, drives: tuple[Drive, ...]) -> None:
        """Remove columns that a killed program left without a truth that lists them.

        What is something else than such a column stays.
        """
        known = {one.id for one in self.all()}
        for drive in drives:
            home = drive.folder / _FOLDER
            for folder in tuple(home.iterdir()) if home.is_dir() else ():
                column = column_path(folder, TRUTH)
                own = {column.name, record_of(column).name}
                is_column = holds_only(folder, own.__contains__)
                if folder.name not in known and is_column:
                    remove_folder(folder, drive.folder)

    def _put(self, truths: tuple[Truth, ...]) -> None:
        self._settings.put(_KEY, [_values_of(one) for one in truths])


def has_truth(drive: Drive, id_: str) -> bool:
    """Whether a drive has a whole column of a truth."""
    path = column_path(truth_folder(drive, id_), TRUTH)
    return path.is_file() and path.stat().st_size == drive.count


def _values_of(truth: Truth) -> JsonValue:
    known: dict[str, JsonValue] = dict(truth.known)
    made = truth.made.isoformat()
    name: dict[str, JsonValue] = {"en": truth.name.en, "ja": truth.name.ja}
    return {"id": truth.id, "name": name, "known": known, "made": made}


def _truth_of(values: JsonValue) -> Truth | None:
    if not isinstance(values, dict):
        return None
    id_, name, known = values.get("id"), values.get("name"), values.get("known")
    if not isinstance(id_, str) or not isinstance(name, dict) or not isinstance(known, dict):
        return None
    if Path(id_).name != id_:
        return None
    counts = {key: one for key, one in known.items() if isinstance(one, int)}
    try:
        made = datetime.fromisoformat(str(values.get("made")))
    except ValueError:
        return None
    words = Text(str(name.get("en")), str(name.get("ja")))
    return Truth(id_, words, counts, made)

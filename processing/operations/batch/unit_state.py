"""What has become of a drive of a job: its tasks with what they said, kept beside its results.

A task that is done is known by the text of its operation, so that the next run goes on where this
one ended, and a changed step is done anew with all that follow it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from processing.core.errors import BadFile, InUse, UserError, report_as_user_error
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.operations.written_values import json_text, table_from_text, table_of, value_from
from processing.project.importing.file_recorder import checksum_of
from processing.project.importing.import_request import ImportRequest, mark_of

STATE_FILE, PROGRESS_FILE, LOG_FILE = "state.json", "progress.json", "log.txt"

Became = Literal["done", "unsuited", "failed", "defect"]


@dataclass(frozen=True)
class ErrorWords:
    """What a message said, where and what to do, kept in both languages."""

    what: Text
    where: Text
    remedy: Text

    @staticmethod
    def of(error: UserError) -> ErrorWords:
        """The words of an error."""
        return ErrorWords(error.what, error.where, error.remedy)

    def error(self) -> UserError:
        """The error that says it."""
        return UserError(self.what, self.where, self.remedy)


@dataclass(frozen=True)
class InputFile:
    """A delivered file as it was when work on it began."""

    path: str
    size: int
    modified_ns: int
    sha256: str


@dataclass(frozen=True)
class TaskState:
    """One task that was tried.

    Attributes
    ----------
    task : str
        Its operation, written down.
    title : Text
    became : "done", "unsuited", "failed" or "defect"
        Unsuited: an extractor that the drive has not what it needs for; nothing is wrong.
    seconds : float
    peak_bytes : int
        The most memory that was held, of no file; 0 where the system doesn't tell.
    words : tuple of Text
        What came of it.
    error : ErrorWords or None
    """

    task: str
    title: Text
    became: Became
    seconds: float = 0.0
    peak_bytes: int = 0
    words: tuple[Text, ...] = ()
    error: ErrorWords | None = None

    @property
    def is_settled(self) -> bool:
        """Whether it need not be tried again."""
        return self.became in ("done", "unsuited")


@dataclass(frozen=True)
class UnitState:
    """What has become of a drive so far.

    Attributes
    ----------
    name : str
    files : tuple of InputFile
    tasks : tuple of TaskState
        In the order in which they were done.
    is_whole : bool
        Whether all tasks came to a good end.
    trouble : TaskState or None
        What ended the work from outside: a process that was killed, memory, a defect.
    """

    name: str
    files: tuple[InputFile, ...] = ()
    tasks: tuple[TaskState, ...] = ()
    is_whole: bool = False
    trouble: TaskState | None = None

    @property
    def troubles(self) -> tuple[TaskState, ...]:
        """All that did not come to a good end."""
        own = () if self.trouble is None else (self.trouble,)
        return (*(one for one in self.tasks if not one.is_settled), *own)

    @property
    def has_defect(self) -> bool:
        """Whether the program itself is to blame for one of them."""
        return any(one.became == "defect" for one in self.troubles)

    @property
    def seconds(self) -> float:
        """What its tasks took."""
        return sum(one.seconds for one in self.tasks)

    @property
    def peak_bytes(self) -> int:
        """The most memory of any task."""
        return max((one.peak_bytes for one in self.tasks), default=0)


def read_state(folder: Path, name: str) -> UnitState:
    """The state that a drive's folder has; an empty one where none is.

    Raises
    ------
    BadFile
        The file is damaged.
    """
    path = folder / STATE_FILE
    if not path.exists():
        return UnitState(name)
    with report_as_user_error(path):
        text = path.read_text(encoding="utf-8", errors="replace")
    return value_from(UnitState, table_from_text(text, str(path)), str(path))


def with_trouble(folder: Path, name: str, trouble: TaskState) -> UnitState:
    """Note what ended the work on a drive from outside; gives what stands there now.

    Raises
    ------
    NoSpace, MissingInput
    """
    try:
        known = read_state(folder, name)
    except UserError:  # the state itself is damaged
        known = UnitState(name)
    state = replace(known, is_whole=False, trouble=trouble)
    write_state(folder, state)
    return state


def write_state(folder: Path, state: UnitState) -> None:
    """Keep a state, whole or not at all.

    Raises
    ------
    NoSpace, MissingInput
    """
    with write_safely(folder / STATE_FILE) as temporary:
        temporary.write_text(json_text(table_of(state)), encoding="utf-8")


def input_files(requests: Iterable[ImportRequest], known: UnitState) -> tuple[InputFile, ...]:
    """The delivered files as they are now; checksums are taken of new and changed ones only.

    Raises
    ------
    UserError
        One can't be read.
    """
    before = {one.path: one for one in known.files}
    found = []
    for path in (path for request in requests for path in request.files):
        mark = mark_of(path)
        old = before.get(mark.path)
        is_same = old is not None and (old.size, old.modified_ns) == (mark.size, mark.modified_ns)
        checksum = old.sha256 if old is not None and is_same else checksum_of(path)
        found.append(InputFile(mark.path, mark.size, mark.modified_ns, checksum))
    return tuple(found)


def refuse_other_files(known: UnitState, now: Iterable[InputFile], folder: Path) -> None:
    """Refuse to go on with results that were made of other files.

    A file that was only copied again, with the same content, is the same.

    Raises
    ------
    InUse
    """
    contents = {one.path: one.sha256 for one in known.files}
    changed = [one.path for one in now if contents.get(one.path, one.sha256) != one.sha256]
    if changed:
        raise InUse(
            Text(
                "A delivered file was changed since this drive was worked on.",
                "この走行データの処理後に、納品ファイルが変更されています。",
            ),
            Text.same(changed[0]),
            Text(
                "Put the earlier file back, or rename {folder} to have it worked on anew.",
                "元のファイルに戻すか、{folder} の名前を変えて最初から処理してください。",
            ).filled(folder=str(folder)),
        )


@dataclass(frozen=True)
class UnitProgress:
    """How far a drive is at this moment.

    Attributes
    ----------
    fraction : float
        0 to 1.
    text : Text
    held_bytes, peak_bytes : int
        Memory of its processes now, and the most of it; of no file.
    """

    fraction: float = 0.0
    text: Text = Text("", "")
    held_bytes: int = 0
    peak_bytes: int = 0


def write_progress(folder: Path, progress: UnitProgress) -> None:
    """Say how far a drive is; a reader never sees half of it, and a full disk stops no work."""
    path = folder / PROGRESS_FILE
    temporary = path.with_suffix(".part")
    try:
        temporary.write_text(json.dumps(table_of(progress)), encoding="utf-8")
        temporary.replace(path)
    except OSError:  # it is told again in a moment
        return


def read_progress(folder: Path) -> UnitProgress:
    """How far a drive said that it is; nothing where it said nothing readable."""
    try:
        text = (folder / PROGRESS_FILE).read_text(encoding="utf-8", errors="replace")
        return value_from(UnitProgress, table_from_text(text, PROGRESS_FILE))
    except (OSError, BadFile):
        return UnitProgress()

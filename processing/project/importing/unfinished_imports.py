"""Imports that a kill or a full disk stopped: found again by what they import, or dropped."""

from __future__ import annotations

from collections.abc import Collection
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from processing.core.errors import UserError
from processing.core.owned_files import (
    is_link,
    is_marked,
    mark,
    remove_emptied,
    remove_folder,
    remove_marked,
)
from processing.core.stored_json import json_of
from processing.project.importing.import_journal import FINISHED, PLAN
from processing.project.importing.import_request import (
    ImportRequest,
    describe_request,
    digest_of,
    marks_of,
    request_from,
)

TEMPORARY = "tmp"
_STEM = "import-"


@dataclass(frozen=True)
class UnfinishedImport:
    """An import that can go on.

    Attributes
    ----------
    folder : Path
        What is done of it.
    """

    folder: Path
    request: ImportRequest


def import_folder(project: Path, request: ImportRequest) -> Path:
    """The folder of an import into a project: the same for the same files and options.

    Raises
    ------
    UserError
        A file can't be looked at.
    """
    return project / TEMPORARY / f"{_STEM}{digest_of(describe_request(request, marks_of(request)))}"


def is_import_folder(folder: Path) -> bool:
    """Whether :func:`import_folder` names a folder like this."""
    return folder.name.startswith(_STEM) and folder.parent.name == TEMPORARY


def unfinished_imports(project: Path) -> tuple[UnfinishedImport, ...]:
    """The imports into a project that can go on."""
    found = []
    for folder in _folders(project):
        request = _request_of(folder)
        if request is not None:
            found.append(UnfinishedImport(folder, request))
    return tuple(found)


def discard(unfinished: UnfinishedImport) -> None:
    """Give an import up: what is done of it is removed."""
    remove_import(unfinished.folder)


def remove_import(folder: Path) -> None:
    """Remove an import's folder; a kill meanwhile leaves nothing that could go on.

    Only one that the program made, as its mark or its plan says, and no link.
    """
    if not is_own_import(folder):
        return
    with suppress(OSError):
        # Without its plan it can't go on; by its mark it is still known as litter.
        if not is_marked(folder):
            mark(folder)
        (folder / PLAN).unlink(missing_ok=True)
    remove_folder(folder)


def remove_litter(project: Path, drives: Collection[str]) -> None:
    """Remove what imports left that can't go on, and that of imports whose drives are there.

    What the program didn't make stays, and so does all that lies behind a link.

    Parameters
    ----------
    drives : collection of str
        Ids of the project's drives.
    """
    for folder in _folders(project):
        finished = _finished_drives(folder)
        is_there = bool(finished) and all(id_ in drives for id_ in finished)
        if is_there or _request_of(folder) is None:
            remove_import(folder)
            remove_emptied(folder)
    home = project / TEMPORARY
    for path in () if is_link(home) else home.glob("*"):
        if path.is_dir() and not is_link(path) and not is_import_folder(path):
            remove_marked(path, project)
            remove_emptied(path)


def _folders(project: Path) -> list[Path]:
    home = project / TEMPORARY
    folders = () if is_link(home) else home.glob(f"{_STEM}*")
    return sorted(folder for folder in folders if folder.is_dir() and not is_link(folder))


def is_own_import(folder: Path) -> bool:
    """Whether the program made an import's folder, as its mark or its plan says."""
    plan = folder / PLAN
    return is_marked(folder) or (plan.is_file() and not is_link(plan) and not is_link(folder))


def _request_of(folder: Path) -> ImportRequest | None:
    """What is imported there, if the delivered files are still as they were."""
    try:
        text = (folder / PLAN).read_text(encoding="utf-8")
        request, marks = request_from(json_of(text))
        is_same = marks_of(request) == marks
    except (OSError, ValueError, TypeError, KeyError, UserError):
        return None
    return request if is_same else None


def _finished_drives(folder: Path) -> tuple[str, ...]:
    try:
        ids = json_of((folder / FINISHED).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return ()
    return tuple(map(str, ids)) if isinstance(ids, list) else ()

"""ImportRequest: what to import, and how it is written down for an import that is to go on."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, cast

from processing.core.errors import report_as_user_error

Labels = Literal["label", "classification"]

_GROUPING = 2
"""Counted up when files are dealt to recordings in another way: no import goes on across that."""


@dataclass(frozen=True)
class ImportRequest:
    """What to import.

    Attributes
    ----------
    inputs : tuple of Path
        Point files.
    trajectories, images : tuple of Path
        Trajectory files; camera image lists.
    crs : str
        ``EPSG:n``; empty to take the files' own.
    labels : "label" or "classification"
        What becomes of the points' labels: the extra dimension of this name, where there is one;
        or the delivered classes.
    columns : tuple of str
        What the columns of text files are, whatever they say; empty to go by the files.
    """

    inputs: tuple[Path, ...]
    trajectories: tuple[Path, ...] = ()
    images: tuple[Path, ...] = ()
    crs: str = ""
    labels: Labels = "label"
    columns: tuple[str, ...] = ()

    @property
    def files(self) -> tuple[Path, ...]:
        """All files it names."""
        return (*self.inputs, *self.trajectories, *self.images)


@dataclass(frozen=True)
class FileMark:
    """By what a file is seen to have changed: its size, and when it was written."""

    path: str
    size: int
    modified_ns: int


def mark_of(path: Path) -> FileMark:
    """A file's mark as it is now.

    Raises
    ------
    UserError
        It can't be looked at.
    """
    with report_as_user_error(path):
        status = path.stat()
    return FileMark(str(path.resolve()), status.st_size, status.st_mtime_ns)


def marks_of(request: ImportRequest) -> tuple[FileMark, ...]:
    """The marks of all files of a request, in its order.

    Raises
    ------
    UserError
        One can't be looked at.
    """
    return tuple(mark_of(path) for path in request.files)


def describe_request(request: ImportRequest, marks: tuple[FileMark, ...]) -> dict[str, object]:
    """A request as JSON keeps it; paths are whole, so another folder to work in changes nothing."""
    # Only where it says something, so that an import of an earlier version goes on.
    columns = {"columns": list(request.columns)} if request.columns else {}
    return {
        "inputs": [str(path.resolve()) for path in request.inputs],
        "trajectories": [str(path.resolve()) for path in request.trajectories],
        "images": [str(path.resolve()) for path in request.images],
        "crs": request.crs,
        "labels": request.labels,
        **columns,
        "marks": [[mark.path, mark.size, mark.modified_ns] for mark in marks],
        "grouping": _GROUPING,
    }


# The values come from JSON, whose types only the field names tell.
def request_from(values: dict[str, Any]) -> tuple[ImportRequest, tuple[FileMark, ...]]:
    """A request and its files' marks as :func:`describe_request` wrote them.

    Raises
    ------
    ValueError, TypeError, KeyError
        It is no such description, or one whose import can't go on with this program.
    """
    if values["grouping"] != _GROUPING:
        raise ValueError(values["grouping"])
    labels = values["labels"]
    if labels not in ("label", "classification"):
        raise ValueError(labels)
    inputs, trajectories, images = (
        tuple(Path(path) for path in values[name]) for name in ("inputs", "trajectories", "images")
    )
    columns = tuple(str(name) for name in values.get("columns", ()))
    request = ImportRequest(
        inputs, trajectories, images, str(values["crs"]), cast("Labels", labels), columns
    )
    marks = tuple(FileMark(str(path), int(size), int(ns)) for path, size, ns in values["marks"])
    return request, marks


def digest_of(description: object) -> str:
    """Sixteen letters that stand for a description."""
    text = json.dumps(description, sort_keys=True, ensure_ascii=False)
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()[:16]

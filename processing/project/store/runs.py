"""Runs: which tool was run on what, with which parameters, and what came of it."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any
from uuid import uuid4

from processing.core.stored_json import json_of
from processing.core.text import Text
from processing.map.feature import AttributeValue
from processing.project.store.database import Database
from processing.project.store.database_errors import damaged

_COLUMNS = "id, tool, version, parameters, drives, started, finished, summary_en, summary_ja"
_INSERT = f"INSERT INTO zuka_runs ({_COLUMNS}) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)"  # noqa: S608 - constants only
_SELECT = f"SELECT {_COLUMNS} FROM zuka_runs ORDER BY fid"  # noqa: S608 - constants only


@dataclass(frozen=True)
class Run:
    """One finished run of a tool.

    Attributes
    ----------
    id : str
        Unique for ever; ``Provenance.run`` of its candidates.
    tool : str
        Id of the :class:`processing.tools.tool.Tool`.
    version : int
        The tool's.
    parameters : mapping
        As given.
    drives : tuple of str
        Ids of the drives it ran over.
    started, finished : datetime
        With their time zone.
    summary : Text
        What came of it: "Curbs: 214 candidates".
    """

    id: str
    tool: str
    version: int
    parameters: Mapping[str, AttributeValue]
    drives: tuple[str, ...]
    started: datetime
    finished: datetime
    summary: Text


def new_run_id() -> str:
    """An id that no other run has."""
    return uuid4().hex


class Runs:
    """The runs of a project, in their order.

    They stay when their candidates are taken back: the tool did run.
    """

    def __init__(self, database: Database) -> None:
        self._database = database

    def all(self) -> tuple[Run, ...]:
        """All runs, the first one first.

        Raises
        ------
        BadFile
            A stored run can't be read.
        """
        rows = self._database.rows(_SELECT)
        try:
            return tuple(_run_of(row) for row in rows)
        except (ValueError, TypeError) as error:
            raise damaged(self._database.path, f"zuka_runs: {error}") from error

    def get(self, id: str) -> Run | None:  # noqa: A002 - the word of the trade
        """One run, or None.

        Raises
        ------
        BadFile
        """
        return next((run for run in self.all() if run.id == id), None)

    def add(self, run: Run) -> None:
        """Store a run that changed nothing on the map.

        Raises
        ------
        NoSpace, InUse
        """
        with self._database.transaction() as connection:
            write_run(connection, run)


def write_run(connection: sqlite3.Connection, run: Run) -> None:
    """Write a run in the caller's transaction."""
    connection.execute(
        _INSERT,
        (
            run.id,
            run.tool,
            run.version,
            json.dumps(dict(run.parameters), ensure_ascii=False, allow_nan=False),
            json.dumps(run.drives),
            run.started.isoformat(),
            run.finished.isoformat(),
            run.summary.en,
            run.summary.ja,
        ),
    )


# Rows come from SQLite untyped.
def _run_of(row: tuple[Any, ...]) -> Run:
    id_, tool, version, parameters, drives, started, finished, en, ja = row
    return Run(
        id=id_,
        tool=tool,
        version=int(version),
        parameters=json_of(parameters),
        drives=tuple(json_of(drives)),
        started=datetime.fromisoformat(started),
        finished=datetime.fromisoformat(finished),
        summary=Text(en, ja),
    )

"""Settings of a project: values by name, kept as JSON in its database."""

from __future__ import annotations

import json
import sqlite3

from processing.core.stored_json import json_of
from processing.project.store.database import Database
from processing.project.store.database_errors import damaged

JsonValue = str | int | float | bool | None | list["JsonValue"] | dict[str, "JsonValue"]


class ProjectSettings:
    """What a project remembers beside its map; read once, written at once.

    Raises
    ------
    BadFile
        A stored value can't be read.
    """

    def __init__(self, database: Database) -> None:
        self._database = database
        self._values: dict[str, JsonValue] = {}
        for key, value in database.rows("SELECT key, value FROM zuka_settings"):
            try:
                self._values[str(key)] = json_of(str(value))
            except ValueError as error:
                raise damaged(database.path, f"zuka_settings.{key}: {error}") from error

    def get(self, key: str) -> JsonValue:
        """A value, or None."""
        return self._values.get(key)

    def text(self, key: str) -> str:
        """A text; empty when it is not set.

        Raises
        ------
        BadFile
            What is stored is no text.
        """
        value = self.get(key)
        if value is not None and not isinstance(value, str):
            raise damaged(self._database.path, f"zuka_settings.{key}: {value}")
        return value or ""

    def whole(self, key: str) -> int:
        """A whole number from 0; 0 when it is not set.

        Raises
        ------
        BadFile
            What is stored is none.
        """
        value = self.get(key)
        if value is not None and (not isinstance(value, int) or value < 0):
            raise damaged(self._database.path, f"zuka_settings.{key}: {value}")
        return int(value or 0)

    def put(self, key: str, value: JsonValue) -> None:
        """Store a value.

        Raises
        ------
        NoSpace, InUse
            The old one stays.
        """
        with self._database.transaction() as connection:
            write_setting(connection, key, value)
        self.took(key, value)

    def took(self, key: str, value: JsonValue) -> None:
        """The transaction of a :func:`write_setting` is through."""
        self._values[key] = value


def write_setting(connection: sqlite3.Connection, key: str, value: JsonValue) -> None:
    """Write a value in the caller's transaction."""
    connection.execute(
        "INSERT OR REPLACE INTO zuka_settings VALUES (?, ?)",
        (key, json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)),
    )

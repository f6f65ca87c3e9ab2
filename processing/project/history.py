"""History: the changes of a project in their order, on disk, so undo survives a restart."""

from __future__ import annotations

import sqlite3

from processing.project.change import Change
from processing.project.database import Database
from processing.project.feature_rows import change_from_json, change_to_json
from processing.text import Text

_POSITION = "history_position"


class History:
    """What was done and can be taken back, and what was taken back and can be done again.

    Attributes
    ----------
    position : int
        Number of changes that are done; those behind it were taken back.
    """

    def __init__(self, database: Database) -> None:
        self._database = database
        rows = database.rows("SELECT value FROM zuka_settings WHERE key = ?", (_POSITION,))
        self.position = int(str(rows[0][0])) if rows else 0
        self._labels = {
            int(str(place)): Text(str(en), str(ja))
            for place, en, ja in database.rows("SELECT place, label_en, label_ja FROM zuka_history")
        }

    @property
    def can_undo(self) -> bool:
        """Whether there is something to take back."""
        return self.position > 0

    @property
    def can_redo(self) -> bool:
        """Whether something was taken back."""
        return self.position + 1 in self._labels

    @property
    def undo_label(self) -> Text | None:
        """What undo would take back."""
        return self._labels.get(self.position)

    @property
    def redo_label(self) -> Text | None:
        """What redo would do again."""
        return self._labels.get(self.position + 1)

    def last(self) -> Change | None:
        """The change that undo would take back."""
        return self._change(self.position)

    def coming(self) -> Change | None:
        """The change that redo would do again."""
        return self._change(self.position + 1)

    def append(self, connection: sqlite3.Connection, label: Text, change: Change) -> None:
        """Write a change behind the last one, in the caller's transaction; redo is gone."""
        place = self.position + 1
        connection.execute("DELETE FROM zuka_history WHERE place >= ?", (place,))
        connection.execute(
            "INSERT INTO zuka_history VALUES (?, ?, ?, ?)",
            (place, label.en, label.ja, change_to_json(change)),
        )
        self.write_position(connection, place)

    def write_position(self, connection: sqlite3.Connection, position: int) -> None:
        """Write how many changes are done, in the caller's transaction."""
        connection.execute(
            "INSERT OR REPLACE INTO zuka_settings VALUES (?, ?)", (_POSITION, str(position))
        )

    def appended(self, label: Text) -> None:
        """The transaction of :meth:`append` is through."""
        self.position += 1
        self._labels = {
            place: kept for place, kept in self._labels.items() if place < self.position
        }
        self._labels[self.position] = label

    def moved_to(self, position: int) -> None:
        """The transaction of :meth:`write_position` is through."""
        self.position = position

    def _change(self, place: int) -> Change | None:
        rows = self._database.rows("SELECT change FROM zuka_history WHERE place = ?", (place,))
        return change_from_json(str(rows[0][0])) if rows else None

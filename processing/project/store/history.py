"""History: the changes of a project in their order, on disk, so undo survives a restart."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from dataclasses import dataclass, replace

from processing.core.text import Text
from processing.map.change import Change
from processing.map.feature import Feature
from processing.project.store.database import Database
from processing.project.store.database_errors import damaged
from processing.project.store.feature_rows import change_from_json, change_to_json
from processing.project.store.label_rows import PENDING, labels_at, write_labels, write_pending
from processing.project.store.project_settings import ProjectSettings, write_setting

_POSITION = "history_position"
_FIRST = "history_first"
_FIRST_WITH = "SELECT place FROM zuka_history WHERE instr(change, ?) > 0 ORDER BY place LIMIT 1"
_FILED = "SELECT place FROM zuka_history WHERE instr(change, '\"filed\":') > 0"
_WITH_FILES = "SELECT place FROM zuka_history WHERE instr(change, '\"files\":') > 0"
_WITH_DRIVES = (
    "SELECT place FROM zuka_history WHERE (instr(change, '\"removed_drives\":') > 0"
    " OR instr(change, '\"restored_drives\":') > 0)"
)
_LABEL = "SELECT label_en, label_ja FROM zuka_history WHERE place = ?"


@dataclass(frozen=True)
class HistoryPosition:
    """Where the history stands: how many changes are done, and the labels on both sides."""

    position: int
    undo_label: Text | None
    redo_label: Text | None


class History:
    """What was done and can be taken back, and what was taken back and can be done again.

    :class:`processing.project.store.feature_store.FeatureStore` applies it.

    Raises
    ------
    BadFile
        What is stored is damaged.
    """

    def __init__(self, database: Database, settings: ProjectSettings) -> None:
        self._database = database
        position = settings.whole(_POSITION)
        self._first = settings.whole(_FIRST)
        self._pending = settings.whole(PENDING)
        with database.snapshot() as connection:
            self._standing = _standing_at(connection, position, self._first)

    @property
    def position(self) -> int:
        """Number of changes that are done; those behind it were taken back."""
        return self._standing.position

    @property
    def can_undo(self) -> bool:
        """Whether there is something to take back."""
        return self.undo_label is not None

    @property
    def can_redo(self) -> bool:
        """Whether something was taken back."""
        return self.redo_label is not None

    @property
    def undo_label(self) -> Text | None:
        """What undo would take back."""
        return self._standing.undo_label

    @property
    def redo_label(self) -> Text | None:
        """What redo would do again."""
        return self._standing.redo_label

    def last(self) -> Change | None:
        """The change that undo would take back.

        Raises
        ------
        BadFile
            It is damaged.
        """
        return self._change(self.position) if self.can_undo else None

    def coming(self) -> Change | None:
        """The change that redo would do again.

        Raises
        ------
        BadFile
            It is damaged.
        """
        return self._change(self.position + 1)

    def has_filed(self, by: int) -> bool:
        """Whether the change that undo (−1) or redo (1) is about labels many points; at once."""
        return self._is_among(_FILED, by)

    def coming_move(self, by: int) -> Change | None:
        """What undo (−1) or redo (1) would do, where it is about drives or files; None elsewhere.

        Raises
        ------
        BadFile
            It is damaged.
        """
        if not (self._is_among(_WITH_FILES, by) or self._is_among(_WITH_DRIVES, by)):
            return None
        if by > 0:
            return self.coming()
        last = self.last()
        return None if last is None else last.inverse()

    def drive_steps(self) -> tuple[tuple[int, Change], ...]:
        """The steps that can be taken back or done again and are about drives, with their places.

        Raises
        ------
        BadFile
            One is damaged.
        """
        return tuple(self._changes(f"{_WITH_DRIVES} AND place > ?"))

    def file_folders(self) -> frozenset[str]:
        """Names of the folders of files that steps want which can be taken back or done again.

        Raises
        ------
        BadFile
            One is damaged.
        """
        changes = (change for _, change in self._changes(f"{_WITH_FILES} AND place > ?"))
        return frozenset(one.files.folder.name for one in changes if one.files is not None)

    def pending(self) -> Change:
        """The step that was done last before the project was opened, where it was about labels.

        Raises
        ------
        BadFile
            It is damaged.
        """
        change = self._change(self._pending)
        if change is None:
            return Change()
        return change if self._pending <= self.position else change.inverse()

    def label_folders(self) -> frozenset[str]:
        """Names of the folders in which labels of many points lie.

        Raises
        ------
        BadFile
            An entry is damaged.
        """
        rows = self._database.rows(_FILED)
        return frozenset(
            filed.folder.name
            for (position,) in rows
            if (change := self._change(int(str(position)))) is not None
            and (filed := change.filed) is not None
        )

    def additions_of(self, run: str) -> tuple[Feature, ...]:
        """The candidates of a run as the tool gave them; none where the history lacks them.

        Raises
        ------
        BadFile
            It is damaged.
        """
        # A run's id is on no change before the one that put its candidates on the map.
        rows = self._database.rows(_FIRST_WITH, (run,))
        change = self._change(int(str(rows[0][0]))) if rows else None
        added = () if change is None else change.added
        return tuple(feature for feature in added if feature.provenance.run == run)

    def append(
        self, connection: sqlite3.Connection, label: Text, change: Change
    ) -> HistoryPosition:
        """Write a change behind the last one, in the caller's transaction; redo is gone.

        Returns
        -------
        Standing
            For :meth:`stands` once the transaction is through.
        """
        position = self.position + 1
        connection.execute("DELETE FROM zuka_history WHERE place >= ?", (position,))
        connection.execute(
            "INSERT INTO zuka_history VALUES (?, ?, ?, ?)",
            (position, label.en, label.ja, change_to_json(change)),
        )
        write_labels(connection, position, change.labels)
        write_pending(connection, position)
        write_setting(connection, _POSITION, position)
        return HistoryPosition(position, label, None)

    def step(self, connection: sqlite3.Connection, by: int) -> HistoryPosition:
        """Write that a change was taken back (−1) or done again (1), in the caller's transaction.

        Returns
        -------
        Standing
            For :meth:`stands` once the transaction is through.
        """
        position = self.position + by
        write_pending(connection, max(position, self.position))
        write_setting(connection, _POSITION, position)
        return _standing_at(connection, position, self._first)

    def end_undo(self, connection: sqlite3.Connection, position: int) -> HistoryPosition:
        """Write that nothing up to a place is taken back any more, in the caller's transaction.

        What was done stays readable: runs are judged by it.
        """
        first = max(position, self._first)
        write_setting(connection, _FIRST, first)
        return _standing_at(connection, self.position, first)

    def end_redo(self, connection: sqlite3.Connection) -> HistoryPosition:
        """Write that nothing that was taken back is done again, in the caller's transaction."""
        connection.execute("DELETE FROM zuka_history WHERE place > ?", (self.position,))
        connection.execute("DELETE FROM zuka_history_labels WHERE place > ?", (self.position,))
        return _standing_at(connection, self.position, self._first)

    def ended_undo(self, standing: HistoryPosition, position: int) -> None:
        """The transaction of :meth:`end_undo` is through."""
        self._first = max(position, self._first)
        self.stands(standing)

    def stands(self, standing: HistoryPosition) -> None:
        """The transaction that gave this is through."""
        self._standing = standing

    def _is_among(self, query: str, by: int) -> bool:
        position = self.position + (0 if by < 0 else 1)
        return bool(self._database.rows(f"{query} AND place = ?", (position,)))

    def _changes(self, query: str) -> Iterator[tuple[int, Change]]:
        for (position,) in self._database.rows(query, (self._first,)):
            change = self._change(int(str(position)))
            if change is not None:
                yield int(str(position)), change

    def _change(self, position: int) -> Change | None:
        rows = self._database.rows("SELECT change FROM zuka_history WHERE place = ?", (position,))
        try:
            if not rows:
                return None
            labels = labels_at(self._database, position)
            found = change_from_json(str(rows[0][0]), self._database.path.parent)
            return replace(found, labels=labels)
        except (ValueError, KeyError, TypeError, IndexError) as error:
            raise damaged(self._database.path, f"zuka_history.place {position}: {error}") from error


def _standing_at(connection: sqlite3.Connection, position: int, first: int) -> HistoryPosition:
    undo = _label_at(connection, position) if position > first else None
    return HistoryPosition(position, undo, _label_at(connection, position + 1))


def _label_at(connection: sqlite3.Connection, position: int) -> Text | None:
    found = connection.execute(_LABEL, (position,)).fetchone()
    return None if found is None else Text(str(found[0]), str(found[1]))

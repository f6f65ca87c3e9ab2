"""Changes of labels as rows beside the history, and which of its entries label files may lack."""

from __future__ import annotations

import sqlite3

from processing.map.label_change import LabelChange
from processing.project.store.database import Database
from processing.project.store.project_settings import write_setting

PENDING = "labels_pending"
"""Setting: the place in the history that was done or taken back last.

The database is written before the label files; after a kill they may lack what this entry says,
and opening the project brings them up to date. Writing it twice does no harm.
"""

_INSERT = "INSERT INTO zuka_history_labels VALUES (?, ?, ?, ?, ?, ?, ?)"
_SELECT = (
    "SELECT drive, count, points, before, after FROM zuka_history_labels WHERE place = ?"
    " ORDER BY number"
)


def write_labels(
    connection: sqlite3.Connection, position: int, labels: tuple[LabelChange, ...]
) -> None:
    """Write the labels of a change behind all others, in the caller's transaction."""
    connection.execute("DELETE FROM zuka_history_labels WHERE place >= ?", (position,))
    connection.executemany(
        _INSERT,
        [
            (position, number, one.drive, one.count, one.points, one.before, one.after)
            for number, one in enumerate(labels)
        ],
    )


def write_pending(connection: sqlite3.Connection, position: int) -> None:
    """Write which entry label files may lack from now on, in the caller's transaction."""
    write_setting(connection, PENDING, position)


def labels_at(database: Database, position: int) -> tuple[LabelChange, ...]:
    """The labels of the change at a place in the history.

    Raises
    ------
    TypeError
        A row is damaged.
    """
    return tuple(_label_change(row) for row in database.rows(_SELECT, (position,)))


def _label_change(row: tuple[object, ...]) -> LabelChange:
    drive, count, *packed = row
    points, before, after = (one for one in packed if isinstance(one, bytes))
    if not isinstance(drive, str) or not isinstance(count, int):
        message = f"labels of {count} points of {drive}"
        raise TypeError(message)
    return LabelChange(drive, count, points, before, after)

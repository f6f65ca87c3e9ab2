"""FeatureStore: the features of a project, in memory and in its database, always the same."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator

from processing.errors import BadFile
from processing.project.change import Change
from processing.project.database import Database
from processing.project.feature import Feature
from processing.project.feature_rows import COLUMNS, feature_of, row_of
from processing.project.history import History
from processing.text import Text

_NAMES = ", ".join(COLUMNS)
_PLACES = ", ".join("?" * len(COLUMNS))
_INSERT = f"INSERT INTO features ({_NAMES}) VALUES ({_PLACES})"  # noqa: S608 - constants only
_UPDATE = f"UPDATE features SET {', '.join(f'{name} = ?' for name in COLUMNS)} WHERE id = ?"  # noqa: S608 - constants only
_SELECT = f"SELECT {_NAMES} FROM features ORDER BY fid"  # noqa: S608 - constants only
_EXTENT = (
    "UPDATE gpkg_contents SET last_change = strftime('%Y-%m-%dT%H:%M:%fZ','now'),"
    " min_x = min(coalesce(min_x, ?1), ?1), min_y = min(coalesce(min_y, ?2), ?2),"
    " max_x = max(coalesce(max_x, ?3), ?3), max_y = max(coalesce(max_y, ?4), ?4)"
    " WHERE table_name = 'features'"
)


class FeatureStore:
    """Features by id, in the order in which they were first drawn.

    Raises
    ------
    BadFile
        A stored feature can't be read.
    """

    def __init__(self, database: Database, history: History, srs_id: int) -> None:
        self._database = database
        self._history = history
        self._srs_id = srs_id
        self._features: dict[str, Feature] = {}
        for row in database.rows(_SELECT):
            try:
                feature = feature_of(row)
            except (ValueError, KeyError, TypeError) as error:
                raise BadFile(
                    Text("A stored feature can't be read.", "保存された地物を読み込めません。"),
                    Text.same(f"{database.path}, features.id {row[1]}: {error}"),
                    Text(
                        "Undo what another program changed there, or take a backup.",
                        "他のプログラムによる変更を元に戻すか、バックアップから復元してください。",
                    ),
                ) from error
            self._features[feature.id] = feature

    def __len__(self) -> int:
        return len(self._features)

    def all(self) -> Iterator[Feature]:
        """All features; they may change while this is walked through."""
        return iter(tuple(self._features.values()))

    def get(self, id: str) -> Feature | None:  # noqa: A002 - the word of the trade
        """One feature, or None."""
        return self._features.get(id)

    def apply(self, label: Text, change: Change) -> Change:
        """Do a change and remember it in the history, in one transaction.

        Returns
        -------
        Change
            Its inverse.

        Raises
        ------
        ValueError
            What it replaces or removes is not what is stored: a defect of the caller.
        NoSpace, InUse
            Nothing was changed.
        """
        self._check(change)
        with self._database.transaction() as connection:
            self._write(connection, change)
            self._history.append(connection, label, change)
        self._history.appended(label)
        self._take_over(change)
        return change.inverse()

    def undo(self) -> Change | None:
        """Take the last change back; gives the change that did it, None when there is none."""
        last = self._history.last()
        return None if last is None else self._step(last.inverse(), -1)

    def redo(self) -> Change | None:
        """Do the next change again; gives it, None when there is none."""
        coming = self._history.coming()
        return None if coming is None else self._step(coming, 1)

    def rewrite_srs(self, connection: sqlite3.Connection, srs_id: int) -> None:
        """Write all geometries with another reference system's number, in a transaction."""
        self._srs_id = srs_id
        rows = [(row_of(feature, srs_id)[0], feature.id) for feature in self._features.values()]
        connection.executemany("UPDATE features SET geom = ? WHERE id = ?", rows)

    def _step(self, change: Change, step: int) -> Change:
        self._check(change)
        position = self._history.position + step
        with self._database.transaction() as connection:
            self._write(connection, change)
            self._history.write_position(connection, position)
        self._history.moved_to(position)
        self._take_over(change)
        return change

    def _check(self, change: Change) -> None:
        ids = change.feature_ids
        expected = {
            **{feature.id: feature for feature in change.removed},
            **{pair.before.id: pair.before for pair in change.replaced},
            **{feature.id: None for feature in change.added},
        }
        is_sound = len(set(ids)) == len(ids) and all(
            pair.before.id == pair.after.id for pair in change.replaced
        )
        if not is_sound or any(self._features.get(id_) != f for id_, f in expected.items()):
            message = f"the change does not fit the stored features {ids}"
            raise ValueError(message)

    def _write(self, connection: sqlite3.Connection, change: Change) -> None:
        connection.executemany(
            "DELETE FROM features WHERE id = ?", [(feature.id,) for feature in change.removed]
        )
        connection.executemany(_INSERT, [row_of(f, self._srs_id) for f in change.added])
        updates = [(*row_of(p.after, self._srs_id), p.after.id) for p in change.replaced]
        connection.executemany(_UPDATE, updates)
        new = [*change.added, *(pair.after for pair in change.replaced)]
        places = [vertex.xyz for feature in new for vertex in feature.vertices]
        if places:
            eastings, northings, _ = zip(*places, strict=True)
            extent = (min(eastings), min(northings), max(eastings), max(northings))
            connection.execute(_EXTENT, extent)

    def _take_over(self, change: Change) -> None:
        for feature in change.removed:
            del self._features[feature.id]
        for pair in change.replaced:
            self._features[pair.after.id] = pair.after
        for feature in change.added:
            self._features[feature.id] = feature

"""FeatureStore: the features of a project, in memory and in its database, always the same."""

from __future__ import annotations

import gc
import sqlite3
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UserError
from processing.core.text import Text
from processing.map.catalogue import Catalogue
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, with_points_at
from processing.map.filed_labels import FiledLabels
from processing.map.map_extent import Bounds, extent_after, extent_of
from processing.map.reference_system import CRS, srs_number, write_reference_system
from processing.project.store.database import Database
from processing.project.store.database_errors import changed_elsewhere, damaged
from processing.project.store.exchanged_files import ExchangedFiles
from processing.project.store.feature_rows import COLUMNS, feature_of, row_of
from processing.project.store.history import History, HistoryPosition
from processing.project.store.label_layer import LabelLayer
from processing.project.store.open_drives import OpenDrives
from processing.project.store.project_settings import ProjectSettings, write_setting
from processing.project.store.runs import Run, write_run

_NAMES = ", ".join(COLUMNS)
_POSITIONS = ", ".join("?" * len(COLUMNS))
_INSERT = f"INSERT INTO features ({_NAMES}) VALUES ({_POSITIONS})"  # noqa: S608 - constants only
_UPDATE = f"UPDATE features SET {', '.join(f'{name} = ?' for name in COLUMNS)} WHERE id = ?"  # noqa: S608 - constants only
_SELECT = f"SELECT {_NAMES} FROM features ORDER BY fid"  # noqa: S608 - constants only
_EXTENT = (
    "UPDATE gpkg_contents SET last_change = strftime('%Y-%m-%dT%H:%M:%fZ','now'),"
    " min_x = ?, min_y = ?, max_x = ?, max_y = ? WHERE table_name = 'features'"
)
_MOST_IDS_TOLD = 3


class FeatureStore:
    """Features by id, in the order in which they were first drawn; and points' labels with them.

    Parameters
    ----------
    labels : LabelLayer
        Written when the database has a change.
    drives : OpenDrives
        Of which steps may remove some.
    files : ExchangedFiles
        Moved when the database has a change.

    Raises
    ------
    BadFile
        A stored feature can't be read.
    """

    def __init__(
        self,
        database: Database,
        history: History,
        catalogue: Catalogue,
        settings: ProjectSettings,
        *,
        labels: LabelLayer,
        drives: OpenDrives,
        files: ExchangedFiles,
    ) -> None:
        self._database = database
        self._history = history
        self._catalogue = catalogue
        self._settings = settings
        self._srs_id = self._stored_srs()
        self._labels = labels
        self._drives = drives
        self._files = files
        self._features = self._stored()
        self._extent = self._stored_extent()

    def __len__(self) -> int:
        return len(self._features)

    def all(self) -> Iterator[Feature]:
        """All features; they may change while this is walked through."""
        return iter(tuple(self._features.values()))

    def get(self, id: str) -> Feature | None:  # noqa: A002 - the word of the trade
        """One feature, or None."""
        return self._features.get(id)

    def fits(self, change: Change) -> bool:
        """Whether what a change replaces or removes is what is stored now."""
        return not self._misfits(change)

    def apply(
        self,
        label: Text,
        change: Change,
        *,
        run: Run | None = None,
        also: Callable[[sqlite3.Connection], None] | None = None,
    ) -> Change:
        """Do a change and remember it in the history, in one transaction.

        Parameters
        ----------
        run : Run or None
            The run that the change comes from, stored with it.
        also : callable or None
            Writes in the same transaction what no undo takes back.

        Returns
        -------
        Change
            Its inverse.

        Raises
        ------
        ValueError
            What it replaces or removes is not what is stored, or a value can't be stored: a
            defect of the caller. Nothing was changed.
        NoSpace, InUse, BadFile
            The disk is full; a program is reading; one has changed the map. Nothing was changed.
        """
        misfits = self._misfits(change)
        if misfits:
            message = f"the change does not fit the stored features {misfits}"
            raise ValueError(message)
        with self._written(change) as connection:
            if run is not None:
                write_run(connection, run)
            if also is not None:
                also(connection)
            standing = self._history.append(connection, label, change)
        self._follow(change, standing, 1)
        return change.inverse()

    def coming_labels(self, by: int) -> FiledLabels | None:
        """What `undo` (−1) or `redo` (1) would do to labels of many points; None: to none.

        Raises
        ------
        BadFile
            The history is damaged.
        """
        if not self._history.has_filed(by):
            return None
        change = self._history.last() if by < 0 else self._history.coming()
        if change is None or change.filed is None:
            return None
        return change.filed.inverse() if by < 0 else change.filed

    def undo(self, *, are_columns_made: bool = False) -> Change | None:
        """Take the last change back; gives the change that did it, None when there is none.

        Parameters
        ----------
        are_columns_made : bool
            Whether the columns of :meth:`coming_labels` were made just now, in a worker's thread.

        Raises
        ------
        NoSpace, InUse, BadFile
            Nothing was changed. ``BadFile`` too where another program has changed the features.
        """
        last = self._history.last()
        return None if last is None else self._step(last.inverse(), -1, are_columns_made)

    def redo(self, *, are_columns_made: bool = False) -> Change | None:
        """Do the next change again; gives it, None when there is none.

        Parameters
        ----------
        are_columns_made : bool
            As :meth:`undo`.

        Raises
        ------
        NoSpace, InUse, BadFile
            As :meth:`undo`.
        """
        coming = self._history.coming()
        return None if coming is None else self._step(coming, 1, are_columns_made)

    def points_elsewhere(
        self, positions: Mapping[str, NDArray[np.int64]]
    ) -> tuple[Replacement, ...]:
        """What becomes of features when points have other places.

        Parameters
        ----------
        positions : mapping of str to (n,) int64
            By drive: where each of its points is then.
        """
        return tuple(
            Replacement(feature, moved)
            for feature in self._features.values()
            if (moved := with_points_at(feature, positions)) is not feature
        )

    def write_system(self, connection: sqlite3.Connection, crs: str) -> None:
        """Write that all coordinates are in another reference system, in a transaction.

        Parameters
        ----------
        crs : str
            ``EPSG:n``; empty for an unknown one.
        """
        write_reference_system(connection, crs)
        write_setting(connection, CRS, crs)
        rows = [(self._row(one, srs_number(crs))[0], one.id) for one in self._features.values()]
        connection.executemany("UPDATE features SET geom = ? WHERE id = ?", rows)

    def took_system(self, crs: str) -> None:
        """The transaction of :meth:`write_system` is through."""
        self._settings.took(CRS, crs)
        self._srs_id = srs_number(crs)

    def layers_fit(self) -> bool:
        """Whether the stored layers are those of the catalogue.

        They are not when a catalogue was written by hand, or by a program that was killed then.
        """
        stored = self._database.rows("SELECT DISTINCT kind, layer FROM features")
        return all(layer == _layer_of(self._catalogue, str(kind)) for kind, layer in stored)

    def rewrite_layers(self, connection: sqlite3.Connection, catalogue: Catalogue) -> None:
        """Write the layers that a catalogue gives to all features, in a transaction.

        Raises
        ------
        BadFile
            Another program has changed the features.
        """
        self._refuse_changed_elsewhere()
        kinds = [str(kind) for (kind,) in connection.execute("SELECT DISTINCT kind FROM features")]
        rows = [(_layer_of(catalogue, kind), kind) for kind in kinds]
        connection.executemany(
            "UPDATE features SET layer = ?1 WHERE kind = ?2 AND layer <> ?1", rows
        )

    def took_catalogue(self, catalogue: Catalogue) -> None:
        """The transaction of :meth:`rewrite_layers` is through."""
        self._catalogue = catalogue

    def _step(self, change: Change, by: int, are_columns_made: bool) -> Change:  # noqa: FBT001 - passed on
        misfits = self._misfits(change)
        if change.filed is not None and not are_columns_made:
            misfits += self._labels.make(change.filed)
        if misfits:
            # The history was made from what was stored then; only somebody else can differ.
            raise changed_elsewhere(self._database.path, ", ".join(misfits[:_MOST_IDS_TOLD]))
        with self._written(change) as connection:
            standing = self._history.step(connection, by)
        self._follow(change, standing, by)
        return change

    def _follow(self, change: Change, standing: HistoryPosition, by: int) -> None:
        """Take over what the database has; where label files can't, it is taken back."""
        self._history.stands(standing)
        try:
            self._write_files(change)
        except UserError:
            with self._written(change.inverse()) as connection:
                standing = self._history.step(connection, -by)
            self._history.stands(standing)
            raise

    def _write_files(self, change: Change) -> None:
        if change.files is not None:
            self._files.exchange(change.files)
            self._drives.follow_files(change.files)
        try:
            self._labels.write(change.labels)
            if change.filed is not None:
                self._labels.adopt(change.filed)
        except UserError:
            if change.files is not None:
                with suppress(UserError):
                    self._files.exchange(change.files.inverse())
                self._drives.follow_files(change.files)
            raise

    def _misfits(self, change: Change) -> list[str]:
        """Ids that the change names twice or takes for something else than is stored."""
        ids = change.feature_ids
        if len(set(ids)) != len(ids):
            return sorted(id_ for id_ in set(ids) if ids.count(id_) > 1)
        expected: dict[str, Feature | None] = dict.fromkeys(ids)
        expected.update((feature.id, feature) for feature in change.removed)
        expected.update((pair.before.id, pair.before) for pair in change.replaced)
        return [
            *(pair.before.id for pair in change.replaced if pair.before.id != pair.after.id),
            *(id_ for id_, feature in expected.items() if self._features.get(id_) != feature),
            *self._labels.misfits(change.labels),
            *self._drives.misfits(change),
        ]

    @contextmanager
    def _written(self, change: Change) -> Iterator[sqlite3.Connection]:
        """A transaction that writes the change and the body; memory follows when it is through."""
        extent = extent_after(change, self._features, self._extent)
        self._labels.prepare(change.labels)
        with self._database.transaction() as connection:
            self._refuse_changed_elsewhere()
            self._write(connection, change)
            connection.execute(_EXTENT, extent or (None, None, None, None))
            yield connection
        self._extent = extent
        self._take_over(change)

    def _write(self, connection: sqlite3.Connection, change: Change) -> None:
        crs = self._system_after(change)
        srs_id = srs_number(crs)
        if srs_id != self._srs_id:
            self.write_system(connection, crs)
        connection.executemany(
            "DELETE FROM features WHERE id = ?", [(feature.id,) for feature in change.removed]
        )
        connection.executemany(_INSERT, [self._row(f, srs_id) for f in change.added])
        afters = [pair.after for pair in change.replaced]
        connection.executemany(_UPDATE, [(*self._row(f, srs_id), f.id) for f in afters])
        self._drives.write(connection, change)

    def _system_after(self, change: Change) -> str:
        """What somebody said of the reference system since a step counts more than the step."""
        crs, system = self._settings.text(CRS), change.system
        return crs if system is None or system.before != crs else system.after

    def _take_over(self, change: Change) -> None:
        self.took_system(self._system_after(change))
        for feature in change.removed:
            del self._features[feature.id]
        for pair in change.replaced:
            self._features[pair.after.id] = pair.after
        for feature in change.added:
            self._features[feature.id] = feature
        self._drives.follow(change)

    def _row(self, feature: Feature, srs_id: int) -> tuple[object, ...]:
        return row_of(feature, _layer_of(self._catalogue, feature.kind), srs_id)

    def _stored(self) -> dict[str, Feature]:
        features: dict[str, Feature] = {}
        with _without_collection():
            for row in self._database.rows(_SELECT):
                try:
                    feature = feature_of(row)
                except (ValueError, KeyError, TypeError) as error:
                    reason = f"features.id {row[1]}: {error}"
                    raise damaged(self._database.path, reason) from error
                features[feature.id] = feature
        return features

    def _stored_srs(self) -> int:
        crs = self._settings.text(CRS)
        try:
            return srs_number(crs)
        except ValueError as error:
            raise damaged(self._database.path, f"zuka_settings.crs: {error}") from error

    def _stored_extent(self) -> Bounds | None:
        query = "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'features'"
        for low_x, low_y, high_x, high_y in self._database.rows(query):
            if (
                isinstance(low_x, float)
                and isinstance(low_y, float)
                and isinstance(high_x, float)
                and isinstance(high_y, float)
            ):
                return low_x, low_y, high_x, high_y
        return extent_of(self._features.values())

    def _refuse_changed_elsewhere(self) -> None:
        if self._database.was_changed_elsewhere():
            self._compare()
            self._database.accept_changes()

    def _compare(self) -> None:
        stored = self._stored()
        if stored != self._features:
            ids = [
                id_
                for id_ in {**self._features, **stored}
                if stored.get(id_) != self._features.get(id_)
            ]
            raise changed_elsewhere(self._database.path, ", ".join(ids[:_MOST_IDS_TOLD]))


def _layer_of(catalogue: Catalogue, kind: str) -> str:
    """Empty for a kind that the catalogue doesn't know."""
    return catalogue[kind].layer if kind in catalogue else ""


@contextmanager
def _without_collection() -> Iterator[None]:
    """A map is a million objects without a cycle: looking for cycles takes half of the time."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()

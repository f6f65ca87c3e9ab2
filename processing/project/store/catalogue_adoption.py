"""A project's own catalogue: a file in its folder, always in step with the layers of its map."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from processing.core.errors import UserError
from processing.map.catalogue import Catalogue
from processing.map.catalogue_change import CatalogueComparison, compare, keep_used_kinds
from processing.map.catalogue_file import read_catalogue
from processing.map.catalogue_writing import catalogue_replaced
from processing.project.store.database import Database
from processing.project.store.feature_store import FeatureStore
from resources import path_of

_CATALOGUE = "catalogue.toml"
_BUNDLED = "catalogue/level500.toml"


class CatalogueFile:
    """The catalogue that a project draws by: its own, or the bundled one.

    Parameters
    ----------
    folder : Path
        The project's.

    Attributes
    ----------
    path : Path
        Of the project's own; there may be none.
    current : Catalogue

    Raises
    ------
    NoSpace, BadFile
        The project's own can't be read.
    """

    def __init__(self, folder: Path) -> None:
        self.path = folder / _CATALOGUE
        own_or_bundled = self.path if self.path.is_file() else path_of(_BUNDLED)
        self.current: Catalogue = read_catalogue(own_or_bundled)

    def adopt(
        self, path: Path, features: FeatureStore, database: Database, *, keep_used: bool
    ) -> CatalogueComparison:
        """Take an office's catalogue; see :meth:`processing.project.project.Project`."""
        new = read_catalogue(path)
        comparison = compare(self.current, new, features.all())
        comparison.refuse_losses(path, keep_used=keep_used)
        adopted = keep_used_kinds(new, comparison)
        # An office's file is never written; the project's own, edited by hand, is.
        never = () if path.resolve() == self.path.resolve() else (path,)
        try:
            # The layers are committed first, the file takes its name then. A kill in between is
            # put right by correct_layers at the next opening.
            with (
                catalogue_replaced(self.path, adopted, never=never),
                database.transaction() as connection,
            ):
                features.rewrite_layers(connection, adopted)
        except BaseException:
            self.correct_layers(features, database)
            raise
        self.current = adopted
        features.took_catalogue(adopted)
        return comparison

    def correct_layers(self, features: FeatureStore, database: Database) -> None:
        """Bring the stored layers up to the catalogue, should they differ from it."""
        # Only other programs read them: a full disk shall not keep a project from opening.
        with suppress(UserError):
            if not features.layers_fit():
                with database.transaction() as connection:
                    features.rewrite_layers(connection, self.current)

"""MapSource: what views may ask of the document; reading only."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from processing.map.catalogue import Catalogue
from processing.map.feature import Feature
from processing.project.store.runs import Run
from processing.recording.drive import Drive


class MapSource(Protocol):
    """The open project as views see it; empty answers when none is open."""

    def drives(self) -> tuple[Drive, ...]:
        """All drives."""

    def drive(self, id: str) -> Drive:  # noqa: A002 - the word of the trade
        """One drive; KeyError when there is none of that id."""

    def origin(self) -> NDArray[np.float64]:
        """The (3,) local origin, m, project CRS, that keeps float32 exact enough to draw."""

    def features(self) -> Iterable[Feature]:
        """All features."""

    def feature(self, id: str) -> Feature | None:  # noqa: A002 - the word of the trade
        """One feature, or None."""

    def photo(self, feature: Feature) -> Path | None:
        """The file of a feature's picture, or None."""

    def runs(self) -> tuple[Run, ...]:
        """The runs of tools, the first one first; those whose candidates are gone, too."""

    def catalogue(self) -> Catalogue:
        """The feature kinds."""

    def crs(self) -> str:
        """``EPSG:n``, or empty when unknown."""

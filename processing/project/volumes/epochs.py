"""The epochs of a project: drives recorded together, which are one survey of a site."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import PurePath

import numpy as np

from processing.project.volumes.volume import ChosenSide, SideKind
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive
from processing.recording.measured_day import measured_day
from processing.recording.recorded_together import recordings_of

_GROUND = 2
_LOOKED_AT, _CHUNKS = 1000, 50


@dataclass(frozen=True)
class Epoch:
    """One survey of a site.

    Attributes
    ----------
    drives : tuple of Drive
        One for each station or head.
    name : str
        That of the delivered file, or of the first drive.
    measured_on : date or None
        Its first day, where its points tell.
    """

    drives: tuple[Drive, ...]
    name: str
    measured_on: date | None

    @property
    def side(self) -> ChosenSide:
        """It as one of two grounds."""
        ids = tuple(drive.id for drive in self.drives)
        return ChosenSide(SideKind.EPOCH, self.name, ids, measured_on=self.measured_on)


def epochs_of(drives: Sequence[Drive]) -> tuple[Epoch, ...]:
    """All epochs, older ones first; those without a date behind them, as they were imported."""
    found = [
        Epoch(together, _name_of(together), measured_day(together))
        for together in recordings_of([drive for drive in drives if drive.count])
    ]
    return tuple(sorted(found, key=lambda one: (one.measured_on is None, one.measured_on or 0)))


def has_ground(drive: Drive) -> bool:
    """Whether ground was told from what stands on it, as far as some stretches show."""
    classes = class_columns(drive.columns)
    starts = np.linspace(0, max(drive.count - _LOOKED_AT, 0), _CHUNKS).astype(np.int64)
    return any(
        bool(
            np.any(
                classes.codes_of(np.arange(start, min(start + _LOOKED_AT, drive.count))) == _GROUND
            )
        )
        for start in np.unique(starts).tolist()
    )


def _name_of(drives: Sequence[Drive]) -> str:
    files = {PurePath(source.path).stem for drive in drives for source in drive.info.sources}
    return files.pop() if len(files) == 1 else drives[0].info.name

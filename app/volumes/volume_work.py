"""What a volume has done in the background: functions for a job's thread."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.contours import (
    ContourOptions,
    LevelLine,
    change_lines,
    contour_lines,
)
from processing.methods.earthwork.maps.heat_map import change_limit
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.operations.project_volumes import MadeVolume, make_volume, words_of
from processing.project.volumes.volume import KeptVolume, VolumeRequest
from processing.project.volumes.volume_store import VolumeStore
from processing.recording.drive import Drive
from widgets.shared.shown_volume import ContourOf, VolumeStyle

_SIMPLER_SHARE, _SHORTEST_CELLS = 0.2, 8.0
_MOST_LOOKED_AT = 2_000_000


@dataclass(frozen=True, eq=False)
class LoadedMap:
    """A volume whose map can be shown, and the range that suits it."""

    result: VolumeResult
    limit_m: float


def volume_work(
    request: VolumeRequest, drives: Sequence[Drive], crs: str, into: Path
) -> tuple[Text, Callable[[Monitor], MadeVolume]]:
    """Two grounds are compared; what came of it is written into a new folder.

    Parameters
    ----------
    drives, crs, into
        As of :func:`processing.operations.project_volumes.make_volume`.
    """

    def work(monitor: Monitor) -> MadeVolume:
        return make_volume(request, drives, crs, into, monitor)

    return words_of(request), work


def map_work(store: VolumeStore, kept: KeptVolume) -> Callable[[], LoadedMap]:
    """A kept volume is read, and how far the colours of its map should reach."""

    def work() -> LoadedMap:
        result = store.read_result(kept)
        change = result.change
        step = max(1, round((change.change_m.size / _MOST_LOOKED_AT) ** 0.5))
        return LoadedMap(result, change_limit(change.change_m[::step, ::step]))

    return work


def contours_of(change: ChangeGrid, look: VolumeStyle, monitor: Monitor) -> tuple[LevelLine, ...]:
    """The contours that are wished over a map; none where none are.

    Raises
    ------
    OutOfRange
        The interval gives too many of them.
    """
    request = ContourOptions(
        look.interval_m,
        simplify_m=_SIMPLER_SHARE * change.grid.size_m,
        shortest_m=_SHORTEST_CELLS * change.grid.size_m,
    )
    match look.contours:
        case ContourOf.NOTHING:
            return ()
        case ContourOf.CHANGE:
            return change_lines(change, request, monitor)
    ground = change.before if look.contours is ContourOf.BEFORE else change.after
    within = np.where(change.inside > 0, ground, np.float32(np.nan))
    return contour_lines(change.grid, within, request, monitor)

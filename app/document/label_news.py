"""A change of labels told to the views, tile by tile or drive by drive, so that it is seen."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from processing.image.attributes.tile_cache import TileCache
from processing.map.label_change import LabelChange
from processing.recording.drive import Drive
from widgets.shared.map_changes import MapChanges

_MANY_POINTS = 4_000_000
"""More than so many of a drive are most of its tiles: all are made anew, without looking which."""


def report_labels(
    labels: tuple[tuple[Drive, LabelChange], ...],
    filed: Iterable[str],
    tiles: TileCache,
    map_changes: MapChanges,
) -> None:
    """Drop the tiles whose points have other labels now, and tell the views.

    Parameters
    ----------
    filed : iterable of str
        Drives in which so many points have other labels that they were filed.
    """
    counts: dict[str, int] = dict.fromkeys(filed, _MANY_POINTS + 1)
    for drive, label in labels:
        counts[drive.id] = counts.get(drive.id, 0) + label.count
    # The first classes of a drive take the place of what it was shown by without any.
    counts |= {id_: _MANY_POINTS + 1 for id_ in counts if tiles.is_stand_in(id_)}
    for id_, count in counts.items():
        if count > _MANY_POINTS:
            tiles.drop(id_)
            map_changes.drive_columns_changed.emit(id_)
            map_changes.labels_changed.emit(id_, np.empty(0, np.int64))
    for drive, label in labels:
        if counts[drive.id] <= _MANY_POINTS:
            points = label.unpacked_points()
            tiles.drop_relabelled(drive, points)
            map_changes.labels_changed.emit(drive.id, points)

"""A change of labels told to the views tile by tile, so that it is seen at once."""

from __future__ import annotations

from processing.image.tile_cache import TileCache
from processing.points.drive import Drive
from processing.project.label_change import LabelChange
from widgets.shared.map_changes import MapChanges


def tell_labels(
    labels: tuple[tuple[Drive, LabelChange], ...], tiles: TileCache, map_changes: MapChanges
) -> None:
    """Drop the tiles whose points have other labels now, and tell the views."""
    for drive, label in labels:
        points = label.unpacked_points()
        tiles.drop_relabelled(drive, points)
        map_changes.labels_changed.emit(drive.id, points)

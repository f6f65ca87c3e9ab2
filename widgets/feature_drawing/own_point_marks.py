"""Own points of chosen features in the views: where they lie, how they are drawn."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from processing.core.arrays import Floats, Integers
from processing.map.feature import Feature
from processing.recording.drive import Drive
from widgets.feature_drawing.crowded_marks import marks_to_paint
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

MOST_FEATURES = 50
"""Of more chosen ones no points are shown: who chooses them all doesn't look at one."""

_DOT_PX, _HALO_PX = 2.5, 4.5
_HALO = QColor("#0b0d10")


class OwnPointPlaces:
    """The own points of the chosen features, looked up once.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
        Says what is chosen, shown and being edited.
    """

    def __init__(self, source: MapSource, shared: SharedState) -> None:
        self._source = source
        self._shared = shared
        self._known: dict[str, tuple[Feature, tuple[Drive, ...], Floats]] = {}

    def features(self) -> Iterator[Feature]:
        """Those that have points to show; none where very many are chosen."""
        chosen, drawing = self._shared.selection.features, self._shared.sketch.drawing
        if len(chosen) > MOST_FEATURES:
            return
        for id_ in sorted(chosen):
            feature = self._source.feature(id_)
            if feature is None or (drawing is not None and drawing.replaces == id_):
                continue
            if feature.own_points and self._shared.view_settings.shows(feature):
                yield feature

    def xyz(self, feature: Feature) -> Floats:
        """(n, 3) float64: where a feature's points lie, m, project CRS."""
        known, drives = self._known.get(feature.id), self._source.drives()
        if known is None or known[0] is not feature or known[1] != drives:
            parts = [drive.xyz(points_in(drive, feature)) for drive in drives]
            if len(self._known) > MOST_FEATURES:
                self._known.clear()
            known = feature, drives, np.concatenate([np.empty((0, 3)), *parts])
            self._known[feature.id] = known
        return known[2]


def points_in(drive: Drive, feature: Feature) -> Integers:
    """(n,) int64: the own points of a feature that are of a drive."""
    found = [own.numbers(drive.count) for own in feature.own_points if own.drive == drive.id]
    return np.concatenate([np.empty(0, np.int64), *found])


def paint_own_points(painter: QPainter, spots: Floats, colour: str) -> None:
    """Paint a dot for each point, small enough to leave the picture below readable.

    Parameters
    ----------
    spots : (n, 2) float64
        Widget pixels; NaN where a point isn't in the picture.
    """
    room = painter.viewport()
    seen = spots[marks_to_paint(spots, room.width(), room.height())]
    dots = [QPointF(x, y) for x, y in seen.tolist()]
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    for tint, size_px in ((_HALO, _HALO_PX), (QColor(colour), _DOT_PX)):
        pen = QPen(tint, size_px)
        pen.setCapStyle(Qt.PenCapStyle.RoundCap)
        painter.setPen(pen)
        painter.drawPoints(dots)

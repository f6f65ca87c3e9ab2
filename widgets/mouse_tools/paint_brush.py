"""PaintBrush: labels points within a circle that is dragged over what is measured."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject
from typing_extensions import override

from processing.labels.strokes import points_under_brush, way_is_short
from processing.project.feature import PointReference
from widgets.mouse_tools.mouse_tool import Hit
from widgets.mouse_tools.paint_tool import PaintTool
from widgets.mouse_tools.tracing import AtHand
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState


class PaintBrush(PaintTool):
    """Press, drag, release: all measured points as near to the brush as its radius.

    Only points of the drive that was pressed on are painted, however many lie in one place.
    """

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        at_hand: AtHand,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(source, shared, at_hand, parent)
        self._drive = ""
        self._last = np.zeros(3)
        self._points = np.empty(0, np.int64)

    @override
    def press(self, hit: Hit) -> None:
        measured = _measured(hit)
        if measured is None or hit.place is None:
            return
        self._begin()
        self._drive = measured.drive
        self._last = np.array(hit.place.xyz)
        self._points = np.empty(0, np.int64)
        self._go_to(self._last)

    @override
    def move(self, hit: Hit) -> None:
        measured = _measured(hit)
        if self.is_pressed and measured is not None and measured.drive == self._drive and hit.place:
            self._go_to(np.array(hit.place.xyz))

    @override
    def release(self, hit: Hit) -> None:
        if not self.is_pressed:
            return
        self.move(hit)
        self._paint({self._drive: self._points})

    def _go_to(self, place: NDArray[np.float64]) -> None:
        radius_m = self._shared.labels.radius_m
        start = self._last if way_is_short(self._last, place, radius_m) else place
        drive = self._source.drive(self._drive)
        found = points_under_brush(drive, start, place, radius_m)
        self._last = place
        joined = np.union1d(self._points, found)
        if joined.size > self._points.size:
            self._points = joined
            self._show_stroke({self._drive: joined})


def _measured(hit: Hit) -> PointReference | None:
    return None if hit.place is None else hit.place.measured

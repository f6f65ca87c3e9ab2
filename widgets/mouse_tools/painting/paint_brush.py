"""PaintBrush: labels points within a circle that is dragged over what is measured."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject
from typing_extensions import override

from processing.core.arrays import Floats
from processing.image.images_of_drives import image_of
from processing.labels.strokes import points_in_slab, points_under_brush, stroke_is_short
from processing.map.feature import PointReference
from processing.section.cut import Cut
from widgets.mouse_tools.mouse_tool import Hit
from widgets.mouse_tools.painting.paint_tool import PaintTool
from widgets.mouse_tools.tracing import BackgroundRunner
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState


class PaintBrush(PaintTool):
    """Press, drag, release: all measured points as near to the brush as its radius.

    On a surface the brush is a ball, and only points of the drive that was pressed on are painted,
    however many lie in one place. In a section it is a circle in the picture, and means the points
    of the slab that it covers, of every drive that is shown.
    """

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        in_background: BackgroundRunner,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(source, shared, in_background, parent)
        self._drives: tuple[str, ...] = ()
        self._slab: Cut | None = None
        self._last = np.zeros(3)
        self._points: dict[str, NDArray[np.int64]] = {}

    @override
    def press(self, hit: Hit) -> None:
        self._slab = None if hit.ray is None else hit.ray.slab
        measured = _measured_point(hit)
        if self._slab is not None:
            self._drives = self._drives_in_sections()
        elif measured is not None:
            self._drives = (measured.drive,)
        else:
            return
        position = self._position_of(hit)
        if position is None:
            return
        self._begin()
        self._last, self._points = position, {}
        self._go_to(position)

    @override
    def move(self, hit: Hit) -> None:
        position = self._position_of(hit) if self.is_pressed else None
        if position is not None:
            self._go_to(position)

    @override
    def release(self, hit: Hit) -> None:
        if not self.is_pressed:
            return
        self.move(hit)
        self._paint(dict(self._points))

    def _position_of(self, hit: Hit) -> Floats | None:
        """Where the brush is: in space, or offset and height; None where it paints nothing."""
        if self._slab is not None:
            if hit.ray is None or hit.ray.slab != self._slab:
                return None
            position: Floats = self._slab.to_section([hit.ray.origin])[0, :2]
            return position
        measured = _measured_point(hit)
        if measured is None or measured.drive not in self._drives or hit.position is None:
            return None
        return np.array(hit.position.xyz)

    def _go_to(self, position: Floats) -> None:
        radius_m = self._shared.labels.radius_m
        # Off the edge of a surface the mouse jumps to another; over a section it doesn't.
        is_way = self._slab is not None or stroke_is_short(self._last, position, radius_m)
        start = self._last if is_way else position
        self._last = position
        is_more = False
        for id_ in self._drives:
            drive, before = self._source.drive(id_), self._points.get(id_, np.empty(0, np.int64))
            if self._slab is None:
                found = points_under_brush(drive, start, position, radius_m)
            else:
                found = points_in_slab(drive, self._slab, np.stack([start, position]), radius_m)
            joined = np.union1d(before, found)
            if joined.size > before.size:
                self._points[id_] = joined
                is_more = True
        if is_more:
            self._show_stroke(self._points)

    def _drives_in_sections(self) -> tuple[str, ...]:
        """The drives that sections show, but for those whose tiles aren't known yet."""
        hidden = self._shared.view_settings.hidden_drives
        return tuple(
            drive.id
            for drive in self._source.drives()
            if drive.count
            and drive.id not in hidden
            and image_of(drive, drive.image_kinds[-1]).pyramid.is_ready
        )


def _measured_point(hit: Hit) -> PointReference | None:
    return None if hit.position is None else hit.position.measured

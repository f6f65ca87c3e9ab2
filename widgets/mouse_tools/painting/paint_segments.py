"""PaintSegments: labels whole connected segments, by a click or by all that a drag touches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject
from typing_extensions import override

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.labels.strokes import (
    points_of_segment,
    points_under_brush,
    segments_of,
    stroke_is_short,
)
from processing.recording.drive import Drive
from widgets.mouse_tools.mouse_tool import Hit
from widgets.mouse_tools.painting.paint_tool import PaintedPoints, PaintTool
from widgets.mouse_tools.tracing import BackgroundRunner
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

NO_SEGMENTS = Text(
    "The drive has no segments yet: wait for them, or run the tool “Segments”.",
    "セグメントがまだありません。検出を待つか「セグメント分割」を実行してください。",
)
IN_NO_SEGMENT = Text("That point belongs to no segment.", "この点はセグメントに属していません。")
_WAY_RADIUS_M = 0.03


class PaintSegments(PaintTool):
    """A click labels the segment under it; a drag floods every segment that it goes over."""

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        in_background: BackgroundRunner,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(source, shared, in_background, parent)
        self._drive: Drive | None = None
        self._last = np.zeros(3)
        self._found: dict[int, NDArray[np.int64]] = {}

    @override
    def press(self, hit: Hit) -> None:
        if hit.position is None or hit.position.measured is None:
            return
        drive = self._source.drive(hit.position.measured.drive)
        try:
            (segment,) = segments_of(drive, np.array([hit.position.measured.point])).tolist()
        except Unsuitable:
            self.reported.emit(NO_SEGMENTS)
            return
        self._begin()
        self._drive, self._found = drive, {}
        self._last = np.array(hit.position.xyz)
        if segment < 0:
            self.reported.emit(IN_NO_SEGMENT)
        else:
            self._flood(drive, (segment,))

    @override
    def move(self, hit: Hit) -> None:
        drive = self._drive
        if (
            not self.is_pressed
            or drive is None
            or hit.position is None
            or hit.position.measured is None
        ):
            return
        if hit.position.measured.drive != drive.id:
            return
        start, position = self._last, np.array(hit.position.xyz)
        self._last = position
        points = np.array([hit.position.measured.point])
        if start.tolist() != position.tolist() and stroke_is_short(start, position, _WAY_RADIUS_M):
            points = np.append(points, points_under_brush(drive, start, position, _WAY_RADIUS_M))
        touched = np.unique(segments_of(drive, points))
        self._flood(drive, tuple(touched[touched >= 0].tolist()))

    @override
    def release(self, hit: Hit) -> None:
        drive, found = self._drive, self._found
        if not self.is_pressed or drive is None:
            return
        self.move(hit)
        segments = tuple(found)

        def points_of() -> PaintedPoints:
            # What the drag has shown was found before this: one thread does it all in order.
            parts = [_points_in(drive, segment, found) for segment in segments]
            return {drive.id: np.sort(np.concatenate(parts))} if parts else {}

        self._paint_later(points_of)

    def _flood(self, drive: Drive, segments: tuple[int, ...]) -> None:
        found, stroke = self._found, self._stroke
        new = [segment for segment in segments if segment not in found]
        if not new:
            return
        for segment in new:
            found[segment] = np.empty(0, np.int64)

        def work() -> bool:
            for segment in new:
                _points_in(drive, segment, found)
            return True

        def take(_done: object) -> None:
            if stroke is not None and self._stroke is stroke:
                parts = np.sort(np.concatenate(list(found.values())))
                self._show_stroke({drive.id: parts})

        self._in_background(work, take)


def _points_in(
    drive: Drive, segment: int, found: dict[int, NDArray[np.int64]]
) -> NDArray[np.int64]:
    """The points of a segment, looked up once."""
    if not found[segment].size:
        found[segment] = points_of_segment(drive, segment)
    return found[segment]

"""Splitting, extending and trimming lines by clicks on them."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from PySide6.QtCore import QObject
from typing_extensions import override

from processing.core.errors import UserError
from processing.core.text import Text
from processing.map.change import Change, Replacement
from processing.map.drafting.line_edits import split_line
from processing.map.drafting.line_joins import extend_to, trim_at
from processing.map.feature import Feature, Position, Vertex
from widgets.mouse_tools.editing_tool import EditingTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

SPLIT = Text("Split a line", "線の分割")
EXTEND = Text("Extend a line", "線の延伸")
TRIM = Text("Trim a line", "線の切り取り")

PICK_TARGET = Text(
    "Now click on the line to extend it to.", "次に、延ばす先の線をクリックしてください。"
)
PICK_REST = Text(
    "Now click on the part of the line to keep.",
    "次に、残す側の線の部分をクリックしてください。",
)


class SplitLine(EditingTool):
    """A click on a line makes two of it there."""

    @override
    def press(self, hit: Hit) -> None:
        line = self._line_of(hit)
        if line is None:
            return
        segment = hit.segment if hit.segment >= 0 else max(hit.vertex - 1, 0)
        vertex = line.vertices[hit.vertex] if hit.vertex >= 0 else _on_segment(line, segment, hit)
        try:
            first, second = split_line(line, segment, vertex)
        except UserError as refusal:
            self._report_refusal(refusal)
            return
        self.change_requested.emit(
            SPLIT, Change(added=(second,), replaced=(Replacement(line, first),))
        )


class ExtendLine(EditingTool):
    """The first click takes a line's end, the second says up to which line it goes on."""

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(source, shared, parent)
        self._line: Feature | None = None
        self._end: Literal["start", "end"] = "end"

    @property
    @override
    def is_busy(self) -> bool:
        return self._line is not None

    @override
    def press(self, hit: Hit) -> None:
        picked = self._line_of(hit)
        if picked is None:
            return
        line = None if self._line is None else self._source.feature(self._line.id)
        if line is None:
            self._line, self._end = picked, _nearer_end(picked, hit)
            self._selection.choose_features(frozenset({picked.id}))
            self.reported.emit(PICK_TARGET)
            return
        self.put_down()
        try:
            self._replace(EXTEND, line, extend_to(line, picked, self._end))
        except UserError as refusal:
            self._report_refusal(refusal)

    @override
    def put_down(self) -> None:
        self._line = None


class TrimLine(EditingTool):
    """The first click takes the line that cuts, the next ones the parts that stay."""

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(source, shared, parent)
        self._cutter = ""

    @property
    @override
    def is_busy(self) -> bool:
        return bool(self._cutter)

    @override
    def press(self, hit: Hit) -> None:
        picked = self._line_of(hit)
        if picked is None:
            return
        cutter = self._source.feature(self._cutter) if self._cutter else None
        if cutter is None or picked.id == cutter.id:
            self._cutter = picked.id
            self._selection.choose_features(frozenset({picked.id}))
            self.reported.emit(PICK_REST)
            return
        try:
            self._replace(
                TRIM, picked, trim_at(picked, cutter, _find_clicked_position(picked, hit))
            )
        except UserError as refusal:
            self._report_refusal(refusal)

    @override
    def put_down(self) -> None:
        self._cutter = ""


def _find_clicked_position(line: Feature, hit: Hit) -> Position:
    """Where the line was clicked: the point there, or the middle of the segment."""
    if hit.vertex >= 0:
        return line.vertices[hit.vertex].xyz
    return _on_segment(line, max(hit.segment, 0), hit).xyz


def _on_segment(line: Feature, segment: int, hit: Hit) -> Vertex:
    """The place of a segment nearest in plan to the point that was clicked."""
    start, end = (np.array(line.vertices[segment + position].xyz) for position in (0, 1))
    way = end - start
    share = 0.5
    if hit.position is not None:
        offset = np.array(hit.position.xyz) - start
        share = float(offset[:2] @ way[:2]) / max(float(way[:2] @ way[:2]), 1e-12)
    east, north, up = (start + min(max(share, 0.0), 1.0) * way).tolist()
    return Vertex((east, north, up))


def _nearer_end(line: Feature, hit: Hit) -> Literal["start", "end"]:
    clicked = _find_clicked_position(line, hit)
    first, last = (math.dist(line.vertices[position].xyz, clicked) for position in (0, -1))
    return "start" if first < last else "end"

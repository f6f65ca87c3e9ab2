"""Tracing: the line between two clicks that follows the recording, found in the background."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from processing.core.text import Text
from processing.image.search.nearest import nearest_point
from processing.image.tracing.trace import TraceResult, trace
from processing.map.feature import PointReference, Vertex
from processing.recording.drive import Drive
from widgets.shared.map_source import MapSource

STRAIGHT_ON = Text(
    "Where nothing could be followed the line goes straight.",
    "追跡できない区間は直線でつなぎました。",
)
_SAME_EDGE_M = 0.15


class BackgroundRunner(Protocol):
    """Does short work in the background for what is in the hand, and gives its result back."""

    def __call__(self, work: Callable[[], object], take: Callable[[object | None], None]) -> None:
        """Work in a thread; ``take`` gets the result on the window's thread, None if it failed."""


@dataclass(frozen=True)
class TracedLine:
    """What was followed.

    Attributes
    ----------
    vertices : tuple of Vertex
        Behind the start; empty where nothing could be followed.
    is_complete : bool
        Whether it came to the end that was clicked.
    reason : Text
        Why it did not, or how it came there all the same.
    """

    vertices: tuple[Vertex, ...]
    is_complete: bool
    reason: Text

    def going_straight_to(self, end: Vertex) -> TracedLine:
        """The line led on to where it was told to go, though nothing could be followed there."""
        if self.is_complete:
            return self
        return TracedLine((*self.vertices, end), is_complete=True, reason=STRAIGHT_ON)


def tracing_work(
    source: MapSource, through: tuple[Vertex, ...], *, across_gaps: bool
) -> Callable[[], TracedLine] | None:
    """The work of following the recording through some vertices, None where nothing is measured.

    Parameters
    ----------
    through : tuple of Vertex
        Start, places that it must pass, end.
    across_gaps : bool
        Whether stretches without points are bridged.
    """
    drives = [vertex.measured.drive for vertex in through if vertex.measured is not None]
    if not drives:
        return None
    drive = source.drive(drives[-1])

    def work() -> TracedLine:
        points = [_point_of(drive, vertex) for vertex in through]
        found: list[Vertex] = []
        for (start, end), clicked in zip(itertools.pairwise(points), through[1:], strict=True):
            if start < 0 or end < 0:
                return TracedLine(tuple(found), is_complete=False, reason=_NOT_MEASURED)
            traced = trace(drive, start, end, across_gaps=across_gaps)
            vertices = _vertices(drive, traced)[1:]
            if not traced.is_complete:
                return TracedLine((*found, *vertices), is_complete=False, reason=traced.reason)
            # What was clicked stays where it was clicked: a hold finds its clicks again by them.
            found += [*vertices[:-1], clicked]
        return TracedLine(tuple(found), is_complete=True, reason=Text("", ""))

    return work


_NOT_MEASURED = Text(
    "There is no measured point of this drive to follow; click on points of one drive.",
    "この走行データの計測点がないため追跡できません。同じ走行データの点をクリックしてください。",
)


def _point_of(drive: Drive, vertex: Vertex) -> int:
    if vertex.measured is not None and vertex.measured.drive == drive.id:
        return vertex.measured.point
    return nearest_point(drive, np.array(vertex.xyz), _SAME_EDGE_M)


def _vertices(drive: Drive, traced: TraceResult) -> list[Vertex]:
    return [
        Vertex((east, north, up), PointReference(drive.id, point))
        for (east, north, up), point in zip(
            traced.xyz.tolist(), traced.points.tolist(), strict=True
        )
    ]

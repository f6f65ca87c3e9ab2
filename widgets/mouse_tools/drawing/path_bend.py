"""PathBend: a traced piece of the drawing, dragged to where it should pass."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from processing.map.feature import Vertex
from widgets.mouse_tools.drawing.legs import DrawnPath, Leg, LegMode


@dataclass(frozen=True)
class PathBend:
    """Hold of a traced leg between two of its vertices.

    Attributes
    ----------
    leg : int
        Its number in the path.
    segment : int
        Vertices of the leg before the place that is held.
    via : Vertex or None
        Where the mouse is; None before it moved.
    """

    leg: int
    segment: int
    via: Vertex | None = None

    def moved_to(self, vertex: Vertex) -> PathBend:
        """The same hold with the mouse elsewhere."""
        return replace(self, via=vertex)

    def clicked_of(self, leg: Leg) -> tuple[Vertex, ...]:
        """The clicks of the leg with the new one where it belongs."""
        if self.via is None:
            return leg.clicked
        passed = set(leg.vertices[: self.segment])
        before = tuple(one for one in leg.clicked[:-1] if one in passed)
        after = tuple(one for one in leg.clicked if one not in before)
        return (*before, self.via, *after)

    def shown_in(self, path: DrawnPath) -> DrawnPath:
        """The path as it is shown while the mouse drags."""
        leg = path.legs[self.leg]
        via = () if self.via is None else (self.via,)
        vertices = (*leg.vertices[: self.segment], *via, *leg.vertices[self.segment :])
        bent = replace(leg, vertices=vertices)
        return replace(path, legs=(*path.legs[: self.leg], bent, *path.legs[self.leg + 1 :]))


def bend_at(path: DrawnPath, vertex: Vertex, reach_m: float) -> PathBend | None:
    """Take hold of the last traced leg within reach of a place, but not at its ends."""
    if not path.legs or path.legs[-1].mode is not LegMode.TRACE or reach_m <= 0:
        return None
    number = len(path.legs) - 1
    start = DrawnPath(path.start, path.legs[:number]).end
    if start is None:
        return None
    line = np.array([start.xyz, *(one.xyz for one in path.legs[number].vertices)])
    held = np.array(vertex.xyz)
    ends = np.hypot(*(line[[0, -1], :2] - held[:2]).T)
    if ends.min() <= reach_m:
        return None
    begins, ways = line[:-1, :2], np.diff(line[:, :2], axis=0)
    squares = np.maximum((ways**2).sum(axis=1), 1e-12)
    share = np.clip(((held[:2] - begins) * ways).sum(axis=1) / squares, 0.0, 1.0)
    away = np.hypot(*(begins + share[:, None] * ways - held[:2]).T)
    nearest = int(np.argmin(away))
    return PathBend(number, nearest) if away[nearest] <= reach_m else None

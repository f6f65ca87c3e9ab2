"""A line along a road by whose metres and square to which everything is measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.methods.road.objects.drive_passes import passes_of
from processing.recording.drive import Drive

NODE_M = 1.0
"""Between the nodes of a frame: curves of 15 m radius leave their chords by 8 mm."""

_DIRECTION_NODES = 2
"""To either side, over which the direction at a node is taken: a trajectory's own jitter of a
centimetre turns it by a quarter of a degree."""

_FEWEST = 3
"""A direction needs a node on either side."""

_MOVED_M = 0.5
"""A vehicle that hasn't moved as far stands."""


@dataclass(frozen=True)
class RoadFrame:
    """Nodes along a line.

    Attributes
    ----------
    nodes : (n, 2) float64
        A metre apart in plan, the last rest left out; m about an origin.
    directions : (n, 2) float64
        Ahead, of length 1.
    start_m : float
        Station of the first node.
    """

    nodes: Floats
    directions: Floats
    start_m: float = 0.0

    @staticmethod
    def along(xy: Floats, start_m: float = 0.0) -> RoadFrame | None:
        """The frame of a line (n, 2); None where it is shorter than two metres."""
        steps = np.hypot(*np.diff(xy, axis=0).T) if len(xy) > 1 else np.empty(0)
        reached = np.concatenate([[0.0], np.cumsum(steps)])
        at = np.arange(0.0, reached[-1], NODE_M)
        if at.size < _FEWEST:
            return None
        nodes = np.column_stack([np.interp(at, reached, axis) for axis in xy.T])
        numbers = np.arange(at.size)
        ahead = nodes[np.minimum(numbers + _DIRECTION_NODES, at.size - 1)]
        ways = ahead - nodes[np.maximum(numbers - _DIRECTION_NODES, 0)]
        lengths = np.linalg.norm(ways, axis=1, keepdims=True)
        return RoadFrame(nodes, ways / np.where(lengths > 0, lengths, 1.0), start_m)

    @property
    def end_m(self) -> float:
        """Station of the last node."""
        return self.start_m + NODE_M * (len(self.nodes) - 1)

    def places(self, stations: Floats, offsets: Floats) -> Floats:
        """Places (n, m, 2) at stations (n,) and offsets (m,) to the left, m."""
        at = (stations - self.start_m) / NODE_M
        numbers = np.arange(len(self.nodes))
        feet = np.column_stack([np.interp(at, numbers, axis) for axis in self.nodes.T])
        ways = np.column_stack([np.interp(at, numbers, axis) for axis in self.directions.T])
        normals = np.column_stack([-ways[:, 1], ways[:, 0]])
        places: Floats = feet[:, None] + offsets[None, :, None] * normals[:, None]
        return places

    def located(self, places: Floats, nearest: Integers) -> tuple[Floats, Floats]:
        """Station and offset of places (n, 2), whose nearest nodes are known."""
        beside, ways = places - self.nodes[nearest], self.directions[nearest]
        ahead = (beside * ways).sum(axis=1)
        aside = ways[:, 0] * beside[:, 1] - ways[:, 1] * beside[:, 0]
        return self.start_m + NODE_M * nearest + ahead, aside


def driven_lines(drives: Sequence[Drive]) -> list[Floats]:
    """Where the vehicle went, a line (n, 2) for each pass, m, project CRS; standstills left out."""
    lines = []
    for members in passes_of(drives):
        paths = [path for one in members if (path := drives[one].trajectory) is not None]
        if paths:
            lines.append(_moved(paths[0].xyz[:, :2]))
    return [one for one in lines if len(one) > 1]


def _moved(xy: Floats) -> Floats:
    """Places at least half a metre apart."""
    kept, last = [0], xy[0]
    steps = np.hypot(*np.diff(xy, axis=0).T)
    # Where it surely moved, every record is looked at; elsewhere the sums of steps say nothing.
    for number in np.flatnonzero(np.concatenate([[0.0], steps]) >= 0).tolist():
        if np.hypot(*(xy[number] - last)) >= _MOVED_M:
            kept.append(number)
            last = xy[number]
    return np.asarray(xy[kept])

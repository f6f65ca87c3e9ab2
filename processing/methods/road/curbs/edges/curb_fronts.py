"""Which curbs stand between the vehicle's path and others: what another one has raised."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.methods.road.curbs.edges.curb_lines import CurbLine
from processing.recording.drive import Drive

_Floats = NDArray[np.float64]

_SPACING_M = 0.5
"""Between places of the vehicle's path: finer than any curb turns away from another."""

_BEHIND_M = 0.1
"""A line so much farther from the path than another lies behind it: less than a kerb stone's
width."""


class PathSides:
    """Places beside the vehicles' paths of a survey: how far along and how far aside."""

    def __init__(self, drives: Sequence[Drive]) -> None:
        paths = [_thinned(one.trajectory.xyz[:, :2]) for one in drives if one.trajectory]
        self._path = np.vstack(paths) if paths else np.zeros((1, 2))
        ahead = [np.gradient(one, axis=0) if len(one) > 1 else np.ones_like(one) for one in paths]
        self._ahead = np.vstack(ahead) if ahead else np.ones((1, 2))
        self._tree = cKDTree(self._path)

    def of(self, xyz: _Floats) -> tuple[NDArray[np.int64], _Floats]:
        """(n,) the nearest place of the paths and the side, as one number; and m away from it."""
        away, nearest = self._tree.query(xyz[:, :2])
        ahead, off = self._ahead[nearest], xyz[:, :2] - self._path[nearest]
        is_left = ahead[:, 0] * off[:, 1] - ahead[:, 1] * off[:, 0] > 0
        return 2 * np.asarray(nearest, np.int64) + is_left, np.asarray(away)

    @property
    def count(self) -> int:
        """Of the numbers that `of` gives."""
        return 2 * len(self._path)

    def is_left(self, xyz: _Floats) -> bool:
        """Whether most of some places lie on the left."""
        return bool((self.of(xyz)[0] % 2).mean() > 0.5)


def raised_shares(
    lines: Sequence[CurbLine], is_front: Sequence[bool], sides: PathSides
) -> list[float]:
    """The share of each line that lies behind another one that is a front, 0 to 1."""
    placed = [sides.of(line.lower) for line in lines]
    nearest = np.full(sides.count, np.inf)
    for (at, away), counts in zip(placed, is_front, strict=True):
        if counts:
            np.minimum.at(nearest, at, away)
    return [float((away > nearest[at] + _BEHIND_M).mean()) for at, away in placed]


def _thinned(path: _Floats) -> _Floats:
    """A path without places that lie nearer to each other."""
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(path, axis=0).T)))
    count = max(2, round(float(along[-1]) / _SPACING_M) + 1)
    at = np.linspace(0.0, float(along[-1]), count)
    return np.column_stack([np.interp(at, along, column) for column in path.T])

"""Exact edges: carriageway, face and top fitted to all points about a rough curb line."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.road.curbs.edges.approximate_lines import ApproximateLine
from processing.methods.road.curbs.edges.curb_edge_kernels import edges_kernel
from processing.methods.road.curbs.edges.curb_points import ChosenPoints, LineCells, PointsAbout
from processing.methods.road.curbs.edges.edge_measures import (
    ASKEW,
    HIDDEN,
    MEASURES,
    STEP_M,
    VISIBLE,
    Window,
)
from processing.recording.drive import Drive
from processing.recording.vehicle_path.trajectory import Trajectory

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_SEEN_FROM = (0.0, -1.0, 1.0)
"""Where on the vehicle's path a face is looked at from: the nearest place, and as far before and
behind it as that is away (45° aside), from where curbs of side streets show their faces."""

_LEAST_FRONT = 0.1
"""Sine of the least angle (6°) between a face and the sight of it: at flatter ones pulses pass over
a face 15 cm high within 1.5 m of ground, and its points are none that tell a plane."""

_ASKEW = math.sin(math.radians(45.0))
"""Sine of the angle below which a face is looked at rather along than across from the nearest
place: whether it shows depends on where the scanner looks."""

_LEAST_AWAY_M = 1e-3
"""Guard of a division."""


@dataclass(frozen=True)
class EdgeSettings:
    """What points say about an edge.

    Attributes
    ----------
    along_m, across_m : float
        How far along and across the road points are looked at; Takahashi 2022, Table 6-1: 0.5 m,
        0.4 m.
    inlier_m : float
        How far a point may lie off a surface; Table 6-1: 5 mm.
    enough_points : int
        Where a window half as long holds as many, it is used: some 25 for each of the three
        surfaces. By trial.
    """

    along_m: float = 0.5
    across_m: float = 0.4
    inlier_m: float = 0.005
    enough_points: int = 80


@dataclass(frozen=True)
class MeasuredEdges:
    """What one drive shows of one approximate line.

    Attributes
    ----------
    measures : (m, MEASURES) float64
        At its stations; NaN where too few points lie about one.
    along : (n,) float64
        The points about it, rising, in stations.
    across_above : (n, 2) float64
        m from its line.
    points : (n,) int64
        Their indices in the drive.
    """

    measures: _Floats
    along: _Floats
    across_above: _Floats
    points: _Integers

    def nearest(self, positions: _Floats, within_m: float) -> tuple[_Integers, _Floats]:
        """The measured points nearest to places in an approximate line's frame, and how far.

        Parameters
        ----------
        positions : (k, 3) float64
            Stations, rising; m across and above.

        Returns
        -------
        points : (k,) int64
            −1 where none is near enough.
        away_m : (k,) float64
            Across and above; infinite where there is none.
        """
        found = np.full(positions.shape[0], -1, np.int64)
        nearest_kernel(self.along, self.across_above, positions, within_m, found)
        has = found >= 0
        points, away = found.copy(), np.full(found.size, np.inf)
        points[has] = self.points[found[has]]
        off = self.across_above[found[has]] - positions[has, 1:]
        away[has] = np.hypot(off[:, 0], off[:, 1])
        return points, away


def measure_edges(
    drive: Drive,
    approximate_lines: Sequence[ApproximateLine],
    settings: EdgeSettings,
    monitor: Monitor,
) -> list[MeasuredEdges]:
    """Edges at the stations of approximate lines, as one drive shows them."""
    if not approximate_lines:
        return []
    about = LineCells(approximate_lines, settings.across_m).about(drive, monitor)
    monitor.check()
    return _measure(drive, approximate_lines, about, settings)


def measure_edges_among(
    drive: Drive,
    approximate_lines: Sequence[ApproximateLine],
    chosen: ChosenPoints,
    settings: EdgeSettings,
) -> list[MeasuredEdges]:
    """The same by some points of the drive."""
    about = LineCells(approximate_lines, settings.across_m).among(drive, chosen)
    return _measure(drive, approximate_lines, about, settings)


def _measure(
    drive: Drive,
    approximate_lines: Sequence[ApproximateLine],
    about: PointsAbout,
    settings: EdgeSettings,
) -> list[MeasuredEdges]:
    measured = []
    views = _views(approximate_lines, drive.trajectory)
    first = 0
    for number, approximate_line in enumerate(approximate_lines):
        part = slice(int(about.starts[number]), int(about.starts[number + 1]))
        along = about.along[part]
        positions = np.column_stack([about.across[part], about.above[part]])
        view = views[first : first + approximate_line.width_m.size]
        first += view.size
        stations = np.column_stack(
            [approximate_line.width_m, view, approximate_line.step_m, approximate_line.is_edging]
        )
        measures = _edges(along, positions, stations, settings)
        measured.append(MeasuredEdges(measures, along, positions, about.point[part]))
    return measured


def _views(approximate_lines: Sequence[ApproximateLine], trajectory: Trajectory | None) -> _Floats:
    """(m,) how the faces of approximate lines are seen, line by line, for `edges_kernel`."""
    if trajectory is None:
        hidden = [approximate_line.is_hidden for approximate_line in approximate_lines]
        return np.where(np.concatenate(hidden), HIDDEN, VISIBLE)
    xy = np.vstack([approximate_line.xyz[:, :2] for approximate_line in approximate_lines])
    outwards = np.vstack([approximate_line.outwards for approximate_line in approximate_lines])
    vehicle_path = trajectory.xyz[:, :2]
    driven_m = np.append(0.0, np.cumsum(np.hypot(*np.diff(vehicle_path, axis=0).T)))
    away_m, nearest = cKDTree(vehicle_path).query(xy)
    fronts = []
    for side in _SEEN_FROM:
        at_m = driven_m[nearest] + side * away_m
        seen_from = np.column_stack([np.interp(at_m, driven_m, one) for one in vehicle_path.T]) - xy
        away = np.maximum(np.hypot(*seen_from.T), _LEAST_AWAY_M)
        fronts.append(-(seen_from * outwards).sum(axis=1) / away)
    is_seen = np.max(fronts, axis=0) > _LEAST_FRONT
    seen = np.where(fronts[0] < _ASKEW, ASKEW, VISIBLE)
    return np.where(is_seen, seen, HIDDEN)


def _edges(
    along: _Floats, positions: _Floats, stations: _Floats, settings: EdgeSettings
) -> _Floats:
    window = Window(
        settings.along_m / 2,
        settings.along_m,
        float(settings.enough_points),
        settings.inlier_m,
    )
    measures = np.full((stations.shape[0], MEASURES), np.nan)
    edges_kernel(along, positions, stations, window, measures)
    return measures


@kernel
def nearest_kernel(
    along: _Floats, across_above: _Floats, wanted: _Floats, within_m: float, nearest: _Integers
) -> None:
    """The point nearest to each of some places, (k, 3) in the same frame; −1 beyond a distance.

    The first column of ``wanted`` rises.
    """
    first = 0
    for k in range(wanted.shape[0]):
        nearest[k] = -1
        least = within_m * within_m
        reach = within_m / STEP_M
        while first < along.shape[0] and along[first] < wanted[k, 0] - reach:
            first += 1
        i = first
        while i < along.shape[0] and along[i] <= wanted[k, 0] + reach:
            away = ((along[i] - wanted[k, 0]) * STEP_M) ** 2
            away += (across_above[i, 0] - wanted[k, 1]) ** 2
            away += (across_above[i, 1] - wanted[k, 2]) ** 2
            if away < least:
                nearest[k], least = i, away
            i += 1


def warm_up() -> None:
    """Compile the kernel."""
    nearest_kernel(np.zeros(1), np.zeros((1, 2)), np.zeros((1, 3)), 0.1, np.zeros(1, np.int64))

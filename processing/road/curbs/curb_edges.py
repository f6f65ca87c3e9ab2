"""Exact edges: carriageway, face and top laid through all points about a rough curb line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.monitor import Monitor
from processing.points.drive import Drive
from processing.points.trajectory import Trajectory
from processing.road.curbs.curb_edge_kernels import MEASURES, edges_kernel, nearest_kernel
from processing.road.curbs.curb_guides import Guide
from processing.road.curbs.curb_points import ChosenPoints, GuideCells, PointsAbout

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]


@dataclass(frozen=True)
class EdgeSettings:
    """What points say about an edge.

    Attributes
    ----------
    along_m, across_m : float
        How far along and across the road points are looked at; mms.md Table 6-1: 0.5 m, 0.4 m.
    inlier_m : float
        How far a point may lie off a surface; Table 6-1: 5 mm.
    enough_points : int
        Where a window half as long holds as many, it is used.
    """

    along_m: float = 0.5
    across_m: float = 0.4
    inlier_m: float = 0.005
    enough_points: int = 80


@dataclass(frozen=True)
class MeasuredEdges:
    """What one drive shows of one guide.

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

    def nearest(self, places: _Floats, within_m: float) -> tuple[_Integers, _Floats]:
        """The measured points nearest to places in the guide's frame, and how far they are.

        Parameters
        ----------
        places : (k, 3) float64
            Stations, rising; m across and above.

        Returns
        -------
        points : (k,) int64
            −1 where none is near enough.
        away_m : (k,) float64
            Across and above; infinite where there is none.
        """
        found = np.full(places.shape[0], -1, np.int64)
        nearest_kernel(self.along, self.across_above, places, within_m, found)
        has = found >= 0
        points, away = found.copy(), np.full(found.size, np.inf)
        points[has] = self.points[found[has]]
        off = self.across_above[found[has]] - places[has, 1:]
        away[has] = np.hypot(off[:, 0], off[:, 1])
        return points, away


def measured_edges(
    drive: Drive, guides: Sequence[Guide], settings: EdgeSettings, monitor: Monitor
) -> list[MeasuredEdges]:
    """Edges at the stations of guides, as one drive shows them."""
    if not guides:
        return []
    about = GuideCells(guides, settings.across_m).about(drive, monitor)
    monitor.check()
    return _measured(drive, guides, about, settings)


def measured_among(
    drive: Drive, guides: Sequence[Guide], chosen: ChosenPoints, settings: EdgeSettings
) -> list[MeasuredEdges]:
    """The same by some points of the drive."""
    about = GuideCells(guides, settings.across_m).among(drive, chosen)
    return _measured(drive, guides, about, settings)


def _measured(
    drive: Drive, guides: Sequence[Guide], about: PointsAbout, settings: EdgeSettings
) -> list[MeasuredEdges]:
    measured = []
    is_hidden = _hidden(guides, drive.trajectory)
    first = 0
    for number, guide in enumerate(guides):
        part = slice(int(about.starts[number]), int(about.starts[number + 1]))
        along = about.along[part]
        places = np.column_stack([about.across[part], about.above[part]])
        hidden = is_hidden[first : first + guide.width_m.size]
        first += hidden.size
        stations = np.column_stack([guide.width_m, hidden, guide.step_m, guide.is_edging])
        measures = _edges(along, places, stations, settings)
        measured.append(MeasuredEdges(measures, along, places, about.point[part]))
    return measured


def _hidden(guides: Sequence[Guide], trajectory: Trajectory | None) -> NDArray[np.bool_]:
    """Where the faces of guides look away from the vehicle, one guide after the other."""
    if trajectory is None:
        return np.concatenate([guide.is_hidden for guide in guides])
    xy = np.vstack([guide.xyz[:, :2] for guide in guides])
    outwards = np.vstack([guide.outwards for guide in guides])
    way = trajectory.xyz[:, :2]
    nearest = cKDTree(way).query(xy)[1]
    return np.asarray(((way[nearest] - xy) * outwards).sum(axis=1) > 0)


def _edges(along: _Floats, places: _Floats, stations: _Floats, settings: EdgeSettings) -> _Floats:
    window = np.array(
        [settings.along_m / 2, settings.along_m, settings.enough_points, settings.inlier_m]
    )
    measures = np.full((stations.shape[0], MEASURES), np.nan)
    edges_kernel(along, places, stations, window, measures)
    return measures

"""Way: the vehicle's path on the map, with stations in metres and the direction of travel."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.points.drive import Drive
from widgets.map_view.plan_lay import on_plan

Floats = NDArray[np.float64]

_STEP_M = 0.5


@dataclass(frozen=True, eq=False)
class Way:
    """Where the vehicle went while points were measured.

    Attributes
    ----------
    places : (m, 2) float64
        On the plane: metres to the east and to the south; at least two.
    stations : (m,) float64
        Metres from the beginning, rising.
    """

    places: Floats
    stations: Floats

    @property
    def length_m(self) -> float:
        """Of all of it."""
        return float(self.stations[-1])

    def at(self, stations: Floats) -> Floats:
        """(k, 2) places at stations."""
        east = np.interp(stations, self.stations, self.places[:, 0])
        south = np.interp(stations, self.stations, self.places[:, 1])
        return np.column_stack([east, south])

    def directions(self, stations: Floats, over_m: float) -> Floats:
        """(k, 2) unit vectors of travel on the plane."""
        before = self.at(np.maximum(stations - over_m, 0.0))
        ahead = self.at(np.minimum(stations + over_m, self.length_m))
        step = ahead - before
        directions: Floats = step / np.maximum(np.hypot(*step.T), 1e-9)[:, None]
        return directions

    def distance_to(self, spot: tuple[float, float]) -> float:
        """Metres from a place of the plane to the nearest place of the path."""
        return float(np.hypot(*(self.places - np.array(spot)).T).min())

    def station_near(self, spot: tuple[float, float]) -> float:
        """The station nearest to a place of the plane."""
        nearest = int(np.hypot(*(self.places - np.array(spot)).T).argmin())
        return float(self.stations[nearest])


def ways_of(drives: Iterable[Drive]) -> tuple[Way, ...]:
    """The paths of drives; scanners of one vehicle share one."""
    ways: list[Way] = []
    seen: list[Floats] = []
    for drive in drives:
        trajectory = drive.trajectory
        if trajectory is None or not drive.count:
            continue
        if any(np.array_equal(trajectory.xyz, other) for other in seen):
            continue
        seen.append(trajectory.xyz)
        way = _way_of(trajectory.xyz, drive)
        if way is not None:
            ways.append(way)
    return tuple(ways)


def _way_of(xyz: Floats, drive: Drive) -> Way | None:
    """From the first to the last place beside which the drive's points lie."""
    low, high = np.array(drive.info.lowest)[:2], np.array(drive.info.highest)[:2]
    inside = np.flatnonzero(((xyz[:, :2] >= low) & (xyz[:, :2] <= high)).all(axis=1))
    kept = xyz[inside[0] : inside[-1] + 1] if inside.size else xyz
    places = on_plan(kept)
    gone = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])
    # A vehicle that stands gives many places at one station.
    step = np.floor(gone / _STEP_M)
    first = np.flatnonzero(np.diff(step, prepend=-1.0) > 0)
    chosen = np.unique(np.concatenate([first, [len(places) - 1]]))
    chosen = chosen[np.diff(gone[chosen], prepend=-1.0) > 0]
    return Way(places[chosen], gone[chosen]) if len(chosen) > 1 else None

"""VehiclePath: where the vehicle went on the map, with stations and the direction of travel."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.recording.drive import Drive
from processing.recording.vehicle_path.trajectory import Trajectory
from processing.section.stations import Stations
from widgets.map_view.plan_projection import on_plan

_STEP_M = 0.25


@dataclass(frozen=True, eq=False)
class VehiclePath:
    """Where the vehicle went while points were measured.

    Attributes
    ----------
    positions : (m, 2) float64
        On the plane: metres to the east and to the south; at least two.
    stations : (m,) float64
        Metres from the trajectory's beginning, as in sections; rising.
    """

    positions: Floats
    stations: Floats

    @property
    def ends(self) -> tuple[float, float]:
        """The first and the last station."""
        return float(self.stations[0]), float(self.stations[-1])

    def at(self, stations: Floats) -> Floats:
        """(k, 2) places at stations."""
        east = np.interp(stations, self.stations, self.positions[:, 0])
        south = np.interp(stations, self.stations, self.positions[:, 1])
        return np.column_stack([east, south])

    def directions(self, stations: Floats, over_m: float) -> Floats:
        """(k, 2) unit vectors of travel on the plane."""
        # Beyond the ends it stays where it is.
        before, ahead = self.at(stations - over_m), self.at(stations + over_m)
        step = ahead - before
        directions: Floats = step / np.maximum(np.hypot(*step.T), 1e-9)[:, None]
        return directions

    def beside(self, within_m: float) -> QRectF:
        """The part of the plane about it, so far to each side."""
        (left, top), (right, bottom) = self.positions.min(axis=0), self.positions.max(axis=0)
        path = QRectF(QPointF(left, top), QPointF(right, bottom))
        return path.adjusted(-within_m, -within_m, within_m, within_m)

    def distance_to(self, spot: tuple[float, float]) -> float:
        """Metres from a place of the plane to the nearest place of the path."""
        return float(np.hypot(*(self.positions - np.array(spot)).T).min())

    def station_near(self, spot: tuple[float, float]) -> float:
        """The station nearest to a place of the plane."""
        nearest = int(np.hypot(*(self.positions - np.array(spot)).T).argmin())
        return float(self.stations[nearest])


def vehicle_paths_of(drives: Iterable[Drive]) -> tuple[VehiclePath, ...]:
    """The paths of drives; scanners of one vehicle share one."""
    vehicle_paths: list[VehiclePath] = []
    by_trajectory: list[tuple[Trajectory, list[Drive]]] = []
    for drive in drives:
        trajectory = drive.trajectory
        if trajectory is None or not drive.count:
            continue
        for other, sharing in by_trajectory:
            if np.array_equal(trajectory.xyz, other.xyz):
                sharing.append(drive)
                break
        else:
            by_trajectory.append((trajectory, [drive]))
    for trajectory, sharing in by_trajectory:
        vehicle_path = _way_of(trajectory, sharing)
        if vehicle_path is not None:
            vehicle_paths.append(vehicle_path)
    return tuple(vehicle_paths)


def _way_of(trajectory: Trajectory, drives: list[Drive]) -> VehiclePath | None:
    """The stretch beside which points were measured; None where the vehicle never moved."""
    try:
        line = Stations.of_trajectory(trajectory)
    except Unsuitable:
        return None
    stations, xyz = line.measured_positions()
    is_recorded = np.zeros(len(stations), dtype=bool)
    for drive in drives:
        is_recorded |= _find_recorded(line, stations, xyz, drive)
    inside = np.flatnonzero(is_recorded)
    if inside.size > 1:
        stations, xyz = (one[inside[0] : inside[-1] + 1] for one in (stations, xyz))
    # Painted often, and far closer than anyone can see.
    is_first = np.diff(np.floor(stations / _STEP_M), prepend=-1.0) > 0
    is_first[-1] = True
    return VehiclePath(on_plan(xyz[is_first]), stations[is_first])


def _find_recorded(
    line: Stations, stations: Floats, xyz: Floats, drive: Drive
) -> NDArray[np.bool_]:
    """(k,) which places were passed while a drive was measured; without times, by its extent."""
    revolutions = drive.revolutions
    if revolutions is not None and len(revolutions.reference_times):
        ends = [line.station_at_time(float(revolutions.reference_times[end])) for end in (0, -1)]
        first = 0.0 if ends[0] is None else ends[0]
        last = line.length_m if ends[1] is None else ends[1]
        between: NDArray[np.bool_] = (stations >= first) & (stations <= last)
        return between
    low, high = np.array(drive.info.lowest)[:2], np.array(drive.info.highest)[:2]
    east, north = xyz[:, 0], xyz[:, 1]
    is_beside: NDArray[np.bool_] = (
        (east >= low[0]) & (east <= high[0]) & (north >= low[1]) & (north <= high[1])
    )
    return is_beside

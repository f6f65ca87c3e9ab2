"""How a line goes on: by its own last positions, and by the trajectory where it isn't seen.

Where a constant says “by trial”, it was set on the left head of a simulated town street; no
measurement varied it alone. Scores of all values together are in docs/accuracy.md.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.methods.templates.slab import SectionFrame
from processing.recording.vehicle_path.trajectory import Trajectory

_Floats = NDArray[np.float64]

_REMEMBERED = 8
"""Last positions that tell the direction: four metres of half-metre steps. By trial."""

_FADES_M = 2.0
"""Distance over which a position's weight falls to 1/e; beyond twice as much it is another line's.
By trial."""

_FEWEST_TO_BEND, _FEWEST = 5, 3
"""Positions from which a bend is told, and a direction; by trial: a parabola has three unknowns."""

_TAKEN_SHARE = 0.7
"""Of the turn from the fitted direction to that of the last positions; by trial: positions are
surer than the direction within one section."""

_RECORDS_M = 0.5
"""Least distance of the trajectory's records that are used: closer ones tell noise for turns."""

_SEARCHED_RECORDS = 60
"""To either side of the nearest one before, 30 m or more: a street may be driven twice."""


class RoadDirection:
    """How a trajectory turns and climbs beside a position.

    Parameters
    ----------
    trajectory : Trajectory or None
        None: the road goes straight on.
    """

    def __init__(self, trajectory: Trajectory | None) -> None:
        self._xyz = np.empty((0, 3)) if trajectory is None else _evenly(trajectory.xyz)
        self._near = -1

    def change(self, position: _Floats, step: _Floats) -> tuple[float, float]:
        """Turn (rad, counter-clockwise) and rise (m) of the road beside a step."""
        if len(self._xyz) < _FEWEST:
            return 0.0, 0.0
        before, after = self._nearest(position), self._nearest(position + step)
        (heading, height), (heading_after, height_after) = self._at(before), self._at(after)
        return _between(heading, heading_after), height_after - height

    def heading_near(self, position: _Floats) -> float | None:
        """The road's direction next to a position, rad counter-clockwise from the easting."""
        if len(self._xyz) < _FEWEST:
            return None
        self._near = -1
        return self._at(self._nearest(position))[0]

    def _nearest(self, position: _Floats) -> int:
        first, end = 0, len(self._xyz)
        if self._near >= 0:
            first = max(0, self._near - _SEARCHED_RECORDS)
            end = min(end, self._near + _SEARCHED_RECORDS + 1)
        away = self._xyz[first:end, :2] - position[:2]
        self._near = first + int((away**2).sum(axis=1).argmin())
        return self._near

    def _at(self, record: int) -> tuple[float, float]:
        first, last = max(0, record - 1), min(len(self._xyz) - 1, record + 1)
        east, north, _ = self._xyz[last] - self._xyz[first]
        return math.atan2(north, east), float(self._xyz[record, 2])


class LineDirection:
    """Where the next position of a line is expected, from those before.

    Parameters
    ----------
    frame : SectionFrame
        Where the line begins, and its direction there.
    direction : {1, -1}
        Along that direction or against it.
    """

    def __init__(self, frame: SectionFrame, direction: int) -> None:
        self._sense = direction
        self._heading_rad = frame.heading_rad
        self._grade = 0.0
        self._positions: list[_Floats] = [frame.position]
        self._last = frame.position

    @property
    def grade(self) -> float:
        """Rise per metre along the line's heading."""
        return self._grade

    def next_frame(self, step_m: float, road: RoadDirection, *, is_seen: bool) -> SectionFrame:
        """The frame a step further.

        Parameters
        ----------
        is_seen : bool
            False: nothing was fitted here, the road says how the line turns.
        """
        along = SectionFrame(self._last, self._heading_rad).along
        step = self._sense * step_m * along
        if not is_seen:
            turn, _ = road.change(self._last, step)
            self._heading_rad += turn
            step = self._sense * step_m * SectionFrame(self._last, self._heading_rad).along
        position = self._last + step + np.array([0.0, 0.0, self._sense * step_m * self._grade])
        return SectionFrame(position, self._heading_rad)

    def go_on(self, frame: SectionFrame) -> None:
        """Nothing was fitted at a frame: go on from it."""
        self._last, self._heading_rad = frame.position, frame.heading_rad

    def take(self, position: _Floats, heading_rad: float) -> None:
        """A position was fitted, and the line's direction in it."""
        is_near = np.linalg.norm(position - self._positions[-1]) <= 2 * _FADES_M
        self._positions = [*(self._positions if is_near else ()), position][-_REMEMBERED:]
        self._last, self._heading_rad = position, heading_rad
        if len(self._positions) < _FEWEST:
            return
        rear, rise = self._direction(position)
        self._heading_rad += _between(heading_rad, rear) * _TAKEN_SHARE
        self._grade = rise

    def _direction(self, position: _Floats) -> tuple[float, float]:
        """Heading and grade at the last position, by a parabola through the last ones."""
        xyz = np.array(self._positions) - position
        steps = np.linalg.norm(np.diff(xyz[:, :2], axis=0), axis=1)
        along = -np.concatenate([np.cumsum(steps[::-1])[::-1], [0.0]])
        weight = np.exp(along / _FADES_M)
        bends = len(xyz) >= _FEWEST_TO_BEND
        plan = np.vander(along, 3 if bends else 2)
        east, north = np.linalg.lstsq(plan * weight[:, None], xyz[:, :2] * weight[:, None])[0][-2]
        level = np.vander(along, 2) * weight[:, None]
        rise = np.linalg.lstsq(level, xyz[:, 2] * weight)[0][0]
        return math.atan2(self._sense * north, self._sense * east), float(self._sense * rise)


def _evenly(xyz: _Floats) -> _Floats:
    """Records at least half a metre apart."""
    kept = [0]
    for record in range(1, len(xyz)):
        if math.dist(xyz[record, :2], xyz[kept[-1], :2]) >= _RECORDS_M:
            kept.append(record)
    return xyz[kept]


def _between(heading: float, other: float) -> float:
    """The turn from one heading to another, −π to π."""
    return math.remainder(other - heading, math.tau)

"""How densely a sensor measures, before anybody drives: in closed form, from its spinning beams."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.core.errors import OutOfRange
from processing.core.text import Text
from processing.laboratory.simulate.scanning.beams import head_axes
from processing.laboratory.simulate.scanning.sensors import Head, Sensor
from processing.laboratory.simulate.scanning.simulated_passes import REFERENCE_HIGH_M

Floats = NDArray[np.float64]

_KM_H = 3.6
_REACH_ACROSS_M = 20.0
_REACH_UP_M = 10.0
_CELL_M = 0.1
_LEAST_WALL_M = 1.5  # nearer than that the vehicle itself drives


@dataclass(frozen=True)
class DrivingSensor:
    """A sensor on a vehicle that drives straight on at one speed.

    Attributes
    ----------
    heads : tuple of Head
    turns_per_s : float
        Of each head's mirror.
    pulses : int
        In one revolution.
    most_m : float
        Reach; farther surfaces are not measured.
    speed_m_s : float
    height_m : float
        Of the reference point over the road.
    """

    heads: tuple[Head, ...]
    turns_per_s: float
    pulses: int
    most_m: float
    speed_m_s: float
    height_m: float = sum(REFERENCE_HIGH_M) / 2

    @property
    def between_revolutions_m(self) -> float:
        """How far the vehicle drives during one turn: from scan line to scan line."""
        return self.speed_m_s / self.turns_per_s


@dataclass(frozen=True)
class DensityMap:
    """Points per square metre beside a vehicle that drives by.

    Attributes
    ----------
    survey : DrivingSensor
    across_m : (n,) float64
        To the left of the vehicle's reference point, m.
    up_m : (k,) float64
        Above the road, m.
    road : (n,) float64
        Points/m² of a level road, all heads together; 0 out of reach.
    spacing_m : (n,) float64
        From point to point across the road within one scan line, of the head that is densest
        there; NaN out of reach.
    wall : (k, n) float64
        Points/m² of an upright wall along the road at each distance; NaN where the vehicle drives.
    """

    survey: DrivingSensor
    across_m: Floats
    up_m: Floats
    road: Floats
    spacing_m: Floats
    wall: Floats


def survey_of(
    sensor: Sensor, speed_km_h: float, *, pulses: int = 0, turns_per_s: float = 0.0
) -> DrivingSensor:
    """A sensor as it is usually mounted, at a speed.

    Parameters
    ----------
    pulses, turns_per_s : int, float
        0 for those of the sensor.

    Raises
    ------
    OutOfRange
        The vehicle stands still: the same line would be measured for ever.
    """
    if speed_km_h <= 0:
        raise OutOfRange(
            Text("A density needs a speed.", "点密度の計算には走行速度が必要です。"),
            Text.same(f"{speed_km_h:g} km/h"),
            Text("Give more than 0 km/h.", "0 km/h より大きい値を指定してください。"),
        )
    return DrivingSensor(
        sensor.heads,
        turns_per_s or sensor.turns_per_s,
        pulses or sensor.pulses,
        sensor.most_m,
        speed_km_h / _KM_H,
    )


def road_density(survey: DrivingSensor, across_m: ArrayLike) -> Floats:
    """Points per square metre of a level road.

    Parameters
    ----------
    across_m : (...) array_like
        To the left of the reference point, m.

    Returns
    -------
    (...) float64
    """
    across = np.asarray(across_m, np.float64)
    total = np.zeros(across.shape)
    for head in survey.heads:
        total += _on_road(survey, head, across)
    return total


def wall_density(survey: DrivingSensor, across_m: ArrayLike, up_m: ArrayLike) -> Floats:
    """Points per square metre of an upright wall along the road.

    Parameters
    ----------
    across_m : (...) array_like
        Where the wall stands: to the left of the reference point, m.
    up_m : (...) array_like
        Above the road, m.

    Returns
    -------
    (...) float64
    """
    across, up = np.broadcast_arrays(np.asarray(across_m, np.float64), up_m)
    total = np.zeros(across.shape)
    for head in survey.heads:
        beside = across - head.lever_m[1]
        above = up - survey.height_m - head.lever_m[2]
        total += _density(survey, head, beside, above, np.abs(beside))
    return total


def density_map(survey: DrivingSensor) -> DensityMap:
    """Road and walls up to 20 m to both sides and 10 m up, in cells of 0.1 m."""
    cells = round(_REACH_ACROSS_M / _CELL_M)
    across = _middles(-cells, cells)
    up = _middles(0, round(_REACH_UP_M / _CELL_M))
    each = np.array([_on_road(survey, head, across) for head in survey.heads])
    with np.errstate(divide="ignore"):
        spacing = 1 / (each.max(axis=0) * survey.between_revolutions_m)
    wall = wall_density(survey, across[None, :], up[:, None])
    wall[:, np.abs(across) < _LEAST_WALL_M] = np.nan
    spacing[~np.isfinite(spacing)] = np.nan
    return DensityMap(survey, across, up, each.sum(axis=0), spacing, wall)


def _middles(first: int, stop: int) -> Floats:
    """The middles of cells, m."""
    return (np.arange(first, stop, dtype=np.float64) + 0.5) * _CELL_M


def _on_road(survey: DrivingSensor, head: Head, across: Floats) -> Floats:
    below = survey.height_m + head.lever_m[2]
    beside = across - head.lever_m[1]
    return _density(
        survey, head, beside, np.full(across.shape, -below), np.full_like(beside, below)
    )


def _density(
    survey: DrivingSensor, head: Head, beside: Floats, above: Floats, distance: Floats
) -> Floats:
    """Points/m² of one head on a plane along the road.

    1. Beams lie in the plane square to the axis a, so a place ``beside`` and ``above`` the head is
       met from where its place ahead is x = -(a_y beside + a_z above) / a_x.
    2. On a plane along the road in the distance D, the place along the other coordinate moves with
       the mirror's angle by r² |a_x| / D, r the range; along the road it moves with the vehicle.
    3. Pulses per radian and turns per metre, divided by that, are points per square metre.

    Parameters
    ----------
    beside, above : (...) float64
        Of the place, from the head, m.
    distance : (...) float64
        From the head to the plane, m.
    """
    ahead, left, up = head_axes(head)[:, 2]
    x = -(left * beside + up * above) / ahead
    square = x**2 + beside**2 + above**2
    per_radian = survey.pulses / (2 * np.pi)
    found: Floats = per_radian / survey.between_revolutions_m * distance / (square * abs(ahead))
    return np.where(square > survey.most_m**2, 0.0, found)

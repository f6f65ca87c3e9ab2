"""What a surveyor reads off places: lengths, heights, slopes, angles, areas, widths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.map.drafting.plan_sides import SideIndex, crossing_fractions
from processing.map.drafting.polyline import SAME_POSITION_M, Polyline, name_position
from processing.map.feature import Position
from processing.map.measures import length_m, plan_area_m2, plan_length_m

_STATION_M = 1.0
_MOST_SKEW = 4.0


@dataclass(frozen=True)
class Measure:
    """One number with its name.

    Attributes
    ----------
    id : str
        The attribute as which it is kept, with its unit.
    name : Text
    value : float
        In ``unit``.
    unit : str
        As printed.
    decimals : int
        Digits after the point that the measurement supports.
    """

    id: str
    name: Text
    value: float
    unit: str
    decimals: int


class Width(NamedTuple):
    """Widths between two lines in plan, m."""

    least_m: float
    mean_m: float
    greatest_m: float


def measures_of(positions: Sequence[Position], *, is_closed: bool) -> tuple[Measure, ...]:
    """All that can be said about places.

    Parameters
    ----------
    positions : sequence of Position
        m, project CRS; a ring's first place not repeated.
    is_closed : bool
        Whether they are a ring: with three places and more its areas and perimeter are given.

    Returns
    -------
    tuple of Measure
        Nothing for one place; for two, distance, plan distance, height difference, slope,
        direction; for more, the whole, the last leg and the angle before it.
    """
    if len(positions) < 2:
        return ()
    if len(positions) == 2:
        return _of_two(positions[0], positions[1])
    return _of_ring(positions) if is_closed else _of_line(positions)


def width_between(line: Sequence[Position], other: Sequence[Position]) -> Width:
    """How wide it is from one line to another in plan.

    Square to the line, at its vertices and at every metre, the distance to the other line is
    taken where the perpendicular meets it. The mean is over the line's length.

    Raises
    ------
    Unsuitable
        No perpendicular of the line meets the other.
    """
    own = Polyline.of(line)
    opposite = Polyline.of(other, origin=line[0])
    has_length = len(other) > 1 and own.plan_distances[-1] > SAME_POSITION_M
    if not has_length:
        raise _never_beside(line[0])
    along = _stations(own)
    starts, normals = _perpendiculars(own, along)
    widths = _widths(starts, normals, opposite.plan_sides)
    met = np.isfinite(widths)
    if not met.any():
        raise _never_beside(line[0])
    steps = np.diff(along, prepend=along[0], append=along[-1])
    weights = np.where(met, (steps[:-1] + steps[1:]) / 2, 0.0)
    mean = float((np.where(met, widths, 0.0) * weights).sum() / weights.sum())
    return Width(float(widths[met].min()), mean, float(widths[met].max()))


def _of_two(first: Position, second: Position) -> tuple[Measure, ...]:
    step = _step(first, second)
    plan = float(np.hypot(step[0], step[1]))
    measures = [
        _metres("distance_m", Text("Distance", "斜距離"), float(np.linalg.norm(step))),
        _metres("plan_distance_m", Text("Plan distance", "水平距離"), plan),
        _metres("height_difference_m", Text("Height difference", "比高"), float(step[2])),
    ]
    if plan >= SAME_POSITION_M:
        measures.append(
            Measure("slope_percent", Text("Slope", "勾配"), float(step[2]) / plan * 100, "%", 2)
        )
        if abs(step[2]) >= SAME_POSITION_M:
            gradient = Text("Gradient 1:n", "勾配 1:n")
            measures.append(Measure("gradient", gradient, plan / abs(float(step[2])), "", 1))
        measures.append(
            Measure("direction_deg", Text("Direction", "方向角"), _bearing(step), "°", 2)
        )
    return tuple(measures)


def _of_line(positions: Sequence[Position]) -> tuple[Measure, ...]:
    before, corner, last = positions[-3:]
    measures = [
        _metres("distance_m", Text("Length", "延長（斜距離）"), length_m(positions)),
        _metres("plan_distance_m", Text("Plan length", "水平延長"), plan_length_m(positions)),
        _metres(
            "last_leg_m", Text("Last leg", "最終辺長"), float(np.linalg.norm(_step(corner, last)))
        ),
        _metres(
            "last_height_difference_m",
            Text("Rise of the last leg", "最終辺の比高"),
            last[2] - corner[2],
        ),
        _metres(
            "height_difference_m", Text("Height difference", "比高"), last[2] - positions[0][2]
        ),
    ]
    one, other = _step(corner, before)[:2], _step(corner, last)[:2]
    if min(np.hypot(*one), np.hypot(*other)) >= SAME_POSITION_M:
        turn = np.arctan2(one[0] * other[1] - one[1] * other[0], one @ other)
        measures.append(
            Measure("angle_deg", Text("Angle", "夾角"), abs(float(np.degrees(turn))), "°", 2)
        )
    return tuple(measures)


def _of_ring(positions: Sequence[Position]) -> tuple[Measure, ...]:
    ring = Polyline.of(positions, is_closed=True)
    # Half the sum of the corners' cross products: exact for a plane ring, whatever its slope.
    vector = np.cross(ring.starts, ring.ends).sum(axis=0) / 2
    around = (*positions, positions[0])
    return (
        Measure("plan_area_m2", Text("Plan area", "水平面積"), plan_area_m2(positions), "m²", 2),
        Measure(
            "slope_area_m2", Text("Slope area", "斜面積"), float(np.linalg.norm(vector)), "m²", 2
        ),
        _metres("perimeter_m", Text("Perimeter", "周長（斜距離）"), length_m(around)),
        _metres("plan_perimeter_m", Text("Plan perimeter", "水平周長"), plan_length_m(around)),
    )


def _metres(id_: str, name: Text, value: float) -> Measure:
    return Measure(id_, name, value, "m", 3)


def _step(first: Position, second: Position) -> Floats:
    step: Floats = np.array(second, dtype=np.float64) - np.array(first, dtype=np.float64)
    return step


def _bearing(step: Floats) -> float:
    """Degrees clockwise from grid north."""
    return float(np.degrees(np.arctan2(step[0], step[1])) % 360.0)


def _stations(line: Polyline) -> Floats:
    """Plan distances along a line: its vertices and every metre."""
    distances = line.plan_distances
    every = np.arange(0.0, distances[-1], _STATION_M)
    stations: Floats = np.unique(np.round(np.concatenate([every, distances]), 6))
    return stations


def _perpendiculars(line: Polyline, along: Floats) -> tuple[Floats, Floats]:
    """Places on a line, (k, 2), and unit vectors square to it; at a vertex the bisector."""
    distances = line.plan_distances
    sides = np.flatnonzero(np.diff(distances) > 0)
    steps = line.plan_sides[sides, 1] - line.plan_sides[sides, 0]
    directions = steps / np.linalg.norm(steps, axis=1)[:, None]
    nearly = SAME_POSITION_M / 2
    before = np.searchsorted(distances[sides], along - nearly).clip(1) - 1
    after = np.searchsorted(distances[sides], along + nearly).clip(1) - 1
    mean = directions[before] + directions[after]
    is_reversal = np.linalg.norm(mean, axis=1) < 1e-9
    mean[is_reversal] = directions[after[is_reversal]]
    mean /= np.linalg.norm(mean, axis=1)[:, None]
    into = (along - distances[sides[after]]) / np.diff(distances)[sides[after]]
    positions = line.between(sides[after], into.clip(0, 1))[:, :2]
    return positions, np.column_stack([-mean[:, 1], mean[:, 0]])


def _widths(positions: Floats, normals: Floats, sides: Floats) -> Floats:
    """(k,): from places along their perpendiculars to the nearest of sides; inf where none is."""
    nearest = SideIndex(sides).nearest(positions)[2]
    # A line that turns away so far that the perpendicular is four times longer isn't beside it.
    arms = (_MOST_SKEW * nearest + SAME_POSITION_M)[:, None] * normals
    reaches = np.stack([positions - arms, positions + arms], axis=1)
    tree = shapely.STRtree(shapely.linestrings(sides))
    station, side = tree.query(shapely.linestrings(reaches), predicate="intersects")
    on_reach, _ = crossing_fractions(reaches[station], sides[side])
    lengths = np.linalg.norm(arms, axis=1)[station]
    found = np.abs(2 * on_reach - 1) * lengths
    widths = np.full(len(positions), np.inf)
    is_met = ~np.isnan(found)
    np.minimum.at(widths, station[is_met], found[is_met])
    return widths


def _never_beside(position: Position) -> Unsuitable:
    return Unsuitable(
        Text(
            "The two lines nowhere lie beside each other.",
            "2本の線が向かい合う区間がないため、幅を計測できません。",
        ),
        name_position(position),
        Text(
            "Choose two lines that run side by side.",
            "並行して延びる2本の線を選んでください。",
        ),
    )

"""Figures drawn by a few places: arcs, splines, circles, rectangles.

The given places are on the figure exactly as given; curves are chords within a tolerance.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.errors import OutOfRange
from processing.core.text import Text
from processing.map.drafting.polyline import SAME_POSITION_M, Polyline, name_position
from processing.map.feature import Position

_FINEST_M = 1e-4
_MOST_CHORDS = 2_000


def arc_through(
    first: Position, second: Position, third: Position, tolerance_m: float = 0.01
) -> tuple[Position, ...]:
    """The arc from a first place over a second to a third.

    Parameters
    ----------
    first, second, third : Position
        m, project CRS; each is one of the places given back.
    tolerance_m : float
        Most distance of a chord from the arc in plan.

    Returns
    -------
    tuple of Position
        The circle is taken in plan; heights change evenly between the given places. Straight from
        place to place where the three lie on one line to within the tolerance.
    """
    line = Polyline.of((first, second, third))
    plan = line.xyz[:, :2]
    if _least_height(plan) <= max(tolerance_m, _FINEST_M):
        return _without_repeats((first, second, third))
    positions: list[Position] = [first]
    for number, given in enumerate((second, third)):
        inner = _arc_between(plan, number, tolerance_m)
        share = np.arange(1, len(inner) + 1) / (len(inner) + 1)
        heights = line.xyz[number, 2] + share * (line.xyz[number + 1, 2] - line.xyz[number, 2])
        positions += [*line.positions(np.column_stack([inner, heights])), given]
    return tuple(positions)


def circle_through(
    first: Position, second: Position, third: Position, tolerance_m: float = 0.005
) -> tuple[Position, ...]:
    """The circle through three places, on the plane that they span.

    Parameters
    ----------
    tolerance_m : float
        Most distance of a chord from the circle.

    Returns
    -------
    tuple of Position
        A ring, its first place not repeated; the three are among its places.

    Raises
    ------
    OutOfRange
        The three lie on one straight line.
    """
    line = Polyline.of((first, second, third))
    if _least_height(line.xyz) < SAME_POSITION_M:
        raise _on_one_line(first)
    axes = _axes_of_plane(line.xyz[1], line.xyz[2])
    in_plane = line.xyz @ axes.T
    positions: list[Position] = []
    for number, given in enumerate((first, second, third)):
        inner = _arc_between(in_plane, number, tolerance_m)
        positions += [given, *line.positions(inner @ axes)]
    return tuple(positions)


def rectangle_from(first: Position, second: Position, third: Position) -> tuple[Position, ...]:
    """A rectangle with a given side that reaches as far as a third place.

    Parameters
    ----------
    first, second : Position
        The ends of one side.
    third : Position
        Any place on the opposite side's straight line.

    Returns
    -------
    tuple of Position
        Four corners from ``first`` over ``second``, on the plane of the three places.

    Raises
    ------
    OutOfRange
        The three lie on one straight line.
    """
    line = Polyline.of((first, second, third))
    side, away = line.xyz[1], line.xyz[2]
    length = float(np.linalg.norm(side))
    along = side / length if length > 0 else side
    width = away - (away @ along) * along
    if length < SAME_POSITION_M or float(np.linalg.norm(width)) < SAME_POSITION_M:
        raise _on_one_line(first)
    third_corner, fourth = line.positions(np.stack([side + width, width]))
    return (first, second, third_corner, fourth)


def spline_through(
    positions: Sequence[Position], tolerance_m: float = 0.01
) -> tuple[Position, ...]:
    """A smooth line through places.

    1. Centripetal Catmull-Rom segments in plan; beyond each end the neighbour is mirrored.
    2. Each segment is divided until its chords stay within the tolerance.
    3. Heights change evenly along the curve from one given place to the next.

    Parameters
    ----------
    tolerance_m : float
        Most distance of a chord from the curve in plan.

    References
    ----------
    Yuksel, Schaefer, Keyser 2011, Parameterization and applications of Catmull-Rom curves,
    https://doi.org/10.1016/j.cad.2010.08.008
    """
    given = _without_repeats(positions)
    if len(given) < 3:
        return given
    line = Polyline.of(given)
    # Places above one another are one knot of the curve, joined by a plumb side.
    leads_on = np.flatnonzero(np.diff(line.plan_distances) > 0)
    if leads_on.size < 2:
        return given
    knots = line.xyz[np.append(leads_on, len(given) - 1), :2]
    controls = _bezier_controls(knots)
    counts = _divisions(controls, tolerance_m)
    inner = _samples(controls, counts)
    curve_points: list[Position] = []
    done = 0
    for number, (start, piece) in enumerate(zip(leads_on.tolist(), inner, strict=True)):
        curve_points += given[done : start + 1]
        done = start + 1
        ends = knots[number], knots[number + 1]
        heights = line.xyz[start, 2], line.xyz[start + 1, 2]
        curve_points += line.positions(_with_heights(piece, ends, heights))
    return (*curve_points, *given[done:])


def _without_repeats(positions: Sequence[Position]) -> tuple[Position, ...]:
    return tuple(
        position
        for number, position in enumerate(positions)
        if number == 0 or position != positions[number - 1]
    )


def _least_height(triangle: Floats) -> float:
    """The least height of a triangle whose first corner is the origin; 0 on one straight line."""
    sides = [triangle[1], triangle[2], triangle[2] - triangle[1]]
    longest = max(float(np.linalg.norm(side)) for side in sides)
    squares = (sides[0] @ sides[0]) * (sides[1] @ sides[1]) - (sides[0] @ sides[1]) ** 2
    return float(np.sqrt(max(squares, 0.0)) / longest) if longest > 0 else 0.0


def _arc_between(triangle: Floats, number: int, tolerance_m: float) -> Floats:
    """(k, 2): places inside the arc from one corner of a triangle to the next.

    The arc belongs to the circle through the corners, the first of which is the origin.
    """
    b, c = triangle[1], triangle[2]
    turn = b[0] * c[1] - b[1] * c[0]
    centre = np.array([c[1] * (b @ b) - b[1] * (c @ c), b[0] * (c @ c) - c[0] * (b @ b)])
    centre /= 2 * turn
    radius = float(np.linalg.norm(centre))
    arms = triangle[[number, (number + 1) % 3]] - centre
    start, end = np.arctan2(arms[:, 1], arms[:, 0])
    sweep = (end - start) % (2 * np.pi) if turn > 0 else -((start - end) % (2 * np.pi))
    chord = 2 * np.arccos(1 - min(max(tolerance_m, _FINEST_M) / radius, 0.2))
    count = min(int(np.ceil(abs(sweep) / chord)), _MOST_CHORDS)
    angles = start + sweep * np.arange(1, count) / max(count, 1)
    return centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])


def _axes_of_plane(one: Floats, other: Floats) -> Floats:
    """(2, 3): two unit vectors at right angles that span a plane; the other is left of the one."""
    along = one / np.linalg.norm(one)
    across = other - (other @ along) * along
    return np.stack([along, across / np.linalg.norm(across)])


def _bezier_controls(knots: Floats) -> Floats:
    """(k − 1, 4, 2): cubic Bezier controls of the centripetal curve through (k, 2) knots."""
    before, after = 2 * knots[0] - knots[1], 2 * knots[-1] - knots[-2]
    padded = np.concatenate([[before], knots, [after]])
    roots = np.sqrt(np.linalg.norm(np.diff(padded, axis=0), axis=1))[:, None]
    steps = np.diff(padded, axis=0)
    # Tangents of the non-uniform curve at both ends of a segment, scaled to its own interval.
    sums = (steps[:-1] + steps[1:]) / (roots[:-1] + roots[1:])
    rates = steps / roots
    leaving = rates[:-2] - sums[:-1] + rates[1:-1]
    arriving = rates[1:-1] - sums[1:] + rates[2:]
    start, end, own = knots[:-1], knots[1:], roots[1:-1]
    return np.stack([start, start + leaving * own / 3, end - arriving * own / 3, end], axis=1)


def _divisions(controls: Floats, tolerance_m: float) -> NDArray[np.int64]:
    """Into how many equal steps of its parameter each segment is divided."""
    bends = np.linalg.norm(np.diff(controls, n=2, axis=1), axis=2).max(axis=1)
    # A chord over a step h of a curve with |B''| <= 6 bend strays by at most 6 bend h² / 8.
    counts = np.ceil(np.sqrt(0.75 * bends / max(tolerance_m, _FINEST_M)))
    divisions: NDArray[np.int64] = np.clip(counts, 1, _MOST_CHORDS).astype(np.int64)
    return divisions


def _samples(controls: Floats, counts: NDArray[np.int64]) -> Iterator[Floats]:
    """The places inside each segment: (count − 1, 2) for each."""
    inner = counts - 1
    segment = np.repeat(np.arange(counts.size), inner)
    ends = np.cumsum(inner)
    step = np.arange(segment.size) - (ends - inner)[segment] + 1
    t = (step / counts[segment])[:, None]
    p = controls[segment]
    positions = (1 - t) ** 3 * p[:, 0] + 3 * (1 - t) ** 2 * t * p[:, 1]
    positions += 3 * (1 - t) * t**2 * p[:, 2] + t**3 * p[:, 3]
    return iter(np.split(positions, ends[:-1]))


def _with_heights(
    inner: Floats, ends: tuple[Floats, Floats], heights: tuple[float, float]
) -> Floats:
    """(k, 3): places inside a curve with heights even along it."""
    whole = np.concatenate([[ends[0]], inner, [ends[1]]])
    along = np.cumsum(np.linalg.norm(np.diff(whole, axis=0), axis=1))
    shares = along[:-1] / along[-1]
    return np.column_stack([inner, heights[0] + shares * (heights[1] - heights[0])])


def _on_one_line(position: Position) -> OutOfRange:
    return OutOfRange(
        Text(
            "The three places lie on one straight line.",
            "3点が一直線上にあるため、図形を作成できません。",
        ),
        name_position(position),
        Text(
            "Choose a third place beside the line through the first two.",
            "1点目と2点目を結ぶ線から離れた位置に3点目を指定してください。",
        ),
    )

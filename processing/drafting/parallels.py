"""Parallel copies of lines, and the signed distance of a place from a line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.drafting.plan_sides import (
    cross,
    crossing_fractions,
    meeting_pairs,
    nearest_fractions,
    nearest_sides,
)
from processing.drafting.polyline import Polyline, said_place
from processing.errors import OutOfRange
from processing.project.feature import Position
from processing.text import Text

Floats = NDArray[np.float64]

_SHARPEST_MITRE = np.radians(120.0)
_TOO_NEAR_M = 1e-8
_JOINED_M = 1e-6


def parallel(
    positions: Sequence[Position], distance_m: float, *, is_closed: bool = False
) -> tuple[Position, ...]:
    """A copy of a line at a distance in plan.

    1. Every side is shifted; outer joints are mitred, very sharp ones cut off at the distance.
    2. The shifted line is cut where it crosses itself, and where it passes the line's ends.
    3. Pieces that come nearer to the line than the distance are dropped: the loops that appear
       where the distance is larger than a bend's radius.

    Parameters
    ----------
    positions : sequence of Position
        m, project CRS; a ring's first place not repeated.
    distance_m : float
        Positive to the left of the line's direction, negative to the right.
    is_closed : bool
        Whether it is a ring; the copy is one too.

    Returns
    -------
    tuple of Position
        In the direction of the original, with the heights of its nearest places. Where the copy
        falls apart, its longest part.

    Raises
    ------
    OutOfRange
        Nothing of the copy is left, or the line has no length in plan.
    """
    line = _without_repeats(Polyline.of(positions, is_closed=is_closed))
    if line.xyz.shape[0] < 2:
        raise _no_copy(positions)
    if distance_m == 0:
        return line.positions(line.xyz)
    parts = _parts_off(line, _shifted(line, distance_m), abs(distance_m))
    if not parts.size:
        raise _no_copy(positions)
    plan = max(_chained(parts, is_closed=is_closed), key=_length)
    sides, fractions, _ = nearest_sides(line.plan_sides, plan)
    heights = line.between(sides, fractions)[:, 2]
    return line.positions(np.column_stack([plan, heights]))


def distance_to_line(
    positions: Sequence[Position], place: Position, *, is_closed: bool = False
) -> float:
    """How far a place lies beside a line in plan.

    Returns
    -------
    float
        m; positive to the left of the line's direction.

    Raises
    ------
    OutOfRange
        The line has no length in plan.
    """
    # About the place itself: the line may be long.
    line = _without_repeats(Polyline.of(positions, is_closed=is_closed, origin=place))
    sides = line.plan_sides
    if not sides.size:
        raise _no_copy(positions)
    fractions, distances = nearest_fractions(sides, np.zeros(2))
    side = int(distances.argmin())
    steps = sides[:, 1] - sides[:, 0]
    directions = steps / np.linalg.norm(steps, axis=1)[:, None]
    direction, fraction = directions[side], fractions[side]
    if fraction in (0.0, 1.0):
        # At a corner both of its sides count, or the sign would depend on which came first.
        neighbour = side + (1 if fraction == 1.0 else -1)
        if is_closed or 0 <= neighbour < len(sides):
            direction = direction + directions[neighbour % len(sides)]
    corner = sides[side, 0] + fraction * steps[side]
    is_left = float(cross(direction, -corner)) >= 0
    return float(distances[side]) * (1 if is_left else -1)


def _without_repeats(line: Polyline) -> Polyline:
    """The line without places above one another: a side needs a direction in plan."""
    plan = line.xyz[:, :2]
    moves = np.linalg.norm(plan - np.roll(plan, 1, axis=0), axis=1) > _JOINED_M
    if plan.size and not line.is_closed:
        moves[0] = True
    kept = line.xyz[moves]
    return Polyline(line.origin, kept if kept.size else line.xyz[:1], line.is_closed)


@dataclass(frozen=True)
class _Shifted:
    """The shifted sides in their order.

    Attributes
    ----------
    sides : (s, 2, 2) float64
        In plan; each with a length.
    is_bridge : (s,) bool
        Joins two sides across an inner bend that is too tight; never part of the copy.
    """

    sides: Floats
    is_bridge: NDArray[np.bool_]


def _shifted(line: Polyline, distance: float) -> _Shifted:
    """The sides at the distance, joined; with the loops of tight inner bends still in it."""
    sides = line.plan_sides
    steps = sides[:, 1] - sides[:, 0]
    directions = steps / np.linalg.norm(steps, axis=1)[:, None]
    offsets = distance * np.column_stack([-directions[:, 1], directions[:, 0]])
    after = np.arange(0 if line.is_closed else 1, len(sides))
    before = (after - 1) % len(sides)
    turn = np.arctan2(
        cross(directions[before], directions[after]),
        (directions[before] * directions[after]).sum(axis=1),
    )
    reach, is_loop = _reach_of_joints(sides, before, after, turn, distance)
    corners = sides[after, 0]
    leaving = corners + offsets[before] + reach[:, None] * directions[before]
    arriving = corners + offsets[after] - reach[:, None] * directions[after]
    # Between two shifted sides lies a link: none at a mitre, a cut-off corner, or a bridge.
    is_mitre = np.linalg.norm(arriving - leaving, axis=1) < _JOINED_M
    arriving[is_mitre] = leaving[is_mitre]
    places = np.stack([leaving, arriving], axis=1).reshape(-1, 2)
    if line.is_closed:
        places = np.concatenate([places, places[:1]])
        is_bridge = np.column_stack([is_loop, np.zeros_like(is_loop)]).ravel()
    else:
        first, last = sides[0, 0] + offsets[0], sides[-1, 1] + offsets[-1]
        places = np.concatenate([[first], places, [last]])
        is_bridge = np.column_stack([np.zeros_like(is_loop), is_loop]).ravel()
        is_bridge = np.append(is_bridge, np.zeros(1, np.bool_))
    moves = (places[1:] != places[:-1]).any(axis=1)
    return _Shifted(np.stack([places[:-1], places[1:]], axis=1)[moves], is_bridge[moves])


def _reach_of_joints(
    sides: Floats,
    before: NDArray[np.int64],
    after: NDArray[np.int64],
    turn: Floats,
    distance: float,
) -> tuple[Floats, NDArray[np.bool_]]:
    """How far shifted sides go on beyond their corners, and which joints can't be mitred inside.

    Returns
    -------
    reach : (j,) float64
        m; negative where a mitre shortens both sides.
    is_loop : (j,) bool
        An inner joint whose mitre would take more than the sides have.
    """
    lengths = np.linalg.norm(sides[:, 1] - sides[:, 0], axis=1)
    is_outer = turn * distance <= 0
    is_sharp = np.abs(turn) >= _SHARPEST_MITRE
    mitre = np.abs(distance * np.tan(np.where(is_sharp, 0.0, turn) / 2))
    taken = np.zeros(len(sides))
    inner = np.where(is_outer, 0.0, np.where(is_sharp, np.inf, mitre))
    np.add.at(taken, before, inner)
    np.add.at(taken, after, inner)
    fits = taken <= lengths
    is_loop = ~is_outer & ~(fits[before] & fits[after])
    cut_off = np.abs(distance) * np.tan(np.abs(turn) / 4)
    outer = np.where(is_sharp, cut_off, mitre)
    return np.where(is_outer, outer, np.where(is_loop, 0.0, -mitre)), is_loop


def _parts_off(line: Polyline, shifted: _Shifted, distance: float) -> Floats:
    """The parts of shifted sides that come no nearer to the line than the distance.

    Returns
    -------
    (p, 2, 2) float64
        In their order; each is a side or what lies between two of its crossings.
    """
    sides, lengths = shifted.sides, _lengths(shifted.sides)
    middles = sides.mean(axis=1)
    # No place of a side is further from the line than its middle by more than half its length.
    is_possible = ~shifted.is_bridge
    is_possible &= _distances(line, middles) + lengths / 2 >= distance - _TOO_NEAR_M
    sides = sides[is_possible]
    if not sides.size:
        return sides
    one, other = meeting_pairs(sides, sides)
    is_first = one < other
    one, other = one[is_first], other[is_first]
    on_one, on_other = crossing_fractions(sides[one], sides[other])
    real = (on_one >= 0) & (on_one <= 1) & (on_other >= 0) & (on_other <= 1)
    stops = [np.arange(len(sides) + 1.0), (one + on_one)[real], (other + on_other)[real]]
    if not line.is_closed:
        stops += [_circle_cuts(sides, end[:2], distance) for end in (line.xyz[0], line.xyz[-1])]
    cuts = np.unique(np.concatenate(stops))
    side = cuts[:-1].astype(np.int64)
    steps = sides[side, 1] - sides[side, 0]
    starts = sides[side, 0] + (cuts[:-1] - side)[:, None] * steps
    ends = sides[side, 0] + (cuts[1:] - side)[:, None] * steps
    nearest = np.minimum(_distances(line, starts), _distances(line, ends)) + _JOINED_M
    keeps_off = np.minimum(nearest, _distances(line, (starts + ends) / 2)) >= distance - _TOO_NEAR_M
    parts: Floats = np.stack([starts, ends], axis=1)[keeps_off]
    return parts


def _circle_cuts(sides: Floats, centre: Floats, radius: float) -> Floats:
    """Where sides cross a circle: index of the side plus the fraction on it."""
    steps, away = sides[:, 1] - sides[:, 0], sides[:, 0] - centre
    a, b = (steps**2).sum(axis=1), (steps * away).sum(axis=1)
    roots = b**2 - a * ((away**2).sum(axis=1) - radius**2)
    crosses = np.flatnonzero(roots > 0)
    root = np.sqrt(roots[crosses])
    cuts = []
    for sign in (-1.0, 1.0):
        fraction = (sign * root - b[crosses]) / a[crosses]
        inside = (fraction >= 0) & (fraction <= 1)
        cuts.append(crosses[inside] + fraction[inside])
    return np.concatenate(cuts)


def _chained(parts: Floats, *, is_closed: bool) -> list[Floats]:
    """Lines, (k, 2) each, from parts of which one ends where the next begins."""
    gaps = np.linalg.norm(parts[1:, 0] - parts[:-1, 1], axis=1) > _JOINED_M
    chains = [_places_of(chain) for chain in np.split(parts, np.flatnonzero(gaps) + 1)]
    if is_closed and np.linalg.norm(chains[-1][-1] - chains[0][0]) <= _JOINED_M:
        if len(chains) > 1:
            chains[0] = np.concatenate([chains.pop()[:-1], chains[0]])
        else:
            chains[0] = chains[0][:-1]
    return chains


def _places_of(parts: Floats) -> Floats:
    """The places of a chain; those that crossings put on top of one another are one."""
    places = np.concatenate([parts[:1, 0], parts[:, 1]])
    moves = np.linalg.norm(np.diff(places, axis=0), axis=1) > _JOINED_M
    return places[np.concatenate([[True], moves])]


def _distances(line: Polyline, places: Floats) -> Floats:
    return nearest_sides(line.plan_sides, places)[2]


def _lengths(sides: Floats) -> Floats:
    lengths: Floats = np.linalg.norm(sides[:, 1] - sides[:, 0], axis=1)
    return lengths


def _length(plan: Floats) -> float:
    return float(np.linalg.norm(np.diff(plan, axis=0), axis=1).sum())


def _no_copy(positions: Sequence[Position]) -> OutOfRange:
    place = positions[0] if positions else (0.0, 0.0, 0.0)
    return OutOfRange(
        Text(
            "No parallel line is left at this distance on this side.",
            "この距離・この側では平行線を作成できません。",
        ),
        said_place(place),
        Text(
            "Choose a smaller distance or the other side.",
            "距離を小さくするか、反対側を指定してください。",
        ),
    )

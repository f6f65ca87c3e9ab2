"""Parallel copies of lines, and the signed distance of a place from a line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.errors import OutOfRange
from processing.core.text import Text
from processing.map.drafting.plan_sides import SideIndex, cross, nearest_fractions
from processing.map.drafting.polyline import Polyline, name_position
from processing.map.feature import Position

_SHARPEST_MITRE = np.radians(100.0)
_LONGEST_SPIKE_M = 0.01
_JOINED_M = 1e-6


def parallel(
    positions: Sequence[Position], distance_m: float, *, is_closed: bool = False
) -> tuple[Position, ...]:
    """A copy of a line at a distance in plan.

    1. Every side gets a strip of ground as wide as the distance; joints are mitred, very sharp
       outer ones cut off at the distance.
    2. The strips are united: where a bend is tighter than the distance, they overlap.
    3. The copy is what bounds the union but the line itself and its two ends.

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
    index = SideIndex(line.plan_sides)
    chains = list(_far_sides(_band(line, distance_m), line, index, distance_m))
    if not chains:
        raise _no_copy(positions)
    plan = max(chains, key=_length)
    if is_closed and (plan[0] == plan[-1]).all():
        plan = plan[:-1]
    sides, fractions, _ = index.nearest(plan)
    heights = line.between(sides, fractions)[:, 2]
    return line.positions(np.column_stack([plan, heights]))


def distance_to_line(
    positions: Sequence[Position], position: Position, *, is_closed: bool = False
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
    line = _without_repeats(Polyline.of(positions, is_closed=is_closed, origin=position))
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


def _band(line: Polyline, distance: float) -> shapely.Geometry:
    """The strip of ground between a line and its copy, as the union of one strip per side."""
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
    reach = _reach_of_joints(sides, before, after, turn, distance)
    corners = sides[after, 0]
    leaving = corners + offsets[before] + reach[:, None] * directions[before]
    arriving = corners + offsets[after] - reach[:, None] * directions[after]
    # At a mitre both are one place, to the last bit, or slivers would lie between the strips.
    is_mitre = np.linalg.norm(arriving - leaving, axis=1) < _JOINED_M
    arriving[is_mitre] = leaving[is_mitre]
    starts, ends = sides[:, 0] + offsets, sides[:, 1] + offsets
    starts[after], ends[before] = arriving, leaving
    strips = shapely.polygons(np.stack([sides[:, 0], sides[:, 1], ends, starts], axis=1))
    is_cut = (turn * distance < 0) & ~is_mitre
    corner_pieces = np.stack([corners, leaving, arriving], axis=1)[is_cut]
    return shapely.union_all(np.concatenate([strips, shapely.polygons(corner_pieces)]))


def _far_sides(
    band: shapely.Geometry, line: Polyline, index: SideIndex, distance: float
) -> Iterator[Floats]:
    """What bounds the strip but the line and the ends: (k, 2) each, in the line's direction."""
    for polygon in shapely.get_parts(shapely.orient_polygons(band)):
        for ring in (polygon.exterior, *polygon.interiors):
            # With the strip on its left a boundary runs against a line that has it on its left.
            positions = shapely.get_coordinates(ring)[:: -1 if distance > 0 else 1]
            yield from _runs_off(positions, line, index, abs(distance))


def _runs_off(ring: Floats, line: Polyline, index: SideIndex, distance: float) -> Iterator[Floats]:
    """The runs of a closed boundary that keep off the line and its ends."""
    middles = (ring[1:] + ring[:-1]) / 2
    away = index.nearest(middles)[2]
    is_off = away > _JOINED_M
    if not line.is_closed:
        is_off &= ~_is_at_end(middles, line, distance)
    if is_off.all():
        # A hole that reaches the distance nowhere is a crack between overlapping strips.
        if away.max() >= distance - _JOINED_M:
            yield _without_doubles(ring)
        return
    first = int(np.flatnonzero(~is_off)[0])
    order = np.roll(np.arange(len(middles)), -first)
    for run in np.split(order, np.flatnonzero(np.diff(is_off[order].astype(np.int8))) + 1):
        # Where the strip ends askew, its boundary comes back to the line: no part of the copy.
        at_distance = np.flatnonzero(is_off[run] & (away[run] >= distance - _JOINED_M))
        if at_distance.size:
            kept = run[at_distance[0] : at_distance[-1] + 1]
            yield _without_doubles(np.concatenate([ring[kept], ring[kept[-1:] + 1]]))


def _is_at_end(positions: Floats, line: Polyline, distance: float) -> NDArray[np.bool_]:
    """Which places are on the straight edges that end the strip of an open line."""
    found = np.zeros(len(positions), np.bool_)
    for xyz in (line.xyz, line.xyz[::-1]):
        along = xyz[1, :2] - xyz[0, :2]
        along /= np.linalg.norm(along)
        away = positions - xyz[0, :2]
        is_square = np.abs(away @ along) < _JOINED_M
        found |= is_square & (np.linalg.norm(away, axis=1) < distance + _JOINED_M)
    return found


def _without_doubles(positions: Floats) -> Floats:
    moves = np.linalg.norm(np.diff(positions, axis=0), axis=1) > _JOINED_M
    moves[-1:] = True
    kept: Floats = positions[np.concatenate([[True], moves])]
    return kept


def _reach_of_joints(
    sides: Floats,
    before: NDArray[np.int64],
    after: NDArray[np.int64],
    turn: Floats,
    distance: float,
) -> Floats:
    """How far shifted sides go on beyond their corners, (j,) m.

    Negative where a mitre shortens both sides; 0 inside a bend whose sides are too short for it:
    there they overlap.
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
    # A mitre longer than its sides is a spike on an uneven line, not the corner of a street.
    spike = np.hypot(distance, mitre) - abs(distance)
    is_spike = (spike > _LONGEST_SPIKE_M) & (mitre > np.minimum(lengths[before], lengths[after]))
    outer = np.where(is_sharp | is_spike, cut_off, mitre)
    return np.where(is_outer, outer, np.where(is_loop, 0.0, -mitre))


def _length(plan: Floats) -> float:
    return float(np.linalg.norm(np.diff(plan, axis=0), axis=1).sum())


def _no_copy(positions: Sequence[Position]) -> OutOfRange:
    position = positions[0] if positions else (0.0, 0.0, 0.0)
    return OutOfRange(
        Text(
            "No parallel line is left at this distance on this side.",
            "この距離・この側では平行線を作成できません。",
        ),
        name_position(position),
        Text(
            "Choose a smaller distance or the other side.",
            "距離を小さくするか、反対側を指定してください。",
        ),
    )

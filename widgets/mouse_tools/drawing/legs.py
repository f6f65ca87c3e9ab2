"""Legs: the pieces of a line that is being drawn, each in its own way."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property

from processing.map.drafting.constructions import arc_through, spline_through
from processing.map.feature import Feature, Position, Vertex


class LegMode(Enum):
    """How a line goes from one click to the next."""

    STRAIGHT = "line"
    ARC = "arc"
    SPLINE = "spline"
    TRACE = "trace"


@dataclass(frozen=True)
class Leg:
    """A piece of a path.

    Attributes
    ----------
    clicked : tuple of Vertex
        The clicks that made it, the last one at its end.
    vertices : tuple of Vertex
        What it adds behind the vertex where it starts; its last one is the last click.
    """

    mode: LegMode
    clicked: tuple[Vertex, ...]
    vertices: tuple[Vertex, ...]


@dataclass(frozen=True)
class DrawnPath:
    """What was drawn so far.

    Attributes
    ----------
    start : tuple of Vertex
        The first click; or all vertices of a line that is continued.
    pending : tuple of Vertex
        Clicks that make no leg yet: the middle of an arc.
    """

    start: tuple[Vertex, ...] = ()
    legs: tuple[Leg, ...] = ()
    pending: tuple[Vertex, ...] = ()

    @cached_property
    def vertices(self) -> tuple[Vertex, ...]:
        """All vertices in their order, without pending ones."""
        return self.start + tuple(vertex for leg in self.legs for vertex in leg.vertices)

    @property
    def end(self) -> Vertex | None:
        """Where the next leg starts."""
        if self.legs:
            return self.legs[-1].vertices[-1]
        return self.start[-1] if self.start else None

    def with_leg(self, leg: Leg) -> DrawnPath:
        """The path with one more leg."""
        longer = replace(self, legs=(*self.legs, leg), pending=())
        # Lines of many vertices grow by one leg at a time: those before are not gathered anew.
        longer.__dict__["vertices"] = self.vertices + leg.vertices
        return longer

    def with_pending(self, vertex: Vertex) -> DrawnPath:
        """The path with one more click that makes no leg yet."""
        return replace(self, pending=(*self.pending, vertex))

    def without_last(self) -> DrawnPath:
        """The path without the last click; a leg of several clicks loses one of them."""
        if self.pending:
            return replace(self, pending=self.pending[:-1])
        if not self.legs:
            return replace(self, start=self.start[:-1])
        last = self.legs[-1]
        legs = self.legs[:-1]
        shorter = replace(self, legs=legs)
        if last.mode is LegMode.SPLINE and len(last.clicked) > 1:
            start = shorter.end
            if start is not None:
                return shorter.with_leg(spline_leg(start, last.clicked[:-1]))
        return shorter


@dataclass(frozen=True)
class InterruptedDrawing:
    """A drawing that was put down and can be taken up again.

    Attributes
    ----------
    base : Feature or None
        The line that it continues.
    is_turned : bool
        Whether it goes on at that line's first vertex.
    """

    path: DrawnPath
    base: Feature | None
    is_turned: bool


def straight_leg(vertex: Vertex) -> Leg:
    """Straight on to a click."""
    return Leg(LegMode.STRAIGHT, (vertex,), (vertex,))


def arc_leg(start: Vertex, middle: Vertex, end: Vertex) -> Leg:
    """A circle's arc over a click to another; its heights run between those of the clicks."""
    curve = arc_through(start.xyz, middle.xyz, end.xyz)
    return Leg(LegMode.ARC, (middle, end), _on_curve(curve, (start, middle, end)))


def spline_leg(start: Vertex, clicked: Sequence[Vertex]) -> Leg:
    """A smooth curve through all clicks."""
    through = (start, *clicked)
    if len(through) < 3:
        return Leg(LegMode.SPLINE, tuple(clicked), tuple(clicked))
    curve = spline_through([vertex.xyz for vertex in through])
    return Leg(LegMode.SPLINE, tuple(clicked), _on_curve(curve, through))


def _on_curve(curve: Sequence[Position], clicked: Sequence[Vertex]) -> tuple[Vertex, ...]:
    """The curve's vertices behind its start; where it passes a click, the click itself."""
    vertices = [Vertex(position) for position in curve]
    for vertex in clicked:
        near = min(range(len(curve)), key=lambda position: _away(curve[position], vertex.xyz))
        if _away(curve[near], vertex.xyz) < 1e-3:
            vertices[near] = vertex
    vertices[-1] = clicked[-1]
    return tuple(vertices[1:])


def _away(one: Position, other: Position) -> float:
    return math.hypot(one[0] - other[0], one[1] - other[1])


def square_to(before: Vertex, last: Vertex, wanted: Position) -> Position:
    """The place nearest to a wanted one that goes on straight or at right angles, in plan.

    Parameters
    ----------
    before, last : Vertex
        The segment whose direction is held.
    """
    east, north = last.xyz[0] - before.xyz[0], last.xyz[1] - before.xyz[1]
    length = math.hypot(east, north)
    if length < 1e-6:
        return wanted
    along = (east / length, north / length)
    mode = (wanted[0] - last.xyz[0], wanted[1] - last.xyz[1])
    forward = mode[0] * along[0] + mode[1] * along[1]
    aside = mode[1] * along[0] - mode[0] * along[1]
    if abs(forward) >= abs(aside):
        step = (along[0] * forward, along[1] * forward)
    else:
        step = (-along[1] * aside, along[0] * aside)
    return last.xyz[0] + step[0], last.xyz[1] + step[1], wanted[2]

"""The body through the points of a stem: where its fits begin, and which the points speak for.

Trunks bend, lean and taper, ivy and stakes stand about them, and of most only one side was seen. A
fit ends in what lies near to where it begins, so it begins from several places, and what lies
inside speaks against a body as much as what lies on it speaks for it: nothing shines through bark.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.methods.road.trees.cone_kernels import (
    NUMBERS,
    arc_kernel,
    evenness_kernel,
    inside_kernel,
    near_kernel,
    scatter_kernel,
    settle_kernel,
    speaks_kernel,
    thinner_kernel,
)

BREAST_M = 1.2
"""Height of the diameter above the foot: 胸高 in Japan (Takahashi 2022, 5.1)."""

SHAPE_M = 0.003
"""How far bark and the points at a trunk's edges make its shape seem off; as for the girth."""

_SHAPES_M = (SHAPE_M, 0.001, 0.0)
"""Less and less of what is seen is held for bark, and more for a trunk that isn't round. Of the
stems that were looked at, sectors of 15 degrees lie 0.4 to 1.3 mm off an ellipse."""

_ABOUT_M = 0.1
"""From a body's surface to the points that are looked at: what it may move while it is fitted."""

_ALIKE = 10
"""Points that lie off a trunk together: a burr or a lobe of bark holds so many."""

_FLATTER = (0.0, 5.0, 6.0)
"""How much likelier (natural logarithm, halves) each shape must make the points: Akaike's 2 for
each of the two numbers of an ellipse, and somewhat more, since few trunks are flat."""

_CLEARLY_OTHER = 22.0
"""The same for all ten numbers of a piece by itself."""

_OPEN = 0.5
"""Standard deviation of the radius over what its shapes differ in it: where they do, half a trunk
was seen, and how flat it is stays open."""

_THINNER = (1.0, 0.75, 0.6)
"""Radius of the bodies from which fits begin, over that of the circles: ivy and stakes widen these
by so much, and a fit from too wide a circle keeps to the ivy."""

_CLAD = 0.03
"""Points inside a body over those on it, from which a thinner one is asked: stray points of edges
are fewer."""

_BENDS_BELOW_M, _BENDS_OVER_M = 0.55, 0.25
"""How far below and above 1.2 m a stem has circles whose bend is told."""

_BEND_M, _CIRCLE_M = 0.05, 0.01
"""Standard deviations of how far a trunk leaves its tangent in a metre and of a circle's middle:
few circles tell no bend."""

_PIECE_M, _FEWEST_CIRCLES = 0.65, 4
"""m to either side of 1.2 m in which a stem that bends twice is simple enough: slender stems of one
tree curve out by 0.1 m in a metre and a half, a hundredth of a metre there; and circles of it."""


class StemBody(NamedTuple):
    """One upright round body.

    Attributes
    ----------
    numbers : (10,) float64
        As kernels have them, about the foot.
    deviation_m : float
        Standard deviation of the radius, m.
    noise_m : float
        How far its points lie off it.
    arc : float
        Share of its circumference that was seen.
    lines : (n,) int64
        Its points, by their line among those of the column.
    evenness : float
        How evenly they fill its seen side, 1: as by chance.
    outer : (10,) float64
        The body about what clings to it: where the fit from the circles themselves ends.
    """

    numbers: Floats
    deviation_m: float
    noise_m: float
    arc: float
    lines: Integers
    evenness: float
    outer: Floats


class _Fit(NamedTuple):
    """Points near a body, and the body.

    By line and about 1.2 m above the foot; which of them lie on it, and the body about what clings
    to it.
    """

    about: Integers
    local: Floats
    body: Floats
    deviation_m: float
    noise_m: float
    near: NDArray[np.bool_]
    outer: Floats


class _Cone(NamedTuple):
    """A body, its radius' standard deviation, how far its points lie off it, and which they are."""

    body: Floats
    deviation_m: float
    noise_m: float
    near: NDArray[np.bool_]


def body_through(points: Floats, chain: Floats, over_m: float) -> StemBody | None:
    """The body through the points about a chain of circles; None where too few are near.

    Parameters
    ----------
    points : (n, 3) float64
        m about the foot.
    chain : (k, 5) float64
        Height, middle, radius and arc of circles that follow each other upwards, m.
    over_m : float
        How far below the first and above the last circle its points reach.

    Notes
    -----
    1. A straight, leaning, tapering, oval cone by steps of Gauss and Newton.
    2. A bent one, where circles reach far enough and the points are likelier with it: how far
       trunks bend holds it.
    3. One through the piece about 1.2 m alone, where its points are clearly likelier with it
       (Akaike 1974).
    """
    heights = float(chain[0, 0]) - over_m, float(chain[-1, 0]) + over_m
    fit = _fitted(points, _straight(chain), heights)
    if _is_long(chain):
        bent = _fitted(points, _bent(chain), heights)
        if bent is not None and (fit is None or _is_likelier(bent, fit, 0.0)):
            fit = bent
    if fit is None:
        return None
    lines, outer = fit.about[fit.near], fit.outer
    rows = chain[np.abs(chain[:, 0] - BREAST_M) < _PIECE_M]
    if _FEWEST_CIRCLES <= len(rows) < len(chain):
        ends = float(rows[0, 0]) - over_m, float(rows[-1, 0]) + over_m
        piece = _fitted(points, fit.body, ends)
        if piece is not None and _is_likelier(piece, fit, _CLEARLY_OTHER):
            beyond = (points[lines, 2] < ends[0]) | (points[lines, 2] > ends[1])
            fit, lines = piece, np.concatenate([lines[beyond], piece.about[piece.near]])
    arc = float(arc_kernel(fit.local, fit.body, fit.near))
    local = points[lines] - (0.0, 0.0, BREAST_M)
    evenness = float(evenness_kernel(local, fit.body, np.ones(len(lines), np.bool_)))
    return StemBody(fit.body, fit.deviation_m, fit.noise_m, arc, lines, evenness, outer)


def _fitted(points: Floats, start: Floats, heights: tuple[float, float]) -> _Fit | None:
    """The body near one through points of some heights; None where too few are near."""
    about = _points_near(points, start, heights)
    local = points[about] - (0.0, 0.0, BREAST_M)
    ends = _ends(local, start)
    if not ends:
        return None
    cone = _likeliest(local, max(ends, key=lambda body: float(speaks_kernel(local, body))))
    return _Fit(about, local, *cone, ends[0]) if cone is not None else None


def _is_likelier(fit: _Fit, other: _Fit, clearly: float) -> bool:
    """Whether points are clearly likelier with a body than with another."""
    both = fit.near | near_kernel(fit.local, other.body)
    worse = scatter_kernel(fit.local, other.body, both)
    better = scatter_kernel(fit.local, fit.body, both)
    number = np.count_nonzero(both) / _ALIKE
    return bool(2 * number * math.log(worse / better) > clearly)


def _is_long(chain: Floats) -> bool:
    """Whether circles reach as far to either side of 1.2 m as tells a bend."""
    below, over = BREAST_M - chain[0, 0], chain[-1, 0] - BREAST_M
    return bool(below >= _BENDS_BELOW_M and over >= _BENDS_OVER_M)


def _points_near(points: Floats, body: Floats, heights: tuple[float, float]) -> Integers:
    """Points of some heights within a hand's breadth of a body."""
    up = points[:, 2]
    about = np.flatnonzero((up >= heights[0]) & (up <= heights[1]))
    over = up[about, None] - BREAST_M
    beside = points[about, :2] - body[:2] - over * (body[2:4] + over * body[8:10])
    near: Integers = about[np.hypot(beside[:, 0], beside[:, 1]) < body[4] + _ABOUT_M]
    return near


def _straight(chain: Floats) -> Floats:
    """The round, straight body that circles tell."""
    height = chain[:, 0] - BREAST_M
    body = np.zeros(NUMBERS)
    weight = (0.1 + chain[:, 4]) ** 2
    about = height - np.average(height, weights=weight)
    slope = (weight * about) @ chain[:, 1:3] / max(float(weight @ about**2), 1e-9)
    body[2:4] = slope
    body[:2] = np.average(chain[:, 1:3] - height[:, None] * slope, axis=0, weights=weight)
    body[4] = float(np.median(chain[:, 3]))
    return body


def _bent(chain: Floats) -> Floats:
    """The round body that circles tell whose axis bends."""
    body = _straight(chain)
    height = chain[:, 0] - BREAST_M
    powers = np.column_stack([np.ones(height.size), height, height**2])
    weight = ((0.1 + chain[:, 4]) ** 2)[:, None]
    normal = powers.T @ (weight * powers)
    normal[2, 2] += float(weight.mean()) * (_CIRCLE_M / _BEND_M) ** 2
    body[:2], body[2:4], body[8:10] = np.linalg.solve(normal, powers.T @ (weight * chain[:, 1:3]))
    return body


def _ends(local: Floats, start: Floats) -> list[Floats]:
    """Where fits from a body end, and from thinner ones where points lie inside that."""
    ends: list[Floats] = []
    for share in _THINNER:
        if ends and inside_kernel(local, ends[0]) < _CLAD:
            break
        thinner = start.copy()
        thinner_kernel(local, share, thinner)
        cone = _settled(local, thinner, SHAPE_M)
        if cone is not None:
            ends.append(cone.body)
    return ends


def _likeliest(local: Floats, start: Floats) -> _Cone | None:
    """The body that the points near it give, as flat as they show it; None where too few are."""
    cones: list[_Cone] = []
    for shape_m in _SHAPES_M:
        cone = _settled(local, cones[-1].body if cones else start, shape_m)
        if cone is None:
            break
        cones.append(cone)
    if not cones:
        return None
    near = np.any([cone.near for cone in cones], axis=0)
    number = np.count_nonzero(near) / _ALIKE
    worse = [
        2 * number * math.log(scatter_kernel(local, cone.body, near)) + more
        for cone, more in zip(cones, _FLATTER, strict=False)
    ]
    chosen = cones[int(np.argmin(worse))]
    open_m = _OPEN * float(np.ptp([cone.body[4] for cone in cones]))
    return chosen._replace(deviation_m=math.hypot(chosen.deviation_m, open_m))


def _settled(local: Floats, start: Floats, shape_m: float) -> _Cone | None:
    """The body that the points near it give; None where too few are."""
    body, near = start.copy(), np.zeros(len(local), np.bool_)
    deviation, noise = settle_kernel(local, shape_m, body, np.empty(len(local)), near)
    return _Cone(body, deviation, noise, near) if noise > 0 else None

"""Shafts that are mirror images: windows and glass doors show poles of the street behind the wall.

The image is as straight and round as the pole itself, with fewer points, since panes mirror a small
part of the light. It lies as far behind the pane as the pole lies before it, so the plane midway
between both is that of the wall, where the beam passed it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.methods.road.objects.column_points import points_about
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.poles.shaft_sides import towards_vehicle
from processing.methods.road.poles.shafts import Shaft, feet_of
from processing.recording.drive import Drive

_NEAR_M, _FAR_M = 1.0, 40.0
"""From an image to what it shows: walls stand half a metre and more beside poles, and across the
widest streets panes mirror too little to be measured."""

_ALIKE_M, _ALIKE = 0.015, 0.25
"""How far radii of both may differ, m and as a share: of an image few points were measured."""

_LEVEL_M = 0.3
"""How far their feet differ in height: ground seen through panes is told badly."""

_HIGHER_M = 0.3
"""By which an image may reach higher than what it shows: a pane shows less of it, never more."""

_FEWER = 0.5
"""Points of an image for each of what it shows: a pane mirrors 4 to 10 % of the light, and a beam
that meets it square or strikes its frame mirrors nothing back."""

_ABOUT_M, _GATHERED_M = 1.5, 2.5
"""About the place where the beam passed the wall, what is looked for of it: frames and piers beside
panes. Places of several pairs nearer than the difference are asked for at once."""

_LOW_M, _HIGH_M = 0.3, 4.0
"""Heights above the foot in which shops and houses have panes."""

_ON_M, _BESIDE_M = 0.06, 0.6
"""From the plane to the wall's points, frames and sills included; and to those of other things."""

_FEWEST, _MOST_ON = 50, 0.5
"""Points that are a wall, and their share of all beside the plane: of a simulated street's seven
poles none had fifty and 0.15 at once, of its eight images whose pole was found each had a thousand
and 0.7."""


class _Pair(NamedTuple):
    """An image that a shaft may be: its number, the plane's middle and normal, where it is passed.

    All in plan, m about the plan's origin.
    """

    image: int
    middle: Floats
    normal: Floats
    passed: Floats


def mirror_images(
    drives: Sequence[Drive],
    plan: SparsePlan,
    shafts: Sequence[Shaft],
    asked: Sequence[int],
    monitor: Monitor,
) -> frozenset[int]:
    """Which of the shafts are images of others.

    Parameters
    ----------
    asked : sequence of int
        Numbers of the shafts that are asked about.
    """
    if not shafts:
        return frozenset()
    feet = cKDTree(feet_of(shafts))
    pairs: list[_Pair] = []
    for number in asked:
        monitor.check()
        near = feet.query_ball_point(shafts[number].foot[:2], _FAR_M, return_sorted=True)
        towards = towards_vehicle(drives, shafts[number], plan.origin)
        pairs += _pairs(number, shafts[number], [shafts[other] for other in near], towards)
    if not pairs:
        return frozenset()
    places = _thinned(np.array([one.passed for one in pairs]))
    walls = points_about(drives, plan, places, _GATHERED_M, monitor)
    tree = cKDTree(places)
    images = set()
    for pair in pairs:
        monitor.check()
        about = tree.query_ball_point(pair.passed, _GATHERED_M + _ABOUT_M, return_sorted=True)
        local = np.concatenate([walls.local[walls.of(place)] for place in about])
        away = np.hypot(*(local[:, :2] - pair.passed).T)
        if _is_wall(local[away <= _ABOUT_M], pair, float(shafts[pair.image].foot[2])):
            images.add(pair.image)
    return frozenset(images)


def _pairs(number: int, shaft: Shaft, others: Sequence[Shaft], towards: Floats) -> Iterator[_Pair]:
    """What a shaft could be an image of, seen from where the vehicle was.

    Parameters
    ----------
    others : sequence of Shaft
        Those near enough.
    towards : (n, 2) float64
        As :func:`towards_vehicle` tells it of the shaft.
    """
    towards = towards[np.isfinite(towards[:, 0])]
    if len(towards) == 0:
        return
    view = towards.mean(axis=0)
    for other in others:
        away = other.foot - shaft.foot
        apart = float(np.hypot(*away[:2]))
        alike = _ALIKE_M + _ALIKE * min(shaft.radius_m, other.radius_m)
        if not _NEAR_M < apart < _FAR_M or abs(away[2]) > _LEVEL_M:
            continue
        if abs(shaft.radius_m - other.radius_m) > alike:
            continue
        if shaft.points.size > _FEWER * other.points.size:
            continue
        if shaft.top_m > other.top_m + _HIGHER_M:
            continue
        normal = away[:2] / apart
        before = float(view @ normal)
        # The vehicle is before the wall, as what is mirrored is.
        if before > apart / 2:
            passed = shaft.foot[:2] + view * (apart / 2 / before)
            yield _Pair(number, shaft.foot[:2] + away[:2] / 2, normal, passed)


def _thinned(places: Floats) -> Floats:
    """Some of the places, none of the others farther from one than is looked about each."""
    tree = cKDTree(places)
    is_free = np.ones(len(places), np.bool_)
    kept: list[int] = []
    for number, place in enumerate(places):
        if is_free[number]:
            kept.append(number)
            is_free[tree.query_ball_point(place, _GATHERED_M - _ABOUT_M)] = False
    return np.asarray(places[kept])


def _is_wall(points: Floats, pair: _Pair, foot_m: float) -> bool:
    """Whether what lies about the place where the beam passed is a wall on the plane."""
    up = points[:, 2] - foot_m
    off = np.abs((points[:, :2] - pair.middle) @ pair.normal)
    is_beside: NDArray[np.bool_] = (up > _LOW_M) & (up < _HIGH_M) & (off < _BESIDE_M)
    on = int(np.count_nonzero(is_beside & (off < _ON_M)))
    return bool(on >= _FEWEST and on >= _MOST_ON * np.count_nonzero(is_beside))

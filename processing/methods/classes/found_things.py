"""Things that were found along a street, and the points that are theirs.

A curb is a few centimetres of a row of points, a sign a few dozen points on a post: how they look
from near by differs between scanners and worlds, but extraction measures them as what they are. A
point on the face or top of a found curb, on a plate or on a shaft is told by it: this joins what a
model says of surroundings to what a tool measured, class by class. Before a curb lies the road, and
none behind it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats, Integers
from processing.methods.classes.points_on_curbs import (
    CurbEdges,
    NearCurbs,
    curb_samples,
    moved_to,
    near_samples,
)

ROAD, SIGN, POLE_LIKE, CURB = 11, 65, 66, 67

_PLATE_STEP_M, _SHAFT_STEP_M = 0.15, 0.3
"""Between the places of plates and shafts that are looked for near a point."""

_PLATE_REACH_M, _SHAFT_REACH_M = 0.35, 1.0
"""From the middle of a plate's or an axis's place; trunks of 1.2 m have their bark."""

_PLATE_M, _RIM_M = 0.04, 0.03
"""Off a plate's plane and beyond its outline: two passes lie so far apart."""

_BARK_M = 0.05
"""Outside a shaft's surface: bands, bolts, and what a cone is not."""


class FoundPlate(NamedTuple):
    """A plate of a sign.

    Attributes
    ----------
    outline : (n, 3) float64
        Its corners in order, m, project CRS.
    confidence : float
    """

    outline: Floats
    confidence: float


class FoundShaft(NamedTuple):
    """A pole, or a stem of a tree.

    Attributes
    ----------
    foot : (3,) float64
        Where its axis meets the ground, m, project CRS.
    lean : (2,) float64
        Metres that the axis moves to the east and north in a metre of height.
    radius_m, taper : float
        Radius at the foot, m; what it loses in a metre of height.
    height_m : float
    confidence : float
    """

    foot: Floats
    lean: Floats
    radius_m: float
    taper: float
    height_m: float
    confidence: float


@dataclass(frozen=True)
class FoundThings:
    """What was found on drives recorded together.

    Attributes
    ----------
    curbs, plates, shafts : sequence
    sought : frozenset of int
        The classes whose things could be looked for: a point that belongs to none is then less
        likely of theirs.
    """

    curbs: Sequence[CurbEdges] = ()
    plates: Sequence[FoundPlate] = ()
    shafts: Sequence[FoundShaft] = ()
    sought: frozenset[int] = frozenset()


class ToldPoints(NamedTuple):
    """What found things say of points.

    Attributes
    ----------
    codes : (n,) uint8
        The class of the thing that a point belongs to; 0: to none.
    chances : (n,) float64
        Confidence of that thing, 0 to 1.
    off_road : (n,) float64
        Confidence of the curb behind which a point lies, 0 to 1.
    """

    codes: NDArray[np.uint8]
    chances: Floats
    off_road: Floats


class NearThings:
    """Tells which points belong to found things.

    Parameters
    ----------
    things : FoundThings
    """

    def __init__(self, things: FoundThings) -> None:
        origin = _place_of(things)
        self._origin = origin
        self._curbs = curb_samples(things.curbs, origin)
        self._plates = _plates_of(things.plates, origin)
        self._shafts = _shafts_of(things.shafts, origin)

    def told(self, xyz: Floats) -> ToldPoints:
        """What things say of points of one recording, (n, 3) float64, m, project CRS."""
        places = xyz - self._origin
        nothing = np.zeros((2, len(places)))
        told = ToldPoints(np.zeros(len(places), np.uint8), *nothing)
        if self._curbs is not None:
            near = NearCurbs(moved_to(self._curbs, places), places)
            _tell(told, CURB, near.chances_on_curbs())
            _tell(told, ROAD, near.chances_on_road())
            told.off_road[:] = near.chances_behind()
        if self._plates is not None:
            _tell(told, SIGN, _chances_on_plates(self._plates, places))
        if self._shafts is not None:
            _tell(told, POLE_LIKE, _chances_on_shafts(self._shafts, places))
        return told


def _place_of(things: FoundThings) -> Floats:
    """(3,) a place near things: coordinates of a survey have too many digits to be squared."""
    places = [one.upper[0] for one in things.curbs[:1]]
    places += [one.outline[0] for one in things.plates[:1]]
    places += [one.foot for one in things.shafts[:1]]
    return np.asarray(places[0], np.float64) if places else np.zeros(3)


def _tell(told: ToldPoints, code: int, chances: Floats) -> None:
    """The surer of two things has a point."""
    is_surer = chances > told.chances
    told.codes[is_surer] = code
    told.chances[is_surer] = chances[is_surer]


class _PlateSamples(NamedTuple):
    """Places on plates, the plate of each; normals, corners in the plane, and confidence."""

    tree: cKDTree
    plate_of: Integers
    frames: tuple[tuple[Floats, Floats, Floats], ...]
    confidence: Floats


class _ShaftSamples(NamedTuple):
    """Places along axes, the shaft of each; (k, 8): foot, lean, radius, taper, height."""

    tree: cKDTree
    shaft_of: Integers
    axes: Floats
    confidence: Floats


def _plates_of(plates: Sequence[FoundPlate], origin: Floats) -> _PlateSamples | None:
    if not plates:
        return None
    frames, samples, plate_of = [], [], []
    for number, one in enumerate(plates):
        outline = one.outline - origin
        middle = outline.mean(axis=0)
        _, _, axes = np.linalg.svd(outline - middle)
        corners = (outline - middle) @ axes[:2].T
        low, high = corners.min(axis=0), corners.max(axis=0)
        steps = [
            np.linspace(a, b, max(2, int((b - a) / _PLATE_STEP_M) + 2))
            for a, b in zip(low, high, strict=True)
        ]
        grid = np.stack(np.meshgrid(*steps), axis=-1).reshape(-1, 2)
        samples.append(middle + grid @ axes[:2])
        plate_of.append(np.full(len(grid), number))
        frames.append((middle, axes, np.abs(corners).max(axis=0)))
    return _PlateSamples(
        cKDTree(np.concatenate(samples)),
        np.concatenate(plate_of),
        tuple(frames),
        np.array([one.confidence for one in plates]),
    )


def _chances_on_plates(plates: _PlateSamples, places: Floats) -> Floats:
    """(n,) confidence of the plate that a place lies on; 0 where on none."""
    chances = np.zeros(len(places))
    near, nearest = near_samples(plates.tree, places, _PLATE_REACH_M)
    own = plates.plate_of[nearest]
    for number in np.unique(own):
        of_plate = near[own == number]
        middle, axes, half = plates.frames[number]
        about = np.abs((places[of_plate] - middle) @ axes.T)
        is_on = (about[:, 2] < _PLATE_M) & (about[:, :2] < half + _RIM_M).all(axis=1)
        chances[of_plate[is_on]] = plates.confidence[number]
    return chances


def _shafts_of(shafts: Sequence[FoundShaft], origin: Floats) -> _ShaftSamples | None:
    if not shafts:
        return None
    samples, shaft_of = [], []
    for number, one in enumerate(shafts):
        up = np.arange(0.0, one.height_m + _SHAFT_STEP_M, _SHAFT_STEP_M)
        samples.append(one.foot - origin + np.column_stack([up[:, None] * one.lean, up]))
        shaft_of.append(np.full(up.size, number))
    axes = [
        (*(one.foot - origin), *one.lean, one.radius_m, one.taper, one.height_m) for one in shafts
    ]
    return _ShaftSamples(
        cKDTree(np.concatenate(samples)),
        np.concatenate(shaft_of),
        np.array(axes, np.float64),
        np.array([one.confidence for one in shafts]),
    )


def _chances_on_shafts(shafts: _ShaftSamples, places: Floats) -> Floats:
    """(n,) confidence of the shaft whose surface a place lies on; 0 where on none."""
    chances = np.zeros(len(places))
    near, nearest = near_samples(shafts.tree, places, _SHAFT_REACH_M)
    own = shafts.shaft_of[nearest]
    axis = shafts.axes[own]
    up = places[near, 2] - axis[:, 2]
    off = places[near, :2] - axis[:, :2] - up[:, None] * axis[:, 3:5]
    outside = np.hypot(*off.T) - (axis[:, 5] - axis[:, 6] * up)
    is_on = (outside < _BARK_M) & (up > _BARK_M) & (up < axis[:, 7] + _BARK_M)
    chances[near[is_on]] = shafts.confidence[own[is_on]]
    return chances

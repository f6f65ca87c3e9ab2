"""Noise that stays at a place while the vehicle passes: dust, ground seen too low, the sun.

What is drawn for a second of the pass is the same however the recording is cut into stretches.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.returns import BeamHits, shares_of
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats, Integers

_SLOT_S = 1.0
_SEEN_S = 2.0
"""How long before and behind itself a scanner on a vehicle sees a place, at most."""

_ASIDE_M = 8.0
"""Of clouds and patches from the vehicle's way, usually: a road's width and a half."""

_CLOUD_M, _CLOUD_ABOVE_M = (0.3, 1.5), (-1.5, 1.0)
"""Half width, and height over the trajectory's reference point, of what a wheel throws up."""

_THICKNESS = (0.3, 3.0)
"""Mean number of particles met on a way as long as a cloud's half width."""

_NEAREST_M = 0.6
_PATCH_M, _DEPTH_M, _PATCH_SHARES = (0.2, 1.2), (0.06, 0.8), (0.2, 0.9)
_DEPTH_SPREAD_M = 0.02
"""A second way of the light is some centimetres to decimetres longer, and about the same all over a
patch that shines."""

_LEAST_FALL = 0.15
"""Of a beam that tells depth: flatter ones go far for a little depth."""

_SUN_HIGH_DEG, _SUN_HALF_DEG, _SUN_REACH_M = (8.0, 60.0), (0.5, 3.0), (1.0, 30.0)
_STREAM = {"sun": 1000, "clouds": 2_000, "patches": 1_000_002_000}
_MOST_IN_A_SLOT, _SALTS_A_THING = 1000, 4
_FLAT = 0.7
_LEAST = 1e-12


@dataclass(frozen=True)
class Path:
    """Where the scanner's carrier was.

    Attributes
    ----------
    time_s : (m,) float64
    positions : (m, 3) float64
        m.
    stands : bool
        On a tripod: it sees the same places all the time, as many as others pass in some seconds.
    """

    time_s: Floats
    positions: Floats
    stands: bool = False

    def at(self, time_s: float) -> Floats:
        """(3,) m."""
        return np.array([np.interp(time_s, self.time_s, axis) for axis in self.positions.T])


@dataclass(frozen=True)
class _Thing:
    """What the vehicle passes: where, m, chance of its own, and a number apart from others'."""

    middle: Floats
    random: Generator
    salt: int


def way_through(
    beams: Beams, centre: Floats, radii: Floats | float
) -> tuple[Integers, Floats, Floats]:
    """Which beams go through an ellipsoid, and between which ranges, m.

    Parameters
    ----------
    centre : (3,) float64
        m.
    radii : (3,) float64 or float
        m.
    """
    start = (beams.origins - centre) / radii
    direction = beams.directions / radii
    a = np.einsum("ij,ij->i", direction, direction)
    b = np.einsum("ij,ij->i", start, direction)
    inside = b * b - a * (np.einsum("ij,ij->i", start, start) - 1)
    rays = np.flatnonzero(inside > 0)
    root = np.sqrt(inside[rays])
    return rays, (-b[rays] - root) / a[rays], (-b[rays] + root) / a[rays]


class PassingNoise:
    """Dust, patches and sun of one pass or scan, the same for all heads of a vehicle.

    Parameters
    ----------
    clouds_per_s, patches_per_s, sun, aside_m : float
        As `NoiseOptions` has them.
    """

    def __init__(
        self,
        seed: int,
        path: Path,
        *,
        clouds_per_s: float,
        patches_per_s: float,
        sun: float,
        aside_m: float = _ASIDE_M,
    ) -> None:
        self._seed, self._path = seed, path
        self._clouds_per_s, self._patches_per_s, self._share = clouds_per_s, patches_per_s, sun
        self._aside_m = aside_m
        random = chance(seed, "sun")
        high, around = np.radians(random.uniform(*_SUN_HIGH_DEG)), random.uniform(-np.pi, np.pi)
        flat = np.cos(high)
        self._sun = np.array([flat * np.cos(around), flat * np.sin(around), np.sin(high)])
        self._sun_cosine = float(np.cos(np.radians(random.uniform(*_SUN_HALF_DEG))))

    def measure(
        self, beams: Beams, met: BeamHits, is_ground: Integers, key: int, ranges: Floats
    ) -> None:
        """Put the ranges of noise in place.

        Parameters
        ----------
        is_ground : (k,) int64
            Rows of the beams that met the ground.
        key : int
            Of the head's chance.
        ranges : (n,) float64
            Of all beams, m.
        """
        if beams.time_s.size == 0:
            return
        self._into_the_sun(beams, met, key, ranges)
        for one in self._things(beams, "patches", self._patches_per_s, _ASIDE_M):
            _measure_patch(one, (beams, met, is_ground), key, ranges)
        for one in self._things(beams, "clouds", self._clouds_per_s, self._aside_m):
            _measure_cloud(one, beams, met, key, ranges)

    def _things(self, beams: Beams, what: str, per_s: float, aside_m: float) -> Iterator[_Thing]:
        """What the vehicle passes about the time of some beams."""
        if per_s <= 0:
            return
        first = int((beams.time_s[0] - _SEEN_S) // _SLOT_S)
        slots = range(first, int((beams.time_s[-1] + _SEEN_S) // _SLOT_S) + 1)
        for slot in range(int(2 * _SEEN_S)) if self._path.stands else slots:
            random = chance(self._seed, what, slot)
            for number in range(int(random.poisson(per_s * _SLOT_S))):
                middle = self._path.at((slot + random.random()) * _SLOT_S)
                middle[:2] += random.uniform(-aside_m, aside_m, 2)
                salt = _STREAM[what] + _SALTS_A_THING * (_MOST_IN_A_SLOT * slot + number)
                yield _Thing(middle, random, salt)

    def _into_the_sun(self, beams: Beams, met: BeamHits, key: int, ranges: Floats) -> None:
        if self._share <= 0:
            return
        rows = np.flatnonzero(beams.directions @ self._sun > self._sun_cosine)
        rows = rows[shares_of(beams.first + rows, key + _STREAM["sun"]) < self._share]
        low, high = _SUN_REACH_M
        away = low + (high - low) * shares_of(beams.first + rows, key + _STREAM["sun"] + 1)
        is_free = away < met.ranges[rows]
        ranges[rows[is_free]] = away[is_free]


def _measure_cloud(one: _Thing, beams: Beams, met: BeamHits, key: int, ranges: Floats) -> None:
    wide = one.random.uniform(*_CLOUD_M)
    centre = one.middle + np.array([0.0, 0.0, one.random.uniform(*_CLOUD_ABOVE_M)])
    per_m = one.random.uniform(*_THICKNESS) / wide
    rays, near, far = way_through(beams, centre, np.array([wide, wide, _FLAT * wide]))
    near = np.maximum(near, _NEAREST_M)
    long = np.maximum(np.minimum(far, met.ranges[rays]) - near, 0.0)
    # The way to the first particle is exponential.
    to = -np.log(np.maximum(shares_of(beams.first + rays, key + one.salt), _LEAST)) / per_m
    is_met = to < long
    ranges[rays[is_met]] = (near + to)[is_met]


def _measure_patch(
    one: _Thing, seen: tuple[Beams, BeamHits, Integers], key: int, ranges: Floats
) -> None:
    (beams, met, rows), salt = seen, key + one.salt
    wide, depth = one.random.uniform(*_PATCH_M), one.random.uniform(*_DEPTH_M)
    share = one.random.uniform(*_PATCH_SHARES)
    there = beams.origins[rows, :2] + met.ranges[rows, None] * beams.directions[rows, :2]
    rows = rows[np.hypot(*(there - one.middle[:2]).T) < wide]
    rows = rows[shares_of(beams.first + rows, salt) < share]
    deep = depth + _DEPTH_SPREAD_M * _nearly_normal(beams.first + rows, salt + 1)
    ranges[rows] = met.ranges[rows] + deep / np.maximum(-beams.directions[rows, 2], _LEAST_FALL)


def _nearly_normal(numbers: Integers, salt: int) -> Floats:
    """Sums of three equal chances: standard deviation 1, about 0."""
    total: Floats = np.full(numbers.size, -1.5)
    for one in range(3):
        total += shares_of(numbers, salt + one)
    return total * 2.0

"""Patches: small plane pieces of hard surfaces, at several sizes, as one visit saw them.

Space is cut into cubes. Where the points of a cube lie in a plane as exactly as those of the
flattest surfaces around, they are a patch; where they don't, the cubes are cut finer. So roads give
large patches, plates and steps small ones, plants and noise none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.core.monitor import Monitor
from processing.methods.registration.visits import Visit

SIZES_M = (1.0, 0.5, 0.25)
"""Sides of the cubes: of roads and walls, of plates and kerbs, of small faces."""

_SHIFTS = (0.0, 0.37, 0.61)
"""Of the cubes of each size, in their sides: a surface that lies along the faces of one size is
met in the middle by the next."""

_FEWEST = 12
"""Points: the scatter of a plane through fewer is hardly known."""

_NARROWEST = 0.12
"""Standard deviation across the longer direction, in sides of the cube; even cover has 0.29."""

_SCATTERS = 2.5
"""A patch scatters by no more than so many times the scatter of the flattest fifth."""

_OUTLIERS = 3.0
_FITS = 2
_FLATTEST = 20
_FAR = 1 << 20


@dataclass(frozen=True, eq=False)
class Patches:
    """Plane pieces, (k,) each.

    Attributes
    ----------
    key : (k,) int64
        The cube: the same one for all visits.
    size_m : (k,) float64
    xyz, normal : (k, 3) float64
        The middle of the points, m about the survey's origin, and a unit vector.
    scatter_m : (k,) float64
        Standard deviation of the points off the plane.
    count : (k,) int64
    time : (k,) float64
        Mean time.
    """

    key: Integers
    size_m: Floats
    xyz: Floats
    normal: Floats
    scatter_m: Floats
    count: Integers
    time: Floats

    @staticmethod
    def joined(parts: list[Patches]) -> Patches:
        """Several of them as one."""
        return Patches(
            *(
                np.concatenate([getattr(one, name) for one in parts])
                for name in ("key", "size_m", "xyz", "normal", "scatter_m", "count", "time")
            )
        )


@dataclass(frozen=True, eq=False)
class FoundPatches:
    """Patches of a visit.

    Attributes
    ----------
    patches : Patches
    is_level : (n,) bool
        Which points of the visit lie on a patch that is no steeper than a street.
    is_flat : (n,) bool
        Which points lie on any patch.
    """

    patches: Patches
    is_level: Flags
    is_flat: Flags


_LEVEL = 0.9
"""Upward part of the normal of a level patch: 25°, steeper than any street."""


def patches_of(visit: Visit, monitor: Monitor) -> FoundPatches:
    """The patches that a visit saw.

    Raises
    ------
    Cancelled
    """
    left = np.arange(visit.time.size)
    is_level, is_flat = np.zeros(left.size, np.bool_), np.zeros(left.size, np.bool_)
    found: list[Patches] = []
    typical = np.inf
    for level, size in enumerate(SIZES_M):
        cubes = _Cubes.of(visit, left, size, level)
        for _ in range(_FITS):
            monitor.check()
            cubes.fit_again()
        monitor.check()
        patches, is_good, typical = cubes.patches(typical)
        found.append(patches)
        on = np.repeat(is_good, cubes.counts)
        level_ones = np.repeat(is_good & (np.abs(cubes.normal[:, 2]) > _LEVEL), cubes.counts)
        is_flat[cubes.points[on]] = True
        is_level[cubes.points[level_ones]] = True
        left = cubes.points[~on]
        if left.size < _FEWEST:
            break
    return FoundPatches(Patches.joined(found), is_level, is_flat)


class _Cubes:
    """Points in the order of their cubes, and the plane through those of each."""

    def __init__(self, visit: Visit, points: Integers, starts: Integers) -> None:
        self.points, self.starts = points, starts
        self.counts = np.diff(np.append(starts, points.size))
        self.xyz, self.time = visit.xyz[points], visit.time[points]
        self.key = np.zeros(starts.size, np.int64)
        self.low: Floats = np.zeros((starts.size, 3))
        self.size = 0.0
        self.middle: Floats = np.zeros((starts.size, 3))
        self.normal: Floats = np.zeros((starts.size, 3))
        self.spread: Floats = np.zeros((starts.size, 3))
        self.along: Floats = np.zeros((starts.size, 3))
        self.used = self.counts.copy()

    @staticmethod
    def of(visit: Visit, points: Integers, size: float, level: int) -> _Cubes:
        """The cubes of one size that hold enough points."""
        cells = np.floor(visit.xyz[points] / size + _SHIFTS[level]).astype(np.int64)
        keys = (cells[:, 0] + _FAR) << 42 | (cells[:, 1] + _FAR) << 21 | (cells[:, 2] + _FAR)
        order = np.argsort(keys, kind="stable")
        keys = keys[order]
        firsts = np.flatnonzero(np.diff(keys, prepend=keys[:1] - 1))
        counts = np.diff(np.append(firsts, keys.size))
        enough = counts >= _FEWEST
        kept = np.repeat(enough, counts)
        starts = np.cumsum(np.append(0, counts[enough]))[:-1]
        cubes = _Cubes(visit, points[order[kept]], starts)
        if not starts.size:
            return cubes
        cubes.key = keys[firsts[enough]]
        cubes.size = size
        low = (cells[order[firsts[enough]]] - _SHIFTS[level]) * size
        cubes.low = np.asarray(low, np.float64)
        cubes._fit(np.ones(cubes.points.size))
        return cubes

    def fit_again(self) -> None:
        """Planes without the points that are far off them."""
        if not self.starts.size:
            return
        about = self.xyz - np.repeat(self.middle, self.counts, axis=0)
        off = np.abs((about * np.repeat(self.normal, self.counts, axis=0)).sum(axis=1))
        limit = _OUTLIERS * np.sqrt(np.maximum(self.spread[:, 0], 1e-8))
        self._fit((off <= np.repeat(limit, self.counts)).astype(np.float64))

    def _fit(self, weights: Floats) -> None:
        """Planes through points that count by weights of 0 or 1."""
        base = np.repeat(self.low, self.counts, axis=0)
        about = self.xyz - base
        total = np.maximum(np.add.reduceat(weights, self.starts), 1.0)
        mean = np.add.reduceat(about * weights[:, None], self.starts) / total[:, None]
        about -= np.repeat(mean, self.counts, axis=0)
        spread = np.empty((self.starts.size, 3, 3))
        for row in range(3):
            for column in range(row, 3):
                products = about[:, row] * about[:, column] * weights
                spread[:, row, column] = np.add.reduceat(products, self.starts) / total
                spread[:, column, row] = spread[:, row, column]
        values, vectors = np.linalg.eigh(spread)
        self.middle, self.normal, self.spread = mean + self.low, vectors[:, :, 0], values
        self.along = np.sqrt(np.maximum(np.einsum("kii->ki", spread), 0.0))
        self.used = total.astype(np.int64)
        self.mean_time = np.add.reduceat((self.time - self.time[0]) * weights, self.starts) / total
        self.mean_time += self.time[0]

    def patches(self, typical: float) -> tuple[Patches, Flags, float]:
        """Those that are flat, wide and not cut off by a face of the cube.

        Parameters
        ----------
        typical : float
            Scatter of the flattest fifth of larger cubes, m: what is left for smaller ones may
            hold nothing flat.

        Returns
        -------
        Patches, which of the cubes they are, and the scatter of the flattest fifth so far
        """
        if not self.starts.size:
            none = np.empty(0)
            whole = np.empty(0, np.int64)
            empty = np.empty((0, 3))
            return (
                Patches(whole, none, empty, empty, none, whole, none),
                np.empty(0, np.bool_),
                typical,
            )
        scatter = np.sqrt(np.maximum(self.spread[:, 0], 0.0))
        is_wide = np.sqrt(np.maximum(self.spread[:, 1], 0.0)) > _NARROWEST * self.size
        is_good = is_wide & (self.used >= _FEWEST) & (self.used > 0.8 * self.counts)
        if is_good.any():
            typical = min(typical, float(np.percentile(scatter[is_good], _FLATTEST)))
            is_good &= scatter <= _SCATTERS * typical
        is_good &= self._is_whole(scatter)
        kept = np.flatnonzero(is_good)
        size = np.full(kept.size, self.size)
        return (
            Patches(
                self.key[kept],
                size,
                self.middle[kept],
                self.normal[kept],
                scatter[kept],
                self.used[kept],
                self.mean_time[kept],
            ),
            is_good,
            typical,
        )

    def _is_whole(self, scatter: Floats) -> Flags:
        """Whether a patch ends before the faces of the cube that it faces."""
        rows = np.arange(self.starts.size)
        axis = np.abs(self.normal).argmax(axis=1)
        # Evenly spread points reach 1.73 standard deviations to both sides.
        reach = 1.75 * self.along[rows, axis] + 3.0 * scatter
        at = (self.middle - self.low)[rows, axis]
        return np.asarray((at - reach > 0) & (at + reach < self.size))

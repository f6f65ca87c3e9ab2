"""How densely a recording covers what it shows, and whether it is one scan from one place.

Measured on a piece of it. A single scan of a spinning head has decimetres between its points a few
metres from the scanner, so that a post is a handful of points and a façade some lines of them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.recording.drive import Drive

_PLACE_M = 0.4
"""Side of the cubes that points are counted in: as wide as a trunk."""

_LOOKED_AT = 500_000
"""Points from the middle of the recording that are looked at: a piece of street as it was
measured."""

_FEW = 3.0
"""Half of the cubes of 0.4 m with points have no more than these: fewer than tell a post from a
leaf. Nine of ten simulated single scans have no more; thin profiles 2 to 4, streets 9 to 48."""

_SPARSE = 6.0
"""Between thin profiles and streets: with no more points in half of the cubes, what is round and
what is flat can't be told."""

_SPARSE_AT_TRUNKS, _DENSEST = 18.0, 75.0
"""The same in three quarters of the cubes at the height of trunks, in per cent: real sparse
recordings have 3 to 11 there, streets 30 and more, also where noise of phase fills half of them
with a point or two."""

_SPARSE_ABOUT = 40.0
"""The same in the cubes that half of the points lie in: real sparse recordings mostly have 7 to 23,
122 simulated streets 65 and more. Noise that fills most cubes is a small part of the points, also
where little else stands as high as trunks."""

_TRUNKS = 2, 5
"""Cubes above the lowest one in the same place, between which trunks and posts are: 0.8 to 2.4 m.
Crowns, fronts and noise in the air fill most cubes of a dense street with a point or two."""

_GATHERED = 0.38
"""The radius that holds half of the points over that which holds 95 %, at most. Along a path
points lie evenly, which makes it 0.53; about one scanner their number falls with the squared
distance. 95 % of simulated single scans of many heads have no more, streets 0.49 and more."""

_KEPT = "cubes of the middle"

_ENOUGH = 1_000
"""Points, at least: a turn of the smallest head has ten times as many."""

_BITS = 21
_LAST_CUBE = (1 << _BITS) - 1
"""Along each axis: 800 km; what lies farther is counted with what lies there by chance."""


class _Cubes(NamedTuple):
    """The numbers of cubes that have points, those of one place in plan upwards, and how many."""

    codes: Integers
    counts: Integers


def is_single_scan(drive: Drive) -> bool:
    """Whether most places have a few points only, and these gather about one scanner.

    A handful of points is none: of it nothing is known.
    """
    if _in_half_of(_middle_cubes(drive)) > _FEW:
        return False
    xyz = middle_points(drive)
    return len(xyz) >= _ENOUGH and spread_of(xyz) <= _GATHERED


def are_sparse(drives: Sequence[Drive]) -> bool:
    """Whether trunks and posts of each drive have too few points for their shape.

    Few are where anything is, at the height of trunks, and where most points are: large crowns and
    noise in the air make the first low on a dense street, low leaves the second. Not of drives
    without points.
    """
    return bool(drives) and all(
        _in_half_of(cubes) <= _SPARSE
        and _at_trunks_of(cubes) <= _SPARSE_AT_TRUNKS
        and _about_a_point_of(cubes) <= _SPARSE_ABOUT
        for cubes in map(_middle_cubes, drives)
    )


def _middle_cubes(drive: Drive) -> _Cubes:
    return drive.kept(_KEPT, lambda: _cubes_of(middle_points(drive)))


def middle_points(drive: Drive) -> Floats:
    """(n, 3) float64 the finite points from the middle of a drive, m, project CRS; 500,000 at most.

    They follow each other as they were measured.
    """
    first = max(0, (drive.count - _LOOKED_AT) // 2)
    xyz = drive.xyz(slice(first, min(drive.count, first + _LOOKED_AT)))
    if np.isfinite(xyz.sum()):
        return xyz
    finite: Floats = xyz[np.isfinite(xyz).all(axis=1)]
    return finite


def points_a_place(xyz: Floats) -> float:
    """Median number of points in the cubes of 0.4 m that have any; infinite without points.

    Parameters
    ----------
    xyz : (n, 3) float64
        m; finite.
    """
    return _in_half_of(_cubes_of(xyz))


def points_about_a_point(xyz: Floats) -> float:
    """How many points lie in the fullest of the emptiest cubes that hold half of the points.

    Parameters
    ----------
    xyz : (n, 3) float64
        m; finite. Infinite without points.
    """
    return _about_a_point_of(_cubes_of(xyz))


def points_at_trunks(xyz: Floats) -> float:
    """How many points three quarters of the cubes 0.8 to 2.4 m above the lowest one have at most.

    Of all cubes where nothing stands so high; infinite without points.

    Parameters
    ----------
    xyz : (n, 3) float64
        m; finite.
    """
    return _at_trunks_of(_cubes_of(xyz))


def _in_half_of(cubes: _Cubes) -> float:
    return float(np.median(cubes.counts)) if len(cubes.counts) else math.inf


def _about_a_point_of(cubes: _Cubes) -> float:
    if not len(cubes.counts):
        return math.inf
    counts = np.sort(cubes.counts)
    reached = np.cumsum(counts)
    return float(counts[np.searchsorted(reached, reached[-1] / 2)])


def _at_trunks_of(cubes: _Cubes) -> float:
    codes, counts = cubes
    if not len(counts):
        return math.inf
    first = np.flatnonzero(np.diff(codes >> _BITS, prepend=-1))
    lowest = np.repeat(codes[first], np.diff(first, append=len(codes)))
    above = codes - lowest
    at_trunks = counts[(above >= _TRUNKS[0]) & (above <= _TRUNKS[1])]
    return float(np.percentile(at_trunks if at_trunks.size else counts, _DENSEST))


def _cubes_of(xyz: Floats) -> _Cubes:
    if not len(xyz):
        return _Cubes(np.empty(0, np.int64), np.empty(0, np.int64))
    codes, counts = np.empty((2, len(xyz)), np.int64)
    runs = runs_kernel(xyz, xyz.min(axis=0), codes, counts)
    order = np.argsort(codes[:runs], kind="stable")
    codes = codes[order]
    first = np.flatnonzero(np.diff(codes, prepend=-1))
    return _Cubes(codes[first], np.add.reduceat(counts[order], first))


@kernel
def runs_kernel(xyz: Floats, low: Floats, codes: Integers, counts: Integers) -> int:
    """Write the cubes of points that follow each other and how many there are of each.

    Of a scan line many points lie in one cube, so that few of them are left to be sorted.

    Returns
    -------
    int
        How many were written.
    """
    runs = 0
    for point in range(len(xyz)):
        code = 0
        for axis in range(3):
            cube = int((xyz[point, axis] - low[axis]) / _PLACE_M) & _LAST_CUBE
            code = (code << _BITS) | cube
        if runs == 0 or codes[runs - 1] != code:
            codes[runs], counts[runs] = code, 0
            runs += 1
        counts[runs - 1] += 1
    return runs


def spread_of(xyz: Floats) -> float:
    """The radius about the middle that holds half of the points, over that which holds 95 %.

    1 where all points are in one place in plan, or there are none.

    Parameters
    ----------
    xyz : (n, 3) float64
        m; finite.
    """
    if not len(xyz):
        return 1.0
    away = np.hypot(*(xyz[:, :2] - np.median(xyz[:, :2], axis=0)).T)
    half, most = np.percentile(away, (50.0, 95.0)).tolist()
    return half / most if most > 0 else 1.0

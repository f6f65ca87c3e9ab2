"""Single scans of spinning heads on a street, too sparse for cells of 10 cm.

Their points lie decimetres apart a few metres from the scanner, so that a post is a handful of
points and a façade some lines of them. They are described by wider cells and asked of models that
learnt from such scans; the ground is found as in clouds from the air.
"""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats
from processing.methods.noise.neighbours.morton import nested_cells
from processing.recording.drive import Drive

SCAN_CELL_M = 0.2
"""Side of the finest cells: two rows of a spinning head at 10 m are as far apart or farther."""

_SIDE_M, _FEW = 0.4, 3.0
"""Half of the cubes of 0.4 m with points have no more than these: fewer than tell a post from a
leaf. Nine of ten simulated single scans have no more; thin profiles 2 to 4, streets 9 to 48."""

_GATHERED = 0.38
"""The radius that holds half of the points over that which holds 95 %, at most. Along a path
points lie evenly, which makes it 0.53; about one scanner their number falls with the squared
distance. 95 % of simulated single scans of many heads have no more, streets 0.49 and more."""

_ENOUGH = 1_000
"""Points, at least: a turn of the smallest head has ten times as many."""

_LOOKED_AT = 500_000
"""Points from the middle of the recording that are looked at: a piece of street as it was
measured."""


def is_single_scan(drive: Drive) -> bool:
    """Whether most places have a few points only, and these gather about one scanner.

    A handful of points is none: of it nothing is known.
    """
    first = max(0, (drive.count - _LOOKED_AT) // 2)
    xyz = drive.xyz(slice(first, min(drive.count, first + _LOOKED_AT)))
    xyz = xyz[np.isfinite(xyz).all(axis=1)]
    if len(xyz) < _ENOUGH:
        return False
    return points_a_place(xyz) <= _FEW and spread_of(xyz) <= _GATHERED


def points_a_place(xyz: Floats) -> float:
    """Median number of points in the cubes of 0.4 m that have any; infinite without points.

    Parameters
    ----------
    xyz : (n, 3) float64
        m; finite.
    """
    if not len(xyz):
        return float("inf")
    cells = nested_cells(xyz - xyz.min(axis=0), _SIDE_M)
    return float(np.median(np.unique(cells.codes, return_counts=True)[1]))


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

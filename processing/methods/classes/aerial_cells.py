"""Cells of clouds from the air: what is a cloud from the air, and what its points look like.

Streets are looked at in cells of 10 cm. From the air a point has neighbours in decimetres or
metres: its cells are as wide as its points lie apart, and the ground that
:mod:`processing.methods.ground` finds takes the place of what a vehicle sees of the road. How
bright things are isn't asked: roofs, leaves and grass look otherwise on every flight, and what was
learnt of them on simulated ones made both clouds worse that models for the air were scored on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor
from processing.methods.classes.features import ClassCells, class_cells
from processing.recording.drive import Drive

AERIAL_COLUMNS = 4
"""Columns besides those of a street's cells: how much of a cell is ground, how many of its returns
were their pulse's last, and its only one; how wide it is."""

_SPARSE_M = 0.15
"""Points that lie farther apart, seen from above, are one to a cell of a street's model. Half of
the points of single scans of a spinning head lie within 0.13 m, of profiles within 0.12 m."""

_SAMPLE, _ENOUGH = 200_000, 20
_FIRST_TILE_M, _TILES = 4.0, 9
"""How far apart points lie is told from so many of them, in the smallest squares, from 4 m to 1 km,
in which half of them have so many others."""


_MOST_UNEVEN = 2.0
"""Points are this many times as dense where half of them lie as in half of the place. From above a
place is measured evenly (1.0 to 1.4 in flights of several makers); from the ground much more nearby
than far off (2.8 to 84 in streets, profiles, single scans and sites)."""


@dataclass(frozen=True)
class Density:
    """How close the points of a place lie, seen from above.

    Attributes
    ----------
    spacing_m : float
        Half of the points lie closer, m; 0 where they are too few to tell.
    unevenness : float
        How many times as dense the points are where half of them lie as in half of the place.
    """

    spacing_m: float = 0.0
    unevenness: float = 1.0


def spacing_m(drives: Sequence[Drive]) -> float:
    """How far apart the points of drives lie, seen from above: half of them lie closer, m.

    0 where they are too few to tell.
    """
    return density_of(drives).spacing_m


def density_of(drives: Sequence[Drive]) -> Density:
    """How close the points of drives lie, seen from above."""
    step = max(1, sum(drive.count for drive in drives) // _SAMPLE)
    parts = [drive.xyz(np.arange(0, drive.count, step))[:, :2] for drive in drives]
    xy = np.concatenate(parts)
    xy = xy[np.isfinite(xy).all(axis=1)]
    if not len(xy):
        return Density()
    for doublings in range(_TILES):
        side = _FIRST_TILE_M * 2**doublings
        _, tile_of, counts = np.unique(
            np.floor((xy - xy.min(axis=0)) / side), axis=0, return_inverse=True, return_counts=True
        )
        near = float(np.median(counts[tile_of.ravel()]))
        if near >= _ENOUGH:
            return Density(side / float(np.sqrt(near * step)), near / float(np.median(counts)))
    return Density()


def is_from_air(drive: Drive) -> bool:
    """Whether a drive is too thin for a street's cells, and as thin everywhere.

    That no turns of a scanner were found isn't asked: strips of a flight have rows, too. A single
    scan of a spinning head may be as thin in the middle of its points, but it is dense about the
    head.
    """
    if not drive.count:
        return False
    density = density_of([drive])
    return density.spacing_m > _SPARSE_M and density.unevenness < _MOST_UNEVEN


@dataclass(frozen=True)
class AerialPoints:
    """Points of a cloud from the air with what their features need.

    Attributes
    ----------
    local : (n, 3) float64
        m about an origin near by.
    heights : (n,) float64
        m above the ground; 0 where none is known.
    is_ground : (n,) bool
    is_last, is_only : (n,) bool
        Whether a return is its pulse's last, and its only one; both where nothing is known.
    """

    local: Floats
    heights: Floats
    is_ground: NDArray[np.bool_]
    is_last: NDArray[np.bool_]
    is_only: NDArray[np.bool_]


def last_and_only(drive: Drive, points: Integers) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which of a drive's points are their pulse's last, and its only return, (n,) each."""
    columns = drive.columns
    if not (columns.has("return_number") and columns.has("number_of_returns")):
        return np.ones(points.size, np.bool_), np.ones(points.size, np.bool_)
    returns = np.asarray(columns["number_of_returns"][points])
    return np.asarray(columns["return_number"][points]) >= returns, returns <= 1


def aerial_cells(points: AerialPoints, cell_m: float, monitor: Monitor) -> ClassCells:
    """Cells of points from the air: a street's features, and :data:`AERIAL_COLUMNS` more."""
    dark = np.zeros(len(points.local), np.float32)
    cells = class_cells(points.local, points.heights, dark, monitor, cell_m)
    count = np.maximum(1, np.bincount(cells.cell_of, minlength=len(cells.rows)))
    shares = [
        np.bincount(cells.cell_of, weights=one, minlength=len(cells.rows)) / count
        for one in (points.is_ground, points.is_last, points.is_only)
    ]
    wide = np.full(len(cells.rows), np.log2(cell_m))
    more = np.column_stack([*shares, wide]).astype(np.float32)
    return replace(cells, rows=np.hstack([cells.rows, more]))

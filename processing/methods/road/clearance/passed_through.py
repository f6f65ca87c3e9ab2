"""Bodies that are none: where the vehicle itself drove, and arcs of one range about it.

Dust and spray stay in the air where the vehicle passes a moment before or after. Scanners that
measure by phase draw arcs of one range about themselves.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.methods.road.clearance.points_over_road import PointsOverRoad
from processing.methods.road.surface.road_cells import RoadCells
from processing.methods.road.surface.road_frame import RoadFrame

_HALF_WIDTH_M, _ROOF_M = 0.7, 2.0
"""Of the vehicle and of the scanners on its roof: cars are 1.4 m wide and more, and scanners are
mounted higher than this."""

_DRIVEN_SHARE = 0.1
"""Of a body's points those where the vehicle drove, from which on it can't be a thing."""

_FEWEST, _MOST = 20, 4000
_CENTRE_M, _LOW_M = 1.0, 1.0
"""How near to the vehicle's way an arc is centred, and how high over the road at least."""

_FARTHEST_M = 8.0
_LEAST_BEND = 3.0
"""How far the middle of an arc stands off its chord, over how far points lie off the arc."""

_OFF_M = 0.06


def is_passed_through(
    lines: Integers, found: PointsOverRoad, road: RoadCells, frames: Sequence[RoadFrame]
) -> bool:
    """Whether points of a body lie where the vehicle drove, or on an arc about it.

    Parameters
    ----------
    lines : (n,) int64
        Of the points over the road.
    frames : sequence of RoadFrame
        The ways that were driven; of others nothing is told.
    """
    offset = _offsets(lines, found, road, frames)
    over = found.over[lines]
    driven = (np.abs(offset) <= _HALF_WIDTH_M) & (over <= _ROOF_M)
    return bool(driven.mean() >= _DRIVEN_SHARE) or is_arc(offset, over)


def is_arc(offset: Floats, over: Floats) -> bool:
    """Whether places of a cross section lie on a circle about the scanner.

    Parameters
    ----------
    offset, over : (n,) float64
        From the way that was driven, and over the road, m.

    Notes
    -----
    The circle is that of least squares of its equation (Kåsa 1976); what is flat has none, or one
    whose bend is no larger than the noise.
    """
    # Of places beside no way nothing is told; least squares would never end.
    known = np.isfinite(offset) & np.isfinite(over)
    offset, over = offset[known], over[known]
    if offset.size < _FEWEST:
        return False
    step = max(1, offset.size // _MOST)
    x, z = offset[::step], over[::step]
    design = np.column_stack([2 * x, 2 * z, np.ones_like(x)])
    try:
        east, up, rest = np.linalg.lstsq(design, x**2 + z**2, rcond=None)[0].tolist()
    except np.linalg.LinAlgError:
        return False
    square = rest + east**2 + up**2
    if square <= 0:
        return False
    radius = math.sqrt(square)
    off = float(np.median(np.abs(np.hypot(x - east, z - up) - radius)))
    if abs(east) > _CENTRE_M or up < _LOW_M or radius > _FARTHEST_M or off > _OFF_M:
        return False
    chord = min(float(np.hypot(np.ptp(x), np.ptp(z))) / 2, radius)
    bend = radius - math.sqrt(radius**2 - chord**2)
    return bend >= _LEAST_BEND * max(off, 1e-3)


def _offsets(
    lines: Integers, found: PointsOverRoad, road: RoadCells, frames: Sequence[RoadFrame]
) -> Floats:
    """Of each point from the way that told its cell, m; infinite beside none."""
    offset = np.full(lines.size, np.inf)
    cells = found.cells[lines]
    for number, frame in enumerate(frames):
        mine = np.flatnonzero(road.frame[cells] == number)
        if mine.size:
            nearest = np.rint(road.station[cells[mine]] - frame.start_m).astype(np.int64)
            nearest = np.clip(nearest, 0, len(frame.nodes) - 1)
            places = found.local[lines[mine], :2]
            offset[mine] = frame.located(places, nearest)[1]
    return offset

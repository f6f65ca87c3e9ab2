"""Which sides of a shaft were seen: round bodies show the half that faces the scanner.

What a circle was fitted to may be the corner of a house, a square post, or two edges of a wall, of
which one turns its back. Noise and distance change neither measure.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.methods.road.objects.square_sections import square_share
from processing.methods.road.poles.shafts import Shaft
from processing.recording.drive import Drive

_BEHIND = 0.2
"""Sine of the angle beyond its rim at which a point is on the side turned away: the head stands a
metre beside the place of the vehicle that is known, and points are off by their noise."""


@dataclass(frozen=True)
class SeenSides:
    """How the points of a shaft lie about its axis.

    Attributes
    ----------
    square : float
        How far its section goes in and out four times about the axis, over what a square does, 0
        to 1.
    behind : float
        Share of its points on the side that is turned away from the vehicle; 0 where its way is
        not known.
    """

    square: float
    behind: float


def seen_sides(drives: Sequence[Drive], shaft: Shaft, origin: Floats) -> SeenSides:
    """How the points of a shaft lie about its axis.

    Parameters
    ----------
    origin : (3,) float64
        Of the plan, m, project CRS.
    """
    up = shaft.local[:, 2]
    beside = shaft.local[:, :2] - up[:, None] * shaft.lean
    radii = shaft.radius_m - shaft.taper * up
    return SeenSides(
        square_share(beside, radii), _behind(towards_vehicle(drives, shaft, origin), beside)
    )


def _behind(towards: Floats, beside: Floats) -> float:
    """Share of the points that the shaft itself would have hidden."""
    is_known = np.isfinite(towards[:, 0])
    if not is_known.any():
        return 0.0
    side = (beside * towards)[is_known].sum(axis=1)
    lengths = np.linalg.norm(towards[is_known], axis=1) * np.linalg.norm(beside[is_known], axis=1)
    return float((side < -_BEHIND * lengths).mean())


def towards_vehicle(drives: Sequence[Drive], shaft: Shaft, origin: Floats) -> Floats:
    """The way from a shaft's axis to where the vehicle was when each point was measured.

    Parameters
    ----------
    origin : (3,) float64
        Of the plan, m, project CRS.

    Returns
    -------
    (n, 2) float64
        In plan, m; NaN where its way is not known.
    """
    towards = np.full((shaft.points.size, 2), np.nan)
    axis = shaft.foot[:2] + origin[:2] + shaft.lean * shaft.local[:, 2:]
    for number in np.unique(shaft.drives).tolist():
        trajectory = drives[number].trajectory
        if trajectory is None:
            continue
        mine = np.flatnonzero(shaft.drives == number)
        times = np.asarray(drives[number].columns["time"][shaft.points[mine]])
        is_known = trajectory.covers(times)
        mine = mine[is_known]
        towards[mine] = trajectory.positions_at(times[is_known])[:, :2] - axis[mine]
    return towards

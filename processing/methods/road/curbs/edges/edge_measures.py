"""What is measured at the stations of a curb's line: columns of tables, and their spacing."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]

STEP_M = 0.25
"""Between stations: half of what Table 6-1 looks at to either side, so that neighbours share points
and ramps of 70 cm have three."""

LOWER_ACROSS, LOWER_ABOVE, UPPER_ACROSS, UPPER_ABOVE = range(4)
LEAN, ERROR_ACROSS, ERROR_LOW, ERROR_HIGH = range(4, 8)
FACE_POINTS, LOW_POINTS, HIGH_POINTS, GAP, OFF, LOW_OFF, HIGH_OFF, AWAY = range(8, 16)
MEASURES = 16
"""Measures of a station: edges in its frame, m; lean of the face (across per m of height); errors
of place and of the two heights, m; how many points each surface has; how wide nothing is seen
between them, m; how far points of face, carriageway and top lie off them, m RMS; how far ahead of
the station the middle of the face's points is, m. NaN where not measured."""

WIDTH, IS_HIDDEN, STEP, IS_EDGING = range(4)
"""What is known roughly of a station: width of the face, m; how the face is seen (see below);
height of the step, m; 1 where it is of an edging stone."""

VISIBLE, HIDDEN, ASKEW = 0.0, 1.0, 2.0
"""How a face is seen: from its front, not at all, or along it, so that points on it, or on the
ground before it, may be missing."""


class Window(NamedTuple):
    """Points that are looked at about a station.

    Attributes
    ----------
    half_m, most_m : float
        Half the window, and half the longest one, which is used where the other holds too few.
    enough : float
        Points that are enough in one.
    tolerance_m : float
        How far a point may lie off a surface.
    """

    half_m: float
    most_m: float
    enough: float
    tolerance_m: float


@kernel
def span_about(along: _Floats, station: int, reach_m: float) -> tuple[int, int]:
    """The first of some points, rising in stations, up to a distance before, and past the last."""
    near = int(np.searchsorted(along, station - reach_m / STEP_M))
    return near, int(np.searchsorted(along, station + reach_m / STEP_M))


@kernel
def is_surer(one: _Floats, other: _Floats) -> bool:
    """Whether the measures of one place across are better known than another's, or the only."""
    return bool(one[ERROR_ACROSS] < other[ERROR_ACROSS]) or (
        not math.isnan(one[ERROR_ACROSS]) and math.isnan(other[ERROR_ACROSS])
    )

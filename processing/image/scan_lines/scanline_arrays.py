"""The arrays that the loops over pixels share: two rows, crossings of the mesh, what counts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


PIXEL = np.dtype(
    [
        ("east", np.float64),
        ("north", np.float64),
        ("up", np.float64),
        ("station", np.float64),
        ("across", np.float64),
        ("time", np.float64),
        ("intensity", np.float64),
        ("point", np.int64),
        ("level", np.int64),
        ("crossing", np.int64),
        ("is_short", np.bool_),
    ],
    align=True,
)
"""A pixel of one of the two rows next to each other, (2, w) by row (old, new) and column.

``point`` is its point in the drive, −1 where nothing came back or nothing that counts; the place is
about the origin of the pass, m; ``level`` is how many spacings the station is, rounded down, within
the sections that are asked for; ``crossing`` is the first one on the edge to the next column, −1
where there is none as yet; ``is_short`` tells whether that edge may belong to a triangle.
"""

CROSSING = np.dtype(
    [
        ("across", np.float64),
        ("height", np.float64),
        ("time", np.float64),
        ("point", np.int64),
        ("intensity", np.float32),
        ("level", np.int32),
        ("first", np.int32),
        ("second", np.int32),
    ]
)
"""Where a section crosses an edge of the mesh, (n,) in the order in which they were found.

``level`` is which section; ``first`` and ``second`` are the crossings on either side along it, −1
where the mesh ends; the height is about the origin.
"""

Pixels = NDArray[Any]
Crossings = NDArray[Any]


class MeshLimits(NamedTuple):
    """What counts.

    Attributes
    ----------
    reach_m, half_width_m : float
        How far from the vehicle along the vehicle's path, and from the vehicle's path across.
    lowest_m, highest_m : float
        Heights about the vehicle's path.
    spacing_m : float
        Of the sections.
    first, last : int
        The sections that are asked for, by multiples of the spacing.
    longest_m : float
        No longer edge belongs to the mesh.
    """

    reach_m: float
    half_width_m: float
    lowest_m: float
    highest_m: float
    spacing_m: float
    first: int
    last: int
    longest_m: float


PointArrays = tuple[Integers, Floats, Floats, Floats, NDArray[np.uint16], NDArray[np.bool_]]

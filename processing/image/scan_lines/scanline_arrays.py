"""The arrays that the loops over pixels share: two rows, crossings of the mesh, what counts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers

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


class PointArrays(NamedTuple):
    """The points of some rows, each in one place of every array.

    Attributes
    ----------
    pulse : (n,) int64
    position : (n, 3) float64
        About the origin of the pass, m.
    on_path : (n, 3) float64
        Station, across (right is positive) and height above the vehicle's path, m.
    time : (n,) float64
        s on the trajectory's clock.
    intensity : (n,) uint16
    is_noise : (n,) bool
    """

    pulse: Integers
    position: Floats
    on_path: Floats
    time: Floats
    intensity: NDArray[np.uint16]
    is_noise: NDArray[np.bool_]


class RowPair(NamedTuple):
    """Two rows next to each other: pixels (2, w); first filled column and end of each, (2, 2)."""

    pixels: Pixels
    extents: Integers


class MeshRows(NamedTuple):
    """Rows that are meshed.

    Attributes
    ----------
    ends : (k, 5) int64
        First and end point, the number in the drive of point 0, the pulse of column 0, and
        whether the mesh breaks before the row.
    stations : (k + 1,) float64
        Of the vehicle at each row, m, after that of the row before the first.
    """

    ends: Integers
    stations: Floats


class MeshRule(NamedTuple):
    """What may be joined in the strip between two rows.

    Attributes
    ----------
    spacing_m : float
        Of the sections.
    longest_square : float
        The longest edge squared, m².
    most_levels : int
        The most sections that an edge may cross.
    """

    spacing_m: float
    longest_square: float
    most_levels: int


class CellSides(NamedTuple):
    """Whether the edges between the rows on a cell's left and right are short."""

    left: bool
    right: bool


class MeshEdge(NamedTuple):
    """Row and column of the pixels at both ends of an edge."""

    row: int
    column: int
    to_row: int
    to_column: int


class MeshCell(NamedTuple):
    """A cell between two rows.

    Attributes
    ----------
    old : int
        Which row is the older one.
    column : int
        Its left column.
    is_rising : bool
        It is cut from its old left pixel to its new right one.
    has_lower, has_upper : bool
        Whether the triangles with its old and its new edge are there.
    """

    old: int
    column: int
    is_rising: bool
    has_lower: bool
    has_upper: bool


class CellLevels(NamedTuple):
    """The levels of a cell's pixels."""

    old_left: int
    old_right: int
    new_left: int
    new_right: int


class CellBases(NamedTuple):
    """The first crossing on each of a cell's edges, −1 where there is none."""

    old: int
    new: int
    left: int
    right: int


class TriangleLevels(NamedTuple):
    """The levels of a triangle's corners."""

    first: int
    second: int
    third: int


class TriangleBases(NamedTuple):
    """The first crossing on a triangle's edges: first to second corner, and so on round."""

    first_second: int
    second_third: int
    third_first: int


class ChainArrays(NamedTuple):
    """What is copied of crossings chain by chain, each (n,); see `SectionVertices`."""

    level: Integers
    across: Floats
    height: Floats
    time: Floats
    intensity: NDArray[np.float32]
    point: Integers
    is_break: NDArray[np.bool_]

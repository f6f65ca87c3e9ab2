"""Points within a cut, found by the tiles' bounds and the rows below them; no other index."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.image.images_of_drives import image_of
from processing.image.tiles.tile_kernels import COUNT, HIGHEST, LOWEST
from processing.image.tiles.tiles import TileKey
from processing.recording.columns.counted_classes import seen_points
from processing.section.cut import Cut

if TYPE_CHECKING:  # processing.recording.drive makes images, so importing it here would be a circle
    from processing.recording.drive import Drive


MOST_POINTS = 300_000
"""More points than this make a section no clearer: most then lie behind others on a screen."""

_MIDDLE_HALF_M = 1.0
"""To either side of a cut's middle within which the ground there is looked for."""


class _CutPlan(NamedTuple):
    """A cut about a drive's offset: its middle, direction (a unit vector) and half sides, m."""

    east: float
    north: float
    along_east: float
    along_north: float
    half_length_m: float
    half_width_m: float


@dataclass(frozen=True)
class SectionPoints:
    """Points of one drive as a section sees them.

    Attributes
    ----------
    drive_id : str
    points : (n,) int64
        Indices in the drive, by rising offset.
    section : (n, 3) float64
        Offset, height, distance from the plane, m (:meth:`Cut.to_section`).
    """

    drive_id: str
    points: Integers
    section: Floats


def points_in_cut(
    drive: Drive, cut: Cut, most: int = MOST_POINTS, *, hides_noise: bool = False
) -> Integers:
    """The measured points within a cut, at any height.

    Parameters
    ----------
    most : int
        Of more points than this every so many are given, in the order of their measurement.
    hides_noise : bool
        Without the points whose class is noise.

    Returns
    -------
    (n,) int64
        Indices in the drive, rising.
    """
    if drive.count == 0:
        return np.empty(0, np.int64)
    image = image_of(drive, drive.image_kinds[-1])
    stretches = image.stretches_in(_tiles_touched(drive, cut))
    found = np.empty(int((stretches[:, 1] - stretches[:, 0]).sum()), np.int64)
    part = drive.coordinates.stretched(stretches)
    count = _inside_kernel(
        part.integers,
        np.array(drive.coordinates.quantisation.scale[:2]),
        part.stretches,
        _plan_of(drive, cut),
        found,
    )
    points = np.sort(part.points(found[:count]))
    inside = seen_points(drive.columns, points, hides_noise=hides_noise)
    count = inside.size
    return inside if count <= most else inside[np.arange(most) * count // most]


def section_points(
    drive: Drive, cut: Cut, most: int = MOST_POINTS, *, hides_noise: bool = False
) -> SectionPoints:
    """The points within a cut with their positions in it, sorted by offset."""
    points = points_in_cut(drive, cut, most, hides_noise=hides_noise)
    section = cut.to_section(drive.xyz(points))
    order = np.argsort(section[:, 0], kind="stable")
    return SectionPoints(drive.id, points[order], section[order])


def ground_near(drive: Drive, cut: Cut) -> int:
    """The measured point of the ground nearest to a cut's middle in plan; −1 where none is.

    Looked for within a metre to either side, below the middle: as a trajectory runs above the
    road. The ground is the median height there, and no noise.
    """
    near = section_points(drive, replace(cut, half_length_m=_MIDDLE_HALF_M), hides_noise=True)
    below = near.section[:, 1] <= cut.middle[2]
    if not below.any():
        return -1
    section, points = near.section[below], near.points[below]
    ground_m = float(np.median(section[:, 1]))
    from_middle = section - np.array([0.0, ground_m, 0.0])
    return int(points[(from_middle**2).sum(axis=1).argmin()])


def _tiles_touched(drive: Drive, cut: Cut) -> Integers:
    """(k, 4): first and end row, first and end column of the finest tiles that a cut touches."""
    pyramid = image_of(drive, drive.image_kinds[-1]).pyramid
    rows, columns = pyramid.shape(0)
    table = pyramid.table[: rows * columns]
    filled = np.flatnonzero(table[:, COUNT] > 0)
    low, high = table[filled, LOWEST][:, :2], table[filled, HIGHEST][:, :2]
    corners = cut.outline
    touches = (low <= corners.max(axis=0)).all(axis=1) & (high >= corners.min(axis=0)).all(axis=1)
    middles, halves = (low + high) / 2 - np.array(cut.middle[:2]), (high - low) / 2
    sizes = ((cut.direction, cut.half_length_m), (cut.normal, cut.width_m / 2))
    for axis, half in sizes:
        touches &= np.abs(middles @ np.array(axis)) <= halves @ np.abs(axis) + half
    touched = filled[touches]
    windows = np.empty((touched.size, 4), np.int64)
    for line, number in enumerate(touched.tolist()):
        tile = TileKey(0, *divmod(number, columns))
        of_rows, of_columns = pyramid.rows_columns(tile)
        windows[line] = of_rows.start, of_rows.stop, of_columns.start, of_columns.stop
    return windows


def _plan_of(drive: Drive, cut: Cut) -> _CutPlan:
    """The cut about the drive's offset."""
    offset = drive.coordinates.quantisation.offset
    east, north = cut.middle[0] - offset[0], cut.middle[1] - offset[1]
    along_east, along_north = cut.direction
    return _CutPlan(
        float(east),
        float(north),
        float(along_east),
        float(along_north),
        float(cut.half_length_m),
        cut.width_m / 2,
    )


@kernel
def _inside_kernel(
    integers: NDArray[np.int32],
    scale: Floats,
    stretches: Integers,
    plan: _CutPlan,
    found: Integers,
) -> int:
    """Points of stretches within a cut; gives their number."""
    count = 0
    for k in range(stretches.shape[0]):
        for i in range(stretches[k, 0], stretches[k, 1]):
            east = integers[i, 0] * scale[0] - plan.east
            north = integers[i, 1] * scale[1] - plan.north
            aside = north * plan.along_east - east * plan.along_north
            if abs(aside) > plan.half_width_m:
                continue
            if abs(east * plan.along_east + north * plan.along_north) <= plan.half_length_m:
                found[count] = i
                count += 1
    return count


def warm_up() -> None:
    """Compile the kernel for mapped columns, which are read-only."""
    xyz = np.zeros((1, 3), np.int32)
    xyz.flags.writeable = False
    plan = _CutPlan(0.0, 0.0, 1.0, 0.0, 1.0, 1.0)
    _inside_kernel(xyz, np.ones(2), np.array([[0, 1]]), plan, np.empty(1, np.int64))

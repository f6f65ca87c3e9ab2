"""Which points a stroke means: those about a brush, those of connected segments."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.errors import Unsuitable
from processing.core.kernels import kernel
from processing.core.text import Text
from processing.image.images_of_drives import image_of
from processing.image.point_image import PointCloudImage
from processing.recording.drive import Drive
from processing.section.cut import Cut
from processing.section.points_in_cut import points_in_cut

SEGMENT = "segment"
_POINTS_AT_ONCE = 4_000_000
_FIRST_ROOM = 1 << 14


class StrokePath(NamedTuple):
    """Both ends of a brush's straight path, (2, 3) in the integers' own units; its radius, m."""

    ends: Floats
    radius_m: float


def points_under_brush(drive: Drive, start: Floats, end: Floats, radius_m: float) -> Integers:
    """All measured points as near as a radius to the straight path of a brush.

    Parameters
    ----------
    start, end : (3,) float64
        m, project CRS; the same for a click.
    radius_m : float
        In space: on a wall as on the road.

    Returns
    -------
    (n,) int64
        Rising.

    Notes
    -----
    1. The tiles whose bounds come near the path are looked up in the image's pyramid.
    2. The rows of those tiles are runs of points; each point in them is measured.
    """
    if drive.count == 0:
        return np.empty(0, np.int64)
    image = _ready_image(drive)
    stretches = _stretches_near(image, np.stack([start, end]), radius_m)
    quantisation, part = drive.coordinates.quantisation, drive.coordinates.stretched(stretches)
    scale = np.array(quantisation.scale)
    # In the integers' own units, so that no coordinate is computed for a point far off.
    ends = quantisation.in_units(np.stack([start, end]))
    stroke = StrokePath(ends, radius_m)
    room = np.empty(_FIRST_ROOM, np.int64)
    count = _near_stroke_kernel(part.integers, scale, part.stretches, stroke, room)
    if count > room.size:
        room = np.empty(count, np.int64)
        _near_stroke_kernel(part.integers, scale, part.stretches, stroke, room)
    return part.points(room[:count])


def points_in_slab(drive: Drive, cut: Cut, ends: Floats, radius_m: float) -> Integers:
    """All measured points of a section's slab as near in its picture to the path of a brush.

    Parameters
    ----------
    cut : Cut
        Points outside its slab are not painted, however near they are.
    ends : (2, 2) float64
        Offset and height of both ends, m; the same for a click.
    radius_m : float

    Returns
    -------
    (n,) int64
        Rising.
    """
    offsets = ends[:, 0]
    east, north, _ = cut.to_space([[offsets.mean(), 0.0, 0.0]])[0].tolist()
    half_m = float(np.ptp(offsets)) / 2 + radius_m
    around = replace(cut, middle=(east, north, cut.middle[2]), half_length_m=half_m)
    points = points_in_cut(drive, around, drive.count)
    positions = cut.to_section(drive.xyz(points))[:, :2]
    along = ends[1] - ends[0]
    length = float(along @ along)
    share = (
        np.clip((positions - ends[0]) @ along / length, 0.0, 1.0)
        if length
        else np.zeros(len(positions))
    )
    away = positions - ends[0] - share[:, None] * along
    is_near = (away**2).sum(axis=1) <= radius_m**2
    return np.asarray(points[is_near])


def segments_of(drive: Drive, points: Integers) -> NDArray[np.int32]:
    """Numbers of the connected segments that points belong to; negative ones are none.

    Raises
    ------
    Unsuitable
        The drive has no segments yet.
    """
    if not drive.columns.has(SEGMENT):
        raise Unsuitable(
            Text("The drive has no segments yet.", "この走行データにはセグメントがありません。"),
            Text.same(drive.info.name),
            Text(
                "Wait until they are found, or run the tool “Segments”.",
                "検出が終わるのを待つか、「セグメント分割」を実行してください。",
            ),
        )
    return np.asarray(drive.columns[SEGMENT][points])


def points_of_segment(drive: Drive, segment: int) -> Integers:
    """All points of a connected segment, rising: (n,) int64.

    Raises
    ------
    Unsuitable
        The drive has no segments.
    """
    segments_of(drive, np.empty(0, np.int64))
    column = drive.columns[SEGMENT]
    found = [
        start + np.flatnonzero(column[start : start + _POINTS_AT_ONCE] == segment)
        for start in range(0, drive.count, _POINTS_AT_ONCE)
    ]
    return np.concatenate(found) if found else np.empty(0, np.int64)


def _ready_image(drive: Drive) -> PointCloudImage:
    """The image whose tiles are known already, or else that of the first kind."""
    images = [image_of(drive, kind) for kind in drive.image_kinds]
    return next((image for image in images if image.pyramid.is_ready), images[0])


def _stretches_near(image: PointCloudImage, ends: Floats, radius_m: float) -> Integers:
    """(k, 2) first and last + 1 points of the rows of tiles that come near a brush's path."""
    pyramid = image.pyramid
    low, high = ends.min(axis=0) - radius_m, ends.max(axis=0) + radius_m
    waiting, rows = [pyramid.top], set()
    while waiting:
        key = waiting.pop()
        bounds = pyramid.bounds(key)
        if bounds is None or (bounds[0] > high).any() or (bounds[1] < low).any():
            continue
        if key.level:
            waiting.extend(pyramid.children(key))
        else:
            covered, _ = pyramid.rows_columns(key)
            rows.add((covered.start, covered.stop))
    starts = image.row_starts
    stretches = [(int(starts[first]), int(starts[stop])) for first, stop in sorted(rows)]
    return np.array(stretches, dtype=np.int64).reshape(-1, 2)


@kernel
def _near_stroke_kernel(
    integers: NDArray[np.int32],
    scale: Floats,
    stretches: Integers,
    stroke: StrokePath,
    found: Integers,
) -> int:
    """Points of stretches that lie near a stroke; gives how many, also of those without room."""
    start, along = stroke.ends[0], stroke.ends[1] - stroke.ends[0]
    length = 0.0
    for j in range(3):
        length += (along[j] * scale[j]) ** 2
    count = 0
    for k in range(stretches.shape[0]):
        for i in range(stretches[k, 0], stretches[k, 1]):
            share = 0.0
            if length > 0.0:
                for j in range(3):
                    share += (integers[i, j] - start[j]) * along[j] * scale[j] * scale[j]
                share = min(max(share / length, 0.0), 1.0)
            square = 0.0
            for j in range(3):
                away = (integers[i, j] - start[j] - share * along[j]) * scale[j]
                square += away * away
            if square <= stroke.radius_m * stroke.radius_m:
                if count < found.size:
                    found[count] = i
                count += 1
    return count


def stroke_is_short(start: Floats, end: Floats, radius_m: float) -> bool:
    """Whether a brush went over the surface between two positions, and did not jump off it."""
    return math.dist(start, end) <= max(10 * radius_m, 2.0)


def warm_up() -> None:
    """Compile the kernel."""
    stroke, room = StrokePath(np.zeros((2, 3)), 1.0), np.empty(1, np.int64)
    _near_stroke_kernel(np.zeros((1, 3), np.int32), np.ones(3), np.array([[0, 1]]), stroke, room)

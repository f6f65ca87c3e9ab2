"""Square buckets over a plan that know which triangles reach into them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

Floats = NDArray[np.float64]
BucketCounts = NDArray[np.int64]

_SMALLEST_M = 1e-6
"""Side of a bucket, at least, for triangles without area."""

_TRIANGLE_SIDES = 1.2
"""Side of a bucket, in sides of a square of twice the area of most triangles. By timing; it changes
the time only."""

_MOST_BUCKETS = 4_000_000
"""32 MB of beginnings."""

_MOST_ENTRIES_EACH, _FEW_ENTRIES = 16, 1_000_000
"""Entries for each triangle, and in any case, from which buckets are made larger: thin triangles as
long as the site would be in all of them."""

_MARGIN = 1e-6
"""Triangles reach this share of a bucket's side further, so that rounding leaves none out."""


@dataclass(frozen=True)
class PlanBuckets:
    """Triangles by the buckets that they reach into; row = north, column = east.

    Attributes
    ----------
    west, south : float
        Lower left corner of the first bucket, in the frame of the triangles, m.
    size_m : float
        Side of a bucket.
    rows, columns : int
    starts : (rows × columns + 1,) int64
        Where in ``triangles`` those of a bucket begin.
    triangles : (k,) int64
        Rising within a bucket.
    """

    west: float
    south: float
    size_m: float
    rows: int
    columns: int
    starts: BucketCounts
    triangles: BucketCounts


def sort_into_buckets(triangles: Floats) -> PlanBuckets:
    """Buckets about as large as most triangles; larger ones where there would be too many.

    The size of the triangles counts, not that of the plan: a road that runs aslant leaves most of
    its plan empty, and a surface may have one corner far away.

    Parameters
    ----------
    triangles : (t, 3, 3) float64
        Corners, finite; t at least 1.
    """
    plan = triangles[:, :, :2].reshape(-1, 2)
    low, high = plan.min(axis=0), plan.max(axis=0)
    size = high - low
    u, v = (triangles[:, corner, :2] - triangles[:, 0, :2] for corner in (1, 2))
    doubled = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    least = float(max(np.sqrt(size.prod() / _MOST_BUCKETS), size.max() / _MOST_BUCKETS))
    # By area: thin triangles would make buckets as large as they are long.
    side = max(_TRIANGLE_SIDES * float(np.sqrt(np.median(doubled))), least, _SMALLEST_M)
    most = _MOST_ENTRIES_EACH * len(triangles) + _FEW_ENTRIES
    while True:
        columns, rows = (int(count) for count in np.floor(size / side).astype(np.int64) + 1)
        frame = (float(low[0]), float(low[1]), side)
        if rows * columns <= _MOST_BUCKETS:
            counts = np.zeros(rows * columns + 1, np.int64)
            _count_kernel(triangles, frame, columns, counts)
            if counts.sum() <= most:
                break
        side *= 2.0
    starts = np.concatenate([[0], np.cumsum(counts[:-1])])
    held = np.empty(starts[-1], np.int64)
    _fill_kernel(triangles, frame, columns, (starts[:-1].copy(), held))
    return PlanBuckets(*frame, rows, columns, starts, held)


def buckets_of_triangles(buckets: PlanBuckets) -> tuple[BucketCounts, BucketCounts]:
    """The same from the other side.

    Returns
    -------
    firsts : (t + 1,) int64
        Where in the second array the buckets of a triangle begin.
    bucket_of : (k,) int64
        Row × columns + column of each bucket.
    """
    numbers = np.repeat(np.arange(len(buckets.starts) - 1), np.diff(buckets.starts))
    order = np.argsort(buckets.triangles, kind="stable")
    counts = np.bincount(buckets.triangles)
    return np.concatenate([[0], np.cumsum(counts)]), numbers[order]


@kernel
def _span(triangle: Floats, low: float, high: float) -> tuple[float, float]:
    """From where to where east a triangle reaches between two northings."""
    west, east = np.inf, -np.inf
    for one in range(3):
        other = one + 1 if one < 2 else 0
        x0, y0 = triangle[one, 0], triangle[one, 1]
        x1, y1 = triangle[other, 0], triangle[other, 1]
        if y0 > y1:
            x0, y0, x1, y1 = x1, y1, x0, y0
        if y1 < low or y0 > high:
            continue
        start, end = x0, x1
        if y0 < low:
            start = x0 + (x1 - x0) * ((low - y0) / (y1 - y0))
        if y1 > high:
            end = x0 + (x1 - x0) * ((high - y0) / (y1 - y0))
        west = min(west, start, end)
        east = max(east, start, end)
    return west, east


@kernel
def _rows_of(triangle: Floats, frame: tuple[float, float, float], most: int) -> tuple[int, int]:
    """First and last row of buckets that a triangle reaches into."""
    _, south, size = frame
    low = min(triangle[0, 1], triangle[1, 1], triangle[2, 1])
    high = max(triangle[0, 1], triangle[1, 1], triangle[2, 1])
    first = int(np.floor((low - south) / size - _MARGIN))
    last = int(np.floor((high - south) / size + _MARGIN))
    return max(first, 0), min(last, most)


@kernel
def _columns_of(
    triangle: Floats, frame: tuple[float, float, float], row: int, most: int
) -> tuple[int, int]:
    """First and last column that a triangle reaches into within a row."""
    west, south, size = frame
    start, end = _span(triangle, south + (row - _MARGIN) * size, south + (row + 1 + _MARGIN) * size)
    if start > end:
        return 0, -1
    first = int(np.floor((start - west) / size - _MARGIN))
    last = int(np.floor((end - west) / size + _MARGIN))
    return max(first, 0), min(last, most)


@kernel
def _count_kernel(
    triangles: Floats, frame: tuple[float, float, float], columns: int, counts: BucketCounts
) -> None:
    """How many triangles reach into each bucket."""
    rows = (counts.shape[0] - 1) // columns
    for triangle in range(triangles.shape[0]):
        first, last = _rows_of(triangles[triangle], frame, rows - 1)
        for row in range(first, last + 1):
            start, end = _columns_of(triangles[triangle], frame, row, columns - 1)
            for column in range(start, end + 1):
                counts[row * columns + column] += 1


@kernel
def _fill_kernel(
    triangles: Floats,
    frame: tuple[float, float, float],
    columns: int,
    held: tuple[BucketCounts, BucketCounts],
) -> None:
    """The triangles of each bucket, from where its place in the list begins."""
    following, numbers = held
    rows = following.shape[0] // columns
    for triangle in range(triangles.shape[0]):
        first, last = _rows_of(triangles[triangle], frame, rows - 1)
        for row in range(first, last + 1):
            start, end = _columns_of(triangles[triangle], frame, row, columns - 1)
            for column in range(start, end + 1):
                bucket = row * columns + column
                numbers[following[bucket]] = triangle
                following[bucket] += 1


def warm_up() -> None:
    """Compile the kernels."""
    sort_into_buckets(np.array([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]))

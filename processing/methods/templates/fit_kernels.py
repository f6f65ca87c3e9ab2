"""Loops that lay a wanted profile on the points of a slab: where it lies best, and how well.

A pose says how the template's axes lie in the slab: offset and height of the anchor (m), tilt about
it (rad, anticlockwise), turn (offset per metre along), grade (height per metre along).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

OFFSET, HEIGHT, TILT, TURN, GRADE = range(5)
POSE = 5
"""Values of a pose."""

START_U, START_V, ALONG_U, ALONG_V, LENGTH, FIRST_BIN, BINS, HAS_BEFORE, HAS_AFTER = range(9)
SEGMENT = 9
"""Values of a straight piece of the shape; the last two say whether another one joins it there."""

_SCALES = (3.0, 1.5, 0.75)  # in tolerances
_TURNS_PER_SCALE = 4
_NOISE_M = 0.005  # how far points of a scanner lie off a surface
_MOST_PER_BIN = 4.0  # of more points in one bin each counts for less: a dense road isn't all
_STEEPEST_TILT = math.radians(5.0)
_ZONE_WEIGHT = 4.0  # a quarter as many points in the empty zones as on the shape is no fit at all
_LEAST_SEEN = 0.5  # of the shape's length
_SHARPNESS = 1.5
_SPARSE_M = 0.05  # as far on either side of a point the shape is seen by it


@kernel
def _nearest(x: float, y: float, segments: _Floats, margin: float) -> tuple[int, float, float]:
    """Segment nearest to a place, where along it, and the distance, left of it positive.

    −1 where the place lies beyond the ends of all of them.
    """
    best, best_along, best_off, least = -1, 0.0, 0.0, math.inf
    for k in range(segments.shape[0]):
        du, dv = x - segments[k, START_U], y - segments[k, START_V]
        along = du * segments[k, ALONG_U] + dv * segments[k, ALONG_V]
        off = dv * segments[k, ALONG_U] - du * segments[k, ALONG_V]
        length = segments[k, LENGTH]
        beyond = max(-along, along - length)
        if beyond > 0.0:
            is_joined = segments[k, HAS_BEFORE] if along < 0.0 else segments[k, HAS_AFTER]
            if beyond > margin and is_joined == 0.0:
                continue
        away = math.hypot(max(0.0, beyond), off)
        if away < least:
            best, least = k, away
            best_along = min(max(along, 0.0), length)
            best_off = off if beyond <= 0.0 else math.copysign(away, off)
    return best, best_along, best_off


@kernel
def _bin_of(segment: _Floats, along: float) -> int:
    position = int(along / segment[LENGTH] * segment[BINS])
    return int(segment[FIRST_BIN]) + min(position, int(segment[BINS]) - 1)


@kernel
def _is_inside(x: float, y: float, ring: _Floats) -> bool:
    inside = False
    j = ring.shape[0] - 1
    for i in range(ring.shape[0]):
        if (ring[i, 1] > y) != (ring[j, 1] > y):
            crossing = ring[i, 0] + (y - ring[i, 1]) / (ring[j, 1] - ring[i, 1]) * (
                ring[j, 0] - ring[i, 0]
            )
            if x < crossing:
                inside = not inside
        j = i
    return inside


@kernel
def score_kernel(
    slab: _Floats,
    pose: _Floats,
    segments: _Floats,
    zones: tuple[_Floats, _Integers],
    limits: tuple[float, float, float],
) -> tuple[float, float, float]:
    """How well a template lies.

    Parameters
    ----------
    slab : (n, 3)
        Offset, height, distance along, m.
    pose : (POSE,)
    segments : (k, SEGMENT)
    zones : (z, 2) and (rings + 1,)
        Places of the rings in which nothing should be, and where each ring begins.
    limits : tuple of float
        Tolerance, reach (how far off the shape points still count against it), thinning (each so
        many-th point is looked at), m.

    Returns
    -------
    tuple of float
        Score, 0 to 1: share of the seen length that lies on points, less what is in the zones;
        the same with a soft edge, for comparing poses; seen share of the length.
    """
    tolerance, reach, step = limits
    sums = np.zeros((int(segments[-1, FIRST_BIN] + segments[-1, BINS]), 3))
    cos, sin = math.cos(pose[TILT]), math.sin(pose[TILT])
    on_shape, in_zones = 0, 0
    softness = (_SHARPNESS / tolerance) ** 2 / 2
    for i in range(0, slab.shape[0], int(step)):
        u = slab[i, 0] - pose[OFFSET] - pose[TURN] * slab[i, 2]
        v = slab[i, 1] - pose[HEIGHT] - pose[GRADE] * slab[i, 2]
        x, y = u * cos + v * sin, v * cos - u * sin
        for z in range(zones[1].size - 1):
            if _is_inside(x, y, zones[0][zones[1][z] : zones[1][z + 1]]):
                in_zones += 1
                break
        k, along, off = _nearest(x, y, segments, 0.0)
        if k >= 0 and abs(off) <= tolerance:
            position = _bin_of(segments[k], along)
            sums[position, 0] += 1.0
            sums[position, 1] += 1.0
            sums[position, 2] += math.exp(-off * off * softness)
            on_shape += 1
        else:
            _add_misses(x, y, segments, (reach, softness), sums)
    lies, softly, seen = _shares(sums, segments)
    penalty = min(1.0, _ZONE_WEIGHT * in_zones / (on_shape + 1.0))
    return max(0.0, lies - penalty), softly - penalty, seen


@kernel
def _shares(sums: _Floats, segments: _Floats) -> tuple[float, float, float]:
    """Shares of the seen length that lies on points, sharply and softly; of what is seen.

    Bins between points a little apart are seen with them: far from a scanner points are sparse.
    """
    seen, whole, lies, softly = 0.0, 0.0, 0.0, 0.0
    for k in range(segments.shape[0]):
        size = segments[k, LENGTH] / segments[k, BINS]
        whole += segments[k, LENGTH]
        first, end = int(segments[k, FIRST_BIN]), int(segments[k, FIRST_BIN] + segments[k, BINS])
        before = -1
        for position in range(first, end + 1):
            if position < end and sums[position, 0] == 0.0:
                continue
            # What stands between the bin seen before and this one: shared, if they are near.
            start = before + 1 if before >= 0 else first
            missing = (position - start) * size
            sides = (before >= 0) + (position < end)
            if 0.0 < missing <= _SPARSE_M * sides:
                for side in range(2):
                    other = before if side == 0 else position
                    if first <= other < end and (side == 1 or before >= 0):
                        seen += missing / sides
                        lies += missing / sides * sums[other, 1] / sums[other, 0]
                        softly += missing / sides * sums[other, 2] / sums[other, 0]
            if position < end:
                seen += size
                lies += size * sums[position, 1] / sums[position, 0]
                softly += size * sums[position, 2] / sums[position, 0]
                before = position
    needed = max(seen, _LEAST_SEEN * whole)
    return lies / needed, softly / needed, seen / whole


@kernel
def _add_misses(
    x: float, y: float, segments: _Floats, limits: tuple[float, float], sums: _Floats
) -> None:
    """A point off the shape tells against each piece that it lies beside: nothing hid that one."""
    for k in range(segments.shape[0]):
        du, dv = x - segments[k, START_U], y - segments[k, START_V]
        along = du * segments[k, ALONG_U] + dv * segments[k, ALONG_V]
        off = dv * segments[k, ALONG_U] - du * segments[k, ALONG_V]
        if 0.0 <= along <= segments[k, LENGTH] and abs(off) <= limits[0]:
            position = _bin_of(segments[k], along)
            sums[position, 0] += 1.0
            sums[position, 2] += math.exp(-off * off * limits[1])


@kernel
def refine_kernel(
    slab: _Floats,
    pose: _Floats,
    prior: tuple[_Floats, _Floats],
    segments: _Floats,
    tolerance: float,
) -> None:
    """Move a pose to where points lie nearest to the shape: Gauss-Newton, coarse to fine.

    Points count by a Gaussian of their distance, those of one bin of the shape together by four at
    most.

    Parameters
    ----------
    pose : (POSE,)
        Where to begin; made better.
    prior : (POSE,) and (POSE,)
        The pose expected, and how far from it one may be (standard deviations).
    """
    normal = np.empty((slab.shape[0], 2))
    seen = np.empty((slab.shape[0], 4))
    matrix, right = np.empty((POSE, POSE)), np.empty(POSE)
    for turn in range(len(_SCALES) * _TURNS_PER_SCALE):
        scale = _SCALES[turn // _TURNS_PER_SCALE] * tolerance
        _weigh(slab, pose, segments, (tolerance, scale), seen, normal)
        matrix[:, :] = 0.0
        for j in range(POSE):
            matrix[j, j] = 1.0 / prior[1][j] ** 2
            right[j] = (prior[0][j] - pose[j]) * matrix[j, j]
        _add_equations(slab, seen, normal, matrix, right)
        step = np.linalg.solve(matrix, right)
        for j in range(POSE):
            pose[j] += step[j]
        pose[TILT] = min(max(pose[TILT], -_STEEPEST_TILT), _STEEPEST_TILT)


@kernel
def _weigh(
    slab: _Floats,
    pose: _Floats,
    segments: _Floats,
    limits: tuple[float, float],
    seen: _Floats,
    normal: _Floats,
) -> None:
    """Weight, distance and place (about the anchor) of points; the shape's normal next to them."""
    tolerance, scale = limits
    counts = np.zeros(int(segments[-1, FIRST_BIN] + segments[-1, BINS]))
    positions = np.empty(slab.shape[0], np.int64)
    cos, sin = math.cos(pose[TILT]), math.sin(pose[TILT])
    for i in range(slab.shape[0]):
        u = slab[i, 0] - pose[OFFSET] - pose[TURN] * slab[i, 2]
        v = slab[i, 1] - pose[HEIGHT] - pose[GRADE] * slab[i, 2]
        k, along, off = _nearest(u * cos + v * sin, v * cos - u * sin, segments, tolerance)
        positions[i] = -1
        seen[i, 0] = 0.0
        if k < 0 or abs(off) > 3.0 * scale:
            continue
        positions[i] = _bin_of(segments[k], along)
        seen[i, 0], seen[i, 1] = math.exp(-off * off / (2.0 * scale * scale)), off
        seen[i, 2], seen[i, 3] = u, v
        counts[positions[i]] += seen[i, 0]
        normal[i, 0] = -segments[k, ALONG_V] * cos - segments[k, ALONG_U] * sin
        normal[i, 1] = segments[k, ALONG_U] * cos - segments[k, ALONG_V] * sin
    for i in range(slab.shape[0]):
        if positions[i] >= 0:
            seen[i, 0] *= min(1.0, _MOST_PER_BIN / counts[positions[i]]) / (_NOISE_M * _NOISE_M)


@kernel
def _add_equations(
    slab: _Floats, seen: _Floats, normal: _Floats, matrix: _Floats, right: _Floats
) -> None:
    gradient = np.empty(POSE)
    for i in range(slab.shape[0]):
        weight = seen[i, 0]
        if weight == 0.0:
            continue
        gradient[OFFSET], gradient[HEIGHT] = normal[i, 0], normal[i, 1]
        gradient[TILT] = normal[i, 1] * seen[i, 2] - normal[i, 0] * seen[i, 3]
        gradient[TURN], gradient[GRADE] = normal[i, 0] * slab[i, 2], normal[i, 1] * slab[i, 2]
        for j in range(POSE):
            right[j] += weight * seen[i, 1] * gradient[j]
            for m in range(POSE):
                matrix[j, m] += weight * gradient[j] * gradient[m]


@kernel
def search_kernel(
    slab: _Floats,
    poses: _Floats,
    segments: _Floats,
    zones: tuple[_Floats, _Integers],
    limits: tuple[float, float, float],
    scores: _Floats,
) -> None:
    """Soft scores of many poses.

    Parameters
    ----------
    poses : (m, POSE)
    scores : (m,)
        Filled; see `score_kernel`.
    """
    for i in range(poses.shape[0]):
        _, scores[i], _ = score_kernel(slab, poses[i], segments, zones, limits)


@kernel
def slab_kernel(
    local: _Floats, frame: _Floats, box: _Floats, slab: _Floats, chosen: _Integers
) -> int:
    """Points of a slab as the slab sees them; gives their number.

    Parameters
    ----------
    local : (n, 3)
        m, about some origin.
    frame : (5,)
        The slab's middle about that origin; direction along in plan.
    box : (5,)
        Least and largest offset and height about the middle; half the thickness, m.
    slab : (n, 3)
        Offset to the right, height, distance along.
    chosen : (n,)
        Which points they are.
    """
    count = 0
    for i in range(local.shape[0]):
        east, north = local[i, 0] - frame[0], local[i, 1] - frame[1]
        along = east * frame[3] + north * frame[4]
        if abs(along) > box[4]:
            continue
        right, up = east * frame[4] - north * frame[3], local[i, 2] - frame[2]
        if box[0] <= right <= box[1] and box[2] <= up <= box[3]:
            slab[count, 0], slab[count, 1], slab[count, 2] = right, up, along
            chosen[count] = i
            count += 1
    return count


def warm_up() -> None:
    """Compile the kernels."""
    segments = np.array([[0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 5.0, 0.0, 0.0]])
    zones = np.zeros((0, 2)), np.zeros(1, np.int64)
    slab, chosen = np.zeros((2, 3)), np.zeros(2, np.int64)
    slab_kernel(slab.copy(), np.array([0.0, 0, 0, 0, 1]), np.ones(5), slab, chosen)
    limits = (0.02, 0.1, 1.0)
    score_kernel(slab, np.zeros(POSE), segments, zones, limits)
    search_kernel(slab, np.zeros((1, POSE)), segments, zones, limits, np.zeros(1))
    refine_kernel(slab, np.zeros(POSE), (np.zeros(POSE), np.ones(POSE)), segments, 0.02)

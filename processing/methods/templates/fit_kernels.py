"""Loops that lay a wanted profile on the points of a slab: where it lies best, and how well.

A pose says how the template's axes lie in the slab: offset and height of the anchor (m), tilt about
it (rad, anticlockwise), turn (offset per metre along), grade (height per metre along).

Where a constant says “by trial”, it was set on the left head of a simulated town street; no
measurement varied it alone. Scores of all values together are in docs/accuracy.md.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

POSE = 5
OFFSET, HEIGHT, TILT, TURN, GRADE = range(POSE)
"""Values of a pose."""

SEGMENT = 9
START_U, START_V, ALONG_U, ALONG_V, LENGTH, FIRST_BIN, BINS, HAS_BEFORE, HAS_AFTER = range(SEGMENT)
"""Values of a straight piece of the shape; the last two say whether another one joins it there."""

FRAME = 5
EAST, NORTH, UP, ALONG_EAST, ALONG_NORTH = range(FRAME)
"""Values of a slab's frame: its middle, m, and the direction along in plan."""

BOX = 5
LEFT, RIGHT, LOWEST, HIGHEST, HALF_WIDTH = range(BOX)
"""Values of a slab's box about its middle, m."""

_SCALES = (3.0, 1.5, 0.75)
"""Of the Gaussian by which points count, in tolerances, from coarse to fine; by trial."""

_ROUNDS_PER_SCALE = 4
"""Steps of Gauss-Newton with each; by trial."""

_SCALES_FAR = 3.0
"""Scales beyond which a point does not count: its weight would be 1 %."""

_NOISE_M = 0.005
"""How far points of a scanner lie off a surface; sets points against what is expected of a pose."""

_MOST_PER_BIN = 4.0
"""Of more points in one bin of the shape each counts for less: a dense road isn't all. By trial."""

_STEEPEST_TILT = math.radians(5.0)
"""By trial: a template is drawn upright, and what is built along a road leans little."""

_ZONE_WEIGHT = 4.0
"""A quarter as many points in the empty zones as on the shape is no fit at all; by trial."""

_LEAST_SEEN = 0.5
"""Share of the shape's length that must be seen for a full score; by trial."""

_SHARPNESS = 1.5
"""Tolerance in standard deviations of the soft edge: a point there counts a third."""

_SPARSE_M = 0.05
"""As far on either side of a point the shape is seen by it; by trial, the distance of points on the
far side of a street."""

_SEEN, _ON, _SOFTLY, _BIN_SUMS = 0, 1, 2, 3
"""Sums of a bin: points beside it, those on it, and those on it by the soft edge."""

_WEIGHT, _OFF, _U, _V, _POINT_FACTS = 0, 1, 2, 3, 4
"""Of a point: weight, distance from the shape, and where it lies about the anchor."""


class EmptyZones(NamedTuple):
    """(z, 2) corners of the rings in which nothing should be, and where each ring begins."""

    corners: _Floats
    starts: _Integers


class ScoreLimits(NamedTuple):
    """What a score is given by.

    ``tolerance_m``; ``reach_m``: how far off the shape points still count against it;
    ``thinning``: each so many-th point is looked at.
    """

    tolerance_m: float
    reach_m: float
    thinning: float


class PoseScore(NamedTuple):
    """How well a pose fits.

    ``score``, 0 to 1: share of the seen length that lies on points, less what is in the zones;
    ``softly``: the same with a soft edge, for comparing poses; ``seen``: share of the length.
    """

    score: float
    softly: float
    seen: float


class ExpectedPose(NamedTuple):
    """(POSE,) each: the pose expected, and how far from it one may be (standard deviations)."""

    pose: _Floats
    spread: _Floats


class _MissLimits(NamedTuple):
    """How far off a point counts against a piece, m, and the factor of the soft edge, 1/m²."""

    reach_m: float
    softness: float


class _WeightLimits(NamedTuple):
    """Tolerance, and scale of the Gaussian, m."""

    tolerance_m: float
    scale_m: float


@kernel
def _nearest(x: float, y: float, segments: _Floats, margin: float) -> tuple[int, float, float]:
    """Segment nearest to a position, where along it, and the distance, left of it positive.

    −1 where the position lies beyond the ends of all of them.
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
    zones: EmptyZones,
    limits: ScoreLimits,
) -> PoseScore:
    """How well a template fits.

    Parameters
    ----------
    slab : (n, 3)
        Offset, height, distance along, m.
    pose : (POSE,)
    segments : (k, SEGMENT)
    zones : EmptyZones
    limits : ScoreLimits
    """
    tolerance, reach, step = limits
    corners, starts = zones
    sums = np.zeros((int(segments[-1, FIRST_BIN] + segments[-1, BINS]), _BIN_SUMS))
    cos, sin = math.cos(pose[TILT]), math.sin(pose[TILT])
    on_shape, in_zones = 0, 0
    softness = (_SHARPNESS / tolerance) ** 2 / 2
    for i in range(0, slab.shape[0], int(step)):
        u = slab[i, 0] - pose[OFFSET] - pose[TURN] * slab[i, 2]
        v = slab[i, 1] - pose[HEIGHT] - pose[GRADE] * slab[i, 2]
        x, y = u * cos + v * sin, v * cos - u * sin
        for z in range(starts.size - 1):
            if _is_inside(x, y, corners[starts[z] : starts[z + 1]]):
                in_zones += 1
                break
        k, along, off = _nearest(x, y, segments, 0.0)
        if k >= 0 and abs(off) <= tolerance:
            position = _bin_of(segments[k], along)
            sums[position, _SEEN] += 1.0
            sums[position, _ON] += 1.0
            sums[position, _SOFTLY] += math.exp(-off * off * softness)
            on_shape += 1
        else:
            _add_misses(x, y, segments, _MissLimits(reach, softness), sums)
    lies, softly, seen = _shares(sums, segments)
    penalty = min(1.0, _ZONE_WEIGHT * in_zones / (on_shape + 1.0))
    return PoseScore(max(0.0, lies - penalty), softly - penalty, seen)


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
            if position < end and sums[position, _SEEN] == 0.0:
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
                        lies += missing / sides * sums[other, _ON] / sums[other, _SEEN]
                        softly += missing / sides * sums[other, _SOFTLY] / sums[other, _SEEN]
            if position < end:
                seen += size
                lies += size * sums[position, _ON] / sums[position, _SEEN]
                softly += size * sums[position, _SOFTLY] / sums[position, _SEEN]
                before = position
    needed = max(seen, _LEAST_SEEN * whole)
    return lies / needed, softly / needed, seen / whole


@kernel
def _add_misses(x: float, y: float, segments: _Floats, limits: _MissLimits, sums: _Floats) -> None:
    """A point off the shape tells against each piece that it lies beside: nothing hid that one."""
    for k in range(segments.shape[0]):
        du, dv = x - segments[k, START_U], y - segments[k, START_V]
        along = du * segments[k, ALONG_U] + dv * segments[k, ALONG_V]
        off = dv * segments[k, ALONG_U] - du * segments[k, ALONG_V]
        if 0.0 <= along <= segments[k, LENGTH] and abs(off) <= limits.reach_m:
            position = _bin_of(segments[k], along)
            sums[position, _SEEN] += 1.0
            sums[position, _SOFTLY] += math.exp(-off * off * limits.softness)


@kernel
def refine_kernel(
    slab: _Floats,
    pose: _Floats,
    prior: ExpectedPose,
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
    prior : ExpectedPose
    """
    expected, spread = prior
    normal = np.empty((slab.shape[0], 2))
    seen = np.empty((slab.shape[0], _POINT_FACTS))
    matrix, right = np.empty((POSE, POSE)), np.empty(POSE)
    for number in range(len(_SCALES) * _ROUNDS_PER_SCALE):
        scale = _SCALES[number // _ROUNDS_PER_SCALE] * tolerance
        _weigh(slab, pose, segments, _WeightLimits(tolerance, scale), seen, normal)
        matrix[:, :] = 0.0
        for j in range(POSE):
            matrix[j, j] = 1.0 / spread[j] ** 2
            right[j] = (expected[j] - pose[j]) * matrix[j, j]
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
    limits: _WeightLimits,
    seen: _Floats,
    normal: _Floats,
) -> None:
    """Weight, distance and position (about the anchor) of points; the shape's normal there."""
    tolerance, scale = limits.tolerance_m, limits.scale_m
    counts = np.zeros(int(segments[-1, FIRST_BIN] + segments[-1, BINS]))
    positions = np.empty(slab.shape[0], np.int64)
    cos, sin = math.cos(pose[TILT]), math.sin(pose[TILT])
    for i in range(slab.shape[0]):
        u = slab[i, 0] - pose[OFFSET] - pose[TURN] * slab[i, 2]
        v = slab[i, 1] - pose[HEIGHT] - pose[GRADE] * slab[i, 2]
        k, along, off = _nearest(u * cos + v * sin, v * cos - u * sin, segments, tolerance)
        positions[i] = -1
        seen[i, _WEIGHT] = 0.0
        if k < 0 or abs(off) > _SCALES_FAR * scale:
            continue
        positions[i] = _bin_of(segments[k], along)
        seen[i, _WEIGHT], seen[i, _OFF] = math.exp(-off * off / (2.0 * scale * scale)), off
        seen[i, _U], seen[i, _V] = u, v
        counts[positions[i]] += seen[i, _WEIGHT]
        normal[i, 0] = -segments[k, ALONG_V] * cos - segments[k, ALONG_U] * sin
        normal[i, 1] = segments[k, ALONG_U] * cos - segments[k, ALONG_V] * sin
    for i in range(slab.shape[0]):
        if positions[i] >= 0:
            share = min(1.0, _MOST_PER_BIN / counts[positions[i]])
            seen[i, _WEIGHT] *= share / (_NOISE_M * _NOISE_M)


@kernel
def _add_equations(
    slab: _Floats, seen: _Floats, normal: _Floats, matrix: _Floats, right: _Floats
) -> None:
    gradient = np.empty(POSE)
    for i in range(slab.shape[0]):
        weight = seen[i, _WEIGHT]
        if weight == 0.0:
            continue
        gradient[OFFSET], gradient[HEIGHT] = normal[i, 0], normal[i, 1]
        gradient[TILT] = normal[i, 1] * seen[i, _U] - normal[i, 0] * seen[i, _V]
        gradient[TURN], gradient[GRADE] = normal[i, 0] * slab[i, 2], normal[i, 1] * slab[i, 2]
        for j in range(POSE):
            right[j] += weight * seen[i, _OFF] * gradient[j]
            for m in range(POSE):
                matrix[j, m] += weight * gradient[j] * gradient[m]


@kernel
def search_kernel(
    slab: _Floats,
    poses: _Floats,
    segments: _Floats,
    zones: EmptyZones,
    limits: ScoreLimits,
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
        scores[i] = score_kernel(slab, poses[i], segments, zones, limits).softly


@kernel
def slab_kernel(
    local: _Floats, frame: _Floats, box: _Floats, slab: _Floats, chosen: _Integers
) -> int:
    """Points of a slab as the slab sees them; gives their number.

    Parameters
    ----------
    local : (n, 3)
        m, about some origin.
    frame : (FRAME,)
        The slab's middle about that origin; direction along in plan.
    box : (BOX,)
        Least and largest offset and height about the middle; half the thickness, m.
    slab : (n, 3)
        Offset to the right, height, distance along.
    chosen : (n,)
        Which points they are.
    """
    count = 0
    for i in range(local.shape[0]):
        east, north = local[i, 0] - frame[EAST], local[i, 1] - frame[NORTH]
        along = east * frame[ALONG_EAST] + north * frame[ALONG_NORTH]
        if abs(along) > box[HALF_WIDTH]:
            continue
        right = east * frame[ALONG_NORTH] - north * frame[ALONG_EAST]
        up = local[i, 2] - frame[UP]
        if box[LEFT] <= right <= box[RIGHT] and box[LOWEST] <= up <= box[HIGHEST]:
            slab[count, 0], slab[count, 1], slab[count, 2] = right, up, along
            chosen[count] = i
            count += 1
    return count


def warm_up() -> None:
    """Compile the kernels."""
    segments = np.array([[0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 5.0, 0.0, 0.0]])
    zones = EmptyZones(np.zeros((0, 2)), np.zeros(1, np.int64))
    slab, chosen = np.zeros((2, 3)), np.zeros(2, np.int64)
    slab_kernel(slab.copy(), np.array([0.0, 0, 0, 0, 1]), np.ones(5), slab, chosen)
    limits = ScoreLimits(0.02, 0.1, 1.0)
    score_kernel(slab, np.zeros(POSE), segments, zones, limits)
    search_kernel(slab, np.zeros((1, POSE)), segments, zones, limits, np.zeros(1))
    expected = ExpectedPose(np.zeros(POSE), np.ones(POSE))
    refine_kernel(slab, np.zeros(POSE), expected, segments, 0.02)

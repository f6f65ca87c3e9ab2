"""EdgeProfile: the profile across an edge, from the points of several rows on either side of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from processing.core.arrays import Floats
from processing.image.edges.edge_kernels import (
    ACROSS,
    BEND,
    CORNER_COLUMNS,
    HEIGHT,
    MOST_CORNERS,
    SectionLimits,
    corners_kernel,
)

PATCH_M = 0.5
"""Radius of what is looked at as one piece of edge: longer than a curb is high, and yet in a bend
of 5 m radius its ends are only 2.5 cm off the straight, which a curved frame takes up."""

LEAST_STRENGTH_M = 0.010
"""An edge bends the surface at least so far from the straight: sine of the bend times the shorter
of the two surfaces (10 cm at most). Steps of 2 cm and more are well above it, joints below."""

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_FEWEST = 30
"""Points from which a direction and a profile follow. By trial."""

_ENOUGH, _MOST = 160, 300
"""Points that are enough for a profile, of which the nearest along the edge are taken; more make it
slower, not better. By trial."""

_LEAST_ALONG_M = 0.2
"""Half the shortest length of edge: several rows of any drive. By trial."""

_NEIGHBOURS, _LEAST_RADIUS_M = 20, 0.08
"""Points in the circle from which a normal is found, and its least radius: a normal of 20 points
with 4 mm of noise over 8 cm is sure to about a degree."""

_THINNEST, _STEEPEST_LEVEL = 0.02, 0.7
"""Second to first eigenvalue from which neighbours are a surface and no row; an edge whose
direction is less level than this share is taken as level: 45°. By trial."""

_NOISE_M = 0.004
"""How far points of a line scanner lie off a smooth surface, usually: 3 to 5 mm."""

_NOISE_MARGIN, _MOST_NOISE_M = 1.1, 0.008
"""Where they lie farther off the noise is taken so much larger than found, at most the second. By
trial."""

_MOST_SPREAD_M = 0.020
"""Beyond: plants, parts of several things. By trial."""

_MOST_HEIGHT_M = 0.5
"""Half the height that is looked at, as the radius."""

_TRIED_HEADINGS = np.radians(np.arange(-15.0, 15.1, 2.5))
"""About the direction of the normals, which is sure to some degrees; the frame settles within
6°."""

_ROUGH_BINS, _ROUGH_SPAN, _MOST_OFF = 160, 3.0, 6.0
"""Bins along the profile, over so many radii (2 √2 at most): 9 mm; points weigh no more than at so
many noises off it."""

_DENSE_M, _EVENLY_FILLED = 0.015, 0.5
"""Points are expected on all places of this width across the edge; where fewer than this share of
those that chance would fill are, rows run along it. By trial."""

_FOLDED = math.radians(110.0)
"""Sharper bends come from rows that don't fit on one profile. By trial."""

_LEAST_SQUARE = 1e-9
"""Guard of a division."""


@dataclass(frozen=True)
class EdgeProfile:
    """The profile across an edge.

    Attributes
    ----------
    center : (3,) float64
        m; what the frame is about.
    heading_rad, grade, curvature : float
        Direction of the edge: counter-clockwise from the easting; rise per metre; 1/m.
    corners : (k, CORNER_COLUMNS) float64
        See `edge_kernels`.
    spread_m : float
        How far points lie off the profile, its pieces being paid for.
    """

    center: Floats
    heading_rad: float
    grade: float
    curvature: float
    corners: Floats
    spread_m: float

    @property
    def direction(self) -> Floats:
        """(3,) unit vector along the edge."""
        along = np.array([math.cos(self.heading_rad), math.sin(self.heading_rad), self.grade])
        return np.asarray(along / np.linalg.norm(along))

    @property
    def positions(self) -> Floats:
        """(k, 3) the corners, m, project CRS."""
        left = np.array([-math.sin(self.heading_rad), math.cos(self.heading_rad), 0.0])
        up = np.array([0.0, 0.0, 1.0])
        corners = self.corners
        return np.asarray(
            self.center + corners[:, ACROSS, None] * left + corners[:, HEIGHT, None] * up
        )


def section_at(xyz: Floats, center: Floats) -> EdgeProfile | None:
    """The profile of points about a place, seen along the edge that runs there.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.

    Returns
    -------
    EdgeProfile or None
        None where there are too few points or they are no surfaces.
    """
    local = xyz - center
    near = (local**2).sum(axis=1) <= PATCH_M**2
    local = local[near]
    if local.shape[0] < _FEWEST:
        return None
    local = np.ascontiguousarray(local[:: max(1, local.shape[0] // _MOST)])
    frame = _first_frame(local)
    tried = np.tile(frame, (_TRIED_HEADINGS.size, 1))
    tried[:, 0] += _TRIED_HEADINGS
    costs = _roughness(local, tried)
    best: EdgeProfile | None = None
    starts = (frame, tried[costs.argmin()])
    for start in starts[: 1 if np.array_equal(*starts) else 2]:
        if _runs_with_rows(local, start):
            continue
        found = section_along(local, start, (length_needed(local, start), PATCH_M), 0)
        if found is not None and (best is None or found.spread_m < best.spread_m):
            best = found
    if best is None or best.spread_m > _MOST_SPREAD_M:
        return None
    return replace(best, center=center)


def section_along(
    local: Floats, frame: Floats, reach: tuple[float, float], order: int
) -> EdgeProfile | None:
    """The profile of points about the origin when the direction of the edge is nearly known."""
    corners = np.empty((MOST_CORNERS, CORNER_COLUMNS))
    along, across = reach
    noise = _NOISE_M
    for _ in range(2):
        turned = frame.copy()
        limits = SectionLimits(along, across, min(_MOST_HEIGHT_M, across), noise, order)
        count, price, spread = corners_kernel(local, limits, turned, corners)
        if not math.isfinite(price):
            return None
        if spread <= noise:
            break
        # Rougher ground or another scanner: again, by what was found.
        noise = min(_MOST_NOISE_M, _NOISE_MARGIN * spread)
    is_edge = np.abs(corners[:count, BEND]) <= _FOLDED
    return EdgeProfile(
        center=np.zeros(3),
        heading_rad=float(turned[0]),
        grade=float(turned[1]),
        curvature=float(turned[2]),
        corners=corners[:count][is_edge],
        spread_m=noise * math.sqrt(price),
    )


def _runs_with_rows(local: Floats, frame: Floats) -> bool:
    """Whether points fall on few places of the profile, since rows run along that direction."""
    across = local[:, 1] * math.cos(frame[0]) - local[:, 0] * math.sin(frame[0])
    bins = round(2 * PATCH_M / _DENSE_M)
    filled = np.unique((across / _DENSE_M).astype(np.int64)).size
    return filled < _EVENLY_FILLED * bins * (1 - math.exp(-across.size / bins))


def length_needed(local: Floats, frame: Floats, most_m: float = PATCH_M) -> float:
    """Half the length of edge that has enough points: the shorter, the straighter it is."""
    along = np.abs(local[:, 0] * math.cos(frame[0]) + local[:, 1] * math.sin(frame[0]))
    if along.size <= _ENOUGH:
        return most_m
    return max(_LEAST_ALONG_M, float(np.partition(along, _ENOUGH)[_ENOUGH]))


def _first_frame(local: Floats) -> Floats:
    """Heading and grade of the direction square to all normals."""
    step = max(1, local.shape[0] // _ENOUGH)
    thinned = local[::step]
    spacing = math.sqrt(math.pi * float((thinned[:, :2] ** 2).sum(axis=1).max()) / len(thinned))
    scatters = _scatters(thinned, max(_LEAST_RADIUS_M, spacing * math.sqrt(_NEIGHBOURS / math.pi)))
    values, vectors = np.linalg.eigh(scatters)
    is_surface = values[:, 1] > _THINNEST * values[:, 2]
    if not is_surface.any():
        return np.zeros(3)
    normals = vectors[is_surface, :, 0]
    along = np.linalg.eigh(normals.T @ normals)[1][:, 0]
    level = math.hypot(along[0], along[1])
    grade = float(along[2]) / level if level > _STEEPEST_LEVEL else 0.0
    heading = math.atan2(along[1], along[0])
    return np.array([heading, grade, 0.0])


def _scatters(xyz: Floats, radius: float) -> Floats:
    """(n, 3, 3) covariance of the neighbours of every point."""
    squares = (xyz**2).sum(axis=1)
    apart = squares[:, None] + squares - 2 * xyz @ xyz.T
    is_near = (apart <= radius**2).astype(np.float64)
    counts = is_near.sum(axis=1)[:, None]
    means = is_near @ xyz / counts
    products = is_near @ np.einsum("ij,ik->ijk", xyz, xyz).reshape(-1, 9) / counts
    return np.asarray(products.reshape(-1, 3, 3) - np.einsum("ij,ik->ijk", means, means))


def _roughness(local: Floats, frames: Floats) -> Floats:
    """(k,) how badly points fall on one profile when looked at along each of some frames, m².

    Mean squares of the distance from short straight pieces, of profiles that rise or fall.
    """
    cos, sin = np.cos(frames[:, 0, None]), np.sin(frames[:, 0, None])
    u = local[:, 1] * cos - local[:, 0] * sin
    v = local[:, 2] - frames[:, 1, None] * (local[:, 0] * cos + local[:, 1] * sin)
    costs = []
    for order in (1, -1):
        # Along the order of the profile, and square to it.
        s, w = (u + order * v) / math.sqrt(2), (v - order * u) / math.sqrt(2)
        position = ((s / PATCH_M + _ROUGH_SPAN / 2) / _ROUGH_SPAN * _ROUGH_BINS).astype(np.int64)
        flat = (
            np.clip(position, 0, _ROUGH_BINS - 1) + np.arange(len(s))[:, None] * _ROUGH_BINS
        ).ravel()
        sums = np.stack(
            [
                np.bincount(flat, weight.ravel(), len(s) * _ROUGH_BINS).reshape(len(s), -1)
                for weight in (np.ones_like(s), s, w, s * s, s * w, w * w)
            ]
        )
        three = sums[:, :, :-2] + sums[:, :, 1:-1] + sums[:, :, 2:]
        count = np.maximum(three[0], 1.0)
        ss = three[3] - three[1] ** 2 / count
        sw = three[4] - three[1] * three[2] / count
        ww = three[5] - three[2] ** 2 / count
        # Straight pieces as functions of s: none can run across the order.
        left = ww - sw**2 / np.maximum(ss, _LEAST_SQUARE)
        usable = np.where(three[0] > 2, sums[0, :, 1:-1], 0.0)
        squares = np.minimum(left / np.maximum(three[0] - 2, 1.0), (_MOST_OFF * _NOISE_M) ** 2)
        costs.append((usable * squares).sum(axis=1) / np.maximum(usable.sum(axis=1), 1.0))
    return np.asarray(np.minimum(costs[0], costs[1]))


def warm_up() -> None:
    """Compile the kernels."""
    across = np.linspace(-0.4, 0.4, 60)
    up = np.where(across > 0, 0.15, 0.0)
    section_at(np.column_stack([np.tile([0.0, 0.2, 0.4], 20), across, up]), np.zeros(3))

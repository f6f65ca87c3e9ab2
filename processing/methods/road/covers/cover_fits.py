"""From a raster of the surface to covers: places that differ from the road about them, and shapes.

1. Boxes of several sizes along the road are held against the bands on their four sides, by tone, by
   height and by what lies below; the places that differ most are looked at.
2. About each the plane of the road is taken off, and the circle and the rectangle are searched for
   whose edge parts most: a cover has a sharp edge all around, dirt and water have none.
3. Of shapes that overlap the likelier one stays.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.covers.cell_kernels import (
    LAYERS,
    apart_kernel,
    contrast_kernel,
    integral_kernel,
    window_kernel,
)
from processing.methods.road.covers.cover_raster import CoverRaster
from processing.methods.road.covers.edge_kernels import SECTORS, edge_kernel
from processing.methods.road.covers.shape_kernels import BAND_M, PATCHY, LookedAt, fit_kernel
from processing.methods.road.markings.paint_raster import TILE_M

_HALVES_M = (
    *((0.1, 0.1), (0.15, 0.15), (0.22, 0.22), (0.3, 0.3), (0.42, 0.42)),
    *((0.3, 0.2), (0.2, 0.3), (0.45, 0.3), (0.3, 0.45), (0.6, 0.3), (0.3, 0.6)),
)
"""Half sides of boxes that are looked for: from valves of 0.2 m to manholes of 0.9 m, and boxes of
0.6 by 0.4, 0.9 by 0.6 and 1.2 by 0.6 m along and across the road."""

_HALO_M = 1.2
"""Around a tile: half of the longest cover and the road about it."""

_STEP_M, _ALIKE = 0.1, 2.5
_LEAST_CONTRAST = 5.0
"""Sum of squares of differences over what chance makes of them."""

_LEAST_GAIN = 25.0
"""The same of a shape's edge."""

_FLOORS = (0.03, 0.0008, 0.15)
"""Standard deviations of a cell's tone, height, m, and share of points below, at least."""

_MOST_CELLS, _MOST_WEIGHT = 4096, 3.0
_OFF_PLANE_M = 0.03
"""What lies farther off the road's plane is a curb or stands on it."""

_SHARED = 0.2
"""Of the smaller of two shapes that overlap: two covers don't."""

_CORNER_COST = 1.04
"""How much clearer a rectangle's edge has to be than a circle's: it has two measures more."""

_RADII_M: Floats = np.array(
    [0.075, 0.1, 0.125, 0.15, 0.18, 0.21, 0.25, 0.3, 0.36, 0.42, 0.48, 0.56, 0.65]
)
_REACH_M = (0.3, 1.5, 0.25)
"""About a place that is looked at: least, and over the half side of its box."""


class CoverEdge(NamedTuple):
    """What a shape's edge parts, sector by sector: means of bands inside and outside.

    Attributes
    ----------
    bands : (12, 2, 5) float64
        Inside and outside: weight, tone, height, m, weight of all, share of points below.
    core : (4, 5) float64
        The same of all that lies inside; the number of its cells, and the weighted squares of tones
        and heights; the same as the first of what lies within 5 cm of the edge, inside and outside.
    noise : (3,) float64
        Standard deviations of a cell's tone, height, m, and share of points below.
    """

    bands: Floats
    core: Floats
    noise: Floats


@dataclass(frozen=True)
class FittedCover:
    """A shape in the surface.

    Attributes
    ----------
    middle : (2,) float64
        m about the plan's origin.
    half_m : (float, float)
        Half length and half width; of a circle its radius and 0.
    angle_rad : float
        Of its length, anticlockwise from east.
    gain : float
        How clear its edge is: as :func:`gain_of` tells it.
    edge : CoverEdge
    plane : (3,) float64
        Height of its middle about the plan's origin, m, and how it rises to the east and north.
    filled : float
        Share of its area that was measured.
    """

    middle: Floats
    half_m: tuple[float, float]
    angle_rad: float
    gain: float
    edge: CoverEdge
    plane: Floats
    filled: float

    @property
    def is_round(self) -> bool:
        """A circle, no rectangle."""
        return self.half_m[1] <= 0.0

    @property
    def sides_m(self) -> tuple[float, float]:
        """Length and width; of a circle its diameter twice."""
        return self.half_m[0] * 2, (self.half_m[1] or self.half_m[0]) * 2

    @property
    def corners(self) -> Floats:
        """(4, 2) round a rectangle, or about a circle; m about the plan's origin."""
        long, wide = np.array(self.sides_m) / 2
        own = np.array([[-long, -wide], [long, -wide], [long, wide], [-long, wide]])
        return np.asarray(self.middle + own @ _turn(self.angle_rad))


class _Frame(NamedTuple):
    """A window along the road: its middle, m about the plan's origin, and direction."""

    middle: Floats
    angle_rad: float
    cell_m: float
    size: int

    def placed(self, own: Floats) -> Floats:
        """Places in it, m from its first corner, about the plan's origin."""
        return np.asarray(self.middle + (own - self.size * self.cell_m / 2) @ _turn(self.angle_rad))


class _Place(NamedTuple):
    """What is looked at: cells from the window's corner, half sides of its box, m."""

    cell: tuple[int, int]
    half_m: tuple[float, float]

    @property
    def reach_m(self) -> float:
        """How far about it cells are looked at."""
        return max(_REACH_M[0], _REACH_M[1] * max(self.half_m) + _REACH_M[2])


def fitted_covers(raster: CoverRaster, monitor: Monitor) -> tuple[FittedCover, ...]:
    """All shapes that differ from the road about them; which are covers is asked later."""
    tiles = [(int(i), int(j)) for i, j in np.argwhere(raster.road.table >= 0)]
    usual = _usual_count(raster)

    def of_tile(tile: tuple[int, int]) -> list[FittedCover]:
        monitor.check()
        return [*_of_tile(tile, raster, usual, monitor)]

    found: list[FittedCover] = []
    for number, one in enumerate(in_order(of_tile, tiles)):
        monitor.check()
        monitor.report((number + 1) / len(tiles))
        found += one
    return tuple(found)


def _usual_count(raster: CoverRaster) -> float:
    """Points of a cell where the surface was seen as it usually is; 1 at least."""
    counts = raster.counts[0]
    sample = counts[:: max(1, counts.size // 1_000_000)]
    seen = sample[sample > 0]
    return float(np.median(seen)) if seen.size else 1.0


def _of_tile(
    tile: tuple[int, int], raster: CoverRaster, usual: float, monitor: Monitor
) -> Iterator[FittedCover]:
    per, road = raster.per_tile, raster.road
    own = slice(int(road.table[tile]) * per**2, (int(road.table[tile]) + 1) * per**2)
    if not raster.counts[0, own].any():
        return
    middle = (np.array(tile) + 0.5) * TILE_M
    angle = _heading(middle, road.path)
    wide_m = TILE_M * (abs(math.cos(angle)) + abs(math.sin(angle))) + 2 * _HALO_M
    frame = _Frame(middle, angle, raster.cell_m, 2 * math.ceil(wide_m / raster.cell_m / 2))
    layers: NDArray[np.float32] = np.empty((LAYERS, frame.size, frame.size), np.float32)
    place = (*(middle / raster.cell_m).tolist(), math.cos(angle), math.sin(angle))
    window_kernel((road.table, raster.counts, raster.sums), per, place, usual, _MOST_WEIGHT, layers)
    corner = np.array(tile) * TILE_M
    places = _places(layers, raster.cell_m)
    about = frame.placed(np.array([one.cell for one in places]).reshape(-1, 2) * raster.cell_m)
    outside = np.maximum(corner - about, about - corner - TILE_M).max(axis=1)
    cells = np.empty((_MOST_CELLS, 9))
    for one, outside_m in zip(places, outside.tolist(), strict=True):
        # No edge is seen all around whose middle lies beyond the cells of its place.
        if outside_m > one.reach_m:
            continue
        monitor.check()
        cover = _fitted(layers, frame, one, cells)
        if cover is not None:
            inner = cover.middle - corner
            if (inner >= 0).all() and (inner < TILE_M).all():
                yield cover


def _heading(place: Floats, path: Floats) -> float:
    """The direction of the vehicle's way by a place, in the first quarter; 0 without one."""
    if len(path) < 2:
        return 0.0
    nearest = int(np.argmin(((path - place) ** 2).sum(axis=1)))
    first, last = max(0, nearest - 2), min(len(path) - 1, nearest + 2)
    along = path[last] - path[first]
    return math.atan2(along[1], along[0]) % (math.pi / 2)


def _places(layers: NDArray[np.float32], cell_m: float) -> list[_Place]:
    """What differs most from the road about it, the most first."""
    from scipy.ndimage import maximum_filter

    size = layers.shape[1]
    known = layers[2][layers[0] > 0]
    sums = np.zeros((size + 1, size + 1, 7))
    integral_kernel(layers, float(np.median(known)) if known.size else 0.0, sums)
    step, halo = max(1, round(_STEP_M / cell_m)), round(_HALO_M / cell_m / 1.5)
    halves = np.array([[max(2, round(q / cell_m)) for q in one] for one in _HALVES_M], np.int64)
    many = (size - 2 * halo) // step
    scores = np.zeros((len(halves), many, many))
    band = max(2, round(BAND_M / cell_m))
    contrast_kernel(sums, (halo, size - halo, step), halves, band, PATCHY, scores)
    best, which = scores.max(axis=0), scores.argmax(axis=0)
    is_peak = (best >= _LEAST_CONTRAST) & (best >= maximum_filter(best, 3))
    peaks = np.argwhere(is_peak)[np.argsort(-best[is_peak], kind="stable")]
    sizes = np.array(_HALVES_M)[which[tuple(peaks.T)]]
    kept = _apart(np.asarray(peaks * step * cell_m, np.float64), sizes)
    cells = halo + peaks[kept] * step
    return [
        _Place((a, b), (p, q))
        for (a, b), (p, q) in zip(cells.tolist(), sizes[kept].tolist(), strict=True)
    ]


def _apart(places: Floats, halves: Floats) -> NDArray[np.int64]:
    """Which boxes aren't nearly the same as one before them."""
    is_left = np.ones(len(places), np.bool_)
    apart_kernel(places, halves, _ALIKE, is_left)
    return np.flatnonzero(is_left)


def _fitted(
    layers: NDArray[np.float32], frame: _Frame, about: _Place, room: Floats
) -> FittedCover | None:
    """The better of the circle and the rectangle about a place; ``room``: for its cells."""
    at = (float(about.cell[0]), float(about.cell[1]))
    looked = LookedAt(at, about.half_m, about.reach_m, _OFF_PLANE_M, frame.cell_m)
    noise, plane, shapes = np.array(_FLOORS), np.zeros(3), np.zeros((2, 5))
    count, gain, other = fit_kernel(layers, looked, _RADII_M, room, (noise, plane, shapes))
    if max(gain, other) < _LEAST_GAIN:
        return None
    cells, place = room[:count], (frame, np.array(at) * frame.cell_m, plane)
    if other > _CORNER_COST * gain:
        return _told(cells, noise, (shapes[1], other), place)
    return _told(cells, noise, (shapes[0], gain), place)


def _told(
    cells: Floats,
    noise: Floats,
    fit: tuple[Floats, float],
    place: tuple[_Frame, Floats, Floats],
) -> FittedCover:
    shape, gain = fit
    frame, start, plane = place
    bands, core = np.zeros((SECTORS, 2, 5)), np.zeros((4, 5))
    edge_kernel(cells, shape, bands, core)
    area = math.pi * shape[2] ** 2 if shape[3] <= 0 else 4 * shape[2] * shape[3]
    slope = plane[1:] @ _turn(frame.angle_rad)
    long, wide, angle = float(shape[2]), float(shape[3]), float(shape[4])
    if wide > long:
        long, wide, angle = wide, long, angle + math.pi / 2
    return FittedCover(
        middle=frame.placed(start + shape[:2]),
        half_m=(long, wide),
        angle_rad=(angle + frame.angle_rad) % math.pi,
        gain=gain,
        edge=CoverEdge(bands, core, noise),
        plane=np.append(plane[0] + shape[:2] @ plane[1:] + core[0, 2], slope),
        filled=min(float(core[1, 0]) * frame.cell_m**2 / area, 1.0),
    )


def _turn(angle_rad: float) -> Floats:
    """What turns rows of places anticlockwise."""
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[cosine, sine], [-sine, cosine]])


def without_overlaps(covers: Sequence[FittedCover], chances: Floats) -> list[int]:
    """Which covers overlap none that is likelier, the likeliest first."""
    import shapely

    order = sorted(range(len(covers)), key=lambda one: (-chances[one], -covers[one].gain, one))
    if not order:
        return []
    areas = np.array([shapely.Polygon(covers[one].corners) for one in order])
    sizes = shapely.area(areas)
    i, j = shapely.STRtree(areas).query(areas, predicate="intersects")
    shared = shapely.area(shapely.intersection(areas[i], areas[j]))
    close = (i < j) & (shared > _SHARED * np.minimum(sizes[i], sizes[j]))
    below: dict[int, list[int]] = {}
    for one, other in zip(i[close].tolist(), j[close].tolist(), strict=True):
        below.setdefault(one, []).append(other)
    left_out: set[int] = set()
    for number in range(len(order)):
        if number not in left_out:
            left_out.update(below.get(number, ()))
    return [one for number, one in enumerate(order) if number not in left_out]

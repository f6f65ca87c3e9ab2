"""What the parts of a beam meet on their way down: surfaces, leaves and rods, with their energies.

A beam is a bundle of rays over its footprint, each standing for the energy around it. A ray ends at
a surface or at a leaf; a rod takes the share of it that it covers and lets the rest go on.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.laboratory.simulate.airborne.flight_scene import COARSE_CELLS, FlightScene
from processing.laboratory.simulate.airborne.landscapes import CELL_M, Floats

RINGS = 3
MOST_HITS = 320
"""Of one beam; 37 rays meet nine things each at most."""

_SMOOTH_M = 0.5
"""Cells that differ by less are one sloped surface, by more a step: slopes of 60° at most."""

_STEP_M = 0.1
"""How far a ray goes sideways at a time: well within a cell."""

_NEAR_M = 0.002
_LEAF_M = 0.12
"""Side of the cells of leaves and twigs: a leaf with what hangs about it."""

_CLUMP_M = 0.6
"""Side of the clumps: shoots of one branch."""

_WALL_REFLECTANCE = 0.35
_BUILDING = 6


class FootprintHits(NamedTuple):
    """What n beams meet, in the order of range.

    ``met`` (n,) int32, hits of each beam; ``range_m`` float64, ``energy`` float32 and ``code``
    uint8 (n, :data:`MOST_HITS`). An energy of 1 is a whole beam on a white surface across it.
    """

    met: NDArray[np.int32]
    range_m: Floats
    energy: NDArray[np.float32]
    code: NDArray[np.uint8]


def ray_pattern() -> Floats:
    """(37, 3): offsets of a beam's rays in radii of 1/e² of its power, and their energies."""
    rays = []
    for ring in range(RINGS + 1):
        count = max(1, 6 * ring)
        for number in range(count):
            turn = 2 * np.pi * number / count
            out = ring / RINGS * _OUTERMOST
            rays.append((out * np.cos(turn), out * np.sin(turn), np.exp(-2.0 * out**2)))
    pattern = np.array(rays)
    pattern[:, 2] /= pattern[:, 2].sum()
    return pattern


_OUTERMOST = 1.15
"""Radii: beyond lie 7 % of the power."""


def cast_beams(
    scene: FlightScene, origins: Floats, directions: Floats, radius_rad: float, turns: Floats
) -> FootprintHits:
    """What beams meet.

    Parameters
    ----------
    origins, directions : (n, 3) float64
        Frame of the scene; unit vectors that point down.
    radius_rad : float
        Half the angle of 1/e².
    turns : (n,) float64
        By which each beam's rays are turned about its axis.
    """
    n = len(origins)
    hits = FootprintHits(
        np.zeros(n, np.int32),
        np.zeros((n, MOST_HITS)),
        np.zeros((n, MOST_HITS), np.float32),
        np.zeros((n, MOST_HITS), np.uint8),
    )
    size = (scene.top_m, float(scene.surface.min()), radius_rad)
    rasters = (scene.surface, scene.code, scene.reflectance, scene.coarse)
    index = (scene.thing_starts, scene.thing_numbers)
    beams = (origins, directions, turns, ray_pattern())
    things = (scene.things.rods, scene.things.crowns)
    _cast_kernel(rasters, things, index, beams, size, hits)
    return hits


@kernel
def _uniform(a: int, b: int, c: int, d: int) -> float:
    """A number between 0 and 1 that four whole numbers alone decide (splitmix64's mixing)."""
    key = np.uint64(a & 0xFFFFF) | (np.uint64(b & 0xFFFFF) << np.uint64(20))
    key = key | (np.uint64(c & 0xFFFFF) << np.uint64(40))
    key = key + np.uint64(d + 1) * np.uint64(0x9E3779B97F4A7C15)
    key = (key ^ (key >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    key = (key ^ (key >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    key = key ^ (key >> np.uint64(31))
    return float(key >> np.uint64(11)) / 9007199254740992.0


@kernel
def _height_at(surface: NDArray[np.float32], x: float, y: float) -> float:
    """Height of the surface: sloped between cells that are alike, else the cell's own."""
    rows, columns = surface.shape
    j, i = int(y / CELL_M), int(x / CELL_M)
    if x < 0.0 or y < 0.0 or j >= rows or i >= columns:
        return -1e9
    u, v = x / CELL_M - 0.5, y / CELL_M - 0.5
    i0, j0 = int(np.floor(u)), int(np.floor(v))
    if i0 < 0 or j0 < 0 or i0 + 1 >= columns or j0 + 1 >= rows:
        return float(surface[j, i])
    a, b = float(surface[j0, i0]), float(surface[j0, i0 + 1])
    c, d = float(surface[j0 + 1, i0]), float(surface[j0 + 1, i0 + 1])
    if max(a, b, c, d) - min(a, b, c, d) > _SMOOTH_M:
        return float(surface[j, i])
    fu, fv = u - i0, v - j0
    return (a * (1 - fu) + b * fu) * (1 - fv) + (c * (1 - fu) + d * fu) * fv


@kernel
def _surface_range(
    surface: NDArray[np.float32],
    coarse: NDArray[np.float32],
    o: NDArray[np.float64],
    d: NDArray[np.float64],
    start: float,
) -> tuple[float, bool]:
    """Range at which a ray meets the surface, and whether from its side; -1 outside of it."""
    side = CELL_M * COARSE_CELLS
    across = np.sqrt(d[0] ** 2 + d[1] ** 2)
    sideways = _STEP_M / max(across, 1e-6)
    far = 0.45 * side / max(across, 1e-6)
    t, before, gap_before = start, start, 0.0
    for _ in range(20_000):
        x, y, z = o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]
        row, column = int(np.floor(y / side)), int(np.floor(x / side))
        outside = row < 0 or column < 0 or row >= coarse.shape[0] or column >= coarse.shape[1]
        if outside or z > coarse[row, column] + 0.3:
            above = 1e9 if outside else z - coarse[row, column] - 0.2
            if z < -1e3:
                return -1.0, False
            before = t
            t += min(far, above / -d[2])
            gap_before = 0.3
            continue
        gap = z - _height_at(surface, x, y)
        if gap < _NEAR_M:
            if gap > -0.05 or t == before:
                return t, False
            low, high = before, t
            for _ in range(9):
                middle = 0.5 * (low + high)
                x, y = o[0] + middle * d[0], o[1] + middle * d[1]
                if o[2] + middle * d[2] - _height_at(surface, x, y) < 0.0:
                    high = middle
                else:
                    low = middle
            x, y, z = o[0] + high * d[0], o[1] + high * d[1], o[2] + high * d[2]
            return high, _height_at(surface, x, y) - z > 0.1
        before, gap_before = t, gap
        t += min(sideways, max(gap_before, 0.5 * _NEAR_M) / -d[2])
    return -1.0, False


@kernel
def _rod_meeting(
    rod: NDArray[np.float64], o: NDArray[np.float64], d: NDArray[np.float64]
) -> tuple[float, float]:
    """Least distance between a ray and a rod's axis, and the range on the ray where it is."""
    u = rod[3:6] - rod[0:3]
    w = o - rod[0:3]
    uu, ud, uw, dw = u @ u, u @ d, u @ w, d @ w
    below = uu - ud * ud
    part = 0.0 if below < 1e-12 else (uw - ud * dw) / below
    part = min(1.0, max(0.0, part))
    t = part * ud - dw
    apart = o + t * d - rod[0:3] - part * u
    return float(np.sqrt(apart @ apart)), float(t)


@kernel
def _leaf_range(
    crown: NDArray[np.float64], number: int, o: NDArray[np.float64], d: NDArray[np.float64]
) -> tuple[float, float]:
    """Range of the first leaf on a ray through a crown, and its reflectance; -1 without."""
    start, stop = (crown[3] - o[2]) / d[2], (crown[2] - o[2]) / d[2]
    tall, radius = crown[3] - crown[2], crown[4]
    t = start + 0.5 * _LEAF_M
    while t < stop:
        x, y, z = o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]
        up = (z - crown[2]) / tall
        if crown[5] > 0.5:
            wide = radius * min(1.0 - up, 6.0 * up)
        else:
            wide = radius * np.sqrt(max(0.0, 1.0 - (2.0 * up - 1.0) ** 2))
        off = np.sqrt((x - crown[0]) ** 2 + (y - crown[1]) ** 2)
        if off < wide:
            i, j = int(np.floor(x / _CLUMP_M)), int(np.floor(y / _CLUMP_M))
            k = int(np.floor(z / _CLUMP_M))
            if _uniform(i, j, k, number) < crown[6]:
                i, j = int(np.floor(x / _LEAF_M)), int(np.floor(y / _LEAF_M))
                k = int(np.floor(z / _LEAF_M))
                # Leaves stand near the light: the outer third holds twice those of the middle.
                share = crown[7] * (0.6 + 0.6 * off / max(wide, 1e-3))
                if _uniform(i, j, k, number + 1_000_003) < share:
                    turned = 0.4 + 0.6 * _uniform(i, j, k, number + 2_000_003)
                    inside = _LEAF_M * (_uniform(i, j, k, number + 3_000_003) - 0.5)
                    return t + inside, crown[9] * turned
        t += _LEAF_M
    return -1.0, 0.0


@kernel
def _near_things(
    rods: NDArray[np.float64],
    crowns: NDArray[np.float64],
    starts: NDArray[np.int64],
    numbers: NDArray[np.int64],
    o: NDArray[np.float64],
    d: NDArray[np.float64],
    reach: tuple[float, float, float],
    shape: tuple[int, int],
    seen: NDArray[np.int64],
    beam: int,
    near: NDArray[np.int64],
) -> int:
    """Collect the things that a beam may meet; gives how many."""
    start, stop, wide = reach
    side = CELL_M * COARSE_CELLS
    step = 0.5 * side / max(np.sqrt(d[0] ** 2 + d[1] ** 2), 1e-3)
    found, t, last = 0, start, -1
    while True:
        t = min(t, stop)
        column = int(np.floor((o[0] + t * d[0]) / side))
        row = int(np.floor((o[1] + t * d[1]) / side))
        square = row * shape[1] + column
        inside = row >= 0 and column >= 0 and row < shape[0] and column < shape[1]
        if inside and square != last:
            last = square
            for at in range(starts[square], starts[square + 1]):
                thing = numbers[at]
                if seen[thing] == beam or found == near.size:
                    continue
                if thing < len(rods):
                    seen[thing] = beam
                    if _rod_meeting(rods[thing], o, d)[0] > wide + rods[thing, 6]:
                        continue
                else:
                    seen[thing] = beam
                    crown = crowns[thing - len(rods)]
                    middle = (0.5 * (crown[2] + crown[3]) - o[2]) / d[2]
                    half = 0.5 * (crown[3] - crown[2]) / -d[2]
                    across = np.sqrt(d[0] ** 2 + d[1] ** 2)
                    x, y = o[0] + middle * d[0] - crown[0], o[1] + middle * d[1] - crown[1]
                    if np.sqrt(x * x + y * y) > crown[4] + wide + half * across:
                        continue
                near[found] = thing
                found += 1
        if t >= stop:
            return found
        t += step


@kernel
def _add_event(
    events: NDArray[np.float64], count: int, t: float, share: float, reflectance: float, code: float
) -> int:
    """Sort what a ray meets into the order of range; the farthest is forgotten when full."""
    if count == len(events):
        if t >= events[count - 1, 0]:
            return count
        count -= 1
    at = count
    while at > 0 and events[at - 1, 0] > t:
        events[at] = events[at - 1]
        at -= 1
    events[at, 0], events[at, 1], events[at, 2], events[at, 3] = t, share, reflectance, code
    return count + 1


@kernel
def _ray_events(
    rasters: tuple[
        NDArray[np.float32], NDArray[np.uint8], NDArray[np.float32], NDArray[np.float32]
    ],
    things: tuple[NDArray[np.float64], NDArray[np.float64]],
    near: NDArray[np.int64],
    o: NDArray[np.float64],
    d: NDArray[np.float64],
    reach: tuple[float, float],
    events: NDArray[np.float64],
) -> int:
    """What one ray meets, in the order of range: range, share taken, reflectance, class."""
    surface, code, reflectance, coarse = rasters
    rods, crowns = things
    start, half = reach
    count = 0
    t, is_wall = _surface_range(surface, coarse, o, d, start)
    if t > 0:
        column, row = int((o[0] + t * d[0]) / CELL_M), int((o[1] + t * d[1]) / CELL_M)
        if 0 <= row < code.shape[0] and 0 <= column < code.shape[1]:
            value, kind = float(reflectance[row, column]), float(code[row, column])
            if is_wall:
                across = np.sqrt(d[0] ** 2 + d[1] ** 2)
                value = _WALL_REFLECTANCE * across if kind == _BUILDING else value
            count = _add_event(events, count, t, 1.0, value, kind)
    for thing in near:
        if thing < len(rods):
            rod = rods[thing]
            apart, t = _rod_meeting(rod, o, d)
            covered = min(apart + half, rod[6]) - max(apart - half, -rod[6])
            if covered > 0.0:
                share = min(1.0, covered / (2.0 * half))
                count = _add_event(events, count, t - rod[6], share, rod[8], rod[7])
        else:
            crown = crowns[thing - len(rods)]
            t, value = _leaf_range(crown, thing - len(rods), o, d)
            if t > 0:
                count = _add_event(events, count, t, 1.0, value, crown[8])
    return count


@kernel
def _cast_kernel(
    rasters: tuple[
        NDArray[np.float32], NDArray[np.uint8], NDArray[np.float32], NDArray[np.float32]
    ],
    things: tuple[NDArray[np.float64], NDArray[np.float64]],
    index: tuple[NDArray[np.int64], NDArray[np.int64]],
    beams: tuple[
        NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]
    ],
    size: tuple[float, float, float],
    hits: FootprintHits,
) -> None:
    rods, crowns = things
    origins, directions, turns, pattern = beams
    top, bottom, radius_rad = size
    shape = rasters[3].shape
    seen = np.full(len(rods) + len(crowns), -1, np.int64)
    near, events = np.empty(256, np.int64), np.empty((9, 4))
    ranges, energies = np.empty(MOST_HITS), np.empty(MOST_HITS)
    codes, ray = np.empty(MOST_HITS), np.empty(3)
    for beam in range(len(origins)):
        o, d = origins[beam], directions[beam]
        start, stop = (top - o[2]) / d[2], (bottom - o[2]) / d[2]
        reach = (start, stop, 1.2 * radius_rad * stop)
        count = _near_things(
            rods, crowns, index[0], index[1], o, d, reach, shape, seen, beam, near
        )  # fmt: skip
        # Two directions across the beam.
        e1 = np.array([d[2], 0.0, -d[0]])
        e1 /= np.sqrt(e1 @ e1)
        e2 = np.array([
            d[1] * e1[2] - d[2] * e1[1], d[2] * e1[0] - d[0] * e1[2], d[0] * e1[1] - d[1] * e1[0]
        ])  # fmt: skip
        cosine, sine = np.cos(turns[beam]), np.sin(turns[beam])
        half = 0.5 * radius_rad * stop * _OUTERMOST / RINGS
        met = 0
        for number in range(len(pattern)):
            a = radius_rad * (cosine * pattern[number, 0] - sine * pattern[number, 1])
            b = radius_rad * (sine * pattern[number, 0] + cosine * pattern[number, 1])
            ray[:] = d + a * e1 + b * e2
            ray /= np.sqrt(ray @ ray)
            found = _ray_events(rasters, things, near[:count], o, ray, (start, half), events)
            left = pattern[number, 2]
            for at in range(found):
                if met < MOST_HITS and left > 1e-5:
                    ranges[met] = events[at, 0]
                    energies[met] = left * events[at, 1] * events[at, 2]
                    codes[met] = events[at, 3]
                    met += 1
                    left *= 1.0 - events[at, 1]
        order = np.argsort(ranges[:met])
        hits.met[beam] = met
        for place in range(met):
            hits.range_m[beam, place] = ranges[order[place]]
            hits.energy[beam, place] = energies[order[place]]
            hits.code[beam, place] = int(codes[order[place]])

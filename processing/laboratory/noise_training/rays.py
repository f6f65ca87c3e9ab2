"""Rays against the things of a simulated street: which is met first, and how far away."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel

NUMBERS = 13  # of a thing: shape, kind, albedo, then ten that describe the shape
STRIP, BOX, CAPSULE, CROWN, PANE = range(5)
NOWHERE = 1e9
_NEAREST_M = 0.05


class RangeHits(NamedTuple):
    """``ranges`` (n,) m, `NOWHERE` where nothing was met; ``things`` (n,) their rows, or −1."""

    ranges: Floats
    things: Integers


def thing(shape: int, kind: int, albedo: float, *numbers: float) -> list[float]:
    """A row that describes a thing.

    Parameters
    ----------
    shape : int
        `STRIP`: endless along x, between (y, z) and (y, z). `BOX`: centre, half sizes, yaw.
        `CAPSULE`: both ends, radius. `CROWN`: centre, radii, mean way that a beam goes in it.
        `PANE`: upright rectangle: centre, direction of its normal, half width, half height.
    """
    return [float(shape), float(kind), albedo, *numbers, *[0.0] * (10 - len(numbers))]


def trace_rays(
    origins: Floats,
    directions: Floats,
    things: Floats,
    footprint: float,
    chances: Floats,
) -> RangeHits:
    """What rays meet first.

    Parameters
    ----------
    origins, directions : (n, 3) float64
        m; unit vectors.
    things : (k, NUMBERS) float64
    footprint : float
        By how many metres a thin thing is wider for the beam, per metre of range.
    chances : (n, 2) float64
        0 to 1: whether the rim of a beam returns, and how deep it enters a crown.
    """
    met = RangeHits(np.full(len(origins), NOWHERE), np.full(len(origins), -1, np.int64))
    rays_kernel(origins, directions, things, footprint, chances, met.ranges, met.things)
    return met


@kernel
def rays_kernel(
    origins: Floats,
    directions: Floats,
    things: Floats,
    footprint: float,
    chances: Floats,
    ranges: Floats,
    found: Integers,
) -> None:
    """See :func:`trace_rays`."""
    for ray in range(origins.shape[0]):
        for number in range(things.shape[0]):
            row = things[number]
            shape = int(row[0])
            if shape == STRIP:
                reach = _strip(origins[ray], directions[ray], row)
            elif shape == BOX:
                reach = _box(origins[ray], directions[ray], row)
            elif shape == CAPSULE:
                reach = _capsule(origins[ray], directions[ray], row, footprint, chances[ray, 0])
            elif shape == CROWN:
                chance = chances[ray, 1] * 7919.0 * (number + 1)
                reach = _crown(origins[ray], directions[ray], row, chance - math.floor(chance))
            else:
                reach = _pane(origins[ray], directions[ray], row)
            if _NEAREST_M < reach < ranges[ray]:
                ranges[ray] = reach
                found[ray] = number


@kernel
def _strip(origin: Floats, way: Floats, row: Floats) -> float:
    y0, z0, y1, z1 = row[3], row[4], row[5], row[6]
    ny, nz = z0 - z1, y1 - y0
    steep = ny * way[1] + nz * way[2]
    if abs(steep) < 1e-9:
        return NOWHERE
    reach = (ny * (y0 - origin[1]) + nz * (z0 - origin[2])) / steep
    if abs(y1 - y0) > abs(z1 - z0):
        at, one, other = origin[1] + reach * way[1], y0, y1
    else:
        at, one, other = origin[2] + reach * way[2], z0, z1
    return reach if min(one, other) <= at < max(one, other) else NOWHERE


@kernel
def _box(origin: Floats, way: Floats, row: Floats) -> float:
    c, s = math.cos(row[9]), math.sin(row[9])
    x, y = origin[0] - row[3], origin[1] - row[4]
    near, far = -1e18, 1e18
    for axis in range(3):
        if axis == 0:
            start, step = c * x + s * y, c * way[0] + s * way[1]
        elif axis == 1:
            start, step = c * y - s * x, c * way[1] - s * way[0]
        else:
            start, step = origin[2] - row[5], way[2]
        half = row[6 + axis]
        if abs(step) < 1e-12:
            step = 1e-12
        one, other = (-half - start) / step, (half - start) / step
        near, far = max(near, min(one, other)), min(far, max(one, other))
    return near if near <= far else NOWHERE


@kernel
def _capsule(origin: Floats, way: Floats, row: Floats, footprint: float, chance: float) -> float:
    ax, ay, az = row[6] - row[3], row[7] - row[4], row[8] - row[5]
    length = math.sqrt(ax * ax + ay * ay + az * az)
    ax, ay, az = ax / length, ay / length, az / length
    x, y, z = origin[0] - row[3], origin[1] - row[4], origin[2] - row[5]
    along = way[0] * ax + way[1] * ay + way[2] * az
    ahead = way[0] * x + way[1] * y + way[2] * z
    beside = ax * x + ay * y + az * z
    square = 1 - along * along
    if square < 1e-6:
        return NOWHERE
    reach: float = (along * beside - ahead) / square
    position = (beside - along * ahead) / square
    if reach <= 0 or position < 0 or position > length:
        return NOWHERE
    x += reach * way[0] - position * ax
    y += reach * way[1] - position * ay
    z += reach * way[2] - position * az
    gap = math.sqrt(x * x + y * y + z * z)
    radius = row[9]
    wide = radius + footprint * reach
    if gap >= wide or (gap > radius and chance < 0.4 * (gap - radius) / max(wide - radius, 1e-9)):
        return NOWHERE
    return reach - math.sqrt(max(radius * radius - gap * gap, 0.0) / square)


@kernel
def _crown(origin: Floats, way: Floats, row: Floats, chance: float) -> float:
    a, b, c = 0.0, 0.0, -1.0
    for axis in range(3):
        start = (origin[axis] - row[3 + axis]) / row[6 + axis]
        step = way[axis] / row[6 + axis]
        a += step * step
        b += start * step
        c += start * start
    inner = b * b - a * c
    if inner <= 0:
        return NOWHERE
    near, far = (-b - math.sqrt(inner)) / a, (-b + math.sqrt(inner)) / a
    reach = near - row[9] * math.log(max(chance, 1e-12))
    return reach if near > _NEAREST_M and reach <= far else NOWHERE


@kernel
def _pane(origin: Floats, way: Floats, row: Floats) -> float:
    nx, ny = math.cos(row[6]), math.sin(row[6])
    steep: float = nx * way[0] + ny * way[1]
    if abs(steep) < 1e-9:
        return NOWHERE
    reach: float = (nx * (row[3] - origin[0]) + ny * (row[4] - origin[1])) / steep
    x, y = origin[0] + reach * way[0] - row[3], origin[1] + reach * way[1] - row[4]
    z = origin[2] + reach * way[2] - row[5]
    if abs(nx * y - ny * x) > row[7] or abs(z) > row[8]:
        return NOWHERE
    return reach


def warm_up() -> None:
    """Compile the kernels."""
    row = np.array([thing(PANE, 0, 0.5, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0)])
    trace_rays(np.zeros((1, 3)), np.eye(3)[:1], row, 0.0, np.zeros((1, 2)))

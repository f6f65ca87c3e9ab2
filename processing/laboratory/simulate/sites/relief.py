"""What shapes ground on a site, each as a change of heights over plane coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.random import Generator
from numpy.typing import ArrayLike, NDArray

from processing.laboratory.simulate.scene.mesh import Floats

Mask = NDArray[np.bool_]

_NEAR_M = 4.0
_SPREAD = 0.45  # of a cubic B-spline through independent numbers of spread 1


def undulation(random: Generator, x: Floats, y: Floats, wave_m: float) -> Floats:
    """Smooth random heights of standard deviation 1 with bumps of a given width.

    Parameters
    ----------
    x, y : (rows, columns) float64
        m; a regular grid.
    """
    wide, high = float(np.ptp(x)), float(np.ptp(y))
    shape = (int(high / wave_m) + 6, int(wide / wave_m) + 6)
    lattice = random.normal(size=shape)
    shift = random.uniform(1.5, 2.5, 2)
    rows, of_rows = _spline((y[:, 0] - y[0, 0]) / wave_m + shift[0])
    columns, of_columns = _spline((x[0] - x[0, 0]) / wave_m + shift[1])
    partly = sum(of_rows[k][:, None] * lattice[rows + k] for k in range(4))
    smooth = np.zeros(x.shape)
    for k in range(4):
        smooth += of_columns[k] * np.take(partly, columns + k, axis=1)
    return smooth / _SPREAD


def _spline(positions: Floats) -> tuple[NDArray[np.int64], Floats]:
    """First of four lattice points about each place, and the weights of a cubic B-spline."""
    whole = np.floor(positions).astype(np.int64)
    t = positions - whole
    weights = [(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, 1 + 3 * t + 3 * t**2 - 3 * t**3, t**3]
    return whole - 1, np.stack(weights) / 6


def distance_to_path(x: Floats, y: Floats, path: Floats) -> tuple[Floats, Floats]:
    """Distance from a path and distance along it of every node within 4 m.

    Parameters
    ----------
    path : (n, 2) float64

    Returns
    -------
    signed : (rows, columns) float64
        m, positive to the left; infinite where the path is farther.
    along : (rows, columns) float64
        m from the path's beginning; 0 where it is farther.
    """
    signed, along = np.full(x.shape, np.inf), np.zeros(x.shape)
    run = 0.0
    for start, end in pairwise(path):
        direction = end - start
        span = float(np.hypot(*direction))
        if span == 0:
            continue
        direction = direction / span
        low, high = np.minimum(start, end) - _NEAR_M, np.maximum(start, end) + _NEAR_M
        columns = slice(*np.searchsorted(x[0], [low[0], high[0]]))
        rows = slice(*np.searchsorted(y[:, 0], [low[1], high[1]]))
        dx, dy = x[rows, columns] - start[0], y[rows, columns] - start[1]
        share = np.clip(dx * direction[0] + dy * direction[1], 0, span)
        away = np.hypot(dx - share * direction[0], dy - share * direction[1])
        best = np.abs(signed[rows, columns])
        nearer = (away < best) & (away < _NEAR_M)
        side = np.where(direction[0] * dy - direction[1] * dx >= 0, 1.0, -1.0)
        signed[rows, columns] = np.where(nearer, side * away, signed[rows, columns])
        along[rows, columns] = np.where(nearer, run + share, along[rows, columns])
        run += span
    return signed, along


def _near_path(x: Floats, y: Floats, path: Floats) -> tuple[Mask, Floats, Floats]:
    """Nodes near a path, and of these alone their distances from it and along it."""
    signed, along = distance_to_path(x, y, path)
    near = np.isfinite(signed)
    return near, signed[near], along[near]


def wander(random: Generator, start: ArrayLike, end: ArrayLike, sway: float) -> Floats:
    """A path between two places that swings from side to side: (n, 2) float64."""
    first, last = np.asarray(start, np.float64), np.asarray(end, np.float64)
    direction = last - first
    span = max(float(np.hypot(*direction)), 1e-6)
    count = int(np.clip(span / 1.2, 16, 60))
    shares = np.linspace(0, 1, count)
    side = np.array([-direction[1], direction[0]]) / span
    swing = (
        sway * np.sin(shares * random.uniform(2, 7) + random.uniform(0, 6)) * np.sin(np.pi * shares)
    )
    return np.asarray(first + shares[:, None] * direction + swing[:, None] * side, np.float64)


def ruts(random: Generator, z: Floats, x: Floats, y: Floats, path: Floats) -> Mask:
    """Two wheel tracks along a path, pressed into the heights; gives where the track is."""
    gauge, wide = random.uniform(1.6, 2.2), random.uniform(0.25, 0.55)
    deep = random.uniform(0.02, 0.14)
    near, away, along = _near_path(x, y, path)
    wave = 1 + 0.5 * np.sin(along / random.uniform(1.5, 5)) * np.sin(along / random.uniform(3, 9))
    fade = np.clip(along / 2, 0, 1)
    for side in (-1, 1):
        beside = np.abs(away - side * gauge / 2) / wide
        pressed = np.exp(-((beside / 0.55) ** 4))
        bank = np.exp(-(((beside - 1.0) / 0.3) ** 2))  # what was pressed out lies beside it
        z[near] -= deep * wave * fade * (pressed - 0.3 * bank)
    track = np.zeros(z.shape, np.bool_)
    track[near] = np.abs(away) < gauge / 2 + wide
    return track


def add_crawler_prints(random: Generator, z: Floats, x: Floats, y: Floats, path: Floats) -> None:
    """The prints of a crawler's two chains: shallow with ribs square to the way."""
    gauge, wide = random.uniform(1.8, 2.6), random.uniform(0.5, 0.7)
    deep, rib = random.uniform(0.01, 0.04), random.uniform(0.3, 0.45)
    near, away, along = _near_path(x, y, path)
    for side in (-1, 1):
        under = np.abs(away - side * gauge / 2) < wide / 2
        z[near] -= np.where(under, deep * (1 + 0.6 * np.sign(np.sin(2 * np.pi * along / rib))), 0)


def heap(random: Generator, z: Floats, x: Floats, y: Floats, where: Sequence[float]) -> Mask:
    """A spoil heap tipped at its angle of repose, mostly of several loads; gives where it lies."""
    base = z.copy()
    loads = int(random.integers(1, 6))
    repose = np.tan(np.radians(random.uniform(28, 38)))
    turn, stretch = random.uniform(0, np.pi), random.uniform(0.7, 1.0)
    for load in range(loads):
        off = random.normal(0, 1.0, 2) * (load > 0) * random.uniform(0.8, 2.2)
        dx, dy = x - where[0] - off[0], y - where[1] - off[1]
        u, v = np.cos(turn) * dx + np.sin(turn) * dy, -np.sin(turn) * dx + np.cos(turn) * dy
        high = random.uniform(0.5, 2.3)
        ragged = 0.22 * undulation(random, x, y, 1.1)
        cone = high - repose * np.maximum(np.hypot(u * stretch, v) + ragged, 0.0)
        rounded = np.minimum(cone, high * 0.85 + 0.15 * cone)
        np.maximum(z, base + rounded, out=z)
    covered = np.asarray(z > base + 0.01, np.bool_)
    clods = undulation(random, x, y, 0.35) * random.uniform(0.01, 0.04)
    z += np.where(covered, clods, 0.0)
    return covered


def ditch(random: Generator, z: Floats, x: Floats, y: Floats, path: Floats) -> Mask:
    """A trench with battered sides along a path, its soil beside it now and then."""
    deep, half = random.uniform(0.3, 1.1), random.uniform(0.2, 0.5)
    batter = random.uniform(0.1, 0.7)
    near, away, along = _near_path(x, y, path)
    ends = np.clip((along - 0.01) / 0.2, 0, 1)
    dug = np.clip((half + deep * batter - np.abs(away)) / batter, 0, deep) * ends
    z[near] -= dug
    if random.random() < 0.5:
        side = random.choice([-1.0, 1.0]) * (half + deep * batter + random.uniform(0.6, 1.2))
        bank = np.clip(0.45 * deep - 0.65 * np.abs(away - side), 0, None)
        z[near] += bank * ends * (1 + 0.3 * np.sin(along * 1.7))
    trench = np.zeros(z.shape, np.bool_)
    trench[near] = dug > 0.02
    return trench


def step(random: Generator, z: Floats, x: Floats, y: Floats, where: Sequence[float]) -> None:
    """A pit with steep edges: where someone has begun to dig."""
    turn = random.uniform(0, np.pi)
    wide, long = random.uniform(1.0, 4.0, 2)
    deep = random.uniform(0.25, 1.2)
    batter = random.uniform(0.05, 0.6)
    dx, dy = x - where[0], y - where[1]
    u, v = np.cos(turn) * dx + np.sin(turn) * dy, -np.sin(turn) * dx + np.cos(turn) * dy
    corner = random.uniform(2.5, 9.0)  # of a superellipse: dug by a bucket, never quite square
    ragged = 0.08 * undulation(random, x, y, 0.6)
    within = (1 - (np.abs(u / long) ** corner + np.abs(v / wide) ** corner) ** (1 / corner)) * wide
    within = within + ragged
    z -= np.clip(within / batter, 0, deep)


def puddle(random: Generator, z: Floats, x: Floats, y: Floats, where: Sequence[float]) -> Mask:
    """Water that fills a hollow up to a level; gives where it stands.

    The water's surface is the ground that a surveyor can see there, and truth takes it as such.
    """
    reach = random.uniform(0.8, 3.0)
    near = np.hypot(x - where[0], y - where[1]) < reach
    if near.sum() < 10:
        return np.zeros(z.shape, np.bool_)
    level = float(np.quantile(z[near], random.uniform(0.15, 0.45)))
    if float(np.ptp(z[near])) > 0.6:
        return np.zeros(z.shape, np.bool_)  # water does not stay on a slope
    wet = near & (z < level)
    z[wet] = level
    return np.asarray(wet, np.bool_)

"""Loops over the cells on both sides of a cover's edge, and over its sectors."""

from __future__ import annotations

import math

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.methods.road.covers.shape_kernels import BAND_M

SECTORS = 12
"""Of a cover's edge."""


@kernel
def depth_of(cell: Floats, shape: Floats) -> float:
    """How far a cell's middle lies within a shape's edge; negative outside.

    ``shape``: middle, half length and half width, angle; a half width of 0 makes it a circle.
    """
    x, y = cell[0] - shape[0], cell[1] - shape[1]
    if shape[3] <= 0.0:
        return float(shape[2] - math.sqrt(x * x + y * y))
    cosine, sine = math.cos(shape[4]), math.sin(shape[4])
    along, across = abs(x * cosine + y * sine), abs(y * cosine - x * sine)
    return float(min(shape[2] - along, shape[3] - across))


@kernel
def edge_kernel(cells: Floats, shape: Floats, found: Floats, core: Floats) -> None:
    """What lies inside and outside of a shape's edge, sector by sector, and within.

    ``found``: (SECTORS, 2, 5) of the bands inside and outside: weight, tone, height, weight of all,
    share below. ``core``: (4, 5) the same of all that lies inside; number of its cells and weighted
    squares of their tones and heights; the same as the first of the halves of the bands that are
    next to the edge, inside and outside.
    """
    found[:] = 0.0
    core[:] = 0.0
    for k in range(len(cells)):
        depth = depth_of(cells[k], shape)
        w, v = cells[k, 5], cells[k, 6]
        t, h = cells[k, 2], cells[k, 3]
        if depth > 0.02:
            core[0, 0] += w
            core[0, 1] += w * t
            core[0, 2] += w * h
            core[0, 3] += v
            core[0, 4] += v * cells[k, 4]
            core[1, 0] += 1.0
            core[1, 1] += w * t * t
            core[1, 2] += w * h * h
        if not -BAND_M < depth < BAND_M or abs(depth) < 0.015:
            continue
        x, y = cells[k, 0] - shape[0], cells[k, 1] - shape[1]
        if shape[3] > 0.0:
            cosine, sine = math.cos(shape[4]), math.sin(shape[4])
            x, y = (x * cosine + y * sine) / shape[2], (y * cosine - x * sine) / shape[3]
        if abs(depth) < BAND_M / 2:
            near = core[2 if depth > 0 else 3]
            near[0] += w
            near[1] += w * t
            near[2] += w * h
            near[3] += v
            near[4] += v * cells[k, 4]
        sector = int((math.atan2(y, x) / (2 * math.pi) + 0.5) * SECTORS) % SECTORS
        side = 0 if depth > 0 else 1
        found[sector, side, 0] += w
        found[sector, side, 1] += w * t
        found[sector, side, 2] += w * h
        found[sector, side, 3] += v
        found[sector, side, 4] += v * cells[k, 4]
    for sector in range(SECTORS):
        for side in range(2):
            _to_means(found[sector, side])
    for row in (0, 2, 3):
        _to_means(core[row])


@kernel
def edge_means_kernel(bands: Floats, least: float, told: Floats) -> None:
    """Means and standard deviations over the sectors of an edge that hold enough.

    ``bands``: of `edge_kernel`; ``least``: weight of a band that says something. ``told`` (9,):
    inside less outside of tone, height and share below; how much the first two differ from sector
    to sector; the same of the band outside alone; of the tone inside; the share of sectors seen.
    """
    off, count = np.zeros((6, SECTORS)), np.zeros(6, np.int64)
    for sector in range(SECTORS):
        inner, outer = bands[sector, 0], bands[sector, 1]
        if inner[0] >= least and outer[0] >= least:
            _note(off, count, 0, inner[1] - outer[1])
            _note(off, count, 1, inner[2] - outer[2])
        if inner[3] >= least and outer[3] >= least:
            _note(off, count, 2, inner[4] - outer[4])
        if outer[0] >= least:
            _note(off, count, 3, outer[1])
            _note(off, count, 4, outer[2])
        if inner[0] >= least:
            _note(off, count, 5, inner[1])
    means, spreads = np.zeros(6), np.zeros(6)
    for one in range(6):
        if count[one] > 0:
            means[one] = off[one, : count[one]].mean()
            spreads[one] = off[one, : count[one]].std()
    told[:3], told[3:5], told[5:8] = means[:3], spreads[:2], spreads[3:]
    told[8] = count[2] / SECTORS


@kernel
def _note(values: Floats, count: Integers, row: int, value: float) -> None:
    values[row, count[row]] = value
    count[row] += 1


@kernel
def _to_means(sums: Floats) -> None:
    if sums[0] > 0:
        sums[1] /= sums[0]
        sums[2] /= sums[0]
    if sums[3] > 0:
        sums[4] /= sums[3]

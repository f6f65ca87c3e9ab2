"""Cut and fill between two triangulated grounds, exact: no sampling, no cells cut in half.

Inside every triangle the difference of both surfaces is linear. The triangle is clipped at the
polygon's edge and where the difference changes its sign; what is left is a polygon under a plane,
whose volume is its area times the plane's height at its centroid. Clipped figures may fold back
on themselves; their fans count with signs, so that the sums stay right.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.core.kernels import kernel
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.sites.heights import HeightGrid

SEEN_CELL_M = 0.5
_MOST_CORNERS = 64


@dataclass(frozen=True)
class CutAndFill:
    """Volumes in square blocks of nodes, the site's frame; row = north, column = east.

    Attributes
    ----------
    cut_m3, fill_m3, area_m2 : (rows, columns) float64
        Inside the polygon only.
    block_m : float
        Side of a block.
    """

    cut_m3: Floats
    fill_m3: Floats
    area_m2: Floats
    block_m: float


def cut_and_fill(before: HeightGrid, after: HeightGrid, polygon: Floats) -> CutAndFill:
    """Volumes between two grounds on the same nodes.

    Parameters
    ----------
    polygon : (n, 2) float64
        Corners in order, not closed, the site's frame, m; n at most 56.

    Raises
    ------
    ValueError
        The grounds have other nodes than each other, or the polygon has too many corners.
    """
    if before.z.shape != after.z.shape or before.res != after.res:
        raise ValueError("the nodes of both dates differ")
    if len(polygon) > _MOST_CORNERS - 8:
        raise ValueError("too many corners")
    per_block = max(1, round(SEEN_CELL_M / before.res))
    rows, columns = (-(-(count - 1) // per_block) for count in before.z.shape)
    cut, fill, area = (np.zeros((rows, columns)) for _ in range(3))
    difference = after.z.astype(np.float64) - before.z.astype(np.float64)
    corners = np.asarray(polygon, np.float64)
    twice = np.sum(
        corners[:, 0] * np.roll(corners[:, 1], -1) - np.roll(corners[:, 0], -1) * corners[:, 1]
    )
    ring = np.ascontiguousarray(corners if twice > 0 else corners[::-1])
    _volume_kernel(difference, before.res, ring, per_block, cut, fill, area)
    return CutAndFill(cut, fill, area, per_block * before.res)


def warm_up() -> None:
    """Compile the kernels."""
    flat = HeightGrid(np.zeros((3, 3), np.float32), 0.5)
    cut_and_fill(flat, flat, np.array([[0.1, 0.1], [0.9, 0.1], [0.5, 0.9]]))


@kernel
def _clip_kernel(
    figure: Floats, count: int, line: tuple[float, float, float], clipped: Floats
) -> int:
    """Keep where a x + b y + c >= 0 (Sutherland and Hodgman 1974); gives the corners left."""
    left = 0
    a, b, c = line
    for one in range(count):
        other = one + 1 if one + 1 < count else 0
        here = a * figure[one, 0] + b * figure[one, 1] + c
        there = a * figure[other, 0] + b * figure[other, 1] + c
        if here >= 0.0:
            clipped[left, 0] = figure[one, 0]
            clipped[left, 1] = figure[one, 1]
            left += 1
        if (here >= 0.0) != (there >= 0.0):
            share = here / (here - there)
            clipped[left, 0] = figure[one, 0] + share * (figure[other, 0] - figure[one, 0])
            clipped[left, 1] = figure[one, 1] + share * (figure[other, 1] - figure[one, 1])
            left += 1
    return left


@kernel
def _under_plane_kernel(
    figure: Floats, count: int, plane: tuple[float, float, float]
) -> tuple[float, float]:
    """Area and volume under z = p x + q y + r of a figure, by a fan with signs."""
    area = 0.0
    volume = 0.0
    p, q, r = plane
    x0, y0 = figure[0, 0], figure[0, 1]
    for one in range(1, count - 1):
        x1, y1 = figure[one, 0], figure[one, 1]
        x2, y2 = figure[one + 1, 0], figure[one + 1, 1]
        part = 0.5 * ((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0))
        area += part
        volume += part * (p * (x0 + x1 + x2) / 3.0 + q * (y0 + y1 + y2) / 3.0 + r)
    return area, volume


@kernel
def _relation_kernel(ring: Floats, x: float, y: float, reach: float) -> int:
    """1 inside and farther than reach from the edge, -1 outside so, 0 near the edge."""
    is_inside = False
    count = ring.shape[0]
    for one in range(count):
        other = one + 1 if one + 1 < count else 0
        x0, y0 = ring[one, 0], ring[one, 1]
        dx, dy = ring[other, 0] - x0, ring[other, 1] - y0
        share = ((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy)
        share = min(1.0, max(0.0, share))
        away_x, away_y = x - x0 - share * dx, y - y0 - share * dy
        if away_x * away_x + away_y * away_y <= reach * reach:
            return 0
        if (y0 > y) != (y0 + dy > y) and x < x0 + dx * (y - y0) / dy:
            is_inside = not is_inside
    return 1 if is_inside else -1


@kernel
def _half_kernel(ring: Floats, corner: tuple[float, float, float], half: int, work: Floats) -> int:
    """What of one half of a cell is inside the polygon, in the cell's own frame: ``work[0]``."""
    x, y, res = corner
    count = ring.shape[0]
    for one in range(count):
        work[0, one, 0] = ring[one, 0] - x
        work[0, one, 1] = ring[one, 1] - y
    if half == 0:
        count = _clip_kernel(work[0], count, (0.0, 1.0, 0.0), work[1])
        count = _clip_kernel(work[1], count, (-1.0, 0.0, res), work[2])
        return _clip_kernel(work[2], count, (1.0, -1.0, 0.0), work[0])
    count = _clip_kernel(work[0], count, (1.0, 0.0, 0.0), work[1])
    count = _clip_kernel(work[1], count, (0.0, -1.0, res), work[2])
    return _clip_kernel(work[2], count, (-1.0, 1.0, 0.0), work[0])


@kernel
def _whole_half_kernel(res: float, half: int, work: Floats) -> int:
    """One half of a cell: ``work[0]``."""
    work[0, 0, 0], work[0, 0, 1] = 0.0, 0.0
    work[0, 1 + half, 0], work[0, 1 + half, 1] = res * (1 - half), res * half
    work[0, 2 - half, 0], work[0, 2 - half, 1] = res, res
    return 3


@kernel
def _volume_kernel(
    difference: Floats,
    res: float,
    ring: Floats,
    per_block: int,
    cut: Floats,
    fill: Floats,
    area: Floats,
) -> None:
    rows, columns = difference.shape
    work = np.empty((3, _MOST_CORNERS * 2, 2))
    for cell in range((rows - 1) * (columns - 1)):
        j, i = cell // (columns - 1), cell % (columns - 1)
        # In the cell's own frame, so that large coordinates cost no digits.
        x, y = i * res, j * res
        relation = _relation_kernel(ring, x + res / 2, y + res / 2, res)
        if relation < 0:
            continue
        low, high = difference[j, i], difference[j + 1, i + 1]
        right, up = difference[j, i + 1], difference[j + 1, i]
        bj, bi = j // per_block, i // per_block
        for half in range(2):
            plane = ((high - up) / res, (up - low) / res, low)
            if half == 0:
                plane = ((right - low) / res, (high - right) / res, low)
            if relation > 0:
                count = _whole_half_kernel(res, half, work)
            else:
                count = _half_kernel(ring, (x, y, res), half, work)
            area[bj, bi] += _under_plane_kernel(work[0], count, plane)[0]
            risen = _clip_kernel(work[0], count, plane, work[1])
            fill[bj, bi] += _under_plane_kernel(work[1], risen, plane)[1]
            fallen = (-plane[0], -plane[1], -plane[2])
            sunk = _clip_kernel(work[0], count, fallen, work[1])
            cut[bj, bi] += _under_plane_kernel(work[1], sunk, fallen)[1]

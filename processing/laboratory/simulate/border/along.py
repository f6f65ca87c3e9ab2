"""Bodies of one cross section along the road: walls, rails, pipes, beams."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape, grid, plate
from processing.laboratory.simulate.street.section import StreetSection

_STEP_M = 1.0


def stations(from_m: float, to_m: float, step_m: float = _STEP_M) -> Floats:
    """Chainages from one place to another, at most a step apart."""
    return np.linspace(from_m, to_m, max(2, int(np.ceil((to_m - from_m) / step_m)) + 1))


def sweep_section(
    section: StreetSection,
    chainages: Floats,
    offset_m: float | Floats,
    outline: Sequence[tuple[float, float]] | Floats,
    *,
    is_closed: bool = True,
    sunk: Floats | float = 0.0,
) -> TriangleShape:
    """A cross section led along the road, over the ground's height on one line.

    Parameters
    ----------
    chainages : (n,) float64
    offset_m : float or (n,) float64
        Of the line, m to the left of the road's centre.
    outline : (k, 2) float
        Metres away from the road and above the ground, in order around the body.
    is_closed : bool
        Whether the last corner is joined to the first and both ends are shut; else a sheet.
    sunk : float or (n,) float64
        How far the body lies lower, m.
    """
    corners = np.asarray(outline, np.float64)
    if is_closed:
        corners = np.concatenate([corners, corners[:1]])
    offsets = np.broadcast_to(offset_m, chainages.shape)
    base = section.ground.height(chainages, offsets) - sunk
    away = np.sign(offsets.mean()) or 1.0
    rows = section.alignment.at(
        chainages[:, None],
        offsets[:, None] + away * corners[None, :, 0],
        base[:, None] + corners[None, :, 1],
    )
    vertices, triangles = grid(rows)
    if not is_closed:
        return vertices, triangles
    count = len(corners)
    fan = plate(rows[0, :-1])[1]
    far = fan + (len(rows) - 1) * count
    return vertices, np.concatenate([triangles, fan, far])


def wall(thick_m: float, high_m: float, below_m: float = 0.3) -> list[tuple[float, float]]:
    """The outline of an upright wall."""
    return [(0.0, -below_m), (0.0, high_m), (thick_m, high_m), (thick_m, -below_m)]


def pipe(radius_m: float, above_m: float, sides: int = 6) -> Floats:
    """The outline of a pipe at a height."""
    angles = np.arange(sides) * 2 * np.pi / sides
    return np.column_stack([radius_m * np.cos(angles), above_m + radius_m * np.sin(angles)])


def posts(
    feet: Floats, radius_m: float, heights_m: Floats | float, sides: int = 8, below_m: float = 0.3
) -> TriangleShape:
    """Upright round posts.

    Parameters
    ----------
    feet : (n, 3) float64
        On the ground, m.
    heights_m : float or (n,) float64
        Above it.
    """
    angles = np.arange(sides) * 2 * np.pi / sides
    ring = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(sides)]) * radius_m
    low = feet[:, None] + ring - [0.0, 0.0, below_m]
    high = feet[:, None] + ring
    high[..., 2] += np.broadcast_to(heights_m, len(feet))[:, None]
    one = np.arange(sides)
    other = (one + 1) % sides
    rest = np.arange(1, sides - 1)
    single = np.concatenate(
        [
            np.column_stack([one, other, one + sides]),
            np.column_stack([other, other + sides, one + sides]),
            np.column_stack([np.full(sides - 2, sides), sides + rest, sides + rest + 1]),
        ]
    )
    vertices = np.concatenate([low, high], axis=1).reshape(-1, 3)
    triangles = (np.arange(len(feet))[:, None, None] * 2 * sides + single).reshape(-1, 3)
    return vertices, triangles

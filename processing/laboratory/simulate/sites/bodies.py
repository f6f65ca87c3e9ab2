"""Things that stand on a site, in frames of their own: x forward, y left, z up from the ground."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape, box

OTHER = 1


class SiteKind(IntEnum):
    """What a point is of, as the truth's files number it."""

    DUST = -3
    GHOST = -2
    TERRAIN = 0
    EXCAVATOR = 1
    DUMP_TRUCK = 2
    BULLDOZER = 3
    WORKER = 4
    MATERIAL = 5
    FENCE = 6
    SCAFFOLD = 7
    BRUSH = 8
    NET = 9
    GRASS = 10
    HUT = 11
    ROLLER = 12
    BATTER_BOARD = 13
    SURVEY_POLE = 14
    CONE = 15


NAMES = {kind: kind.name.lower().replace("_", " ") for kind in SiteKind}

SitePart = tuple[TriangleShape, Material]


@dataclass(frozen=True)
class SiteBody:
    """One thing.

    Attributes
    ----------
    parts : tuple of (Shape, Material)
    footing_m : tuple of float
        Half its length and half its width where it stands: it tilts as the ground under it does;
        0 for what stands upright whatever the ground does.
    """

    kind: SiteKind
    parts: tuple[SitePart, ...]
    footing_m: tuple[float, float] = (0.0, 0.0)

    @property
    def radius_m(self) -> float:
        """Of its outline about its own origin."""
        return max(float(np.hypot(shape[0][:, 0], shape[0][:, 1]).max()) for shape, _ in self.parts)


def block(low: ArrayLike, high: ArrayLike, material: Material) -> SitePart:
    """A box as a part."""
    return box(np.asarray(low).tolist(), np.asarray(high).tolist()), material


def rotate_part(part: SitePart, axis: int, angle_rad: float, about: ArrayLike) -> SitePart:
    """A part turned about an axis (0 x, 1 y, 2 z) through a place."""
    (vertices, triangles), material = part
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    one, other = ((1, 2), (2, 0), (0, 1))[axis]
    local = vertices - np.asarray(about, np.float64)
    spun = local.copy()
    spun[:, one] = c * local[:, one] - s * local[:, other]
    spun[:, other] = s * local[:, one] + c * local[:, other]
    return (spun + np.asarray(about, np.float64), triangles), material


def shift_parts(parts: Iterable[SitePart], by: ArrayLike) -> tuple[SitePart, ...]:
    """Parts shifted together."""
    offset = np.asarray(by, np.float64)
    return tuple(
        ((vertices + offset, triangles), material) for (vertices, triangles), material in parts
    )


def slab(outline: Floats, thick_m: float) -> TriangleShape:
    """A convex outline in the x-z plane, thick along y about y = 0.

    Parameters
    ----------
    outline : (n, 2) float64
        x and z in order.
    """
    count = len(outline)
    low = np.column_stack([outline[:, 0], np.full(count, -thick_m / 2), outline[:, 1]])
    high = low + np.array([0.0, thick_m, 0.0])
    rest = np.arange(1, count - 1)
    fan = np.column_stack([np.zeros_like(rest), rest, rest + 1])
    one = np.arange(count)
    other = (one + 1) % count
    rim = np.concatenate(
        [
            np.column_stack([one, other, other + count]),
            np.column_stack([one, other + count, one + count]),
        ]
    )
    return np.concatenate([low, high]), np.concatenate([fan, fan[:, ::-1] + count, rim])


def beam(start: ArrayLike, end: ArrayLike, wide_m: float, high_m: float) -> TriangleShape:
    """A straight bar of rectangular section between two places."""
    first, last = np.asarray(start, np.float64), np.asarray(end, np.float64)
    direction = last - first
    span = float(np.linalg.norm(direction))
    direction = direction / span
    side = np.cross([0.0, 0.0, 1.0], direction)
    if np.linalg.norm(side) < 1e-6:
        side = np.array([0.0, 1.0, 0.0])
    side /= np.linalg.norm(side)
    up = np.cross(direction, side)
    vertices, triangles = box((0, -wide_m / 2, -high_m / 2), (span, wide_m / 2, high_m / 2))
    return first + vertices @ np.stack([direction, side, up]), triangles

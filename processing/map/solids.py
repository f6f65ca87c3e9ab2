"""Areas that are the top of a body, such as lids and gratings, as solids of some thickness.

The 3D view and drawings show the same bodies, so they are made here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.map.catalogue import FeatureKind, Geometry
from processing.map.feature import Feature

THICKNESS = "thickness_m"
"""The attribute by which a feature says how thick it is itself."""

_LEAST_AREA_M2 = 1e-6
_THICKEST_M = 10.0

FaceIndices = tuple[int, ...]


@dataclass(frozen=True)
class Solid:
    """A body with flat sides.

    Attributes
    ----------
    positions : (2n, 3) float64
        The top's corners counter-clockwise as seen from above, then those below them, in the
        frame of the ring.
    top, sides, bottom : tuple of tuples of int
        Faces of three or four places, counter-clockwise as seen from outside.
    """

    positions: Floats
    top: tuple[FaceIndices, ...]
    sides: tuple[FaceIndices, ...]
    bottom: tuple[FaceIndices, ...]


def thickness_of(kind: FeatureKind, feature: Feature) -> float:
    """How thick a feature is: by its own attribute, else as is usual for its kind; 0: no body."""
    if feature.geometry is not Geometry.AREA or kind.thickness_m <= 0.0:
        return 0.0
    own = feature.attributes.get(THICKNESS)
    if isinstance(own, bool) or not isinstance(own, (int, float)):
        return kind.thickness_m
    return float(own) if 0.0 < own <= _THICKEST_M else kind.thickness_m


def solid_of(ring: Floats, thickness_m: float) -> Solid | None:
    """The body below a ring; None where the ring has no area in plan.

    Parameters
    ----------
    ring : (n, 3) float64
        The corners of the top in order, the first not repeated.
    """
    if len(ring) < 3 or not np.isfinite(ring).all():
        return None
    about = ring - ring[0]
    normal = np.cross(about[1:-1], about[2:]).sum(axis=0) / 2  # Newell's, its length is the area
    area_m2 = float(np.linalg.norm(normal))
    if area_m2 < _LEAST_AREA_M2 or abs(normal[2]) < _LEAST_AREA_M2:
        return None
    if normal[2] < 0:
        ring, normal = ring[::-1], -normal
    low = ring - normal / area_m2 * thickness_m
    count = len(ring)
    following = np.roll(np.arange(count), -1).tolist()
    top = _faces(ring[:, :2] - ring[0, :2])
    return Solid(
        np.concatenate([ring, low]),
        top,
        tuple((at, count + at, count + after, after) for at, after in enumerate(following)),
        tuple(tuple(count + corner for corner in reversed(face)) for face in top),
    )


def _faces(ring: Floats) -> tuple[FaceIndices, ...]:
    """A ring in plan, counter-clockwise, as one face of four corners or triangles."""
    left = list(range(len(ring)))
    if len(left) == 4 and all(_turns_left(ring, left, at) for at in range(4)):
        return (tuple(left),)
    faces: list[FaceIndices] = []
    while len(left) > 3:
        ear = next((at for at in range(len(left)) if _is_ear(ring, left, at)), 0)
        faces.append((left[ear - 1], left[ear], left[(ear + 1) % len(left)]))
        del left[ear]
    return (*faces, tuple(left))


def _turns_left(ring: Floats, left: list[int], at: int) -> bool:
    before, here, after = (ring[left[(at + step) % len(left)]] for step in (-1, 0, 1))
    return _cross(before, here, after) > 0


def _is_ear(ring: Floats, left: list[int], at: int) -> bool:
    """Whether a corner can be cut off: it turns left and no other corner lies in its triangle."""
    if not _turns_left(ring, left, at):
        return False
    corners = [left[(at + step) % len(left)] for step in (-1, 0, 1)]
    first, second, third = (ring[corner] for corner in corners)
    return not any(
        _cross(first, second, ring[other]) >= 0
        and _cross(second, third, ring[other]) >= 0
        and _cross(third, first, ring[other]) >= 0
        for other in left
        if other not in corners
    )


def _cross(first: Floats, second: Floats, third: Floats) -> float:
    ahead, aside = second - first, third - first
    return float(ahead[0] * aside[1] - ahead[1] * aside[0])

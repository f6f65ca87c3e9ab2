"""Trunks as they grow: elliptical, tapering, leaning, bent, with flares and burrs.

Pieces of a tree: 1 to 36 the ten-degree sectors of the trunk between 1.1 and 1.3 m above the foot
(by the outward normal, anticlockwise from east: 1 holds 0 to 10 degrees), 37 the rest of the trunk
below 2.5 m, 38 trunk and branches above, 0 leaves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.scene.mesh import Floats, Integers, TriangleShape

TAPE_M = 1.2
"""Height above the foot at which a tape goes round (都市公園・街路樹の幹周)."""

LOW_PIECE, HIGH_PIECE = 37, 38
_BREAST_M = (1.1, 1.3)
_LOW_M = 2.5
_SECTORS = 36
_LEVELS_M = (-0.25, 0.0, 0.07, 0.2, 0.45, 0.8, 1.1, 1.2, 1.3, 1.6, 2.0, 2.5, 3.2)


@dataclass(frozen=True)
class Stem:
    """One stem in its tree's frame: the foot on the ground is (0, 0, 0), axes as the street's.

    Attributes
    ----------
    path : (n, 3) float64
        Its axis, m, from below the ground upwards.
    radii : (n,) float64
        Half the longer diameter of its level section, m.
    ratio : float
        Shorter by longer diameter.
    turn_rad : float
        Of the longer diameter, anticlockwise from east.
    lobes : (n, 36) float64
        Relative swellings of each ring.
    """

    path: Floats
    radii: Floats
    ratio: float
    turn_rad: float
    lobes: Floats

    def at(self, height_m: float) -> Floats:
        """The axis at a height above the foot: (3,) float64."""
        return np.array([np.interp(height_m, self.path[:, 2], self.path[:, i]) for i in range(3)])

    def radius_m(self, height_m: float) -> float:
        """Half the longer diameter at a height above the foot."""
        return float(np.interp(height_m, self.path[:, 2], self.radii))


@dataclass(frozen=True)
class StemOptions:
    """What a stem is to be like.

    Attributes
    ----------
    radius_m : float
        At the height of the tape, about.
    high_m : float
        Of its end, which is ``end_share`` as thick.
    lean : (float, float)
        m per m of height towards east and north.
    foot : (float, float)
        m east and north of the tree's foot.
    """

    radius_m: float
    high_m: float
    end_share: float
    lean: tuple[float, float]
    foot: tuple[float, float] = (0.0, 0.0)


def stem_of(random: Generator, options: StemOptions) -> Stem:
    """A stem with chance bends, flare, burrs and section."""
    upper = np.arange(4.0, options.high_m - 0.3, max(0.9, options.high_m / 8))
    levels = np.array([one for one in _LEVELS_M if one < options.high_m - 0.1])
    levels = np.concatenate([levels, upper, [options.high_m]])
    share = np.clip(levels / options.high_m, 0.0, 1.0)
    bend = random.normal(0, 0.02, 2) * options.high_m * (random.random() < 0.6)
    swing = random.uniform(0, 2 * np.pi)
    wave = np.sin(share * random.uniform(2, 5) + swing) - np.sin(swing)
    aside = np.array(options.lean) * np.maximum(levels, -0.3)[:, None]
    path = np.column_stack([np.array(options.foot) + aside + bend * wave[:, None], levels])
    taper = 1 + (options.end_share - 1) * (levels - TAPE_M) / max(options.high_m - TAPE_M, 0.5)
    flare = 1 + random.uniform(0.1, 0.7) * np.exp(-np.maximum(levels, 0.0) / 0.15)
    radii = options.radius_m * np.clip(taper, 0.05, 1.4) * flare
    lobes = _lobes(random, levels)
    ratio = float(np.clip(random.normal(0.95, 0.035), 0.84, 1.0))
    return Stem(path, radii, ratio, float(random.uniform(0, np.pi)), lobes)


def _lobes(random: Generator, levels: Floats) -> Floats:
    angles = np.arange(_SECTORS) * (2 * np.pi / _SECTORS)
    turns = random.uniform(0, 2 * np.pi, 3)
    fine = 0.006 * np.cos(2 * angles + turns[0]) + 0.006 * np.cos(3 * angles + turns[1])
    low = np.exp(-np.maximum(levels, 0.0) / 0.12)[:, None]
    roots = low * random.uniform(0.0, 0.18) * np.cos(5 * angles + turns[2])
    burrs = np.zeros((levels.size, _SECTORS))
    for _ in range(int(random.integers(0, 4))):
        level, turn = random.uniform(0.3, 3.0), random.uniform(0, 2 * np.pi)
        near = np.exp(-(((levels - level) / random.uniform(0.12, 0.3)) ** 2))
        away = np.cos(angles - turn) - 1
        burrs += random.uniform(0.05, 0.25) * near[:, None] * np.exp(away / 0.15)
    swollen: Floats = fine + roots + burrs
    return swollen


def stem_shape(stem: Stem) -> tuple[TriangleShape, Integers]:
    """The bark's triangles and their pieces."""
    normals = np.arange(_SECTORS) * (2 * np.pi / _SECTORS) - stem.turn_rad
    inner = np.arctan2(stem.ratio * np.sin(normals), np.cos(normals))
    local = np.column_stack([np.cos(inner), stem.ratio * np.sin(inner)])
    cosine, sine = np.cos(stem.turn_rad), np.sin(stem.turn_rad)
    outline = local @ np.array([[cosine, sine], [-sine, cosine]])
    wide = stem.radii[:, None] * (1 + stem.lobes)
    level = stem.path[:, None, :2] + wide[..., None] * outline
    heights = np.broadcast_to(stem.path[:, None, 2:], (*level.shape[:2], 1))
    vertices = np.concatenate([level, heights], axis=2).reshape(-1, 3)
    count, corner = len(stem.path), np.arange(_SECTORS)
    ring = (np.arange(count - 1) * _SECTORS)[:, None]
    here, beside = ring + corner, ring + (corner + 1) % _SECTORS
    faces = np.stack(
        [
            np.stack([here, beside, beside + _SECTORS], axis=2),
            np.stack([here, beside + _SECTORS, here + _SECTORS], axis=2),
        ],
        axis=2,
    ).reshape(-1, 3)
    fan = np.arange(1, _SECTORS - 1) + (count - 1) * _SECTORS
    lid = np.column_stack([np.full_like(fan, fan[0] - 1), fan, fan + 1])
    faces = np.concatenate([faces, lid])
    return (vertices, faces), pieces_of_bark(vertices, faces)


def pieces_of_bark(vertices: Floats, faces: NDArray[np.int64]) -> Integers:
    """The piece of each triangle of a trunk, (m,) int64; ``vertices`` in the tree's frame."""
    corners = vertices[faces]
    middle = corners[..., 2].mean(axis=1)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    turn = np.arctan2(normal[:, 1], normal[:, 0]) % (2 * np.pi)
    sector = np.minimum((turn / (2 * np.pi) * _SECTORS).astype(np.int64), _SECTORS - 1) + 1
    piece = np.where(middle < _LOW_M, LOW_PIECE, HIGH_PIECE)
    is_breast = (middle > _BREAST_M[0]) & (middle < _BREAST_M[1])
    return np.where(is_breast, sector, piece)


def tape_girth_m(shape: TriangleShape, at: Floats, direction: Floats) -> float:
    """What a tape shows that is laid round a body: the girth of the section's convex hull.

    Parameters
    ----------
    at, direction : (3,) float64
        A place in the tape's plane, and the plane's normal: the axis of the stem.
    """
    from scipy.spatial import ConvexHull

    vertices, triangles = shape
    normal = direction / np.linalg.norm(direction)
    high = (vertices - at) @ normal
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    below, above = edges[(high[edges[:, 0]] <= 0) & (high[edges[:, 1]] > 0)].T
    share = high[below] / (high[below] - high[above])
    cut = vertices[below] + share[:, None] * (vertices[above] - vertices[below]) - at
    first = np.cross(normal, [0.6, 0.8, 0.0])
    first /= np.linalg.norm(first)
    plane = np.column_stack([cut @ first, cut @ np.cross(normal, first)])
    return float(ConvexHull(plane).area)


def girth_of_stem_m(stem: Stem, shape: TriangleShape) -> float:
    """What a tape shows 1.2 m above the foot, square to the stem."""
    direction = stem.at(TAPE_M + 0.05) - stem.at(TAPE_M - 0.05)
    return tape_girth_m(shape, stem.at(TAPE_M), direction)

"""Posts of one thickness: of signs, signals, mirrors, bollards."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadside.poles import POLE, SHAFT_PIECE, SUNK_M, pole_truth
from processing.laboratory.simulate.roadside.rods import rods
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePosition, FreePositions


@dataclass(frozen=True)
class Post:
    """A post as it stands: foot, way of its axis (unit), radius, and where it belongs."""

    spot: FreePosition
    foot: Floats
    direction: Floats
    radius_m: float
    ground_m: float

    def at(self, above_m: float) -> Floats:
        """A place on its axis, by the height above the foot."""
        return np.asarray(self.foot + self.direction * (above_m / self.direction[2]), np.float64)


def post_at(
    positions: FreePositions, random: Generator, options: tuple[int, float], diameter_m: float
) -> Post | None:
    """A place for a post on a side at a chainage (``options``); None where there is none."""
    side, at = options
    spot = positions.beside(random, side, at, diameter_m / 2 + 0.12)
    if spot is None:
        return None
    return post_on(positions, random, spot, diameter_m)


def post_on(
    positions: FreePositions, random: Generator, spot: FreePosition, diameter_m: float
) -> Post:
    """A post on a place that was taken for it: upright, or as cars left it."""
    foot = positions.where(spot)
    lean = random.normal(0, 0.006 if random.random() < 0.9 else 0.05, 2)
    direction = np.array([lean[0], lean[1], 1.0])
    return Post(spot, foot, direction / np.linalg.norm(direction), diameter_m / 2, float(foot[2]))


def add_post(
    built: SectionBuilder,
    post: Post,
    high_m: float,
    kind: str,
    *,
    material: Material = Material.PAINTED_METAL,
) -> int:
    """Add a post of one thickness and its truth; its instance."""
    instance = built.thing("pole")
    path = np.stack([post.at(-SUNK_M), post.at(0.0), post.at(high_m / 2), post.at(high_m)])
    built.mesh.add(
        rods(path[None], post.radius_m, 14),
        material,
        POLE,
        instance,
        piece=SHAFT_PIECE,
    )
    facts = {"height_m": high_m, "diameter_m": 2 * post.radius_m}
    pole_truth(built, post.spot, instance, post.foot, type=kind, **facts)
    return instance

"""Short posts: bollards along walks, delineators along country roads."""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.roadside.posts import add_post, post_on
from processing.laboratory.simulate.roadside.rods import rods
from processing.laboratory.simulate.roadside.signs import against_traffic_rad
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import place_shape
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePosition, FreePositions
from processing.laboratory.simulate.street.plan import SIDES
from processing.laboratory.simulate.street.styles import URBAN

OTHER = 1
_GAP_M = 0.3  # behind the curb


def add_bollards(positions: FreePositions, built: SectionBuilder) -> None:
    """Add rows of bollards on walks, delineators elsewhere."""
    plan = positions.section.plan
    for side in SIDES:
        if plan.side(side).walk_m > 1.5 and plan.side(side).strip_m == 0:
            _add_row(positions, built, side)
        elif plan.style is not URBAN and plan.side(side).walk_m == 0:
            _add_delineators(positions, built, side)


def _add_row(positions: FreePositions, built: SectionBuilder, side: int) -> None:
    """Bollards of 65 to 85 cm, 1.2 to 2 m apart (車止め)."""
    section = positions.section
    random = section.chance("bollards", side)
    if random.random() > 0.2:
        return
    diameter = float(random.choice([0.0605, 0.0763, 0.1143, 0.1143, 0.1398, 0.2]))
    high = float(random.uniform(0.6, 0.9))
    pitch = float(random.uniform(1.2, 2.0))
    away = positions.near_m(side) + _GAP_M + diameter / 2
    at = float(random.uniform(section.plan.start_m, section.plan.end_m))
    material = Material.STEEL if random.random() < 0.5 else Material.PAINTED_METAL
    for each in range(int(random.integers(2, 9))):
        spot = FreePosition(at + each * pitch + float(random.normal(0, 0.03)), side * away)
        if random.random() < 0.07 or not positions.take(spot, diameter / 2 + 0.05):
            continue
        post = post_on(positions, random, spot, diameter)
        add_post(built, post, high + float(random.normal(0, 0.01)), "bollard", material=material)


def _add_delineators(positions: FreePositions, built: SectionBuilder, side: int) -> None:
    """Thin posts with a reflector 90 cm up, 20 to 50 m apart (視線誘導標設置基準)."""
    section = positions.section
    street = chance(section.seed, "delineators", side)
    if street.random() < 0.5:
        return
    pitch = float(street.uniform(20, 50))
    diameter = float(street.choice([0.034, 0.0605, 0.089]))
    plan = section.plan
    for number in range(int(np.ceil(plan.start_m / pitch)), int(plan.end_m / pitch) + 1):
        random = section.chance("delineator", number * side)
        away = positions.near_m(side) + 0.15 + diameter / 2
        spot = FreePosition(number * pitch + float(random.normal(0, 0.4)), side * away)
        if random.random() < 0.1 or not positions.take(spot, diameter / 2 + 0.03):
            continue
        post = post_on(positions, random, spot, diameter)
        high = float(random.normal(0.92, 0.02))
        add_post(built, post, high, "delineator")
        looks = against_traffic_rad(positions, spot)
        path = np.array([[0.0, 0.0, 0.0], [0.02, 0.0, 0.0]])
        look = np.array([np.cos(looks), np.sin(looks), 0.0])
        where = post.at(high - 0.06) + look * post.radius_m
        disc = place_shape(rods(path[None], 0.045, 12), where, looks)
        built.mesh.add(disc, Material.SIGN_FACE, OTHER, built.thing("reflector"))

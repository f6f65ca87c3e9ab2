"""Guide signs over the road: on bent posts with arms (L and F shape), on gantries."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadside.poles import POLE
from processing.laboratory.simulate.roadside.posts import Post, add_post, post_at
from processing.laboratory.simulate.roadside.rods import join_shapes, rod
from processing.laboratory.simulate.roadside.sign_plates import (
    SIGN,
    PlateMounting,
    SignPlate,
    add_plate,
)
from processing.laboratory.simulate.roadside.signs import against_traffic_rad
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePositions
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SIDES
from processing.laboratory.simulate.street.styles import HIGHWAY, RURAL

# 5 m of clearance over carriageways (道路標識設置基準 2-2), half a metre more in practice.
_CLEAR_M = 5.0
_PER_M = {"urban": 1 / 260, "rural": 1 / 500, "highway": 1 / 260}
_GANTRY_SHARE = 0.25


def add_overhead_signs(positions: FreePositions, built: SectionBuilder) -> None:
    """Add the arms and gantries of this section."""
    section = positions.section
    plan = section.plan
    random = section.chance("overhead signs")
    for side in SIDES:
        for _ in range(int(random.poisson(plan.length_m * _PER_M[plan.style.id]))):
            at = float(random.uniform(plan.start_m, plan.end_m))
            if plan.style is HIGHWAY and random.random() < _GANTRY_SHARE:
                _add_gantry(positions, built, random, at)
            else:
                _add_arm(positions, built, random, (side, at))


def _edge_m(positions: FreePositions, post: Post) -> float:
    """The carriageway's edge above the post's foot."""
    alignment = positions.section.alignment
    edge = alignment.carriageway_height(post.spot.chainage_m, post.spot.offset_m)
    return float(edge) - post.ground_m


def _guide(random: Generator, positions: FreePositions) -> SignPlate:
    if positions.section.plan.style is HIGHWAY:
        return SignPlate(
            "rectangle", float(random.uniform(2.2, 3.5)), float(random.uniform(1.4, 2.8))
        )
    if positions.section.plan.style is RURAL and random.random() < 0.4:
        return SignPlate("circle", float(random.choice([0.6, 0.9])))
    return SignPlate("rectangle", float(random.uniform(1.2, 2.8)), float(random.uniform(0.6, 2.0)))


def _add_arm(
    positions: FreePositions, built: SectionBuilder, random: Generator, options: tuple[int, float]
) -> None:
    diameter = float(random.choice([0.1398, 0.1652, 0.2163, 0.2674]))
    post = post_at(positions, random, options, diameter)
    if post is None:
        return
    plate = _guide(random, positions)
    tall = plate.high_m or plate.size_m
    lowest = _edge_m(positions, post) + _CLEAR_M + float(random.uniform(0.0, 0.4))
    middle = lowest + tall / 2
    levels = [middle + tall * 0.3, middle - tall * 0.3] if tall > 1.0 else [middle]
    pole = add_post(built, post, max(levels) + float(random.uniform(0.1, 0.4)), "arm_pole")
    heading = positions.section.heading(post.spot.chainage_m)
    towards = -post.spot.side * np.array([-np.sin(heading), np.cos(heading), 0.0])
    reach = float(random.uniform(0.4, 1.8)) + plate.size_m / 2
    parts = [
        rod(post.at(one), post.at(one) + towards * (reach + plate.size_m * 0.45), 0.045, 8)
        for one in levels
    ]
    built.mesh.add(join_shapes(parts), Material.PAINTED_METAL, POLE, pole)
    looks = against_traffic_rad(positions, post.spot)
    _hang(built, random, plate, (post.at(middle) + towards * reach, looks), post)


def _hang(
    built: SectionBuilder,
    random: Generator,
    plate: SignPlate,
    where: tuple[Floats, float],
    post: Post,
) -> None:
    middle, looks = where
    looks += float(np.deg2rad(random.normal(0, 2.0)))
    look = np.array([np.cos(looks), np.sin(looks), 0.0])
    tilt = -float(np.deg2rad(random.uniform(0, 6)))  # large plates look down a little
    hung = PlateMounting(middle + look * 0.09, looks, tilt, 0.0, 0.0, post.ground_m)
    instance = add_plate(built, plate, hung, post.spot.chainage_m)
    tall = plate.high_m or plate.size_m
    right = np.array([-look[1], look[0], 0.0])
    ribs = []
    for share in (-0.3, 0.0, 0.3) if plate.size_m > 1.0 else (0.0,):
        centre = middle + look * 0.055 + right * share * plate.size_m
        up = np.array([0.0, 0.0, tall * 0.42])
        ribs.append(rod(centre - up, centre + up, 0.02, 4))
    built.mesh.add(join_shapes(ribs), Material.STEEL, SIGN, instance)


def _add_gantry(
    positions: FreePositions, built: SectionBuilder, random: Generator, at: float
) -> None:
    diameter = float(random.uniform(0.25, 0.4))
    posts = [post_at(positions, random, (side, at), diameter) for side in (LEFT, RIGHT)]
    left, right = posts
    if left is None or right is None:
        return
    level = max(one.ground_m + _edge_m(positions, one) for one in (left, right)) + _CLEAR_M + 1.0
    lows = [one.at(level - one.ground_m) for one in (left, right)]
    highs = [one.at(level + 0.8 - one.ground_m) for one in (left, right)]
    pole = add_post(built, left, level + 0.9 - left.ground_m, "arm_pole")
    add_post(built, right, level + 0.9 - right.ground_m, "arm_pole")
    beams = join_shapes([rod(lows[0], lows[1], 0.08, 8), rod(highs[0], highs[1], 0.08, 8)])
    built.mesh.add(beams, Material.PAINTED_METAL, POLE, pole)
    across = lows[1] - lows[0]
    for post, first in ((left, 0.08), (right, 0.58)):
        share = first + 0.08
        for _ in range(int(random.integers(1, 3))):
            plate = SignPlate(
                "rectangle", float(random.uniform(2.0, 3.2)), float(random.uniform(1.2, 1.9))
            )
            middle = lows[0] + across * share + [0.0, 0.0, 0.4]
            _hang(built, random, plate, (middle, against_traffic_rad(positions, post.spot)), post)
            share += 0.2

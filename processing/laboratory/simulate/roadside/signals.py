"""Traffic lights at junctions: level rows of three lamps on arms, and lights for people on foot."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadside.poles import POLE
from processing.laboratory.simulate.roadside.posts import Post, add_post, post_at
from processing.laboratory.simulate.roadside.rods import join_shapes, rods
from processing.laboratory.simulate.roadside.sign_plates import PlateMounting, SignPlate, add_plate
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape, box, place_shape
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePositions
from processing.laboratory.simulate.street.neighbours import neighbour
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SectionPlan
from processing.laboratory.simulate.street.styles import RURAL

OTHER = 1
_LAMPS = 3
_SHARE, _RURAL_SHARE = 0.55, 0.25
# Lamps of 25 and 30 cm, lower edge 4.7 m above the road or more (信号機設置の指針).
_LOWEST_M = 4.75
_NAME_AT = 0.35  # of the arm's reach: where the plate with the junction's name hangs
_HALF_HOUSING_M = 0.68  # of three lamps of 30 cm, and some room


def has_signals(seed: int, plan: SectionPlan) -> bool:
    """Whether traffic at a junction obeys lights."""
    share = _RURAL_SHARE if plan.style is RURAL else _SHARE
    return bool(plan.junctions) and bool(chance(seed, "signals", plan.index).random() < share)


def add_signals(positions: FreePositions, built: SectionBuilder) -> None:
    """Add the lights of junctions next door that stand in this section.

    Drivers look at the light on the far left corner: those ahead see it behind a junction on the
    left, those who come towards them before it on the right.
    """
    section = positions.section
    plan = section.plan
    for step, side, at in ((-1, LEFT, plan.start_m + 1.0), (1, RIGHT, plan.end_m - 1.0)):
        junction = neighbour(section, step)
        if junction is None or not has_signals(section.seed, junction):
            continue
        random = section.chance("signal", step)
        post = post_at(positions, random, (side, at), float(random.uniform(0.14, 0.22)))
        if post is None:
            continue
        heading = section.heading(at)
        looks = heading + np.pi if side == LEFT else heading
        _add_signal(positions, built, random, post, looks)


def _add_signal(
    positions: FreePositions, built: SectionBuilder, random: Generator, post: Post, looks_rad: float
) -> None:
    edge = float(
        positions.section.alignment.carriageway_height(post.spot.chainage_m, post.spot.offset_m)
    )
    level = _LOWEST_M + 0.3 + float(random.uniform(0.0, 0.6)) + edge - post.ground_m
    pole = add_post(built, post, level + float(random.uniform(0.3, 0.9)), "signal_pole")
    heading = positions.section.heading(post.spot.chainage_m)
    towards = -post.spot.side * np.array([-np.sin(heading), np.cos(heading), 0.0])
    reach = float(random.uniform(1.6, 4.2))
    start = post.at(level)
    end = start + towards * (reach + 0.75)
    arm = rods(np.stack([start, (start + end) / 2 + [0.0, 0.0, 0.03], end])[None], 0.04, 8)
    built.mesh.add(arm, Material.PAINTED_METAL, POLE, pole)
    look = np.array([np.cos(looks_rad), np.sin(looks_rad), 0.0])
    body, lenses = _three_lamps(random)
    where = start + towards * reach + look * 0.16
    instance = built.thing("signal")
    built.mesh.add(place_shape(body, where, looks_rad), Material.PAINTED_METAL, OTHER, instance)
    built.mesh.add(place_shape(lenses, where, looks_rad), Material.GLASS, OTHER, instance)
    if random.random() < 0.3:
        most = 2 * ((1 - _NAME_AT) * reach - _HALF_HOUSING_M)
        plate = SignPlate("rectangle", min(float(random.uniform(0.9, 1.5)), most), 0.35)
        middle = start + towards * (reach * _NAME_AT) + look * 0.07 - [0.0, 0.0, 0.3]
        where_hung = PlateMounting(middle, looks_rad, ground_m=post.ground_m)
        add_plate(built, plate, where_hung, post.spot.chainage_m)
    if random.random() < 0.7:
        _add_walkers_light(built, random, post, towards)


def _three_lamps(random: Generator) -> tuple[TriangleShape, TriangleShape]:
    """Housing and lamps; x looks at the drivers."""
    lamp = float(random.choice([0.125, 0.15, 0.15]))
    is_flat = random.random() < 0.5
    deep = 0.06 if is_flat else float(random.uniform(0.12, 0.2))
    half = _LAMPS * (lamp + 0.06)
    parts = [box((-deep, -half, -lamp - 0.06), (0.0, half, lamp + 0.06))]
    lenses = []
    for each in range(_LAMPS):
        y = (each - 1) * 2 * (lamp + 0.05)
        lenses.append(_disc(np.array([0.012, y, 0.0]), lamp))
        if not is_flat or random.random() < 0.2:
            path = np.array([[0.0, y, 0.0], [0.22, y, -0.03]])
            parts.append(rods(path[None], lamp + 0.01, 12, is_closed=False))
    return join_shapes(parts), join_shapes(lenses)


def _disc(middle: Floats, radius: float) -> TriangleShape:
    angles = np.arange(16) * (2 * np.pi / 16)
    rim = middle + radius * np.column_stack([np.zeros(16), np.cos(angles), np.sin(angles)])
    fan = np.arange(1, 15)
    return rim, np.column_stack([np.zeros_like(fan), fan, fan + 1])


def _add_walkers_light(
    built: SectionBuilder, random: Generator, post: Post, towards: Floats
) -> None:
    turn = float(np.arctan2(towards[1], towards[0]))
    high = float(random.uniform(2.6, 3.0))
    where = post.at(high) + towards * (post.radius_m + 0.02)
    body = box((0.0, -0.21, 0.0), (0.17, 0.21, 0.85))
    instance = built.thing("signal")
    built.mesh.add(place_shape(body, where, turn), Material.PAINTED_METAL, OTHER, instance)
    lenses = [place_shape(box((0.172, -0.14, z), (0.178, 0.14, z + 0.28)), where, turn)
              for z in (0.08, 0.48)]  # fmt: skip
    built.mesh.add(join_shapes(lenses), Material.GLASS, OTHER, instance)

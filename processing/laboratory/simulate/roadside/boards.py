"""Flat things beside the road that are no road signs, and signs that hang on walls.

Things (label 1): ``bus_stop``, ``billboard``, ``shop_sign``, ``banner``, and the ``wall`` that a
sign hangs on. Boards are as bright as paint or plastic, not as a sign's face.
"""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.border.parts import BorderPart, block, merge_parts
from processing.laboratory.simulate.border.wall_lines import add_block_outline
from processing.laboratory.simulate.roadside.posts import Post, add_post, post_on
from processing.laboratory.simulate.roadside.rods import tilt_shape
from processing.laboratory.simulate.roadside.sign_choice import plate_of
from processing.laboratory.simulate.roadside.sign_plates import (
    PlateMounting,
    PlateShape,
    SignPlate,
    add_plate,
    outline,
)
from processing.laboratory.simulate.roadside.signs import against_traffic_rad
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape, grid, place_shape
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePosition, FreePositions
from processing.laboratory.simulate.street.plan import SIDES
from processing.laboratory.simulate.street.styles import URBAN

OTHER = 1

_PER_M = {"urban": 1 / 14, "rural": 1 / 45, "highway": 1 / 120}
_BELOW_M = 0.3
_THIN_M = 0.03
_ROOM_M = 0.3  # of what stands on one post


def add_boards(positions: FreePositions, built: SectionBuilder) -> None:
    """Add boards at chance places, and a wall with a sign now and then."""
    section = positions.section
    plan = section.plan
    for side in SIDES:
        random = section.chance("boards", side)
        for _ in range(int(random.poisson(plan.length_m * _PER_M[plan.style.id] / 2))):
            at = float(random.uniform(plan.start_m, plan.end_m))
            make = _KINDS[int(random.integers(len(_KINDS) if plan.style is URBAN else 3))]
            make(positions, built, random, (side, at))


def _disc(radius_m: float) -> TriangleShape:
    """A round plate that faces along x, 1 cm thick."""
    turn = np.linspace(0, 2 * np.pi, 25)
    rows = np.stack(
        [
            np.column_stack([np.full(25, x), r * np.cos(turn), r * np.sin(turn)])
            for x, r in ((-0.005, 0.001), (-0.005, radius_m), (0.005, radius_m), (0.005, 0.001))
        ]
    )
    return grid(rows)


def _board(wide_m: float, z: tuple[float, float], thick_m: float) -> TriangleShape:
    """An upright board that faces along x."""
    return block((-thick_m / 2, thick_m / 2), (-wide_m / 2, wide_m / 2), z)


def _post(
    positions: FreePositions, random: Generator, where: tuple[int, float], radius_m: float
) -> Post | None:
    side, at = where
    spot = positions.beside(random, side, at, _ROOM_M)
    return None if spot is None else post_on(positions, random, spot, 2 * radius_m)


def _facing(positions: FreePositions, random: Generator, post: Post) -> float:
    """Across the street mostly: boards look at who passes, many at the traffic."""
    looks = against_traffic_rad(positions, post.spot)
    return looks + float(random.choice([0.0, np.pi / 2])) + float(np.deg2rad(random.normal(0, 6)))


def _hang(
    built: SectionBuilder, kind: str, parts: list[BorderPart], post: Post, looks_rad: float
) -> None:
    instance = built.thing(kind)
    before = post.radius_m + 0.03
    place = post.foot + before * np.array([np.cos(looks_rad), np.sin(looks_rad), 0.0])
    for shape, material in parts:
        built.mesh.add(place_shape(shape, place.tolist(), looks_rad), material, OTHER, instance)


def _bus_stop(
    positions: FreePositions, built: SectionBuilder, random: Generator, where: tuple[int, float]
) -> None:
    """A round plate over a timetable on one post."""
    post = _post(positions, random, where, 0.0302)
    if post is None:
        return
    high, radius = float(random.uniform(2.1, 2.6)), float(random.choice([0.2, 0.225, 0.25]))
    disc = _disc(radius)
    plates: list[BorderPart] = [((disc[0] + [0.0, 0.0, high], disc[1]), Material.PAINTED_METAL)]
    low = float(random.uniform(1.1, 1.4))
    plates.append((_board(0.4, (low, high - radius - 0.05), _THIN_M), Material.PLASTIC))
    _hang(built, "bus_stop", plates, post, _facing(positions, random, post))
    add_post(built, post, high + radius * 0.6, "other")


def _billboard(
    positions: FreePositions, built: SectionBuilder, random: Generator, where: tuple[int, float]
) -> None:
    """A painted board on two posts."""
    wide, tall = float(random.uniform(0.9, 3.0)), float(random.uniform(0.6, 1.8))
    low = float(random.uniform(0.8, 3.0))
    post = _post(positions, random, where, 0.04)
    if post is None:
        return
    board = _board(wide, (low, low + tall), 0.05)
    legs = merge_parts(
        [
            block((-0.1, -0.04), (y - 0.03, y + 0.03), (-_BELOW_M, low + tall))
            for y in (-wide * 0.35, wide * 0.35)
        ]
    )
    parts: list[BorderPart] = [(board, Material.PAINTED_METAL), (legs, Material.STEEL)]
    _hang(built, "billboard", parts, post, _facing(positions, random, post))


def _wall_sign(
    positions: FreePositions, built: SectionBuilder, random: Generator, where: tuple[int, float]
) -> None:
    """A wall of concrete with a sign on it, some centimetres before its face."""
    side, at = where
    half, high = float(random.uniform(1.2, 2.5)), float(random.uniform(2.8, 4.5))
    spot = positions.beside(random, side, at, half)
    if spot is None:
        return
    looks = against_traffic_rad(positions, spot) + float(random.choice([0.0, -side * np.pi / 2]))
    instance = built.thing("wall")
    foot = positions.where(spot)
    wall = block((-0.25, 0.0), (-half, half), (-_BELOW_M, high))
    placed = place_shape(wall, foot.tolist(), looks)
    built.mesh.add(placed, Material.OLD_CONCRETE, OTHER, instance)
    ring = placed[0][:4] + np.array([0.0, 0.0, _BELOW_M])
    add_block_outline(positions.section, built, instance, ring, ("wall", high))
    shapes: tuple[PlateShape, ...] = ("circle", "diamond", "square", "rectangle")
    plate = plate_of(random, shapes[int(random.integers(4))], positions.section.plan.style)
    _add_on_wall(built, random, plate, (foot, looks, spot))


def _add_on_wall(
    built: SectionBuilder,
    random: Generator,
    plate: SignPlate,
    where: tuple[Floats, float, FreePosition],
) -> None:
    foot, looks, spot = where
    low = float(outline(plate)[:, 1].min())
    before = float(random.uniform(0.03, 0.1))
    look = np.array([np.cos(looks), np.sin(looks), 0.0])
    aside = np.array([-look[1], look[0], 0.0]) * float(random.uniform(-0.5, 0.5))
    middle = foot + before * look + aside
    middle[2] += 1.8 + float(random.uniform(0.0, 0.4)) - low
    hung = PlateMounting(middle, looks, ground_m=float(foot[2]))
    add_plate(built, plate, hung, spot.chainage_m)


def _shop_sign(
    positions: FreePositions, built: SectionBuilder, random: Generator, where: tuple[int, float]
) -> None:
    """A thick board or a disc high up on a post."""
    post = _post(positions, random, where, float(random.uniform(0.05, 0.1)))
    if post is None:
        return
    low, wide = float(random.uniform(2.4, 4.5)), float(random.uniform(0.6, 1.8))
    tall = wide * float(random.uniform(0.5, 1.8))
    looks = _facing(positions, random, post)
    if random.random() < 0.25:
        disc = _disc(wide / 2)
        shape: TriangleShape = (disc[0] + [0.0, 0.0, low + wide / 2], disc[1])
    else:
        shape = _board(wide, (low, low + tall), float(random.uniform(0.05, 0.25)))
    _hang(built, "shop_sign", [(shape, Material.PLASTIC)], post, looks)
    add_post(built, post, low + min(tall, wide) * 0.9, "other")


def _banner(
    positions: FreePositions, built: SectionBuilder, random: Generator, where: tuple[int, float]
) -> None:
    """A flag of cloth on a thin pole (のぼり)."""
    post = _post(positions, random, where, 0.011)
    if post is None:
        return
    rows = np.stack(
        [
            np.column_stack([0.04 * np.sin(6 * y + z) * np.ones(1), [y], [z]])
            for y in np.linspace(0.0, 0.6, 7)
            for z in (0.7, 1.3, 1.9, 2.45)
        ]
    ).reshape(7, 4, 3)
    tilted = tilt_shape(grid(rows), float(np.deg2rad(random.normal(0, 3))))
    looks = float(random.uniform(0, 2 * np.pi))
    _hang(built, "banner", [(tilted, Material.CLOTH)], post, looks)
    add_post(built, post, 2.5, "other", material=Material.PLASTIC)


_KINDS = (_bus_stop, _billboard, _wall_sign, _shop_sign, _banner)
"""The first three stand in the country, too."""

"""Street lamps on steel posts, and small ones on utility poles.

Pieces of a lamp post: 1 the shaft, 0 arm and head.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadside.pole_line import axis, pole_line
from processing.laboratory.simulate.roadside.poles import (
    FITTING_PIECE,
    POLE,
    SHAFT_PIECE,
    SUNK_M,
    pole_truth,
)
from processing.laboratory.simulate.roadside.posts import Post
from processing.laboratory.simulate.roadside.rods import join_shapes, rod, rods
from processing.laboratory.simulate.roadside.sign_choice import plates_of
from processing.laboratory.simulate.roadside.signs import against_traffic_rad, hang_plates
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape, box, place_shape
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePosition, FreePositions
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SIDES
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import HIGHWAY, RURAL

_SHARES = {"urban": 0.75, "rural": 0.25, "highway": 0.75}
_BREAST_M = 1.2
_SIGNED = 0.15  # of lamp posts carry signs


@dataclass(frozen=True)
class LampKind:
    """What the lamps of a street look like, lengths in m."""

    sides: tuple[int, ...]
    pitch_m: float
    high_m: float
    foot_m: float
    top_m: float
    reach_m: float
    is_bent: bool
    is_led: bool


def lamp_kind(section: StreetSection) -> LampKind | None:
    """The lamps of a street; None where it has none.

    Posts of 4.5 to 12 m after 道路照明施設設置基準: 10 and 12 m on wide roads, low ones over walks.
    """
    style = section.plan.style
    random = chance(section.seed, "lamps")
    is_avenue = section.plan.left.is_avenue
    if random.random() > (1.0 if is_avenue else _SHARES[style.id]):
        return None
    both = SIDES if style is HIGHWAY or random.random() < 0.35 else ()
    line = pole_line(section).poles
    other = -line[0].spot.side if line else (LEFT if random.random() < 0.5 else RIGHT)
    is_low = style is not HIGHWAY and random.random() < 0.25
    high = float(random.uniform(4.2, 5.5) if is_low else random.uniform(7.5, 12.0))
    pitch = float(random.uniform(16, 24) if is_low else random.uniform(28, 45))
    foot = float(random.uniform(0.09, 0.115) if is_low else random.uniform(0.14, 0.2))
    return LampKind(
        both or (other,),
        pitch * (0.5 if is_avenue else 2 if style is RURAL else 1),
        high,
        foot,
        foot * float(random.uniform(0.45, 1.0)),
        0.0 if is_low and random.random() < 0.5 else float(random.uniform(0.8, 2.4)),
        bool(random.random() < 0.5),
        bool(random.random() < 0.6),
    )


def add_lights(positions: FreePositions, built: SectionBuilder) -> None:
    """Add lamp posts at their numbers along the chainage, and lamps on utility poles."""
    section = positions.section
    kind = lamp_kind(section)
    if kind is not None:
        plan = section.plan
        for side in kind.sides:
            shift = 0.5 if side == RIGHT else 0.0
            first = int(np.ceil(plan.start_m / kind.pitch_m - shift))
            for number in range(first, int(plan.end_m / kind.pitch_m - shift) + 1):
                random = section.chance("lamp", number * 2 + (side > 0))
                at = (number + shift + float(random.normal(0, 0.04))) * kind.pitch_m
                spot = positions.beside(random, side, at, kind.foot_m / 2 + 0.12)
                if spot is not None:
                    _add_lamp_post(positions, built, kind, spot, random)
    _add_on_poles(positions, built)


def _add_lamp_post(
    positions: FreePositions,
    built: SectionBuilder,
    kind: LampKind,
    spot: FreePosition,
    random: Generator,
) -> None:
    section = positions.section
    foot = positions.where(spot)
    high = kind.high_m + float(random.normal(0, 0.05))
    lean = random.normal(0, 0.004 if random.random() < 0.93 else 0.025, 2)
    levels = np.array([-SUNK_M, 0.0, 0.25, 0.26, high * 0.5, high])
    path = foot + np.column_stack([np.outer(levels, lean), levels])
    slope = (kind.top_m - kind.foot_m) / high
    radii = (kind.foot_m + slope * np.maximum(levels, 0)) / 2
    radii[:3] *= float(random.choice([1.0, 1.0, 1.35]))
    instance = built.thing("pole")
    material = Material.PAINTED_METAL if random.random() < 0.75 else Material.STEEL
    built.mesh.add(rods(path[None], radii, 16), material, POLE, instance, piece=SHAFT_PIECE)
    parts, end = _arm(section, kind, spot, path[-1])
    turn = section.heading(spot.chainage_m) - spot.side * np.pi / 2
    parts.append(place_shape(_head(kind), end, turn))
    if random.random() < 0.6:
        hatch = box((-0.06, kind.foot_m * 0.35, 0.5), (0.06, kind.foot_m / 2 + 0.02, 0.85))
        parts.append(place_shape(hatch, foot, turn))
    built.mesh.add(join_shapes(parts), material, POLE, instance, piece=FITTING_PIECE)
    if random.random() < _SIGNED:
        direction = np.array([lean[0], lean[1], 1.0])
        radius = (kind.foot_m + slope * _BREAST_M) / 2
        post = Post(spot, foot, direction / np.linalg.norm(direction), radius, float(foot[2]))
        looks = against_traffic_rad(positions, spot) + float(random.normal(0, 0.1))
        plates = plates_of(random, section.plan.style)[:2]
        hang_plates(built, random, post, plates, (looks, float(random.uniform(2.0, 2.9))))
    pole_truth(
        built,
        spot,
        instance,
        foot,
        type="street_light",
        height_m=high,
        diameter_m=float(kind.foot_m + slope * _BREAST_M),
    )


def _arm(
    section: StreetSection, kind: LampKind, spot: FreePosition, top: Floats
) -> tuple[list[TriangleShape], Floats]:
    """The arm towards the road and its end."""
    if kind.reach_m == 0.0:
        return [], top
    heading = section.heading(spot.chainage_m)
    towards = -spot.side * np.array([-np.sin(heading), np.cos(heading), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    share = np.linspace(0, 1, 7)[:, None]
    rise = np.sin(share * np.pi / 2) * 0.7 if kind.is_bent else share * 0.25
    path = top - up * 0.05 + towards * share * kind.reach_m + up * rise * min(kind.reach_m, 1.5)
    return [rods(path[None], np.linspace(kind.top_m / 2, 0.028, 7), 10)], path[-1]


def _head(kind: LampKind) -> TriangleShape:
    """Its own x axis points over the road."""
    if kind.is_led:
        return box((-0.1, -0.14, -0.05), (0.5, 0.14, 0.06))
    path = np.array(
        [[-0.1, 0, 0], [0.1, 0, 0], [0.35, 0, -0.01], [0.6, 0, -0.02], [0.68, 0, -0.02]]
    )
    return rods(path[None], np.array([0.05, 0.12, 0.16, 0.11, 0.03]), 10)


def _add_on_poles(positions: FreePositions, built: SectionBuilder) -> None:
    """Small lamps for the walk on every other utility pole (防犯灯)."""
    section = positions.section
    share = float(chance(section.seed, "small lamps").uniform(0.1, 0.6))
    for pole in pole_line(section).poles:
        random = section.chance("small lamp", pole.number)
        if pole.section != section.plan.index or random.random() > share:
            continue
        start = axis(section.alignment, pole, np.array([float(random.uniform(4.4, 5.4))]))[0]
        heading = section.heading(pole.spot.chainage_m)
        left = np.array([-np.sin(heading), np.cos(heading), 0.0])
        end = start - pole.spot.side * left * float(random.uniform(0.5, 0.9)) + [0.0, 0.0, 0.15]
        instance = built.thing("lamp")
        turn = heading - pole.spot.side * np.pi / 2
        head = place_shape(box((-0.05, -0.07, -0.05), (0.4, 0.07, 0.03)), end, turn)
        parts = join_shapes([rod(start, end, 0.017), head])
        built.mesh.add(parts, Material.PAINTED_METAL, POLE, instance)

"""Convex mirrors on orange posts (カーブミラー), opposite side streets and on bends."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadside.posts import Post, add_post, post_at
from processing.laboratory.simulate.roadside.rods import join_shapes, rod, tilt_shape
from processing.laboratory.simulate.roadside.signals import has_signals
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape, grid, place_shape
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePositions
from processing.laboratory.simulate.street.plan import SIDES
from processing.laboratory.simulate.street.styles import HIGHWAY, RURAL

OTHER = 1
# Diameters, posts and heights after 道路反射鏡設置指針: 600, 800 and 1000 mm; lower edge 1.8 m up
# or more; radius of curvature 1.5 to 3.6 m.
_DIAMETERS_M = (0.6, 0.6, 0.8, 0.8, 1.0)
_POSTS_M = (0.0763, 0.0763, 0.0891)
_ON_BENDS_PER_M = 1 / 160
_BENT_PER_M = 1 / 250


def add_mirrors(positions: FreePositions, built: SectionBuilder) -> None:
    """Add the mirrors of this section."""
    plan, section = positions.section.plan, positions.section
    if plan.style is HIGHWAY:
        return
    random = section.chance("mirrors")
    for side in SIDES:
        is_opposite = plan.junctions == (-side,)
        if is_opposite and not has_signals(section.seed, plan) and random.random() < 0.7:
            at = (plan.start_m + plan.end_m) / 2 + float(random.uniform(-3, 3))
            looks = section.heading(at) - side * np.pi / 2
            _add_mirror(positions, built, random, (side, at, looks))
    middle = (plan.start_m + plan.end_m) / 2
    is_bent = abs(np.interp(middle, section.alignment.chainages, section.alignment.curvatures))
    rate = _ON_BENDS_PER_M if is_bent > _BENT_PER_M else _ON_BENDS_PER_M / 6
    for _ in range(int(random.poisson(rate * plan.length_m * (1.5 if plan.style is RURAL else 1)))):
        side = SIDES[int(random.integers(2))]
        at = float(random.uniform(plan.start_m, plan.end_m))
        looks = section.heading(at) + (np.pi if random.random() < 0.5 else 0.0)
        _add_mirror(positions, built, random, (side, at, looks))


def _add_mirror(
    positions: FreePositions,
    built: SectionBuilder,
    random: Generator,
    options: tuple[int, float, float],
) -> None:
    side, at, looks_rad = options
    post = post_at(positions, random, (side, at), float(random.choice(_POSTS_M)))
    if post is None:
        return
    diameter = float(random.choice(_DIAMETERS_M))
    high = float(random.uniform(2.0, 2.6)) + diameter / 2
    count = 2 if random.random() < 0.35 else 1
    is_level = random.random() < 0.6
    step = diameter + 0.12
    for each in range(count):
        turn = looks_rad + float(np.deg2rad(random.normal(0, 18 if count == 1 else 28)))
        aside = (each - (count - 1) / 2) * step * is_level
        level = high + each * step * (not is_level)
        _add_glass(built, post, diameter, (level, aside, turn), random)
    top = high + (count - 1) * step * (not is_level) + float(random.uniform(0.0, 0.3))
    add_post(built, post, top, "mirror_pole", material=Material.PLASTIC)


def _add_glass(
    built: SectionBuilder,
    post: Post,
    diameter: float,
    hung: tuple[float, float, float],
    random: Generator,
) -> None:
    level, aside, turn = hung
    instance = built.thing("mirror")
    across = np.array([-np.sin(turn), np.cos(turn), 0.0])
    look = np.array([np.cos(turn), np.sin(turn), 0.0])
    where = post.at(level) + across * aside + look * (post.radius_m + 0.09)
    tilt = float(np.deg2rad(random.uniform(2, 9)))
    cap, shell = _cap(diameter / 2, 0.0), _cap(diameter / 2 + 0.015, -0.03)
    built.mesh.add(
        place_shape(tilt_shape(cap, -tilt), where, turn), Material.MIRROR, OTHER, instance, piece=1
    )
    back = join_shapes([tilt_shape(shell, -tilt), tilt_shape(_hood(diameter / 2), -tilt)])
    built.mesh.add(place_shape(back, where, turn), Material.PLASTIC, OTHER, instance, piece=2)
    arm = rod(post.at(level), where - look * 0.05, 0.02, 6)
    built.mesh.add(arm, Material.STEEL, OTHER, instance)


def _cap(radius: float, back_m: float) -> TriangleShape:
    """A spherical cap that bulges along x."""
    away = np.array([0.02, 0.35, 0.7, 1.0]) * radius
    angles = np.linspace(0, 2 * np.pi, 21)
    x = back_m + (radius**2 - away**2) / (2 * 2.5)
    rows = np.stack(
        [
            np.broadcast_to(x[:, None], (4, 21)),
            away[:, None] * np.cos(angles),
            away[:, None] * np.sin(angles),
        ],
        axis=2,
    )
    return grid(rows)


def _hood(radius: float) -> TriangleShape:
    angles = np.deg2rad(np.linspace(25, 155, 13))
    rim: Floats = (radius + 0.03) * np.column_stack([np.cos(angles), np.sin(angles)])
    rows = np.stack([np.column_stack([np.full(13, x), rim]) for x in (-0.03, 0.1)])
    return grid(rows)

"""Sign posts beside the road: plates one above the other, some back to back, some bent."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadside.pole_line import TAPER, axis, pole_line
from processing.laboratory.simulate.roadside.posts import Post, add_post, post_on
from processing.laboratory.simulate.roadside.rods import join_shapes, rod
from processing.laboratory.simulate.roadside.sign_choice import plate_of, plates_of
from processing.laboratory.simulate.roadside.sign_plates import (
    SIGN,
    THICK_M,
    PlateMounting,
    PlateShape,
    SignPlate,
    add_plate,
    axes_of,
    outline,
)
from processing.laboratory.simulate.roadside.signals import has_signals
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePosition, FreePositions
from processing.laboratory.simulate.street.neighbours import neighbour
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SIDES

# Posts of signs: steel pipes of 60.5, 76.3 and 89.1 mm (道路標識ハンドブック); the lower edge of a
# plate is 1.8 m up, 2.5 m over walks (道路標識設置基準 2-2).
POSTS_M = (0.0605, 0.0605, 0.0763, 0.0891)
LOWEST_M, LOWEST_OVER_WALK_M = 1.8, 2.5
_BRACKET_M = 0.025
_MORE_IN_AVENUES = 3.0  # so that some stand under every few crowns
_PER_M = {"urban": 1 / 26, "rural": 1 / 60, "highway": 1 / 90}


def add_signs(positions: FreePositions, built: SectionBuilder) -> None:
    """Add sign posts at chance places, the signs of junctions next door, and signs on poles."""
    section = positions.section
    plan = section.plan
    for side in SIDES:
        random = section.chance("signs", side)
        more = _MORE_IN_AVENUES if plan.side(side).is_avenue else 1.0
        per_m = _PER_M[plan.style.id] / 2 * 1.6 * more
        for _ in range(int(random.poisson(plan.length_m * per_m))):
            at = float(random.uniform(plan.start_m, plan.end_m))
            _add_post(positions, built, random, (side, at, plates_of(random, plan.style)))
    _add_stop_signs(positions, built)
    _add_on_poles(positions, built)


def against_traffic_rad(positions: FreePositions, spot: FreePosition) -> float:
    """Where a sign looks: to those who drive on its side, anticlockwise from east."""
    heading = positions.section.heading(spot.chainage_m)
    return heading + np.pi if spot.side == LEFT else heading


def _add_stop_signs(positions: FreePositions, built: SectionBuilder) -> None:
    """Side streets stop: their signs stand at the far corner on the left of who comes out."""
    section = positions.section
    random = section.chance("stop signs")
    for step, side in ((-1, LEFT), (1, RIGHT)):
        plan = neighbour(section, step)
        if plan is None or side not in plan.junctions or has_signals(section.seed, plan):
            continue
        if random.random() < 0.25:
            continue
        at = section.plan.start_m + 0.7 if step < 0 else section.plan.end_m - 0.7
        stop = [plate_of(random, "triangle", section.plan.style)]
        outwards = section.heading(at) + side * np.pi / 2
        _add_post(positions, built, random, (side, at, stop), looks_rad=outwards)


def _add_post(
    positions: FreePositions,
    built: SectionBuilder,
    random: Generator,
    options: tuple[int, float, list[SignPlate]],
    *,
    looks_rad: float | None = None,
) -> None:
    side, at, plates = options
    diameter = float(random.choice(POSTS_M))
    wide = max(one.size_m for one in plates)
    spot = positions.beside(random, side, at, max(0.12, min(wide / 2, 0.45)))
    if spot is None:
        return
    post = post_on(positions, random, spot, diameter)
    looks = against_traffic_rad(positions, spot) if looks_rad is None else looks_rad
    looks += side * float(np.deg2rad(random.uniform(-4, 14)))
    over_walk = positions.section.plan.side(side).walk_m > 0
    lowest = LOWEST_OVER_WALK_M if over_walk and random.random() < 0.5 else LOWEST_M
    lowest += float(random.uniform(-0.1, 0.35))
    top = hang_plates(built, random, post, plates, (looks, lowest))
    if random.random() < 0.18:
        other = plates_of(random, positions.section.plan.style)[:2]
        top = max(top, hang_plates(built, random, post, other, (looks + np.pi, lowest)))
    add_post(built, post, top + float(random.uniform(-0.03, 0.12)), "sign_pole")


def hang_plates(
    built: SectionBuilder,
    random: Generator,
    post: Post,
    plates: list[SignPlate],
    options: tuple[float, float],
) -> float:
    """Hang plates on a post, the last one lowest.

    Parameters
    ----------
    options : (float, float)
        Where they look (anticlockwise from east), and the height of the lowest edge above the
        foot, m.

    Returns
    -------
    float
        Height of the highest edge above the foot, m.
    """
    looks_rad, edge = options
    for plate in plates[::-1]:
        corners = outline(plate)
        low, high = corners[:, 1].min(), corners[:, 1].max()
        is_hit = random.random() < 0.06
        hung = PlateMounting(
            np.zeros(3),
            looks_rad + float(np.deg2rad(random.normal(0, 14 if is_hit else 1.5))),
            float(np.deg2rad(random.normal(0, 4 if is_hit else 0.8))),
            float(np.deg2rad(random.normal(0, 5 if is_hit else 0.7))),
            float(random.normal(0, 0.15)) if is_hit else 0.0,
            post.ground_m,
        )
        centre = post.at(edge - low)
        away = post.radius_m + _BRACKET_M + THICK_M
        look = axes_of(hung)[2]
        middle = centre + look * away
        instance = add_plate(
            built,
            plate,
            PlateMounting(
                middle, hung.facing_rad, hung.tilt_rad, hung.roll_rad, hung.bend, post.ground_m
            ),
            post.spot.chainage_m,
        )
        holds = [post.at(edge - low + y) for y in (low * 0.4, high * 0.4)]
        reach = look * (away - THICK_M)
        brackets = join_shapes([rod(one, one + reach, 0.012) for one in holds])
        built.mesh.add(brackets, Material.STEEL, SIGN, instance)
        edge += float(high - low) + float(random.uniform(0.015, 0.06))
    return edge


def _add_on_poles(positions: FreePositions, built: SectionBuilder) -> None:
    """A few signs hang on utility poles."""
    section = positions.section
    for pole in pole_line(section).poles:
        random = section.chance("sign on a pole", pole.number)
        if pole.section != section.plan.index or random.random() > 0.14:
            continue
        ground = section.ground.height(pole.spot.chainage_m, pole.spot.offset_m)
        edge = section.alignment.carriageway_height(pole.spot.chainage_m, pole.spot.offset_m)
        above = float(ground - edge)
        foot, top = axis(section.alignment, pole, np.array([above, above + 3.0]))
        radius = (pole.top_diameter_m + (pole.high_m - above - 2.5) * TAPER) / 2
        post = Post(
            pole.spot, foot, (top - foot) / np.linalg.norm(top - foot), radius, float(ground)
        )
        shape: PlateShape = "circle" if random.random() < 0.6 else "rectangle"
        plates = [plate_of(random, shape, section.plan.style)]
        looks = against_traffic_rad(positions, pole.spot)
        hang_plates(built, random, post, plates, (looks, float(random.uniform(2.2, 3.0))))

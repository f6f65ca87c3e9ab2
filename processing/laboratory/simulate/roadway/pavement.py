"""What lies in the pavement: patches, manholes, tactile blocks on walks.

Things: ``manhole``, whose truth is a cover: sectors of two rings are its pieces.
"""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.roadway.paint import add_sheet
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.cover_truth import tell_round_cover
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, grid
from processing.laboratory.simulate.scene.things import NO_THING, SectionBuilder
from processing.laboratory.simulate.street.layout import CornerLayout
from processing.laboratory.simulate.street.plan import SIDES
from processing.laboratory.simulate.street.profile import GROUND, ROAD
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import HIGHWAY, URBAN
from processing.laboratory.simulate.street.surfaces import asphalt_of
from processing.laboratory.simulate.street.walk_lines import first_of_walk, walk_lines

_DISC_SIDES = 24
_SECTORS = 12
_JOINT_M, _FRAME_M = (0.004, 0.012), (0.02, 0.05)  # between a cover and its frame, and the frame
_LOW_M = 0.0005
_COLLAR_M = (0.08, 0.35)  # of new asphalt about a frame that was set anew
_BLOCK_M = 0.3  # 視覚障害者誘導用ブロック, JIS T 9251: 30 cm squares, dots and bars 5 mm high
_BLOCK_HIGH_M = 0.003
_FROM_CURB_M = 0.3
_CLEAR_M = 0.4


def add_pavement(section: StreetSection, built: SectionBuilder) -> None:
    """Add patches, manholes and tactile blocks of a section."""
    _add_patches(section, built)
    _add_manholes(section, built)
    for side in SIDES:
        if side not in section.plan.junctions:
            _add_tactile(section, side, built)
        for number, corner in enumerate(section.layout.sides[side].corners):
            _add_tactile_of_corner(section, corner, (side, number), built)


def _add_patches(section: StreetSection, built: SectionBuilder) -> None:
    random = section.chance("patches")
    plan = section.plan
    if plan.style is HIGHWAY or random.random() < 0.5:
        return
    old = asphalt_of(section.seed)
    other = Material.ASPHALT if old == Material.WORN_ASPHALT else Material.WORN_ASPHALT
    for _ in range(int(random.integers(1, 4))):
        long = min(float(random.uniform(0.8, 25.0)), plan.length_m - 1.0)
        wide = float(random.uniform(0.6, 2.2))
        first = plan.start_m + 0.5 + float(random.random()) * (plan.length_m - 1.0 - long)
        low = -plan.right.edge_m + 0.4
        high = -plan.median_m / 2 - 0.4 - wide
        if random.random() < 0.5:
            low, high = plan.median_m / 2 + 0.4, plan.left.edge_m - 0.4 - wide
        if high <= low:
            continue
        right = float(random.uniform(low, high))
        above = float(random.uniform(0.003, 0.008))
        where = (first, first + long, right, right + wide)
        add_sheet(section, built, where, material=other, above_m=above)


def _add_manholes(section: StreetSection, built: SectionBuilder) -> None:
    random = section.chance("manholes")
    plan = section.plan
    if plan.style is HIGHWAY:
        return
    mean = plan.length_m / (18.0 if plan.style is URBAN else 60.0)
    for _ in range(int(random.poisson(mean))):
        radius = float(random.choice([0.3, 0.3, 0.3, 0.45, 0.15]))
        chainage = float(random.uniform(plan.start_m + 1, plan.end_m - 1))
        side = int(random.choice([-1, 1]))
        inner = plan.median_m / 2 + _CLEAR_M + radius
        outer = plan.side(side).edge_m - 0.3 - radius
        above = float(random.uniform(0.004, 0.012))
        if outer > inner:
            offset = side * float(random.uniform(inner, outer))
            _add_disc(section, built, (chainage, offset), radius, above)


def _add_disc(
    section: StreetSection,
    built: SectionBuilder,
    where: tuple[float, float],
    radius: float,
    above: float,
) -> None:
    """A cover in its frame, with a joint between; about some a collar of other asphalt."""
    random = section.chance("looks of a manhole", built.first_instance + len(built.things))
    iron = (Material.STEEL, Material.OLD_IRON)[int(random.random() < 0.5)]
    if random.random() < 0.3:
        _add_collar(section, built, where, radius + float(random.uniform(*_COLLAR_M)))
    inner = radius - min(float(random.uniform(*_FRAME_M)), 0.3 * radius)
    joint = inner - float(random.uniform(*_JOINT_M))
    rings = np.array([0.02 * radius, joint / 2, joint, joint, inner, inner, radius, radius])
    heights = np.array([above, above, above, _LOW_M, _LOW_M, above, above, -0.01])
    materials = np.full(len(rings) - 1, int(iron), np.uint8)
    materials[3] = Material.JOINT
    angles = np.linspace(0, 2 * np.pi, _DISC_SIDES + 1)
    chainage = where[0] + rings[:, None] * np.cos(angles)
    offset = where[1] + rings[:, None] * np.sin(angles)
    rows = section.position(chainage, offset, heights[:, None])
    instance = built.thing("manhole")
    sector = np.arange(_DISC_SIDES) * _SECTORS // _DISC_SIDES
    is_outer = (np.arange(len(rings) - 1) > 1)[:, None]
    piece = np.repeat((sector + _SECTORS * is_outer).ravel(), 2)
    each = np.repeat(materials, 2 * _DISC_SIDES)
    built.mesh.add(grid(rows), each, ROAD, instance, piece=piece)
    middle = section.position(*where, above)
    tell_round_cover(built, (middle, where[0]), 2 * radius, (instance, 2 * _SECTORS))


def _add_collar(
    section: StreetSection, built: SectionBuilder, where: tuple[float, float], radius: float
) -> None:
    old = asphalt_of(section.seed)
    other = Material.ASPHALT if old == Material.WORN_ASPHALT else Material.WORN_ASPHALT
    angles = np.linspace(0, 2 * np.pi, _DISC_SIDES + 1)
    rings = np.array([0.02, 0.5, 1.0, 1.0])[:, None] * radius
    chainage, offset = where[0] + rings * np.cos(angles), where[1] + rings * np.sin(angles)
    heights = np.array([0.002, 0.002, 0.002, -0.01])[:, None]
    rows = section.position(chainage, offset, heights)
    built.mesh.add(grid(rows), other, ROAD, NO_THING)


def _add_tactile(section: StreetSection, side: int, built: SectionBuilder) -> None:
    """Blocks along the walk where it is wide enough, and across it at crossings."""
    lines = walk_lines(section, side)
    random = section.chance("tactile", side)
    if lines is None or not section.plan.side(side).has_tactile:
        return
    chainages, inner, bend, outer = lines.chainages, lines.inner, lines.bend, lines.outer
    beside = float(chance(section.seed, "tactile", side).uniform(0.15, 0.4))
    fits = bend + beside + _BLOCK_M < outer - 0.1
    for first, last in _stretches(fits):
        if last - first > 2:
            rows = slice(first, last)
            near = bend[rows] + beside
            _add_blocks(section, built, (chainages[rows], near, near + _BLOCK_M), side)
    for drop in section.layout.sides[side].drops:
        if drop.high_m > 0.03 or random.random() < 0.3:
            continue
        there = np.flatnonzero(
            (chainages >= drop.from_m + drop.ramp_m) & (chainages <= drop.to_m - drop.ramp_m)
        )
        if there.size < 2 or float((bend - inner)[there].min()) < _FROM_CURB_M + 2 * _BLOCK_M:
            continue
        near = inner[there] + _FROM_CURB_M
        _add_blocks(section, built, (chainages[there], near, near + 2 * _BLOCK_M), side)


def _add_tactile_of_corner(
    section: StreetSection, corner: CornerLayout, where: tuple[int, int], built: SectionBuilder
) -> None:
    """Blocks with dots before a corner's lowered curb, as wide as it is."""
    side, number = where
    first = first_of_walk(corner.sweep)
    random = section.chance("tactile of a corner", side * (number + 1))
    if first is None or not section.plan.side(side).has_tactile or random.random() < 0.2:
        return
    sweep, along = corner.sweep, corner.track.along
    near, far = (
        section.alignment.at(
            sweep.chainages[:, line], sweep.offsets[:, line], sweep.heights[:, line]
        )
        for line in (first, first + 1)
    )
    wide = np.linalg.norm(far - near, axis=1)
    for drop in corner.drops:
        low, high = drop.from_m + drop.ramp_m, drop.to_m - drop.ramp_m
        long = min(float(random.uniform(1.8, 4.0)), high - low)
        # Towards the side street, which is what people cross there.
        start = low + float(random.uniform(0.5, 1.0)) * (high - low - long)
        is_low = (along >= start) & (along <= start + long)
        for first_node, last in _stretches(is_low & (wide >= _FROM_CURB_M + _BLOCK_M)):
            there = slice(first_node, last)
            if last - first_node < 3:
                continue
            blocks = 2 if wide[there].min() >= _FROM_CURB_M + 2 * _BLOCK_M else 1
            directions = (far - near)[there] / wide[there, None]
            starts = near[there] + _FROM_CURB_M * directions + np.array([0.0, 0.0, _BLOCK_HIGH_M])
            steps = np.linspace(0.0, blocks * _BLOCK_M, blocks + 1)
            rows = starts[:, None] + steps[:, None] * directions[:, None]
            built.mesh.add(grid(rows), Material.TACTILE, GROUND, NO_THING)


def _add_blocks(
    section: StreetSection, built: SectionBuilder, lines: tuple[Floats, Floats, Floats], side: int
) -> None:
    chainages, near, far = lines
    offsets = side * np.column_stack([near, far])
    rows = section.position(chainages[:, None], offsets, _BLOCK_HIGH_M)
    built.mesh.add(grid(rows), Material.TACTILE, GROUND, NO_THING)


def _stretches(wanted: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> list[tuple[int, int]]:
    """First and last-but-one rows of the stretches in which something holds."""
    padded = np.concatenate([[False], wanted, [False]])
    turns = np.flatnonzero(padded[1:] != padded[:-1])
    return [(int(one), int(other)) for one, other in zip(turns[::2], turns[1::2], strict=True)]

"""Aprons of L-gutters: blocks with joints between them, catch basins under square gratings.

Each apron is built from the lines that the ground leaves open for it, so that it meets the asphalt
and the curb's foot exactly. Things: ``basin`` (frame and shaft) and ``grating`` (pieces: see
`lid_shapes`). Truth: one polygon for each grating, a run of its own, and a cover.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.gutters.lid_shapes import (
    SIDES_PIECE,
    Grating,
    grating_pieces,
)
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.cover_truth import tell_square_cover
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, grid
from processing.laboratory.simulate.scene.things import NO_THING, Fact, SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.plan import LEFT, SIDES
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.sweep import Sweep

GUTTER = 11
_RUN_IN_M = 1.0  # no basin so near to a ramp or to the section's end
_LEAST_BLOCK_M = 0.15
_GAP_M = 0.005  # between a grating and its frame
_STEP_MOST_M = 0.003
_SKIRT_M = 0.02
"""How far the blocks reach down at both sides, so that no beam passes below a joint's ends."""


@dataclass(frozen=True)
class _Habit:
    """What the aprons of a side have in common; lengths in m.

    Attributes
    ----------
    block_m : float
        From joint to joint.
    joint_m, joint_deep_m : float
    step_m : float
        Standard deviation of the steps between blocks at the asphalt.
    basin_m : float
        From one catch basin to the next.
    grating_m : float
        Length of their gratings.
    """

    block_m: float
    joint_m: float
    joint_deep_m: float
    step_m: float
    basin_m: float
    grating_m: float
    pitch_m: float
    bar_m: float
    shaft_m: float


@dataclass(frozen=True)
class _Apron:
    """An apron's lines.

    Attributes
    ----------
    near, far : (n, 3) float64
        At the asphalt and at the curb's foot, m, the street's frame.
    chainages : (n,) float64
    along : (n,) float64
        m along the line at the asphalt.
    """

    near: Floats
    far: Floats
    chainages: Floats
    along: Floats
    side: int
    material: Material

    @staticmethod
    def of(section: StreetSection, sweep: Sweep, number: int, side: int) -> _Apron:
        """The apron between two lines of a sweep."""
        lines = [
            section.alignment.at(
                sweep.chainages[:, line], sweep.offsets[:, line], sweep.heights[:, line]
            )
            for line in (number, number + 1)
        ]
        steps = np.linalg.norm(np.diff(lines[0], axis=0), axis=1)
        along = np.append(0.0, np.cumsum(steps))
        material = sweep.profile.strips[number].material
        return _Apron(lines[0], lines[1], sweep.chainages[:, number], along, side, material)

    def at(self, along: Floats, share: float) -> Floats:
        """Places at distances along, a share of the way from the asphalt to the curb."""
        line = self.near + share * (self.far - self.near)
        return np.column_stack([np.interp(along, self.along, line[:, axis]) for axis in range(3)])


def add_aprons(section: StreetSection, built: SectionBuilder) -> None:
    """Add the aprons of a section's sides and of the corners of its side streets."""
    for side in SIDES:
        part = section.layout.sides[side]
        habit = _habit_of(section, side)
        for number, corner in enumerate(part.corners):
            random = section.chance("apron of a corner", side * (number + 1))
            for apron in _aprons(section, corner.sweep, side):
                _add_apron(built, apron, habit, [], random)
        random = section.chance("apron", side)
        for apron in _aprons(section, part.sweep, side):
            basins = [*_basins(section, apron, habit, random)]
            _add_apron(built, apron, habit, basins, random)


def _aprons(section: StreetSection, sweep: Sweep, side: int) -> Iterator[_Apron]:
    for number, strip in enumerate(sweep.profile.strips):
        if strip.kind == "apron":
            yield _Apron.of(section, sweep, number, side)


def _habit_of(section: StreetSection, side: int) -> _Habit:
    plan = section.plan.side(side)
    random = chance(section.seed, "aprons", side, int(plan.drain_m * 1e6))
    # Blocks of 0.6 m (JIS A 5371, 鉄筋コンクリートL形), or cast in place with joints up to 2 m.
    block = 0.6 if random.random() < 0.55 else float(random.uniform(0.9, 2.0))
    bar = float(random.uniform(0.005, 0.008))
    return _Habit(
        block,
        float(random.uniform(0.003, 0.009)),
        float(random.uniform(0.002, 0.012)),
        float(random.uniform(0.0, 0.0015)),
        float(random.uniform(12.0, 30.0)),  # 20 m is usual (道路土工要綱, 2009)
        float(random.choice([0.4, 0.5, 0.5, random.uniform(0.35, 0.6)])),
        max(float(random.uniform(0.02, 0.035)), 2 * bar),
        bar,
        float(random.uniform(0.4, 0.9)),
    )


def _basins(
    section: StreetSection, apron: _Apron, habit: _Habit, random: Generator
) -> Iterator[float]:
    """Where catch basins begin, m along the apron: where the curb is whole, about evenly."""
    drops = section.layout.sides[apron.side].drops
    at = float(random.uniform(0.0, habit.basin_m))
    while at < apron.along[-1] - habit.grating_m - _RUN_IN_M:
        first = float(np.interp(at, apron.along, apron.chainages))
        last = float(np.interp(at + habit.grating_m, apron.along, apron.chainages))
        is_clear = all(
            last + _RUN_IN_M < one.from_m or first - _RUN_IN_M > one.to_m for one in drops
        )
        if at > _RUN_IN_M and is_clear and random.random() < 0.93:
            yield at
            at += habit.basin_m * float(random.uniform(0.8, 1.2))
        else:
            at += _RUN_IN_M


def _add_apron(
    built: SectionBuilder, apron: _Apron, habit: _Habit, basins: list[float], random: Generator
) -> None:
    at = 0.0
    for basin in basins:
        _add_blocks(built, apron, habit, (at, basin), random)
        at = basin + habit.grating_m + 2 * _GAP_M
        _add_basin(built, apron, habit, basin, random)
    _add_blocks(built, apron, habit, (at, float(apron.along[-1])), random)


def _add_blocks(
    built: SectionBuilder,
    apron: _Apron,
    habit: _Habit,
    ends: tuple[float, float],
    random: Generator,
) -> None:
    """Blocks between two places: one surface that dips into each joint."""
    low, high = ends
    if high - low < 1e-6:
        return
    count = int((high - low) / habit.block_m) + 2
    blocks = habit.block_m * (1 + random.normal(0, 0.004, count))
    joints = low + float(random.uniform(0.2, 1.0)) * habit.block_m + np.cumsum(blocks) - blocks[0]
    joints = joints[(joints > low + _LEAST_BLOCK_M) & (joints < high - _LEAST_BLOCK_M)]
    half = habit.joint_m * random.uniform(0.6, 1.4, joints.size) / 2
    deep = habit.joint_deep_m * random.uniform(0.3, 1.0, joints.size)
    inner = apron.along[(apron.along > low) & (apron.along < high)]
    sunk = (np.abs(inner[:, None] - joints) < half) @ -deep
    walls = [joints - half, joints - half, joints + half, joints + half]
    none = np.zeros(joints.size)
    positions = np.concatenate([[low], inner, *walls, [high]])
    levels = np.concatenate([[0.0], sunk, none, -deep, -deep, none, [0.0]])
    # Both ends of a wall lie on one place: it goes down before the joint and up behind it.
    turn = np.concatenate([[0.0], 0 * inner, none, none + 1, none + 2, none + 3, [0.0]])
    order = np.lexsort((turn, positions))
    positions, levels = positions[order], levels[order]
    steps = np.clip(random.normal(0, habit.step_m, joints.size + 1), -_STEP_MOST_M, _STEP_MOST_M)
    steps[[0, -1]] = 0.0
    block = np.searchsorted(joints, positions)
    upright = np.array([0.0, 0.0, 1.0])
    edge, foot = apron.at(positions, 0.0), apron.at(positions, 1.0)
    near, far = edge + upright * (levels + steps[block])[:, None], foot + upright * levels[:, None]
    under = np.array([0.0, 0.0, _SKIRT_M])
    rows = np.stack([edge - under, near, far, foot - under], axis=1)
    built.mesh.add(grid(rows), apron.material, GUTTER, NO_THING)


def _add_basin(
    built: SectionBuilder, apron: _Apron, habit: _Habit, start: float, random: Generator
) -> None:
    """A catch basin (集水桝): a shaft, its concrete rims beside the grating, the grating."""
    end = start + habit.grating_m + 2 * _GAP_M
    inside = apron.along[(apron.along > start) & (apron.along < end)]
    along = np.concatenate([[start], inside, [end]])
    width = float(np.linalg.norm(apron.at(along[:1], 1.0) - apron.at(along[:1], 0.0)))
    rims = (float(random.uniform(0.03, 0.06)) / width, 1 - float(random.uniform(0.04, 0.1)) / width)
    lines = [apron.at(along, share) for share in (0.0, *rims, 1.0)]
    basin = built.thing("basin")
    for near, far in ((0, 1), (2, 3)):
        rows = np.stack([lines[near], lines[far]], axis=1)
        built.mesh.add(grid(rows), apron.material, GUTTER, basin)
    ring = np.concatenate([lines[1], lines[2][::-1], lines[1][:1]])
    deep = np.array([0.0, 0.0, habit.shaft_m])
    built.mesh.add(grid(np.stack([ring, ring - deep])), Material.OLD_CONCRETE, GUTTER, basin)
    silt = (Material.SOIL, Material.WATER)[int(random.random() < 0.4)]
    floor = np.stack([lines[1] - deep, lines[2] - deep], axis=1)
    built.mesh.add(grid(floor), silt, GUTTER, basin)
    edges = lines[1][[0, -1]], lines[2][[0, -1]]
    position = float(np.interp(start + habit.grating_m / 2, apron.along, apron.chainages))
    _add_grating(built, (apron.side, position), habit, edges, basin)


def _add_grating(
    built: SectionBuilder,
    where: tuple[int, float],
    habit: _Habit,
    edges: tuple[Floats, Floats],
    basin: int,
) -> None:
    """Add a grating of a side and chainage between the rims' edges, and its truth."""
    side, chainage = where
    near, far = edges
    along = near[1] - near[0] + far[1] - far[0]
    along /= np.linalg.norm(along)
    across = (far - near).sum(axis=0) * side
    up = np.cross(along, across)
    up /= np.linalg.norm(up)
    left = np.cross(up, along)
    middle = (near.sum(axis=0) + far.sum(axis=0)) / 4
    wide = float(np.linalg.norm(far - near, axis=1).min()) - 2 * _GAP_M
    shape = grating_pieces(Grating(habit.grating_m, wide, 0.04, habit.pitch_m, habit.bar_m))
    axes = np.stack([along, left, up])
    instance = built.thing("grating")
    built.mesh.add(
        (middle + shape.vertices @ axes, shape.triangles),
        Material.GRATING,
        GUTTER,
        instance,
        piece=shape.piece,
    )
    x, y = habit.grating_m / 2, wide / 2
    ring = np.array([[-x, -y, 0], [x, -y, 0], [x, y, 0], [-x, y, 0], [-x, -y, 0]])
    facts = grating_facts((wide, habit.grating_m), (basin, 0), side)
    built.truth.append(
        TrueFeature("gutters", "Polygon", middle + ring @ axes, facts, instance, chainage)
    )
    corners = (middle + ring @ axes)[:-1]
    lies = corners, chainage, "gutter"
    tell_square_cover(built, lies, "rain_inlet", (instance, SIDES_PIECE))


def grating_facts(
    size_m: tuple[float, float], position: tuple[int, int], side: int
) -> dict[str, Fact]:
    """What the truth tells of a grating.

    Parameters
    ----------
    size_m : (float, float)
        Across its gutter and along it.
    position : (int, int)
        Its run, and which it is there.
    """
    return {
        "kind": "gutter",
        "type": "grating",
        "width_m": round(size_m[0], 4),
        "length_m": round(size_m[1], 4),
        "run": position[0],
        "order": position[1],
        "holes": 0,
        "hole_length_m": 0.0,
        "hole_width_m": 0.0,
        "side": "left" if side == LEFT else "right",
        "uncovered": 1.0,
    }

"""Where things stand on a site on one date, and the triangles of all of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers, Mesh, MeshBuilder
from processing.laboratory.simulate.sites.barriers import cone, fence_panel, hut, net, scaffold
from processing.laboratory.simulate.sites.bodies import OTHER, SiteBody, SiteKind
from processing.laboratory.simulate.sites.machines import MACHINES
from processing.laboratory.simulate.sites.relief import wander
from processing.laboratory.simulate.sites.small_things import (
    batter_board,
    bush,
    survey_pole,
    worker,
)
from processing.laboratory.simulate.sites.stores import STORES
from processing.laboratory.simulate.sites.terrain import SiteGround, SiteTerrain, StopCheck

GROUND = 2
_PANEL_M = 1.8
_FOLLOWS_GROUND = (SiteKind.FENCE, SiteKind.NET)
_TRIES = 60


@dataclass(frozen=True)
class StandingObject:
    """A thing that stands still: its kind and place, m, the site's frame."""

    kind: SiteKind
    x: float
    y: float
    radius_m: float


@dataclass
class SiteLayout:
    """What stands on one date's ground.

    Attributes
    ----------
    mesh : MeshBuilder
        The ground (instance 0, label 2) and all things (label 1), the site's frame.
    things : list of StandingObject
        The thing of instance n is number n - 1.
    """

    ground: SiteGround
    mesh: MeshBuilder = field(default_factory=MeshBuilder)
    things: list[StandingObject] = field(default_factory=list)

    def add(self, body: SiteBody, x: float, y: float, heading_rad: float) -> None:
        """Put a body on the ground."""
        instance = len(self.things) + 1
        for (vertices, triangles), material in body.parts:
            stood = stand_on_ground(body, self.ground, vertices, (x, y, heading_rad))
            self.mesh.add((stood, triangles), material, OTHER, instance)
        self.things.append(StandingObject(body.kind, x, y, body.radius_m))

    def is_free(self, x: float, y: float, radius_m: float) -> bool:
        """Whether nothing large stands there."""
        return all(
            math.hypot(one.x - x, one.y - y) > radius_m + one.radius_m for one in self.things
        )

    def kinds(self) -> Integers:
        """Kind of every instance: (instances + 1,) int64."""
        return np.array([int(SiteKind.TERRAIN), *(int(one.kind) for one in self.things)], np.int64)


def layout_of(seed: int, date: str, terrain: SiteTerrain, check: StopCheck) -> SiteLayout:
    """Everything that stands still on one date.

    Parameters
    ----------
    check : callable
        Called for every few things; raises to stop.
    """
    ground = terrain.before if date == "before" else terrain.after
    layout = SiteLayout(ground)
    layout.mesh.add(ground.heights.shape(), ground.triangle_materials(), GROUND, 0)
    check()
    furnish = _Furnisher(layout, chance(seed, "things", date), check, *ground.heights.size_m)
    furnish.large()
    furnish.fences()
    furnish.small()
    _plants(seed, layout, terrain, check)
    return layout


def stand_on_ground(
    body: SiteBody, ground: SiteGround, vertices: Floats, where: tuple[float, float, float]
) -> Floats:
    """Vertices of a body where it stands: upright, tilted as its footing is, or along the ground.

    Parameters
    ----------
    where : (float, float, float)
        x and y in the site's frame, m, and heading in radians anticlockwise from east.
    """
    x, y, heading = where
    forward = np.array([np.cos(heading), np.sin(heading)])
    left = np.array([-forward[1], forward[0]])
    plan = np.array([x, y]) + vertices[:, :1] * forward + vertices[:, 1:2] * left
    if body.kind in _FOLLOWS_GROUND:
        along = np.array([x, y]) + vertices[:, :1] * forward
        z = ground.heights.height(along[:, 0], along[:, 1]) + vertices[:, 2]
        return np.column_stack([plan, z])
    if not any(body.footing_m):
        base = ground.heights.height(x, y) - 0.01
        return np.column_stack([plan, base + vertices[:, 2]])
    half, side = body.footing_m
    corners = np.array([x, y]) + np.array(
        [a * half * forward + b * side * left for a in (1, -1) for b in (1, -1)]
    )
    z = ground.heights.height(corners[:, 0], corners[:, 1])
    pitch = (z[0] + z[1] - z[2] - z[3]) / (4 * half)
    roll = (z[0] + z[2] - z[1] - z[3]) / (4 * side)
    x_axis = np.array([*forward, pitch]) / np.sqrt(1 + pitch**2)
    y_axis = np.array([*left, roll])
    y_axis -= x_axis * (x_axis @ y_axis)
    y_axis /= np.linalg.norm(y_axis)
    axes = np.stack([x_axis, y_axis, np.cross(x_axis, y_axis)])
    return np.asarray(np.array([x, y, z.mean() - 0.02]) + vertices @ axes, np.float64)


@dataclass
class _Furnisher:
    layout: SiteLayout
    random: Generator
    check: StopCheck
    east_m: float
    north_m: float

    def large(self) -> None:
        """Huts, machines, scaffolds, material, nets."""
        for _ in range(self._count(0, 2)):
            self._put(hut, 0.35)
        for _ in range(self._count(2, 5)):
            self._put(MACHINES[int(self.random.integers(len(MACHINES)))], 0.5)
        for _ in range(self._count(0, 2)):
            self._put(scaffold, 0.3)
        for _ in range(self._count(2, 6)):
            self._put(STORES[int(self.random.integers(len(STORES)))], 0.35)
        for _ in range(self._count(0, 3)):
            self._put(net, 2.5)

    def fences(self) -> None:
        """Rows of panels, now and then with one missing."""
        for _ in range(self._count(1, 3)):
            path = wander(self.random, self._position(), self._position(), 1.0)
            self.check()
            look = int(self.random.integers(1 << 30))
            row = _along(path, _PANEL_M, most=24)
            free = [self.layout.is_free(x, y, 0.3) for x, y, _ in row]
            for (x, y, heading), has_room in zip(row, free, strict=True):
                if self.random.random() < 0.08 or not has_room:
                    continue
                body = fence_panel(np.random.default_rng(look), _PANEL_M)
                self.layout.add(body, x, y, heading + self.random.normal(0, 0.02))

    def small(self) -> None:
        """Cones in rows, batter boards across slopes, poles, people who stand."""
        for _ in range(self._count(0, 3)):
            self.check()
            path = wander(self.random, self._position(), self._position(), 2.0)
            for x, y, heading in _along(path, self.random.uniform(1.5, 4), most=12):
                if self.layout.is_free(x, y, 0.2):
                    self.layout.add(cone(self.random), x, y, heading)
        for _ in range(self._count(4, 14)):
            x, y = self._position()
            east, north = self.layout.ground.heights.slope(x, y, 2.0)
            downhill = float(np.arctan2(-north, -east)) + self.random.normal(0, 0.06)
            if np.hypot(east, north) > 0.12 and self.layout.is_free(x, y, 1.2):
                self.layout.add(batter_board(self.random), x, y, downhill)
        for maker, count in ((survey_pole, self._count(2, 9)), (worker, self._count(1, 4))):
            for _ in range(count):
                self._put(maker, 1.5)

    def _put(self, make: Callable[[Generator], SiteBody], uneven_m: float) -> None:
        """Put a body where there is room and the ground is even enough for it, or nowhere."""
        self.check()
        body = make(self.random)
        radius = body.radius_m
        heights = self.layout.ground.heights
        for _ in range(_TRIES):
            x, y = self._position()
            heading = self.random.uniform(-np.pi, np.pi)
            around = np.linspace(0, 2 * np.pi, 12, endpoint=False)
            reach = min(radius, 4.0)
            z = heights.height(x + reach * np.cos(around), y + reach * np.sin(around))
            bend = np.abs(z[:6] + z[6:] - 2 * heights.height(x, y)).max()
            rough = float(np.ptp(z)) if not any(body.footing_m) else float(bend)
            # Machines and stacks stand on slopes of 1:3 at most.
            steepest = 0.65 * reach if any(body.footing_m) else reach
            if rough < uneven_m and np.ptp(z) < steepest and self.layout.is_free(x, y, radius):
                self.layout.add(body, x, y, heading)
                return

    def _position(self) -> tuple[float, float]:
        x, y = self.random.uniform(0.05, 0.95, 2)
        return float(x) * self.east_m, float(y) * self.north_m

    def _count(self, low: int, high: int) -> int:
        scale = float(np.clip(np.sqrt(self.east_m * self.north_m / 2600), 0.4, 4))
        return round(int(self.random.integers(low, high + 1)) * scale)


def _along(path: Floats, every_m: float, *, most: int) -> list[tuple[float, float, float]]:
    """Places along a path with its direction there."""
    runs = np.r_[0.0, np.cumsum(np.hypot(*np.diff(path, axis=0).T))]
    marks = np.arange(0.0, runs[-1], every_m)[:most]
    x, y = np.interp(marks, runs, path[:, 0]), np.interp(marks, runs, path[:, 1])
    on = np.minimum(marks + every_m, runs[-1])
    dx, dy = np.interp(on, runs, path[:, 0]) - x, np.interp(on, runs, path[:, 1]) - y
    return list(zip(x.tolist(), y.tolist(), np.arctan2(dy, dx).tolist(), strict=True))


def _plants(seed: int, layout: SiteLayout, terrain: SiteTerrain, check: StopCheck) -> None:
    """Bushes where grass grows; the same on both dates where the ground is the same."""
    random = chance(seed, "plants")
    east, north = layout.ground.heights.size_m
    count = int(random.integers(8, 60) * np.clip(np.sqrt(east * north / 2600), 0.4, 3))
    clumps = random.uniform((0, 0), (east, north), (4, 2))
    for number in range(count):
        x, y = clumps[number % 4] + random.normal(0, 4.0, 2)
        if not (0.5 < x < east - 0.5 and 0.5 < y < north - 0.5):
            continue
        j, i = int(y / layout.ground.heights.res), int(x / layout.ground.heights.res)
        grows = terrain.before.material[j, i] == Material.GRASS
        stays = abs(float(terrain.after.heights.z[j, i] - terrain.before.heights.z[j, i])) < 0.05
        is_left = layout.ground is terrain.before or stays
        if grows and is_left and layout.is_free(x, y, 0.4):
            check()
            layout.add(bush(chance(seed, "bush", number)), float(x), float(y), 0.0)


def scene_mesh(layout: SiteLayout) -> Mesh:
    """All triangles of a date."""
    return layout.mesh.mesh()

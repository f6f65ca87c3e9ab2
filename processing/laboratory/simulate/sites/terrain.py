"""The ground of a site on two dates: the work's progress, and what machines and rain do to it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.sites.heights import HeightGrid, nodes_apart
from processing.laboratory.simulate.sites.relief import (
    Mask,
    add_crawler_prints,
    ditch,
    heap,
    puddle,
    ruts,
    step,
    undulation,
    wander,
)
from processing.laboratory.simulate.sites.works import (
    PLANS,
    Plan,
    WorkPlacement,
    progress_of,
    work_placement_of,
)

StopCheck = Callable[[], None]
Bytes = NDArray[np.uint8]
PlanPoint = tuple[float, float]

_EDGE_M = 2.0  # over which a strip of work ends


@dataclass(frozen=True)
class SiteGround:
    """The ground of one date.

    Attributes
    ----------
    heights : HeightGrid
    material : (rows, columns) uint8
        Of the cell whose lower left node it is; the last row and column belong to no cell.
    is_reached : (rows, columns) bool
        Nodes where a tripod is set up if there is room.
    """

    heights: HeightGrid
    material: Bytes
    is_reached: Mask

    def triangle_materials(self) -> Bytes:
        """As :meth:`HeightGrid.shape` orders the triangles."""
        return np.repeat(self.material[:-1, :-1].ravel(), 2)


@dataclass(frozen=True)
class SiteTerrain:
    """The ground on both dates.

    Attributes
    ----------
    unchanged : (rows, columns) bool
        Nodes that are the same on both, to the last bit.
    """

    before: SiteGround
    after: SiteGround
    unchanged: Mask


def terrain_of(seed: int, style: str, length_m: float, check: StopCheck) -> SiteTerrain:
    """The ground of a seed.

    Parameters
    ----------
    style : {"levee", "cutting", "pad", "hillside"}
    length_m : float
        Of the site's longer side.
    check : callable
        Called every few tens of milliseconds; raises to stop.
    """
    random = chance(seed, "site")
    res = nodes_apart(length_m)
    wide = length_m * random.uniform(0.58, 0.86)
    columns, rows = round(length_m / res) + 1, round(wide / res) + 1
    x, y = np.meshgrid(np.arange(columns) * res, np.arange(rows) * res)
    lie = work_placement_of(random, x, y)
    check()
    plan = PLANS[style](random, lie)
    lowest = random.uniform(1.0, 60.0) - min(float(plan.natural.min()), float(plan.design.min()))
    plan = replace(plan, natural=plan.natural + lowest, design=plan.design + lowest)
    check()
    first, second = progress_of(random, lie, plan)
    check()
    states = [plan.built(one.down_to, one.up_to) for one in (first, second)]
    grown = undulation(random, x, y, 6.0) > random.uniform(-0.6, 0.9)
    field = _Field(seed, lie, check)
    check()
    rough = 0.003 * random.normal(size=x.shape) + 0.006 * undulation(random, x, y, 0.35)
    before, material = field.weathered("before", states[0], plan, grown)
    before += rough
    check()
    after, later = field.weathered("after", states[1], plan, grown)
    moved = np.abs(states[1] - states[0]) > 0.01
    other = 0.004 * random.normal(size=x.shape) + 0.009 * undulation(random, x, y, 0.4)
    after += np.where(moved, other, rough)
    check()
    active = _active(random, lie)
    reached = _reached(random, lie, plan)
    active = active * np.clip((plan.reach_m - np.abs(lie.v)) / _EDGE_M, 0, 1)
    after = before + active * (after - before)
    later = np.where(active > 0, later, material).astype(np.uint8)
    return SiteTerrain(
        SiteGround(HeightGrid(before.astype(np.float32), res), material, reached),
        SiteGround(HeightGrid(after.astype(np.float32), res), later, reached),
        np.asarray(active == 0, np.bool_),
    )


def _active(random: Generator, lie: WorkPlacement) -> Floats:
    """1 where work goes on between the dates, 0 where nothing changes at all."""
    span = float(np.ptp(lie.u))
    start = lie.u.min() + random.uniform(0.1, 0.32) * span
    ramp = random.uniform(0.2, 2.0)
    ahead: Floats = np.clip((lie.u - start) / ramp, 0, 1)
    return ahead if random.random() < 0.5 else ahead[:, ::-1].copy()


def _reached(random: Generator, lie: WorkPlacement, plan: Plan) -> Mask:
    """Where scanners are carried: everywhere, or along the work but for one far end of it."""
    if not np.isfinite(plan.reach_m):
        return np.ones(lie.x.shape, np.bool_)
    left = random.uniform(0.15, 0.3) * float(np.ptp(lie.u))
    along = lie.u if random.random() < 0.5 else -lie.u
    return np.asarray((np.abs(lie.v) <= plan.reach_m) & (along <= along.max() - left), np.bool_)


@dataclass(frozen=True)
class _Field:
    """Marks of a date on the ground."""

    seed: int
    lie: WorkPlacement
    check: StopCheck

    def weathered(self, date: str, built: Floats, plan: Plan, grown: Mask) -> tuple[Floats, Bytes]:
        """Heights with the marks of machines and rain, and what the ground is made of."""
        random = chance(self.seed, "marks", date)
        x, y = self.lie.x, self.lie.y
        z = built.copy()
        worked = np.abs(built - plan.natural) > 0.03
        material = np.full(z.shape, int(Material.SOIL), np.uint8)
        material[grown & ~worked] = int(Material.GRASS)
        if random.random() < 0.3:
            material[worked & (np.abs(built - plan.design) < 0.01)] = int(Material.GRAVEL)
        for number in range(self._count(random, 1, 5)):
            path = wander(random, self._position(random), self._position(random), 3.0)
            if number % 2:
                add_crawler_prints(random, z, x, y, path)
            else:
                track = ruts(random, z, x, y, path)
                is_paved = random.random() < 0.3
                material[track] = int(Material.GRAVEL if is_paved else Material.SOIL)
            self.check()
        self._dug(random, z, material)
        for _ in range(self._count(random, 2, 10)):
            where = self._position(random)
            self._local(z, where, 4.0, partial(_wet, random), material)
            self.check()
        return z, material

    def _dug(self, random: Generator, z: Floats, material: Bytes) -> None:
        soil = int(Material.SOIL)
        for _ in range(self._count(random, 1, 6)):
            where = self._position(random)
            self._local(z, where, 9.0, partial(_tip, random), material)
            self.check()
        for _ in range(self._count(random, 0, 3)):
            start = self._position(random)
            end = np.asarray(start) + random.uniform(-14, 14, 2)
            path = wander(random, start, end, 0.6)
            material[ditch(random, z, self.lie.x, self.lie.y, path)] = soil
            self.check()
        for _ in range(self._count(random, 0, 4)):
            where = self._position(random)
            self._local(z, where, 6.5, partial(_dig, random), material)
            self.check()

    def _local(
        self,
        z: Floats,
        where: PlanPoint,
        reach: float,
        change: Callable[[Floats, tuple[Floats, Floats, Bytes], PlanPoint], None],
        material: Bytes,
    ) -> None:
        """Change a window of the ground only: what is small costs little."""
        res = float(self.lie.x[0, 1] - self.lie.x[0, 0])
        i, j = int(where[0] / res), int(where[1] / res)
        half = int(reach / res) + 2
        rows = slice(max(0, j - half), j + half + 1)
        columns = slice(max(0, i - half), i + half + 1)
        window = z[rows, columns]
        positions = self.lie.x[rows, columns], self.lie.y[rows, columns], material[rows, columns]
        change(window, positions, where)

    def _count(self, random: Generator, low: int, high: int) -> int:
        """How many: more on a larger site, but not in proportion."""
        scale = float(np.clip(np.sqrt(np.ptp(self.lie.x) * np.ptp(self.lie.y) / 2600), 0.4, 4))
        return round(int(random.integers(low, high + 1)) * scale)

    def _position(self, random: Generator) -> tuple[float, float]:
        east, north = float(self.lie.x[0, -1]), float(self.lie.y[-1, 0])
        return random.uniform(0.06, 0.94) * east, random.uniform(0.08, 0.92) * north


def _tip(
    random: Generator, z: Floats, positions: tuple[Floats, Floats, Bytes], where: PlanPoint
) -> None:
    x, y, material = positions
    material[heap(random, z, x, y, where)] = int(Material.SOIL)


def _dig(
    random: Generator, z: Floats, positions: tuple[Floats, Floats, Bytes], where: PlanPoint
) -> None:
    step(random, z, positions[0], positions[1], where)


def _wet(
    random: Generator, z: Floats, positions: tuple[Floats, Floats, Bytes], where: PlanPoint
) -> None:
    x, y, material = positions
    material[puddle(random, z, x, y, where)] = int(Material.WATER)

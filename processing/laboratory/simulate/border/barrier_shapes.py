"""Guard rails, pipes, cables, fences and walls of concrete or sheets: one stretch of each.

Heights and spacings are about those of 防護柵の設置基準 (2021) and its makers' tables: beam 35 cm
high about 60 cm above the ground, posts every 2–4 m; fences for people 80 cm.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.border.along import pipe, posts, stations, sweep_section, wall
from processing.laboratory.simulate.border.line_things import LineThing, spacing_of
from processing.laboratory.simulate.border.wall_lines import add_swept_wall
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.section import StreetSection

_STEP_M = 2.0
_BEAM = np.array(
    [
        (-0.07, 0.425), (-0.075, 0.44), (-0.15, 0.475), (-0.15, 0.535), (-0.085, 0.585),
        (-0.085, 0.615), (-0.15, 0.665), (-0.15, 0.725), (-0.075, 0.76), (-0.07, 0.775),
    ]
)  # fmt: skip
_PAINTS = (Material.PAINTED_METAL, Material.PAINTED_METAL, Material.STEEL)


@dataclass(frozen=True)
class BarrierRun:
    """Where a barrier runs: chainages, offset of its posts, m to the left of the centre.

    Attributes
    ----------
    is_double : bool
        In a median: a beam on both sides of the posts.
    """

    from_m: float
    to_m: float
    offset_m: float
    is_double: bool = False

    @property
    def long_m(self) -> float:
        """Its length along the centre."""
        return self.to_m - self.from_m

    @property
    def line(self) -> tuple[float, float, float]:
        """Chainages from and to, and the offset."""
        return self.from_m, self.to_m, self.offset_m

    def along(self, step_m: float = _STEP_M) -> Floats:
        """Chainages at most a step apart."""
        return stations(self.from_m, self.to_m, step_m)

    def spacing(self, step_m: float) -> float:
        """How far apart posts stand that are at most a step apart."""
        return spacing_of(self.from_m, self.to_m, step_m)


Barrier = Callable[[Generator, StreetSection, SectionBuilder, BarrierRun], None]


def add_beam(
    random: Generator, section: StreetSection, built: SectionBuilder, stretch: BarrierRun
) -> None:
    """Add a guard rail of W-shaped beams; some are dented, some end in the ground."""
    thing, paint = _thing(section, built, "guardrail", stretch), _PAINTS[int(random.integers(3))]
    spacing = float(random.choice([2.0, 4.0]))
    lift = float(random.uniform(-0.04, 0.1))
    along = stretch.along(1.0)
    dent = float(random.uniform(stretch.from_m, stretch.to_m))
    deep = float(random.uniform(0.03, 0.15)) if random.random() < 0.25 else 0.0
    direction = np.sign(stretch.offset_m) or 1.0
    offsets = stretch.offset_m + direction * deep * np.exp(-(((along - dent) / 0.9) ** 2))
    ends = [at for at in (stretch.from_m, stretch.to_m) if _is_free_end(section, at)]
    is_buried = random.random() < 0.2 and stretch.long_m > 16.0
    sunk = np.zeros(along.size)
    for at in ends if is_buried else ():
        sunk = np.maximum(sunk, (4.0 - np.abs(along - at)) / 4.0 * 0.75)
    outlines = [_BEAM + [0.0, lift]]  # noqa: RUF005 (added, not joined)
    if stretch.is_double:
        outlines.append(outlines[0] * [-1.0, 1.0])
    for outline in outlines:
        beam = sweep_section(section, along, offsets, outline, is_closed=False, sunk=sunk)
        thing.add(beam, paint)
    at_posts = stretch.along(spacing)
    high = 0.75 + lift - np.interp(at_posts, along, sunk)
    feet = section.position(at_posts, stretch.offset_m)[high > 0.1]
    radius = float(random.choice([0.057, 0.07]))
    thing.add(posts(feet, radius, high[high > 0.1]), paint)
    for at in () if is_buried else ends:
        curl = section.position(np.array([at]), stretch.offset_m - direction * 0.02, 0.43 + lift)
        thing.add(posts(curl, 0.12, 0.34, below_m=0.0), paint)
    thing.tell("guard_rail", float(_BEAM[-1, 1]) + lift, stretch.spacing(spacing), "guard_rail")


def _thing(
    section: StreetSection, built: SectionBuilder, kind: str, stretch: BarrierRun
) -> LineThing:
    return LineThing(section, built, kind, stretch.line)


def _is_free_end(section: StreetSection, chainage_m: float) -> bool:
    """Whether a barrier ends there, rather than going on into the next section."""
    plan = section.plan
    return min(abs(chainage_m - plan.start_m), abs(chainage_m - plan.end_m)) > 0.01


def add_pipes(
    random: Generator, section: StreetSection, built: SectionBuilder, stretch: BarrierRun
) -> None:
    """Add a guard pipe: two to four pipes on posts."""
    heights = np.linspace(0.3, float(random.uniform(0.75, 1.1)), int(random.integers(2, 5)))
    _add_rails(
        section,
        built,
        stretch,
        ("guard_pipe", _PAINTS[int(random.integers(3))]),
        (heights, float(random.uniform(0.021, 0.03)), float(random.choice([2.0, 3.0]))),
    )


def add_walkers_fence(
    random: Generator, section: StreetSection, built: SectionBuilder, stretch: BarrierRun
) -> None:
    """Add a fence that keeps people from crossing: rails, often upright bars between them."""
    high = float(random.uniform(0.7, 1.1))
    paint = (Material.PAINTED_METAL, Material.STEEL, Material.WOOD)[int(random.integers(3))]
    has_bars = random.random() < 0.5
    count = 2 if has_bars else int(random.integers(2, 4))
    heights = np.linspace(0.15 if has_bars else 0.4, high, count)
    spacing = float(random.choice([1.5, 2.0, 3.0]))
    thing = _add_rails(section, built, stretch, ("fence", paint), (heights, 0.021, spacing))
    if has_bars:
        bars = section.position(
            stretch.along(float(random.uniform(0.1, 0.16))), stretch.offset_m, 0.15
        )
        shape = posts(bars, 0.008, high - 0.15, sides=3, below_m=0.0)
        thing.add(shape, paint)


def add_cables(
    random: Generator, section: StreetSection, built: SectionBuilder, stretch: BarrierRun
) -> None:
    """Add a guard cable: three to five steel ropes between posts, thicker ones at both ends."""
    count, apart = int(random.integers(3, 6)), float(random.uniform(0.1, 0.13))
    heights = np.linspace(0.75 - (count - 1) * apart, 0.75, count)
    spacing = float(random.uniform(4.0, 6.0))
    thing = _add_rails(
        section, built, stretch, ("guard_cable", Material.STEEL), (heights, 0.009, spacing)
    )
    ends = section.position(np.array([stretch.from_m, stretch.to_m]), stretch.offset_m)
    thing.add(posts(ends, 0.085, 0.85), Material.STEEL)


def _add_rails(
    section: StreetSection,
    built: SectionBuilder,
    stretch: BarrierRun,
    looks: tuple[str, Material],
    measures: tuple[Floats, float, float],
) -> LineThing:
    """Add round rails at heights, of a radius, on posts at a spacing; their thing."""
    kind, material = looks
    heights, radius, spacing = measures
    thing = _thing(section, built, kind, stretch)
    for height in heights:
        outline = pipe(radius, float(height))
        shape = sweep_section(section, stretch.along(), stretch.offset_m, outline)
        thing.add(shape, material)
    feet = section.position(stretch.along(spacing), stretch.offset_m)
    high = float(heights.max()) + 0.03
    thing.add(posts(feet, max(1.4 * radius, 0.03), high), material)
    thing.tell(kind, high, stretch.spacing(spacing), kind)
    return thing


def add_concrete(
    random: Generator, section: StreetSection, built: SectionBuilder, stretch: BarrierRun
) -> None:
    """Add a wall of concrete with the safety shape, 0.8–1.15 m high (剛性防護柵)."""
    high, foot = float(random.uniform(0.8, 1.15)), float(random.uniform(0.2, 0.28))
    half = [(-foot, -0.2), (-foot, 0.075), (-foot + 0.11, 0.255), (-0.08, high)]
    outline = half + [(-x, z) for x, z in half[::-1]]
    shape = sweep_section(section, stretch.along(), stretch.offset_m, outline)
    worn = Material.OLD_CONCRETE if random.random() < 0.6 else Material.CONCRETE
    thing = _thing(section, built, "parapet", stretch)
    thing.add(shape, worn)
    thing.tell("parapet", high, None, "guard_wall")
    for edge in (-foot, foot):
        _add_other_wall(section, built, thing.instance, stretch, (edge, high))


def add_noise_barrier(
    random: Generator, section: StreetSection, built: SectionBuilder, stretch: BarrierRun
) -> None:
    """Add a noise barrier: posts every 2 or 4 m, panels 2–4 m high, often clear ones on top."""
    high, thing = float(random.uniform(2.0, 4.0)), _thing(section, built, "noise_barrier", stretch)
    clear = float(random.uniform(0.8, 1.5)) if random.random() < 0.35 else 0.0
    along = stretch.along()
    for outline, material in (
        (wall(0.25, 0.4), Material.OLD_CONCRETE),
        (_panel(0.4, high - clear), Material.PAINTED_METAL),
        (_panel(high - clear, high), Material.GLASS),
    ):
        if outline[1][1] - outline[0][1] > 0.1:
            shape = sweep_section(section, along, stretch.offset_m, outline)
            thing.add(shape, material)
    spacing = float(random.choice([2.0, 4.0]))
    feet = section.position(stretch.along(spacing), stretch.offset_m)
    thing.add(posts(feet, 0.075, high + 0.05, sides=4), Material.STEEL)
    thing.tell("noise_barrier", high + 0.05, stretch.spacing(spacing), "noise_barrier")
    _add_other_wall(section, built, thing.instance, stretch, (0.0, high))


def _add_other_wall(
    section: StreetSection,
    built: SectionBuilder,
    instance: int,
    stretch: BarrierRun,
    measures: tuple[float, float],
) -> None:
    """Add the truth of what looks like a wall and is a barrier.

    Parameters
    ----------
    measures : (float, float)
        How far its foot lies to the left of the stretch, and its height, m.
    """
    edge, high = measures
    line = stretch.from_m, stretch.to_m, stretch.offset_m + edge
    add_swept_wall(section, built, instance, line, ("other", high, 0.0))


def _panel(low_m: float, high_m: float) -> list[tuple[float, float]]:
    return [(0.02, low_m), (0.02, high_m), (0.1, high_m), (0.1, low_m)]


BARRIERS: Mapping[str, Barrier] = {
    "beam": add_beam,
    "pipes": add_pipes,
    "walkers": add_walkers_fence,
    "cables": add_cables,
    "concrete": add_concrete,
    "noise": add_noise_barrier,
}

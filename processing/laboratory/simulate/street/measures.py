"""The measures of a side: those of its plan and those that a drawing adds, by chainage.

Where a section meets its neighbour, both take the mean of their measures, if they have the same
bands; else each keeps its own and the step is closed by a face.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import ArrayLike

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.plan import SidePlan
from processing.laboratory.simulate.street.stones import StoneRow

_CHANGE_M = 5.0
"""Over how many metres widths change to those of the next section."""

_LAND_CHANGE_M = 15.0


@dataclass(frozen=True)
class Measures:
    """Lengths in m, slopes as rise per metre; each () or (n,) float64.

    Attributes
    ----------
    drain, fall : float64
        Width of the gutter's band; its fall outwards.
    depth, wall : float64
        Of an open gutter: how deep, and how thick its walls are.
    wide, high, chamfer, batter : float64
        Of the curb stone.
    behind : float64
        Height of the walk behind a stone that stands above both, over the stone's foot.
    strip, soil, edging_wide, edging_high : float64
        Planting strip: how far the soil lies below the walk, and the stones towards the walk.
    walk, walk_slope, verge : float64
    shoulder, shoulder_low, shoulder_fall : float64
        Shoulder of gravel or soil: its width, how far it lies below the asphalt's edge, and its
        fall outwards.
    run, rise : float64
        How far and how high the slope outside goes.
    """

    drain: Floats
    fall: Floats
    depth: Floats
    wall: Floats
    wide: Floats
    high: Floats
    chamfer: Floats
    batter: Floats
    behind: Floats
    strip: Floats
    soil: Floats
    edging_wide: Floats
    edging_high: Floats
    walk: Floats
    walk_slope: Floats
    verge: Floats
    shoulder: Floats
    shoulder_low: Floats
    shoulder_fall: Floats
    run: Floats
    rise: Floats

    def all(self) -> tuple[Floats, ...]:
        """Every measure in the fields' order."""
        return tuple(getattr(self, one.name) for one in fields(self))

    def mixed(self, other: Measures, share: ArrayLike) -> Measures:
        """Between this (share 0) and another (1)."""
        part = np.asarray(share, np.float64)
        pairs = zip(self.all(), other.all(), strict=True)
        return Measures(*((1 - part) * mine + part * theirs for mine, theirs in pairs))


@dataclass(frozen=True)
class BandSurfaces:
    """What the bands of a side are made of.

    Attributes
    ----------
    row : StoneRow
        The curb's stones.
    shoulder : Material
        Of a soft shoulder.
    """

    gutter: Material
    stone: Material
    walk: Material
    row: StoneRow
    shoulder: Material


def measures_of(seed: int, side: SidePlan) -> Measures:
    """What is built on a side; the same for all sections that share its plan."""
    random = chance(seed, "measures", int(side.verge_m * 1e7), int(side.drain_m * 1e7))
    high, wide = side.curb_high_m, side.curb_wide_m
    chamfer = min(float(random.uniform(0.004, 0.03)), 0.3 * high, 0.25 * wide)
    # Batters of 1:10 to 1:20 (歩車道境界ブロック, JIS A 5371 appendix B).
    batter = float(random.uniform(0.05, 0.1)) if side.curb != "asphalt" else 0.5
    behind = {"raised": high, "semi": min(0.05, 0.5 * high)}.get(side.curb, 0.0)
    steepness = float(random.uniform(1.2, 1.8))
    if side.outside == "wall":
        steepness = float(random.uniform(0.03, 0.3))
    shoulder = chance(seed, "shoulder", int(side.verge_m * 1e7), int(side.drain_m * 1e7))
    values = (
        side.drain_m if side.drain != "none" else 0.0,
        float(random.uniform(0.04, 0.08)) if side.drain == "apron" else 0.0,
        float(random.uniform(0.24, 0.5)),
        float(random.uniform(0.05, 0.09)),
        wide if side.curb != "none" else 0.0,
        high if side.curb != "none" else 0.0,
        0.0 if side.curb == "asphalt" else chamfer,
        batter,
        behind if side.curb != "none" else 0.0,
        side.strip_m,
        float(random.uniform(0.01, 0.06)),
        float(random.uniform(0.1, 0.15)),
        float(random.uniform(0.08, 0.15)) if random.random() < 0.7 else 0.0,
        side.walk_m,
        float(random.uniform(0.005, 0.02)),
        side.verge_m,
        side.shoulder_m,
        float(shoulder.uniform(0.0, 0.015)),
        float(shoulder.uniform(0.03, 0.08)),
        abs(side.outside_high_m) * steepness,
        side.outside_high_m,
    )
    return Measures(*(np.asarray(one, np.float64) for one in values))


def band_surfaces_of(seed: int, side: SidePlan) -> BandSurfaces:
    """Materials of a side; the same for all sections that share its plan."""
    random = chance(seed, "looks", int(side.verge_m * 1e7), int(side.drain_m * 1e7))
    concretes = (Material.CONCRETE, Material.OLD_CONCRETE)
    walks = (Material.PAVING, Material.PAVING, Material.ASPHALT, Material.WORN_ASPHALT)
    if side.flush == "walk":  # what is told from the carriageway by a painted line alone has none
        walks = (Material.PAVING, Material.PAVING, *concretes)
    return BandSurfaces(
        concretes[int(random.integers(2))],
        Material.WORN_ASPHALT if side.curb == "asphalt" else concretes[int(random.integers(2))],
        walks[int(random.integers(4))],
        StoneRow(
            0.6 if random.random() < 0.75 else 2.0,
            float(random.uniform(0.0005, 0.004)),
            side.wear,
        ),
        Material.GRAVEL if side.flush == "gravel" else Material.SOIL,
    )


def is_alike(one: SidePlan, other: SidePlan) -> bool:
    """Whether two sides have the same bands, so that their lines can be joined."""
    return (one.drain, one.curb, one.strip_m > 0, one.walk_m > 0, one.flush) == (
        other.drain,
        other.curb,
        other.strip_m > 0,
        other.walk_m > 0,
        other.flush,
    )


def meeting(seed: int, side: SidePlan, other: SidePlan | None) -> Measures:
    """The measures of a side where it meets its neighbour."""
    mine = measures_of(seed, side)
    if other is None:
        return mine
    theirs = measures_of(seed, other)
    both = mine.mixed(theirs, 0.5)
    if is_alike(side, other):
        return both
    return Measures(*mine.all()[:-2], *both.all()[-2:])


def measures_along(
    seed: int, sides: tuple[SidePlan | None, SidePlan, SidePlan | None], along: Floats, ends: Floats
) -> Measures:
    """The measures of a side by chainage.

    Parameters
    ----------
    sides : tuple
        The plan before, its own, the plan behind.
    along : (n,) float64
        Chainages.
    ends : (2,) float64
        Where the section begins and ends.
    """
    before, side, after = sides
    change = min(_CHANGE_M, float(ends[1] - ends[0]) / 3)
    near = _changed(seed, (before, side, after), along, ends, change)
    slow = min(_LAND_CHANGE_M, float(ends[1] - ends[0]) / 2.2)
    land = _changed(seed, (before, side, after), along, ends, slow)
    return replace(near, run=land.run, rise=land.rise)


def _changed(
    seed: int,
    sides: tuple[SidePlan | None, SidePlan, SidePlan | None],
    along: Floats,
    ends: Floats,
    change: float,
) -> Measures:
    before, side, after = sides
    near_start = np.clip(1 - (along - ends[0]) / change, 0, 1)
    near_end = np.clip(1 - (ends[1] - along) / change, 0, 1)
    smooth_start = near_start**2 * (3 - 2 * near_start)
    smooth_end = near_end**2 * (3 - 2 * near_end)
    first = measures_of(seed, side).mixed(meeting(seed, side, before), smooth_start)
    return first.mixed(meeting(seed, side, after), smooth_end)

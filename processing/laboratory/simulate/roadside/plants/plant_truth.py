"""Truth of areas of plants: planting strips, lawns and hedges as closed outlines.

What grows beyond the verge, on slopes and on the land, is told as ``other``: neither asked for nor
wrong.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import NO_THING, Fact, SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.ground import Strip
from processing.laboratory.simulate.street.plan import SIDES
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.sweep import Sweep

PLANTING, LAWN, HEDGE, OTHER = "planting_strip", "lawn", "hedge", "other"
_NARROWEST_M, _SHORTEST_M = 0.2, 0.2
_PIECE_M = 4.0
"""What points show is told by pieces: the vehicle passes most areas for a part of their length."""

_SOFT = (Material.GRASS, Material.SOIL, Material.GRAVEL)


def add_plant_truth(section: StreetSection, built: SectionBuilder) -> None:
    """Tell the areas of the ground of a section on which plants grow."""
    layout = section.layout
    sweeps = [*layout.median]
    for side in SIDES:
        sweeps += [layout.sides[side].sweep, *(one.sweep for one in layout.sides[side].corners)]
    for sweep in sweeps:
        for number, strip in enumerate(sweep.profile.strips):
            type_ = _type_of(strip)
            if type_ is not None:
                for nodes in _stretches(sweep, strip):
                    _tell_strip(section, built, sweep, (number, nodes, type_))


def tell_area(
    built: SectionBuilder, ring: Floats, which: tuple[str, int, float], height_m: float
) -> None:
    """Tell an area.

    Parameters
    ----------
    ring : (n, 3) float64
        Its outline, not closed, m.
    which : (str, int, float)
        Its type, its instance and its chainage.
    height_m : float
        Of its plants, without leaves and weeds that stand out of them.
    """
    type_, instance, chainage = which
    x, y = (ring[:, :2] - ring[0, :2]).T
    area = abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1))) / 2
    kind = {HEDGE: "hedge_area", PLANTING: "planting_area"}.get(type_, "lawn_area")
    facts: dict[str, Fact] = {"kind": kind, "type": type_, "area_m2": area, "height_m": height_m}
    closed = np.concatenate([ring, ring[:1]])
    built.truth.append(TrueFeature("plant_areas", "Polygon", closed, facts, instance, chainage))


def _type_of(strip: Strip) -> str | None:
    if strip.kind == "strip":
        return PLANTING
    if strip.kind in ("slope", "land"):
        return OTHER if strip.material in _SOFT else None
    return LAWN if strip.material == Material.GRASS else None


def _stretches(sweep: Sweep, strip: Strip) -> Iterator[slice]:
    """Nodes of the pieces of a strip that aren't paved: at lowered curbs planting strips are."""
    count = len(sweep.chainages)
    is_soft: NDArray[np.bool_] = np.ones(count, np.bool_)
    if strip.kind == "strip" and sweep.profile.edges:
        is_soft = sweep.profile.edges[0].lowered <= 0
    padded = np.concatenate([[False], is_soft, [False]])
    turns = np.flatnonzero(padded[1:] != padded[:-1])
    piece = np.floor(sweep.chainages[:, 0] / _PIECE_M)
    for first, last in zip(turns[::2], turns[1::2], strict=True):
        cuts = np.flatnonzero(np.diff(piece[first:last])) + first + 1
        ends = [int(first), *cuts.tolist(), int(last) - 1]
        for low, high in itertools.pairwise(ends):
            if high > low:
                yield slice(low, high + 1)


def _tell_strip(
    section: StreetSection,
    built: SectionBuilder,
    sweep: Sweep,
    what: tuple[int, slice, str],
) -> None:
    number, nodes, type_ = what
    lines = [
        section.alignment.at(
            sweep.chainages[nodes, line], sweep.offsets[nodes, line], sweep.heights[nodes, line]
        )
        for line in (number, number + 1)
    ]
    wide = float(np.median(np.linalg.norm((lines[1] - lines[0])[:, :2], axis=1)))
    long = float(np.linalg.norm(np.diff(lines[0], axis=0), axis=1).sum())
    if wide < _NARROWEST_M or long < _SHORTEST_M:
        return
    chainage = float(sweep.chainages[nodes, number].mean())
    tell_area(built, np.concatenate([lines[0], lines[1][::-1]]), (type_, NO_THING, chainage), 0.0)

"""Poles of a survey: shafts beside the road, how sure each is a pole, and of which type.

The steps stand in a file each: shafts among the columns, what stands beside them, what they carry.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor, PartMonitor
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.column_points import ColumnPoints, points_about_each
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.objects.standing_apart import stand_apart
from processing.methods.road.objects.survey import survey_columns
from processing.methods.road.poles.alike_shafts import alike_of
from processing.methods.road.poles.carried import (
    ARMS_FROM_M,
    Carried,
    ShaftNeighbourhood,
    carried_of,
    type_of,
)
from processing.methods.road.poles.mirror_images import mirror_images
from processing.methods.road.poles.pole_confidence import (
    ShaftAbout,
    chances_of,
    facts_of,
    is_low,
    most_chances_of,
)
from processing.methods.road.poles.reflectors import ReflectorSearch
from processing.methods.road.poles.roofs import fellows_of
from processing.methods.road.poles.shaft_kernels import LEVEL_M, POINTS
from processing.methods.road.poles.shaft_sides import seen_sides
from processing.methods.road.poles.shafts import (
    Shaft,
    feet_of,
    find_hidden_shafts,
    find_shafts,
    with_whole_sides,
)
from processing.methods.road.poles.surroundings import Surroundings, surroundings_of
from processing.methods.road.poles.trunks_among import tree_chances
from processing.methods.road.trees.street_trees import StreetTree
from processing.recording.drive import Drive

REACH_M = 5.0
"""Points so near to a shaft may be of what it carries: arms over the road reach 4 to 5 m."""

_APART_M = 0.4
"""Two poles never stand nearer to each other: the surer one stays."""

_LEAST_CHANCE = 0.05
"""What is less likely a pole, or would be if all that isn't known yet spoke for it, is measured no
further."""

_NOTHING = Surroundings(rails=0.0, cover=0.0, over=0.0, roof=0.0, crown=None)

_LIKELY = 0.3
"""Of what is less likely a pole nobody asks whether a pane mirrors it."""

_EVEN, _SURE = 0.5, 0.95
"""As likely as not; and from where on nobody asks whether it is a trunk: of some 600 such shafts of
134 streets four were."""

_ROUGH = 2.5
"""Noise over the usual one beyond which nobody asks what a shaft carries."""

_MANY_POINTS, _SMOOTH_SHARE, _LEAST_NOISE_M = 60, 0.2, 5e-4
"""Points of a shaft whose noise counts; the share of shafts that are smoother than the recording's
usual ones; and the least noise of any scanner."""


@dataclass(frozen=True)
class StreetPole:
    """One pole, or what might be one.

    Attributes
    ----------
    foot : (3,) float64
        Where its axis meets the ground, m, project CRS.
    shaft : Shaft
    carried : Carried
    type : str
        The contract's name.
    height_m : float
        Of its shaft's top above the foot.
    diameter_m, diameter_within_m : float
        1.2 m above the foot, of low ones at half their height; off by no more in 95 of 100 cases.
    confidence : float
        The share of its like that are poles.
    """

    foot: Floats
    shaft: Shaft
    carried: Carried
    type: str
    height_m: float
    diameter_m: float
    diameter_within_m: float
    confidence: float

    @property
    def lean_deg(self) -> float:
        """From the vertical."""
        return math.degrees(math.atan(float(np.hypot(*self.shaft.lean))))

    @property
    def points(self) -> Integers:
        """Measured points of the shaft by their number in their drive, the lowest first."""
        return self.shaft.points

    @property
    def drives(self) -> Integers:
        """Which of the drives each is of."""
        return self.shaft.drives


class _Judged(NamedTuple):
    """A shaft by its number, what is known about it, and the chance that it is a pole."""

    number: int
    about: ShaftAbout
    chance: float


def street_poles(
    drives: Sequence[Drive], monitor: Monitor, *, upright: Sequence[StreetTree] | None = None
) -> tuple[StreetPole, ...]:
    """All shafts that may be poles; a confidence tells poles from the others.

    Parameters
    ----------
    upright : sequence of StreetTree, optional
        What the search for trees found, as :func:`trunks_among.tree_chances` takes it.

    Notes
    -----
    1. Columns stand free at some heights (:mod:`processing.methods.road.objects.columns`); in
       each, straight cones are fitted and followed upwards, pass by pass.
    2. Rails, roofs and crowns about a shaft speak against a pole, reflectors and faces of signs
       for one; of what a crown leaves in doubt the search for trees has its say.
    3. Wires, arms, plates and reflectors tell its type.
    """
    (plan, _), columns = survey_columns(drives, PartMonitor(monitor, 0.0, 0.4))
    shafts = find_shafts(drives, plan, columns.posts, PartMonitor(monitor, 0.4, 0.7))
    part = PartMonitor(monitor, 0.7, 0.75)
    hidden = find_hidden_shafts(drives, plan, columns.raised, shafts, part)
    if not shafts and not hidden:
        return ()
    usual_m = usual_noise_m(shafts or hidden)
    part = PartMonitor(monitor, 0.75, 0.9)
    # What stands out of a crown or behind a wall takes no points from what stands on the ground.
    feet = feet_of(shafts), feet_of(hidden)
    shafts, around = shafts + hidden, points_about_each(drives, plan, feet, REACH_M, part)
    shafts = with_whole_sides(shafts, around, monitor)
    part = PartMonitor(monitor, 0.9, 0.95)
    judged = _judged(drives, plan, (shafts, around, usual_m), part, upright)
    asked = [one.number for one in judged if one.chance >= _LIKELY]
    images = mirror_images(drives, plan, shafts, asked, PartMonitor(monitor, 0.95, 1.0))
    surest = sorted(judged, key=lambda one: (-one.chance, one.number))
    kept = _apart([one for one in surest if one.number not in images], shafts)
    monitor.report(1.0)
    return tuple(_pole(shafts[one.number], one, plan.origin) for one in kept)


def _apart(judged: Sequence[_Judged], shafts: Sequence[Shaft]) -> list[_Judged]:
    """Those of which no surer one, named before them, stands in their place."""
    are_kept = stand_apart(feet_of([shafts[one.number] for one in judged]), _APART_M)
    return [one for one, is_kept in zip(judged, are_kept.tolist(), strict=True) if is_kept]


def _judged(
    drives: Sequence[Drive],
    plan: SparsePlan,
    found: tuple[list[Shaft], ColumnPoints, float],
    monitor: Monitor,
    upright: Sequence[StreetTree] | None,
) -> list[_Judged]:
    """What may be a pole, and how surely: trees are looked for where one would change that."""
    shafts, _, usual_m = found
    known = shafts_about_all(drives, plan, found, monitor)
    chances = _chances(shafts, known, usual_m)
    if_trees = {number: about._replace(tree=1.0) for number, about in known.items()}
    is_doubtful = (chances >= _LIKELY) & (chances < _SURE)
    is_doubtful &= _chances(shafts, if_trees, usual_m) < _EVEN
    is_doubtful &= np.array([about.beside.crown is not None for about in known.values()], np.bool_)
    doubtful = [number for number, asked in zip(known, is_doubtful, strict=True) if asked]
    feet = feet_of([shafts[number] for number in doubtful])
    trees = tree_chances(drives, plan, feet, monitor, upright=upright)
    for number, tree in zip(doubtful, trees, strict=True):
        known[number] = known[number]._replace(tree=float(tree))
    chances = _chances(shafts, known, usual_m)
    return [
        _Judged(number, about, chance)
        for (number, about), chance in zip(known.items(), chances.tolist(), strict=True)
        if chance >= _LEAST_CHANCE
    ]


def _chances(shafts: Sequence[Shaft], known: Mapping[int, ShaftAbout], usual_m: float) -> Floats:
    """(n,) the chances of those of which something is known, in its order."""
    facts = [facts_of(shafts[number], about, usual_m) for number, about in known.items()]
    return chances_of(facts, are_low=[is_low(shafts[number]) for number in known])


def shafts_about_all(
    drives: Sequence[Drive],
    plan: SparsePlan,
    found: tuple[Sequence[Shaft], ColumnPoints, float],
    monitor: Monitor,
    *,
    least: float = _LEAST_CHANCE,
) -> dict[int, ShaftAbout]:
    """What is known about the shafts that may be poles, by their number; not yet of trees.

    Parameters
    ----------
    found : tuple
        The shafts, the points about each, and the noise of the recording's smooth shafts, m.
    least : float
        The least chance of what may be one.
    """
    shafts, around, usual_m = found
    fellows, stands = fellows_of(shafts), cKDTree(feet_of(shafts))
    reflectors = ReflectorSearch(drives, shafts, around, plan.origin)
    alike = alike_of(shafts) * [is_low(one) for one in shafts]
    beside = {number: replace(_NOTHING, alike=one) for number, one in enumerate(alike.tolist())}
    beside = _likely(shafts, beside, usual_m, least)

    def told_beside(number: int) -> Surroundings:
        monitor.check()
        local = around.local[around.of(number)] - shafts[number].foot
        told = surroundings_of(local, shafts[number], usual_m, fellows[number])
        return replace(told, alike=beside[number].alike)

    beside = dict(zip(beside, in_order(told_beside, list(beside)), strict=True))
    likely = _likely(shafts, beside, usual_m, least)

    def told_about(number: int) -> ShaftAbout:
        monitor.check()
        carried = Carried()
        if _may_carry(shafts[number], usual_m):
            carried = carried_of(own_points(around, number, shafts, stands), shafts[number])
        sides = seen_sides(drives, shafts[number], plan.origin)
        shines = reflectors.shines(number, shafts[number])
        return ShaftAbout(likely[number], carried, sides, shines, tree=0.0)

    return dict(zip(likely, in_order(told_about, likely), strict=True))


def _likely(
    shafts: Sequence[Shaft], beside: Mapping[int, Surroundings], usual_m: float, least: float
) -> dict[int, Surroundings]:
    """Those that may be poles by what stands beside them."""
    some = [shafts[number] for number in beside]
    chances = most_chances_of(some, list(beside.values()), usual_m)
    return {
        number: one
        for (number, one), chance in zip(beside.items(), chances.tolist(), strict=True)
        if chance >= least
    }


def own_points(
    around: ColumnPoints, number: int, shafts: Sequence[Shaft], stands: cKDTree
) -> ShaftNeighbourhood:
    """Points about a shaft, by its number, of the heads that measured it.

    Passes lie centimetres apart, which would make two plates of one and no smooth surface.

    Parameters
    ----------
    stands : cKDTree
        Of the feet of all shafts (:func:`feet_of`).
    """
    shaft = shafts[number]
    part = around.of(number)
    is_head = np.zeros(int(shaft.drives.max(initial=-1)) + 1, np.bool_)
    is_head[shaft.drives] = True
    own = np.array([[part.start, part.stop]])
    others = np.empty((0, 2), np.int64)
    if shaft.top_m > ARMS_FROM_M:
        beside = stands.query_ball_point(shaft.foot[:2], 2 * REACH_M, return_sorted=True)
        near = np.array([one for one in beside if one != number], np.int64)
        others = np.column_stack([around.starts[near], around.starts[near + 1]])
    local, heads = _about(around, own, shaft.foot, is_head, (-np.inf, np.inf))
    beyond, _ = _about(around, others, shaft.foot, is_head, (ARMS_FROM_M, REACH_M))
    return ShaftNeighbourhood(local, heads, beyond)


def _about(
    around: ColumnPoints, parts: Integers, foot: Floats, is_head: Flags, limits: tuple[float, float]
) -> tuple[Floats, Integers]:
    """(n, 3) points of some heads about a foot, and (n,) the head of each.

    Parameters
    ----------
    parts : (k, 2) int64
        First line of the points about a shaft, and the one behind the last.
    limits : tuple of float
        Above which height above the foot, and how near in plan, m.
    """
    points, wanted = (around.local, around.drives), (foot, is_head)
    # Counted first: where shafts stand close, few of the points about the others are wanted.
    count = about_kernel(points, parts, wanted, limits, (np.empty((0, 3)), np.empty(0, np.int64)))
    local, heads = np.empty((count, 3)), np.empty(count, np.int64)
    about_kernel(points, parts, wanted, limits, (local, heads))
    return local, heads


@kernel
def about_kernel(
    points: tuple[Floats, Integers],
    parts: Integers,
    wanted: tuple[Floats, Flags],
    limits: tuple[float, float],
    found: tuple[Floats, Integers],
) -> int:
    """Write the points that `_about` wants, in their order, as far as there is room; how many."""
    (local, drives), (foot, is_head) = points, wanted
    count = 0
    for part in range(len(parts)):
        for point in range(parts[part, 0], parts[part, 1]):
            if drives[point] >= is_head.size or not is_head[drives[point]]:
                continue
            up = local[point, 2] - foot[2]
            east, north = local[point, 0] - foot[0], local[point, 1] - foot[1]
            if up > limits[0] and math.hypot(east, north) < limits[1]:
                if count < found[1].size:
                    found[0][count, 0], found[0][count, 1], found[0][count, 2] = east, north, up
                    found[1][count] = drives[point]
                count += 1
    return count


def _may_carry(shaft: Shaft, usual_m: float) -> bool:
    """Whether anybody asks what a shaft carries: low ones and those too rough for poles: nothing.

    Parameters
    ----------
    usual_m : float
        Noise of the recording's smooth shafts.
    """
    return not is_low(shaft) and shaft.noise_m <= _ROUGH * usual_m


def usual_noise_m(shafts: Sequence[Shaft]) -> float:
    """How far points lie off the smooth shafts of a recording, m."""
    noise = [one.noise_m for one in shafts if one.told[POINTS] >= _MANY_POINTS]
    if not noise:
        noise = [one.noise_m for one in shafts]
    return max(float(np.quantile(noise, _SMOOTH_SHARE)), _LEAST_NOISE_M)


def _pole(shaft: Shaft, judged: _Judged, origin: Floats) -> StreetPole:
    """The pole that a shaft is."""
    level = min(LEVEL_M, shaft.top_m / 2)
    about = judged.about
    is_reflecting = about.shines > _EVEN
    return StreetPole(
        foot=shaft.foot + origin,
        shaft=shaft,
        carried=about.carried,
        type=type_of(shaft, about.carried, over=about.beside.over, is_reflecting=is_reflecting),
        height_m=shaft.top_m,
        diameter_m=2 * shaft.radius_at(level),
        diameter_within_m=1.96 * 2 * math.hypot(shaft.deviation_m, shaft.noise_m / 2),
        confidence=judged.chance,
    )

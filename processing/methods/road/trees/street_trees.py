"""Street trees of a survey: columns whose stem is round and carries a crown on all sides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor, PartMonitor
from processing.methods.road.objects.column_points import (
    ColumnPoints,
    nearest_columns,
    points_about,
)
from processing.methods.road.objects.columns import FoundColumns
from processing.methods.road.objects.driven_path import driven_places
from processing.methods.road.objects.foot import foot_height
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.objects.standing_apart import stand_apart
from processing.methods.road.objects.survey import survey_columns
from processing.methods.road.trees.clearances import Clearances, GroundBelowCrowns
from processing.methods.road.trees.column_trunks import ColumnTrunk, column_trunks
from processing.methods.road.trees.crown_cells import StandingStems, crown_cells
from processing.methods.road.trees.crowns import CROWN_M, Crown, CrownShares, UprightTrunk
from processing.methods.road.trees.rises import rise_of
from processing.methods.road.trees.tree_confidence import chances_of, facts_of
from processing.methods.road.trees.trunks import Trunk, has_flat_sides, is_round
from processing.recording.drive import Drive

_TRUNK_M = 0.9
"""Points so near to a column's middle are looked at for stems: those of a tree of several stems,
its stakes and its guard."""

_ONE_TREE_M = 0.7
"""Columns nearer to each other are of one tree: stakes and stems. Street trees stand metres apart
(道路緑化技術基準: 6 to 10 m)."""


_LEAST_CHANCE = 0.1
"""What is less likely a tree leaves its neighbours' crowns to them."""

_BESIDE_M, _ABOVE_M = 0.12, 0.5
"""m beside a stem's surface and above its end; nearer points are bark and noise."""

_APART_M = 1.2
"""Two trunks nearer to each other are stems of one tree, or one is a stake, a shrub or a piece of
the crown of the other."""


@dataclass(frozen=True)
class TreeSettings:
    """What is looked for.

    Attributes
    ----------
    most_diameter_m : float
        Of a trunk 1.2 m above the foot.
    """

    most_diameter_m: float


@dataclass(frozen=True)
class StreetTree:
    """One tree, or what might be one.

    Attributes
    ----------
    foot : (3,) float64
        Where the trunk's axis meets the ground, m, project CRS.
    upright : UprightTrunk
        Its trunk, about the column's foot.
    crown : Crown
    clearances : Clearances
        Of its crown over carriageway and walk.
    confidence : float
        The share of its like that are trees.
    points : (n,) int64
        Measured points of the trunk, the lowest first, by their number in their drive.
    drives : (n,) int64
        Which of the drives each is of.
    """

    foot: Floats
    upright: UprightTrunk
    crown: Crown
    clearances: Clearances
    confidence: float
    points: Integers
    drives: Integers

    @property
    def trunk(self) -> Trunk:
        """Its stems, about the column's foot."""
        return self.upright.trunk


class _MeasuredTrunk(NamedTuple):
    """A trunk where it stands, whether all its stems have flat sides, and its points."""

    standing: UprightTrunk
    has_flat_sides: bool
    points: Integers
    drives: Integers


def street_trees(
    drives: Sequence[Drive], settings: TreeSettings, monitor: Monitor
) -> tuple[StreetTree, ...]:
    """The upright things of a survey that may be trees, of those of one tree the surest."""
    return surest_trees(upright_things(drives, settings, monitor))


def surest_trees(upright: Sequence[StreetTree]) -> tuple[StreetTree, ...]:
    """Of upright things that would be one tree the surest, the surest of all first."""
    found = sorted(upright, key=lambda one: -one.confidence)
    feet = np.array([one.foot[:2] for one in found]).reshape(-1, 2)
    are_kept = stand_apart(feet, _APART_M).tolist()
    return tuple(one for one, is_kept in zip(found, are_kept, strict=True) if is_kept)


def upright_things(
    drives: Sequence[Drive],
    settings: TreeSettings,
    monitor: Monitor,
    *,
    about: Floats | None = None,
) -> tuple[StreetTree, ...]:
    """All columns with a trunk, with what stands on it; a confidence tells trees from the others.

    Parameters
    ----------
    about : (n, 2) float64, optional
        Places, m about the plan's origin: things there and those that may share a crown with them
        are enough.

    Notes
    -----
    1. Columns stand free at some heights (:mod:`processing.methods.road.objects.columns`); those
       of one tree are joined.
    2. Stems are circles that follow each other upwards, each fitted by a leaning cone.
    3. The trunk is what goes on upwards of them, its foot lies on the ground about it.
    4. What hangs together above is shared out between trunks, first between all, then between
       those that may be trees' (:mod:`processing.methods.road.trees.crowns`). What has flat sides
       is left out after that: it takes its share, so that nothing beside it looks like a tree.
    """
    (plan, ground), (columns, *_) = survey_columns(drives, PartMonitor(monitor, 0.0, 0.4))
    asked = _joined(columns) if about is None else _near(_joined(columns), about)
    trunks = _standing_trunks(drives, plan, asked, settings, PartMonitor(monitor, 0.4, 0.8))
    if not trunks:
        return ()
    street = GroundBelowCrowns(plan, ground, driven_places(drives, plan))
    standing = [one.standing for one in trunks]
    crowns = _crowns(drives, plan, standing, PartMonitor(monitor, 0.8, 1.0))
    return tuple(
        StreetTree(
            one.standing.foot + plan.origin,
            one.standing,
            crown,
            street.clearances(one.standing.foot, crown.underside),
            chance,
            one.points,
            one.drives,
        )
        for one, (crown, chance) in zip(trunks, crowns, strict=True)
        if not one.has_flat_sides
    )


def _crowns(
    drives: Sequence[Drive], plan: SparsePlan, trunks: Sequence[UprightTrunk], monitor: Monitor
) -> list[tuple[Crown, float]]:
    """What each trunk carries, and the chance that it is a tree's.

    What is surely no tree, or a stake or shoot beside a likelier one, takes no part of its
    neighbours' crowns: they are shared out again without it.
    """
    feet = np.array([one.foot[:2] for one in trunks])
    owners = nearest_columns(plan, feet, CROWN_M)
    cells = crown_cells(drives, plan, owners, _stems_of(trunks), monitor)
    shares = CrownShares(cells, trunks, monitor)
    is_asked = np.ones(len(trunks), np.bool_)
    crowns = shares.crowns(is_asked, monitor)
    chances = _chances(trunks, crowns, monitor)
    is_asked &= (chances >= _LEAST_CHANCE) & _are_surest(feet, chances)
    shared = shares.crowns(is_asked, monitor)
    crowns = [
        new if asked else old for new, old, asked in zip(shared, crowns, is_asked, strict=True)
    ]
    return list(zip(crowns, _chances(trunks, crowns, monitor).tolist(), strict=True))


def _chances(trunks: Sequence[UprightTrunk], crowns: Sequence[Crown], monitor: Monitor) -> Floats:
    return chances_of([facts_of(*one) for one in zip(trunks, crowns, strict=True)], monitor)


def _are_surest(feet: Floats, chances: Floats) -> NDArray[np.bool_]:
    """Which things are likelier than everything so near that it would be of the same tree."""
    pairs = cKDTree(feet).query_pairs(_APART_M, output_type="ndarray")
    is_surest = np.ones(len(feet), np.bool_)
    is_surest[np.where(chances[pairs[:, 0]] < chances[pairs[:, 1]], *pairs.T)] = False
    return is_surest


def _stems_of(trunks: Sequence[UprightTrunk]) -> StandingStems:
    """Where the stems of trunks stand, and their stakes and guards."""
    rows: list[tuple[float, ...]] = []
    starts = [0]
    for number, one in enumerate(trunks):
        thickest = one.trunk.stems[0]
        for stem in (*one.trunk.stems, *one.trunk.companions):
            axis = one.foot[:2] + stem.base - one.trunk.base
            high = one.rise.high_m if stem is thickest else stem.high_m
            wide = stem.radius_m + _BESIDE_M
            rows.append((*axis, *stem.slope, wide, high + _ABOVE_M, number))
        starts.append(len(rows))
    heights = np.array([one.foot[2] for one in trunks])
    return StandingStems(np.array(starts, np.int64), np.array(rows, np.float64), heights)


def _standing_trunks(
    drives: Sequence[Drive],
    plan: SparsePlan,
    columns: FoundColumns,
    settings: TreeSettings,
    monitor: Monitor,
) -> list[_MeasuredTrunk]:
    """What is round and upright among the columns."""
    gathered = points_about(drives, plan, columns.middles, _TRUNK_M, PartMonitor(monitor, 0.0, 0.5))
    about = column_trunks(
        columns, gathered, settings.most_diameter_m, PartMonitor(monitor, 0.5, 0.9)
    )
    trunks = []
    for one in about:
        monitor.check()
        if is_round(one.trunk):
            trunks.append(_standing(gathered, one))
    return trunks


def _joined(columns: FoundColumns) -> FoundColumns:
    """Columns that are near each other as one, in their middle."""
    if len(columns) < 2:
        return columns
    pairs = cKDTree(columns.middles).query_pairs(_ONE_TREE_M, output_type="ndarray")
    slabs = np.bitwise_count(columns.slabs).astype(np.float64)
    order = np.argsort(-slabs, kind="stable")
    near: dict[int, list[int]] = {}
    for a, b in pairs.tolist():
        near.setdefault(a, []).append(b)
        near.setdefault(b, []).append(a)
    taken = np.zeros(len(columns), np.bool_)
    middles, ground, bits = [], [], []
    for first in order.tolist():
        if taken[first]:
            continue
        members = [first, *(one for one in near.get(first, ()) if not taken[one])]
        taken[members] = True
        middles.append(np.average(columns.middles[members], axis=0, weights=slabs[members]))
        ground.append(columns.ground[first])
        bits.append(np.bitwise_or.reduce(columns.slabs[members]))
    return FoundColumns(np.array(middles), np.array(ground), np.array(bits, np.uint32))


def _near(columns: FoundColumns, about: Floats) -> FoundColumns:
    """The columns whose crowns may reach to some places."""
    if not len(columns) or not len(about):
        return columns.chosen(np.zeros(len(columns), np.bool_))
    away = np.asarray(cKDTree(about).query(columns.middles)[0])
    return columns.chosen(away < CROWN_M)


def _standing(gathered: ColumnPoints, one: ColumnTrunk) -> _MeasuredTrunk:
    """A trunk with its foot on the ground, and how it goes on above."""
    stem = one.trunk.stems[0]
    higher = foot_height(one.about, stem.base, one.coarse_m - one.height_m, stem.radius_m)
    trunk = one.trunk.about(higher)
    lines = trunk.lines[np.argsort(one.about[trunk.lines, 2], kind="stable")]
    rise = rise_of(one.about - (0.0, 0.0, higher), trunk.stems[0])
    foot = np.array([*(one.middle + trunk.base), one.height_m + higher])
    return _MeasuredTrunk(
        UprightTrunk(trunk, foot, rise),
        all(
            has_flat_sides(stem, one.about, gathered.drives[one.lines]) for stem in one.trunk.stems
        ),
        gathered.points[one.lines[lines]],
        gathered.drives[one.lines[lines]],
    )

"""The trunk of each column: its stems, those that stand in columns of their own too.

A tree of several stems may spread over several columns, each of which shows a part of it. Its stems
leave the ground together and part upwards, which posts beside a tree don't.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.column_points import ColumnPoints
from processing.methods.road.objects.columns import FoundColumns
from processing.methods.road.objects.foot import foot_height, ground_seen
from processing.methods.road.trees.alike_stems import CLUMP_M
from processing.methods.road.trees.drive_shifts import (
    JoinedPoints,
    agreed_shifts,
    laid_by,
    without_shifts,
)
from processing.methods.road.trees.rises import followed
from processing.methods.road.trees.stem_bodies import BREAST_M
from processing.methods.road.trees.stems import FittedStem, stems_of
from processing.methods.road.trees.trunks import (
    Trunk,
    has_flat_sides,
    leave_together,
    trunks_of,
)

_NEIGHBOURS, _MOST = list(range(1, 21)), 0.5
"""Nearest columns that are asked whether drives lie apart, and how many have to say so: positions
drift over minutes, so columns of a street agree."""

_BESIDE = 9
"""Of them those nearest, a row of trees on one side: heads that are mounted otherwise than told lie
apart along the street, forwards on one side of it and backwards on the other."""

_SAME_M = 0.1
"""Axes nearer than this are of one stem that two columns show: what each misses of it moves it by a
centimetre or two."""


class ColumnTrunk(NamedTuple):
    """The trunk of a column and the points about its foot.

    Attributes
    ----------
    lines : (n,) int64
        Which of the gathered points.
    middle : (2,) float64
        Of the column, m about the plan's origin.
    coarse_m, height_m : float
        The ground by the coarse map and by what lies about the column, m about the plan's origin.
    about : (n, 3) float64
        The points about middle and ground.
    trunk : Trunk
        About the same.
    """

    lines: Integers
    middle: Floats
    coarse_m: float
    height_m: float
    about: Floats
    trunk: Trunk


def column_trunks(
    columns: FoundColumns, gathered: ColumnPoints, most_diameter_m: float, monitor: Monitor
) -> list[ColumnTrunk]:
    """The trunks of all columns that have one, of several that are one tree the whole.

    Notes
    -----
    1. Each column's stems are looked for by themselves.
    2. Columns whose stems leave the ground together and move apart are looked at as one.
    3. Where most columns say that drives lie apart, their points are laid onto each other.
    """

    def of_column(number: int) -> list[ColumnTrunk]:
        monitor.check()
        part = gathered.of(number)
        lines = np.arange(part.start, part.stop)
        ground = float(columns.ground[number])
        return _trunks_about(gathered, lines, (columns.middles[number], ground), most_diameter_m)

    found: list[ColumnTrunk] = []
    for number, some in enumerate(in_order(of_column, range(len(columns)))):
        found += some
        monitor.report((number + 1) / len(columns))
    whole = _clumps_joined(_without_twins(found), gathered, most_diameter_m, monitor)
    has_several = np.unique(gathered.drives).size > 1
    return _drives_joined(whole, gathered, most_diameter_m, monitor) if has_several else whole


def _trunks_about(
    gathered: ColumnPoints, lines: Integers, place: tuple[Floats, float], most_diameter_m: float
) -> list[ColumnTrunk]:
    """The trunks of points about a middle and a ground."""
    middle, ground = place
    local = gathered.local[lines]
    coarse = ground_seen(local, ground)
    height = foot_height(local, middle, coarse)
    about = local - (*middle, height)
    return [
        ColumnTrunk(lines, middle, coarse, height, about, trunk)
        for trunk in _trunks_in(about, gathered.drives[lines], most_diameter_m)
    ]


def _trunks_in(about: Floats, drives: Integers, most_diameter_m: float) -> tuple[Trunk, ...]:
    """The trunks among points about a foot; what has flat sides is one where nothing else is."""
    stems = followed(about, stems_of(about, most_diameter_m))
    is_flat = [has_flat_sides(stem, about, drives) for stem in stems]
    round_ones = [stem for stem, flat in zip(stems, is_flat, strict=True) if not flat]
    # What parts at its root from what bends is no pier, however ill it shows that it bends.
    round_ones += [
        stem
        for stem, flat in zip(stems, is_flat, strict=True)
        if flat and any(leave_together(stem, one, np.zeros(2)) for one in round_ones)
    ]
    trunks = trunks_of(round_ones)
    return trunks or trunks_of(stems)


def _without_twins(trunks: Sequence[ColumnTrunk]) -> list[ColumnTrunk]:
    """Each trunk once, as the column tells it that shows the most stems and points of it."""
    axes = np.array([one.middle + one.trunk.stems[0].middle_at(BREAST_M) for one in trunks])
    kept: list[int] = []
    order = sorted(
        range(len(trunks)),
        key=lambda n: (-len(trunks[n].trunk.stems), -trunks[n].trunk.lines.size),
    )
    for number in order:
        away = np.hypot(*(axes[kept] - axes[number]).T) if kept else np.empty(0)
        if (away >= _SAME_M).all():
            kept.append(number)
    return [trunks[number] for number in sorted(kept)]


def _clumps_joined(
    trunks: Sequence[ColumnTrunk],
    gathered: ColumnPoints,
    most_diameter_m: float,
    monitor: Monitor,
) -> list[ColumnTrunk]:
    """Trunks that are stems of one tree as one trunk."""
    if len(trunks) < 2:
        return list(trunks)
    feet = np.array([one.middle + one.trunk.base for one in trunks])
    pairs = cKDTree(feet).query_pairs(2 * CLUMP_M, output_type="ndarray")
    pairs = pairs[[_is_one_tree(trunks[a], trunks[b]) for a, b in pairs.tolist()]]
    ties = coo_matrix((np.ones(len(pairs)), pairs.T), (len(trunks),) * 2)
    clumps = connected_components(ties, directed=False)[1]
    joined: list[ColumnTrunk] = []
    for clump in np.unique(clumps):
        monitor.check()
        members = [trunks[number] for number in np.flatnonzero(clumps == clump).tolist()]
        whole = _whole(members, gathered, most_diameter_m) if len(members) > 1 else None
        joined += members if whole is None else [whole, *_beside(whole, members)]
    return joined


def _beside(whole: ColumnTrunk, members: Sequence[ColumnTrunk]) -> list[ColumnTrunk]:
    """Columns whose thickest stem is none of the whole tree's: a pole among its stems."""
    axes = [whole.middle + stem.middle_at(BREAST_M) for stem in whole.trunk.stems]
    return [
        one
        for one in members
        if min(
            float(np.hypot(*(one.middle + one.trunk.stems[0].middle_at(BREAST_M) - axis)))
            for axis in axes
        )
        >= _SAME_M
    ]


def _is_one_tree(one: ColumnTrunk, other: ColumnTrunk) -> bool:
    """Whether some of their stems leave the ground together and move apart.

    What stands beside a stem counts on one side: of a pole's column it may be a tree's.
    """
    beside = other.middle - one.middle
    mine, others = one.trunk, other.trunk
    return any(
        leave_together(a, b, beside)
        for a, b in (
            *itertools.product(mine.stems, (*others.stems, *others.companions)),
            *itertools.product(mine.companions, others.stems),
        )
    )


def _whole(
    members: Sequence[ColumnTrunk], gathered: ColumnPoints, most_diameter_m: float
) -> ColumnTrunk | None:
    """The trunk of several columns together; None where that shows no more stems than one does.

    Circles of all their points may tell stems that are none, or pass by one that a column tells, so
    the columns' own stems are asked by themselves too.
    """
    lines = np.concatenate([one.lines for one in members])
    middle = np.mean([one.middle + one.trunk.base for one in members], axis=0)
    ground = min(one.coarse_m for one in members)
    local = gathered.local[lines]
    coarse = ground_seen(local, ground)
    height = foot_height(local, middle, coarse)
    about = local - (*middle, height)
    trunks = (
        *_trunks_in(about, gathered.drives[lines], most_diameter_m),
        *trunks_of(_own_stems(members, middle, height)),
    )
    most = max(len(one.trunk.stems) for one in members)
    whole = max(trunks, key=lambda one: len(one.stems), default=None)
    if whole is None or len(whole.stems) <= most:
        return None
    return ColumnTrunk(lines, middle, coarse, height, about, whole)


def _own_stems(members: Sequence[ColumnTrunk], middle: Floats, height_m: float) -> list[FittedStem]:
    """The stems of columns about a common foot, those with the most points first."""
    stems: list[FittedStem] = []
    start = 0
    for one in members:
        for stem in (*one.trunk.stems, *one.trunk.companions):
            lifted = stem.about(height_m - one.height_m)
            base, lines = lifted.base + one.middle - middle, stem.lines + start
            stems.append(replace(lifted, base=base, lines=lines))
        start += one.lines.size
    return sorted(stems, key=lambda stem: -stem.lines.size)


def _drives_joined(
    trunks: Sequence[ColumnTrunk],
    gathered: ColumnPoints,
    most_diameter_m: float,
    monitor: Monitor,
) -> list[ColumnTrunk]:
    """The trunks by points of all drives laid onto each other, where these lie apart.

    Bark that is not round looks like a shift too: drives lie apart where most columns that are
    near say so, by centimetres, or agree how far they do, by less.
    """

    def laid_together(one: ColumnTrunk) -> JoinedPoints:
        monitor.check()
        return without_shifts(one.about, gathered.drives[one.lines], one.trunk.stems[0])

    moved = list(in_order(laid_together, trunks))
    told = [number for number, one in enumerate(moved) if one.is_told]
    if not told:
        return list(trunks)
    places = np.array([one.middle + one.about[:, :2].mean(axis=0) for one in trunks])
    tree = cKDTree(places[told])
    is_apart = np.array([moved[number].points is not None for number in told])
    joined: list[ColumnTrunk] = []
    for place, one, shifted in zip(places, trunks, moved, strict=True):
        monitor.check()
        near = np.asarray(tree.query(place, k=_NEIGHBOURS)[1])
        near = near[near < len(told)]
        are_apart = shifted.points is not None and is_apart[near].mean() > _MOST
        shifts = dict(shifted.shifts) if are_apart else {}
        # What neighbours agree on is surer than what a slender stem tells.
        shifts |= agreed_shifts(shifted, [moved[told[number]] for number in near[:_BESIDE]])
        if any(shift.any() for shift in shifts.values()):
            points = laid_by(one.about, gathered.drives[one.lines], shifts)
            anew = _trunks_in(points, gathered.drives[one.lines], most_diameter_m)
            joined.append(one._replace(about=points, trunk=_nearest(anew, one.trunk)))
        else:
            joined.append(one)
    return joined


def _nearest(trunks: Sequence[Trunk], before: Trunk) -> Trunk:
    """The trunk that stands where one stood; that one itself where none does."""

    def away(trunk: Trunk) -> float:
        return min(
            float(np.hypot(*(one.middle_at(BREAST_M) - other.middle_at(BREAST_M))))
            for one in trunk.stems
            for other in before.stems
        )

    reach = max(_SAME_M, before.stems[0].radius_m)
    near = [one for one in trunks if away(one) < reach]
    return min(near, key=lambda one: (-len(one.stems), away(one)), default=before)

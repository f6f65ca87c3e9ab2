"""Which of a column's stems are the trunk of a tree, and the measures that a ledger needs.

Stakes, straps and guards stand about young trees, and pollarded, forked and many-stemmed ones have
several trunks. A trunk goes on upwards where stakes and guards end.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.methods.road.objects.round_sections import round_share
from processing.methods.road.objects.square_sections import square_share
from processing.methods.road.trees.alike_stems import CLUMP_M, PARTS
from processing.methods.road.trees.cone_kernels import FREE_SLAB_M
from processing.methods.road.trees.diameter_errors import causes_of, wider
from processing.methods.road.trees.stem_bodies import BREAST_M
from processing.methods.road.trees.stems import EVENLY_M, HIGHEST_M, FittedStem

_SAME_M = 0.06
"""Axes nearer than this at one height are of one stem that was found in two pieces."""

_ENDS_M = 0.4
"""A trunk's companion that ends so far below it is a stake, a guard or a broken branch."""

_HIDDEN_M, _SHORT_M = 0.5, 0.2
"""How far above 1.2 m a trunk may come in sight, over stakes and straps, and how far below it may
end: farther off its taper leaves the diameter open by more than a centimetre."""

_LONG_HIDDEN_M = 1.0
"""How far above 1.2 m a stem may come in sight that parts at its root from one that is seen better:
over a clipped hedge. It counts, whatever is off its diameter."""

_FORK_M = 0.3
"""Above 1.2 m: circles of a stem that is whole there begin lower, whatever hides a slab or two."""

_STEM_SHARE = 0.35
"""A second stem is at least so thick as the first: thinner ones are shoots. By trial; no
measurement is recorded."""

_STEMS_SHARE = 0.7
"""Of the sum of their girths counts for a tree of several stems
(公共用緑化樹木等品質寸法規格基準: 株立の幹周は各幹周の総和の70 %)."""

_BARK_M, _BARK = 0.006, 0.015
"""Standard deviation of what a circle doesn't tell of a diameter, m and as a share of it: bark, and
how far a trunk is from an ellipse. Chosen on 110 simulated trunks of seeds 600 to 615: with both 96
of 100 errors lie within."""

_STAKE_M = 0.1
"""As thick are stakes (丸太支柱: 6 to 7.5 cm, and some more): of stems so thin one may be a stake,
or one more may be hidden. Of 33 trees with several stems the number was wrong of 12 of the 24 with
one so thin, and of none of the 9 others."""


_ROUND = 0.33
"""Of its circumference one scanner sees nearly a half of a trunk, and a third where something
stands before one side; what shows less is a piece of a wall or of a vehicle."""


_FACES = 0.35
"""Of the radius off the surface: corners of a square, 0.2 beyond it, and middles of its sides lie
within."""

_SQUARE = 0.7
"""How far a section has corners as a square has (0 to 1) that is none of a trunk's: of 147 trees of
own streets none had more than 0.4, of what else had a chance of 0.1 and more two things had 1 and
the others less than 0.1."""

_LEAST_ROUND = 0.4
"""Of the windows about its axis in which a trunk bends as its circle does. Of 82 trunks of 0.2 m
and more on eleven own streets and two deliveries all had 0.56 and more; of 109 things that are
none 58 had less than 0.4, piers, corners and vehicles; most others were poles."""

_STAY = 0.1
"""Run over rise by which a stay comes nearer to the trunk that it holds (八ツ掛支柱: some 0.4);
stems of one tree lean away from each other or stand side by side."""

_LOOSE = 1.8
"""Times as far as of its neighbour points lie off a stem that isn't there: they fill what is
allowed evenly, or nearly. Bark of one tree is alike on all its stems."""

_MOSTLY = 0.6
"""Of its length: leaves stand about what isn't there."""

_SPARSE, _DENSER = 0.2, 1.5
"""Points on a surface over those on a neighbour's: one scanner sees both, and what hides one hides
it by slabs and sides, which count; circles among stray points have fewer. And how many times as
many a stem holds that goes on below what begins in its crown."""

_BETTER = 1.5
"""Times as much of its circumference a stem shows, and as many points, as a wider circle beside it
among leaves or at a corner."""

_ROOT_M = 0.25
"""Between the surfaces of upright stems that leave the ground as one; stakes are driven in beyond
the root ball, 0.3 m and more from the bark."""


@dataclass(frozen=True)
class Trunk:
    """The stems of one tree.

    Attributes
    ----------
    stems : tuple of FittedStem
        The thickest first.
    companions : tuple of FittedStem
        Stakes and guards.
    """

    stems: tuple[FittedStem, ...]
    companions: tuple[FittedStem, ...]

    @property
    def girth_m(self) -> float:
        """As a tape measures it 1.2 m above the foot; of several stems 0.7 × the sum."""
        girths = [2 * math.pi * stem.radius_m for stem in self.stems]
        return girths[0] if len(girths) == 1 else _STEMS_SHARE * sum(girths)

    @property
    def diameter_m(self) -> float:
        """The girth's, m."""
        return self.girth_m / math.pi

    @property
    def diameter_within_m(self) -> float:
        """The diameter is off by no more in 95 of 100 cases, m.

        By what else may be wrong with the stems wider than by their points and bark.
        """
        return self.fitted_within_m * wider(causes_of(self.stems, self.diameter_m))

    @property
    def fitted_within_m(self) -> float:
        """The same, were all stems found and nothing beside them taken for bark."""
        wide = [2 * stem.radius_m for stem in self.stems]
        share = 1.0 if len(wide) == 1 else _STEMS_SHARE
        random = sum((2 * stem.deviation_m) ** 2 for stem in self.stems)
        # What bark hides of one stem it hides of all.
        bark = sum(math.hypot(_BARK_M, _BARK * one) for one in wide)
        within = 1.96 * share * math.sqrt(random + bark**2)
        unsure = [2 * one.radius_m for one in self.companions if self._may_hold(one)]
        if len(wide) > 1 and min(wide) <= _STAKE_M:
            unsure.append(share * min(wide))
        return math.hypot(within, *unsure)

    def _may_hold(self, companion: FittedStem) -> bool:
        """Whether a stem's points may be those of a stake too, which touches it at the tape."""
        return companion.low_m <= BREAST_M <= companion.high_m and any(
            companion.radius_m < stem.radius_m
            and float(np.hypot(*(stem.middle_at(BREAST_M) - companion.middle_at(BREAST_M))))
            < stem.radius_m
            for stem in self.stems
        )

    @property
    def base(self) -> Floats:
        """(2,) where the axis meets the foot's height; of several stems their middle."""
        middle: Floats = np.mean([stem.base for stem in self.stems], axis=0)
        return middle

    @property
    def stems_about_foot(self) -> tuple[FittedStem, ...]:
        """The stems with their axes about the foot."""
        return tuple(replace(stem, base=stem.base - self.base) for stem in self.stems)

    def about(self, higher_m: float) -> Trunk:
        """The same with a foot that lies so much higher."""
        return Trunk(
            tuple(stem.about(higher_m) for stem in self.stems),
            tuple(stem.about(higher_m) for stem in self.companions),
        )

    @property
    def lean_deg(self) -> float:
        """Of the thickest stem from the vertical."""
        return math.degrees(math.atan(float(np.hypot(*self.stems[0].slope))))

    @property
    def lines(self) -> Integers:
        """The points of the stems, by their line among those of the column."""
        return np.concatenate([stem.lines for stem in self.stems])


def trunks_of(stems: Sequence[FittedStem]) -> tuple[Trunk, ...]:
    """The trunks among the stems of a column, the thickest first; mostly one, or none.

    Notes
    -----
    1. Pieces on one axis are one stem, as high as they reach: the better seen counts.
    2. A stem inside a wider one that ends lower has a guard about it.
    3. Where a trunk forks above 1.2 m it is the trunk that counts, not what begins there.
    4. What points lie about more loosely or more sparsely than about another stem is none, and what
       leans towards a thicker one is a stay.
    5. Stems that neither touch at the foot nor part upwards stand beside each other: a tree and
       its stakes, a tree and a pole.
    6. Of those that leave the ground together the stems of the tree reach as high as the highest or
       part from it upwards, are seen about 1.2 m above the foot and are not much thinner than the
       thickest.
    """
    whole = _without_walls(_without_pieces(stems))
    whole = [stem for stem in whole if not _is_of_fork(stem, whole)]
    high = [
        stem
        for stem in whole
        if stem.low_m <= BREAST_M + _HIDDEN_M and stem.high_m >= BREAST_M - _SHORT_M
    ]
    high += [
        stem
        for stem in whole
        if BREAST_M + _HIDDEN_M < stem.low_m <= BREAST_M + _LONG_HIDDEN_M
        and any(leave_together(stem, one, np.zeros(2)) for one in high)
    ]
    high = [
        stem
        for stem in high
        if not any(
            is_none(stem, high) for is_none in (_is_loose, _is_sparse, _is_of_crown, _is_worse)
        )
    ]
    trees = [one for clump in _clumps(high) if (one := _stems_of_tree(clump, high))]
    trees = _without_stakes(trees)
    taken = {id(stem) for tree in trees for stem in tree}
    others = tuple(stem for stem in whole if id(stem) not in taken)
    trees.sort(key=lambda tree: -tree[0].radius_m)
    return tuple(Trunk(tuple(tree), others) for tree in trees)


def trunk_of(stems: Sequence[FittedStem]) -> Trunk | None:
    """The trunk among stems that stands nearest to the middle about which they are told."""
    trunks = trunks_of(stems)
    return min(trunks, key=lambda one: float(np.hypot(*one.base)), default=None)


def leave_together(one: FittedStem, other: FittedStem, beside: Floats) -> bool:
    """Whether two stems leave the ground together and part upwards, as those of one tree do.

    Parameters
    ----------
    beside : (2,) float64
        From the foot that the one is about to that of the other, m.
    """
    low = one.base - other.base - beside
    high = low + HIGHEST_M * (one.slope - other.slope)
    away = float(np.hypot(*low))
    return away < CLUMP_M and float(np.hypot(*high)) - away > PARTS * HIGHEST_M


def is_round(trunk: Trunk) -> bool:
    """Whether what was seen of the thickest stem can be a trunk."""
    thickest = trunk.stems[0]
    return thickest.arc >= _ROUND


def has_flat_sides(stem: FittedStem, points: Floats, drives: Integers) -> bool:
    """Whether a stem is a pier, the end of a wall, a square post, or goes through several things.

    Parameters
    ----------
    points : (n, 3) float64
        m about the foot that the stem is told about.
    drives : (n,) int64
        Which drive each is of.
    """
    is_seen = (points[:, 2] >= stem.low_m) & (points[:, 2] <= stem.high_m)
    up = points[is_seen, 2] - BREAST_M
    beside = points[is_seen, :2] - stem.axis_at(points[is_seen, 2])
    radii = stem.radius_m - stem.taper * up
    near = np.abs(np.hypot(beside[:, 0], beside[:, 1]) - radii) < _FACES * radii
    bends = round_share(beside[near], radii[near], drives[is_seen][near])
    if math.isnan(bends):
        # Noise hides how it bends; all points together may still tell corners.
        return square_share(beside[near], radii[near]) > _SQUARE
    return bends < _LEAST_ROUND


def _is_of_fork(stem: FittedStem, others: Sequence[FittedStem]) -> bool:
    """Whether it begins above 1.2 m at a thicker one, which is what a tape goes round."""
    return any(
        one.radius_m > stem.radius_m
        and one.low_m <= BREAST_M <= one.high_m
        and stem.low_m > BREAST_M + _FORK_M
        and np.hypot(*(one.middle_at(stem.low_m) - stem.middle_at(stem.low_m)))
        < one.radius_m + stem.radius_m
        for one in others
    )


def _is_loose(stem: FittedStem, others: Sequence[FittedStem]) -> bool:
    """Whether points lie about it as where no surface is, and on a neighbour as on one.

    One that stands free along most of its length bends.
    """
    if stem.free_slabs * FREE_SLAB_M > _MOSTLY * (stem.high_m - stem.low_m):
        return False
    tight = [one.noise_m for one in others if one.arc >= _ROUND]
    return stem.noise_m > EVENLY_M and stem.noise_m > _LOOSE * min(tight, default=np.inf)


def _is_sparse(stem: FittedStem, others: Sequence[FittedStem]) -> bool:
    """Whether a neighbour shows many times as many points on the same surface."""
    return any(stem.density < _SPARSE * one.density for one in others if one.arc >= _ROUND)


def _is_worse(stem: FittedStem, others: Sequence[FittedStem]) -> bool:
    """Whether a thinner one beside it is seen much better, all round and by more points."""
    return any(
        one.radius_m < stem.radius_m
        and one.arc > _BETTER * stem.arc
        and one.lines.size > _BETTER * stem.lines.size
        for one in others
    )


def _is_of_crown(stem: FittedStem, others: Sequence[FittedStem]) -> bool:
    """Whether it begins in the leaves about a stem that is seen better and further down.

    What parts from it at the root doesn't.
    """
    if stem.low_m <= BREAST_M + _FORK_M:
        return False
    if any(leave_together(stem, one, np.zeros(2)) for one in others if one is not stem):
        return False
    return any(
        one.low_m <= BREAST_M
        and one.high_m >= stem.low_m
        and one.noise_m < stem.noise_m
        and one.density > _DENSER * stem.density
        for one in others
    )


def _clumps(stems: Sequence[FittedStem]) -> list[list[FittedStem]]:
    """Stems by what they leave the ground with."""
    clumps: list[list[FittedStem]] = []
    for stem in stems:
        mine = [clump for clump in clumps if any(_are_of_root(stem, one) for one in clump)]
        clumps = [clump for clump in clumps if not any(clump is one for one in mine)]
        clumps.append([stem, *(one for clump in mine for one in clump)])
    return clumps


def _are_of_root(one: FittedStem, other: FittedStem) -> bool:
    """Whether two stems touch at the foot or part upwards."""
    beside = float(np.hypot(*(one.base - other.base)))
    touch = beside - one.radius_m - other.radius_m < _ROOT_M
    return touch or leave_together(one, other, np.zeros(2))


def _stems_of_tree(
    clump: Sequence[FittedStem], everything: Sequence[FittedStem]
) -> list[FittedStem]:
    """Those of a clump that are stems of a tree, the thickest first; none of guards and stays."""
    tops = max(stem.high_m for stem in clump)
    tall = [stem for stem in clump if stem.high_m >= tops - _ENDS_M]
    tall += [
        stem
        for stem in clump
        if BREAST_M + _HIDDEN_M <= stem.high_m < tops - _ENDS_M
        and any(leave_together(stem, one, np.zeros(2)) for one in tall)
    ]
    tall = [stem for stem in tall if not _is_guard(stem, tall)]
    tall = _without_walls([one for one in tall if not _is_stay(one, everything, clump)])
    thick = max((stem.radius_m for stem in tall), default=0.0)
    trunks = [stem for stem in tall if stem.radius_m >= _STEM_SHARE * thick]
    return sorted(trunks, key=lambda stem: -stem.radius_m)


def _without_stakes(trees: Sequence[list[FittedStem]]) -> list[list[FittedStem]]:
    """Without what may be no thicker than a stake beside a thicker stem or a higher one.

    What ends below the tape is one too where another goes on, however thick it seems.
    """
    trees = [tree for tree in trees if not _is_through_stakes(tree, trees)]
    tops = [_top_of(tree) for tree in trees]
    lowest = BREAST_M if max(tops, default=0.0) > BREAST_M + _ENDS_M else 0.0
    trees = [tree for tree, top in zip(trees, tops, strict=True) if top >= lowest]
    thick = [tree for tree in trees if _is_thicker_than_stakes(tree)]
    if thick or not trees:
        return thick
    return [max(trees, key=lambda tree: (_top_of(tree), sum(one.lines.size for one in tree)))]


def _top_of(tree: Sequence[FittedStem]) -> float:
    return max(stem.high_m for stem in tree)


def _is_through_stakes(tree: Sequence[FittedStem], others: Sequence[list[FittedStem]]) -> bool:
    """Whether a thinner stem among its points is rounder, tighter and goes on where it ends."""
    wide = tree[0]
    return any(
        one is not tree
        and one[0].radius_m < wide.radius_m
        and one[0].arc > wide.arc
        and one[0].high_m >= wide.high_m + _ENDS_M
        and wide.noise_m > _LOOSE * one[0].noise_m
        for one in others
    )


def _is_thicker_than_stakes(tree: Sequence[FittedStem]) -> bool:
    thickest = Trunk((tree[0],), ())
    return thickest.diameter_m - thickest.fitted_within_m > _STAKE_M


def _is_stay(stem: FittedStem, others: Sequence[FittedStem], clump: Sequence[FittedStem]) -> bool:
    """Whether it leans on a thicker, higher one that shows more.

    One that parts from its root's doesn't.
    """
    if any(leave_together(stem, one, np.zeros(2)) for one in clump if one is not stem):
        return False
    low, high = stem.low_m, stem.high_m
    return any(
        one.radius_m > stem.radius_m
        and one.high_m >= stem.high_m
        and one.lines.size > stem.lines.size
        and np.hypot(*(one.middle_at(low) - stem.middle_at(low)))
        - np.hypot(*(one.middle_at(high) - stem.middle_at(high)))
        > _STAY * (high - low)
        for one in others
    )


def _without_walls(stems: Sequence[FittedStem]) -> list[FittedStem]:
    """Without what is wider than every stem of which enough was seen, and not seen well itself."""
    sure = [stem.radius_m for stem in stems if stem.arc >= _ROUND]
    return [one for one in stems if not sure or one.arc >= _ROUND or one.radius_m < max(sure)]


def _without_pieces(stems: Sequence[FittedStem]) -> list[FittedStem]:
    kept: list[FittedStem] = []
    for stem in stems:
        middle = (stem.low_m + stem.high_m) / 2
        for number, one in enumerate(kept):
            if (
                np.hypot(*(stem.middle_at(middle) - one.middle_at(middle))) < _SAME_M
                and abs(stem.radius_m - one.radius_m) < _SAME_M / 2
            ):
                low, high = min(one.low_m, stem.low_m), max(one.high_m, stem.high_m)
                kept[number] = replace(one, low_m=low, high_m=high)
                break
        else:
            kept.append(stem)
    return kept


def _is_guard(stem: FittedStem, others: Sequence[FittedStem]) -> bool:
    """Whether a thinner stem stands inside it."""
    middle = (stem.low_m + stem.high_m) / 2
    return any(
        one is not stem
        and one.radius_m < stem.radius_m
        and np.hypot(*(stem.middle_at(middle) - one.middle_at(middle))) < stem.radius_m
        for one in others
    )

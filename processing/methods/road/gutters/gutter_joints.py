"""Joints of the lids along a gutter: the row that explains the notches best.

Takahashi 2022 keeps notches that have a partner a whole number of lids away (equations 7-4 and
7-5). Here a row of covers is fitted along the gutter as a whole, by dynamic programming: each cover
has a length that covers have, each joint is worth what the notches say about its place, so that a
joint seen weakly or not at all is found by its neighbours, and a stretch without lids is a gap.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded
from scipy.ndimage import (
    gaussian_filter1d,
    maximum_filter1d,
    minimum_filter1d,
    uniform_filter1d,
)

from processing.methods.road.gutters.gutter_kernels import (
    BestRows,
    GapCost,
    OpenPlaces,
    Steps,
    joints_kernel,
)

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]
_Bools = NDArray[np.bool_]

LID, GRATING, GAP = 0, 1, 2
"""What lies between two joints."""

GRATING_LENGTHS_M = {0.5: 1.0, 1.0: 1.0, 0.4: 2.0, 0.6: 2.0}
"""Lengths of gratings met, m, with what each costs a row as a logarithm: usual ones less. By
trial."""

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

POSITION_M, _ROUGHLY_M = 0.005, 0.01
"""How finely joints are placed, and where rows are only compared, in half the time: holes are seen
within some 12 mm."""

_HOLE_M = 0.012
"""A notch's place along the gutter is so uncertain, standard deviation: holes are 3 to 5 cm long
(Takahashi 2022, Table 7-2), and of 4 cm that is 12 mm (divided by √12)."""

_ABOUT_M = 0.6
"""Over which notches are everywhere, and say nothing: one lid."""

_LITTLE = 0.08
"""Strength of notches, added to both of a ratio, so that nearly none against none says nothing. By
trial."""

_LEAST, _MOST = -0.8, 2.5
"""What one joint is worth at least and at most, as logarithms, so that no single joint decides. By
trial."""

_LEAST_SEEN, _MOST_SEEN = 0.3, 0.45
"""Share of a gutter's joints that are seen, at least and at most: what a joint costs that nothing
was seen of follows from it (see `_evidence`). A third being seen rows go on; a fourth may be filled
with soil anywhere."""

_WIDEST_JOINT_M = 0.04
"""Widest joint between two lids that are of one row. By trial."""

_WIDE_JOINT_M, _WIDE_COST = 0.015, 60.0
"""A wider joint costs so much per metre beyond, 1.5 for the widest. By trial."""

_OTHER_LENGTH_COST, _GAP_COST = 2.5, 5.0
"""What a lid of another length than most costs, and a stretch without lids: logarithms. By
trial."""

_CHANGE_COST = 5.0
"""What it costs that lids of other lengths follow, as a logarithm: as much as two odd ones."""

_LEAST_GAP_M, _MOST_GAP_M = 0.25, 6.0
"""Length of a stretch without lids within one row, m: longer ones part rows, as entrances do."""

_OCCUPIED_M, _OCCUPIED_WORTH, _GRATING_WORTH = 0.04, 0.04, 0.02
"""A notch makes so much to either side of it open; each place of `POSITION_M` that is open is
worth so much for a grating; a place of a grating must be worth so much. By trial."""

_OPEN_COST = 0.25
"""What each open place costs on a lid, against what it is worth for a grating: weeds and dirt make
a lid's surface seem open too. By trial; no measurement is recorded."""

_SEEN_M = 0.03
"""Notches so near to a joint are of it: as in `gutter_contrast`."""

_LEAST_STRENGTH = 0.1
"""As in `gratings`."""

_JOINT_SCATTER_M = 0.003
"""Standard deviation of joints of one gutter: lids are laid against each other. By trial."""

_UNSEEN_WEIGHT = 1e-3
"""Of a joint that was not seen, against a notch: it stays where the row put it unless others tie
it."""

_TIED_M = 0.05
"""A cover whose measured joints are off its length by more is not tied to it: one of them is
wrong. By trial."""

_ROUNDING_M = 1e-6
"""Guard: the widest joint itself is among those that are tried."""

_CELL_M, _BAND_CELLS = 0.025, 1
"""Notches so near to each other across a gutter are of one opening or one groove: a spacing of
points, to either side."""

_OPENING_M = 0.04
"""An opening's notches lie so near to each other along the gutter (s of Takahashi 2022, Table
7-3)."""

_NO_OTHER_M = 0.34
"""No other joint is nearer, for the shortest lid is 0.5 m: what is open there too makes an opening
worth the less of a joint."""

_BAND_REACH_M, _SHORTEST_M = 1.5, 0.5
"""So far to each side a band is asked how open it is, three joints of the shortest lids: more than
their openings is a groove. What is open k times as often as joints are is worth 1/k² of one, near
the logarithm of the likelihoods."""

_BETWEEN_BARS_M = 0.1
"""So far inside what is barred notches are bars', and no joints: more than a joint's place and the
window are unsure (`gutter_bars`)."""

_LEAST_SUM = 1e-9
"""Guard of a division."""

_LEAST_JOINTS = 3
"""Of a row: two covers (as `_LEAST_COVERS` of `gutter_runs`)."""


def lengths_of(usual_m: Sequence[float], others_m: Sequence[float] = ()) -> dict[float, float]:
    """What a lid of each length costs a row of joints, by the length, m.

    Parameters
    ----------
    usual_m : sequence of float
        Of most lids: one, or several where lids are mixed, of which each lid has to tell its own.
    others_m : sequence of float
        Of single ones between them.
    """
    usual = dict.fromkeys(usual_m, float(np.log(len(usual_m))))
    return usual | dict.fromkeys(others_m, _OTHER_LENGTH_COST)


@dataclass(frozen=True)
class RowNotches:
    """Notches on a gutter.

    Attributes
    ----------
    along_m : (n,) float64
        Places along its axis.
    covers : (n,) float64
        How sure it is that each is an opening of covers: less where it is open all along the
        gutter at the same place across, as the groove beside the lids is, or a curb's foot.
    alone : (n,) float64
        Share of what is open about it, at the same place across, that is of its own opening: 1 at
        a hole, less in gratings and grooves.
    """

    along_m: _Floats
    covers: _Floats
    alone: _Floats

    @property
    def joints(self) -> _Floats:
        """(n,) how sure it is that each is of a joint."""
        return self.covers * self.alone

    @staticmethod
    def of(along_m: _Floats, across_m: _Floats, strength: _Floats) -> RowNotches:
        """From places along and across, and strengths.

        What is open in the same band is asked on the emptier side of each notch: a grating to one
        side of a joint, or the end of a groove, says nothing of the other side.
        """
        if along_m.size == 0:
            return RowNotches(along_m, strength, strength)
        bins = np.floor((along_m - along_m.min()) / _OPENING_M).astype(np.int64)
        cells = np.floor((across_m - across_m.min()) / _CELL_M).astype(np.int64)
        reach, near = round(_BAND_REACH_M / _OPENING_M), round(_NO_OTHER_M / _OPENING_M)
        at = bins + reach + 1
        open_at = np.zeros((int(bins.max()) + 2 * reach + 3, int(cells.max()) + 1))
        np.add.at(open_at, (at, cells), strength)
        band = uniform_filter1d(open_at, 2 * _BAND_CELLS + 1, axis=1, mode="constant")
        summed = np.vstack([np.zeros((1, band.shape[1])), np.cumsum(band, axis=0)])

        def between(first: _Integers, last: _Integers) -> _Floats:
            total: _Floats = summed[last, cells] - summed[first, cells]
            return total

        own = between(at - 1, at + 2)
        sides = np.minimum(between(at - 1 - reach, at - 1), between(at + 2, at + 2 + reach))
        most = own * (_BAND_REACH_M / _SHORTEST_M)
        of_covers = np.minimum(most / np.maximum(sides, _LEAST_SUM), 1.0) ** 2
        about = np.maximum(between(at - near, at + 1 + near), own)
        return RowNotches(along_m, strength * of_covers, own / np.maximum(about, _LEAST_SUM))


@dataclass(frozen=True)
class JointRow:
    """Covers that follow each other along a gutter.

    Attributes
    ----------
    starts_m, ends_m : (k,) float64
        Of the covers, along the axis.
    what : (k,) int64
        ``LID`` or ``GRATING``.
    seen : (k, 2) int64
        Notches at the joints before and behind.
    is_bridged : (k,) bool
        Neither joint was seen.
    value : float
        What the notches are worth for the row against chance, in natural logarithms.
    """

    starts_m: _Floats
    ends_m: _Floats
    what: _Integers
    seen: _Integers
    is_bridged: _Bools
    value: float

    @property
    def share_seen(self) -> float:
        """Share of the joints of its lids that notches show."""
        seen = self.seen[self.what == LID]
        return float((seen > 0).mean()) if seen.size else 0.0

    def chosen(self, which: _Bools) -> JointRow:
        """Some of its covers."""
        return JointRow(
            self.starts_m[which],
            self.ends_m[which],
            self.what[which],
            self.seen[which],
            self.is_bridged[which],
            self.value,
        )


class RowKnown(NamedTuple):
    """What is known of a gutter before its row of joints is looked for.

    Attributes
    ----------
    most_missed : int
        Lids in a row whose joints may all be unseen.
    seen : float
        Share of its joints that notches show.
    barred : (n,) float64, optional
        Of every ``POSITION_M``, the chance that the gutter is barred there as gratings are; without
        it, what is open by the notches.
    """

    most_missed: int
    seen: float = _LEAST_SEEN
    barred: _Floats | None = None


def joint_row(
    notches: RowNotches, mixes: Sequence[Mapping[float, float]], end_m: float, known: RowKnown
) -> JointRow | None:
    """The covers along a gutter, by the places of its notches.

    Parameters
    ----------
    notches : RowNotches
    mixes : sequence of mapping of float
        What the lids may be like: what those of each length cost, see `lengths_of`. Others may
        follow, as where a gutter was laid on later.
    end_m : float
        Where the axis ends.
    known : RowKnown
    """
    best, kinds, lengths = _best(notches, mixes, (end_m, POSITION_M), known)
    positions, taken, _ = _trace(best)
    if positions.size < _LEAST_JOINTS:
        return None
    what = np.where(taken < 0, GAP, kinds[taken])
    long = np.where(taken < 0, np.nan, lengths[taken])
    return _row(
        notches,
        (positions * POSITION_M).astype(np.float64),
        (what, long),
        (float(best.value.max()), known.most_missed),
    )


def joint_worth(
    notches: RowNotches, mixes: Sequence[Mapping[float, float]], end_m: float
) -> tuple[float, tuple[int, ...]]:
    """The value of the best row, roughly, and the numbers of the mixes that it is of.

    For comparison with other lids': see `joint_row`.
    """
    best, _, _ = _best(notches, mixes, (end_m, _ROUGHLY_M), RowKnown(1))
    positions, _, used = _trace(best)
    is_row = positions.size >= _LEAST_JOINTS
    return float(best.value.max()) if is_row else 0.0, tuple(np.unique(used).tolist())


def _best(
    notches: RowNotches,
    mixes: Sequence[Mapping[float, float]],
    line: tuple[float, float],
    known: RowKnown,
) -> tuple[BestRows, _Integers, _Floats]:
    """For each place the best row that ends there; what steps between joints cover, how long."""
    end_m, position_m = line
    count = int(end_m / position_m) + 1
    at = np.round(notches.along_m / position_m).astype(np.int64)
    is_in = (at >= 0) & (at < count)
    joints, hits = (
        np.bincount(at[is_in], one[is_in], minlength=count).astype(np.float64)
        for one in (notches.joints, notches.covers)
    )
    steps, kinds, lengths = _covers(mixes, position_m)
    of_lids = _OPEN_COST
    if known.barred is None:
        occupied = maximum_filter1d(np.minimum(hits, 1.0), 2 * round(_OCCUPIED_M / position_m) + 1)
    else:
        # Lids that are dirty or worn are rough too: of points only gratings are asked.
        occupied, of_lids = known.barred, 0.0
        joints *= 1.0 - minimum_filter1d(occupied, 2 * round(_BETWEEN_BARS_M / position_m) + 1)
    worth = position_m / POSITION_M
    summed = np.concatenate([[0.0], np.cumsum(occupied * _OCCUPIED_WORTH * worth)])
    shape = len(mixes), count
    best = BestRows(np.empty(shape), np.empty(shape, np.int64), np.empty(shape, np.int64))
    joints_kernel(
        _evidence(joints, position_m, known.seen),
        steps,
        GapCost(round(_LEAST_GAP_M / position_m), round(_MOST_GAP_M / position_m), _GAP_COST),
        OpenPlaces(summed, (kinds == GRATING).astype(np.int64), _GRATING_WORTH * worth, of_lids),
        best,
    )
    return best, kinds, lengths


def _evidence(hits: _Floats, position_m: float, seen: float) -> _Floats:
    """What a joint at each place is worth: notches there against notches about.

    One that nothing was seen of costs what it says that it is none: the more of a gutter's joints
    are seen, the more.
    """
    here = gaussian_filter1d(hits, _HOLE_M / position_m) * _HOLE_M / position_m * np.sqrt(2 * np.pi)
    about = uniform_filter1d(here, round(_ABOUT_M / position_m), mode="nearest")
    ratio = np.log((here + _LITTLE) / (about + _LITTLE))
    unseen = -np.log(1.0 - np.clip(seen, _LEAST_SEEN, _MOST_SEEN)) * np.exp(-here / _LITTLE)
    worth: _Floats = np.clip(ratio - unseen, _LEAST, _MOST)
    return worth


def _covers(
    mixes: Sequence[Mapping[float, float]], position_m: float
) -> tuple[Steps, _Integers, _Floats]:
    """Steps from joint to joint with their costs, what they are, and how long the cover is."""
    lids = sorted({one for mix in mixes for one in mix})
    kinds = [(LID, one, [mix.get(one, np.inf) for mix in mixes]) for one in lids]
    kinds += [(GRATING, one, [cost] * len(mixes)) for one, cost in GRATING_LENGTHS_M.items()]
    made = []
    for kind, long, costs in kinds:
        for joint in np.arange(0.0, _WIDEST_JOINT_M + _ROUNDING_M, position_m):
            wide = max(0.0, float(joint) - _WIDE_JOINT_M) * _WIDE_COST
            made.append((round((long + joint) / position_m), np.add(costs, wide), kind, long))
    places, all_costs, what, lengths = zip(*made, strict=True)
    steps = Steps(np.array(places, np.int64), np.column_stack(all_costs), _CHANGE_COST)
    return steps, np.array(what, np.int64), np.array(lengths)


def _trace(best: BestRows) -> tuple[_Integers, _Integers, _Integers]:
    """Places of the best row's joints, the step behind each but the last, and each one's mix."""
    count = best.value.shape[1]
    before, all_taken = best.before.ravel(), best.taken.ravel()
    at, positions, steps = int(best.value.argmax()), [], []
    while at >= 0:
        positions.append(at)
        steps.append(int(all_taken[at]))
        at = int(before[at])
    joints = np.array(positions[::-1])
    return joints % count, np.array(steps[-2::-1], np.int64), joints // count


def _row(
    notches: RowNotches,
    joints_m: _Floats,
    covers: tuple[_Integers, _Floats],
    worth: tuple[float, int],
) -> JointRow:
    what, long = covers
    value, most_missed = worth
    measured, seen = _measure(notches, joints_m)
    joints = _settle(measured, seen, long)
    middles = (joints[1:] + joints[:-1]) / 2
    is_cover = what != GAP
    half = np.where(is_cover, np.minimum(long, np.diff(joints)), 0.0) / 2
    pairs = np.column_stack([seen[:-1], seen[1:]])
    is_unseen = (pairs == 0).all(axis=1) & (what == LID)
    kept = is_cover & ~_longer_than(is_unseen, most_missed)
    starts, ends = middles - half, middles + half
    return JointRow(starts, ends, what, pairs, is_unseen, value).chosen(kept)


def _measure(notches: RowNotches, joints_m: _Floats) -> tuple[_Floats, _Integers]:
    """Mean place of the notches at each joint, and how many strong ones they are."""
    measured, seen = joints_m.copy(), np.zeros(joints_m.size, np.int64)
    order = np.argsort(notches.along_m, kind="stable")
    positions, strength = notches.along_m[order], notches.joints[order]
    first = np.searchsorted(positions, joints_m - _SEEN_M)
    last = np.searchsorted(positions, joints_m + _SEEN_M)
    for number, (low, high) in enumerate(zip(first, last, strict=True)):
        weights = strength[low:high]
        if weights.sum() > _LEAST_STRENGTH:
            measured[number] = float((positions[low:high] * weights).sum() / weights.sum())
            seen[number] = max(1, int((weights > _LEAST_STRENGTH).sum()))
    return measured, seen


def _settle(measured: _Floats, seen: _Integers, long: _Floats) -> _Floats:
    """Joints at which what was measured and how long covers are agree best (least squares)."""
    weights = seen / _HOLE_M**2 + _UNSEEN_WEIGHT / _HOLE_M**2
    is_known = np.isfinite(long)
    gaps = np.diff(measured) - np.where(is_known, long, 0.0)
    usual = float(np.median(gaps[is_known])) if is_known.any() else 0.0
    joint = np.clip(usual, 0.0, _WIDEST_JOINT_M)
    ties = np.where(is_known & (np.abs(gaps - joint) < _TIED_M), 1 / _JOINT_SCATTER_M**2, 0.0)
    wanted = np.where(is_known, long, 0.0) + joint
    bands = np.zeros((2, measured.size))
    bands[1] = weights
    bands[1, :-1] += ties
    bands[1, 1:] += ties
    bands[0, 1:] = -ties
    right = weights * measured
    right[:-1] -= ties * wanted
    right[1:] += ties * wanted
    settled: _Floats = solveh_banded(bands, right)
    return settled


def _longer_than(is_unseen: _Bools, most: int) -> _Bools:
    """Which of those in a row are of rows longer than so many."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], is_unseen.astype(np.int8), [0]])))
    found = np.zeros(is_unseen.size, np.bool_)
    for first, stop in edges.reshape(-1, 2):
        found[first:stop] = stop - first >= most
    return found

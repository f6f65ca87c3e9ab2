"""Gutters: regular lines of notches with their row of covers and the middle of their lids."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.methods.road.gutters.gutter_axis import STEP_M, GutterAxis
from processing.methods.road.gutters.gutter_depths import JointDepths, are_deep
from processing.methods.road.gutters.gutter_holes import (
    HoleFit,
    JointNotches,
    LidType,
    hole_fit,
)
from processing.methods.road.gutters.gutter_joints import (
    LID,
    JointRow,
    RowKnown,
    RowNotches,
    joint_row,
    joint_worth,
    lengths_of,
)
from processing.methods.road.gutters.gutter_lines import (
    LONG,
    REACH_M,
    SHORT,
    GutterLine,
    gutter_lines,
)
from processing.methods.road.gutters.gutter_sides import SideNotches, lids_across, smooth_axis
from processing.methods.road.gutters.notches.notches import Notches, join_notches
from processing.recording.passes import Pass

_Floats = NDArray[np.float64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_BAND_M, _LEVEL_M = 0.45, 0.15
"""Notches so far from a line may be of its lids, half of the widest and its offset; and so far
above or below, a curb's height."""

_MOVED_M = 1.5
"""Farther no axis is moved to the middle of its lids. By trial."""

_JOINT_M = 0.04
"""A notch so near to a joint is of it: s of Takahashi 2022, Table 7-3."""

_CLEAR_OF_JOINT_M = 0.06
"""Between joints begins so far from them: beyond half of the longest hole of 5 cm, the place's own
error and a spacing of points."""

_GROOVE_WIDE_M, _GROOVE_DEEP_M = 0.03, 0.03
"""The groove beside a lid is a gap of a centimetre or less, seen a spacing wider, and a beam that
comes in at 45° falls as deep as it is wide; with both's errors. Of 8,281 notches at the sides of
known lids 93 % are no wider and 96 % no deeper; of those elsewhere 65 and 75 %."""

_ASIDE_M = 0.04
"""A notch may lie so far beside its hole, or beyond the lid's edge: two spacings of points."""

_WEAK, _STRONG = 0.03, 0.1
"""Weaker notches are left out; those from the second on tell the lids' type (see `gratings`). By
trial."""

_CLEAR_M, _END_M = 0.6, 0.1
"""Notches so near to a gutter's axis, and so far beyond its ends, are no other gutter's. By
trial."""

_ROUNDS = 3
"""Of joints, holes and the axis in turn: each is known better by the others."""

_LEAST_COVERS = 2
"""Of a gutter: one lid may be of anything."""

_MORE_BRIDGE_M = 1.0
"""A line goes on over as many lids as may be missed, and so much: a window more."""

_LIDS = (
    lengths_of((0.6,), (0.5, 1.0)),
    lengths_of((0.5,), (0.6, 1.0)),
    lengths_of((1.0,), (0.5, 0.6)),
    lengths_of((0.5, 0.6), (1.0,)),
    lengths_of((0.6, 1.0), (0.5,)),
)
"""What the lids of a gutter may be like: of one length, or of two mixed."""
_BY_CHANCE = (
    lengths_of((0.67,), (0.455, 0.86)),
    lengths_of((0.455,), (0.67, 0.86)),
    lengths_of((0.86,), (0.455, 0.67)),
    lengths_of((0.455, 0.67), (0.86,)),
    lengths_of((0.67, 0.86), (0.455,)),
)
"""The same of lengths that are made nowhere, with their joints apart from those that are."""

_LEAST_WORTH, _MORE_WORTH, _SURE_WORTH = 6.0, 2.5, 50.0
"""Logarithms: a row must be worth so much, and so much more than any row of lengths made nowhere;
what is worth the last is not held against chance, which saves the time. By trial."""

_CHANGES_M = 1.0
"""Lids change their type most where they end, at mouths and junctions: at gaps as long as this."""

_ASKED_M, _USUAL_M = 4.0, 0.6
"""How often else it is asked; the length of most lids (Takahashi 2022, Table 7-2)."""

_LEAST_OF_TYPE, _OTHER_TYPE, _OTHER_WITHOUT_GAP = 6, 3.0, 12.0
"""Notches that tell a type, and how much likelier two types must be than one, at a gap and
anywhere: as logarithms. By trial."""

_LEAST_GAIN = 0.1
"""Notches that lie anywhere across a line are not those of holes and joints: what each of them
gains at least by the holes' places, a logarithm. By trial."""


@dataclass(frozen=True)
class GutterRun:
    """One gutter.

    Attributes
    ----------
    axis : GutterAxis
        Along the middle of its lids.
    row : JointRow
        Its covers.
    holes : HoleFit
        What the holes say of its lids' width.
    length_m : float
        Of most of its lids.
    over_chance : float
        What its joints are worth more than the best row of lengths that no lid has, by the same
        notches: a logarithm. So much is left of it wherever dents come often.
    notches : RowNotches
        That its joints were found by.
    depths : JointDepths
        Of those that are strong.
    mixes : tuple of mapping of float
        What its lids are like: see `joint_row`.
    barred : (k,) float64, optional
        Of each cover, how sure its points are that it is barred (see `gutter_bars`).
    """

    axis: GutterAxis
    row: JointRow
    holes: HoleFit
    length_m: float
    over_chance: float
    notches: RowNotches
    depths: JointDepths
    mixes: tuple[Mapping[float, float], ...]
    barred: _Floats | None = None

    @property
    def edges(self) -> tuple[float, float]:
        """Left and right edge of the lids across the axis, m: of the type that the holes tell.

        The groove beside the lids is too narrow to be measured; the largest change of intensity
        is that of the bed's outer side, some centimetres beyond them.
        """
        half = self.holes.type.width_m / 2
        return -half, half


def gutter_runs(
    passes: Sequence[Pass],
    notches: Sequence[Notches],
    most_missed: int,
    reach_m: float = REACH_M,
    monitor: Monitor | None = None,
) -> tuple[GutterRun, ...]:
    """Gutters that the notches of all drives show.

    Parameters
    ----------
    passes : sequence of Pass
        Of all drives.
    notches : sequence of Notches
        Of each drive.
    most_missed : int
        n_max of equation (7-5): lids in a row whose joints may all be unseen.
    reach_m : float
        How far from the vehicle's path.

    Raises
    ------
    Cancelled
    """
    if not notches:
        return ()
    left = join_notches(list(notches))
    left = left.chosen(left.strength >= _WEAK)
    found: list[GutterRun] = []
    for search in (LONG, SHORT):
        wide = replace(search, reach_m=reach_m)
        for line in gutter_lines(passes, left, wide, most_missed * _USUAL_M + _MORE_BRIDGE_M):
            if monitor is not None:
                monitor.check()
            for run in _runs_of(line, left, most_missed):
                found.append(run)
                left = left.chosen(~_is_covered(run, left.xyz))
    return tuple(found)


def _runs_of(line: GutterLine, notches: Notches, most_missed: int) -> list[GutterRun]:
    """The gutters along a line: more than one where lids of another type follow."""
    run = _run_of(line, notches, most_missed)
    if run is None:
        return []
    cut_m = _change(run, notches)
    if cut_m is None:
        return [run]
    at = int(cut_m / STEP_M)
    axis, parts = run.axis, []
    for part in (slice(0, at + 1), slice(at, None)):
        own = GutterAxis(axis.xyz[part], axis.outwards[part])
        parts += _runs_of(GutterLine(own, line.regularity), notches, most_missed)
    return parts or [run]


def _change(run: GutterRun, notches: Notches) -> float | None:
    """Where lids of another type begin, m along the axis; None: nowhere.

    Asked at each gap between covers, where types change most, and every few metres.
    """
    row = run.row
    near = _about(run.axis, notches)
    along, across, is_on = _on_lids(run.axis, near, None)
    on_row = _row_notches(along, across, near, is_on)
    worth = _worths(along, _alone(on_row, is_on, near), row)
    counting = np.flatnonzero(worth)
    if (worth > 0).sum() < 2 * _LEAST_OF_TYPE:
        return None

    def fit(some: NDArray[np.int64]) -> HoleFit:
        return hole_fit(_joint_notches(run.axis, near.chosen(some), worth[some])[1])

    whole = fit(counting)

    def more(cut_m: float) -> float:
        at = along[counting]
        parts = [fit(counting[at < cut_m]), fit(counting[at >= cut_m])]
        if min(one.count for one in parts) < _LEAST_OF_TYPE or parts[0].type == parts[1].type:
            return -np.inf
        return sum(one.gain * one.count for one in parts) - whole.gain * whole.count

    def best(cuts: _Floats, least: float) -> float | None:
        gains = [(more(cut), cut) for cut in cuts.tolist()]
        gain, cut = max(gains, key=lambda one: one[0], default=(-np.inf, 0.0))
        return cut if gain > least else None

    between = (row.ends_m[:-1] + row.starts_m[1:]) / 2
    is_gap = row.starts_m[1:] - row.ends_m[:-1] > _CHANGES_M
    found = best(between[is_gap], _OTHER_TYPE)
    if found is not None:
        return found
    rough = best(between[:: max(1, round(_ASKED_M / _USUAL_M))], _OTHER_WITHOUT_GAP)
    if rough is None:
        return None
    return best(between[np.abs(between - rough) <= _ASKED_M], _OTHER_WITHOUT_GAP)


def _about(axis: GutterAxis, notches: Notches) -> Notches:
    """The notches near an axis, wherever it may be moved to."""
    along, _, above = axis.coordinates_of(notches.xyz, _MOVED_M)
    return notches.chosen(np.isfinite(along) & (np.abs(above) <= _MOVED_M))


def _is_covered(run: GutterRun, xyz: _Floats) -> NDArray[np.bool_]:
    """Which notches lie on the covers of a run or close beside them."""
    along, _, _ = run.axis.coordinates_of(xyz, _CLEAR_M)
    first, last = float(run.row.starts_m.min()), float(run.row.ends_m.max())
    return np.asarray((along > first - _END_M) & (along < last + _END_M))


def _run_of(line: GutterLine, notches: Notches, most_missed: int) -> GutterRun | None:
    axis = smooth_axis(line.axis)
    near = _about(axis, notches)
    lids = _lids_along(axis, near)
    if not lids:
        return None
    kind, known = None, RowKnown(most_missed)
    for _ in range(_ROUNDS):
        along, across, is_on = _on_lids(axis, near, None)
        on_row = _row_notches(along, across, near, is_on)
        row = joint_row(on_row, lids, axis.length_m, known)
        if row is None or row.starts_m.size < _LEAST_COVERS:
            return None
        known = RowKnown(most_missed, row.share_seen)
        worth = _worths(along, _alone(on_row, is_on, near), row)
        if not (worth > 0.0).any():
            return None
        joints = _joint_notches(axis, near, worth)
        kind, axis = lids_across(axis, joints, _side_notches(near, along, across, row))
    holes = hole_fit(_joint_notches(axis, near, worth)[1])
    if holes.gain < _LEAST_GAIN or kind is None:
        return None
    along, across, is_on = _on_lids(axis, near, kind)
    on_row = _row_notches(along, across, near, is_on)
    row = joint_row(on_row, lids, axis.length_m, known)
    if row is None or row.starts_m.size < _LEAST_COVERS:
        return None
    is_on &= near.strength >= _STRONG
    depths = JointDepths.of(
        along[is_on], near.depth_m[is_on], _square(axis, along, near)[is_on], near.steepness[is_on]
    )
    row = row.chosen(are_deep(row, depths, holes))
    if row.starts_m.size < _LEAST_COVERS:
        return None
    worth_of_lids, _ = joint_worth(on_row, lids, axis.length_m)
    over_chance = worth_of_lids - _by_chance(on_row, axis.length_m)
    holes = replace(holes, type=kind)
    return GutterRun(axis, row, holes, length_of(row), over_chance, on_row, depths, lids)


def _joint_notches(
    axis: GutterAxis, notches: Notches, worth: _Floats
) -> tuple[_Floats, JointNotches]:
    """Where notches that are worth something lie along an axis, and what they say."""
    counting = notches.chosen(worth != 0.0)
    along, across, _ = axis.coordinates_of(counting.xyz, _BAND_M)
    known = np.isfinite(across)
    square = _square(axis, along, counting)[known]
    # An opening is seen a spacing wider than it is, on average.
    wide = np.maximum(counting.width_m - counting.spacing_m, 0.0)[known]
    return along[known], JointNotches(across[known], wide * square, worth[worth != 0.0][known])


def _side_notches(notches: Notches, along: _Floats, across: _Floats, row: JointRow) -> SideNotches:
    """Narrow notches between the joints of lids, which may be of the grooves at their sides."""
    is_lid = row.what == LID
    starts, ends = row.starts_m[is_lid] + _CLEAR_OF_JOINT_M, row.ends_m[is_lid] - _CLEAR_OF_JOINT_M
    known = np.flatnonzero(
        np.isfinite(along)
        & (notches.depth_m <= _GROOVE_DEEP_M)
        & (notches.width_m - notches.spacing_m <= _GROOVE_WIDE_M)
    )
    if starts.size == 0 or known.size == 0:
        return SideNotches(np.empty(0), np.empty(0))
    of = np.clip(np.searchsorted(starts, along[known], "right") - 1, 0, starts.size - 1)
    known = known[(along[known] > starts[of]) & (along[known] < ends[of])]
    return SideNotches(along[known], across[known])


def _square(axis: GutterAxis, along: _Floats, notches: Notches) -> _Floats:
    """(n,) how much each row runs across the axis: 0 along it, 1 square to it; 0 far from it."""
    known = np.isfinite(along)
    at = np.clip((along[known] / STEP_M).astype(np.int64), 0, len(axis.outwards) - 1)
    square = np.zeros(notches.count)
    square[known] = np.abs((notches.direction[known] * axis.outwards[at]).sum(axis=1))
    return square


def _on_lids(
    axis: GutterAxis, notches: Notches, kind: LidType | None
) -> tuple[_Floats, _Floats, NDArray[np.bool_]]:
    """Along and across of notches, and which may be of the lids, as far as their width is known."""
    along, across, above = axis.coordinates_of(notches.xyz, _BAND_M)
    wide = _BAND_M if kind is None else kind.width_m / 2 + _ASIDE_M
    is_on = np.isfinite(along) & (np.abs(above) < _LEVEL_M)
    is_on[is_on] = np.abs(across[is_on]) <= wide
    return along, across, is_on


def _row_notches(
    along: _Floats, across: _Floats, notches: Notches, which: NDArray[np.bool_]
) -> RowNotches:
    return RowNotches.of(along[which], across[which], notches.strength[which])


def _alone(on_row: RowNotches, which: NDArray[np.bool_], notches: Notches) -> _Floats:
    """How far each notch lies alone on a row of joints; 0 of weak ones and of those beside it."""
    alone = np.zeros(notches.count)
    alone[which] = on_row.joints / np.maximum(notches.strength[which], _WEAK)
    return np.where(notches.strength >= _STRONG, alone, 0.0)


def _lids_along(axis: GutterAxis, notches: Notches) -> tuple[Mapping[float, float], ...]:
    """What lids explain the notches best; nothing if no better than by chance.

    What chance does is asked of the same notches: rows of lengths that no lid has are fitted too.
    """
    along, across, is_on = _on_lids(axis, notches, None)
    those = _row_notches(along, across, notches, is_on)
    if those.joints.sum() < _LEAST_WORTH:
        return ()
    worth, used = joint_worth(those, _LIDS, axis.length_m)
    if worth < _LEAST_WORTH:
        return ()
    if worth < _SURE_WORTH and worth < _MORE_WORTH + _by_chance(those, axis.length_m):
        return ()
    return tuple(_LIDS[number] for number in used)


def _by_chance(notches: RowNotches, end_m: float) -> float:
    """What the best row of lengths that no lid has is worth."""
    return joint_worth(notches, _BY_CHANCE, end_m)[0]


def length_of(row: JointRow) -> float:
    """How long most lids of a row are, m; 0 where it has none."""
    lengths = np.round((row.ends_m - row.starts_m)[row.what == LID], 1)
    found, count = np.unique(lengths, return_counts=True)
    return float(found[count.argmax()]) if found.size else 0.0


def _is_at_joint(along: _Floats, row: JointRow) -> NDArray[np.bool_]:
    ends = np.sort(np.concatenate([row.starts_m, row.ends_m]))
    after = np.clip(np.searchsorted(ends, along), 1, ends.size - 1)
    away = np.minimum(np.abs(along - ends[after - 1]), np.abs(along - ends[after]))
    return np.asarray(away < _JOINT_M)


def _worths(along: _Floats, alone: _Floats, row: JointRow) -> _Floats:
    """What each notch counts, as far as it lies alone: at joints 1, between them what chance takes.

    The latter are negative, as many as are expected at joints by chance.
    """
    strong = alone > 0.0
    worth = np.zeros(strong.size)
    worth[strong] = alone[strong] * _is_at_joint(along[strong], row)
    is_lid = row.what == LID
    starts, ends = row.starts_m[is_lid], row.ends_m[is_lid]
    if starts.size:
        one = np.clip(np.searchsorted(starts, along, "right") - 1, 0, starts.size - 1)
        between = strong & (worth == 0.0) & (along > starts[one]) & (along < ends[one])
        free_m = float((ends - starts).sum()) - 2 * _JOINT_M * starts.size
        share = 2 * _JOINT_M * starts.size / max(free_m, _JOINT_M)
        worth[between] = -share * alone[between]
    return worth

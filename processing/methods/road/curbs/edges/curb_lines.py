"""Smooth edges of one curb from end to end, bridged where nothing was seen, cut at openings."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import percentile_filter

from processing.methods.road.curbs.edges.approximate_lines import ApproximateLine
from processing.methods.road.curbs.edges.curb_ends import FACED, own_part
from processing.methods.road.curbs.edges.curb_joins import JointEdges
from processing.methods.road.curbs.edges.curb_smoothing import Smoothness, smooth_values
from processing.methods.road.curbs.edges.edge_measures import STEP_M

_Floats = NDArray[np.float64]
_Flags = NDArray[np.bool_]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

FLAT_M = 0.008
"""A lower step is no edge that could be seen: the ground goes on. Noise of 5 mm over a few points
of two surfaces. By trial."""

_USUAL_M = 0.005
"""Errors of stations that weigh 1: the inlier tolerance of Takahashi 2022, Table 6-1."""

_ACROSS = Smoothness(stiffness=12.0, kink=0.004)
_HEIGHT = Smoothness(stiffness=12.0, kink=0.005)
_STEP = Smoothness(stiffness=2.0, kink=0.003)
_LEAN = Smoothness(stiffness=3000.0, kink=1.0)
"""How places, heights and steps are smoothed, m: steps least, since ramps of dropped curbs are 70
cm long, hardly three stations; the lean nearly not at all but for the whole line, since stones of
one curb lean alike. By trial."""

_TYPICAL_LEAN = 0.08
"""Of upright kerb stones, m across per m of height; where no points lie on a face. By trial."""

_LEAST_LEAN, _MOST_LEAN = -0.1, 1.5
"""Bounds of what is measured: overhanging by noise, and ramp stones."""

_LONGEST_DROP_M, _STEPS_DOWN_M = 12.0, 6.0
"""How long a curb may be lowered to the road and go on: the width of an entrance with its ramps. It
comes down towards it within the second. By trial."""

_FALLEN, _USUAL_OF_END = 0.6, 0.8
"""At an opening the step has come down to this share of the usual one, the latter quantile of those
within the last metres. By trial."""

_FLAT_SHARE, _SHORT_STATIONS = 0.5, 2
"""A hole of which at least half is seen to be flat is an opening, else it is hidden; one of no more
stations than this goes on in any case: one stone."""

_LEAST_M = 1.0
"""Shortest line: two kerb stones of 0.6 m, less their ends."""

_HIDDEN = 0.5
"""A line of which more is hidden looks away from the vehicle."""

_AROUND_M, _USUAL_PERCENT = 8.0, 70.0
"""To either side of a station, m, steps of the curb are asked for their usual height; the
percentile lies above the median, since parts may be lowered. By trial."""

_TALLER, _TALLER_M = 0.15, 0.015
"""What is higher than usual by this share and this much stands on the curb, or is none: heights of
one curb differ by 1 cm. By trial."""


@dataclass(frozen=True)
class CurbLine:
    """The edges of one curb, station by station.

    Attributes
    ----------
    lower, upper : (k, 3) float64
        m, project CRS, the higher ground on the left.
    is_seen : (k,) bool
        False: bridged.
    frame : (k, 3) float64
        Station of the approximate line, and the lower edge across and above it.
    upper_frame : (k, 3) float64
        The same of the upper edge.
    """

    lower: _Floats
    upper: _Floats
    is_seen: _Flags
    frame: _Floats
    upper_frame: _Floats

    @property
    def steps_m(self) -> _Floats:
        """(k,) heights of the step."""
        return self.upper[:, 2] - self.lower[:, 2]


class _Longest(NamedTuple):
    """How long a curb may be hidden, and lowered to the road, and go on; m."""

    hidden: float
    lowered: float


def lines_of(
    approximate_line: ApproximateLine, edges: JointEdges, bridge_m: float
) -> Iterator[CurbLine]:
    """The curbs along an approximate line: one, or several where it is open between them.

    Ends along ground unlike that about the rest are left out, see `curb_ends.own_part`.
    """
    is_measured = np.isfinite(edges.across_error)
    is_edge = is_measured & (edges.steps_m >= FLAT_M)
    is_flat = is_measured & ~is_edge
    is_edge &= ~_stands_out(edges.steps_m, is_edge)
    is_known = is_edge | is_flat
    # A face that looks away and is lowered to the ground shows nothing: there it ends.
    drop_m = 0.0 if approximate_line.is_hidden.mean() > _HIDDEN else _LONGEST_DROP_M
    for part in _parts(is_edge, is_flat, edges.steps_m, _Longest(bridge_m, drop_m)):
        first, stop = own_part(edges, is_edge, part)
        if (stop - first) * STEP_M >= _LEAST_M and is_edge[first:stop].sum() * STEP_M >= _LEAST_M:
            yield _line(approximate_line, edges, (is_edge, is_known), (first, stop))


def _stands_out(steps: _Floats, is_edge: _Flags) -> _Flags:
    """Where the step is much higher than the curb about it: a car, a planter, a post."""
    if not is_edge.any():
        return is_edge
    usual = percentile_filter(
        steps[is_edge], _USUAL_PERCENT, size=2 * int(_AROUND_M / STEP_M) + 1, mode="nearest"
    )
    result = np.zeros_like(is_edge)
    result[is_edge] = steps[is_edge] > usual * (1 + _TALLER) + _TALLER_M
    return result


def _parts(
    is_edge: _Flags, is_flat: _Flags, steps: _Floats, longest_m: _Longest
) -> Iterator[tuple[int, int]]:
    """First and behind the last station of each curb."""
    seen = np.flatnonzero(is_edge)
    if not seen.size:
        return
    first = int(seen[0])
    for last, following in itertools.pairwise(seen):
        if following - last > 1:
            hole = slice(int(last) + 1, int(following))
            if not _goes_on(is_flat, steps, is_edge, hole, longest_m):
                yield first, hole.start
                first = hole.stop
    yield first, int(seen[-1]) + 1


def _goes_on(
    is_flat: _Flags,
    steps: _Floats,
    is_edge: _Flags,
    hole: slice,
    longest_m: _Longest,
) -> bool:
    """Whether a curb goes on where no edge was measured: hidden, or lowered to the road."""
    long_m = (hole.stop - hole.start) * STEP_M
    if float(is_flat[hole].mean()) < _FLAT_SHARE:
        return bool(long_m <= longest_m.hidden)
    short_m = _SHORT_STATIONS * STEP_M
    if long_m > max(longest_m.lowered, short_m):
        return False
    return long_m <= short_m or all(
        _comes_down(steps, is_edge, end, sign)
        for end, sign in ((hole.start - 1, -1), (hole.stop, 1))
    )


def _comes_down(steps: _Floats, is_edge: _Flags, end: int, sign: int) -> bool:
    """Whether a curb is lowered towards an end; the sign says which way the curb lies from it."""
    reach = np.arange(end, end + sign * int(_STEPS_DOWN_M / STEP_M), sign)
    reach = reach[(reach >= 0) & (reach < steps.size)]
    reach = reach[is_edge[reach]]
    near = steps[reach[:2]]
    return bool(near.min() < _FALLEN * np.quantile(steps[reach], _USUAL_OF_END))


def _line(
    approximate_line: ApproximateLine,
    edges: JointEdges,
    flags: tuple[_Flags, _Flags],
    span: tuple[int, int],
) -> CurbLine:
    part = slice(*span)
    is_edge, known = flags[0], flags[1][part]
    across = np.where(is_edge[part], (_USUAL_M / edges.across_error[part]) ** 2, 0.0)
    low = np.where(known, (_USUAL_M / edges.lower_error[part]) ** 2, 0.0)
    high = np.where(known, (_USUAL_M / edges.upper_error[part]) ** 2, 0.0)
    step = np.maximum(smooth_values(edges.steps_m[part], high, _STEP), 0.0)
    lean_weight = np.where(np.isfinite(edges.lean[part]), edges.face_points[part], 0.0)
    lean_weight = lean_weight * np.nan_to_num(edges.steps_m[part]) ** 2
    lean = smooth_values(edges.lean[part], lean_weight, _LEAN)
    lean = np.clip(np.where(np.isfinite(lean), lean, _TYPICAL_LEAN), _LEAST_LEAN, _MOST_LEAN)
    # The middle of a face is better known than its ends; of a hidden one only the upper is seen.
    is_faced = (edges.face_points[part][is_edge[part]] > 0).mean() >= FACED
    share = 0.5 if is_faced else 1.0
    position = (1 - share) * edges.lower_across[part] + share * edges.upper_across[part]
    lower = smooth_values(position, across, _ACROSS) - share * lean * step
    upper = lower + lean * step
    below = smooth_values(edges.lower_above[part], low, _HEIGHT)
    stations = np.arange(*span, dtype=np.float64)
    frames = (
        np.column_stack([stations, lower, below]),
        np.column_stack([stations, upper, below + step]),
    )
    return CurbLine(
        in_space(approximate_line, frames[0]),
        in_space(approximate_line, frames[1]),
        is_edge[part],
        frames[0],
        frames[1],
    )


def in_space(approximate_line: ApproximateLine, frame: _Floats) -> _Floats:
    """(k, 3) places of an approximate line, m, project CRS; stations may lie between vertices."""
    at = np.arange(approximate_line.xyz.shape[0])
    xyz = np.column_stack([np.interp(frame[:, 0], at, column) for column in approximate_line.xyz.T])
    left = np.column_stack(
        [np.interp(frame[:, 0], at, column) for column in approximate_line.outwards.T]
    )
    xyz[:, :2] += left * frame[:, 1:2]
    xyz[:, 2] += frame[:, 2]
    return xyz

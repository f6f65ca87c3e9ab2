"""What is known of a curb's line once its edges are measured: the facts that tell curbs apart.

A curb is concrete and stands at the road: nothing rises between the vehicle and its foot, paved
ground lies up to it and level ground behind it; its edges are straight and even and its face
steep. Walls and plinths stand on the pavement or are taller than kerb stones; verges, ridges of
fields and hedges are rough and uneven.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.methods.road.curbs.edges.approximate_lines import ApproximateLine
from processing.methods.road.curbs.edges.curb_edges import MeasuredEdges
from processing.methods.road.curbs.edges.curb_ends import FACED
from processing.methods.road.curbs.edges.curb_joins import JointEdges
from processing.methods.road.curbs.edges.curb_lines import CurbLine
from processing.methods.road.curbs.edges.edge_measures import (
    HIGH_OFF,
    LEAN,
    LOW_OFF,
    LOW_POINTS,
    STEP_M,
)
from processing.methods.road.curbs.steps.curb_confidence import CurbFacts, chance_of, confidence_of
from processing.methods.road.curbs.steps.curb_runs import StepRun

_Floats = NDArray[np.float64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_LEAST_NOISE_M = 0.002
"""No scanner's points of even ground lie nearer to it."""

_QUIET = 0.25
"""Share of all stations, the quietest, whose ground is taken for even: more is grass and litter. By
trial."""

_NOISES = 2.5
"""Places of one face differ by so many times the noise of single points. By trial."""

_TALLEST_USUAL_M, _TALLER = 0.25, 1.5
"""Blocks of JIS A 5371 show no more above the road; of one survey's curbs the higher are about so
many times as high as the lower, since walks are raised alike."""

_TYPICAL_M = 10.0
"""Lines of which so much was measured tell how high curbs are; walls and steps of houses with a
curb's face and top hardly go on for as long."""

_USUAL_LEAN = 0.3
"""Half of what a face may lean by Takahashi 2022, Table 6-1 (30°), m across per m of height."""

_LONG_M = 20.0
"""What is longer may well stand behind another curb: a median, the far carriageway. By trial."""

_MOST_UNEVEN, _MOST_ROUGH = 1.5, 4.0
_MOST_VERGE_M = 1.0
"""Bound of a fact: of verges as wide grass is mown beside roads, and wider ones say no more."""

_BESIDE_M = 0.5
"""A place of a run so near to a line tells what lies before it; runs lie up to 15 cm off."""

_FRONT = 0.5
"""A line that is rather a curb than none raises what lies behind it."""

_MOST_RISEN_M, _MOST_ABOVE_M, _MOST_TALL_M, _MOST_FLAT = 0.2, 0.1, 0.2, 0.7
"""Bounds of facts, so that none outweighs all others; see `CurbFacts` for their units. They were
set before the weights were fitted."""

_ALONG, _HIDDEN = 0.7, 0.5
"""A run is along the vehicle's path if it goes on for at least this share of its length (45°); a
line counts as hidden if at least half of its places are."""

_FIELD_M = 0.25
"""Below the road: no cross slope of a road comes down so far."""

_LEAST_LONG_M = 0.5
"""Guard of a logarithm: no line is shorter."""

_SHOWN_M = 0.05
"""Of lower steps pulses often miss the face: the lowest full curb."""

_FOOT_POINTS = 1.0
"""Weight of points before the edge; where none were seen it is less (`curb_edge_kernels`)."""

_WALL_ASIDE_M, _WALL_ABOVE_M, _WALL_POINTS = 0.06, 0.10, 2
"""So near to the upper edge, and so far above it, no more than a stray point lies unless the face
goes on: what stands on a walk stands behind the stone, 10 cm wide and more."""

_LEAST_STATIONS = 4
"""With fewer stations there are too few differences for a median."""


class UsualMeasures(NamedTuple):
    """What is usual in a recording.

    Attributes
    ----------
    inlier_m : float
        How far points may lie off a surface.
    noise_m : float
        How far single points of even ground lie off it.
    step_m : float
        Height of a curb.
    """

    inlier_m: float
    noise_m: float
    step_m: float


def usual_step_m(curbs: Sequence[CurbLine]) -> float:
    """How high curbs are: the median place of all long lines, m; of none, what standards allow."""
    steps = [one.steps_m[one.is_seen] for one in curbs if one.is_seen.sum() * STEP_M >= _TYPICAL_M]
    return _median(np.concatenate(steps)) if steps else _TALLEST_USUAL_M / _TALLER


def noise_of(measures: Sequence[_Floats]) -> float:
    """How far points of even ground lie off it, by the quieter quarter of all stations, m."""
    offs = np.concatenate([np.empty(0), *(one[:, LOW_OFF] for one in measures)])
    offs = offs[np.isfinite(offs)]
    return max(float(np.quantile(offs, _QUIET)), _LEAST_NOISE_M) if offs.size else _LEAST_NOISE_M


def facts_of(
    line: tuple[ApproximateLine, CurbLine],
    runs: Sequence[StepRun],
    edges: JointEdges,
    measured: Sequence[MeasuredEdges],
    usual: UsualMeasures,
) -> CurbFacts:
    """The facts of a line along an approximate line.

    Parameters
    ----------
    line : tuple
        The approximate line and the curb found along it.
    runs : sequence of StepRun
        What the approximate line is made of.
    edges : JointEdges
        At the approximate line's stations.
    measured : sequence of MeasuredEdges
        Of each drive.
    usual : UsualMeasures
    """
    approximate_line, curb = line
    stations = _stations(curb)
    shares = _shares(approximate_line, stations)
    # What repeats along a street may cross the vehicle's path and stand where others have risen.
    lone = 1.0 - _weighed(shares, lambda number: float(runs[number].chance_beside > 0))
    crossing = lone * _weighed(shares, lambda number: float(not _is_along(runs[number]))) > 0.5
    short = lone
    if not crossing:
        short *= max(1.0 - float(curb.is_seen.sum()) * STEP_M / _LONG_M, 0.0)
    risen_m = min(_weighed(shares, lambda number: _risen_m(runs[number])), _MOST_RISEN_M)
    above_m = _weighed(shares, lambda number: _seen_median(runs[number], "above_path_m"))
    above_m = 0.0 if above_m < -_FIELD_M else above_m
    known = np.isfinite(edges.across_error[stations])
    part = [one.measures[stations] for one in measured]
    is_faced = bool(known.any() and (edges.face_points[stations][known] > 0).mean() >= FACED)
    # Of a face that looks away from the vehicle nothing but the upper edge was measured. What was
    # found from its front without any point on the face is known by the ground before it alone.
    is_foot_seen = is_faced or float(approximate_line.is_hidden[stations].mean()) < _HIDDEN
    surfaces = (LOW_OFF, HIGH_OFF) if is_foot_seen else (HIGH_OFF,)
    off_m = max(_median_of(part, column) for column in surfaces)
    lean = _median_of(part, LEAN) if is_faced else 0.0
    return CurbFacts(
        before=_weighed(shares, lambda number: confidence_of(runs[number])),
        risen_m=0.0 if crossing else short * risen_m,
        above_path_m=short * min(max(above_m, -_MOST_ABOVE_M), _MOST_ABOVE_M),
        crossing=float(crossing),
        too_tall_m=min(max(_median(curb.steps_m) - _TALLER * usual.step_m, 0.0), _MOST_TALL_M),
        too_flat=min(max(lean - _USUAL_LEAN, 0.0), _MOST_FLAT),
        uneven=_unevenness(
            edges, stations, max(usual.inlier_m, _NOISES * usual.noise_m), is_faced=is_faced
        ),
        rough=min(max(off_m / usual.noise_m, 1.0), _MOST_ROUGH),
        long_m=min(max(float(curb.is_seen.sum()) * STEP_M, _LEAST_LONG_M), _LONG_M),
        faceless=_faceless(line, edges, part, stations),
        walled=_walled(curb, measured),
        bridged=float((~curb.is_seen).mean()),
        verge_m=_verge_m(curb, [runs[number] for number in shares]),
        unraised=float(not crossing and _is_far_side(approximate_line, stations)),
    )


def raised_by_others(facts: CurbFacts, share: float) -> CurbFacts:
    """The facts of a line of which a share lies behind another curb, on what that one raised."""
    return facts._replace(
        verge_m=(1 - share) * facts.verge_m, unraised=(1 - share) * facts.unraised
    )


def is_front(line: ApproximateLine, facts: CurbFacts) -> bool:
    """Whether a line is a curb by itself, which may raise what lies behind it."""
    return float(line.is_hidden.mean()) < _HIDDEN and chance_of(facts) >= _FRONT


def _is_far_side(line: ApproximateLine, stations: slice) -> bool:
    """Whether the ground falls here, seen from the vehicle; edging stones have their own rule."""
    is_hidden = float(line.is_hidden[stations].mean()) >= _HIDDEN
    return is_hidden and not bool(line.is_edging[stations].any())


def _verge_m(curb: CurbLine, runs: Sequence[StepRun]) -> float:
    """Rough ground before the line, by what runs know where they are beside it."""
    tree = cKDTree(curb.lower[:, :2])
    wide = [np.empty(0)]
    for run in runs:
        away = tree.query(run.lower[:, :2], distance_upper_bound=_BESIDE_M)[0]
        wide.append(run.verge_m[np.isfinite(away) & run.is_seen])
    return min(_median(np.concatenate(wide)), _MOST_VERGE_M)


def _stations(curb: CurbLine) -> slice:
    return slice(int(curb.frame[0, 0]), int(curb.frame[-1, 0]) + 1)


def _faceless(
    line: tuple[ApproximateLine, CurbLine],
    edges: JointEdges,
    part: Sequence[_Floats],
    stations: slice,
) -> float:
    """Share of the places whose foot and top are seen, and no point of the face between them."""
    has_foot = np.any([one[:, LOW_POINTS] >= _FOOT_POINTS for one in part], axis=0)
    approximate_line, curb = line
    can_show = curb.is_seen & has_foot & (curb.steps_m >= _SHOWN_M)
    can_show &= ~approximate_line.is_hidden[stations]
    if can_show.sum() < _LEAST_STATIONS:
        return 0.0
    return float((edges.face_points[stations][can_show] <= 0).mean())


def _walled(curb: CurbLine, measured: Sequence[MeasuredEdges]) -> float:
    """Share of the places where the face goes on upwards beyond the upper edge."""
    first = curb.upper_frame[0, 0]
    has_wall = np.zeros(curb.is_seen.size, np.bool_)
    for one in measured:
        begin, end = np.searchsorted(one.along, curb.upper_frame[[0, -1], 0])
        at = one.along[begin:end]
        off = [
            one.across_above[begin:end, k] - np.interp(at, *curb.upper_frame[:, [0, k + 1]].T)
            for k in (0, 1)
        ]
        is_wall = (np.abs(off[0]) <= _WALL_ASIDE_M) & (off[1] >= _WALL_ABOVE_M)
        counts = np.bincount((at[is_wall] - first).astype(np.int64), minlength=has_wall.size)
        has_wall |= counts[: has_wall.size] >= _WALL_POINTS
    return float(has_wall.mean())


def _shares(approximate_line: ApproximateLine, stations: slice) -> dict[int, float]:
    """How much of some stations is of each run; of the whole line where they are of none."""
    of = approximate_line.runs[stations]
    of = of[of >= 0] if (of >= 0).any() else approximate_line.runs[approximate_line.runs >= 0]
    numbers, counts = np.unique(of, return_counts=True)
    return dict(zip(numbers.tolist(), (counts / max(of.size, 1)).tolist(), strict=True))


def _weighed(shares: dict[int, float], value: Callable[[int], float]) -> float:
    return sum(share * value(number) for number, share in shares.items())


def _is_along(run: StepRun) -> bool:
    """Whether a run goes on about as far along the vehicle's path as it is long."""
    ends = np.hypot(*np.diff(run.lower[:, :2], axis=0).T).sum()
    return float(np.ptp(run.stations_m)) >= _ALONG * float(ends)


def _risen_m(run: StepRun) -> float:
    return abs(float(np.mean(run.risen_m[run.is_seen]))) if run.is_seen.any() else 0.0


def _seen_median(run: StepRun, name: str) -> float:
    return _median(getattr(run, name)[run.is_seen])


def _unevenness(edges: JointEdges, stations: slice, unit_m: float, *, is_faced: bool) -> float:
    known = np.isfinite(edges.across_error[stations])
    if known.sum() < _LEAST_STATIONS:
        return 0.0
    uneven = _median(np.abs(np.diff(edges.steps_m[stations][known])))
    if is_faced:
        uneven = max(uneven, _median(np.abs(np.diff(edges.lower_across[stations][known], 2))))
    return min(uneven / unit_m, _MOST_UNEVEN)


def _median_of(measures: Sequence[_Floats], column: int) -> float:
    """Over all drives and stations."""
    return _median(np.concatenate([one[:, column] for one in measures]))


def _median(values: _Floats) -> float:
    """Of what is known; 0 where nothing is."""
    values = values[np.isfinite(values)]
    return float(np.median(values)) if values.size else 0.0

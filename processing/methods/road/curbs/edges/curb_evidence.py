"""What is known of a curb's line once its edges are measured: the facts that tell curbs apart.

A curb is concrete and stands at the road: nothing rises between the vehicle and its foot, paved
ground lies before it and level ground behind it; its edges are straight and even and its face
steep. Walls and plinths stand on the pavement or are taller than kerb stones; verges, ridges of
fields and hedges are rough and uneven.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.curbs.edges.approximate_lines import ApproximateLine
from processing.methods.road.curbs.edges.curb_edge_kernels import HIGH_OFF, LEAN, LOW_OFF, STEP_M
from processing.methods.road.curbs.edges.curb_ends import FACED
from processing.methods.road.curbs.edges.curb_joins import JointEdges
from processing.methods.road.curbs.edges.curb_lines import CurbLine
from processing.methods.road.curbs.steps.curb_confidence import CurbFacts, confidence_of
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

_TALLEST_USUAL_M = 0.25
"""Blocks of JIS A 5371 show no more above the road."""

_USUAL_LEAN = 0.3
"""Half of what a face may lean by Takahashi 2022, Table 6-1 (30°), m across per m of height."""

_LONG_M = 20.0
"""What is longer may well stand behind another curb: a median, the far carriageway. By trial."""

_MOST_UNEVEN, _MOST_ROUGH = 1.5, 4.0
_MOST_RISEN_M, _MOST_ABOVE_M, _MOST_TALL_M, _MOST_FLAT = 0.2, 0.1, 0.2, 0.7
"""Bounds of facts, so that none outweighs all others; see `CurbFacts` for their units. They were
set before the weights were fitted."""

_ALONG, _HIDDEN = 0.7, 0.5
"""A run is along the vehicle's path if it goes on for at least this share of its length (45°); a
line counts as hidden if at least half of its places are."""

_FIELD_M = 0.25
"""Below the road: no cross slope of a road comes down so far."""

_LEAST_STATIONS = 4
"""With fewer stations there are too few differences for a median."""


def noise_of(measures: Sequence[_Floats]) -> float:
    """How far points of even ground lie off it, by the quieter quarter of all stations, m."""
    offs = np.concatenate([np.empty(0), *(one[:, LOW_OFF] for one in measures)])
    offs = offs[np.isfinite(offs)]
    return max(float(np.quantile(offs, _QUIET)), _LEAST_NOISE_M) if offs.size else _LEAST_NOISE_M


def facts_of(
    line: tuple[ApproximateLine, CurbLine],
    runs: Sequence[StepRun],
    edges: JointEdges,
    measures: Sequence[_Floats],
    tolerances: tuple[float, float],
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
    measures : sequence of (m, MEASURES) float64
        Of each drive.
    tolerances : tuple of float
        Inlier tolerance, m; noise of single points, m.
    """
    approximate_line, curb = line
    stations = slice(int(curb.frame[0, 0]), int(curb.frame[-1, 0]) + 1)
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
    part = [one[stations] for one in measures]
    is_faced = bool(known.any() and (edges.face_points[stations][known] > 0).mean() >= FACED)
    inlier_m, noise_m = tolerances
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
        too_tall_m=min(max(_median(curb.steps_m) - _TALLEST_USUAL_M, 0.0), _MOST_TALL_M),
        too_flat=min(max(lean - _USUAL_LEAN, 0.0), _MOST_FLAT),
        uneven=_unevenness(edges, stations, max(inlier_m, _NOISES * noise_m), is_faced=is_faced),
        rough=min(max(off_m / noise_m, 1.0), _MOST_ROUGH),
    )


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

"""Steps of neighbouring scanlines linked to runs: a curb from end to end, still rough."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.curbs.steps.curb_chains import Chain
from processing.methods.road.curbs.steps.curb_profile import PassSteps
from processing.methods.road.curbs.steps.link_kernels import smooth_kernel
from processing.methods.road.curbs.steps.step_columns import (
    FACE_COUNT,
    FOOT_COVER_M,
    FOOT_M,
    FOOT_ROUGH_M,
    LOWER_ACROSS,
    LOWER_HEIGHT,
    SIGN,
    SIGNIFICANCE,
    TOP_M,
    UPPER_ACROSS,
    UPPER_HEIGHT,
)
from processing.methods.road.rising import nearest_rising

Floats = NDArray[np.float64]
_Line = tuple[Floats, Floats, Floats, NDArray[np.bool_]]
"""Where something was measured along a run and how much it counts; the run's stations, and whether
something was measured near each."""

_REACH_M, _HIGH_REACH_M = 0.6, 0.35
"""How far along a run places and heights are smoothed: ramps of dropped curbs are 0.7 m long, so
heights over half of one to either side, places over somewhat more."""

_SEEN_WITHIN_M = 0.3
"""A place of a run is seen if a step was found so near along the vehicle's path: three scanlines.
By trial: no measurement is recorded."""

_BEFORE_M = 0.3
"""What rises so near before a run is of its own foot or apron and doesn't count as risen before.
By trial: no measurement is recorded."""

_HIDDEN_WEIGHT = 0.5
"""Of a step without a vertex on its face, whose place is only known to lie in a gap. By trial."""


@dataclass(frozen=True)
class StepRun:
    """One continuous step along a pass, its edges known within about 3 cm.

    Attributes
    ----------
    drive : int
        Which of the drives given.
    side : int
        −1 left, 1 right of the vehicle's path.
    rises : int
        1 where the ground is higher on the far side (seen from the vehicle's path), −1 where it is
        lower: the far edges of islands, whose faces mostly are hidden.
    stations_m : (k,) float64
        Along the pass. They increase but round corners, where a run turns away from the vehicle's
        path.
    times_s : (k,) float64
        When the places were measured.
    lower, upper : (k, 3) float64
        Edges, in order along the run, some 0.1 m apart; m, project CRS.
    is_seen : (k,) bool
        False: nothing was measured there, the place is bridged.
    face_m : (k,) float64
        Width of the face across, m; great at ramps. NaN where bridged.
    top_m, foot_m : (k,) float64
        Over which width level ground was seen behind the upper and before the lower edge, m.
    spread_m : (k,) float64
        How far the place as found lies off the smooth line, m; NaN where bridged.
    significance : (k,) float64
        Height of the step as found, in its standard deviations; 0 where bridged.
    foot_roughness_m : (k,) float64
        How far points of the ground before the lower edge lie off it, m. NaN where bridged.
    foot_cover_m : (k,) float64
        The same of all points there, those too that hang over the ground. NaN where bridged.
    above_path_m : (k,) float64
        Height of the lower edge above the road where the vehicle passed it, m. NaN where bridged.
    risen_m : (k,) float64
        What other steps between the vehicle's path and this one add up to, up less down, m: 0 for
        the first from the road, about the curb's height for what stands on the pavement behind it.
    verge_m : (k,) float64
        How much ground between the vehicle's path and the lower edge is rough, grass or soil, m.
    is_edging : bool
        The far edge of a narrow edging stone.
    chance_beside : float
        How likely it is a curb by others that are like it, 0 to 1; 0: there are none.
    """

    drive: int
    side: int
    rises: int
    stations_m: Floats
    times_s: Floats
    lower: Floats
    upper: Floats
    is_seen: NDArray[np.bool_]
    face_m: Floats
    top_m: Floats
    foot_m: Floats
    spread_m: Floats
    significance: Floats
    foot_roughness_m: Floats
    foot_cover_m: Floats
    above_path_m: Floats
    risen_m: Floats
    verge_m: Floats
    is_edging: bool = False
    chance_beside: float = 0.0

    @property
    def heights_m(self) -> Floats:
        """(k,) of the step, m."""
        heights: Floats = self.upper[:, 2] - self.lower[:, 2]
        return heights

    @property
    def seen_m(self) -> float:
        """Length of what was seen, m."""
        steps = np.hypot(*np.diff(self.upper[:, :2], axis=0).T)
        return float(steps[self.is_seen[1:]].sum())


def median_of(values: Floats) -> float:
    """The median of at least one known value: several times faster than numpy's for some tens."""
    rising = np.sort(values)
    return float(rising[(rising.size - 1) // 2] + rising[rising.size // 2]) / 2


def is_raised(run: StepRun, least_step_m: float) -> bool:
    """Whether a run stands on ground that other steps have raised above the road."""
    return median_of(run.risen_m[run.is_seen]) >= least_step_m


def run_of(steps: PassSteps, chain: Chain, number: int, among: PassSteps | None = None) -> StepRun:
    """The smooth line through the steps of a chain, at every scanline.

    Parameters
    ----------
    number : int
        Which of the drives given it is of.
    among : PassSteps, optional
        All steps of the same scanlines, where the chain is not of them.
    """
    rows = steps.table[chain.rows]
    every, nearest, line = _line_of(steps, chain)
    at, _, stations, is_seen = line
    positions = (rows[:, LOWER_ACROSS] + rows[:, UPPER_ACROSS]) / 2
    wide = np.abs(rows[:, UPPER_ACROSS] - rows[:, LOWER_ACROSS])
    middle, face = _smooth(positions, line), _smooth(wide, line)
    low = _smooth(rows[:, LOWER_HEIGHT], line, _HIGH_REACH_M)
    high = _smooth(rows[:, UPPER_HEIGHT], line, _HIGH_REACH_M)
    lower = _place(steps, every, middle - chain.sign * face / 2, low)
    upper = _place(steps, every, middle + chain.sign * face / 2, np.maximum(high, low))
    off = np.abs(positions - np.interp(at, stations, middle))
    side = 1 if median_of(middle) > 0 else -1
    unseen = np.where(is_seen, 0.0, np.nan)
    return StepRun(
        drive=number,
        side=side,
        rises=chain.sign * side,
        stations_m=stations,
        times_s=np.interp(stations, at, steps.times_s[chain.rows]),
        lower=lower,
        upper=upper,
        is_seen=is_seen,
        face_m=wide[nearest] + unseen,
        top_m=np.where(is_seen, rows[nearest, TOP_M], 0.0),
        foot_m=np.where(is_seen, rows[nearest, FOOT_M], 0.0),
        spread_m=off[nearest] + unseen,
        significance=np.where(is_seen, rows[nearest, SIGNIFICANCE], 0.0),
        foot_roughness_m=rows[nearest, FOOT_ROUGH_M] + unseen,
        foot_cover_m=rows[nearest, FOOT_COVER_M] + unseen,
        above_path_m=low + unseen,
        risen_m=_risen(among or steps, (every, middle), side),
        verge_m=np.zeros(stations.size),
    )


def spread_of(steps: PassSteps, chain: Chain) -> Floats:
    """(k,) how far steps of a chain lie off the smooth line through them, m; as of a run."""
    rows = steps.table[chain.rows]
    _, nearest, line = _line_of(steps, chain)
    at, _, stations, is_seen = line
    positions = (rows[:, LOWER_ACROSS] + rows[:, UPPER_ACROSS]) / 2
    off = np.abs(positions - np.interp(at, stations, _smooth(positions, line)))
    spread: Floats = off[nearest] + np.where(is_seen, 0.0, np.nan)
    return spread


def _line_of(steps: PassSteps, chain: Chain) -> tuple[NDArray[np.int64], NDArray[np.int64], _Line]:
    """(k,) the scanlines of a chain, and which of its steps is nearest to each; where it runs."""
    sections = steps.sections[chain.rows]
    at = steps.stations_m[sections]
    every = np.arange(sections[0], sections[-1] + 1)
    stations = steps.stations_m[every]
    nearest = nearest_rising(at, stations)
    is_seen = np.abs(at[nearest] - stations) <= _SEEN_WITHIN_M
    weights = np.where(steps.table[chain.rows, FACE_COUNT] > 0, 1.0, _HIDDEN_WEIGHT)
    return every, nearest, (at, weights, stations, is_seen)


def _smooth(values: Floats, line: _Line, reach_m: float = _REACH_M) -> Floats:
    """What was measured along a run, smooth at every station of it."""
    at, weights, stations, is_seen = line
    out = np.empty(stations.size)
    smooth_kernel(at, np.ascontiguousarray(values), weights.copy(), reach_m, stations, out)
    if is_seen.all():
        return out
    # Straight over what wasn't seen: the directions at its ends say nothing over metres.
    smooth: Floats = np.interp(stations, stations[is_seen], out[is_seen])
    return smooth


def _place(steps: PassSteps, every: NDArray[np.int64], across: Floats, height: Floats) -> Floats:
    """Where places beside the vehicle's path are: (k, 3), m, project CRS."""
    shift = np.column_stack([across[:, None] * steps.rights[every], height])
    positions: Floats = steps.positions[every] + shift
    return positions


def _risen(steps: PassSteps, line: tuple[NDArray[np.int64], Floats], side: int) -> Floats:
    """(k,) heights of the steps between the path and a line, up less down, m."""
    every, middle = line
    first, stop = np.searchsorted(steps.sections, [every[0], every[-1] + 1])
    rows = steps.table[first:stop]
    position = steps.sections[first:stop] - every[0]
    across = side * rows[:, LOWER_ACROSS]
    is_between = (across > 0) & (across < side * middle[position] - _BEFORE_M)
    heights = (rows[:, UPPER_HEIGHT] - rows[:, LOWER_HEIGHT]) * rows[:, SIGN] * side
    between = np.bincount(position[is_between], heights[is_between], minlength=every.size)
    return np.asarray(between, np.float64)

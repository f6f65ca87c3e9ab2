"""What is being built: the ground as it was, as it is designed, and how far the work has come.

Earth is moved in horizontal layers: it is cut down to a level and filled up to a level, and both
levels differ from stretch to stretch of the work.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.sites.relief import undulation

_LIFT_M = 0.3  # a layer of fill as it is spread (道路土工 盛土工指針 2010: 30 cm at most)
_LEVEE_SLOPE = (2.0, 2.6)  # 1:2 or gentler (河川管理施設等構造令 第22条)
_BERM_M = (3.0, 4.0)  # 小段 of a levee (同令 第23条: 3 m or more)
_CUT_SLOPE = (0.6, 1.2)  # 道路土工 切土工・斜面安定工指針 2009, by rock and soil
_FILL_SLOPE = (1.5, 2.0)  # 同 盛土工指針
_BENCH_M = (1.0, 2.0)
_BENCH_EVERY_M = (5.0, 7.0)


@dataclass(frozen=True)
class WorkPlacement:
    """Where the work lies on the site.

    Attributes
    ----------
    x, y : (rows, columns) float64
        Nodes, m, the site's frame.
    u, v : (rows, columns) float64
        Along the work and to its left, m, from the middle of the site; bent and turned.
    """

    x: Floats
    y: Floats
    u: Floats
    v: Floats

    @property
    def wide_m(self) -> float:
        """From side to side of the site."""
        return float(np.ptp(self.y))


@dataclass(frozen=True)
class Plan:
    """What is to be built.

    Attributes
    ----------
    natural, design : (rows, columns) float64
        Ground as it was and as it is designed, m.
    reach_m : float
        Half width of the strip along the work within which anything is done, and from which it is
        scanned.
    gain : (float, float)
        Least and most share of the work that is done between the dates on a stretch.
    """

    natural: Floats
    design: Floats
    reach_m: float = np.inf
    gain: tuple[float, float] = (0.05, 0.75)

    def built(self, down_to: Floats, up_to: Floats) -> Floats:
        """The ground when it is cut down and filled up to levels, never past the design."""
        cut = np.maximum(self.design, np.minimum(self.natural, down_to))
        fill = np.minimum(self.design, np.maximum(self.natural, up_to))
        return np.where(self.design < self.natural, cut, fill)


def work_placement_of(random: Generator, x: Floats, y: Floats) -> WorkPlacement:
    """Where the work lies: along the site, but bent, turned and not quite in its middle."""
    wide, high = float(np.ptp(x)), float(np.ptp(y))
    turn = random.uniform(-0.14, 0.14)
    dx, dy = x - wide / 2, y - high / 2 - random.uniform(-0.06, 0.06) * high
    along, across = (
        np.cos(turn) * dx + np.sin(turn) * dy,
        -np.sin(turn) * dx + np.cos(turn) * dy,
    )
    bend = random.uniform(-0.35, 0.35) * high / wide**2
    wobble = 0.25 * np.sin(along / random.uniform(4, 11) + random.uniform(0, 6))
    if random.random() < 0.5:
        across = -across
    return WorkPlacement(x, y, along, across + bend * along**2 + wobble * 0.4)


def levee(random: Generator, lie: WorkPlacement) -> Plan:
    """A levee that is raised and widened on its land side (左右どちらか)."""
    high = float(np.clip(random.uniform(0.08, 0.15) * lie.wide_m, 0.7, 6.5))
    crest = float(np.clip(random.uniform(0.08, 0.16) * lie.wide_m, 1.5, 7.0))
    river, land = random.uniform(*_LEVEE_SLOPE, 2)
    natural = _uneven(random, lie, 0.12) + 0.02 * lie.v
    berm = random.uniform(*_BERM_M) if high > 3.6 else 0.0
    old = _bank(lie.v, high, crest, (river * 0.93, land * 0.93, berm))
    settled = 0.12 * undulation(random, lie.x, lie.y, 9.0)
    raised = random.uniform(0.3, 0.28 * high + 0.4)
    wider = random.uniform(0.0, 0.5) * crest
    new = _bank(lie.v - wider / 2, high + raised, crest + wider, (river, land, berm))
    before = np.maximum(natural, old + np.where(old > 0.3, settled, 0.0))
    trimmed = np.where(old > 0.5, -random.uniform(0.0, 0.25), 0.0)
    return Plan(before, np.maximum(before + trimmed, np.where(new > natural, new, -np.inf)))


def cutting(random: Generator, lie: WorkPlacement) -> Plan:
    """A road in a hillside: cut on its upper side in benches, filled on its lower side."""
    scale = lie.wide_m
    fall = random.uniform(0.14, 0.42)
    natural = fall * lie.v + _uneven(random, lie, 0.35)
    half = float(np.clip(random.uniform(0.09, 0.15) * scale, 1.2, 9.0))
    grade = random.uniform(-0.06, 0.06)
    road = grade * lie.u + random.uniform(-0.06, 0.06) * scale * fall
    road = road + 0.015 * lie.v
    beside = np.maximum(np.abs(lie.v) - half, 0.0)
    bench, every = random.uniform(*_BENCH_M), random.uniform(*_BENCH_EVERY_M)
    upper = _benched(beside, 1.0 / random.uniform(*_CUT_SLOPE), bench, every)
    lower = _benched(beside, 1.0 / random.uniform(*_FILL_SLOPE), bench, every)
    ditch = np.where((beside > 0.1) & (beside < 0.7), -0.25, 0.0)
    return Plan(natural, np.clip(natural, road - lower, road + upper + ditch))


def pad(random: Generator, lie: WorkPlacement) -> Plan:
    """Building land: terraces with slopes or walls between them, cut and filled."""
    scale = lie.wide_m
    fall = random.uniform(0.04, 0.2)
    natural = fall * lie.v + _uneven(random, lie, 0.5)
    count = int(random.integers(2, 6))
    edges = np.sort(random.uniform(-0.38, 0.38, count - 1)) * scale
    bounds = np.r_[-scale / 2, edges, scale / 2]
    middles = (bounds[1:] + bounds[:-1]) / 2
    levels = fall * middles + random.normal(0, 0.25, count)
    batter = np.where(random.random(count - 1) < 0.4, 0.06, random.uniform(1.0, 1.8, count - 1))
    terraces = np.full(lie.v.shape, levels[0])
    for edge, rise, run in zip(edges, np.diff(levels), batter, strict=True):
        terraces += rise * np.clip((lie.v - edge) / max(run * abs(rise), 0.1) + 0.5, 0, 1)
    lots = np.floor((lie.u + 500.0) / random.uniform(8, 18)).astype(np.int64) % 16
    terraces += random.normal(0, 0.12, 16)[lots] + random.uniform(-0.02, 0.02) * lie.u
    inside = np.minimum(0.42 * np.ptp(lie.u) - np.abs(lie.u), 0.4 * scale - np.abs(lie.v))
    reach = np.maximum(inside, 0.0) / random.uniform(1.0, 1.8)
    return Plan(natural, np.clip(terraces, natural - reach, natural + reach))


def hillside(random: Generator, lie: WorkPlacement) -> Plan:
    """A road through hills of which little is moved; beyond the strip ground falls out of sight."""
    scale = lie.wide_m
    fall = random.uniform(0.04, 0.18)
    hills = random.uniform(0.012, 0.03) * scale * undulation(random, lie.x, lie.y, 0.3 * scale)
    natural = fall * lie.v + hills + _uneven(random, lie, 0.2)
    half = float(np.clip(random.uniform(0.05, 0.08) * scale, 1.2, 7.0))
    road = random.uniform(-0.04, 0.04) * lie.u + random.uniform(-0.02, 0.02) * scale
    beside = np.maximum(np.abs(lie.v) - half, 0.0)
    bench, every = random.uniform(*_BENCH_M), random.uniform(*_BENCH_EVERY_M)
    upper = _benched(beside, 1.0 / random.uniform(*_CUT_SLOPE), bench, every)
    lower = _benched(beside, 1.0 / random.uniform(*_FILL_SLOPE), bench, every)
    reach = half + random.uniform(0.12, 0.2) * scale
    return Plan(natural, np.clip(natural, road - lower, road + upper), reach, (0.05, 0.4))


PLANS: dict[str, Callable[[Generator, WorkPlacement], Plan]] = {
    "levee": levee,
    "cutting": cutting,
    "pad": pad,
    "hillside": hillside,
}


@dataclass(frozen=True)
class Progress:
    """Levels of one date: cut down to, and filled up to: (rows, columns) float64, m."""

    down_to: Floats
    up_to: Floats


def progress_of(random: Generator, lie: WorkPlacement, plan: Plan) -> tuple[Progress, Progress]:
    """How far the work has come on both dates, stretch by stretch; never back."""
    length = float(np.ptp(lie.u))
    count = max(2, int(length / random.uniform(7, 22)))
    edges = np.sort(random.uniform(lie.u.min(), lie.u.max(), count - 1))
    ramps = random.uniform(0.15, 5.0, count - 1)
    first = np.clip(random.normal(0.3, 0.3, count), 0, 1)
    gain = random.uniform(*plan.gain, count)
    second = np.clip(first + gain, 0, 1)
    worked = np.abs(plan.design - plan.natural) > 0.05
    if not worked.any():
        worked = np.ones(worked.shape, np.bool_)
    low = float(min(plan.natural[worked].min(), plan.design[worked].min()))
    high = float(max(plan.natural[worked].max(), plan.design[worked].max()))
    ragged = random.uniform(0.0, 0.9) * undulation(random, lie.x, lie.y, 4.0)
    u = lie.u + ragged  # fronts of work are no straight lines
    dates = []
    for shares in (first, second):
        down = _stepped(u, high - shares * (high - low), edges, ramps)
        up = _stepped(u, low + shares * (high - low), edges, ramps)
        dates.append(Progress(down, up))
    return dates[0], dates[1]


def _stepped(u: Floats, levels: Floats, edges: Floats, ramps: Floats) -> Floats:
    """Levels by stretch, in whole layers, with a ramp from one to the next."""
    layered = np.round(levels / _LIFT_M) * _LIFT_M
    heights = np.full(u.shape, layered[0])
    for edge, rise, ramp in zip(edges, np.diff(layered), ramps, strict=True):
        heights += rise * np.clip((u - edge) / ramp + 0.5, 0, 1)
    return heights


def _uneven(random: Generator, lie: WorkPlacement, most_m: float) -> Floats:
    """Natural ground: bumps of several sizes."""
    heights = np.zeros(lie.x.shape)
    for wave, share in ((23.0, 1.0), (8.0, 0.35), (2.7, 0.1), (0.9, 0.025)):
        heights += (
            most_m * share * random.uniform(0.4, 1.2) * undulation(random, lie.x, lie.y, wave)
        )
    return heights


def _bank(v: Floats, high: float, crest: float, sides: tuple[float, float, float]) -> Floats:
    """Heights of a bank: slopes 1:n on both sides, a berm half way up the left one."""
    river, land, berm = sides
    half = crest / 2
    knots = [half, half + land * high / 2, half + land * high / 2 + berm, half + land * high + berm]
    left = np.interp(v, knots, [high, high / 2 + 0.05 * berm, high / 2, 0.0])
    out = knots[-1]
    left = np.where(v > out, -(v - out) / land, left)
    right = high - np.maximum(-v - half, 0.0) / river
    crowned = 0.02 * np.clip(half - np.abs(v), 0, half)
    return np.where(v >= 0, left, right) + crowned


def _benched(beside: Floats, rise: float, bench: float, every: float) -> Floats:
    """Heights of a slope with a flat bench after every few metres of height."""
    period = every / rise + bench
    whole = np.floor(beside / period)
    rest = beside - whole * period
    heights: Floats = whole * every + np.minimum(rest * rise, every)
    return heights

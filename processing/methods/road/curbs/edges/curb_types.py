"""Where a curb is dropped: its runs cut in the middles of ramps, each with a height of its own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import percentile_filter

from processing.methods.road.curbs.edges.edge_measures import STEP_M

_Floats = NDArray[np.float64]

CurbType = Literal["curb", "dropped"]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_LOW_M, _LOW_QUANTILE = 0.065, 0.8
"""A curb whose steps hardly anywhere (but for a fifth of it) are higher is dropped as a whole:
entrances are lowered to 5 cm, crossings to 2 cm, and steps are known within some millimetres."""

_LOWERED_M, _LOWERED = 0.03, 0.65
"""A curb is lowered where its step is lower than usual by so much and less than this share of it:
10 cm to 5 cm are told apart, 15 cm and 12 cm of two kinds of stone are not. By trial."""

_AROUND_M, _USUAL_PERCENT = 12.0, 75.0
"""To either side of a station, m, steps are asked for their usual height, more than a lowered part
takes; the percentile lies above the median, since half of it may be lowered. By trial."""

_LOWEST_QUANTILE = 0.2
"""Height of a lowered part, of its steps: ramps are higher."""

_LONGEST_M, _SHORTEST_M = 15.0, 0.75
"""What is lowered for longer is a lower curb; for shorter, an outlier of three stations. By
trial."""

_LONE_M = 2.0
"""What is shorter and lies alone edges a tree pit."""

_LEAST_RISE_M = 1e-9
"""Guard of a division between two equal steps."""


@dataclass(frozen=True)
class TypedPart:
    """A stretch of a curb of one type.

    Attributes
    ----------
    type : {"curb", "dropped"}
    first, last : float
        Where it begins and ends, in stations from the line's first.
    """

    type: CurbType
    first: float
    last: float


def typed_parts(steps_m: _Floats) -> list[TypedPart]:
    """The stretches of a curb, in order; each begins where the one before ends.

    Parameters
    ----------
    steps_m : (k,) float64
        Height of the step at each station.
    """
    end = float(steps_m.size - 1)
    long_m = steps_m.size * STEP_M
    if _LONE_M <= long_m <= _LONGEST_M and np.quantile(steps_m, _LOW_QUANTILE) < _LOW_M:
        return [TypedPart("dropped", 0.0, end)]
    parts: list[TypedPart] = []
    at = 0.0
    for first, last in _drops(steps_m):
        if first > at:
            parts.append(TypedPart("curb", at, first))
        parts.append(TypedPart("dropped", max(first, at), last))
        at = last
    if at < end:
        parts.append(TypedPart("curb", at, end))
    return parts


def _drops(steps: _Floats) -> Iterator[tuple[float, float]]:
    """Where the step is lowered: from ramp's middle to ramp's middle."""
    usual = _usual(steps)
    is_low = (steps < _LOWERED * usual) & (usual - steps >= _LOWERED_M)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], is_low, [False]]).astype(np.int8)))
    end = 0.0
    for first, stop in edges.reshape(-1, 2):
        low = float(np.quantile(steps[first:stop], _LOWEST_QUANTILE))
        sides = (usual[max(first - 1, 0)], usual[min(stop, steps.size - 1)])
        begin = _crossing(steps, int(first), -1, 0.5 * (float(sides[0]) + low))
        finish = _crossing(steps, int(stop) - 1, 1, 0.5 * (float(sides[1]) + low))
        begin = max(begin, end)
        if _SHORTEST_M <= (finish - begin) * STEP_M <= _LONGEST_M:
            yield begin, finish
            end = finish


def _usual(steps: _Floats) -> _Floats:
    """The step of the curb where it isn't lowered, about each station."""
    around = 2 * int(_AROUND_M / STEP_M) + 1
    return np.asarray(percentile_filter(steps, _USUAL_PERCENT, size=around, mode="nearest"))


def _crossing(steps: _Floats, start: int, sign: int, level: float) -> float:
    """Where the step comes up to a level, from a station on; the line's end where it doesn't."""
    at = start
    while 0 <= at < steps.size and steps[at] >= level:
        at -= sign  # noise: begin inside
    at = min(max(at, 0), steps.size - 1)
    while 0 <= at + sign < steps.size and steps[at + sign] < level:
        at += sign
    if not 0 <= at + sign < steps.size:
        return float(at)
    rise = steps[at + sign] - steps[at]
    return float(at + sign * np.clip((level - steps[at]) / max(rise, _LEAST_RISE_M), 0.0, 1.0))

"""Where a curb is dropped: its runs cut in the middles of ramps, each with a height of its own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import percentile_filter

from processing.methods.road.curbs.edges.curb_edge_kernels import STEP_M

_Floats = NDArray[np.float64]

CurbType = Literal["curb", "dropped"]

_LOW_M = 0.065  # entrances are lowered to 5 cm, crossings to 2 cm
_LOWERED_M = 0.03
_LOWERED = 0.65
_AROUND_M = 12.0
_USUAL_PERCENT = 75.0
_LONGEST_M = 15.0
_SHORTEST_M = 0.75
_LONE_M = 2.0  # what is shorter and lies alone edges a tree pit


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
    if _LONE_M <= long_m <= _LONGEST_M and np.quantile(steps_m, 0.8) < _LOW_M:
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
        low = float(np.quantile(steps[first:stop], 0.2))
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


def _crossing(steps: _Floats, start: int, vehicle_path: int, level: float) -> float:
    """Where the step comes up to a level, from a station on; the line's end where it doesn't."""
    at = start
    while 0 <= at < steps.size and steps[at] >= level:
        at -= vehicle_path  # noise: begin inside
    at = min(max(at, 0), steps.size - 1)
    while 0 <= at + vehicle_path < steps.size and steps[at + vehicle_path] < level:
        at += vehicle_path
    if not 0 <= at + vehicle_path < steps.size:
        return float(at)
    rise = steps[at + vehicle_path] - steps[at]
    return float(at + vehicle_path * np.clip((level - steps[at]) / max(rise, 1e-9), 0.0, 1.0))

"""What a printed drawing is laid out by: its scale, steps of its grid, digits of its numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence

_STEPS = tuple(step * 10.0**power for power in range(-2, 4) for step in (1.0, 2.0, 5.0))
_SCALES = (50, 100, 200, 250, 500, 1000, 2500, 5000, 10_000)


def grid_step(least: float) -> float:
    """The smallest of 1, 2, 5 × 10^k metres that is not less."""
    return next((step for step in _STEPS if step >= least * 0.999), _STEPS[-1])


def round_down_to(value: float, step: float) -> float:
    """The multiple of a step that is not above a value."""
    return math.floor(value / step) * step


def decimals_of(step: float) -> int:
    """Digits behind the point that multiples of a step need."""
    return max(0, -math.floor(math.log10(step) + 1e-9))


def fitting_scale(size_m: Sequence[float], room_m: tuple[float, float]) -> int:
    """The largest usual scale, as its denominator, at which an extent has room on paper.

    Parameters
    ----------
    size_m : sequence of float
        Width and height of the extent, m.
    room_m : (float, float)
        Those of the paper, m.
    """
    least = max(one / room for one, room in zip(size_m, room_m, strict=True))
    return next((scale for scale in _SCALES if scale >= least), _SCALES[-1])

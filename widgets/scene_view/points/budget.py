"""FrameBudget: how many points a frame may have, learnt from how long frames take."""

from __future__ import annotations

FIRST_POINTS = 150_000
_MOVING_S = 0.075
_STILL_S = 0.18
_LEAST, _MOST_MOVING, _MOST_STILL = 30_000, 3_000_000, 6_000_000
_FAST_ENOUGH = 600_000


class FrameBudget:
    """Points per frame while the camera moves, and more once it rests.

    A moving frame is to take 75 ms, so that ten a second remain with all else that a window does;
    a frame at rest may take 180 ms, as nothing waits for it.
    """

    def __init__(self) -> None:
        self._moving = float(FIRST_POINTS)
        self._still = 3.0 * FIRST_POINTS

    @property
    def moving_points(self) -> int:
        """Points of a frame while the camera moves."""
        return int(self._moving)

    @property
    def still_points(self) -> int:
        """Points of a frame at rest; never fewer than while moving."""
        return int(max(self._still, self._moving))

    @property
    def is_fast(self) -> bool:
        """Whether there is time for shading while the camera moves."""
        return self._moving >= _FAST_ENOUGH

    def record_moving(self, points: int, seconds: float) -> None:
        """Learn from a frame that was drawn while the camera moved."""
        self._moving = _adapt_budget(self._moving, points, seconds, _MOVING_S)
        self._moving = min(max(self._moving, _LEAST), _MOST_MOVING)

    def record_still(self, points: int, seconds: float) -> None:
        """Learn from a frame that was drawn at rest."""
        self._still = _adapt_budget(self._still, points, seconds, _STILL_S)
        self._still = min(max(self._still, _LEAST), _MOST_STILL)


def _adapt_budget(budget: float, points: int, seconds: float, wanted_s: float) -> float:
    step = min(max(wanted_s / max(seconds, 1e-3), 0.7), 1.25)
    # A frame far below the budget says nothing about what the budget would take.
    if step > 1.0 and points < 0.5 * budget:
        return budget
    # Close enough: a budget that never settles would change the picture at every frame.
    return budget if 0.85 <= step <= 1.1 else budget * step

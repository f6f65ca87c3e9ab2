"""Where curbs are cut into stretches of one type."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.road.curbs.edges.curb_types import typed_parts
from processing.methods.road.curbs.edges.edge_measures import STEP_M


def _steps(ramp_m: float = 1.0, low_m: float = 0.05) -> NDArray[np.float64]:
    """20 m of curb of 15 cm, lowered between 8 and 14 m, ramps included."""
    at = np.arange(0, 20.0 + 1e-9, STEP_M)
    return np.asarray(
        np.interp(at, [8.0, 8.0 + ramp_m, 14.0 - ramp_m, 14.0], [0.15, low_m, low_m, 0.15])
    )


@pytest.mark.parametrize("low_m", [0.0, 0.02, 0.05])
def test_a_dropped_curb_reaches_from_ramps_middle_to_ramps_middle(low_m: float) -> None:
    parts = typed_parts(_steps(low_m=low_m))
    assert [part.type for part in parts] == ["curb", "dropped", "curb"]
    assert parts[1].first * STEP_M == pytest.approx(8.5, abs=0.1)
    assert parts[1].last * STEP_M == pytest.approx(13.5, abs=0.1)


def test_parts_follow_each_other_without_a_gap() -> None:
    parts = typed_parts(_steps())
    assert parts[0].first == 0.0
    assert [part.last for part in parts[:-1]] == [part.first for part in parts[1:]]
    assert parts[-1].last == _steps().size - 1


def test_a_curb_as_high_all_along_is_one_part() -> None:
    steps = 0.15 + np.random.default_rng(1).normal(0, 0.004, 200)
    assert [part.type for part in typed_parts(steps)] == ["curb"]


def test_a_lone_low_curb_is_dropped() -> None:
    assert [part.type for part in typed_parts(np.full(20, 0.02))] == ["dropped"]

"""Other ways to measure a trunk, on one whose diameter is known."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.accuracy.road.baselines.tree_baselines import (
    WAYS,
    TrunkPoints,
    image_wires,
    own_diameter,
    projected_diameter,
)

DIAMETER_M = 0.24
PER_TURN = 400
ROWS, COLUMNS = 50, 24


def trunk() -> TrunkPoints:
    """Rows of pixels over half a trunk, 5 cm apart, with 2 mm of noise."""
    random = np.random.default_rng(1)
    row, column = np.divmod(np.arange(ROWS * COLUMNS), COLUMNS)
    turn = np.linspace(-1.4, 1.4, COLUMNS)[column]
    radius = DIAMETER_M / 2 + random.normal(0.0, 0.002, turn.size)
    up = 0.2 + 0.05 * row + 0.001 * column
    local = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), up])
    pulses = row * PER_TURN + column
    return TrunkPoints(local, np.zeros(turn.size, np.int64), pulses, (PER_TURN,))


@pytest.mark.parametrize("way", WAYS)
def test_every_way_measures_a_clean_trunk(way: str) -> None:
    assert WAYS[way](trunk()) == pytest.approx(DIAMETER_M, abs=0.012)


def test_wires_of_the_image_join_neighbours_in_the_row_and_in_the_next_rows() -> None:
    points = trunk()
    apart = np.abs(np.diff(points.pulses[image_wires(points)], axis=1)[:, 0])
    assert set(apart[apart <= 2].tolist()) == {1}
    assert np.count_nonzero(apart == 1) == ROWS * (COLUMNS - 1)
    assert np.abs(apart[apart > 2] - PER_TURN).max() <= 1


def test_a_projection_is_misled_by_what_stands_beside_and_the_tool_is_not() -> None:
    points = trunk()
    random = np.random.default_rng(2)
    turn = random.uniform(0, 2 * np.pi, 4_000)
    hedge = np.column_stack(
        [0.6 * np.cos(turn), 0.6 * np.sin(turn), random.uniform(1.0, 1.25, turn.size)]
    )
    both = TrunkPoints(
        np.vstack([points.local, hedge]),
        np.zeros(len(points.local) + len(hedge), np.int64),
        np.concatenate([points.pulses, np.full(len(hedge), -1)]),
        (PER_TURN,),
    )
    assert abs(projected_diameter(both) - DIAMETER_M) > 0.5
    assert own_diameter(both) == pytest.approx(DIAMETER_M, abs=0.012)

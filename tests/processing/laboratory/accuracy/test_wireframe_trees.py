"""The thesis' way of finding trees, on a tree and a post whose pixels are known."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.arrays import Floats, Integers
from processing.laboratory.accuracy.road.baselines.wireframe_trees import (
    WireframeTree,
    edge_bias,
    image_wires_of,
    wireframe_trees,
)

DIAMETER_M = 0.2
PER_TURN = 400
ROWS, COLUMNS = 60, 24
STEP_M = 0.05


def shaft(rows: int = ROWS) -> tuple[Floats, Integers]:
    """Half a trunk, a row each 5 cm, from the ground upwards."""
    row, column = np.divmod(np.arange(rows * COLUMNS), COLUMNS)
    turn = np.linspace(-1.4, 1.4, COLUMNS)[column]
    up = STEP_M * row + 0.001 * column
    radius = DIAMETER_M / 2
    places = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), up])
    return places, row * PER_TURN + column


def crown() -> tuple[Floats, Integers]:
    """Twigs in the rows above the trunk, each pixel near the last one."""
    random = np.random.default_rng(3)
    row, column = np.divmod(np.arange(30 * COLUMNS), COLUMNS)
    places = np.column_stack(
        [
            0.1 + random.uniform(-0.06, 0.06, row.size),
            np.linspace(-0.1, 0.1, COLUMNS)[column] + random.uniform(-0.06, 0.06, row.size),
            STEP_M * (ROWS + row) + random.uniform(-0.06, 0.06, row.size),
        ]
    )
    return places, (ROWS + row) * PER_TURN + column


def found_in(*parts: tuple[Floats, Integers]) -> list[WireframeTree]:
    places = np.vstack([one for one, _ in parts])
    pulses = np.concatenate([one for _, one in parts])
    return wireframe_trees(places, pulses, PER_TURN, lambda east, north: 0.0)


def test_a_trunk_with_twigs_is_a_tree_where_it_stands_and_as_thick_as_it_is() -> None:
    (tree,) = found_in(shaft(), crown())
    assert np.hypot(*tree.place) < 0.02
    assert tree.diameter_m == pytest.approx(DIAMETER_M, abs=0.01)


def test_a_post_is_none() -> None:
    assert found_in(shaft(90)) == []


def test_two_rows_apart_there_is_no_wire() -> None:
    places, pulses = shaft()
    wires = image_wires_of(places, pulses, PER_TURN)
    apart = np.abs(np.diff(pulses[wires], axis=1)[:, 0])
    assert set(apart[apart < COLUMNS].tolist()) == {1}
    assert np.abs(apart[apart > COLUMNS] - PER_TURN).max() <= 1


def test_edges_that_point_anywhere_have_little_bias_and_level_ones_all_of_it() -> None:
    random = np.random.default_rng(4)
    places = random.normal(size=(40_000, 3))
    wires = np.arange(40_000).reshape(-1, 2)
    # Solid angle grows with the angle from the vertical.
    assert edge_bias(places, wires) == pytest.approx(0.421, abs=0.02)
    level = places * (1.0, 1.0, 0.0)
    assert edge_bias(level, wires) == pytest.approx(2 * 17 / 18, abs=1e-6)

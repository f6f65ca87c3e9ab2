"""What speaks for a tree does so everywhere, and what speaks against one too."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from processing.core.monitor import SilentMonitor
from processing.methods.road.trees.tree_confidence import SIGNS, TreeFacts, chances_of

TREE = TreeFacts(
    *(2.8, 0.05, 0.15, 0.0, 0.0, 0.5, 2.0, 0.05, 1.0, 0.0, 0.0, 2.0, 3.0),
    *(0.012, 10.0, 1.0, 0.3, 1.0),
)
LAMP = TreeFacts(
    *(0.3, 0.8, 1.0, 1.5, 0.0, 0.5, 2.0, 0.05, 1.0, 4.0, 0.0, -1.0, 0.2),
    *(0.0, 12.0, 0.1, 1.5, 0.3),
)


def test_a_tree_is_one_and_a_lamp_is_none() -> None:
    tree, lamp = chances_of([TREE, LAMP], SilentMonitor())
    assert tree > 0.9
    assert lamp < 0.05
    assert chances_of([], SilentMonitor()).size == 0


def test_what_nothing_stands_on_but_noise_is_less_of_a_tree() -> None:
    tree, person = chances_of([TREE, TREE._replace(goes_on=0.0)], SilentMonitor())
    assert person < tree


@given(st.integers(0, len(SIGNS) - 1), st.floats(0, 1), st.floats(0, 1))
def test_more_of_what_speaks_for_a_tree_never_lowers_its_chance(
    number: int, one: float, other: float
) -> None:
    between = np.array(LAMP) + np.array([[one], [other]]) * (np.array(TREE) - np.array(LAMP))
    rows = np.tile((np.array(TREE) + np.array(LAMP)) / 2, (2, 1))
    rows[:, number] = between[:, number]
    first, second = chances_of([TreeFacts(*row) for row in rows.tolist()], SilentMonitor())
    grows = (rows[1, number] - rows[0, number]) * SIGNS[number]
    if grows:  # below 2 % the last trees of decisions aren't asked
        assert (second - first) * np.sign(grows) > -0.02

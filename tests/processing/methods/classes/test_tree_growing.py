"""A tree grows where the loss bends, and the compiled kernels do what the readable code says."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.classes import tree_growing
from processing.methods.classes.tree_growing import CUT, FEATURE, GrowthLimits, grow_tree

LIMITS = GrowthLimits(leaves=4, ridge=0.0, least=1, rate=1.0)


def test_a_step_is_found_with_its_feature_its_place_and_both_heights() -> None:
    bins = np.array([[0, 1, 2, 3, 4, 5], [5, 0, 3, 1, 4, 2]], np.uint8)
    wanted = np.where(bins[0] <= 2, -1.0, 3.0)
    tree, said = grow_tree(bins, -wanted, np.ones(6), LIMITS)
    assert (tree.nodes[0, FEATURE], tree.nodes[0, CUT]) == (0, 2)
    np.testing.assert_allclose(said, wanted)
    assert len(tree.values) == 3


def test_few_rows_say_little_and_too_few_make_no_leaf() -> None:
    bins = np.array([[0, 1, 1, 1]], np.uint8)
    gradients = np.array([-8.0, 0.0, 0.0, 0.0])
    _, said = grow_tree(bins, gradients, np.ones(4), LIMITS._replace(ridge=3.0))
    np.testing.assert_allclose(said, [2.0, 0.0, 0.0, 0.0])
    tree, said = grow_tree(bins, gradients, np.ones(4), LIMITS._replace(least=2))
    assert len(tree.values) == 1
    np.testing.assert_allclose(said, 2.0)


def test_the_compiled_kernels_do_what_their_python_does(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(4)
    bins = rng.integers(0, 12, (3, 60)).astype(np.uint8)
    gradients, curvatures = rng.normal(size=60), rng.random(60)
    limits = GrowthLimits(leaves=6, ridge=0.5, least=3, rate=0.4)
    compiled, said = grow_tree(bins, gradients, curvatures, limits)
    for name in ("best_split_kernel", "divide_kernel", "grow_kernel"):
        monkeypatch.setattr(tree_growing, name, getattr(tree_growing, name).py_func)
    plain, said_plainly = grow_tree(bins, gradients, curvatures, limits)
    np.testing.assert_array_equal(compiled.nodes, plain.nodes)
    np.testing.assert_allclose(said, said_plainly)

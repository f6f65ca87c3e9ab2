"""The rules by which two blocks become one answer."""

from __future__ import annotations

import numpy as np

from processing.laboratory.waveform_networks.merging import (
    LearnedMerge,
    merged_any_class,
    merged_published,
)

WORKED_LOCAL = np.array(
    [
        [0.01, 0.80, 0.01, 0.02, 0.10, 0.06],
        [0.00, 0.33, 0.00, 0.33, 0.33, 0.01],
        [0.00, 0.00, 0.00, 0.01, 0.99, 0.00],
    ],
    np.float32,
)
WORKED_GLOBAL = np.array(
    [
        [0.02, 0.39, 0.02, 0.30, 0.30, 0.06],
        [0.01, 0.20, 0.02, 0.59, 0.00, 0.07],
        [0.03, 0.24, 0.02, 0.33, 0.33, 0.05],
    ],
    np.float32,
)
"""Rows 1, 2 and N of figure 3.11; B, D and E are its local classes."""


def test_the_worked_rows_of_the_thesis_come_out() -> None:
    found, is_local = merged_published(WORKED_LOCAL, WORKED_GLOBAL, (1, 3, 4))
    assert found.tolist() == [1, 3, 4]
    assert is_local.tolist() == [True, False, True]


def test_a_surer_global_class_wins_and_no_point_becomes_one() -> None:
    local = np.array([[0.0, 0.6, 0.4, 0.0, 0.0, 0.0], [0.9, 0.1, 0.0, 0.0, 0.0, 0.0]], np.float32)
    of_all = np.array([[0.8, 0.1, 0.1, 0, 0, 0], [0.1, 0.7, 0.2, 0, 0, 0]], np.float32)
    found, is_local = merged_published(local, of_all)
    assert found.tolist() == [0, 1]
    assert not is_local.any()
    anyhow, is_local = merged_any_class(local, of_all)
    assert anyhow.tolist() == [1, 0]
    assert is_local.all()


def test_the_learned_merge_finds_whom_to_believe() -> None:
    rng = np.random.default_rng(0)
    classes = rng.integers(0, 6, 600)
    right = np.full((600, 6), 0.02, np.float32)
    right[np.arange(600), classes] = 0.9
    wrong = rng.dirichlet(np.ones(6), 600).astype(np.float32)
    # The local block knows classes 0 to 2, the global one the others.
    knows = classes < 3
    local = np.where(knows[:, None], right, wrong)
    of_all = np.where(knows[:, None], wrong, right)
    learned = LearnedMerge.of(local[:400], of_all[:400], classes[:400])
    found = learned.merged(local[400:], of_all[400:])
    share = float((found == classes[400:]).mean())
    plain = float((of_all[400:].argmax(axis=1) == classes[400:]).mean())
    assert share > plain + 0.2

"""Echoes held against the true ones, by how near the next is."""

from __future__ import annotations

import numpy as np
import pytest

from processing.scoring.waveforms.echo_scores import TrueEchoes, echo_score


def test_echoes_are_scored_by_how_near_the_next_is() -> None:
    truth = TrueEchoes(
        np.array([0, 1, 1, 2, 2, 3]),
        np.array([50.0, 50.0, 50.9, 50.0, 50.4, 60.0]),
        np.zeros(6),
        np.array([90.0, 90.0, 90.0, 90.0, 90.0, 5.0]),
        np.ones(6, np.bool_),
    )
    score = echo_score(
        truth, np.array([0, 1, 1, 2, 3, 3]), np.array([50.01, 50.0, 50.9, 50.2, 60.0, 70.0])
    )
    assert score.wanted == {"alone": 1, "apart": 2, "near": 2, "weak": 1}
    assert score.found == {"alone": 1, "apart": 2, "near": 1, "weak": 1}
    assert score.false == 1
    assert score.measures["range_cm"] == pytest.approx(1.0)

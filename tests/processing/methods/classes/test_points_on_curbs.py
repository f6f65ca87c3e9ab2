"""Points on curbs that were measured in another pass, which lies centimetres away."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.methods.classes.points_on_curbs import (
    CurbEdges,
    NearCurbs,
    curb_samples,
    moved_to,
)

ORIGIN = np.array([-8_000.0, -33_000.0, 20.0])
HIGH_M, WIDE_M = 0.15, 0.12


def edge(y: float, z: float) -> NDArray[np.float64]:
    return np.array([[0.0, y, z], [20.0, y, z]]) + ORIGIN


def stone(count: int) -> NDArray[np.float64]:
    """Points on the face and the top of a curb along y = 3 with 3 mm of noise."""
    rng = np.random.default_rng(0)
    face = np.column_stack([np.full(count, 3.0), rng.uniform(0.01, HIGH_M, count)])
    top = np.column_stack([rng.uniform(3.0, 3.0 + WIDE_M - 0.02, count), np.full(count, HIGH_M)])
    across = np.vstack([face, top]) + rng.normal(0, 0.003, (2 * count, 2))
    return np.column_stack([rng.uniform(0.5, 19.5, 2 * count), across])


CURB = CurbEdges(edge(3.0, HIGH_M), edge(3.0, 0.0), 0.9)


@pytest.mark.parametrize("apart", [(0.0, 0.0, 0.0), (0.0, 0.03, -0.05), (0.0, -0.04, 0.04)])
def test_a_pass_that_lies_centimetres_away_has_its_points_on_the_curb_all_the_same(
    apart: tuple[float, float, float],
) -> None:
    places = stone(2_000) + apart
    samples = curb_samples([CURB], ORIGIN)
    assert samples is not None
    assert (NearCurbs(moved_to(samples, places), places).chances_on_curbs() > 0).mean() > 0.95


def test_the_road_before_a_curb_moves_with_it() -> None:
    apart = np.array([0.0, 0.03, -0.06])
    samples = curb_samples([CURB], ORIGIN)
    assert samples is not None
    road = np.array([[5.0, 2.9, -0.06], [6.0, 2.5, -0.05]])
    places = np.vstack([stone(2_000) + apart, road])
    assert (NearCurbs(samples, road).chances_on_road() > 0).tolist() == [False, True]
    assert (NearCurbs(moved_to(samples, places), road).chances_on_road() > 0).all()


def test_a_curb_stays_where_too_little_is_seen_or_leaves_lie_over_it() -> None:
    samples = curb_samples([CURB], ORIGIN)
    assert samples is not None
    few = stone(5) + np.array([0.0, 0.03, -0.05])
    rng = np.random.default_rng(1)
    leaves = np.column_stack(
        [rng.uniform(0, 20, 400), rng.uniform(3.0, 3.1, 400), rng.uniform(0.08, 0.22, 400)]
    )
    for places in (few, leaves, np.empty((0, 3))):
        np.testing.assert_allclose(moved_to(samples, places).uppers, samples.uppers)

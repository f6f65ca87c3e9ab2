"""The likeliest course against all courses, and brightness of a road that falls with the range."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.methods.road.edges.cross_cells import CELLS, REACH_M, lane_tones
from processing.methods.road.edges.edge_facts import outward_logits
from processing.methods.road.edges.fact_kernels import CELL_M
from processing.methods.road.edges.path_kernels import likeliest_kernel

TURN, JUMP = 0.5, 1.8


def worth_of(gains: Floats, course: tuple[int, ...]) -> float:
    steps = np.abs(np.diff(course))
    costs = np.where(steps <= 3, np.minimum(TURN * steps, JUMP), JUMP)
    return float(sum(gains[k, place] for k, place in enumerate(course)) - costs.sum())


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kernel", [likeliest_kernel, likeliest_kernel.py_func])
def test_no_other_course_is_likelier(seed: int, kernel: object) -> None:
    gains = np.random.default_rng(seed).normal(0.0, 1.5, (5, 6))
    course = np.zeros(5, np.int64)
    assert callable(kernel)
    kernel(gains, TURN, JUMP, course)
    best = max(worth_of(gains, one) for one in itertools.product(range(6), repeat=5))
    assert worth_of(gains, tuple(course.tolist())) == pytest.approx(best)


def test_brightness_that_falls_with_the_range_is_even_over_the_road() -> None:
    left = (np.arange(CELLS) + 0.5) * CELL_M - REACH_M
    fall = -1.2 * 0.5 * np.log1p((left / 2.0) ** 2)
    tone = np.tile(fall, (20, 1)) + np.linspace(0.0, 0.5, 20)[:, None]
    tone[:, left > 5.0] += 0.9  # a walk
    off = tone - lane_tones(tone, 2.0)
    road = np.abs(left) < 4.9
    assert np.abs(off[:, road]).max() < 0.1
    assert off[:, left > 5.0].min() > 0.5


def test_what_lies_behind_an_edge_is_less_likely_the_first() -> None:
    logits = np.full((1, 2, 60), -4.0)
    logits[0, 0, [20, 40]] = 3.0
    outward = outward_logits(logits)
    assert outward[0, 0, 20] > 2.0
    assert outward[0, 0, 40] < 1.0
    assert np.all(outward <= logits)

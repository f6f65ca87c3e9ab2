"""Posts that stand beside something deep: the ground about them counts."""

from __future__ import annotations

import numpy as np
import pytest

from processing.methods.road.objects.foot import ground_seen

DEEP_M = 0.48


def test_the_bottom_of_an_open_gutter_is_not_the_ground_of_a_post() -> None:
    random = np.random.default_rng(4)
    plan = random.uniform(-0.7, 0.7, (2_000, 2))
    is_gutter = plan[:, 1] < -0.62
    heights = np.where(is_gutter & (random.random(2_000) < 0.4), -DEEP_M, 0.0)
    street = np.column_stack([plan, heights + random.normal(0, 0.004, 2_000)])
    turn = random.uniform(0, np.pi, 90)
    post = np.column_stack([0.04 * np.cos(turn), 0.04 * np.sin(turn), random.uniform(0.0, 0.7, 90)])
    points = np.concatenate([street, post])
    assert ground_seen(points, -DEEP_M, 0.2) == pytest.approx(0.0, abs=0.06)
    assert ground_seen(points, 0.0, 0.2) == pytest.approx(0.0, abs=0.06)

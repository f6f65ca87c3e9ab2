"""What the first judgement says of the points around."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.methods.noise.features.second_pass import FirstEstimate
from processing.methods.noise.features.surroundings import SCALES, CloudNeighbourhood

_OWN, _CLOUD, _AROUND = 0, 1, slice(2, 2 + SCALES)
_IN_PARTS, _SUSPICIOUS_PART = 2 + SCALES, slice(3 + SCALES, 8 + SCALES)


@pytest.fixture(scope="module")
def cloud() -> tuple[np.ndarray, np.ndarray]:
    """A floor, and two small balls of points above it; which ball, 0 for the floor."""
    random = np.random.default_rng(3)
    floor = np.column_stack([random.uniform(0, 8, (6_000, 2)), random.normal(0, 0.005, 6_000)])
    balls = [
        random.normal(0, 0.05, (120, 3)) + middle for middle in ([2.0, 4.0, 3.0], [6.0, 4.0, 3.0])
    ]
    return np.vstack([floor, *balls]), np.repeat([0, 1, 2], [6_000, 120, 120])


def judged(cloud: tuple[np.ndarray, np.ndarray], odds: np.ndarray) -> np.ndarray:
    xyz, ball = cloud
    around = CloudNeighbourhood.of(xyz, np.full(len(xyz), 0.1), ball == 0)
    points = np.flatnonzero(ball > 0)
    judgement = FirstEstimate(around, points, odds[points])
    return judgement.features(np.arange(points.size), [around.link], SilentMonitor())


def test_a_point_is_told_what_was_said_of_its_neighbours_and_of_its_part(
    cloud: tuple[np.ndarray, np.ndarray],
) -> None:
    ball = cloud[1]
    odds = np.where(ball == 1, 5.0, -5.0)
    doubted = np.flatnonzero(ball == 1)[0]
    odds[doubted] = -3.0  # looks true by itself, in the middle of noise
    features = judged(cloud, odds)
    mine = features[0]
    assert mine[_OWN] == pytest.approx(-3.0)
    assert (mine[_AROUND][:3] > 0.9).all()
    assert mine[_IN_PARTS] > 0.9
    assert mine[_SUSPICIOUS_PART][0] == pytest.approx(np.log2(1 + 120), abs=0.2)
    other = features[ball[ball > 0] == 2]
    assert (other[:, _AROUND] < 0.05).all()
    assert (other[:, _IN_PARTS] < 0.05).all()
    assert not other[:, _SUSPICIOUS_PART].any()


def test_the_share_of_noise_in_the_cloud_is_the_same_for_all(
    cloud: tuple[np.ndarray, np.ndarray],
) -> None:
    ball = cloud[1]
    few = judged(cloud, np.where(ball == 1, 9.0, -9.0))[:, _CLOUD]
    none = judged(cloud, np.full(ball.size, -9.0))[:, _CLOUD]
    assert np.ptp(few) == 0
    assert few[0] == pytest.approx(np.log2(120 / ball.size + 1e-4), abs=0.02)
    assert none[0] < few[0]


def test_nobody_asked_gets_nothing(cloud: tuple[np.ndarray, np.ndarray]) -> None:
    xyz, ball = cloud
    around = CloudNeighbourhood.of(xyz, np.full(len(xyz), 0.1), ball == 0)
    nobody = np.zeros(0, np.int64)
    judgement = FirstEstimate(around, nobody, np.zeros(0))
    found = judgement.features(nobody, [around.link], SilentMonitor())
    assert found.shape == (0, 8 + SCALES)

"""Training scenes with grass and next to no noise: beams end at blades, and little else changes."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.noise_training.meadows import grow_grass, remove_most_noise
from processing.laboratory.noise_training.scanners import STANDING
from processing.laboratory.noise_training.scenes import TrainingScene, scene_of
from processing.laboratory.noise_training.streets import GRASS, ROAD


@pytest.fixture(scope="module")
def scene() -> TrainingScene:
    return scene_of(4, STANDING, 20_000)[0]


@pytest.mark.parametrize("seed", range(4))
def test_grass_grows_on_the_ground_along_the_beams(scene: TrainingScene, seed: int) -> None:
    meadow = grow_grass(scene, seed)
    grown = meadow.kinds != scene.kinds
    assert grown.sum() > 100
    assert (scene.kinds[grown] == ROAD).all()
    assert (meadow.kinds[grown] == GRASS).all()
    np.testing.assert_array_equal(meadow.xyz[~grown], scene.xyz[~grown])
    rise = np.abs(meadow.xyz[grown, 2] - scene.xyz[grown, 2])
    assert rise.max() < 0.36
    lengths = np.linalg.norm(meadow.xyz - meadow.origins, axis=1)
    np.testing.assert_allclose(lengths, meadow.ranges, atol=1e-6)
    along = np.cross(meadow.xyz - meadow.origins, scene.xyz - scene.origins)
    np.testing.assert_allclose(along / scene.ranges[:, None] ** 2, 0.0, atol=1e-9)


def test_where_no_ground_was_met_nothing_grows(scene: TrainingScene) -> None:
    bare = scene.chosen(scene.kinds != ROAD)
    assert grow_grass(bare, 1) is bare


def test_a_quiet_scene_keeps_what_is_true_and_loses_most_noise(scene: TrainingScene) -> None:
    for seed in range(4):
        quiet = remove_most_noise(scene, seed)
        assert (quiet.noise == 0).sum() == (scene.noise == 0).sum()
        assert (quiet.noise > 0).sum() < 0.55 * (scene.noise > 0).sum()

"""Grass that grows over the ground of a simulated scene, and scenes with next to no noise.

Most clouds hold far less noise than the scenes that teach what noise is: a tripod on a meadow sees
tens of thousands of blades for one false point.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from processing.laboratory.noise_training.scenes import TrainingScene
from processing.laboratory.noise_training.streets import GRASS, ROAD

_STREAM, _QUIET_STREAM = 8, 6
_MOST_PATCHES, _RADII_M = 4, (3.0, 20.0)
_HEIGHTS_M, _SHARES = (0.05, 0.35), (0.3, 0.8)
_LOWEST_BEAM, _MOST_NEARER_M = 0.08, 2.5
_KEPT_NOISE = (-7.0, -1.0)  # log2 of its share


def grow_grass(scene: TrainingScene, seed: int) -> TrainingScene:
    """The scene with grass in patches of its ground; beams end at the blades that they meet."""
    random = np.random.default_rng(seed * 7 + _STREAM)
    ground = np.flatnonzero(scene.kinds == ROAD)
    if not ground.size:
        return scene
    chances, is_grass = random.random((2, scene.ranges.size)), np.zeros(scene.ranges.size, np.bool_)
    for _ in range(int(random.integers(1, _MOST_PATCHES + 1))):
        middle = scene.xyz[random.choice(ground), :2]
        away = np.hypot(*(scene.xyz[:, :2] - middle).T)
        is_grass |= (away < random.uniform(*_RADII_M)) & (chances[0] < random.uniform(*_SHARES))
    is_grass &= scene.kinds == ROAD
    directions = (scene.xyz - scene.origins) / scene.ranges[:, None]
    high = random.uniform(*_HEIGHTS_M) * chances[1] ** 0.7
    nearer = np.minimum(high / np.maximum(np.abs(directions[:, 2]), _LOWEST_BEAM), _MOST_NEARER_M)
    nearer = np.where(is_grass, np.minimum(nearer, scene.ranges / 2), 0.0)
    return replace(
        scene,
        xyz=scene.xyz - nearer[:, None] * directions,
        ranges=scene.ranges - nearer,
        kinds=np.where(is_grass, GRASS, scene.kinds),
    )


def remove_most_noise(scene: TrainingScene, seed: int) -> TrainingScene:
    """The scene without most of its noise."""
    random = np.random.default_rng(seed * 7 + _QUIET_STREAM)
    share = 2 ** random.uniform(*_KEPT_NOISE)
    return scene.chosen((scene.noise == 0) | (random.random(scene.noise.size) < share))

"""Training scenes on hillsides: things stand on the relief, and what it hides is not measured."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.laboratory.noise_training.relief import Relief, on_relief, relief_of
from processing.laboratory.noise_training.scanners import STANDING
from processing.laboratory.noise_training.scenes import TrainingScene, scene_of


def test_a_bank_rises_over_its_width_and_stays() -> None:
    bank = Relief(np.array([[1.0, 0.0, 2.0, 4.0, 3.0]]), np.zeros((0, 4)))
    xy = np.array([[0.0, 5.0], [2.0, 0.0], [4.0, -7.0], [6.0, 0.0], [90.0, 0.0]])
    assert bank.heights(xy) == pytest.approx([0.0, 0.0, 1.5, 3.0, 3.0])


def _beams(scene: TrainingScene) -> NDArray[np.int64]:
    return (scene.scans * 10_000 + scene.rows) * 10_000 + scene.columns


def test_a_scene_is_lifted_by_its_relief_and_its_beams_reach_what_is_left() -> None:
    scene, _ = scene_of(4, STANDING, 20_000)
    for seed in range(4):
        lifted = on_relief(scene, seed)
        assert 100 < lifted.noise.size <= scene.noise.size
        is_left = np.isin(_beams(scene), _beams(lifted))
        by = lifted.xyz - scene.xyz[is_left]
        np.testing.assert_allclose(by[:, :2], 0.0)
        assert np.ptp(by[:, 2]) > 0.5
        lengths = np.linalg.norm(lifted.xyz - lifted.origins, axis=1)
        np.testing.assert_allclose(lengths, lifted.ranges, atol=1e-6)
        np.testing.assert_array_equal(on_relief(scene, seed).xyz, lifted.xyz)


def test_what_lies_behind_a_hill_is_not_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    hill = Relief(
        np.array([[1.0, 0.0, 4.0, 1.0, 5.0], [1.0, 0.0, 6.0, 1.0, -5.0]]), np.zeros((0, 4))
    )
    monkeypatch.setattr("processing.laboratory.noise_training.relief.relief_of", lambda *_: hill)
    scene, _ = scene_of(4, STANDING, 20_000)
    two = scene.chosen(np.array([0, 1]))
    two = replace(
        two,
        xyz=np.array([[3.0, 0.0, 0.0], [20.0, 0.0, 0.0]]),
        origins=np.array([[0.0, 0.0, 1.7], [0.0, 0.0, 1.7]]),
    )
    np.testing.assert_allclose(on_relief(two, 1).xyz, [[3.0, 0.0, 0.0]])


def test_banks_are_no_steeper_than_earth_stands() -> None:
    for seed in range(10):
        relief = relief_of(np.random.default_rng(seed), 60.0)
        assert (np.abs(relief.banks[:, 4]) <= 1.2 * relief.banks[:, 3] + 1e-9).all()

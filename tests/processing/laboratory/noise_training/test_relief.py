"""Recorded scenes on hillsides: things stand on the relief, and what it hides is not measured."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from processing.laboratory.noise_training.recordings import RecordedScene
from processing.laboratory.noise_training.relief import Relief, on_relief, relief_of
from processing.methods.noise.beams.beam_kernels import PointBeams


def _scene_of(xyz: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> RecordedScene:
    """A scan by one row of beams from 1.7 m above the origin."""
    count = xyz.shape[0]
    origins = np.tile([0.0, 0.0, 1.7], (count, 1))
    beams = PointBeams(
        xyz,
        origins,
        np.linalg.norm(xyz - origins, axis=1),
        np.arange(count, dtype=np.int32),
        np.array([0, count]),
        np.zeros(1, np.int32),
        0.001,
    )
    return RecordedScene(xyz, np.full(count, 2, np.uint8), np.ones(count, np.uint16), beams)


def test_a_bank_rises_over_its_width_and_stays() -> None:
    bank = Relief(np.array([[1.0, 0.0, 2.0, 4.0, 3.0]]), np.zeros((0, 4)))
    xy = np.array([[0.0, 5.0], [2.0, 0.0], [4.0, -7.0], [6.0, 0.0], [90.0, 0.0]])
    assert bank.heights(xy) == pytest.approx([0.0, 0.0, 1.5, 3.0, 3.0])


def test_a_scene_is_lifted_by_its_relief_and_some_of_it_is_hidden() -> None:
    raster = np.linspace(-20, 20, 41)
    x, y = (one.ravel() for one in np.meshgrid(raster, raster))
    level = _scene_of(np.column_stack([x, y, np.zeros(x.size)]))
    for seed in range(4):
        lifted = on_relief(level, seed)
        assert 100 < lifted.labels.size <= level.labels.size
        assert np.isin(lifted.xyz[:, 0] * 1000 + lifted.xyz[:, 1], x * 1000 + y).all()
        assert np.ptp(lifted.xyz[:, 2]) > 0.5
        assert lifted.beams is None
        np.testing.assert_array_equal(on_relief(level, seed).xyz, lifted.xyz)


def test_what_lies_behind_a_hill_is_not_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    hill = Relief(
        np.array([[1.0, 0.0, 4.0, 1.0, 5.0], [1.0, 0.0, 6.0, 1.0, -5.0]]), np.zeros((0, 4))
    )
    monkeypatch.setattr("processing.laboratory.noise_training.relief.relief_of", lambda *_: hill)
    two = _scene_of(np.array([[3.0, 0.0, 0.0], [20.0, 0.0, 0.0]]))
    np.testing.assert_allclose(on_relief(two, 1).xyz, [[3.0, 0.0, 0.0]])


def test_without_beams_nothing_is_lifted() -> None:
    scene = replace(_scene_of(np.ones((2, 3))), beams=None)
    with pytest.raises(ValueError, match="no beams"):
        on_relief(scene, 1)


def test_banks_are_no_steeper_than_earth_stands() -> None:
    for seed in range(10):
        relief = relief_of(np.random.default_rng(seed), 60.0)
        assert (np.abs(relief.banks[:, 4]) <= 1.2 * relief.banks[:, 3] + 1e-9).all()

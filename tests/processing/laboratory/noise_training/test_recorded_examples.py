"""Examples from recordings by the simulator: what may be one, how often, and how much it counts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.laboratory.noise_training import recordings
from processing.laboratory.noise_training.examples import recording_with_beams
from processing.laboratory.noise_training.recordings import (
    MEADOW,
    QUIET,
    STANDING,
    VARIED,
    RecordedScene,
    recorded_scene,
)

_SEED = 4  # measured by phase, with arcs, glass and streaks


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(recordings, "_PULSES", (90_000, 90_001))
        patch.setattr(recordings, "_MEADOW_STEPS_M", (0.08, 0.1))
        yield tmp_path_factory.mktemp("recordings")


@pytest.fixture(scope="module")
def scene(folder: Path) -> RecordedScene:
    return recorded_scene(STANDING, _SEED, folder, VARIED)


def test_a_quiet_recording_has_less_noise_than_a_varied_one(
    folder: Path, scene: RecordedScene
) -> None:
    quiet = recorded_scene(STANDING, _SEED, folder, QUIET)
    assert quiet.is_noise.mean() < 0.7 * scene.is_noise.mean()


def test_a_meadow_is_seen_by_sweeps_and_shows_its_grass(folder: Path) -> None:
    meadow = recorded_scene(MEADOW, 35, folder, VARIED)
    assert meadow.beams is not None
    assert (meadow.labels == 3).mean() > 0.05
    assert meadow.is_noise.mean() < 0.05


def test_a_recording_without_beams_is_no_example_with_beams(scene: RecordedScene) -> None:
    with pytest.raises(ValueError, match="no beams"):
        recording_with_beams(replace(scene, beams=None), 2)


def test_noise_on_a_true_surface_is_no_example(scene: RecordedScene) -> None:
    is_clear = recording_with_beams(scene, 2).is_clear
    assert is_clear is not None
    assert is_clear[~scene.is_noise].all()
    assert 0.0 < is_clear[scene.is_noise].mean() < 1.0
    for noise in scene.xyz[scene.is_noise & ~is_clear][:20]:
        assert np.linalg.norm(scene.xyz[~scene.is_noise] - noise, axis=1).min() <= 0.04


def test_noise_is_taken_more_often_and_counts_as_much_less(scene: RecordedScene) -> None:
    case = recording_with_beams(scene, 2)
    often, plain = (
        replace(case, points_wanted=1_500, noise_often=times).alone()[1] for times in (3.0, 1.0)
    )
    assert often.is_noise.sum() > 2 * plain.is_noise.sum()
    taken, usual = (one.weights[one.is_noise].sum() for one in (often, plain))
    assert taken == pytest.approx(usual, rel=0.3)

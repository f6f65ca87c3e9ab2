"""Examples from recordings by the simulator: what may be one, how often, and how much it counts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.laboratory.noise_training import recordings
from processing.laboratory.noise_training.examples import (
    LabelledCloud,
    recording_in_space,
    recording_with_beams,
)
from processing.laboratory.noise_training.fitting import TreesSize, fit_trees, shift_to_keep
from processing.laboratory.noise_training.recordings import (
    MEADOW,
    QUIET,
    STANDING,
    VARIED,
    RecordedScene,
    quietened,
    recorded_scene,
)
from processing.laboratory.noise_training.scores import f_measure, score_line
from processing.methods.noise.combined import FIRST_LOOK_IN_SPACE, IN_SPACE, MODELS
from processing.methods.noise.tree_files import read_trees
from processing.methods.noise.trees import Trees, log_odds
from resources import path_of

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


@pytest.fixture(scope="module")
def cloud(scene: RecordedScene) -> LabelledCloud:
    return recording_in_space(replace(scene, beams=None), 2)


def _tree_of_one_leaf(odds: float) -> Trees:
    none = np.zeros(1, np.int32)
    return Trees(none - 1, np.array([odds]), none, none, none, 0.0)


def test_examples_are_rows_that_say_what_they_are(
    scene: RecordedScene, cloud: LabelledCloud
) -> None:
    with_beams, first = recording_with_beams(scene, 2), _tree_of_one_leaf(1.0)
    for examples in (
        *with_beams.alone(),
        *cloud.alone(),
        with_beams.again(first, first),
        cloud.again(None, first),
    ):
        assert examples.is_noise.any()
        assert not examples.is_noise.all()
        assert np.isfinite(examples.rows).all()
        assert examples.rows.shape[0] == examples.is_noise.size == examples.weights.size
    assert with_beams.again(_tree_of_one_leaf(-1.0), first).is_noise.size == 0
    assert cloud.again(None, _tree_of_one_leaf(-9.0)).is_noise.size == 0


def test_every_pass_sees_the_same_examples(cloud: LabelledCloud) -> None:
    np.testing.assert_array_equal(cloud.alone()[1].rows, cloud.alone()[1].rows)


def test_the_first_look_in_space_keeps_what_is_called_noise_and_little_else(
    cloud: LabelledCloud,
) -> None:
    own, again, first = (
        read_trees(path_of(f"{MODELS}/{name}")) for name in (*IN_SPACE, FIRST_LOOK_IN_SPACE)
    )
    examples = cloud.said(own, again)
    is_left = log_odds(first, examples.rows, SilentMonitor()) > 0
    assert examples.is_noise.sum() > 100
    assert is_left[examples.is_noise].mean() >= 0.99
    assert is_left[~examples.is_noise].mean() < 0.9


def test_trees_are_fitted_to_examples_and_a_first_look_keeps_the_noise(
    scene: RecordedScene,
) -> None:
    looks = recording_with_beams(scene, 2).alone()[0]
    trees = fit_trees(looks, TreesSize(30, 12, 0.25))
    first = shift_to_keep(trees, looks.rows, looks.is_noise, 0.01)
    is_left = log_odds(first, looks.rows, SilentMonitor()) > 0
    assert is_left[looks.is_noise].mean() >= 0.985
    assert is_left.mean() < 1.0


def test_a_score_names_every_kind_that_is_there(scene: RecordedScene) -> None:
    line = score_line("scene", scene.is_noise, scene)
    assert "F 1.000" in line
    assert "road 1.000" in line
    assert f_measure(np.zeros(scene.labels.size, np.bool_), scene.is_noise) == 0.0


def test_a_quietened_scene_keeps_what_is_true_and_loses_most_noise(scene: RecordedScene) -> None:
    for seed in range(4):
        quiet = quietened(scene, seed)
        assert (~quiet.is_noise).sum() == (~scene.is_noise).sum()
        assert quiet.is_noise.sum() < 0.55 * scene.is_noise.sum()


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

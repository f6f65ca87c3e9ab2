"""What the trees learn from: scenes that hold what they claim to hold."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.laboratory.noise_training.examples import case_in_space, case_with_beams
from processing.laboratory.noise_training.fitting import TreesSize, fit_trees, shift_to_keep
from processing.laboratory.noise_training.noise_kinds import NOISE_KINDS
from processing.laboratory.noise_training.rays import (
    BOX,
    CAPSULE,
    NOWHERE,
    PANE,
    STRIP,
    thing,
    trace_rays,
)
from processing.laboratory.noise_training.scanners import AIRBORNE, MOBILE, STANDING
from processing.laboratory.noise_training.scenes import TrainingScene, scene_of, thin_scene
from processing.laboratory.noise_training.scores import f_measure, score_line
from processing.laboratory.noise_training.streets import KINDS, ROAD
from processing.methods.noise.combined import FIRST_LOOK_IN_SPACE, IN_SPACE, MODELS
from processing.methods.noise.tree_files import read_trees
from processing.methods.noise.trees import Trees, log_odds
from resources import path_of


@pytest.fixture(scope="module")
def scene() -> TrainingScene:
    return scene_of(2, MOBILE, 40_000)[0]


@pytest.mark.parametrize(
    ("row", "reach"),
    [
        (thing(STRIP, 0, 0.5, -9.0, -2.0, 9.0, -2.0), NOWHERE),
        (thing(BOX, 0, 0.5, 5.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0), 4.0),
        (thing(CAPSULE, 0, 0.5, 3.0, 0.0, -1.0, 3.0, 0.0, 1.0, 0.1), 2.9),
        (thing(PANE, 0, 0.5, 6.0, 0.0, 0.0, 0.0, 1.0, 1.0), 6.0),
        (thing(PANE, 0, 0.5, 6.0, 1.5, 0.0, 0.0, 1.0, 1.0), NOWHERE),
    ],
)
def test_a_level_beam_meets_what_stands_ahead(row: list[float], reach: float) -> None:
    met = trace_rays(np.zeros((1, 3)), np.eye(3)[:1], np.array([row]), 0.0, np.ones((1, 2)))
    assert met.ranges[0] == pytest.approx(reach)
    assert met.things[0] == (0 if reach < NOWHERE else -1)


def test_a_seed_gives_the_same_scene_again(scene: TrainingScene) -> None:
    again = scene_of(2, MOBILE, 40_000)[0]
    np.testing.assert_array_equal(again.xyz, scene.xyz)
    np.testing.assert_array_equal(again.noise, scene.noise)


@pytest.mark.parametrize("how", [MOBILE, STANDING, AIRBORNE])
def test_a_scene_holds_noise_and_true_things_and_its_points_lie_on_their_beams(how: str) -> None:
    scene, turn = scene_of(2, how, 40_000)
    is_noise = scene.noise > 0
    assert 0.0005 < is_noise.mean() < 0.6
    assert ((scene.kinds < 0) == is_noise).all()
    assert (scene.kinds == ROAD).mean() > 0.2
    lengths = np.linalg.norm(scene.xyz - scene.origins, axis=1)
    np.testing.assert_allclose(lengths, scene.ranges, atol=1e-6)
    beams = scene.beams(turn)
    assert beams.row_starts[0] == 0
    assert beams.row_starts[-1] == scene.ranges.size


def test_a_thinned_cloud_is_a_part_of_the_scene(scene: TrainingScene) -> None:
    sizes = {thin_scene(scene, seed).noise.size for seed in range(6)}
    assert max(sizes) <= scene.noise.size
    assert len(sizes) > 2


def test_examples_are_rows_that_say_what_they_are(scene: TrainingScene) -> None:
    with_beams, in_space = case_with_beams(scene, 0.002, 2), case_in_space(scene, 2)
    first = _tree_of_one_leaf(1.0)
    for examples in (
        *with_beams.alone(),
        *in_space.alone(),
        with_beams.again(first, first),
        in_space.again(None, first),
    ):
        assert examples.is_noise.any()
        assert not examples.is_noise.all()
        assert np.isfinite(examples.rows).all()
        assert examples.rows.shape[0] == examples.is_noise.size == examples.weights.size
    assert with_beams.again(_tree_of_one_leaf(-1.0), first).is_noise.size == 0
    assert in_space.again(None, _tree_of_one_leaf(-9.0)).is_noise.size == 0


def test_every_pass_sees_the_same_examples(scene: TrainingScene) -> None:
    case = case_in_space(scene, 2)
    np.testing.assert_array_equal(case.alone()[1].rows, case.alone()[1].rows)


def _tree_of_one_leaf(odds: float) -> Trees:
    none = np.zeros(1, np.int32)
    return Trees(none - 1, np.array([odds]), none, none, none, 0.0)


def test_the_first_look_in_space_keeps_what_is_called_noise_and_little_else(
    scene: TrainingScene,
) -> None:
    own, again, first = (
        read_trees(path_of(f"{MODELS}/{name}")) for name in (*IN_SPACE, FIRST_LOOK_IN_SPACE)
    )
    examples = case_in_space(scene, 2).said(own, again)
    is_left = log_odds(first, examples.rows, SilentMonitor()) > 0
    assert examples.is_noise.sum() > 100
    assert is_left[examples.is_noise].mean() >= 0.99
    assert is_left[~examples.is_noise].mean() < 0.8


def test_a_score_names_every_kind_that_is_there(scene: TrainingScene) -> None:
    line = score_line("scene", scene.noise > 0, scene)
    assert "F 1.000" in line
    assert f"{NOISE_KINDS[1]} 1.000" in line
    assert f"{KINDS[ROAD]} 1.000" in line
    assert f_measure(scene.noise > 99, scene.noise > 0) == 0.0


def test_trees_are_fitted_to_examples_and_a_first_look_keeps_the_noise(
    scene: TrainingScene,
) -> None:
    looks = case_with_beams(scene, 0.002, 2).alone()[0]
    trees = fit_trees(looks, TreesSize(30, 12, 0.25))
    first = shift_to_keep(trees, looks.rows, looks.is_noise, 0.01)
    is_left = log_odds(first, looks.rows, SilentMonitor()) > 0
    assert is_left[looks.is_noise].mean() >= 0.985
    assert is_left.mean() < 1.0

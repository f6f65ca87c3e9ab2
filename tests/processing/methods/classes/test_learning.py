"""Learning from corrections: what was painted is learnt, what was right stays, files are safe."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import BadFile, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.methods.classes.boosting import BoostingLimits, ClassExamples, boosted_further
from processing.methods.classes.class_models import (
    ClassModels,
    shipped_models,
    shipped_sample,
)
from processing.methods.classes.class_trees import class_shares
from processing.methods.classes.example_file import read_examples, write_examples
from processing.methods.classes.learning import gain_of, learnt_forest
from processing.methods.classes.own_model import ModelFacts, read_own_model, write_own_model
from processing.methods.classes.painted_cells import PaintedCells
from processing.methods.classes.tree_growing import GrowthLimits
from processing.methods.noise.tree_files import Forest, read_forest, write_forest

M = SilentMonitor()
LIMITS = BoostingLimits(8, GrowthLimits(leaves=4, ridge=1.0, least=5, rate=0.5))
GRASS, BUILDING, OFFICE_CLASS = 3, 6, 70


def said(models: ClassModels, examples: ClassExamples) -> np.ndarray:
    return models.codes[models.say_again(examples.rows, M).argmax(axis=1)]


def boosted(examples: ClassExamples) -> Forest:
    return boosted_further(shipped_models().again, examples, LIMITS, M)


def learnt_models(forest: Forest) -> ClassModels:
    return replace(shipped_models(), again=forest, is_own=True)


def some_of_the_sample(count: int = 1500) -> ClassExamples:
    sample = shipped_sample()
    chosen = np.zeros(len(sample), np.bool_)
    chosen[np.random.default_rng(2).permutation(len(sample))[:count]] = True
    return sample.of(chosen)


def corrected(sample: ClassExamples) -> PaintedCells:
    """A world in which what looks like a building, but is rougher than any known, is grass."""
    is_building = said(shipped_models(), sample) == BUILDING
    rows = sample.rows[is_building]
    is_grass = np.arange(len(rows)) % 2 == 1
    rows[is_grass, :4] += 3.0
    painted = ClassExamples.alike(rows, np.where(is_grass, GRASS, BUILDING).astype(np.uint8))
    places = np.arange(len(painted)) % 12
    none = painted.of(np.zeros(len(painted), np.bool_))
    classes = frozenset({GRASS, BUILDING})
    return PaintedCells(painted, none, places, np.empty(0, np.int64), classes)


def test_more_trees_learn_a_class_that_the_forest_never_met_and_keep_the_others() -> None:
    sample = some_of_the_sample(600)
    models = shipped_models()
    before = said(models, sample)
    is_new = sample.rows[:, 1] > np.quantile(sample.rows[:, 1], 0.8)
    taught = ClassExamples.alike(
        sample.rows, np.where(is_new, OFFICE_CLASS, before).astype(np.uint8)
    )
    after = said(learnt_models(boosted(taught)), taught)
    assert (after[is_new] == OFFICE_CLASS).mean() > 0.95
    assert (after[~is_new] == before[~is_new]).mean() > 0.95


def test_a_forest_with_more_trees_is_written_and_read_like_any_other(tmp_path: Path) -> None:
    sample = some_of_the_sample(300)
    forest = boosted(sample)
    write_forest(forest, tmp_path / "more.onnx", sample.rows.shape[1])
    read = read_forest(tmp_path / "more.onnx")
    np.testing.assert_array_equal(
        class_shares(read, sample.rows, M), class_shares(forest, sample.rows, M)
    )


def test_corrections_are_learnt_at_places_that_were_left_out() -> None:
    sample = some_of_the_sample()
    cells = corrected(sample)
    gain = gain_of(cells, sample, shipped_models(), M)
    before, after = gain.mean_f
    assert gain.places == 12
    assert before < 0.4
    assert after > 0.7
    assert gain.helps
    assert gain.before.count == gain.after.count == len(cells.painted)


def test_what_nobody_corrected_is_told_as_well_as_before() -> None:
    every = np.random.default_rng(2).permutation(len(shipped_sample()))
    sample, others = (shipped_sample().of(every % 8 == part) for part in (0, 1))
    models = shipped_models()
    forest = learnt_forest(corrected(sample), sample, models, M)
    others = others.of(others.codes != BUILDING)
    learnt = learnt_models(forest)
    before, after = (said(one, others) == others.codes for one in (models, learnt))
    assert after.mean() > before.mean() - 0.02


def test_examples_are_kept_in_a_byte_a_feature(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    rows = rng.normal(size=(2000, 4)).astype(np.float32)
    codes = rng.integers(1, 5, 2000).astype(np.uint8)
    write_examples(ClassExamples(rows, codes, rng.random(2000)), tmp_path / "some.npz")
    read = read_examples(tmp_path / "some.npz")
    np.testing.assert_array_equal(read.codes, codes)
    assert np.quantile(np.abs(read.rows - rows), 0.98) < 0.06
    assert (tmp_path / "some.npz").stat().st_size < 2000 * (4 + 1 + 4) + 6000


def written_model(folder: Path) -> ModelFacts:
    sample = some_of_the_sample(300)
    gain = gain_of(corrected(sample), sample, shipped_models(), M)
    facts = ModelFacts(folder.name, datetime(2026, 5, 1, 9, 30, tzinfo=UTC), 12_345, gain)
    folder.mkdir()
    write_own_model(facts, boosted(sample), folder)
    return facts


def test_a_learnt_model_is_read_back_and_refused_when_damaged_or_of_another_version(
    tmp_path: Path,
) -> None:
    facts = written_model(tmp_path / "m")
    read, models = read_own_model(tmp_path / "m")
    assert (read.id, read.made, read.points) == ("m", facts.made, 12_345)
    assert read.gain.mean_f == facts.gain.mean_f
    assert models.codes.tolist() == shipped_models().codes.tolist()

    path = tmp_path / "m" / "model.json"
    table = json.loads(path.read_text(encoding="utf-8"))
    path.write_text(json.dumps({**table, "shipped": "another"}), encoding="utf-8")
    with pytest.raises(Unsuitable, match="another version"):
        read_own_model(tmp_path / "m")
    path.write_text(json.dumps({**table, "places": "many"}), encoding="utf-8")
    with pytest.raises(BadFile, match="damaged"):
        read_own_model(tmp_path / "m")
    path.write_text(json.dumps(table), encoding="utf-8")
    trees = tmp_path / "m" / "again.onnx"
    trees.write_bytes(trees.read_bytes()[:-5])
    with pytest.raises(BadFile, match="damaged"):
        read_own_model(tmp_path / "m")

"""Makes the models of ``classify`` anew and says what they reach.

``python -m processing.laboratory.class_training``

Needs the extra ``train``. Streets of ``--seeds`` and, recorded by heads of any height, tilt and
rate, of ``--mounted`` are learnt from, each head thinned, shaken and brightened in ``--variants``
ways, every third as one scan from one place; those of ``--check`` are not. Of the avenues
``--kept``, which aren't either, a sample is shipped for learning from corrections;
``--sample-only`` makes nothing else.
``--deliveries`` are folders with truths that are only scored.
``--score-only`` leaves the models as they are. ``--pictures`` is a folder for the confusion matrix
of each street that is scored, and for images of its true and found classes. The same seeds give the
same models.
"""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    avenue_scenes,
    given_scenes,
    mounted_scenes,
    simulated_scenes,
    worn_options_of,
)
from processing.laboratory.accuracy.road.true_labels import labels_of_drive
from processing.laboratory.class_training.examples import (
    NOISE,
    labelled_cells,
)
from processing.laboratory.class_training.fitting import AveragedSize, ForestSize
from processing.laboratory.class_training.pictures import write_confusion, write_label_image
from processing.laboratory.class_training.sample import kept_sample
from processing.laboratory.class_training.two_forests import (
    FOLDS,
    ForestPlan,
    SampledCells,
    make_averaged_trees,
    make_two_forests,
)
from processing.laboratory.progress_lines import say
from processing.laboratory.seed_ranges import seeds_of
from processing.methods.classes.class_models import (
    AGAIN,
    ALONE,
    AVERAGED,
    MODELS,
    SAMPLE,
    shipped_models,
)
from processing.methods.classes.drive_classes import classify_drive
from processing.methods.classes.example_file import write_examples
from processing.methods.classes.found_things import NearThings
from processing.scoring.points.class_scores import class_score
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.scoring.points.reliability import Reliability, reliability_of
from processing.tools.found_things import look_for_things
from resources import path_of

_PLAN = ForestPlan(
    ALONE,
    ForestSize(rounds=50, leaves=31, rate=0.2),
    AGAIN,
    ForestSize(rounds=40, leaves=24, rate=0.2),
)
"""Half of it and less (24 rounds of 20 and 16 leaves, half of the cells) loses 0.03 of mean F on
streets of the own simulator that weren't learnt from, and as much as it gains on those of another.
"""

_AVERAGED = AveragedSize(trees=40, leaves=3000, asked=0.13)
"""Of more leaves they would know a little more (docs/accuracy.md); these take 9 MB. A node asks
about the root of the number of features, as is usual."""

_CELLS = 1000
"""Of each class and variant that are learnt from."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the models, or only score those that are there."""
    options = _parser().parse_args(arguments)
    if not (options.score_only or options.sample_only):
        _make(options)
    if not options.score_only:
        _keep_sample(options)
    checked = simulated_scenes(seeds_of(options.check), options.length)
    for scene in itertools.chain(checked, given_scenes(options.deliveries)):
        say(_score_line(scene, options.pictures))
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m processing.laboratory.class_training")
    parser.add_argument("--seeds", default="3000-3011", help="streets that are learnt from")
    parser.add_argument("--worn", default="3030-3033", help="worn ones, by drifting trajectories")
    parser.add_argument("--mounted", default="3040-3049", help="those by heads of any mounting")
    parser.add_argument("--kept", default="600-609", help="avenues a sample is shipped of")
    parser.add_argument("--check", default="3100-3103", help="streets that are only scored")
    parser.add_argument("--length", type=float, default=60.0, help="m of each")
    parser.add_argument("--variants", type=int, default=3, help="of each head")
    parser.add_argument("--deliveries", type=Path, nargs="*", default=[])
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--score-only", action="store_true")
    parser.add_argument("--sample-only", action="store_true")
    return parser


def _make(options: argparse.Namespace) -> None:
    rng = np.random.default_rng(0)
    folds: list[list[SampledCells]] = [[] for _ in range(FOLDS)]
    for number, scene in enumerate(_learnt(options)):
        for one in labelled_cells(scene, options.variants, number):
            folds[number % FOLDS].append(SampledCells.of(one, _CELLS, rng))
        say(f"learnt from {scene.name}: {sum(map(len, folds))} variants")
    make_two_forests(folds, _PLAN)
    make_averaged_trees(itertools.chain(*folds), AVERAGED, _AVERAGED)


def _keep_sample(options: argparse.Namespace) -> None:
    scenes = avenue_scenes(seeds_of(options.kept), options.length)
    path = path_of("models") / Path(MODELS).name / SAMPLE
    write_examples(kept_sample(scenes, shipped_models()), path)
    say(f"{path.name}: {path.stat().st_size / 1e3:,.0f} kB")


def _learnt(options: argparse.Namespace) -> Iterator[RoadScene]:
    return itertools.chain(
        simulated_scenes(seeds_of(options.seeds), options.length),
        simulated_scenes(seeds_of(options.worn), options.length, worn_options_of),
        mounted_scenes(seeds_of(options.mounted), options.length),
    )


def _score_line(scene: RoadScene, pictures: Path | None) -> str:
    said, true, sure, told = [], [], [], []
    things = look_for_things(scene.drives, SilentMonitor()).things
    near = NearThings(things)
    for drive in scene.drives:
        codes, confidence = np.zeros(drive.count, np.uint8), np.zeros(drive.count, np.float32)
        scratch = drive.folder / "classes"
        scratch.mkdir()
        classify_drive(
            drive,
            codes,
            confidence,
            scratch,
            SilentMonitor(),
            models=shipped_models(),
            things=things,
        )
        said.append(codes)
        told.append(near.told(drive.xyz(slice(0, drive.count))).codes)
        sure.append(confidence)
        true.append(labels_of_drive(drive, scene.delivery / "truth"))
        if pictures is not None:
            name = f"{scene.name}_{len(true)}.png".replace(" ", "_")
            write_label_image(drive, true[-1], codes, pictures / name)
    truth, found = np.concatenate(true), np.concatenate(said)
    score = class_score(ConfusionMatrix.of(truth, found))
    if pictures is not None and score.matrix is not None:
        write_confusion(score.matrix, pictures / f"{scene.name}.svg".replace(" ", "_"))
    figures = " ".join(f"{one.id} {one.value:.3f}" for one in score.figures)
    classes = " ".join(f"{one.id} {one.counts.f_measure:.2f}" for one in score.classes)
    is_asked = (found > 0) & (truth > 0) & ~np.isin(truth, NOISE)
    reliability = reliability_of(
        np.concatenate(sure)[is_asked].astype(np.float64), (found == truth)[is_asked]
    )
    words = _told_words(truth, np.concatenate(told), things.sought)
    return f"{scene.name}: {figures}; F {classes}; {_reliability_words(reliability)}; {words}"


def _told_words(truth: NDArray[np.uint8], told: NDArray[np.uint8], sought: frozenset[int]) -> str:
    """Of each class that was looked for: share of the points on things that are right, missed."""
    shares = []
    for code in sorted(sought):
        is_told, is_true = told == code, truth == code
        if is_told.any() and is_true.any():
            right, missed = is_true[is_told].mean(), 1 - is_told[is_true].mean()
            shares.append(f"{code} {right:.2f} {missed:.2f}")
    return f"on things: right, missed {', '.join(shares)}"


def _reliability_words(reliability: Reliability) -> str:
    """How often what was said with about the same confidence was right, of every point."""
    bins = " ".join(
        f"{one.mean_confidence:.2f}>{one.accepted.value:.2f}"
        for one in reliability.bins
        if one.accepted.of
    )
    return f"calibration error {reliability.calibration_error:.3f}, {bins}"


if __name__ == "__main__":
    write_every_character()
    raise SystemExit(main())

"""The thesis' forests on the project's streets: which features carry classes, and to which city.

``python -m processing.laboratory.class_training.ablations --samples FOLDER…``

Needs the extra ``train``. A forest learns from points of the streets of ``--seeds``; importance and
Boruta's choice are taken from those of ``--validation``, as in the thesis; scored are the streets
of ``--check`` and the ``--samples``.
The image network of the thesis (M&A&I) isn't here: it can't be trained in hours without a graphics
card.

References
----------
Takahashi 2022, sections 4.6.3 and 4.7; Kursa and Rudnicki 2010, Journal of Statistical Software
36(11), for Boruta.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    given_scenes,
    simulated_scenes,
)
from processing.laboratory.class_training.examples import NOISE, labels_of_drive
from processing.laboratory.seed_ranges import seeds_of
from processing.methods.point_features.drive_features import computable_features, drive_features
from processing.recording.columns.point_features import POINT_FEATURES, SELECTED
from processing.recording.drive import Drive
from processing.scoring.class_scores import class_score
from processing.scoring.confusion_matrix import ConfusionMatrix

NAMES = (*POINT_FEATURES, "height", "intensity")
"""All 102, in the order of the columns of a sample."""

MMS = ("path_height", "path_distance", "scan_line_length", "scan_line_curvature", "height",
       "intensity")  # fmt: skip
"""The thesis' A; all others are its M, with the six that it doesn't name."""

_NOT_ASKED = (0, 1, *NOISE)
"""No class, “other”, noise: neither learnt nor scored, as in the thesis."""

_OF_A_CLASS = 1_000
"""Points of each class, street and head, as far as there are: some 100,000 of eight streets."""

_TREES, _LEAST_LEAF = 100, 5
"""The thesis names neither: scikit-learn's number of trees, and leaves that no single point makes.
"""

_LEAST_IMPORTANCE = 0.015
"""Table 4-1."""

_BORUTA_ROUNDS, _BORUTA_ROWS, _BORUTA_TREES = 20, 12_000, 50
_SURE = 0.05
"""Rounds in which a feature beats the best shadow follow a binomial distribution; kept is what does
so more often than half at this level, with Bonferroni's correction for all features."""


@dataclass(frozen=True)
class PointSample:
    """Some points of a street.

    Attributes
    ----------
    rows : (k, 102) float32
        Features; NaN where a drive lacks one.
    codes : (k,) uint8
        True classes.
    counts : mapping of int to int
        How many points of each class the street has.
    """

    rows: NDArray[np.float32]
    codes: NDArray[np.uint8]
    counts: Mapping[int, int]


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables."""
    options = _parser().parse_args(arguments)
    learnt = _joined(_samples(simulated_scenes(seeds_of(options.seeds), options.length)))
    valid = _joined(_samples(simulated_scenes(seeds_of(options.validation), options.length)))
    tested = dict(_samples(simulated_scenes(seeds_of(options.check), options.length)))
    tested |= dict(_samples(given_scenes(options.samples)))
    importance = _importance(_forest(valid, range(len(NAMES))))
    _say_importance(importance)
    boruta = _boruta(valid, np.random.default_rng(0))
    _say(f"Boruta keeps {len(boruta)} of {len(NAMES)}; not: "
         f"{', '.join(name for at, name in enumerate(NAMES) if at not in boruta)}")  # fmt: skip
    _say("| features | number | " + " | ".join(tested) + " |")
    _say("|---" * (len(tested) + 2) + "|")
    for name, columns in _choices(importance, boruta):
        scores = _scores(_forest(learnt, columns), columns, tested.values())
        _say(f"| {name} | {len(columns)} | " + " | ".join(f"{one:.3f}" for one in scores) + " |")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.class_training.ablations"
    )
    parser.add_argument("--seeds", default="3000-3007", help="streets that are learnt from")
    parser.add_argument("--validation", default="3020-3021", help="for importance and Boruta")
    parser.add_argument("--check", default="3200-3201", help="streets that are only scored")
    parser.add_argument("--length", type=float, default=40.0, help="m of each")
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    return parser


def _choices(
    importance: NDArray[np.float64], boruta: Sequence[int]
) -> Iterator[tuple[str, list[int]]]:
    """What the forests are given, by name."""
    everything = range(len(NAMES))
    place = {name: at for at, name in enumerate(NAMES)}
    selected = [at for at in everything if importance[at] >= _LEAST_IMPORTANCE]
    absolute = [name for name in NAMES if name == "height" or name.startswith("mean_height")]
    yield "M", [at for at in everything if NAMES[at] not in MMS]
    yield "M&A, all", list(everything)
    yield "M&A, importance ≥ 1.5 % here", selected
    yield "M&A, the thesis' 17", [place[name] for name in (*SELECTED, "height", "intensity")]
    yield "M&A, what Boruta keeps", list(boruta)
    yield "M&A, without absolute height", [at for at in everything if NAMES[at] not in absolute]
    own = [*absolute, *MMS[:4]]
    yield (
        "M and intensity, without absolute height",
        [at for at in everything if NAMES[at] not in own],
    )


def _samples(scenes: Iterable[RoadScene]) -> Iterator[tuple[str, PointSample]]:
    """Some points of each street, of all its heads."""
    for scene in scenes:
        rng, truth = np.random.default_rng(0), scene.delivery / "truth"
        parts = [_of_drive(drive, labels_of_drive(drive, truth), rng) for drive in scene.drives]
        yield scene.name, _together(parts)


def _of_drive(drive: Drive, labels: NDArray[np.uint8], rng: Generator) -> PointSample:
    """Some points of each class, with their features."""
    chosen: list[Integers] = []
    counts = {}
    for code in np.setdiff1d(labels, _NOT_ASKED).tolist():
        points = np.flatnonzero(labels == code)
        counts[code] = points.size
        chosen.append(rng.choice(points, min(points.size, _OF_A_CLASS), replace=False))
    wanted = np.zeros(drive.count, np.bool_)
    wanted[np.concatenate(chosen)] = True
    names, _ = computable_features(drive, tuple(POINT_FEATURES))
    with tempfile.TemporaryDirectory(prefix="zuka-") as folder:
        columns: dict[str, NDArray[np.float32]] = {
            name: np.memmap(Path(folder) / name, np.float32, "w+", shape=(drive.count,))
            for name in names
        }
        drive_features(drive, columns, Path(folder), SilentMonitor(), wanted=wanted)
        points = np.flatnonzero(wanted)
        rows = np.full((points.size, len(NAMES)), np.nan, np.float32)
        for at, name in enumerate(POINT_FEATURES):
            if name in columns:
                rows[:, at] = columns[name][points]
    rows[:, -2] = drive.xyz(points)[:, 2]
    rows[:, -1] = drive.columns["intensity"][points]
    return PointSample(rows, labels[points], counts)


def _together(parts: Sequence[PointSample]) -> PointSample:
    codes = {code for part in parts for code in part.counts}
    counts = {code: sum(part.counts.get(code, 0) for part in parts) for code in sorted(codes)}
    rows = np.concatenate([part.rows for part in parts])
    return PointSample(rows, np.concatenate([part.codes for part in parts]), counts)


def _joined(samples: Iterable[tuple[str, PointSample]]) -> PointSample:
    return _together([sample for _, sample in samples])


def _rows(sample: PointSample, columns: Sequence[int]) -> NDArray[np.float32]:
    """What a forest sees; a feature that a drive lacks is 0."""
    rows: NDArray[np.float32] = np.nan_to_num(sample.rows[:, list(columns)], nan=0.0)
    return rows


# scikit-learn's classes have no types.
def _forest(sample: PointSample, columns: Sequence[int]) -> Any:
    from sklearn.ensemble import RandomForestClassifier

    forest = RandomForestClassifier(
        _TREES,
        min_samples_leaf=_LEAST_LEAF,
        max_features="sqrt",
        class_weight="balanced",
        random_state=0,
    )
    return forest.fit(_rows(sample, columns), sample.codes)


def _importance(forest: Any) -> NDArray[np.float64]:
    shares: NDArray[np.float64] = forest.feature_importances_
    return shares


def _boruta(sample: PointSample, rng: Generator) -> list[int]:
    """Features that beat the best of all shadows more often than by chance.

    1. Every feature gets a shadow: its values in another order, so that they say nothing.
    2. A forest is grown of both; a feature scores when it is worth more than the best shadow.
    3. Kept is what scored in more of the rounds than chance would let it.
    """
    from scipy.stats import binom
    from sklearn.ensemble import RandomForestClassifier

    some = rng.choice(len(sample.codes), min(len(sample.codes), _BORUTA_ROWS), replace=False)
    rows, codes = _rows(sample, range(len(NAMES)))[some], sample.codes[some]
    scored = np.zeros(len(NAMES), np.int64)
    for number in range(_BORUTA_ROUNDS):
        both = np.hstack([rows, rng.permuted(rows, axis=0)])
        forest = RandomForestClassifier(_BORUTA_TREES, class_weight="balanced", random_state=number)
        worth = _importance(forest.fit(both, codes))
        scored += worth[: len(NAMES)] > worth[len(NAMES) :].max()
    by_chance = binom.sf(scored - 1, _BORUTA_ROUNDS, 0.5)
    return [int(at) for at in np.flatnonzero(by_chance < _SURE / len(NAMES))]


def _scores(forest: Any, columns: Sequence[int], tested: Iterable[PointSample]) -> Iterator[float]:
    """Mean F of each street, ground and road as one, as if all its points had been asked."""
    for sample in tested:
        found = forest.predict(_rows(sample, columns)).astype(np.uint8)
        matrix = ConfusionMatrix.of(sample.codes, found)
        whole = np.array([sample.counts.get(code, 0) for code in matrix.codes])
        asked = np.maximum(matrix.true_counts, 1)
        counts = np.rint(matrix.counts * (whole / asked)[:, None]).astype(np.int64)
        score = class_score(ConfusionMatrix(matrix.codes, counts))
        (joined,) = [one.value for one in score.figures if one.id == "mean_f_ground_joined"]
        yield joined


def _say_importance(importance: NDArray[np.float64]) -> None:
    order = np.argsort(-importance, kind="stable")
    kept = [at for at in order if importance[at] >= _LEAST_IMPORTANCE]
    words = ", ".join(f"{NAMES[at]} {importance[at]:.1%}" for at in kept)
    _say(f"{len(kept)} features of at least 1.5 %: {words}")


def _say(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    write_every_character()
    raise SystemExit(main())

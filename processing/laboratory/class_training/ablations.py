"""The thesis' forests on the project's streets: which features carry classes, and to which city.

``python -m processing.laboratory.class_training.ablations --samples FOLDER…``

Needs the extra ``train``. A forest learns from points of the streets of ``--seeds`` and, recorded
by heads of any height, tilt and rate, of ``--mounted``; importance and Boruta's choice are taken
from those of ``--validation``, as in the thesis; scored are the streets of ``--check`` and the
``--samples``. The thesis' image network is a command of its own,
:mod:`processing.laboratory.class_training.image_network`.
"""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from processing.core.arrays import Floats
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    given_scenes,
    mounted_scenes,
    simulated_scenes,
)
from processing.laboratory.class_training.forests import (
    LEAST_IMPORTANCE,
    boruta,
    fitted_forest,
    importance_of,
    mean_f,
    whole_score,
)
from processing.laboratory.class_training.point_samples import (
    ABSOLUTE,
    BRIGHTNESS,
    MMS,
    NAMES,
    PointSample,
    samples_of,
)
from processing.laboratory.progress_lines import say
from processing.laboratory.seed_ranges import seeds_of
from processing.recording.columns.point_features import PATH_FEATURES, SELECTED

_OF_A_CLASS = 1_000
"""Points of each class, street and head, as far as there are: some 100,000 of eight streets."""

_THESIS = [at for at, name in enumerate(NAMES) if name != BRIGHTNESS]
"""Columns of the 102."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables."""
    options = _parser().parse_args(arguments)
    streets = simulated_scenes(seeds_of(options.seeds), options.length)
    mounted = mounted_scenes(seeds_of(options.mounted), options.length)
    learnt = _joined(_samples(itertools.chain(streets, mounted)))
    valid = _joined(_samples(simulated_scenes(seeds_of(options.validation), options.length)))
    tested = dict(_samples(simulated_scenes(seeds_of(options.check), options.length)))
    tested |= dict(_samples(given_scenes(options.samples)))
    importance = importance_of(_forest(valid, _THESIS))
    _say_importance(importance)
    kept = boruta(valid.values(_THESIS), valid.codes, np.random.default_rng(0)).tolist()
    say(f"Boruta keeps {len(kept)} of {len(_THESIS)}; not: "
         f"{', '.join(NAMES[at] for at in _THESIS if at not in kept)}")  # fmt: skip
    say("| features | number | " + " | ".join(tested) + " |")
    say("|---" * (len(tested) + 2) + "|")
    for name, columns in _choices(importance, kept):
        scores = _scores(_forest(learnt, columns), columns, tested.values())
        say(f"| {name} | {len(columns)} | " + " | ".join(f"{one:.3f}" for one in scores) + " |")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.class_training.ablations"
    )
    parser.add_argument("--seeds", default="3000-3007", help="streets that are learnt from")
    parser.add_argument("--mounted", default="", help="those by heads of any mounting")
    parser.add_argument("--validation", default="3020-3021", help="for importance and Boruta")
    parser.add_argument("--check", default="3200-3201", help="streets that are only scored")
    parser.add_argument("--length", type=float, default=40.0, help="m of each")
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    return parser


def _choices(importance: Floats, kept: Sequence[int]) -> Iterator[tuple[str, list[int]]]:
    """What the forests are given, by name."""
    selected = [at for at in _THESIS if importance[at] >= LEAST_IMPORTANCE]
    path = [name for name, *_ in PATH_FEATURES]
    yield "M", _without(*MMS)
    yield "M&A, all", _THESIS
    yield "M&A, importance ≥ 1.5 % here", selected
    yield "M&A, the thesis' 17", [NAMES.index(n) for n in (*SELECTED, "height", "intensity")]
    yield "M&A, what Boruta keeps", list(kept)
    yield "M&A, without absolute height", _without(*ABSOLUTE, BRIGHTNESS)
    yield "the same, intensity relative", _without(*ABSOLUTE, "intensity")
    yield "the same, without the trajectory", _without(*ABSOLUTE, "intensity", *path)


def _without(*names: str) -> list[int]:
    return [at for at, name in enumerate(NAMES) if name not in names]


def _samples(scenes: Iterable[RoadScene]) -> Iterator[tuple[str, PointSample]]:
    return samples_of(scenes, _OF_A_CLASS)


def _joined(samples: Iterable[tuple[str, PointSample]]) -> PointSample:
    return PointSample.joined([sample for _, sample in samples])


# scikit-learn's classes have no types.
def _forest(sample: PointSample, columns: Sequence[int]) -> Any:
    return fitted_forest(sample.values(columns), sample.codes)


def _scores(forest: Any, columns: Sequence[int], tested: Iterable[PointSample]) -> Iterator[float]:
    """Mean F of each street, ground and road as one, as if all its points had been asked."""
    for sample in tested:
        found = forest.predict(sample.values(columns)).astype(np.uint8)
        yield mean_f(whole_score(sample.codes, found, sample.counts))


def _say_importance(importance: Floats) -> None:
    order = np.argsort(-importance, kind="stable")
    kept = [at for at in order if importance[at] >= LEAST_IMPORTANCE]
    words = ", ".join(f"{NAMES[at]} {importance[at]:.1%}" for at in kept)
    say(f"{len(kept)} features of at least 1.5 %: {words}")


if __name__ == "__main__":
    write_every_character()
    raise SystemExit(main())

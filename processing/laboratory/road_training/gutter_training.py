"""What tells lids and gratings, from known streets.

``python -m processing.laboratory.road_training.gutter_training``.

Simulates streets of ``--seeds``, each recorded by heads of any height, tilt and rate, finds covers
on them without leaving any out, and fits the weights of
`processing.methods.road.gutters.gutter_confidence` and
`processing.methods.road.gutters.grating_confidence` to which of them are right; streets of
``--check`` are not learnt from. ``--deliveries`` are further streets to learn from, recorded
before. Prints the weights and how many covers of each confidence are right: of streets learnt from
by weights that were fitted without the street itself.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.road_scenes import RoadScene, mounted_scenes
from processing.laboratory.road_training.learned_confidence import (
    LabelledThings,
    WeightPrior,
    learn_weights,
)
from processing.laboratory.road_training.training_streets import training_streets
from processing.methods.road.gutters.grating_confidence import GratingTerms, terms_of
from processing.methods.road.gutters.gutter_confidence import CoverFacts
from processing.scoring.features.gutters import score_gutters
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.tools.gutters import GutterParameters, gutter_evidence

_FACTS = {"lids": CoverFacts._fields, "gratings": GratingTerms._fields}
_SEEDS = "2000-2023", "2100-2111"
_EXPECTED = {
    "lids": WeightPrior(
        (-4.0, *CoverFacts(1.0, 1.0, 1.0, 0.5, -10.0, -0.5, -0.5, -0.5, -1.5, -0.5, -10.0)),
        (3.0, *CoverFacts(0.5, 0.7, 0.7, 0.4, 10.0, 0.5, 0.5, 0.5, 1.0, 0.5, 5.0)),
    ),
    "gratings": WeightPrior(
        (-12.0, *GratingTerms(2.0, 0.5, 4.0, 2.0, 1.5, -10.0)),
        (6.0, *GratingTerms(2.0, 0.5, 3.0, 1.5, 1.0, 10.0)),
    ),
}

# Terms, whether it is right, its worth, its street.
_Row = tuple[Sequence[float], bool, float, int]


def known_covers(scenes: Iterator[RoadScene]) -> dict[str, LabelledThings]:
    """All covers on some streets, by where they are from: rows of joints, open rectangles."""
    rows: dict[str, list[_Row]] = {name: [] for name in _FACTS}
    for number, scene in enumerate(scenes):
        for name, terms, is_right, worth in _judge_covers(scene):
            rows[name].append((terms, is_right, worth, number))
        counts = ", ".join(f"{len(rows[name])} {name}" for name in rows)
        sys.stderr.write(f"{scene.name}: {counts}\n")
    return {name: LabelledThings.of(rows[name], len(_FACTS[name])) for name in rows}


def _judge_covers(scene: RoadScene) -> Iterator[tuple[str, Sequence[float], bool, float]]:
    truth = read_mapped(scene.truth("gutters"))
    laid, gratings = gutter_evidence(scene.drives, GutterParameters(), SilentMonitor())
    for one in laid:
        # Covers of one gutter are right or wrong together.
        worth = 1.0 / math.sqrt(len(one.covers))
        corners = [(cover.corners, cover.is_grating) for cover in one.covers]
        for number, is_right in _which_are_right(corners, truth):
            yield "lids", one.facts[number], is_right, worth
    corners = [(found.corners, True) for found in gratings]
    for number, is_right in _which_are_right(corners, truth):
        yield "gratings", terms_of(gratings[number].facts), is_right, 1.0


def _which_are_right(
    covers: Sequence[tuple[Floats, bool]], truth: MappedFile
) -> Iterator[tuple[int, bool]]:
    """Places among covers, and whether each is right; not of those on what nobody can see."""
    features = tuple(
        MappedFeature(
            number,
            "area",
            corners,
            {
                "kind": "gutter_grating" if is_grating else "gutter_lid",
                "type": "grating" if is_grating else "lid",
            },
        )
        for number, (corners, is_grating) in enumerate(covers)
    )
    result = MappedFile(Path("gutters.geojson"), truth.crs, features)
    for feature, is_right in score_gutters(result, truth).is_right:
        yield feature.number, is_right


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = training_streets("gutter_training", arguments, mounted_scenes, _SEEDS)
    known, check = known_covers(asked.learnt), known_covers(asked.check)
    for name, expected in _EXPECTED.items():
        told = learn_weights(_FACTS[name], expected, known[name], check[name])
        sys.stdout.write(f"{name}\n{told}")
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

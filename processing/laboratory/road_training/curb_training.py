"""What tells curbs apart, learnt from known streets.

``python -m processing.laboratory.road_training.curb_training``.

Simulates streets of ``--seeds``, ``--worn`` and ``--country``, finds lines on them without leaving
any out, and fits `processing.methods.road.curbs.steps.curb_confidence.WEIGHTS` to which of them are
curbs; streets of ``--check`` are not learnt from. ``--deliveries`` are further streets to learn
from, recorded before. Prints the weights and how many lines of each confidence are right: of
streets learnt from by weights that were fitted without the street itself.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Mapping, Sequence

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    country_options_of,
    worn_options_of,
)
from processing.laboratory.road_training.learned_confidence import (
    LabelledThings,
    WeightPrior,
    learn_weights,
)
from processing.laboratory.road_training.training_streets import RequestOf, training_streets
from processing.methods.road.curbs.steps.curb_confidence import CurbFacts, terms_of
from processing.methods.road.curbs.steps.curb_filters import step_runs
from processing.scoring.features.curb_lines import FOUND_SHARE, TOLERANCE_M
from processing.scoring.features.curb_sections import kind_of
from processing.scoring.features.line_positions import PolylineIndex, length_m, middle_positions
from processing.scoring.features.mapped_features import MappedFile
from processing.tools.curbs import CurbParameters, measure_curbs, step_settings

EXPECTED = WeightPrior(
    (
        2.5,
        *CurbFacts(
            1.0, -25.0, -8.0, -1.0, -20.0, -8.0, -1.0, -1.0, 1.0, -6.0, -3.0, -4.0, -6.0, -4.0
        ),
    ),
    (2.0, *CurbFacts(0.3, 10.0, 5.0, 0.7, 8.0, 4.0, 1.0, 0.7, 0.5, 2.0, 1.5, 2.0, 2.0, 2.0)),
)
"""Tens of streets have few false lines of each kind, so much is left to what reasoning expects."""

_SEEDS, _CHECK = "500-511", "530-539"
_OTHERS: Mapping[str, tuple[str, RequestOf]] = {
    "worn": ("540-557", worn_options_of),
    "country": ("600-629", country_options_of),
}
"""Streets that the curbs' `WEIGHTS` were learnt from: as laid, worn and less exactly driven, and
country roads and highways."""

_SHORTEST_M, _LONGEST_M, _POSITIONS_M = 0.75, 10.0, 0.1


def known_lines(scenes: Iterator[RoadScene]) -> LabelledThings:
    """All lines on some streets; rear edges of kerb stones, which count neither way, left out."""
    rows: list[tuple[CurbFacts, bool, float, int]] = []
    for number, scene in enumerate(scenes):
        rows += [(*one, number) for one in _judge_runs(scene, read_mapped(scene.truth("curbs")))]
        sys.stderr.write(f"{scene.name}: {len(rows)} lines\n")
    known = LabelledThings.of(rows, len(CurbFacts._fields))
    known.worth[:] /= known.worth.mean() if rows else 1.0
    return known


def _judge_runs(scene: RoadScene, truth: MappedFile) -> Iterator[tuple[CurbFacts, bool, float]]:
    lower = [one for one in truth.features if one.facts.get("edge") == "lower"]
    fronts = PolylineIndex([one.xyz for one in lower if kind_of(one) != "back"])
    rears = PolylineIndex([one.xyz for one in truth.features if kind_of(one) == "back"])
    parameters = CurbParameters()
    settings, monitor = step_settings(parameters), SilentMonitor()
    runs = [
        run
        for number, drive in enumerate(scene.drives)
        for run in step_runs(drive, number, settings, monitor)
    ]
    for one in measure_curbs(scene.drives, runs, parameters, monitor):
        long_m = length_m(one.line.lower)
        if long_m < _SHORTEST_M:
            continue
        at = middle_positions(one.line.lower, _POSITIONS_M)
        shares = [
            float((lines.nearest(at, TOLERANCE_M).line >= 0).mean()) for lines in (fronts, rears)
        ]
        if shares[0] >= FOUND_SHARE or shares[1] < FOUND_SHARE:
            # Long lines have more to say, though not so many times more.
            worth = math.sqrt(min(max(long_m, 1.0), _LONGEST_M))
            yield terms_of(one.facts), shares[0] >= FOUND_SHARE, worth


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = training_streets("curb_training", arguments, seeds=(_SEEDS, _CHECK), others=_OTHERS)
    known, check = known_lines(asked.learnt), known_lines(asked.check)
    sys.stdout.write(learn_weights(CurbFacts._fields, EXPECTED, known, check))
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

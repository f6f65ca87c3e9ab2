"""What tells road markings from other bright strokes, learnt from known streets.

``python -m processing.laboratory.road_training.marking_training``.

Simulates streets of ``--seeds``, follows all strokes on them and fits the weights of
`processing.methods.road.markings.marking_confidence` to which of them are markings; streets of
``--check`` are not learnt from. Prints the weights and how many of each confidence are right.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Sequence

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.road_scenes import RoadScene, simulated_scenes
from processing.laboratory.road_training.learned_confidence import (
    LabelledThings,
    WeightPrior,
    learn_weights,
)
from processing.laboratory.road_training.training_streets import (
    training_options_of,
    training_streets,
)
from processing.methods.road.markings.marking_confidence import MarkingFacts
from processing.methods.road.markings.street_markings import seen_markings
from processing.scoring.features.line_positions import PolylineIndex, middle_positions

EXPECTED = WeightPrior(
    (-3.0, *MarkingFacts(2.0, -4.0, 5.0, 0.5, -4.0, -2.0, -1.5, 0.5, -0.2)),
    (3.0, *MarkingFacts(2.0, 2.0, 3.0, 0.5, 2.0, 1.0, 1.0, 0.5, 0.5)),
)
"""What reasoning expects: markings are bright, even, long, and lie on the carriageway."""

_SEEDS, _CHECK = "940-951", "952-955"
_LONGEST_M = 16.0
_NEAR_M, _STEP_M = 0.1, 0.2
"""A stroke is a marking if most of it lies so near to one: trajectories of some streets drift."""


def known_strokes(scenes: Iterator[RoadScene]) -> LabelledThings:
    """All strokes on some streets."""
    rows: list[tuple[MarkingFacts, bool, float, int]] = []
    for number, scene in enumerate(scenes):
        rows += [(*one, number) for one in _judge_strokes(scene)]
        sys.stderr.write(f"{scene.name}: {len(rows)} strokes\n")
    known = LabelledThings.of(rows, len(MarkingFacts._fields))
    known.worth[:] /= known.worth.mean() if rows else 1.0
    return known


def _judge_strokes(scene: RoadScene) -> Iterator[tuple[MarkingFacts, bool, float]]:
    seen = seen_markings(scene.drives, SilentMonitor())
    if seen.raster is None:
        return
    origin = seen.raster.plan.origin
    true = read_mapped(scene.truth("markings")).features
    # Figures are neither lines nor mistaken for other things: nothing is learnt from them.
    index = PolylineIndex([one.xyz for one in true if one.facts["type"] != "other"])
    figures = PolylineIndex([one.xyz for one in true if one.facts["type"] == "other"])
    for marking, facts in seen.markings:
        line = np.column_stack([marking.line, np.zeros(len(marking.line))]) + origin
        at = middle_positions(line, _STEP_M)
        on_figure = np.mean(figures.nearest(at, 3 * _NEAR_M).line >= 0) > 0.5
        if marking.type != "other" and not on_figure:
            is_right = bool(np.mean(index.nearest(at, _NEAR_M).line >= 0) > 0.5)
            yield facts, is_right, math.sqrt(min(max(marking.painted_m, 1.0), _LONGEST_M))


def _scenes(seeds: Sequence[int], length_m: float) -> Iterator[RoadScene]:
    return simulated_scenes(seeds, length_m, training_options_of)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = training_streets("marking_training", arguments, _scenes, seeds=(_SEEDS, _CHECK))
    known, check = known_strokes(asked.learnt), known_strokes(asked.check)
    sys.stdout.write(learn_weights(MarkingFacts._fields, EXPECTED, known, check))
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

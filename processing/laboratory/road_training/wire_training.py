"""What tells wires from other thin lines, learnt from known streets.

``python -m processing.laboratory.road_training.wire_training``.

Simulates streets of ``--seeds``, finds all thin lines on them and fits the weights of
`processing.methods.road.wires.wire_confidence` to which of them are wires; streets of ``--check``
are not learnt from. Prints the weights and how many lines of each confidence are right: of streets
learnt from by weights that were fitted without the street itself.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Sequence

import numpy as np

from processing.core.arrays import Floats
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
from processing.methods.road.objects.survey import survey_ground
from processing.methods.road.wires.spans import spans_of
from processing.methods.road.wires.wire_confidence import WireFacts, facts_of
from processing.methods.road.wires.wire_points import wire_points

EXPECTED = WeightPrior(
    (-3.0, *WireFacts(1.5, 1.0, -1.5, -1.0, 0.1, -2.0, -4.0)),
    (3.0, *WireFacts(1.0, 1.0, 1.5, 1.0, 1.0, 2.0, 4.0)),
)
"""What reasoning expects: long lines that hang are wires, those that bulge, bend sharply or
lie on walls not."""

_SEEDS, _CHECK = "900-911", "918-923"
_LOWEST_M, _SHORTEST_M, _LONGEST_M = 3.5, 1.5, 16.0
_NEAR_M, _STEP_M = 0.15, 0.1
"""A line is a wire if most of it lies so near to one: trajectories of some streets drift."""


def known_lines(scenes: Iterator[RoadScene]) -> LabelledThings:
    """All thin lines on some streets."""
    rows: list[tuple[WireFacts, bool, float, int]] = []
    for number, scene in enumerate(scenes):
        rows += [(*one, number) for one in _judge_lines(scene)]
        sys.stderr.write(f"{scene.name}: {len(rows)} lines\n")
    known = LabelledThings.of(rows, len(WireFacts._fields))
    known.worth[:] /= known.worth.mean() if rows else 1.0
    return known


def _judge_lines(scene: RoadScene) -> Iterator[tuple[WireFacts, bool, float]]:
    from scipy.spatial import cKDTree

    monitor = SilentMonitor()
    plan, ground = survey_ground(scene.drives, monitor)
    found = wire_points(scene.drives, plan, ground, _LOWEST_M, monitor)
    true = [one.xyz - plan.origin for one in read_mapped(scene.truth("wires")).features]
    fine = [_every(line) for line in true]
    tree = cKDTree(np.concatenate(fine)) if fine else None
    for span in spans_of(found, monitor):
        if span.long_m >= _SHORTEST_M:
            at = span.at(np.arange(span.start_m, span.end_m, _STEP_M))
            off = tree.query(at)[0] if tree is not None else np.full(len(at), np.inf)
            worth = math.sqrt(min(span.long_m, _LONGEST_M))
            yield facts_of(span, found.solid), bool(np.mean(off < _NEAR_M) > 0.5), worth


def _every(line: Floats) -> Floats:
    """Places along a line, `_STEP_M` apart."""
    ends = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.arange(0.0, ends[-1], _STEP_M)
    return np.column_stack([np.interp(at, ends, axis) for axis in line.T])


def _scenes(seeds: Sequence[int], length_m: float) -> Iterator[RoadScene]:
    return simulated_scenes(seeds, length_m, training_options_of)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = training_streets("wire_training", arguments, _scenes, seeds=(_SEEDS, _CHECK))
    known, check = known_lines(asked.learnt), known_lines(asked.check)
    sys.stdout.write(learn_weights(WireFacts._fields, EXPECTED, known, check))
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

"""What tells walls and faces of buildings from other upright things, learnt from known streets.

``python -m processing.laboratory.road_training.wall_training``.

Simulates streets of ``--seeds``, looks for all upright faces on them and fits the weights of
`processing.methods.road.walls.wall_confidence` to which of them are walls or buildings; streets of
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
from processing.methods.road.walls.street_walls import seen_walls
from processing.methods.road.walls.wall_confidence import WallFacts
from processing.scoring.features.line_positions import PolylineIndex, middle_positions
from processing.scoring.features.walls import OTHER

EXPECTED = WeightPrior(
    (
        -6.0,
        *WallFacts(
            long=0.8, high=1.0, raised=-1.5, airy=-3.0, near=3.0, filled=1.0,
            open=-4.0, rough=-6.0, leaning=-1.0, over=-3.0, aside=3.0,
        ),
    ),
    (
        4.0,
        *WallFacts(
            long=0.5, high=1.0, raised=1.0, airy=2.0, near=3.0, filled=1.0,
            open=3.0, rough=4.0, leaning=1.0, over=2.0, aside=2.0,
        ),
    ),
)  # fmt: skip
"""What reasoning expects: walls are long, high, flat, closed, and stand apart from the way."""

_SEEDS, _CHECK = "960-971", "972-975"
_LONGEST_M = 16.0
_NEAR_M, _STEP_M = 0.1, 0.2
"""A face is a wall if most of it lies so near to one: trajectories of some streets drift."""


def known_faces(scenes: Iterator[RoadScene]) -> LabelledThings:
    """All upright faces on some streets."""
    rows: list[tuple[WallFacts, bool, float, int]] = []
    for number, scene in enumerate(scenes):
        rows += [(*one, number) for one in _judge_faces(scene)]
        sys.stderr.write(f"{scene.name}: {len(rows)} faces\n")
    known = LabelledThings.of(rows, len(WallFacts._fields))
    known.worth[:] /= known.worth.mean() if rows else 1.0
    return known


def _judge_faces(scene: RoadScene) -> Iterator[tuple[WallFacts, bool, float]]:
    seen = seen_walls(scene.drives, SilentMonitor())
    if seen.about is None:
        return
    origin = seen.about.plan.origin
    true = read_mapped(scene.truth("walls")).features
    index = PolylineIndex([one.xyz for one in true if one.facts["type"] != OTHER])
    # Barriers and posts of gates look like walls: nothing is learnt from them.
    others = PolylineIndex([one.xyz for one in true if one.facts["type"] == OTHER])
    for wall, facts in seen.lines:
        at = middle_positions(wall.line + origin, _STEP_M)
        if np.mean(others.nearest(at, 3 * _NEAR_M).line >= 0) > 0.5:
            continue
        is_right = bool(np.mean(index.nearest(at, _NEAR_M).line >= 0) > 0.5)
        yield facts, is_right, math.sqrt(min(max(wall.long_m, 1.0), _LONGEST_M))


def _scenes(seeds: Sequence[int], length_m: float) -> Iterator[RoadScene]:
    return simulated_scenes(seeds, length_m, training_options_of)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = training_streets("wall_training", arguments, _scenes, seeds=(_SEEDS, _CHECK))
    known, check = known_faces(asked.learnt), known_faces(asked.check)
    sys.stdout.write(learn_weights(WallFacts._fields, EXPECTED, known, check))
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

"""What tells things over a carriageway from drops, people and vehicles, learnt from known streets.

``python -m processing.laboratory.road_training.clearance_training``.

Simulates streets of ``--seeds``, gathers all places on them and fits the weights of
`processing.methods.road.clearance.clearance_confidence` to which of them lie on things that hang
there; streets of ``--check`` are not learnt from. Every other street is an avenue, whose trees hang
low. Prints the weights and how many of each confidence are right.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    options_of,
    simulated_scenes,
    worn_options_of,
)
from processing.laboratory.road_training.learned_confidence import (
    LabelledThings,
    WeightPrior,
    learn_weights,
)
from processing.laboratory.road_training.training_streets import training_streets
from processing.laboratory.simulate.requests import StreetRequest
from processing.methods.road.clearance.clearance_confidence import ClearanceFacts
from processing.methods.road.clearance.street_clearance import ClearanceLimits, street_clearance
from processing.scoring.features.clearances import LIMIT_M, clearance_things, lies_on

EXPECTED = WeightPrior(
    (-3.0, *ClearanceFacts(
        points=4.0, dense=3.0, deep=2.0, under=1.0, low=-2.0, walk=-0.25, unseen=-1.5
    )),
    (2.0, *ClearanceFacts(
        points=2.0, dense=2.0, deep=2.0, under=1.0, low=2.0, walk=0.01, unseen=1.0
    )),
)  # fmt: skip
"""What reasoning expects: things fill their cubes with many points and reach inside the edge.

Nothing is learnt of walks, over which no truth is known: their weight stays."""

_SEEDS, _CHECK = "9551-9564", "9581-9584"
_WALK_M = 2.5
_AVENUES = 2


def request_of(number: int, seed: int, length_m: float) -> StreetRequest:
    """The street of a seed: styles and scanners take turns, every other one is an avenue."""
    make = worn_options_of if number % 4 > 1 else options_of
    request = replace(make(number, seed, length_m), passes=1, stops=False)
    return replace(request, avenue=number % _AVENUES == 0)


def known_places(scenes: Iterator[RoadScene]) -> LabelledThings:
    """All places over the carriageways of some streets, and which of them are right."""
    rows: list[tuple[ClearanceFacts, bool, float, int]] = []
    for number, scene in enumerate(scenes):
        limits = ClearanceLimits(LIMIT_M, _WALK_M)
        found = street_clearance(scene.drives, limits, SilentMonitor())
        true = clearance_things(read_mapped(scene.truth("clearance")), LIMIT_M)
        for place in found.places:
            if not place.is_walk:
                is_right = any(lies_on(np.asarray(place.xyz), thing) for thing in true)
                rows.append((place.facts, is_right, 1.0, number))
        sys.stderr.write(f"{scene.name}: {len(rows)} places\n")
    return LabelledThings.of(rows, len(ClearanceFacts._fields))


def _scenes(seeds: Sequence[int], length_m: float) -> Iterator[RoadScene]:
    return simulated_scenes(seeds, length_m, request_of)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = training_streets("clearance_training", arguments, _scenes, seeds=(_SEEDS, _CHECK))
    known, check = known_places(asked.learnt), known_places(asked.check)
    sys.stdout.write(learn_weights(ClearanceFacts._fields, EXPECTED, known, check))
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

"""What tells covers from other shapes in a road, learnt from known streets.

``python -m processing.laboratory.road_training.cover_training``.

Simulates streets of ``--seeds``, looks for all shapes with an edge in their roads and walks and
fits the weights of `processing.methods.road.covers.cover_confidence` to which of them are covers;
streets of ``--check`` are not learnt from. Prints the weights and how many of each confidence are
right.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from processing.core.arrays import Floats
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
from processing.methods.road.covers.cover_confidence import RoadCoverFacts
from processing.methods.road.covers.street_covers import seen_covers
from processing.scoring.features.mapped_features import MappedFeature

EXPECTED = WeightPrior(
    (
        -6.0,
        *RoadCoverFacts(
            clear=1.0, toned=1.0, raised=1.0, sunk=0.3, open=8.0, bright=-3.0, step=-2.0,
            uneven=-2.0, rough=-1.0, mixed=-1.0, sharp=1.0, usual=0.5, missing=-4.0, small=-3.0,
            large=-2.0, long=-0.5, filled=1.0,
        ),
    ),
    (
        6.0,
        *RoadCoverFacts(
            clear=1.5, toned=1.5, raised=1.5, sunk=0.75, open=12.0, bright=4.5, step=3.0,
            uneven=3.0, rough=1.5, mixed=1.5, sharp=2.0, usual=1.0, missing=6.0, small=4.5,
            large=3.0, long=0.75, filled=1.5,
        ),
    ),
)  # fmt: skip
"""What reasoning expects: covers have a clear edge and another tone than the road, stand a little
out of it or are open, and the road about them is even."""

_SEEDS, _CHECK = "9601-9606,9616-9622", "9651-9654"
_STYLES = ("urban", "urban", "rural")
_TURNS = 60  # of styles, scanners and wear: all of them come in each combination
_NEAR_M, _ALIKE = 0.15, 1.3
"""A shape is a cover if it lies so near to one and is as large; what is near and larger or smaller
by more says nothing either way."""


def known_covers(scenes: Iterator[RoadScene]) -> LabelledThings:
    """All shapes in the roads of some streets."""
    rows: list[tuple[RoadCoverFacts, bool, float, int]] = []
    for number, scene in enumerate(scenes):
        rows += [(*one, 1.0, number) for one in _judge_covers(scene)]
        sys.stderr.write(f"{scene.name}: {len(rows)} shapes\n")
    return LabelledThings.of(rows, len(RoadCoverFacts._fields))


def _judge_covers(scene: RoadScene) -> Iterator[tuple[RoadCoverFacts, bool]]:
    seen = seen_covers(scene.drives, SilentMonitor())
    if seen.raster is None:
        return
    origin = seen.raster.road.plan.origin[:2]
    true = read_mapped(scene.truth("covers")).features
    middles = np.array([one.xyz[:, :2].mean(axis=0) for one in true]).reshape(-1, 2)
    sizes = np.array([_size_m(one) for one in true])
    for cover, facts in seen.covers:
        side = math.sqrt(cover.sides_m[0] * cover.sides_m[1])
        is_right = _is_right(cover.middle + origin, side, middles, sizes)
        if is_right is not None:
            yield facts, is_right


def _is_right(middle: Floats, side_m: float, middles: Floats, sizes: Floats) -> bool | None:
    """Whether a shape is one of the covers; None where it is a part of one."""
    if not len(middles):
        return False
    away = np.hypot(*(middles - middle).T)
    nearest = int(away.argmin())
    ratio = side_m / sizes[nearest]
    if away[nearest] < _NEAR_M and 1 / _ALIKE < ratio < _ALIKE:
        return True
    return None if away[nearest] < max(_NEAR_M, 0.7 * sizes[nearest]) else False


def _size_m(cover: MappedFeature) -> float:
    """Side of a square as large."""
    values = [cover.facts.get(name) for name in ("diameter_m", "width_m", "length_m")]
    known = [float(one) for one in values if isinstance(one, int | float)]
    return math.exp(sum(math.log(one) for one in known) / len(known))


def options_of_seed(_number: int, seed: int, length_m: float) -> StreetRequest:
    """By seed two streets in town, one in the country; every other one is worn."""
    number = (seed - 1) % _TURNS
    make = worn_options_of if number % 2 else options_of
    style = _STYLES[number % len(_STYLES)]
    return replace(make(number, seed, length_m), style=style, passes=1, stops=False)


def _scenes(seeds: Sequence[int], length_m: float) -> Iterator[RoadScene]:
    return simulated_scenes(seeds, length_m, options_of_seed)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = training_streets("cover_training", arguments, _scenes, seeds=(_SEEDS, _CHECK))
    known, check = known_covers(asked.learnt), known_covers(asked.check)
    sys.stdout.write(learn_weights(RoadCoverFacts._fields, EXPECTED, known, check))
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

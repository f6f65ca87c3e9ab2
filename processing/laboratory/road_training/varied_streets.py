"""Streets to learn from that differ in what stands there and in how they were recorded.

Some by scanners of the catalogue, some by scanners of any kind and mounting, avenues and usual
streets, worn ones and less exactly driven ones.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence

from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    avenue_options_of,
    recorded_scene,
    worn_options_of,
)
from processing.laboratory.road_training.training_streets import TrainingStreets
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.simulate.scanning.any_mounting import any_sensor

_SEEDS = ",".join(f"{2001 + 2 * n},{2002 + 2 * n},{2101 + n}" for n in range(36))
_CHECK = "9381-9389"
_LENGTH_M, _KINDS = 60.0, 3


def varied_streets(
    parser: argparse.ArgumentParser, arguments: Sequence[str] | None
) -> TrainingStreets:
    """The streets that a command was told to learn from and to check with."""
    parser.add_argument("--seeds", default=_SEEDS, help="streets to learn from")
    parser.add_argument("--check", default=_CHECK, help="streets to check with")
    parser.add_argument("--length", type=float, default=_LENGTH_M, help="m of each")
    asked = parser.parse_args(arguments)
    return TrainingStreets(
        varied_scenes(seeds_of(asked.seeds), asked.length),
        varied_scenes(seeds_of(asked.check), asked.length),
    )


def varied_scenes(seeds: Sequence[int], length_m: float = _LENGTH_M) -> Iterator[RoadScene]:
    """Streets of seeds: an avenue, one by a scanner of any kind, and a worn street in turns."""
    for number, seed in enumerate(seeds):
        turn, kind = divmod(number, _KINDS)
        if kind == _KINDS - 1:
            request, is_any = worn_options_of(turn, seed, length_m), turn % 2 == 1
        else:
            request, is_any = avenue_options_of(turn + 2 * kind, seed, length_m), kind == 1
        with recorded_scene(request, any_sensor(seed) if is_any else None) as scene:
            yield scene

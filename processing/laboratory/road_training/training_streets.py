"""Streets that something is learnt from, and others that it is checked with, as a command asks."""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    given_scenes,
    simulated_scenes,
    worn_options_of,
)


@dataclass(frozen=True)
class TrainingStreets:
    """Both kinds of streets, made one after the other when they are asked for."""

    learnt: Iterator[RoadScene]
    check: Iterator[RoadScene]


def training_streets(
    module: str,
    arguments: Sequence[str] | None,
    scenes: Callable[[Sequence[int], float], Iterator[RoadScene]] = simulated_scenes,
    seeds: tuple[str, str] = ("500-529", "530-539"),
    worn: str = "",
) -> TrainingStreets:
    """What the command of a module of `processing.laboratory.road_training` was told.

    Parameters
    ----------
    scenes : callable
        Makes streets of seeds and a length, m.
    seeds : (str, str)
        Of streets to learn from and to check with, if nothing else is asked.
    worn : str
        Of streets with worn stones to learn from, too.
    """
    parser = argparse.ArgumentParser(prog=f"python -m processing.laboratory.road_training.{module}")
    parser.add_argument("--seeds", default=seeds[0], help="streets to learn from")
    parser.add_argument("--check", default=seeds[1], help="streets to check with")
    parser.add_argument("--length", type=float, default=60.0, help="m of each")
    parser.add_argument("--worn", default=worn, help="streets of worn stones to learn from")
    parser.add_argument("--deliveries", type=Path, nargs="*", default=[])
    asked = parser.parse_args(arguments)
    laid = scenes(_seeds(asked.seeds), asked.length)
    settled = simulated_scenes(_seeds(asked.worn), asked.length, worn_options_of)
    return TrainingStreets(
        itertools.chain(laid, settled, given_scenes(asked.deliveries)),
        scenes(_seeds(asked.check), asked.length),
    )


def _seeds(text: str) -> range:
    """Numbers from one to another; of nothing none."""
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1) if first else range(0)

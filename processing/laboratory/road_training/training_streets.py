"""Streets that something is learnt from, and others that it is checked with, as a command asks."""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    given_scenes,
    options_of,
    simulated_scenes,
    worn_options_of,
)
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.simulate.requests import StreetRequest

RequestOf = Callable[[int, int, float], StreetRequest]
"""Makes the request of a street from its number, its seed and its length, m."""


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
    others: Mapping[str, tuple[str, RequestOf]] | None = None,
    *,
    length_m: float = 60.0,
) -> TrainingStreets:
    """What the command of a module of `processing.laboratory.road_training` was told.

    Parameters
    ----------
    scenes : callable
        Makes streets of seeds and a length, m.
    seeds : (str, str)
        Of streets to learn from and to check with, if nothing else is asked.
    others : mapping, optional
        By the name of an option, seeds of other streets to learn from, and what makes requests of
        them.
    length_m : float
        Of each, if nothing else is asked.
    """
    parser = argparse.ArgumentParser(prog=f"python -m processing.laboratory.road_training.{module}")
    parser.add_argument("--seeds", default=seeds[0], help="streets to learn from")
    parser.add_argument("--check", default=seeds[1], help="streets to check with")
    parser.add_argument("--length", type=float, default=length_m, help="m of each")
    for name, (default, _) in (others or {}).items():
        parser.add_argument(f"--{name}", default=default, help=f"{name} streets to learn from")
    parser.add_argument("--deliveries", type=Path, nargs="*", default=[])
    asked = parser.parse_args(arguments)
    laid = scenes(seeds_of(asked.seeds), asked.length)
    more = (
        simulated_scenes(seeds_of(getattr(asked, name)), asked.length, request_of)
        for name, (_, request_of) in (others or {}).items()
    )
    return TrainingStreets(
        itertools.chain(laid, *more, given_scenes(asked.deliveries)),
        scenes(seeds_of(asked.check), asked.length),
    )


def training_options_of(_number: int, seed: int, length_m: float) -> StreetRequest:
    """Styles and sensors by seed; every other street is worn and less exactly driven."""
    make = worn_options_of if seed % 2 else options_of
    return replace(make(seed % 12, seed, length_m), seed=seed)

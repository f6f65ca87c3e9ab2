"""Makes the models for clouds from the air anew and says what they reach.

``python -m processing.laboratory.class_training.aerial``

Needs the extra ``train``. Landscapes of every kind are flown over at all distances between points
from 0.2 to 2.5 m, with power lines, with and without numbers of returns; those of
``--seeds`` are learnt from, those of ``--check`` only scored. ``--score-only`` leaves the models as
they are. The same seeds give the same models.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.class_training.examples import (
    LabelledCells,
    codes_of_cells,
    points_above_ground,
)
from processing.laboratory.class_training.fitting import ForestSize
from processing.laboratory.class_training.two_forests import (
    FOLDS,
    ForestPlan,
    SampledCells,
    make_two_forests,
)
from processing.laboratory.progress_lines import say
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.simulate.airborne.flight import (
    CROWN,
    LOW_PLANT,
    FlightPoints,
    fly_over,
)
from processing.laboratory.simulate.airborne.landscapes import KINDS, landscape_of
from processing.laboratory.simulate.airborne.power_lines import HIGH, LOW, power_line
from processing.methods.classes.aerial_cells import AerialPoints, aerial_cells
from processing.methods.classes.class_models import (
    AERIAL_AGAIN,
    AERIAL_ALONE,
    aerial_models,
)
from processing.methods.classes.drive_classes import shares_of_cells
from processing.scoring.points.class_scores import class_score
from processing.scoring.points.confusion_matrix import ConfusionMatrix

_PLAN = ForestPlan(
    AERIAL_ALONE,
    ForestSize(rounds=40, leaves=31, rate=0.2),
    AERIAL_AGAIN,
    ForestSize(rounds=30, leaves=24, rate=0.2),
)

_CELLS = 700
"""Of each class and flight that are learnt from."""

_LEAVES = (LOW_PLANT, CROWN)
_FINEST_M, _COARSEST_M = 0.2, 2.5
_MOST_PULSES = 300_000
"""Of a strip: a landscape is as small as that asks, and no larger than 300 m."""

_LEAST_EXTENT_M, _MOST_EXTENT_M = 90.0, 300.0

_POSITION_M, _HEIGHT_M = (0.02, 0.2), (0.01, 0.05)
"""Standard deviations of points in plan and in height: scanners of today and of the year 2000."""

_WITHOUT_RETURNS = 0.3
"""Share of flights that don't tell which return of its pulse a point is."""

_SPLIT_SOLID, _SPLIT_LEAVES = 0.2, 0.8
"""Most of the returns of solid things, and of leaves, that are one of several of their pulse: edges
and wires beside a roof give a second one, and crowns more than the first and the last."""


@dataclass(frozen=True)
class _Flight:
    """A landscape as it was flown over, and its cells."""

    name: str
    points: AerialPoints
    cells: LabelledCells
    truth: NDArray[np.uint8]


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the models, or only score those that are there."""
    parser = argparse.ArgumentParser(prog="python -m processing.laboratory.class_training.aerial")
    parser.add_argument("--seeds", default="4000-4009", help="of each kind, learnt from")
    parser.add_argument("--check", default="4100-4101", help="of each kind, only scored")
    parser.add_argument("--score-only", action="store_true")
    options = parser.parse_args(arguments)
    if not options.score_only:
        _make(seeds_of(options.seeds))
    for flight in _flights(seeds_of(options.check)):
        say(_score_line(flight))
    return 0


def _flights(seeds: Sequence[int]) -> Iterator[_Flight]:
    for seed in seeds:
        for number, kind in enumerate(sorted(KINDS)):
            yield _flight(kind, seed, np.random.default_rng((seed, number)))


def _flight(kind: str, seed: int, rng: np.random.Generator) -> _Flight:
    spacing_m = float(np.exp(rng.uniform(np.log(_FINEST_M), np.log(_COARSEST_M))))
    extent_m = float(np.clip(spacing_m * _MOST_PULSES**0.5, _LEAST_EXTENT_M, _MOST_EXTENT_M))
    land = landscape_of(kind, seed, extent_m)
    shaken = (float(np.exp(rng.uniform(*np.log(_POSITION_M)))), rng.uniform(*_HEIGHT_M))
    parts = [fly_over(land, seed, spacing_m, shaken)]
    parts += [power_line(land, seed, spacing_m, style) for style in (LOW, HIGH)]
    flown = FlightPoints(*(np.concatenate(one) for one in zip(*parts, strict=True)))
    knows_returns = rng.random() >= _WITHOUT_RETURNS
    is_last, is_only = _returns_of(flown, rng)
    points = points_above_ground(
        flown.xyz, is_last | (not knows_returns), is_only | (not knows_returns)
    )
    # Two strips cross: the points lie closer than the pulses of each.
    cells = aerial_cells(points, extent_m / len(flown.xyz) ** 0.5, SilentMonitor())
    labelled = LabelledCells(cells, codes_of_cells(cells, flown.codes))
    return _Flight(f"{kind} {seed}, {spacing_m:.2f} m", points, labelled, flown.codes)


def _returns_of(
    flown: FlightPoints, rng: np.random.Generator
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which returns are their pulse's last, and its only one, where pulses meet more than one."""
    most = np.where(np.isin(flown.codes, _LEAVES), _SPLIT_LEAVES, _SPLIT_SOLID)
    is_split = (flown.returns <= 1) & (rng.random(flown.codes.size) < most * rng.random())
    is_last = (flown.number >= flown.returns) & ~(is_split & (rng.random(is_split.size) < 0.5))
    return is_last, (flown.returns <= 1) & ~is_split


def _make(seeds: Sequence[int]) -> None:
    rng = np.random.default_rng(0)
    folds: list[list[SampledCells]] = [[] for _ in range(FOLDS)]
    for number, flight in enumerate(_flights(seeds)):
        folds[number % FOLDS].append(SampledCells.of(flight.cells, _CELLS, rng))
        say(f"learnt from {flight.name}")
    make_two_forests(folds, _PLAN)
    aerial_models.cache_clear()


def _score_line(flight: _Flight) -> str:
    cells = flight.cells.cells
    shares = shares_of_cells(cells, aerial_models(), SilentMonitor())
    found = aerial_models().again.codes[shares.argmax(axis=1)][cells.cell_of]
    score = class_score(ConfusionMatrix.of(flight.truth, found))
    by_class = " ".join(f"{one.id}:{one.counts.f_measure:.2f}" for one in score.classes)
    return f"{flight.name:24s} {by_class}"


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

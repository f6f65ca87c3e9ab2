"""What tells edges of the carriageway without a step, learnt from known streets.

``python -m processing.laboratory.road_training.edge_training``.

Simulates streets of ``--seeds``, most of them without curbs, and others of ``--curbed`` with them;
fits and writes the model of `processing.methods.road.edges.edge_facts` to which places beside the
ways are edges or feet of curbs, then the weights of `processing.methods.road.edges.edge_confidence`
to which lines are edges. Streets of ``--check`` are not learnt from. Prints the weights and how
many of each confidence are right. Needs the extra ``train``.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    options_of,
    simulated_scenes,
    worn_options_of,
)
from processing.laboratory.noise_training.fitting import TreesSize
from processing.laboratory.road_training.boosted_confidence import learn_model
from processing.laboratory.road_training.learned_confidence import (
    LabelledThings,
    WeightPrior,
    learn_weights,
)
from processing.laboratory.road_training.training_streets import TrainingStreets, training_streets
from processing.laboratory.simulate.requests import StreetRequest
from processing.methods.road.edges.edge_confidence import EdgeLineFacts
from processing.methods.road.edges.edge_facts import MODEL, EdgeFacts
from processing.methods.road.edges.fact_kernels import CELL_M, NOT_SEEN
from processing.methods.road.edges.street_edges import SeenEdges, seen_edges
from processing.methods.road.objects.survey import survey_ground
from processing.scoring.features.asked_lines import is_seen
from processing.scoring.features.edges import LIMITS, TOLERANCE_M
from processing.scoring.features.line_positions import PolylineIndex, middle_positions
from processing.scoring.features.mapped_features import MappedFeature
from processing.scoring.features.typed_lines import OTHER

SIZE = TreesSize(
    trees=90,
    leaves=14,
    rate=0.1,
    signs=(1, 1, 0, 1, 0, -1, 0, 0, 0, 1, -1, 0, 1, 1, 0),
)
"""More change at a place and beyond it can only speak for an edge, what is unlike the lane inside
only against it."""

EXPECTED_OF_LINES = WeightPrior(
    (
        -5.0,
        *EdgeLineFacts(long=0.5, sure=4.0, restless=-2.0, unlike=-1.0, uneven=-1.0, rough=1.0),
    ),
    (
        4.0,
        *EdgeLineFacts(long=0.5, sure=4.0, restless=3.0, unlike=2.0, uneven=2.0, rough=2.0),
    ),
)
"""What reasoning expects of lines: long, straight ones, sure at every station."""

_SEEDS, _CHECK, _CURBED = "3001-3026,3061-3074", "3031-3036", "3041-3052,3091-3097"
_STYLES, _CURBED_STYLES = ("urban", "rural", "highway"), ("rural", "highway", "rural", "urban")
_CURBS_OF = 4
"""Every fourth street has the curbs that such streets have."""

_ON_M, _OFF_M = 0.04, 0.12
"""Places so near to an edge are edges, those farther off are none; nothing is learnt between."""

_SAMPLED, _WRONG_SHARE = 12, 4.0
"""One of so many wrong places is learnt from, but all that look like edges; and what all wrong
places weigh over all right ones."""

_LOOKS_LIKE = -2.0
_OUTSIDE_M = 0.3
_LONGEST_M = 16.0


def known_places(scenes: Iterator[RoadScene]) -> LabelledThings:
    """Places beside the ways of some streets."""
    return _known(scenes, _judge_places, len(EdgeFacts._fields))


def known_lines(scenes: Iterator[RoadScene]) -> LabelledThings:
    """All lines on some streets."""
    return _known(scenes, _judge_lines, len(EdgeLineFacts._fields))


_Row = tuple[Sequence[float], bool, float]
_Judge = Callable[[SeenEdges, RoadScene], Iterator[_Row]]


def _known(scenes: Iterator[RoadScene], judge: _Judge, facts: int) -> LabelledThings:
    rows: list[tuple[Sequence[float], bool, float, int]] = []
    for number, scene in enumerate(scenes):
        below = survey_ground(scene.drives, SilentMonitor())
        seen = seen_edges(scene.drives, below, SilentMonitor())
        rows += [(*one, number) for one in judge(seen, scene)]
        sys.stderr.write(f"{scene.name}: {len(rows)} in all\n")
    known = LabelledThings.of(rows, facts)
    known.worth[:] /= known.worth.mean() if rows else 1.0
    return known


def _lines_of(scene: RoadScene) -> tuple[list[Floats], list[Floats]]:
    """Lines that are edges or feet of curbs, and those by which nothing is learnt."""
    edges = read_mapped(scene.truth("edges")).features
    curbs = read_mapped(scene.truth("curbs")).features
    true = [part for one in edges if one.facts["type"] != OTHER for part in _seen_parts(one)]
    rest = [one.xyz for one in edges if one.facts["type"] == OTHER]
    rest += [one.xyz for one in edges if one.facts["type"] != OTHER]
    for one in curbs:
        is_foot = one.facts.get("edge") == "lower" and one.facts.get("role") == "road"
        (true if is_foot else rest).append(one.xyz)
    return true, rest


def _seen_parts(edge: MappedFeature) -> Iterator[Floats]:
    pieces = len(edge.xyz) - 1
    asked = is_seen(edge, pieces, LIMITS.least_points)
    for number in np.flatnonzero(asked).tolist():
        yield edge.xyz[number : number + 2]


def _judge_places(seen: SeenEdges, scene: RoadScene) -> Iterator[_Row]:
    if seen.plan is None or seen.cells is None or seen.places is None:
        return
    true, rest = _lines_of(scene)
    on, beside = PolylineIndex(true), PolylineIndex(rest)
    ways, facts = seen.cells.ways, seen.places.facts
    random = np.random.default_rng(1)
    for side in range(2):
        station, cell = np.nonzero(facts[:, side, :, 0] != NOT_SEEN)
        left = np.asarray(cell * CELL_M * (1 if side == 0 else -1), np.float64)
        places = np.column_stack([ways.beside(station, left), np.zeros(len(cell))])
        places += seen.plan.origin
        off = on.nearest(places, _OFF_M).off_m
        is_right = off <= _ON_M
        is_left_out = (beside.nearest(places, LIMITS.beside_m).line >= 0) | (off <= _OFF_M)
        # The chance that it ends there if it didn't before: what lies outside tells nothing.
        wrong = ~is_right & ~is_left_out & ~_is_outside(station, cell, is_right)
        hard = seen.places.outward[station, side, cell] > _LOOKS_LIKE
        wrong &= hard | (random.random(len(cell)) < 1.0 / _SAMPLED)
        worth = np.where(hard, 1.0, _SAMPLED)
        total = _WRONG_SHARE * max(int(is_right.sum()), 1)
        worth = worth * total / max(float(worth[wrong].sum()), 1.0)
        for k in np.flatnonzero(is_right | wrong).tolist():
            row = facts[station[k], side, cell[k]].tolist()
            yield row, bool(is_right[k]), 1.0 if is_right[k] else float(worth[k])


def _is_outside(station: Integers, cell: Integers, is_right: Flags) -> Flags:
    """Places well outside of the edge of their station."""
    farthest = np.full(int(station.max(initial=0)) + 1, np.inf)
    edges = np.flatnonzero(is_right)
    farthest[station[edges]] = cell[edges] * CELL_M + _OUTSIDE_M
    return np.asarray(cell * CELL_M > farthest[station])


def _judge_lines(seen: SeenEdges, scene: RoadScene) -> Iterator[_Row]:
    if seen.plan is None:
        return
    edges = read_mapped(scene.truth("edges")).features
    true = PolylineIndex([one.xyz for one in edges if one.facts["type"] != OTHER])
    rest = PolylineIndex([one.xyz for one in edges if one.facts["type"] == OTHER])
    for line, facts in seen.lines:
        at = middle_positions(line.line + seen.plan.origin, 0.2)
        if len(line.line) < 2 or np.mean(rest.nearest(at, LIMITS.beside_m).line >= 0) > 0.5:
            continue
        is_right = bool(np.mean(true.nearest(at, TOLERANCE_M).line >= 0) > 0.5)
        yield facts, is_right, math.sqrt(min(max(line.length_m, 1.0), _LONGEST_M))


def edge_options_of(number: int, seed: int, length_m: float) -> StreetRequest:
    """Styles, scanners, wear and curbs take turns."""
    make = worn_options_of if number % 2 else options_of
    return replace(
        make(number, seed, length_m),
        style=_STYLES[number % len(_STYLES)],
        passes=1,
        stops=False,
        flush=number % _CURBS_OF != _CURBS_OF - 1,
    )


def curbed_options_of(number: int, seed: int, length_m: float) -> StreetRequest:
    """The same with the curbs and open gutters that such streets have."""
    style = _CURBED_STYLES[number % len(_CURBED_STYLES)]
    return replace(edge_options_of(number, seed, length_m), style=style, flush=False)


def _scenes(seeds: Sequence[int], length_m: float) -> Iterator[RoadScene]:
    return simulated_scenes(seeds, length_m, edge_options_of)


def _streets(arguments: Sequence[str] | None) -> TrainingStreets:
    others = {"curbed": (_CURBED, curbed_options_of)}
    seeds = (_SEEDS, _CHECK)
    return training_streets("edge_training", arguments, _scenes, seeds=seeds, others=others)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = _streets(arguments)
    places, check = known_places(asked.learnt), known_places(asked.check)
    sys.stdout.write(f"{learn_model(MODEL, places, check, SIZE)}\n\n")
    asked = _streets(arguments)  # lines follow from the model
    lines, check = known_lines(asked.learnt), known_lines(asked.check)
    sys.stdout.write(learn_weights(EdgeLineFacts._fields, EXPECTED_OF_LINES, lines, check))
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

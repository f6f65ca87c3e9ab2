"""What tells barriers from other long thin things, learnt from known streets.

``python -m processing.laboratory.road_training.barrier_training``.

Simulates streets of ``--seeds``, follows all strips on them and fits the weights of
`processing.methods.road.barriers.barrier_confidence` to which of their windows show barriers, those
of rails and those of sheets apart; streets of ``--check`` are not learnt from. Prints the weights
and how many of each confidence are right.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

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
from processing.methods.road.barriers.barrier_confidence import (
    BarrierGroup,
    ChanceTerms,
    StretchTerms,
    group_of,
    stretch_terms_of,
    terms_of,
)
from processing.methods.road.barriers.barrier_facts import WindowFacts
from processing.methods.road.barriers.street_barriers import (
    SeenStrips,
    likely_stretches,
    seen_strips,
)
from processing.methods.road.barriers.strip_profiles import COLUMN_M
from processing.scoring.features.line_positions import PolylineIndex, middle_positions
from processing.scoring.features.typed_lines import OTHER


def _expected(**others: float) -> ChanceTerms:
    usual = ChanceTerms(
        short=-2, tall=-1, high=-2, batter=0.5, clean=1, full=1, even=1.5, over=-1, fill=1,
        low=0.5, rows=1, rough=-2, lean=-2, toe=0.1, through=1, free=-1, hidden=-1, roofed=-1,
        rise=-1, banked=-2, across=-3, far=-1.5, long=1,
    )  # fmt: skip
    return usual._replace(**others)


_OFF = (3.0, *ChanceTerms(*[2.0] * len(ChanceTerms._fields)))

EXPECTED: Mapping[BarrierGroup, WeightPrior] = {
    "rails": WeightPrior(
        (-2.0, *_expected(tall=-3, full=4, fill=2, low=-2, across=-4, rise=-1.5)), _OFF
    ),
    "leaning": WeightPrior(
        (-3.0, *_expected(rough=-4, batter=3, lean=-4, toe=0.5, hidden=-0.5, long=3)), _OFF
    ),
    "nets": WeightPrior((-2.0, *_expected(rough=-4, lean=-3, through=2, rise=-1)), _OFF),
    "walls": WeightPrior((-3.0, *_expected(rough=-4, through=2, long=3)), _OFF),
    "screens": WeightPrior(
        (-3.0, *_expected(tall=1, high=-3, rough=-4, lean=-3, hidden=0.5, long=3)), _OFF
    ),
}
"""What reasoning expects: barriers are even, flat, run along the road, and stand free."""

EXPECTED_STRETCH = WeightPrior((-1.0, 1.0, 0.3), (2.0, 1.0, 0.3))
"""The same of whole stretches: sure and long ones are right."""

_STEP_M = 0.2
_SEEDS, _CHECK = "9310-9339", "9340-9345"
_STYLES = ("urban", "rural", "highway")
_NEAR_M = 0.25
"""A window shows a barrier if most of it lies so near to one: a beam hangs before its posts."""

_BESIDE_SHARE, _SAME_TOP_M, _GLASS_M = 0.3, 0.25, 1.6
"""Height of the clear panes on noise walls, which aren't measured."""


class KnownWindow(NamedTuple):
    """Facts of a window, whether it shows a barrier, and the number of its street."""

    facts: WindowFacts
    is_right: bool
    street: int


def request_of(number: int, seed: int, length_m: float) -> StreetRequest:
    """The street of a seed: styles and scanners take turns, every other one is worn."""
    make = worn_options_of if number % 2 else options_of
    style = _STYLES[number % len(_STYLES)]
    return replace(make(number, seed, length_m), style=style, passes=1, stops=False)


class KnownStreets(NamedTuple):
    """Windows of some streets, and stretches as the present weights find them."""

    windows: list[KnownWindow]
    stretches: LabelledThings


def known_streets(scenes: Iterator[RoadScene]) -> KnownStreets:
    """All windows of strips on some streets, and the stretches that are likely barriers."""
    known: list[KnownWindow] = []
    rows: list[tuple[StretchTerms, bool, float, int]] = []
    for number, scene in enumerate(scenes):
        seen = seen_strips(scene.drives, SilentMonitor())
        known += [KnownWindow(*one, number) for one in judge_windows(scene, seen)]
        rows += [(*one, 1.0, number) for one in judge_stretches(scene, seen)]
        sys.stderr.write(f"{scene.name}: {len(known)} windows, {len(rows)} stretches\n")
    return KnownStreets(known, LabelledThings.of(rows, len(StretchTerms._fields)))


def judge_stretches(scene: RoadScene, seen: SeenStrips) -> Iterator[tuple[StretchTerms, bool]]:
    """The stretches on a street, but for those on barriers that stand on walls."""
    true = read_mapped(scene.truth("barriers")).features
    index = PolylineIndex([one.xyz for one in true if one.facts["type"] != OTHER])
    others = PolylineIndex([one.xyz for one in true if one.facts["type"] == OTHER])
    for one in likely_stretches(seen, SilentMonitor()):
        at = middle_positions(one.line + seen.origin, _STEP_M)
        if (others.nearest(at, 2 * _NEAR_M).line >= 0).mean() <= _BESIDE_SHARE:
            is_right = bool((index.nearest(at, _NEAR_M).line >= 0).mean() > 0.5)
            yield stretch_terms_of(one.chance, one.long_m), is_right


def judge_windows(scene: RoadScene, seen: SeenStrips) -> Iterator[tuple[WindowFacts, bool]]:
    """The windows on a street, but for those on barriers that stand on walls.

    Of the tops that a window on a barrier may have, the one nearest to the true height is right;
    nothing is learnt from the others. Those of other windows are all wrong.
    """
    true = read_mapped(scene.truth("barriers")).features
    known = [one for one in true if one.facts["type"] != OTHER]
    index = PolylineIndex([one.xyz for one in known])
    others = PolylineIndex([one.xyz for one in true if one.facts["type"] == OTHER])
    for profile, windows in seen.strips:
        nodes = np.column_stack([profile.nodes, np.zeros(len(profile.nodes))]) + seen.origin
        near = index.nearest(nodes, _NEAR_M).line
        beside = others.nearest(nodes, 2 * _NEAR_M).line >= 0
        for window in windows:
            first = int(window.first * COLUMN_M * 2)
            part = slice(first, max(first + 1, int(window.last * COLUMN_M * 2)))
            if beside[part].mean() > _BESIDE_SHARE:
                continue
            on = near[part][near[part] >= 0]
            if on.size <= (part.stop - part.start) / 2:
                yield from ((one, False) for one in window.options)
                continue
            facts = known[int(np.bincount(on).argmax())].facts
            high = float(str(facts["height_m"]))
            best = min(window.options, key=lambda one: abs(one.top - high))
            lower = _GLASS_M if facts["type"] == "noise_barrier" else _SAME_TOP_M
            if -lower < best.top - high < _SAME_TOP_M:
                yield best, True


def _labelled(known: Sequence[KnownWindow], group: BarrierGroup) -> LabelledThings:
    rows = [
        (terms_of(facts), is_right, 1.0, street)
        for facts, is_right, street in known
        if group_of(facts) == group
    ]
    return LabelledThings.of(rows, len(ChanceTerms._fields))


def _scenes(seeds: Sequence[int], length_m: float) -> Iterator[RoadScene]:
    return simulated_scenes(seeds, length_m, request_of)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = training_streets("barrier_training", arguments, _scenes, seeds=(_SEEDS, _CHECK))
    known, check = known_streets(asked.learnt), known_streets(asked.check)
    for group, expected in EXPECTED.items():
        own, others = _labelled(known.windows, group), _labelled(check.windows, group)
        sys.stdout.write(f"{group}\n")
        sys.stdout.write(learn_weights(ChanceTerms._fields, expected, own, others))
    sys.stdout.write("stretches\n")
    sys.stdout.write(
        learn_weights(StretchTerms._fields, EXPECTED_STRETCH, known.stretches, check.stretches)
    )
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

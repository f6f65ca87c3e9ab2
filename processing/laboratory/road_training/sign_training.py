"""What tells road signs from other flat things, learnt from known streets.

``python -m processing.laboratory.road_training.sign_training``.

Simulates streets of ``--seeds``, avenues of ``--avenues`` and streets of ``--scored``, which were
scored once and are fresh no longer, finds plates on them without leaving any out, and fits the
weights of `processing.methods.road.signs.sign_confidence` to which of them are signs; streets of
``--check`` are not learnt from. ``--deliveries`` are further streets to learn
from, recorded before. Prints the weights and how many plates of each confidence are signs: of
streets learnt from by weights that were fitted without the street itself.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    avenue_options_of,
    options_of,
    simulated_scenes,
)
from processing.laboratory.accuracy.road.signs import LENGTH_M, fast_options_of, options_of_seed
from processing.laboratory.road_training.learned_confidence import (
    LabelledThings,
    WeightPrior,
    learn_weights,
)
from processing.laboratory.road_training.training_streets import training_streets
from processing.laboratory.simulate.requests import StreetRequest
from processing.methods.road.signs.road_signs import road_signs
from processing.methods.road.signs.sign_confidence import SignFacts
from processing.scoring.features.object_matches import positions_of

EXPECTED = WeightPrior(
    (
        -5.0,
        *SignFacts(
            bright=5.0,
            cost=-1.0,
            explained=3.0,
            sectors=4.0,
            turns=1.5,
            open_ends=2.0,
            noise=-2.0,
            low=-3.0,
            askew=-1.0,
            is_plain=-2.0,
            is_large=-1.0,
            high=-2.0,
            across=-1.0,
            thick=-2.5,
            narrow=-2.0,
            other_disc=-5.0,
            unheld=-1.5,
            painted=-3.0,
            cut=-2.5,
            averted=-2.5,
            over_board=-4.0,
            faint=-4.0,
        ),
    ),
    (
        3.0,
        *SignFacts(
            bright=2.0,
            cost=0.4,
            explained=2.0,
            sectors=2.5,
            turns=1.5,
            open_ends=2.0,
            noise=2.0,
            low=2.0,
            askew=1.0,
            is_plain=1.5,
            is_large=1.0,
            high=1.5,
            across=1.0,
            thick=0.7,
            narrow=1.5,
            other_disc=0.7,
            unheld=1.0,
            painted=0.7,
            cut=0.7,
            averted=1.0,
            over_board=0.7,
            faint=1.5,
        ),
    ),
)
"""Before anything is learnt: a face shines, an outline fits and is seen all round. How badly ends
fit says little: passes that lie centimetres apart disagree, and no street here has such. What is
neither a face nor metal is no sign, and few things are cut by the ends of recordings."""

_SEEDS, _AVENUES, _SCORED, _CHECK = "700-711", "600-605", "8191-8200,8211-8230", "780-785"
"""Streets that the weights were learnt from, and such that they were looked at with."""

_WITHIN_M, _BESIDE_M = 0.15, 0.7
"""Of a true plate's centre: as near as a sign is to be in its place; what lies farther off and
nearer than the other is a sign out of its place, and nothing is learnt from it."""


def known_plates(scenes: Iterator[RoadScene]) -> LabelledThings:
    """All plates on some streets, and which of them are signs."""
    rows: list[tuple[SignFacts, bool, float, int]] = []
    for number, scene in enumerate(scenes):
        rows += [(*one, number) for one in _judged(scene)]
        sys.stderr.write(f"{scene.name}: {len(rows)} plates\n")
    return LabelledThings.of(rows, len(SignFacts._fields))


def _judged(scene: RoadScene) -> Iterator[tuple[SignFacts, bool, float]]:
    true = positions_of(read_mapped(scene.truth("signs")).features)
    for one in road_signs(scene.drives, SilentMonitor()):
        away = np.linalg.norm(true - one.centre, axis=1).min(initial=np.inf)
        if away <= _WITHIN_M or away > _BESIDE_M:
            yield one.facts, bool(away <= _WITHIN_M), 1.0


def training_options_of(_number: int, seed: int, length_m: float) -> StreetRequest:
    """Styles and sensors by seed; among every other one are expressways driven fast."""
    return (fast_options_of if seed % 2 else options_of)(seed % 100, seed, length_m)


def _scenes(seeds: Sequence[int], length_m: float) -> Iterator[RoadScene]:
    return simulated_scenes(seeds, length_m, training_options_of)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = training_streets(
        "sign_training",
        arguments,
        _scenes,
        seeds=(_SEEDS, _CHECK),
        others={"avenues": (_AVENUES, avenue_options_of), "scored": (_SCORED, options_of_seed)},
        length_m=LENGTH_M,
    )
    known, check = known_plates(asked.learnt), known_plates(asked.check)
    sys.stdout.write(learn_weights(SignFacts._fields, EXPECTED, known, check))
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

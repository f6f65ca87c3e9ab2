"""What tells poles from other shafts, learnt from known streets.

``python -m processing.laboratory.road_training.pole_training``.

Simulates streets of ``--seeds``, half of them worn and less exactly driven, and ``--avenues``,
finds all shafts on them and fits the weights of
`processing.methods.road.poles.pole_confidence` to which of them are poles, of low and of high ones
apart; streets of ``--check`` are not learnt from. Prints the weights and how many shafts of each
confidence are right: of streets learnt from by weights that were fitted without the street itself.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.core.text import Text
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    avenue_options_of,
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
from processing.methods.road.objects.column_points import points_about
from processing.methods.road.objects.survey import survey_columns
from processing.methods.road.poles.pole_confidence import PoleFacts, facts_of, is_low
from processing.methods.road.poles.roofs import fellows_of
from processing.methods.road.poles.shaft_kernels import FREE
from processing.methods.road.poles.shaft_sides import seen_sides
from processing.methods.road.poles.shafts import Shaft, find_shafts, with_whole_sides
from processing.methods.road.poles.street_poles import (
    REACH_M,
    carried_if_likely,
    usual_noise_m,
)
from processing.methods.road.poles.surroundings import surroundings_of
from processing.scoring.features.object_matches import positions_of
from processing.scoring.features.poles import POLES

EXPECTED_LOW = WeightPrior(
    (
        *(0.0, -3, 3, -5, 4, 3, 1.5, 1, -2, -8, -8, -4, -0.1),
        *(-1, -0.5, 1, -0.1, 0.1, 0.1, 0.1, -2, -8, -3, -5),
    ),
    (
        *(4.0, 3, 3, 5, 4, 4, 1.5, 3, 2, 6, 6, 3, 0.1),
        *(2, 1, 1, 0.1, 0.1, 0.1, 0.1, 2, 8, 3, 5),
    ),
)
EXPECTED_HIGH = WeightPrior(
    (
        *(0.0, -3, 2, -4, 3, 3, 1, 1, -2, -1, -4, -2, -4),
        *(-1, -1, 1, -3, 2, 2, 3, -1, -5, -5, -5),
    ),
    (
        *(4.0, 3, 2, 4, 3, 4, 1.5, 3, 2, 2, 5, 2, 3),
        *(2, 2, 2, 3, 2, 2, 3, 2, 5, 5, 5),
    ),
)
"""A constant, and in the order of `PoleFacts`: tens of streets have few poles of each kind, so much
is left to what reasoning expects."""

_SEEDS, _AVENUES, _CHECK = "900-917", "600-615", "918-923"
"""Streets that the weights were learnt from, usual ones and avenues, and others to check with."""

_NOISE_CODES = (7, 18)

_ON_M, _NEAR_M = 0.25, 0.6
"""How near to a true pole a shaft is its own, and how near it counts neither way: a second cone
through its plates, which the surer one displaces."""


def training_options_of(_number: int, seed: int, length_m: float) -> StreetRequest:
    """Styles and sensors by seed; every other street is worn and less exactly driven."""
    make = worn_options_of if seed % 2 else options_of
    return replace(make(seed % 12, seed, length_m), seed=seed)


def label_shafts(shafts: Sequence[Shaft], true: Floats, usual_m: float) -> list[bool | None]:
    """Which shafts are poles; None of those that count neither way.

    Parameters
    ----------
    true : (n, 2) float64
        Feet of true poles, m about the plan's origin.
    usual_m : float
        Noise of the recording's smooth shafts.
    """
    labels: list[bool | None] = [False] * len(shafts)
    best: dict[int, tuple[float, int]] = {}
    for number, shaft in enumerate(shafts):
        away = np.hypot(*(true - shaft.foot[:2]).T) if len(true) else np.array([np.inf])
        nearest = int(away.argmin())
        if away[nearest] < _NEAR_M:
            labels[number] = None
        if away[nearest] < _ON_M:
            poor = shaft.noise_m / usual_m - 2 * shaft.told[FREE] + 10 * float(away[nearest])
            best[nearest] = min(best.get(nearest, (np.inf, -1)), (poor, number))
    for _, number in best.values():
        labels[number] = True
    return labels


def known_shafts(scenes: Iterator[RoadScene]) -> dict[bool, LabelledThings]:
    """All shafts on some streets, low ones under True."""
    rows: dict[bool, list[tuple[PoleFacts, bool, float, int]]] = {True: [], False: []}
    for number, scene in enumerate(scenes):
        for low, facts, is_right in _judge_shafts(scene):
            rows[low].append((facts, is_right, 1.0, number))
        sys.stderr.write(f"{scene.name}: {len(rows[True])} low, {len(rows[False])} high shafts\n")
    return {low: LabelledThings.of(rows[low], len(PoleFacts._fields)) for low in rows}


def _judge_shafts(scene: RoadScene) -> Iterator[tuple[bool, PoleFacts, bool]]:
    monitor = SilentMonitor()
    below, columns = survey_columns(scene.drives, monitor)
    plan = below.plan
    shafts = find_shafts(scene.drives, plan, columns, monitor)
    if not shafts:
        return
    truth = read_mapped(scene.truth("poles"))
    poles = truth.of_kinds(POLES, "point", Text("poles", "柱状物"))
    true = positions_of(poles)[:, :2] - plan.origin[:2]
    feet = np.array([one.foot[:2] for one in shafts])
    around = points_about(scene.drives, plan, feet, REACH_M, monitor)
    shafts = with_whole_sides(shafts, around, monitor)
    usual_m, fellows = usual_noise_m(shafts), fellows_of(shafts)
    labels = label_shafts(shafts, true, usual_m)
    codes = _codes(scene)
    for number, (shaft, label) in enumerate(zip(shafts, labels, strict=True)):
        if label is not None and not (label is False and _is_noise(shaft, codes)):
            local = around.local[around.of(number)] - shaft.foot
            beside = surroundings_of(local, shaft, usual_m, fellows[number])
            carried = carried_if_likely(around, number, shafts, usual_m)
            sides = seen_sides(scene.drives, shaft, plan.origin)
            yield is_low(shaft), facts_of(shaft, beside, carried, sides, usual_m), label


def _codes(scene: RoadScene) -> list[NDArray[np.uint8]]:
    """What each point of each drive is."""
    truth = scene.delivery / "truth"
    stems = [Path(drive.info.sources[0].path).stem for drive in scene.drives]
    return [np.load(truth / f"{stem}.labels.npy", mmap_mode="r") for stem in stems]


def _is_noise(shaft: Shaft, codes: Sequence[NDArray[np.uint8]]) -> bool:
    """Whether most of its points are noise, as mirrored poles are: another tool's task."""
    told = [codes[drive][point] for drive, point in zip(shaft.drives, shaft.points, strict=True)]
    return float(np.isin(told, _NOISE_CODES).mean()) > 0.5


def _scenes(seeds: Sequence[int], length_m: float) -> Iterator[RoadScene]:
    return simulated_scenes(seeds, length_m, training_options_of)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = training_streets(
        "pole_training",
        arguments,
        _scenes,
        (_SEEDS, _CHECK),
        others={"avenues": (_AVENUES, avenue_options_of)},
    )
    known, check = known_shafts(asked.learnt), known_shafts(asked.check)
    for low, expected in ((True, EXPECTED_LOW), (False, EXPECTED_HIGH)):
        sys.stdout.write(learn_weights(PoleFacts._fields, expected, known[low], check[low]))
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

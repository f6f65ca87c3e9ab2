"""What tells poles from other shafts, learnt from known streets.

``python -m processing.laboratory.road_training.pole_training``.

Needs the extra ``train``. Simulates the streets of ``--seeds`` (avenues and usual ones, by scanners
of the catalogue and of any kind, in turns), finds all shafts on them and fits the models of
`processing.methods.road.poles.pole_confidence` to which of them are poles, of low and of high ones
apart; streets of ``--check`` are not learnt from. Prints how many shafts of each confidence are
right: of streets learnt from by models that were fitted without some streets, it among them.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.core.text import Text
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.road_scenes import RoadScene
from processing.laboratory.noise_training.fitting import TreesSize
from processing.laboratory.road_training.boosted_confidence import learn_model
from processing.laboratory.road_training.learned_confidence import LabelledThings
from processing.laboratory.road_training.varied_streets import varied_streets
from processing.methods.road.objects.column_points import points_about
from processing.methods.road.objects.survey import survey_columns
from processing.methods.road.poles.pole_confidence import MODELS, SIGNS, PoleFacts, facts_of, is_low
from processing.methods.road.poles.shaft_kernels import FREE
from processing.methods.road.poles.shafts import Shaft, find_shafts, with_whole_sides
from processing.methods.road.poles.street_poles import (
    REACH_M,
    shafts_about_all,
    usual_noise_m,
)
from processing.methods.road.poles.trunks_among import tree_chances
from processing.scoring.features.object_matches import positions_of
from processing.scoring.features.poles import POLES

_SIZES = {
    True: TreesSize(trees=200, leaves=6, rate=0.1, least_in_a_leaf=30, signs=SIGNS),
    False: TreesSize(trees=200, leaves=4, rate=0.1, least_in_a_leaf=60, signs=SIGNS),
}
"""Of low shafts and of high ones: of the low ones two in a hundred are poles, as many as one small
leaf holds."""

_NOISE_CODES = (7, 18)

_ON_M, _NEAR_M = 0.25, 0.6
"""How near to a true pole a shaft is its own, and how near it counts neither way: a second cone
through its plates, which the surer one displaces."""


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
    (plan, _), columns = survey_columns(scene.drives, monitor)
    shafts = find_shafts(scene.drives, plan, columns.posts, monitor)
    if not shafts:
        return
    truth = read_mapped(scene.truth("poles"))
    poles = truth.of_kinds(POLES, "point", Text("poles", "柱状物"))
    true = positions_of(poles)[:, :2] - plan.origin[:2]
    feet = np.array([one.foot[:2] for one in shafts])
    around = points_about(scene.drives, plan, feet, REACH_M, monitor)
    shafts = with_whole_sides(shafts, around, monitor)
    usual_m = usual_noise_m(shafts)
    labels = label_shafts(shafts, true, usual_m)
    codes = _codes(scene)
    trees = tree_chances(scene.drives, plan, np.array([one.foot[:2] for one in shafts]), monitor)
    found = shafts, around, usual_m
    known = shafts_about_all(scene.drives, plan, found, monitor, least=0.0)
    for number, about in known.items():
        shaft, label = shafts[number], labels[number]
        if label is not None and not (label is False and _is_noise(shaft, codes)):
            whole = about._replace(tree=float(trees[number]))
            yield is_low(shaft), facts_of(shaft, whole, usual_m), label


def _codes(scene: RoadScene) -> list[NDArray[np.uint8]]:
    """What each point of each drive is."""
    truth = scene.delivery / "truth"
    stems = [Path(drive.info.sources[0].path).stem for drive in scene.drives]
    return [np.load(truth / f"{stem}.labels.npy", mmap_mode="r") for stem in stems]


def _is_noise(shaft: Shaft, codes: Sequence[NDArray[np.uint8]]) -> bool:
    """Whether most of its points are noise, as mirrored poles are: another tool's task."""
    told = [codes[drive][point] for drive, point in zip(shaft.drives, shaft.points, strict=True)]
    return float(np.isin(told, _NOISE_CODES).mean()) > 0.5


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.road_training.pole_training"
    )
    asked = varied_streets(parser, arguments)
    known, check = known_shafts(asked.learnt), known_shafts(asked.check)
    for low, model in MODELS.items():
        sys.stdout.write(f"{learn_model(model, known[low], check[low], _SIZES[low])}\n\n")
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

"""What tells trees from posts and other upright things, learnt from known streets.

``python -m processing.laboratory.road_training.tree_training``.

Simulates avenues of ``--seeds`` and usual streets of ``--worn``, finds upright things on them
without leaving any out, and fits `processing.methods.road.trees.tree_confidence.WEIGHTS` to which
of them are trees; avenues of ``--check`` are not learnt from. ``--deliveries`` are further streets
to learn from, recorded before. Prints the weights and how many things of each confidence are
trees: of streets learnt from by weights that were fitted without the street itself.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    avenue_scenes,
    cloud_of,
    worn_options_of,
)
from processing.laboratory.road_training.learned_confidence import (
    LabelledThings,
    WeightPrior,
    learn_weights,
)
from processing.laboratory.road_training.training_streets import training_streets
from processing.methods.road.trees.stems import BREAST_M
from processing.methods.road.trees.street_trees import StreetTree, TreeSettings, upright_things
from processing.methods.road.trees.tree_confidence import TreeFacts, facts_of
from processing.scoring.features.mapped_features import MappedFile
from processing.scoring.features.object_matches import is_in_span, positions_of, shows_enough
from processing.scoring.features.trees import LEAST_TRUNK_POINTS
from processing.tools.trees import TreeParameters

EXPECTED = WeightPrior(
    (-3.0, *TreeFacts(1.5, -6.0, -3.0, -3.0, -3.0, 2.0, 0.3, -2.0, 1.0, -1.0, -1.0, 0.5, 0.3)),
    (3.0, *TreeFacts(1.5, 4.0, 3.0, 3.0, 3.0, 3.0, 0.5, 2.0, 1.0, 1.5, 1.0, 0.5, 0.3)),
)
"""What reasoning expects; a hundred trees leave some of it open."""

_SEEDS, _USUAL, _CHECK = "600-615", "540-551", "620-623"
"""Streets that the `WEIGHTS` were learnt from, avenues and others, and avenues to check with."""

_POLE_LIKE = 66
"""Code of points of trunks (shared with poles)."""

_BARK_M = 0.1
"""From a trunk's surface to its points."""

_SAME_M = 0.8
"""A trunk so far from a true one is another thing: a post or a stake beside a tree."""


def known_trees(scenes: Iterator[RoadScene]) -> LabelledThings:
    """All upright things on some streets; trees that nobody could tell left out."""
    rows: list[tuple[TreeFacts, bool, float, int]] = []
    for number, scene in enumerate(scenes):
        rows += [(*one, 1.0, number) for one in _judge(scene, read_mapped(scene.truth("trees")))]
        sys.stderr.write(f"{scene.name}: {len(rows)} upright things\n")
    return LabelledThings.of(rows, len(TreeFacts._fields))


def _judge(scene: RoadScene, truth: MappedFile) -> Iterator[tuple[TreeFacts, bool]]:
    settings = TreeSettings(TreeParameters().thickest_m)
    found = upright_things(scene.drives, settings, SilentMonitor())
    feet = positions_of(truth.features)[:, :2]
    asked = [
        is_in_span(one) and shows_enough(truth, one, "trunk_points", LEAST_TRUNK_POINTS)
        for one in truth.features
    ]
    bark = _bark_of(scene.delivery)
    taken: set[int] = set()
    for one in sorted(found, key=lambda one: _off(one, feet)[0]):
        off, which = _off(one, feet)
        stem = one.trunk.stems_about_foot[0]
        middle = one.foot + np.append(stem.middle_at(BREAST_M), BREAST_M)
        is_other_tree = off >= _SAME_M and bark.query(middle)[0] < stem.radius_m + _BARK_M
        # Of several things at one tree, stakes and stems by themselves, the nearest is the tree.
        is_judged = off >= _SAME_M or (asked[which] and which not in taken)
        if off < _SAME_M:
            taken.add(which)
        if is_judged and not is_other_tree:
            yield facts_of(one.upright, one.crown), off < _SAME_M


def _off(tree: StreetTree, feet: Floats) -> tuple[float, int]:
    """How far the nearest true foot is, and which."""
    if not len(feet):
        return np.inf, -1
    beside = np.hypot(*(feet - tree.foot[:2]).T)
    return float(beside.min()), int(beside.argmin())


def _bark_of(delivery: Path) -> cKDTree:
    """Points of the wood of trees, those of woods and yards included that the truth leaves out."""
    cloud = cloud_of(delivery)
    kinds = json.loads((delivery / "truth" / "instance_kinds.json").read_text("utf-8"))
    trees = np.array([int(key) for key, one in kinds.items() if one["kind"] == "tree"], np.int64)
    is_bark = (cloud.label == _POLE_LIKE) & np.isin(cloud.instance, trees)
    return cKDTree(cloud.xyz[is_bark])


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    asked = training_streets(
        "tree_training",
        arguments,
        avenue_scenes,
        (_SEEDS, _CHECK),
        others={"worn": (_USUAL, worn_options_of)},
    )
    known, check = known_trees(asked.learnt), known_trees(asked.check)
    sys.stdout.write(learn_weights(TreeFacts._fields, EXPECTED, known, check))
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

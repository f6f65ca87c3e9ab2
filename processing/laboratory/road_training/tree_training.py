"""What tells trees from posts and other upright things, learnt from known streets.

``python -m processing.laboratory.road_training.tree_training``.

Needs the extra ``train``. Simulates streets of ``--seeds``: an avenue by a scanner of the
catalogue, one by a scanner of any kind and mounting and a usual worn street take turns. Finds
upright things on them without leaving any out, and fits the model of
`processing.methods.road.trees.tree_confidence` to which of them are trees, and the weights of
`processing.methods.road.trees.diameter_errors` to how far their diameters are off. Prints how many
things of each confidence are trees, each street by a model that was fitted without some streets,
it among them; the same of ``--check``, which nothing is learnt from; and the weights.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    cloud_of,
)
from processing.laboratory.noise_training.fitting import TreesSize
from processing.laboratory.progress_lines import say
from processing.laboratory.road_training.boosted_confidence import learn_model
from processing.laboratory.road_training.learned_confidence import LabelledThings
from processing.laboratory.road_training.varied_streets import varied_streets
from processing.methods.road.trees.diameter_errors import ErrorCauses, causes_of, wider
from processing.methods.road.trees.stem_bodies import BREAST_M
from processing.methods.road.trees.street_trees import StreetTree, TreeSettings, upright_things
from processing.methods.road.trees.tree_confidence import MODEL, SIGNS, TreeFacts, facts_of
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.object_matches import is_in_span, positions_of, shows_enough
from processing.scoring.features.trees import LEAST_ARC_DEG, LEAST_TRUNK_POINTS
from processing.tools.trees import TreeParameters

_SIZE = TreesSize(trees=200, leaves=6, rate=0.1, least_in_a_leaf=20, signs=SIGNS)

_IN_95, _HELD = 0.95, 2e-3
"""Which errors lie within, and how much small weights are held to nothing (L1 penalty of
``QuantileRegressor``): chosen by streets left out, of whose errors 95 % lay within."""

_LEAST_ERROR_M = 2e-4

_POLE_LIKE = 66
"""Code of points of trunks (shared with poles)."""

_BARK_M = 0.1
"""From a trunk's surface to its points."""

_SAME_M = 0.8
"""A trunk so far from a true one is another thing: a post or a stake beside a tree."""


@dataclass(frozen=True)
class KnownTrees:
    """Upright things of known streets.

    Attributes
    ----------
    things : LabelledThings
        Their facts, and which are trees.
    causes : (k, d) float64
        Of those of which a sixth and more of the trunk was seen, what makes diameters unsure.
    errors : (k,) float64
        How far each is off, over what the fit alone tells.
    """

    things: LabelledThings
    causes: Floats
    errors: Floats


def known_trees(scenes: Iterator[RoadScene]) -> KnownTrees:
    """All upright things on some streets; trees that nobody could tell left out."""
    rows: list[tuple[TreeFacts, bool, float, int]] = []
    causes: list[ErrorCauses] = []
    errors: list[float] = []
    for number, scene in enumerate(scenes):
        truth = read_mapped(scene.truth("trees"))
        for one, which in _judged(scene, truth):
            rows.append((facts_of(one.upright, one.crown), which is not None, 1.0, number))
            if which is not None and shows_enough(truth, which, "arc_deg", LEAST_ARC_DEG):
                off = abs(one.trunk.diameter_m - truth.number(which, "dbh_m"))
                causes.append(causes_of(one.trunk.stems, one.trunk.diameter_m))
                errors.append(max(off, _LEAST_ERROR_M) / one.trunk.fitted_within_m)
        say(f"{scene.name}: {len(rows)} upright things")
    return KnownTrees(
        LabelledThings.of(rows, len(TreeFacts._fields)), np.array(causes), np.array(errors)
    )


def _judged(
    scene: RoadScene, truth: MappedFile
) -> Iterator[tuple[StreetTree, MappedFeature | None]]:
    """Upright things that are judged, and the tree that each is."""
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
            yield one, truth.features[which] if off < _SAME_M else None


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


def fit_causes(known: KnownTrees) -> Floats:
    """(d + 1,) constant and weights of what widens the errors of diameters.

    References
    ----------
    Koenker, Bassett 1978, Regression quantiles.
    """
    from sklearn.linear_model import QuantileRegressor

    model = QuantileRegressor(quantile=_IN_95, alpha=_HELD, solver="highs")
    model.fit(known.causes, np.log(known.errors))
    return np.array([model.intercept_, *model.coef_])


def share_within(known: KnownTrees) -> float:
    """Of diameters whose error is no greater than what is told with them."""
    told = [wider(ErrorCauses(*one)) for one in known.causes.tolist()]
    return float((known.errors <= told).mean())


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.road_training.tree_training"
    )
    asked = varied_streets(parser, arguments)
    known, check = known_trees(asked.learnt), known_trees(asked.check)
    lines = [
        learn_model(MODEL, known.things, check.things, _SIZE),
        "  ".join(f"{one:.2f}" for one in fit_causes(known)),
        f"within, as told: {share_within(known):.3f}, others {share_within(check):.3f}",
    ]
    sys.stdout.write("\n\n".join(lines) + "\n")
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())

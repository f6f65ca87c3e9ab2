"""Trees found without a prior labelling, and as the thesis finds them with one.

The thesis keeps points of crowns, posts and buildings and looks for trees among those; this program
looks at all points.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.road.baselines.wireframe_trees import (
    KEPT_CLASSES,
    WireframeTree,
    wireframe_trees,
)
from processing.laboratory.accuracy.road.road_tables import percent
from processing.laboratory.accuracy.road.tree_scenes import (
    ScoredTrees,
    TreeScene,
    asked_of,
)
from processing.laboratory.accuracy.road.true_labels import labels_of_drive
from processing.methods.classes.class_models import shipped_models
from processing.methods.classes.drive_classes import classify_drive
from processing.methods.road.objects.ground_heights import height_of
from processing.methods.road.objects.survey import survey_columns
from processing.recording.drive import Drive
from processing.scoring.features.mapped_features import MappedFeature
from processing.scoring.features.object_matches import match_objects, shows_enough
from processing.scoring.features.trees import LEAST_ARC_DEG, WITHIN_M
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

Codes = NDArray[np.uint8]

_LABEL = "label"

NONE, OWN, TRUE = "no classes", "classes by `classify` without tools", "true classes"
"""What is known of the points before."""

_THESIS = "thesis: wireframe of the first head"


class FoundTrees(NamedTuple):
    """What one way found on a street.

    Attributes
    ----------
    way, labelling : str
    counts : BinaryConfusionMatrix
    off_m : tuple of float
        Errors of the diameters of trunks of which 60° and more were seen.
    """

    way: str
    labelling: str
    counts: BinaryConfusionMatrix
    off_m: tuple[float, ...]


def found_trees(street: ScoredTrees) -> list[FoundTrees]:
    """What this program finds without classes, and the thesis' way with them."""
    scene = street.scene
    found = [_ours(street, NONE)]
    for labelling in (OWN, TRUE):
        for drive in scene.drives:
            codes = _codes_of(drive) if labelling == OWN else labels_of_drive(drive, scene.labels)
            drive.columns.hold(_LABEL, codes)
        found.append(_as_thesis(scene, labelling))
    return found


def labellings_table(found: Sequence[FoundTrees]) -> str:
    """Each way with each labelling, over all streets."""
    rows = [["way", "points", "found, false, missed", "P", "R", "**F**",
             "diameter RMS, greatest (cm)"]]  # fmt: skip
    for way, labelling in dict.fromkeys((one.way, one.labelling) for one in found):
        own = [one for one in found if (one.way, one.labelling) == (way, labelling)]
        counts = sum((one.counts for one in own), BinaryConfusionMatrix(0, 0, 0, 0))
        off = 100 * np.array([error for one in own for error in one.off_m])
        rows.append(
            [
                way,
                labelling,
                f"{counts.hits}, {counts.false_alarms}, {counts.misses}",
                *(percent(one) for one in (counts.precision, counts.recall, counts.f_measure)),
                f"{np.sqrt(np.mean(off**2)):.1f}, {np.abs(off).max():.1f}" if off.size else "–",
            ]
        )
    return markdown_table(rows)


def _ours(street: ScoredTrees, labelling: str) -> FoundTrees:
    off = tuple(
        street.number(one, "dbh_m") - street.true(one, "dbh_m")
        for one in street.matches.partners
        if shows_enough(street.scene.truth, one.truth, "arc_deg", LEAST_ARC_DEG)
    )
    return FoundTrees("this program", labelling, street.matches.counts, off)


def _codes_of(drive: Drive) -> Codes:
    codes, sure = np.zeros(drive.count, np.uint8), np.zeros(drive.count, np.float32)
    with TemporaryDirectory(prefix="zuka-") as folder:
        classify_drive(drive, codes, sure, Path(folder), SilentMonitor(), models=shipped_models())
    return codes


def _as_thesis(scene: TreeScene, labelling: str) -> FoundTrees:
    """By the thesis' way from the first head, as it has it."""
    trees = _wireframe_trees(scene.drives[0])
    features = tuple(
        MappedFeature(number, "point", np.array([[*one.place, 0.0]]), {"kind": "tree"})
        for number, one in enumerate(trees)
    )
    truth = scene.truth
    matches = match_objects(features, truth.features, asked_of(truth), WITHIN_M)
    off = [
        trees[one.result.number].diameter_m - truth.number(one.truth, "dbh_m")
        for one in matches.partners
        if shows_enough(truth, one.truth, "arc_deg", LEAST_ARC_DEG)
    ]
    return FoundTrees(
        _THESIS, labelling, matches.counts, tuple(one for one in off if not math.isnan(one))
    )


def _wireframe_trees(drive: Drive) -> list[WireframeTree]:
    if drive.revolutions is None:
        return []
    plan, ground = survey_columns([drive], SilentMonitor())[0]
    codes = np.asarray(drive.columns[_LABEL])
    kept = np.flatnonzero(np.isin(codes, KEPT_CLASSES))
    pulses = np.asarray(drive.columns["pulse"])[kept].astype(np.int64)
    order = np.argsort(pulses, kind="stable")
    local = drive.xyz(kept[order]) - plan.origin
    per_turn = round(drive.revolutions.pulses_per_revolution)

    def ground_at(east: float, north: float) -> float:
        return height_of(ground, plan, east, north)

    trees = wireframe_trees(local, pulses[order], per_turn, ground_at)
    return [one._replace(place=one.place + plan.origin[:2]) for one in trees]

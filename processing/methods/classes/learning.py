"""Learning from corrections: the shipped trees go on from what somebody painted.

1. The forest that comes with the program says how likely each class is for the painted cells.
2. More trees correct what it says there. They are held to what it says of a sample of other
   streets, and of what nobody painted (:mod:`processing.methods.classes.painted_cells`).
3. How much that helps is measured at places that were left out, in turn.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.monitor import Monitor, parts_of
from processing.methods.classes.boosting import BoostingLimits, ClassExamples, boosted_further
from processing.methods.classes.class_models import ClassModels
from processing.methods.classes.painted_cells import PaintedCells
from processing.methods.classes.tree_growing import GrowthLimits
from processing.methods.noise.tree_files import Forest
from processing.scoring.points.confusion_matrix import ConfusionMatrix

LIMITS = BoostingLimits(rounds=20, tree=GrowthLimits(leaves=6, ridge=3.0, least=20, rate=0.25))
"""Fewer and smaller trees than the shipped models have: some minutes of paint are some fifty
things, and a leaf of fewer than 20 cells is a piece of one of them. Chosen among three on a street
of the own simulator (seed 610) and on street_worn, with strokes made from the truth."""

PAINTED_SHARE, LEFT_SHARE, SHIPPED_SHARE = 1.0, 0.5, 0.5
"""How much what was painted counts in all, what was left as it was, and the shipped sample: both
hold what is known together as much as the paint changes it. With the shipped sample's true classes
in place of what the shipped trees say of it, mean F of the avenue fell by 1.6 to 4 points: the
sample is of other streets."""

_FOLDS = 5
"""Parts that the places are left out in."""


@dataclass(frozen=True)
class Gain:
    """What was learnt, asked at places that it wasn't learnt from.

    Attributes
    ----------
    before, after : ConfusionMatrix
        Painted cells by the models that come with the program, and by what was learnt.
    places : int
        So many were painted.
    classes : frozenset of int
        Those that were painted by hand; others are there as far as they were confirmed.
    """

    before: ConfusionMatrix
    after: ConfusionMatrix
    places: int
    classes: frozenset[int]

    @property
    def mean_f(self) -> tuple[float, float]:
        """Mean F of the painted classes, before and after."""
        return self.before.mean_f_of(self.classes), self.after.mean_f_of(self.classes)

    @property
    def helps(self) -> bool:
        """Whether it is no worse than what comes with the program."""
        before, after = self.mean_f
        return after >= before


def learnt_forest(
    cells: PaintedCells, sample: ClassExamples, models: ClassModels, monitor: Monitor
) -> Forest:
    """The second trees with more of them, for what was painted.

    Parameters
    ----------
    sample : ClassExamples
        That comes with the program.
    """
    examples = ClassExamples.joined(
        [
            cells.painted.weighed(PAINTED_SHARE),
            cells.left.weighed(LEFT_SHARE).as_said(),
            sample.weighed(SHIPPED_SHARE).as_said(),
        ]
    )
    return boosted_further(models.again, examples, LIMITS, monitor)


def gain_of(
    cells: PaintedCells, sample: ClassExamples, models: ClassModels, monitor: Monitor
) -> Gain:
    """How much learning helps at places that are left out, in turn."""
    places = np.unique(cells.painted_places)
    folds = np.random.default_rng(0).permutation(places.size) % min(_FOLDS, places.size)
    painted, left = (
        _folds_of(of, places, folds) for of in (cells.painted_places, cells.left_places)
    )
    found = np.zeros_like(cells.painted.codes)
    count = int(folds.max()) + 1
    for fold, part in enumerate(parts_of(monitor, [1.0] * count)):
        others = PaintedCells(
            cells.painted.of(painted != fold),
            cells.left.of(left != fold),
            cells.painted_places[painted != fold],
            cells.left_places[left != fold],
            cells.classes,
        )
        learnt = replace(models, again=learnt_forest(others, sample, models, part), is_own=True)
        asked = painted == fold
        found[asked] = _said(learnt, cells.painted.rows[asked], part)
    first = _said(models, cells.painted.rows, monitor)
    true = cells.painted.codes
    before, after = (ConfusionMatrix.of(true, one) for one in (first, found))
    return Gain(before, after, places.size, cells.classes)


def _folds_of(of: Integers, places: Integers, folds: Integers) -> Integers:
    """The fold of each cell by its place; −1 where the place has no paint."""
    found = np.minimum(np.searchsorted(places, of), places.size - 1)
    return np.where(places[found] == of, folds[found], -1)


def _said(models: ClassModels, rows: NDArray[np.float32], monitor: Monitor) -> NDArray[np.uint8]:
    codes: NDArray[np.uint8] = models.codes[models.say_again(rows, monitor).argmax(axis=1)]
    return codes

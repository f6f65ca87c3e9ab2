"""The sample that is shipped beside the models: what learning from corrections must not forget.

It is of streets that the models didn't learn from, so that what they say of it is as sure as of any
other street.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.laboratory.accuracy.road.road_scenes import RoadScene
from processing.laboratory.class_training.examples import labelled_cells
from processing.methods.classes.boosting import ClassExamples
from processing.methods.classes.class_models import ClassModels
from processing.methods.classes.drive_classes import rows_seen_again

_CELLS = 45
"""Of each class and head: some 10,000 in all, a megabyte on the disk."""


def kept_sample(scenes: Iterable[RoadScene], models: ClassModels) -> ClassExamples:
    """Some cells of each class of each head of streets, as the second trees see them."""
    rng = np.random.default_rng(0)
    parts = []
    for number, scene in enumerate(scenes):
        for one in labelled_cells(scene, 1, number):
            chosen, stands_for = one.sample(_CELLS, rng)
            rows = rows_seen_again(one.cells, models, SilentMonitor())[chosen]
            parts.append(ClassExamples(rows, one.codes[chosen], stands_for))
    return ClassExamples.joined(parts)

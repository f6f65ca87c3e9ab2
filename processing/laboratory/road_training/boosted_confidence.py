"""Chances learnt from things of known streets by boosted trees of decisions."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.laboratory.noise_training.examples import Examples
from processing.laboratory.noise_training.fitting import TreesSize, fit_trees
from processing.laboratory.road_training.learned_confidence import LabelledThings, reliability
from processing.methods.noise.tree_files import write_trees
from processing.methods.noise.trees import Trees, log_odds
from resources import path_of

_FOLDS = 5


def learn_model(model: str, known: LabelledThings, check: LabelledThings, size: TreesSize) -> str:
    """Fit and write a model; how reliable it is, streets left out, and on others.

    Parameters
    ----------
    model : str
        Its file, as :func:`resources.path_of` takes it.
    """
    trees = fit_model(known, size)
    folder, _, name = model.rpartition("/")
    write_trees(trees, path_of(folder) / Path(name), known.terms.shape[1])
    lines = [reliability(known, cross_validated(known, size))]
    if check.is_right.size:
        lines.append(reliability(check, _chances(trees, check)))
    return "\n\n".join(lines)


def fit_model(known: LabelledThings, size: TreesSize) -> Trees:
    """Trees of decisions that give the log-odds of being right."""
    return fit_trees(Examples(known.terms.astype(np.float32), known.is_right, known.worth), size)


def cross_validated(known: LabelledThings, size: TreesSize) -> Floats:
    """(n,) each street's chances by a model that was fitted without it; 0 of a single one."""
    found = np.zeros(known.is_right.size)
    for fold in range(_FOLDS):
        is_here = known.street % _FOLDS == fold
        if is_here.any() and not is_here.all():
            trees = fit_model(known.chosen(~is_here), size)
            found[is_here] = _chances(trees, known.chosen(is_here))
    return found


def _chances(trees: Trees, things: LabelledThings) -> Floats:
    odds = log_odds(trees, things.terms.astype(np.float32), SilentMonitor())
    chances: Floats = 1 / (1 + np.exp(-odds))
    return chances

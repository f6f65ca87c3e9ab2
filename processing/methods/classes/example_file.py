"""A file of examples: each feature by 256 values that it has, so that a row is a byte a feature."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.methods.classes.boosting import ClassExamples

_LEVELS = 256
"""More than trees divide a feature's values into."""


def write_examples(examples: ClassExamples, path: Path) -> None:
    """Write examples; their values are rounded to the nearest of 256 that each feature has."""
    shares = np.linspace(0.0, 1.0, _LEVELS)
    levels = np.quantile(examples.rows, shares, axis=0, method="nearest").T.astype(np.float32)
    places = np.empty(examples.rows.shape, np.uint8)
    for feature, values in enumerate(levels):
        middles = (values[1:] + values[:-1]) / 2
        places[:, feature] = np.searchsorted(middles, examples.rows[:, feature])
    weights = examples.weights.astype(np.float32)
    np.savez_compressed(path, levels=levels, places=places, codes=examples.codes, weights=weights)


def read_examples(path: Path) -> ClassExamples:
    """Read examples.

    Raises
    ------
    OSError, ValueError, KeyError
        The file is missing or damaged: a defect of the program, not of its input.
    """
    with np.load(path, allow_pickle=False) as file:
        levels: NDArray[np.float32] = file["levels"]
        rows = np.take_along_axis(levels.T, file["places"].astype(np.intp), axis=0)
        return ClassExamples(rows, file["codes"], file["weights"].astype(np.float64))

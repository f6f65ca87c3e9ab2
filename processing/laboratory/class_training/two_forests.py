"""The two forests of a classification: one looks at a cell alone, one also at what it said around.

The second learns from what the first says of cells that it didn't learn from, as it will have to
judge it: the flights or streets are split into folds, and of each fold speaks a forest of the
others.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.monitor import SilentMonitor
from processing.laboratory.class_training.examples import LabelledCells
from processing.laboratory.class_training.fitting import (
    AveragedSize,
    ForestSize,
    fit_averaged_trees,
    fit_forest,
    in_order_of,
)
from processing.laboratory.progress_lines import say
from processing.methods.classes.class_models import MODELS
from processing.methods.classes.class_trees import class_shares
from processing.methods.noise.tree_files import (
    AveragedTrees,
    Forest,
    write_averaged_trees,
    write_forest,
)
from resources import path_of

FOLDS = 2


@dataclass(frozen=True)
class SampledCells:
    """Cells and those of them that are learnt from.

    Attributes
    ----------
    cells : LabelledCells
    chosen : (k,) int64
    stands_for : (k,) float64
        For how many cells each chosen one stands.
    """

    cells: LabelledCells
    chosen: Integers
    stands_for: NDArray[np.float64]

    @classmethod
    def of(cls, cells: LabelledCells, most: int, rng: Generator) -> SampledCells:
        """Choose at most so many cells of each class."""
        return cls(cells, *cells.sample(most, rng))

    @property
    def part(self) -> _Part:
        """What is learnt from the cells alone."""
        return self.cells.cells.rows[self.chosen], self.cells.codes[self.chosen], self.stands_for

    def part_seen_again(self, shares: NDArray[np.float32]) -> _Part:
        """What is learnt from the cells and what was said, (c, k), of them and those around."""
        rows = self.cells.cells.with_neighbours(shares, SilentMonitor())[self.chosen]
        return rows, self.cells.codes[self.chosen], self.stands_for


_Part = tuple[NDArray[np.float32], NDArray[np.uint8], NDArray[np.float64]]


@dataclass(frozen=True)
class ForestPlan:
    """What is made: the file names and sizes of the forest that looks alone and of the second."""

    alone: str
    alone_size: ForestSize
    again: str
    again_size: ForestSize


def make_two_forests(folds: Sequence[Sequence[SampledCells]], plan: ForestPlan) -> None:
    """Fit both forests and write them where the program looks for its models."""
    parts = [[one.part for one in fold] for fold in folds]
    everything = list(itertools.chain(*parts))
    alone = _fit(everything, plan.alone_size)
    _write(alone, plan.alone, everything[0][0].shape[1])
    again: list[_Part] = []
    for number, fold in enumerate(folds):
        others = itertools.chain(*parts[:number], *parts[number + 1 :])
        judge = _fit(list(others), plan.alone_size)
        for one in fold:
            shares = class_shares(judge, one.cells.cells.rows, SilentMonitor())
            again.append(one.part_seen_again(in_order_of(shares, judge, alone)))
    _write(_fit(again, plan.again_size), plan.again, again[0][0].shape[1])


def make_averaged_trees(examples: Iterable[SampledCells], name: str, size: AveragedSize) -> None:
    """Fit averaged trees to cells alone and write them beside the two forests."""
    rows, codes, stands_for = _joined([one.part for one in examples])
    _write(fit_averaged_trees(rows, codes, stands_for, size), name, rows.shape[1])


def _fit(parts: Sequence[_Part], size: ForestSize) -> Forest:
    return fit_forest(*_joined(parts), size)


def _joined(parts: Sequence[_Part]) -> _Part:
    rows, codes, stands_for = (np.concatenate(column) for column in zip(*parts, strict=True))
    say(f"fitting {len(rows):,} rows of {rows.shape[1]}")
    return rows, codes, stands_for


def _write(forest: Forest | AveragedTrees, name: str, columns: int) -> None:
    path = path_of("models") / Path(MODELS).name / name
    path.parent.mkdir(exist_ok=True)
    if isinstance(forest, AveragedTrees):
        write_averaged_trees(forest, path, columns)
    else:
        write_forest(forest, path, columns)
    say(f"{path.name}: {path.stat().st_size / 1e3:,.0f} kB")

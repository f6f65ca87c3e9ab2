"""The models of classes: those that come with the program, and one that a project learnt."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.methods.classes.boosting import ClassExamples
from processing.methods.classes.class_trees import class_shares
from processing.methods.classes.example_file import read_examples
from processing.methods.classes.features import FEATURES
from processing.methods.noise.tree_files import (
    AveragedTrees,
    Forest,
    read_averaged_trees,
    read_forest,
)
from resources import path_of

MODELS = "models/classes"
ALONE, AGAIN, SAMPLE = "alone.onnx", "again.onnx", "sample.npz"
AVERAGED = "averaged.onnx"
_STREET = (ALONE, AGAIN, AVERAGED)
AERIAL_ALONE, AERIAL_AGAIN = "aerial_alone.onnx", "aerial_again.onnx"
WAVE_ALONE, WAVE_AGAIN = "wave_alone.onnx", "wave_again.onnx"
WAVE_AVERAGED = "wave_averaged.onnx"
SCAN_ALONE, SCAN_AGAIN = "scan_alone.onnx", "scan_again.onnx"
SCAN_AVERAGED = "scan_averaged.onnx"
BARE_ALONE, BARE_AGAIN = "bare_alone.onnx", "bare_again.onnx"
BARE_AVERAGED = "bare_averaged.onnx"

SCAN_CELL_M = 0.2
"""Side of the finest cells of single scans, too sparse for those of 10 cm: two rows of a spinning
head at 10 m are as far apart or farther. Their ground is found as in clouds from the air."""


_SHARPENED = 1.6
"""Power by which shares that averaged trees have a part in keep what they promise: a mean promises
less. The likeliest on seven streets of the own simulator that weren't learnt from
(docs/accuracy.md); on ten flights of it 1.4 is, and 1.6 promises 0.009 more than it keeps."""


@dataclass(frozen=True)
class ClassModels:
    """Trees that look at a cell alone, and trees that also see what those said around it.

    Attributes
    ----------
    alone, again : Forest
    averaged : AveragedTrees, optional
        Of the first trees' classes, in the same order.
    is_own : bool
        Whether the second trees learnt from somebody's corrections: they may contradict what the
        first are sure of, and know classes more.
    """

    alone: Forest
    again: Forest
    averaged: AveragedTrees | None = None
    is_own: bool = False

    @property
    def codes(self) -> NDArray[np.uint8]:
        """(k,) the classes, in the order of :meth:`say_again`."""
        return self.again.codes

    @property
    def sharpened(self) -> float:
        """Power of the shares by which they keep what they promise."""
        return 1.0 if self.averaged is None else _SHARPENED

    @property
    def again_columns(self) -> int:
        """Features, three times the first's classes, and what averaged trees say."""
        blocks = 3 if self.averaged is None else 4
        return FEATURES + blocks * self.alone.codes.size

    def say_again(self, rows: NDArray[np.float32], monitor: Monitor) -> NDArray[np.float32]:
        """(n, k) how likely each class is, by all trees.

        Parameters
        ----------
        rows : (n, :attr:`again_columns`) float32
        """
        return self.with_averaged(class_shares(self.again, rows, monitor), rows)

    def with_averaged(
        self, shares: NDArray[np.float32], rows: NDArray[np.float32]
    ) -> NDArray[np.float32]:
        """What shares, (n, k), and the last columns of rows, averaged trees' word, say together.

        Of classes that averaged trees never met the shares alone count.
        """
        if self.averaged is None:
            return shares.copy()
        known = np.searchsorted(self.codes, self.averaged.codes)
        both, own = shares.copy(), shares[:, known]
        word = rows[:, -known.size :] * own.sum(axis=1, keepdims=True)
        both[:, known] = (own + word) / 2
        both **= self.sharpened
        return np.asarray(both / both.sum(axis=1, keepdims=True), np.float32)


@cache
def shipped_models() -> ClassModels:
    """The models that come with the program."""
    return _with_averaged(_read_models(ALONE, AGAIN), AVERAGED)


@cache
def aerial_models() -> ClassModels:
    """The models for clouds from the air."""
    return _read_models(AERIAL_ALONE, AERIAL_AGAIN)


@cache
def scan_models() -> ClassModels:
    """The models for single scans of spinning heads on streets."""
    return _with_averaged(_read_models(SCAN_ALONE, SCAN_AGAIN), SCAN_AVERAGED)


@cache
def flight_models(*, with_waveforms: bool) -> ClassModels:
    """The models of the six classes of flights, with waveforms or for points alone."""
    if with_waveforms:
        return _with_averaged(_read_models(WAVE_ALONE, WAVE_AGAIN), WAVE_AVERAGED)
    return _with_averaged(_read_models(BARE_ALONE, BARE_AGAIN), BARE_AVERAGED)


def _read_models(*names: str) -> ClassModels:
    alone, again = (read_forest(path_of(f"{MODELS}/{name}")) for name in names)
    return ClassModels(alone, again)


def _with_averaged(models: ClassModels, name: str) -> ClassModels:
    return replace(models, averaged=read_averaged_trees(path_of(f"{MODELS}/{name}")))


def shipped_sample() -> ClassExamples:
    """Examples that the models that come with the program didn't learn from."""
    return read_examples(path_of(f"{MODELS}/{SAMPLE}"))


@cache
def shipped_version() -> str:
    """What tells these shipped models from those of another version.

    A model that was learnt on top of others asks for what these may not say.
    """
    sums = (hashlib.sha256(path_of(f"{MODELS}/{name}").read_bytes()) for name in _STREET)
    return "-".join(one.hexdigest()[:16] for one in sums)

"""The models of classes: those that come with the program, and one that a project learnt."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cache

from processing.methods.classes.boosting import ClassExamples
from processing.methods.classes.example_file import read_examples
from processing.methods.classes.features import FEATURES
from processing.methods.noise.tree_files import Forest, read_forest
from resources import path_of

MODELS = "models/classes"
ALONE, AGAIN, SAMPLE = "alone.onnx", "again.onnx", "sample.npz"
AERIAL_ALONE, AERIAL_AGAIN = "aerial_alone.onnx", "aerial_again.onnx"
WAVE_ALONE, WAVE_AGAIN = "wave_alone.onnx", "wave_again.onnx"
SCAN_ALONE, SCAN_AGAIN = "scan_alone.onnx", "scan_again.onnx"
BARE_ALONE, BARE_AGAIN = "bare_alone.onnx", "bare_again.onnx"

SCAN_CELL_M = 0.2
"""Side of the finest cells of single scans, too sparse for those of 10 cm: two rows of a spinning
head at 10 m are as far apart or farther. Their ground is found as in clouds from the air."""


@dataclass(frozen=True)
class ClassModels:
    """Trees that look at a cell alone, and trees that also see what those said around it.

    Attributes
    ----------
    alone, again : Forest
    is_own : bool
        Whether the second trees learnt from somebody's corrections: they may contradict what the
        first are sure of.
    """

    alone: Forest
    again: Forest
    is_own: bool = False

    @property
    def again_columns(self) -> int:
        """Features that the second trees are asked about, and three times the first's classes."""
        return FEATURES + 3 * self.alone.codes.size


@cache
def shipped_models() -> ClassModels:
    """The models that come with the program."""
    return _read_models(ALONE, AGAIN)


@cache
def aerial_models() -> ClassModels:
    """The models for clouds from the air."""
    return _read_models(AERIAL_ALONE, AERIAL_AGAIN)


@cache
def scan_models() -> ClassModels:
    """The models for single scans of spinning heads on streets."""
    return _read_models(SCAN_ALONE, SCAN_AGAIN)


@cache
def flight_models(*, with_waveforms: bool) -> ClassModels:
    """The models of the six classes of flights, with waveforms or for points alone."""
    return _read_models(*((WAVE_ALONE, WAVE_AGAIN) if with_waveforms else (BARE_ALONE, BARE_AGAIN)))


def _read_models(*names: str) -> ClassModels:
    alone, again = (read_forest(path_of(f"{MODELS}/{name}")) for name in names)
    return ClassModels(alone, again)


def shipped_sample() -> ClassExamples:
    """Examples that the models that come with the program didn't learn from."""
    return read_examples(path_of(f"{MODELS}/{SAMPLE}"))


@cache
def shipped_version() -> str:
    """What tells these shipped models from those of another version.

    A model that was learnt on top of others asks for what these may not say.
    """
    sums = (hashlib.sha256(path_of(f"{MODELS}/{name}").read_bytes()) for name in (ALONE, AGAIN))
    return "-".join(one.hexdigest()[:16] for one in sums)

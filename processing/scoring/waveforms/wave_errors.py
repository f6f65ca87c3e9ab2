"""How far estimated waveforms are from true ones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats

_SHIFTS = np.linspace(-0.5, 0.5, 11)
"""Samples: where between two of them a first return was isn't known to better than that."""

_COARSE = np.geomspace(0.4, 1.6, 29)
_FINE = np.linspace(0.97, 1.03, 7)
"""Factors of brightness, around the one that the maxima tell: steps of 5 % with three of the
shifts, then of 1 % with all."""

_BEHIND = 64
"""Zeros behind the samples, lest what is moved out of the end comes in at the beginning."""

# Any: of 32 or 64 bits.
AnyFloats = NDArray[np.floating[Any]]


@dataclass(frozen=True)
class WaveError:
    """Mean absolute error over all samples, counts.

    Attributes
    ----------
    mean : float
        Over the classes, each as much.
    of_class : mapping of int to float
    factor : float
        What the estimate was multiplied by.
    each : (n,) float64
        Of every waveform.
    """

    mean: float
    of_class: Mapping[int, float]
    factor: float
    each: Floats


def wave_error(
    estimated: AnyFloats, true: AnyFloats, label: NDArray[np.uint8], *, factor: float | None = None
) -> WaveError:
    """Of waveforms, aligned within half a sample, brightness by the one factor that fits best.

    Parameters
    ----------
    estimated, true : (n, SAMPLES) float
        In any unit, and in counts.
    label : (n,) uint8
    factor : float, optional
        Given, it is used and none is fitted.
    """
    moved = [_moved(estimated, shift) for shift in _SHIFTS]
    if factor is not None:
        return _error(moved, true, label, factor)
    heights = np.maximum(estimated.max(axis=1), 1e-9)
    told = float(np.median(true.max(axis=1) / heights))
    few = moved[:: len(moved) // 2]
    best = min((_error(few, true, label, told * one) for one in _COARSE), key=_mean_of)
    return min((_error(moved, true, label, best.factor * one) for one in _FINE), key=_mean_of)


def constant_error(wave: AnyFloats, true: AnyFloats, label: NDArray[np.uint8]) -> WaveError:
    """Of one waveform (SAMPLES,) in counts that is said of all."""
    moved = [_moved(wave[None], shift) for shift in _SHIFTS]
    return _error(moved, true, label, 1.0)


def best_constant(true: AnyFloats, label: NDArray[np.uint8]) -> Floats:
    """(SAMPLES,) the waveform whose error is least: medians in which each class weighs as much."""
    weight = 1.0 / np.bincount(label)[label]
    order = np.argsort(true, axis=0)
    weights = np.cumsum(weight[order], axis=0)
    middle = (weights < 0.5 * weights[-1]).sum(axis=0)
    columns = np.arange(true.shape[1])
    return np.asarray(true[order[middle, columns], columns])


def _error(
    moved: list[Floats], true: AnyFloats, label: NDArray[np.uint8], factor: float
) -> WaveError:
    each = np.min([np.abs(factor * one - true).mean(axis=1) for one in moved], axis=0)
    of_class = {int(one): float(each[label == one].mean()) for one in np.unique(label)}
    return WaveError(float(np.mean(list(of_class.values()))), of_class, factor, np.asarray(each))


def _mean_of(error: WaveError) -> float:
    return error.mean


def _moved(waves: AnyFloats, shift: float) -> Floats:
    """Waveforms as if sampled ``shift`` earlier, by their band-limited form; none below 0."""
    size = waves.shape[1] + _BEHIND
    turn = np.exp(-2j * np.pi * np.fft.rfftfreq(size) * shift)
    whole = np.fft.irfft(np.fft.rfft(waves, size, axis=1) * turn, size, axis=1)
    return np.maximum(whole[:, : waves.shape[1]], 0.0)

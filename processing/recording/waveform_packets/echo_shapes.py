"""What a return looks like in its waveform: height over the baseline, width, energy, rise.

These are measures of the samples as they are, for looking at; `waveform-decompose` fits echoes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel

_CLIPS = 8
"""Rounds in which what stands out of the baseline is left out; fewer than five were ever needed."""

_CLEAR_SIGMAS = 3.0
"""So far above the baseline a sample is no noise: one in a thousand of a normal one is."""

_LEAST_SIGMA = 0.5
"""Noise that is counted in whole numbers is known to half of one, counts."""

_SEARCHED = 2
"""A return lies within a sample of its peak (98.9 % of a RIEGL airborne recording's), and a
neighbour in doubt, samples."""

_HALF, _LOW, _HIGH = 0.5, 0.1, 0.9
"""Levels of full width at half maximum and of rise, of the height over the baseline."""


@dataclass(frozen=True, eq=False)
class EchoShapes:
    """Measures of k returns; NaN where the waveform does not tell.

    Attributes
    ----------
    baseline, noise : (k,) float64
        Of the return's waveform, and its standard deviation, counts.
    amplitude : (k,) float64
        Height of the peak over the baseline, counts.
    width_ns : (k,) float64
        Full width at half maximum; to the valley where another echo begins before that.
    energy : (k,) float64
        Area over the baseline from valley to valley, counts x ns.
    rise_ns : (k,) float64
        From a tenth to nine tenths of the height.
    """

    baseline: Floats
    noise: Floats
    amplitude: Floats
    width_ns: Floats
    energy: Floats
    rise_ns: Floats


def echo_shapes(
    samples: NDArray[np.float32],
    lengths: NDArray[np.int32],
    interval_ns: Floats,
    place_ns: Floats,
) -> EchoShapes:
    """Measure the returns at some places of their waveforms.

    Parameters
    ----------
    samples : (k, m) float32
        Counts, a row a return.
    lengths : (k,) int32
        Samples that belong to the row's waveform.
    interval_ns : (k,) float64
        Between samples.
    place_ns : (k,) float64
        Of the return, after the first sample.
    """
    out = np.full((6, lengths.size), np.nan)
    _measure_kernel(
        samples,
        np.asarray(lengths, np.int64),
        np.asarray(interval_ns, np.float64),
        np.asarray(place_ns, np.float64),
        out,
    )
    return EchoShapes(*out)


def warm_up() -> None:
    """Compile the kernels."""
    one = np.ones(1)
    echo_shapes(np.zeros((1, 4), np.float32), np.full(1, 4, np.int32), one, one)


@kernel
def _measure_kernel(
    samples: NDArray[np.float32],
    lengths: NDArray[np.int64],
    interval_ns: NDArray[np.float64],
    place_ns: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    for row in range(lengths.size):
        length = lengths[row]
        if length < 3 or not np.isfinite(place_ns[row]):
            continue
        wave = samples[row, :length]
        base, sigma = _baseline_kernel(wave)
        out[0, row], out[1, row] = base, sigma
        middle = round(place_ns[row] / interval_ns[row])
        if middle < 0 or middle >= length:
            continue
        peak = middle
        for at in range(max(0, middle - _SEARCHED), min(length, middle + _SEARCHED + 1)):
            if wave[at] > wave[peak]:
                peak = at
        height = wave[peak] - base
        out[2, row] = height
        if height < _CLEAR_SIGMAS * sigma:
            continue
        first = _foot_kernel(wave, peak, -1, base, sigma)
        last = _foot_kernel(wave, peak, 1, base, sigma)
        area = 0.0
        for at in range(first, last + 1):
            area += wave[at] - base
        out[4, row] = area * interval_ns[row]
        half = base + _HALF * height
        left = _crossing_kernel(wave, peak, first, half)
        right = _crossing_kernel(wave, peak, last, half)
        out[3, row] = (right - left) * interval_ns[row]
        if wave[first] <= base + _LOW * height:
            begin = _crossing_kernel(wave, peak, first, base + _LOW * height)
            end = _crossing_kernel(wave, peak, first, base + _HIGH * height)
            out[5, row] = (end - begin) * interval_ns[row]


@kernel
def _baseline_kernel(wave: NDArray[np.float32]) -> tuple[float, float]:
    """Median and deviation of what is left when all that stands out is left out."""
    ordered = np.sort(wave)
    count = ordered.size
    base, sigma = 0.0, _LEAST_SIGMA
    for _ in range(_CLIPS):
        base = float(ordered[count // 2])
        # The lower half has no echo in it: a normal one's sixteenth percentile is one sigma down.
        sigma = max(base - float(ordered[int(0.16 * count)]), _LEAST_SIGMA)
        kept = np.searchsorted(ordered[:count], base + _CLEAR_SIGMAS * sigma, side="right")
        if kept == count:
            break
        count = int(kept)
    return base, sigma


@kernel
def _foot_kernel(wave: NDArray[np.float32], peak: int, step: int, base: float, sigma: float) -> int:
    """The last sample to one side that is still of the echo: at the baseline, or in a valley."""
    at = peak
    while 0 <= at + step < wave.size:
        following = wave[at + step]
        if following > wave[at] + sigma or wave[at] <= base + sigma:
            break
        at += step
    return at


@kernel
def _crossing_kernel(wave: NDArray[np.float32], peak: int, end: int, level: float) -> float:
    """Where the wave falls below a level between the peak and an end; the end where it doesn't."""
    step = 1 if end > peak else -1
    at = peak
    while at != end:
        if wave[at + step] <= level:
            share = (wave[at] - level) / max(wave[at] - wave[at + step], 1e-9)
            return float(at + step * share)
        at += step
    return float(end)

"""Echoes of waveforms: what each surface that a pulse met gave back, when and how broad."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.methods.waveforms.echo_kernels import FACTS, MOST_ECHOES, decompose_kernel
from processing.methods.waveforms.system_pulse import RecordNoise, SystemPulse

_LEAST = 4.2
"""Standard deviations of the filtered noise that an echo exceeds. A packet of 160 samples holds
some 50 independent values: noise alone exceeds this once in 1,500 packets."""

_GAIN = 16.0
"""By how much another echo lessens chi-square: three unknowns more do so by chance once in a
thousand times (chi-square distribution)."""

_SPLIT = 8.0
"""The same for two narrow echoes in place of a broad one: one unknown more, once in 200 times."""

_SHARE = 0.006
"""Error of the pulse itself as a share of the echo: tabulated values, unequal gain of the recorder.
Measured on simulated flights of development: 0.4 and 1 % give the same echoes."""


class Echoes(NamedTuple):
    """Echoes of packets, in the order of packets and times.

    ``row`` (k,) int64, which packet; ``time_ns`` after its first sample; ``amplitude``, counts of a
    flat target of the same energy; ``width_ns``, standard deviation of the Gaussian by which it is
    broader than the system's pulse; ``time_sigma_ns``, ``amplitude_sigma``, ``width_sigma_ns``
    (NaN where the width isn't asked for); ``covariance`` of time and amplitude, ns x counts;
    ``height`` of its maximum, counts; ``misfit``, chi-square for each sample of its packet. All
    float64.
    """

    row: Integers
    time_ns: Floats
    amplitude: Floats
    width_ns: Floats
    time_sigma_ns: Floats
    amplitude_sigma: Floats
    width_sigma_ns: Floats
    covariance: Floats
    height: Floats
    misfit: Floats


class Digitiser(NamedTuple):
    """Time between samples, ns, and the highest count that is told."""

    interval_ns: float
    top: float


def decompose(
    samples: NDArray[np.float32],
    lengths: NDArray[np.int32],
    pulse: SystemPulse,
    noise: RecordNoise,
    digitiser: Digitiser,
) -> Echoes:
    """Take packets for sums of the system's pulse, each broadened by a Gaussian.

    1. Filter the residual with the pulse; where it is strongest, an echo is added.
    2. Fit all echoes together (Levenberg-Marquardt), widths only of clear ones.
    3. Go on while the fit gains more than noise would; leave out what others make needless.
    4. Take a broad echo for two narrow ones where these explain it better.

    Parameters
    ----------
    samples : (n, m) float32
        Counts; anything behind a packet's own length.
    lengths : (n,) int32

    References
    ----------
    Shinohara 2022, equations 2.8, 2.12 and 2.14; Hofton et al. 2000 (sums of Gaussians).
    """
    n = len(samples)
    counts, facts = np.zeros(n, np.int32), np.zeros((n, MOST_ECHOES, FACTS))
    rule = np.array(
        [noise.baseline, noise.sigma, _SHARE, digitiser.top, _LEAST, _GAIN, _SPLIT], np.float64
    )
    decompose_kernel(
        np.ascontiguousarray(samples, np.float32),
        np.ascontiguousarray(lengths, np.int32),
        pulse.table,
        pulse.grid,
        rule,
        counts,
        facts,
    )
    row = np.repeat(np.arange(n), counts)
    found = facts[row, np.arange(row.size) - (np.cumsum(counts) - counts)[row]]
    step = digitiser.interval_ns
    place, amplitude, width, place_sigma, amplitude_sigma, width_sigma = found[:, :6].T
    return Echoes(
        row,
        place * step,
        amplitude,
        width * step,
        place_sigma * step,
        amplitude_sigma,
        width_sigma * step,
        found[:, 7] * step,
        found[:, 6],
        found[:, 8],
    )

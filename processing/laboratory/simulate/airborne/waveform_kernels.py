"""From what beams meet to records: echoes, digitised waveforms, and the returns told from them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.laboratory.simulate.airborne.beam_kernels import FootprintHits
from processing.laboratory.simulate.airborne.flight_sensors import (
    PULSE_BEFORE_NS,
    PULSE_STEP_NS,
    FlightSensor,
    pulse_table,
)
from processing.laboratory.simulate.airborne.landscapes import Floats

HALF_LIGHT_M_NS = 0.149896229
"""Range that light covers there and back in a nanosecond, in vacuum."""

ECHO_GAP_M = 0.25
"""Hits further apart belong to different true echoes."""

LABEL_REACH_M = 0.5
"""A return is of the class with most energy within this distance of its range."""

MOST_SAMPLES = 640
MOST_RETURNS = 12
_AHEAD_NS = 40.0
"""From the beginning of what is computed to the first hit: more than any packet's lead."""

_VALLEY = 3.0
"""Standard deviations of the noise by which the waveform falls between two returns."""


class FootprintEchoes(NamedTuple):
    """True echoes of beams: ``beam`` int32 (m,), m in all; ranges in m; ``energy`` relative."""

    beam: NDArray[np.int32]
    range_m: Floats
    energy: NDArray[np.float32]
    spread_m: NDArray[np.float32]
    low_m: Floats
    high_m: Floats
    code: NDArray[np.uint8]


class Records(NamedTuple):
    """Counts of n beams and the returns told from them.

    ``counts`` float32 (n, :data:`MOST_SAMPLES`), from the range ``first_m`` (n,) on; ``used``
    (n,) int32 samples; ``clean`` float32, without noise and baseline; ``found`` (n,) int32,
    returns; ``place`` float64 (n, :data:`MOST_RETURNS`), their samples; ``height`` float32, counts
    above the baseline.
    """

    counts: NDArray[np.float32]
    clean: NDArray[np.float32]
    first_m: Floats
    used: NDArray[np.int32]
    found: NDArray[np.int32]
    place: Floats
    height: NDArray[np.float32]


def true_echoes(hits: FootprintHits) -> FootprintEchoes:
    """Groups of hits with gaps of less than :data:`ECHO_GAP_M`."""
    n = int(hits.met.sum())
    echoes = FootprintEchoes(
        np.empty(n, np.int32),
        np.empty(n),
        np.empty(n, np.float32),
        np.empty(n, np.float32),
        np.empty(n),
        np.empty(n),
        np.empty(n, np.uint8),
    )
    found = _echo_kernel(hits, echoes)
    return FootprintEchoes._make(one[:found] for one in echoes)


def record(
    hits: FootprintHits, sensor: FlightSensor, scale: float, random: np.random.Generator
) -> Records:
    """Waveforms as a sensor digitises them, and its returns.

    Parameters
    ----------
    scale : float
        Counts of a beam's whole energy on a white flat target.
    """
    n = len(hits.met)
    records = Records(
        np.zeros((n, MOST_SAMPLES), np.float32),
        np.zeros((n, MOST_SAMPLES), np.float32),
        np.zeros(n),
        np.zeros(n, np.int32),
        np.zeros(n, np.int32),
        np.zeros((n, MOST_RETURNS)),
        np.zeros((n, MOST_RETURNS), np.float32),
    )
    step_m = sensor.interval_ns * HALF_LIGHT_M_NS
    phase = random.random(n)
    ahead = _AHEAD_NS * HALF_LIGHT_M_NS
    records.first_m[:] = hits.range_m[:, 0] - ahead - phase * step_m
    last = hits.range_m[np.arange(n), np.maximum(hits.met, 1) - 1]
    samples = ((last - records.first_m + ahead) / step_m).astype(np.int32)
    records.used[:] = np.where(hits.met > 0, np.clip(samples, 0, MOST_SAMPLES), 0)
    waves = (records.first_m, records.used, records.clean)
    _wave_kernel(hits, pulse_table(sensor), (sensor.interval_ns, scale), waves)
    noise = random.normal(sensor.baseline, sensor.noise, (n, MOST_SAMPLES)).astype(np.float32)
    full = float(2**sensor.bits - 1)
    np.clip(np.rint(records.clean + noise), 0.0, full, out=records.counts)
    size = (sensor.baseline, sensor.noise * sensor.threshold, sensor.noise * _VALLEY)
    _return_kernel(records.counts, size, records)
    return records


def clean_waves(
    hits: FootprintHits,
    beams: NDArray[np.int64],
    first_m: Floats,
    order: tuple[FlightSensor, float, int],
) -> NDArray[np.float32]:
    """Samples of 1 ns without noise and baseline, from given ranges on.

    Parameters
    ----------
    beams : (k,) int64
        Rows of the hits.
    first_m : (k,) float64
        Range of each waveform's first sample.
    order : (FlightSensor, float, int)
        The sensor, its scale as in :func:`record`, and how many samples.
    """
    sensor, scale, samples = order
    waves = np.zeros((len(beams), samples), np.float32)
    used = np.full(len(beams), samples, np.int32)
    chosen = FootprintHits._make(one[beams] for one in hits)
    _wave_kernel(chosen, pulse_table(sensor), (1.0, scale), (first_m, used, waves))
    return np.maximum(waves, 0.0)


@kernel
def _echo_kernel(hits: FootprintHits, echoes: FootprintEchoes) -> int:
    found = 0
    of_code = np.zeros(256)
    for beam in range(len(hits.met)):
        first = 0
        for at in range(hits.met[beam]):
            last = at + 1 == hits.met[beam]
            if not last and hits.range_m[beam, at + 1] - hits.range_m[beam, at] < ECHO_GAP_M:
                continue
            energy, mean, square, best = 0.0, 0.0, 0.0, 0
            of_code[:] = 0.0
            base = hits.range_m[beam, first]
            for one in range(first, at + 1):
                part, off = float(hits.energy[beam, one]), hits.range_m[beam, one] - base
                energy += part
                mean += part * off
                square += part * off * off
                of_code[hits.code[beam, one]] += part
            for code in range(256):
                if of_code[code] > of_code[best]:
                    best = code
            mean /= energy
            echoes.beam[found] = beam
            echoes.range_m[found] = base + mean
            echoes.energy[found] = energy
            echoes.spread_m[found] = np.sqrt(max(0.0, square / energy - mean * mean))
            echoes.low_m[found], echoes.high_m[found] = base, hits.range_m[beam, at]
            echoes.code[found] = best
            found += 1
            first = at + 1
    return found


@kernel
def _wave_kernel(
    hits: FootprintHits,
    table: NDArray[np.float64],
    size: tuple[float, float],
    waves: tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.float32]],
) -> None:
    """Add the pulse at each hit to the samples of its beam."""
    step_ns, scale = size
    firsts, used, clean = waves
    per_sample = step_ns / PULSE_STEP_NS
    for beam in range(len(hits.met)):
        for at in range(hits.met[beam]):
            time = (hits.range_m[beam, at] - firsts[beam]) / HALF_LIGHT_M_NS
            begin = max(0, int(np.ceil((time - PULSE_BEFORE_NS) / step_ns)))
            place = (begin * step_ns - time + PULSE_BEFORE_NS) / PULSE_STEP_NS
            energy = scale * hits.energy[beam, at]
            for sample in range(begin, used[beam]):
                whole = int(place)
                if whole + 1 >= table.size:
                    break
                part = place - whole
                value = table[whole] * (1.0 - part) + table[whole + 1] * part
                clean[beam, sample] += energy * value
                place += per_sample


@kernel
def _return_kernel(
    counts: NDArray[np.float32], size: tuple[float, float, float], records: Records
) -> None:
    """Maxima over the threshold with valleys between them; their tops by a parabola."""
    baseline, threshold, valley = size
    for beam in range(len(counts)):
        found, lowest = 0, 1e9
        wave = counts[beam]
        for at in range(1, records.used[beam] - 1):
            value = wave[at] - baseline
            lowest = min(lowest, value)
            if value < threshold or wave[at] < wave[at - 1] or wave[at] <= wave[at + 1]:
                continue
            deep = max(valley, 0.12 * value)
            if found > 0 and min(value, records.height[beam, found - 1]) - lowest < deep:
                if value <= records.height[beam, found - 1]:
                    continue
                found -= 1
            elif found == MOST_RETURNS:
                break
            bend = wave[at - 1] - 2.0 * wave[at] + wave[at + 1]
            shift = 0.0 if bend >= 0.0 else 0.5 * (wave[at - 1] - wave[at + 1]) / bend
            records.place[beam, found] = at + shift
            records.height[beam, found] = value
            found += 1
            lowest = value
        records.found[beam] = found

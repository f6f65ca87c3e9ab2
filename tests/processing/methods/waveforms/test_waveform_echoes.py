"""Echoes of made waveforms, whose places and amplitudes are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.monitor import SilentMonitor
from processing.methods.waveforms.decomposition import Digitiser, Echoes, decompose
from processing.methods.waveforms.drive_echoes import echoes_of
from processing.methods.waveforms.system_pulse import (
    RecordNoise,
    SystemPulse,
    noise_of,
    own_pulse,
    system_pulse,
)
from tests.waveform_flight import change_descriptor, import_flight, write_flight

SIGMA_NS, NOISE, BASELINE, SAMPLES = 1.7, 1.2, 9.0, 100
TIMES = np.arange(-12, 12, 0.25)
PULSE = np.exp(-0.5 * (TIMES / SIGMA_NS) ** 2)
DIGITISER = Digitiser(1.0, 255.0)


def waves(
    echoes: list[tuple[float, float, float]], copies: int = 200, seed: int = 1
) -> NDArray[np.float32]:
    """Digitised copies of a sum of (time, amplitude, width) with noise."""
    time = np.arange(SAMPLES)
    clean = np.zeros(SAMPLES)
    for place, amplitude, width in echoes:
        broad = np.hypot(SIGMA_NS, width)
        clean += amplitude * SIGMA_NS / broad * np.exp(-0.5 * ((time - place) / broad) ** 2)
    noise = np.random.default_rng(seed).normal(BASELINE, NOISE, (copies, SAMPLES))
    return np.clip(np.rint(clean + noise), 0, 255).astype(np.float32)


def found(samples: NDArray[np.float32], pulse: SystemPulse | None = None) -> Echoes:
    lengths = np.full(len(samples), SAMPLES, np.int32)
    shape = pulse or system_pulse(TIMES, PULSE)
    return decompose(samples, lengths, shape, RecordNoise(BASELINE, NOISE), DIGITISER)


def test_a_lone_echo_is_one_and_its_time_is_as_sure_as_it_says() -> None:
    echoes = found(waves([(30.37, 100.0, 0.0)]))
    assert np.array_equal(echoes.row, np.arange(200))
    off = echoes.time_ns - 30.37
    assert abs(off.mean()) < 0.01
    assert 0.7 < off.std() / np.median(echoes.time_sigma_ns) < 1.5
    assert abs(np.median(echoes.amplitude) - 100.0) < 2.0


def test_noise_alone_has_no_echo() -> None:
    assert found(waves([], copies=1000)).row.size <= 1


def test_two_echoes_a_metre_apart_are_two() -> None:
    echoes = found(waves([(30.0, 80.0, 0.0), (36.7, 40.0, 0.0)]))
    assert np.mean(np.bincount(echoes.row, minlength=200) == 2) > 0.97
    later = echoes.time_ns[1::2] if echoes.row.size == 400 else echoes.time_ns
    assert np.median(np.abs(later[later > 33] - 36.7)) < 0.1


def test_echoes_nearer_than_half_the_pulse_are_told_apart_mostly() -> None:
    echoes = found(waves([(30.0, 90.0, 0.0), (33.0, 90.0, 0.0)]))
    assert np.mean(np.bincount(echoes.row, minlength=200) == 2) > 0.9


def test_a_weak_echo_beside_a_strong_one_is_found() -> None:
    echoes = found(waves([(30.0, 150.0, 0.0), (60.0, 5.0 * NOISE, 0.0)]))
    assert np.mean(np.bincount(echoes.row, minlength=200) == 2) > 0.85


def test_a_broad_echo_is_one_with_its_width() -> None:
    echoes = found(waves([(40.0, 120.0, 1.0)]))
    assert np.mean(np.bincount(echoes.row, minlength=200) == 1) > 0.95
    assert abs(np.median(echoes.width_ns) - 1.0) < 0.1


def test_a_cut_off_echo_keeps_its_time() -> None:
    echoes = found(waves([(30.0, 400.0, 0.0)]))
    strongest = echoes.time_ns[np.abs(echoes.time_ns - 30.0) < 1.5]
    assert strongest.size >= 200
    assert np.median(np.abs(strongest - 30.0)) < 0.2


def test_baseline_and_noise_are_measured_between_the_echoes() -> None:
    samples = waves([(30.0, 150.0, 0.0), (45.0, 80.0, 0.0)], copies=500)
    noise = noise_of(samples, np.full(500, SAMPLES, np.int32))
    assert abs(noise.baseline - BASELINE) < 0.2
    assert abs(noise.sigma - np.hypot(NOISE, 12**-0.5)) < 0.1


def test_the_pulse_is_learnt_from_the_recording() -> None:
    places = np.random.default_rng(3).uniform(20, 70, 300)
    samples = np.concatenate(
        [waves([(place, 150.0, 0.0)], copies=1, seed=k) for k, place in enumerate(places)]
    )
    lengths = np.full(300, SAMPLES, np.int32)
    pulse = own_pulse(samples, lengths, RecordNoise(BASELINE, NOISE), 255.0)
    assert abs(pulse.grid[3] - 2.355 * SIGMA_NS) < 0.15
    echoes = found(samples, pulse)
    assert echoes.row.size == pytest.approx(300, abs=3)
    assert abs(np.median(echoes.time_ns - places[echoes.row])) < 0.03


def test_too_little_to_learn_a_pulse_from_is_told() -> None:
    with pytest.raises(Unsuitable):
        own_pulse(waves([]), np.full(200, SAMPLES, np.int32), RecordNoise(BASELINE, NOISE), 255.0)
    with pytest.raises(Unsuitable):
        system_pulse(np.arange(9.0), np.arange(9.0))


@pytest.mark.parametrize(
    ("said", "why"),
    [
        ({"samples": 0}, "descriptor with no samples"),
        ({"samples": 5_000_000}, "descriptor with no samples"),
        ({"samples": 80, "bits": 12}, "unknown coding"),
        ({"samples": 80, "spacing_ps": 7_000_000}, "too far apart"),
    ],
)
def test_packets_that_no_waveform_can_be_in_are_refused_with_file_and_reason(
    said: dict[str, int], why: str, tmp_path: Path
) -> None:
    flight = write_flight(tmp_path / "flight.las")
    change_descriptor(flight.path, **said)
    drive = import_flight(flight.path, tmp_path / "drive")
    with pytest.raises(Unsuitable) as refused:
        list(echoes_of(drive, None, SilentMonitor()))
    assert why in refused.value.where.en
    assert "flight.las" in refused.value.where.en
    assert "記述子" in refused.value.where.ja

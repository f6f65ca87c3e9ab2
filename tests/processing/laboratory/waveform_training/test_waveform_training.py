"""What networks that estimate waveforms learn from, and the errors that judge them."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.airborne.flight_sensors import FLIGHT_SENSORS
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest
from processing.laboratory.waveform_training.drawn_flights import drawn_sensor
from processing.laboratory.waveform_training.fitting import write_network
from processing.laboratory.waveform_training.flight_examples import FlightExamples, examples_of
from processing.methods.waveforms.estimation.response_network import (
    read_network,
    shipped_network,
)
from processing.scoring.waveforms.wave_errors import best_constant, constant_error, wave_error
from resources import path_of

MOST = 150


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("drawn") / "flight"
    sensor = dataclasses.replace(FLIGHT_SENSORS["corridor"], fwhm_ns=5.0, density=5.0)
    simulate_flight(FlightRequest(seed=4, length_m=40.0), folder, SilentMonitor(), sensor)
    return folder


def examples(flight: Path, *, knows_intensity: bool = True) -> FlightExamples:
    random = np.random.default_rng(1)
    return examples_of(flight, MOST, random, knows_intensity=knows_intensity)


def test_a_seed_draws_one_scanner_between_those_that_are_flown() -> None:
    drawn = [drawn_sensor(seed) for seed in range(10)]
    assert drawn == [drawn_sensor(seed) for seed in range(10)]
    assert {one.id for one in drawn} == set(FLIGHT_SENSORS)
    assert len({one.fwhm_ns for one in drawn}) == len(drawn)
    for one in drawn:
        assert 0.75 <= one.fwhm_ns / FLIGHT_SENSORS[one.id].fwhm_ns <= 1.35


def test_examples_show_the_drawn_pulse_and_true_waveforms(flight: Path) -> None:
    found = examples(flight)
    codes, numbers = np.unique(found.label, return_counts=True)
    assert {2, 5, 6, 11} <= set(codes.tolist())
    assert numbers.max() == MOST
    width_ns = np.count_nonzero(np.interp(np.arange(0, 64, 0.1), range(65), found.pulse) > 0.5) / 10
    assert width_ns == pytest.approx(5.0, abs=0.3)
    # On roads the plain estimate is all but true: both are in the same unit and place.
    road = found.label == 11
    assert np.abs(found.plain - found.true)[road].mean() < 0.2 * found.true[road].mean()
    counts = found.true * found.counts[:, None]
    assert np.allclose(counts, np.rint(counts), atol=1e-2)


def test_the_shipped_networks_are_nearer_than_the_plain_estimate(flight: Path) -> None:
    for knows_intensity in (True, False):
        found = examples(flight, knows_intensity=knows_intensity)
        network = shipped_network(knows_intensity=knows_intensity)
        channels = found.channels.astype(np.float32)
        own = network.waves(channels, found.facts, found.plain, found.pulse)
        by = found.counts[:, None]
        errors = [wave_error(one * by, found.true * by, found.label) for one in (found.plain, own)]
        assert errors[1].mean < errors[0].mean


def test_what_training_writes_is_read_again(flight: Path, tmp_path: Path) -> None:
    found = examples(flight)
    found.write(tmp_path / "flight.npz")
    again = FlightExamples.read(tmp_path / "flight.npz")
    for one in dataclasses.fields(found):
        assert np.array_equal(getattr(found, one.name), getattr(again, one.name))
    with np.load(path_of("models/waveforms/all.npz")) as kept:
        write_network({name: kept[name] for name in kept}, tmp_path / "all.npz")
    asked = found.channels.astype(np.float32), found.facts, found.plain, found.pulse
    network = read_network(tmp_path / "all.npz")
    assert np.array_equal(
        network.waves(*asked), shipped_network(knows_intensity=True).waves(*asked)
    )


def test_errors_are_of_classes_alike_and_forgive_brightness_and_half_a_sample() -> None:
    times = np.arange(160.0)
    height = np.array([10.0, 20.0, 40.0, 80.0])
    label = np.array([2, 2, 2, 5], np.uint8)
    true = height[:, None] * np.exp(-0.5 * ((times - 12.5) / 2.0) ** 2)
    moved = height[:, None] * np.exp(-0.5 * ((times - 12.9) / 2.0) ** 2)
    found = wave_error(3.0 * moved, true, label)
    assert found.mean < 0.01 * true.mean()
    assert found.factor == pytest.approx(1 / 3, rel=0.02)
    zero = constant_error(np.zeros(160), true, label)
    of_class = true[:3].mean(), true[3:].mean()
    assert zero.mean == pytest.approx(np.mean(of_class))
    assert constant_error(best_constant(true, label), true, label).mean < zero.mean

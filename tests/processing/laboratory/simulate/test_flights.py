"""A simulated flight: what is delivered agrees with its truth, and its waveforms with both."""

from __future__ import annotations

import json
from pathlib import Path

import laspy
import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import OutOfRange
from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.airborne.flight_sensors import (
    FLIGHT_SENSORS,
    PULSE_BEFORE_NS,
    PULSE_STEP_NS,
    pulse_table,
)
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest

REQUEST = FlightRequest(seed=5, length_m=40.0, density=6.0)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("flight") / "flight"
    simulate_flight(REQUEST, folder, SilentMonitor())
    return folder


def packets(folder: Path, cloud: laspy.LasData) -> NDArray[np.uint8]:
    """Counts of each point's packet."""
    size = int(cloud.wavepacket_size[0])
    raw = np.fromfile(folder / "in" / "flight.wdp", np.uint8)
    found: NDArray[np.uint8] = raw[
        np.asarray(cloud.wavepacket_offset, np.int64)[:, None] + np.arange(size)
    ]
    return found


def test_points_lie_where_their_pulse_went(made: Path) -> None:
    cloud = laspy.read(made / "in" / "flight.las")
    truth, beams = np.load(made / "truth" / "truth.npz"), np.load(made / "truth" / "beams.npz")
    along = truth["range_m"][:, None] * beams["direction"][truth["beam"]]
    assert np.abs(beams["origin"][truth["beam"]] + along - cloud.xyz).max() < 0.001
    assert np.array_equal(beams["gps"][truth["beam"]], cloud.gps_time)
    points = laspy.read(made / "in" / "points.laz")
    assert np.array_equal(points.X, cloud.X)
    assert np.array_equal(points.return_number, truth["rn"])


def test_a_return_lies_on_a_maximum_of_its_packet(made: Path) -> None:
    cloud = laspy.read(made / "in" / "flight.las")
    waves = packets(made, cloud).astype(float)
    place = np.asarray(cloud.return_point_wave_location) / 1000.0
    rows, sample = np.arange(len(waves)), np.rint(place).astype(int)
    around = [waves[rows, np.clip(sample + off, 0, waves.shape[1] - 1)] for off in (-2, 0, 2)]
    assert np.mean((around[1] >= around[0]) & (around[1] >= around[2])) > 0.99
    later = np.asarray(cloud.z_t)
    assert (later > 0).all(), "the direction of a packet points back to the aircraft"


def test_lone_returns_have_the_range_of_the_echo(made: Path) -> None:
    truth, beams = np.load(made / "truth" / "truth.npz"), np.load(made / "truth" / "beams.npz")
    echoes = np.bincount(beams["echo_beam"], minlength=beams["gps"].size)
    lone = (truth["nr"] == 1) & (echoes[truth["beam"]] == 1)
    of_beam = np.zeros(beams["gps"].size)
    of_beam[beams["echo_beam"]] = beams["echo_range"]
    off = truth["range_m"][lone] - of_beam[truth["beam"][lone]]
    assert lone.sum() > 3000
    assert abs(np.median(off)) < 0.003
    assert np.std(off) < 0.05


def test_every_class_is_there_and_crowns_are_gone_through(made: Path) -> None:
    truth = np.load(made / "truth" / "truth.npz")
    assert {2, 5, 6, 11} <= set(np.unique(truth["label"]).tolist())
    crown_beams = truth["beam"][(truth["label"] == 5) & (truth["rn"] == 1)]
    below = np.isin(truth["beam"][(truth["label"] == 2) & (truth["rn"] > 1)], crown_beams)
    assert below.sum() > 0.1 * crown_beams.size


def test_cleaned_waveforms_have_their_first_return_at_the_agreed_sample(made: Path) -> None:
    first, truth = np.load(made / "truth" / "first.npz"), np.load(made / "truth" / "truth.npz")
    assert first["wave"].shape == (first["index"].size, 160)
    assert (truth["rn"][first["index"]] == 1).all()
    lone = truth["nr"][first["index"]] == 1
    peak = first["wave"][lone].argmax(axis=1)
    assert np.mean(np.abs(peak - 12.5) <= 1.0) > 0.97


def test_the_same_seed_gives_the_same_files(made: Path, tmp_path: Path) -> None:
    simulate_flight(REQUEST, tmp_path / "again", SilentMonitor())
    for name in ("in/flight.las", "in/flight.wdp", "in/points.laz", "truth/truth.npz"):
        assert (tmp_path / "again" / name).read_bytes() == (made / name).read_bytes()
    scene = json.loads((made / "truth" / "scene.json").read_text(encoding="utf-8"))
    assert scene["points"] == laspy.read(made / "in" / "flight.las").header.point_count


@pytest.mark.parametrize("sensor", sorted(FLIGHT_SENSORS))
def test_a_pulse_has_its_maximum_where_it_says(sensor: str) -> None:
    table = pulse_table(FLIGHT_SENSORS[sensor])
    assert table.argmax() == round(PULSE_BEFORE_NS / PULSE_STEP_NS)
    assert table.max() == 1.0
    assert abs(table[0]) < 1e-6
    assert abs(table[-1]) < 1e-3
    width = np.count_nonzero(table > 0.5) * PULSE_STEP_NS
    assert 2.5 < width < 8.5


def test_an_unknown_scanner_is_refused_in_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(OutOfRange):
        simulate_flight(FlightRequest(sensor="x"), tmp_path / "x", SilentMonitor())
    assert not (tmp_path / "x").exists()

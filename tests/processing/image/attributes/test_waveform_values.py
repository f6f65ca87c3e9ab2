"""Waveforms as colours: measures of returns whose shape is known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import Unsuitable
from processing.core.monitor import SilentMonitor
from processing.image.attributes.attributes import available, colours
from processing.image.attributes.waveform_values import BACKSCATTER, waveform_values
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.drive import Drive
from processing.recording.waveform_packets.echo_shapes import echo_shapes
from tests.waveform_flight import FLYING_HEIGHT_M, import_flight, write_flight

_SIGMA_NS = 1.7
_TO_FULL_WIDTH = 2 * np.sqrt(2 * np.log(2))


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    folder = tmp_path_factory.mktemp("flight")
    return import_flight(write_flight(folder / "a.las").path, folder / "into")


def test_a_gaussian_return_has_its_own_height_width_energy_and_rise(drive: Drive) -> None:
    points = np.flatnonzero(drive.columns["number_of_returns"][:] == 1)
    amplitude = waveform_values(drive, "wave_amplitude", points)
    np.testing.assert_allclose(amplitude, 100, atol=5)
    width = waveform_values(drive, "wave_width", points)
    np.testing.assert_allclose(width, _TO_FULL_WIDTH * _SIGMA_NS, atol=0.25)
    energy = waveform_values(drive, "wave_energy", points)
    np.testing.assert_allclose(energy, 100 * _SIGMA_NS * np.sqrt(2 * np.pi), rtol=0.05)
    rise = waveform_values(drive, "wave_rise", points)
    np.testing.assert_allclose(rise, (2.146 - 0.459) * _SIGMA_NS, atol=0.3)


def test_each_return_of_a_pulse_has_values_of_its_own() -> None:
    time = np.arange(80.0)
    wave = 60 * np.exp(-((time - 20) ** 2) / 8) + 30 * np.exp(-((time - 50) ** 2) / 18) + 4
    samples = np.repeat(wave[None].astype(np.float32), 2, axis=0)
    shapes = echo_shapes(samples, np.full(2, 80, np.int32), np.full(2, 1.0), np.array([20.0, 50.0]))
    np.testing.assert_allclose(shapes.amplitude, [60, 30], atol=0.5)
    np.testing.assert_allclose(shapes.width_ns, [4.71, 7.06], atol=0.1)
    np.testing.assert_allclose(shapes.baseline, 4.0, atol=0.1)


def test_noise_alone_has_no_width() -> None:
    samples = np.random.default_rng(0).normal(6, 1, (1, 200)).astype(np.float32)
    shapes = echo_shapes(samples, np.array([200], np.int32), np.ones(1), np.array([100.4]))
    assert np.isnan(shapes.width_ns[0])
    assert abs(shapes.baseline[0] - 6) < 0.3


def test_waveforms_colour_points_and_backscatter_needs_the_range(
    drive: Drive, tmp_path: Path
) -> None:
    assert "wave_width" in available(drive)
    shown = colours(drive, np.arange(drive.count), "wave_width", 2, 98)
    assert len(np.unique(shown.reshape(-1, 3), axis=0)) > 3
    assert BACKSCATTER not in available(drive)
    with pytest.raises(Unsuitable, match="trajectory"):
        colours(drive, np.arange(3), BACKSCATTER, 2, 98)


def test_backscatter_is_the_energy_as_it_were_from_a_kilometre(tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "a.las")
    rows = [f"{999.9 + 0.2 * i},0,{10 + 20 * i},{FLYING_HEIGHT_M},0,0,0" for i in range(2)]
    header = "time_s,easting_m,northing_m,height_m,roll_deg,pitch_deg,heading_deg"
    path = tmp_path / "trajectory.csv"
    path.write_text("\n".join([header, *rows]))
    request = ImportRequest((flight.path,), trajectories=(path,))
    (folder,) = import_drives(request, tmp_path / "into", SilentMonitor())
    drive = Drive(folder)
    points = np.flatnonzero(drive.columns["number_of_returns"][:] == 1)
    energy = waveform_values(drive, "wave_energy", points)
    ratio = waveform_values(drive, BACKSCATTER, points) / energy
    np.testing.assert_allclose(ratio, (FLYING_HEIGHT_M / 1000) ** 2, rtol=0.01)

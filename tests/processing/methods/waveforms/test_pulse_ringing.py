"""Swings of a receiver among the returns, and echoes that are wide; ground knows of both."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest
from processing.methods.waveforms.pulse_ringing import ringing_of, ringing_returns
from processing.methods.waveforms.return_measures import broad_returns
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.columns.source_order import sources_of
from processing.recording.drive import Drive
from processing.recording.waveforms import waveforms_of
from processing.tools.ground import GROUND_TOOL, GroundParameters
from processing.tools.running.run_shares import mark_all

_PLANTS, _GROUND, _FALSE = 4, (2, 11), 0


class Flown:
    """The first strip of a flight by the scanner that rings, and what its points are."""

    def __init__(self, folder: Path) -> None:
        request = FlightRequest(
            seed=31, style="forest", sensor="conical", length_m=40.0, density=4.0
        )
        simulate_flight(request, folder / "flight", SilentMonitor())
        self.flight = folder / "flight"
        self.drive = self.imported("flight.las", folder / "drives")
        runs = self.drive.info.source_runs
        _, indices = sources_of(self.drive.columns, runs, 0, self.drive.count, sources=1)
        self.truth = np.load(self.flight / "truth" / "truth.npz")["label"][indices]

    def imported(self, name: str, into: Path) -> Drive:
        made = import_drives(ImportRequest((self.flight / "in" / name,)), into, SilentMonitor())
        return Drive(made[0])


@pytest.fixture(scope="module")
def flown(tmp_path_factory: pytest.TempPathFactory) -> Flown:
    return Flown(tmp_path_factory.mktemp("上空"))


def _ground(drive: Drive, into: Path, parameters: GroundParameters) -> NDArray[np.uint8]:
    copy = into / "copy"
    shutil.copytree(drive.folder, copy)
    drive = Drive(copy)
    folder = into / "ground"
    mark_all(GROUND_TOOL.id, [drive], SilentMonitor(), into=folder, parameters=parameters)
    return np.array(drive.columns["classification"])


def _waves(swing: float) -> NDArray[np.float32]:
    """Lone echoes of 4 samples' width, with a swing of some share 11 samples behind."""
    random = np.random.default_rng(2)
    place = random.uniform(20.0, 24.0, (400, 1))
    time = np.arange(80) - place
    pulse = np.exp(-0.5 * (time / 1.7) ** 2) + swing * np.exp(-0.5 * ((time - 11.0) / 2.0) ** 2)
    counts = random.uniform(60.0, 200.0, (400, 1)) * pulse + random.normal(10.0, 1.0, (400, 80))
    return np.rint(counts).astype(np.float32)


def test_a_swing_is_told_by_what_flat_targets_show_behind_their_maximum() -> None:
    shares = ringing_of(_waves(0.05), np.full(400, 80, np.int32))
    assert shares is not None
    assert shares.max() == pytest.approx(0.05, abs=0.006)
    assert abs(int(shares.argmax()) - 11) <= 1
    assert not shares[:6].any(), "the pulse itself is no swing"


def test_a_pulse_that_ends_has_no_swing() -> None:
    assert ringing_of(_waves(0.0), np.full(400, 80, np.int32)) is None
    assert ringing_of(_waves(0.05)[:10], np.full(10, 80, np.int32)) is None, "too few echoes"


def test_returns_of_a_swing_are_found_among_true_ones(flown: Flown) -> None:
    found = ringing_returns(flown.drive, SilentMonitor())
    assert found is not None
    assert found[flown.truth == _FALSE].mean() > 0.95
    assert found[flown.truth != _FALSE].mean() < 0.02


def test_ground_is_not_sunk_by_swings_of_the_receiver(flown: Flown, tmp_path: Path) -> None:
    codes = _ground(flown.drive, tmp_path, GroundParameters())
    is_ground = np.isin(flown.truth, _GROUND)
    assert (codes[flown.truth == _FALSE] == 2).mean() < 0.02
    assert (codes[is_ground] == 2).mean() > 0.5


def test_without_waveforms_no_option_changes_the_ground(flown: Flown, tmp_path: Path) -> None:
    drive = flown.imported("points.laz", tmp_path / "drives")
    assert ringing_returns(drive, SilentMonitor()) is None
    assert broad_returns(drive, 1.2, SilentMonitor()) is None
    plain = _ground(drive, tmp_path / "plain", GroundParameters())
    asked = _ground(drive, tmp_path / "asked", GroundParameters(widest_echo=1.2))
    assert np.array_equal(plain, asked)


def test_wide_echoes_are_no_ground_where_that_is_asked(flown: Flown, tmp_path: Path) -> None:
    broad = broad_returns(flown.drive, 1.35, SilentMonitor())
    assert broad is not None
    is_ground = np.isin(flown.truth, _GROUND)
    assert broad[flown.truth == _PLANTS].mean() > 3 * broad[is_ground].mean()
    codes = _ground(flown.drive, tmp_path, GroundParameters(widest_echo=1.35))
    assert not (codes[broad] == 2).any()


def test_the_returns_of_packets_come_with_their_packets(flown: Flown) -> None:
    waveforms = waveforms_of(flown.drive)
    assert waveforms is not None
    numbers = np.array([7, 3, waveforms.count - 1])
    points, row = waveforms.returns_of(numbers)
    assert np.array_equal(waveforms.pulse_of(points), numbers[row])
    first = np.flatnonzero(np.diff(row, prepend=-1))
    assert np.array_equal(points[first], waveforms.owners(numbers))
    assert np.array_equal(np.bincount(row), waveforms.pulses(numbers).returns)

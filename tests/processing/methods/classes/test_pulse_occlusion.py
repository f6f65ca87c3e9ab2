"""What the classes of flights looked at in a pulse: echoes, and no noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest
from processing.methods.classes.pulse_occlusion import (
    WINDOW_NS,
    PulseOcclusion,
    occluded_pulse,
)
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.drive import Drive
from processing.recording.shown_pulse import ShownPulse, pulse_behind
from processing.recording.waveform_packets.kept_packets import packets_path
from processing.recording.waveforms import waveforms_of
from processing.tools.running.runner import RunRequest, columns_of, run_together
from processing.tools.waveform_classify import WaveformClassifyParameters
from tests.waveform_flight import (
    change_descriptor,
    change_points,
    import_flight,
    write_flight,
)

MONITOR = SilentMonitor()
VEGETATION = 5
APART_NS = 12.0
"""Returns so far apart are no part of one window."""


def classified(drive: Drive, codes: NDArray[np.uint8]) -> Drive:
    """The drive, opened again with the classes of its points."""
    codes.astype(np.uint8).tofile(drive.folder / "label.bin")
    return Drive(drive.folder)


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, NDArray[np.float32]]:
    """A village of a seed that nothing was learnt from, with the classes that a run gave it."""
    folder = tmp_path_factory.mktemp("flight")
    request = FlightRequest(seed=7301, style="village", length_m=40.0, density=6.0)
    simulate_flight(request, folder / "made", MONITOR)
    delivered = ImportRequest((folder / "made" / "in" / "flight.las",))
    drive = Drive(import_drives(delivered, folder / "drives", MONITOR)[0])
    asked = RunRequest("waveform-classify", drive, WaveformClassifyParameters())
    result = run_together(asked, MONITOR, into=folder / "classes")
    columns = columns_of(result.columns[0])
    return classified(drive, np.array(columns["classification"])), np.array(columns["confidence"])


def occluded(drive: Drive, point: int) -> PulseOcclusion:
    found = occluded_pulse((drive,), drive, point, MONITOR)
    assert isinstance(found, PulseOcclusion)
    return found


def shown(drive: Drive, point: int) -> ShownPulse:
    found = pulse_behind(drive, point)
    assert isinstance(found, ShownPulse)
    return found


def first_returns(drive: Drive, code: int, most: int) -> list[int]:
    """First of several returns of a class, whose next one is well behind."""
    columns = drive.columns
    asked = np.asarray(columns["label"]) == code
    asked &= np.asarray(columns["return_number"]) == 1
    asked &= np.asarray(columns["number_of_returns"]) > 1
    places = {point: shown(drive, point).places_ns for point in np.flatnonzero(asked).tolist()}
    apart = [one for one, at in places.items() if at.size > 1 and at[1] - at[0] > APART_NS]
    return apart[:most]


def on_noise(pulse: ShownPulse, found: PulseOcclusion) -> NDArray[np.bool_]:
    """Which windows hold nothing but noise, far from any return."""
    interval = pulse.descriptor.interval_ns
    times = np.arange(pulse.counts.size) * interval
    inside = (times >= found.starts_ns[:, None]) & (
        times < found.starts_ns[:, None] + found.window_ns
    )
    stands_out = pulse.counts > pulse.shapes.baseline[0] + 2 * pulse.shapes.noise[0]
    away = np.abs(found.middles_ns[:, None] - pulse.places_ns).min(axis=1) > APART_NS
    are_noise: NDArray[np.bool_] = away & ~(inside & stands_out).any(axis=1)
    return are_noise


def test_windows_go_over_the_whole_waveform(flight: tuple[Drive, NDArray[np.float32]]) -> None:
    drive, _ = flight
    point = first_returns(drive, VEGETATION, 1)[0]
    found, pulse = occluded(drive, point), shown(drive, point)
    assert found.window_ns == pytest.approx(WINDOW_NS, abs=pulse.descriptor.interval_ns / 2)
    assert found.drops.shape == found.drops_together.shape == found.starts_ns.shape
    assert found.starts_ns[0] == 0
    end = found.starts_ns[-1] + found.window_ns
    assert end == pytest.approx(pulse.counts.size * pulse.descriptor.interval_ns)
    assert (np.diff(found.starts_ns) > 0).all()
    for drops in (found.drops, found.drops_together):
        assert (drops <= found.share + 1e-6).all()
        assert (drops >= found.share - 1 - 1e-6).all()


def test_trees_are_asked_as_in_the_run(flight: tuple[Drive, NDArray[np.float32]]) -> None:
    drive, sure = flight
    points = np.arange(50, drive.count, drive.count // 25).tolist()
    off = [abs(occluded(drive, point).share - sure[point]) for point in points]
    assert np.median(off) < 0.02


def test_a_class_hangs_on_echoes_and_not_on_noise(
    flight: tuple[Drive, NDArray[np.float32]],
) -> None:
    drive, _ = flight
    most, noise, on_second = [], [], []
    for point in first_returns(drive, VEGETATION, 30):
        found, pulse = occluded(drive, point), shown(drive, point)
        are_noise = on_noise(pulse, found)
        second = np.abs(found.middles_ns - pulse.places_ns[1]) < 2
        most.append(found.drops_together.max())
        on_second.append(found.drops_together[second].max())
        noise.append(np.abs(found.drops_together[are_noise]).max(initial=0.0))
    assert np.median(most) > 0.5
    assert max(on_second) > 0.5
    hangs_on_second = int(np.argmax(on_second))
    assert noise[hangs_on_second] < 0.1 * on_second[hangs_on_second]
    assert np.quantile(noise, 0.9) < 0.02


def test_a_window_that_is_lost_for_good_costs_what_was_told(
    flight: tuple[Drive, NDArray[np.float32]],
) -> None:
    drive, _ = flight
    points = first_returns(drive, VEGETATION, 400)
    told = [(occluded(drive, point), point) for point in points[::4]]
    found, point = max(told, key=lambda one: float(one[0].drops.max()))
    worst = int(found.drops.argmax())
    assert found.drops[worst] > 0.05
    waveforms = waveforms_of(drive)
    assert waveforms is not None
    pulses = waveforms.pulses(waveforms.pulse_of(np.array([point])))
    path = packets_path(drive.folder, int(pulses.file[0]))
    kept = path.read_bytes()
    data, pulse = bytearray(kept), shown(drive, point)
    bytes_each = pulse.descriptor.bits // 8
    assert bytes_each == 1
    start = int(pulses.byte[0]) + round(found.starts_ns[worst] / pulse.descriptor.interval_ns)
    base = int(pulse.shapes.baseline[0])
    for at in range(start, start + round(found.window_ns / pulse.descriptor.interval_ns)):
        data[at] = min(data[at], base)
    path.write_bytes(data)
    try:
        again = occluded(Drive(drive.folder), point)
    finally:
        path.write_bytes(kept)
    # What the first trees say of cells around changes a little, too, where it is recorded so.
    assert again.share == pytest.approx(found.share - found.drops[worst], abs=0.05)


def test_strips_that_were_flown_together_are_seen_together(
    flight: tuple[Drive, NDArray[np.float32]], tmp_path: Path
) -> None:
    drive, _ = flight
    point = first_returns(drive, VEGETATION, 1)[0]
    far = import_flight(write_flight(tmp_path / "far.las", 300).path, tmp_path)
    far = classified(far, np.full(far.count, 2, np.uint8))
    found = occluded_pulse((far, drive), drive, point, MONITOR)
    assert isinstance(found, PulseOcclusion)
    assert found.code == VEGETATION


@pytest.mark.parametrize(("spacing_ps", "samples"), [(500, 10), (1000, 5), (2000, 2), (8000, 1)])
def test_windows_are_as_long_whatever_the_sampling(
    tmp_path: Path, spacing_ps: int, samples: int
) -> None:
    made = write_flight(tmp_path / "flight.las", 300, spacing_ps=spacing_ps)
    drive = import_flight(made.path, tmp_path)
    drive = classified(drive, np.full(drive.count, 2, np.uint8))
    found = occluded(drive, 7)
    assert found.window_ns == pytest.approx(samples * spacing_ps / 1000)
    assert np.isfinite(found.drops).all()


def _reason(drive: Drive, point: int = 0) -> str:
    found = occluded_pulse((drive,), drive, point, MONITOR)
    assert isinstance(found, Text)
    assert found.ja
    return found.en


def test_what_cannot_be_said_has_a_reason(tmp_path: Path) -> None:
    made = write_flight(tmp_path / "flight.las", 300)
    drive = import_flight(made.path, tmp_path)
    assert "none of the six classes" in _reason(drive)
    noise = classified(drive, np.full(drive.count, 7, np.uint8))
    assert "none of the six classes" in _reason(noise)


def test_a_waveform_of_one_sample_has_no_echo(tmp_path: Path) -> None:
    made = write_flight(tmp_path / "flight.las", 300)
    change_descriptor(made.path, samples=1)
    change_points(made.path, lambda fields: fields["size"].__setitem__(slice(None), 1))
    drive = import_flight(made.path, tmp_path)
    drive = classified(drive, np.full(drive.count, 2, np.uint8))
    assert "too short" in _reason(drive)


def test_a_point_without_a_waveform_says_so(
    flight: tuple[Drive, NDArray[np.float32]], tmp_path: Path
) -> None:
    made = write_flight(tmp_path / "flight.las", 300)
    made.path.with_suffix(".wdp").unlink()
    drive = import_flight(made.path, tmp_path)
    drive = classified(drive, np.full(drive.count, 2, np.uint8))
    assert "no waveform" in _reason(drive)

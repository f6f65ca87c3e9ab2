"""Estimated waveforms from the command line: packets beside the points, where and as promised."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest
from numpy.typing import NDArray

from app.cli.terminal import run_in_terminal
from processing.methods.waveforms.estimation.flown_path import flown_path
from tests.waveform_flight import METRES_IN_PS, Flight, write_flight

DONE, BAD_INPUT = 0, 2
SIGMA_NS, SAMPLES, FIRST_NS = 1.7, 160, 12.5


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> Flight:
    return write_flight(tmp_path_factory.mktemp("飛行") / "flight.las", pulses=90)


@pytest.fixture(scope="module")
def archive(flight: Flight) -> Path:
    """The flight as an archive keeps it: format 6, no waveforms, every return as bright."""
    delivered = laspy.read(flight.path)
    delivered.intensity = np.where(np.asarray(delivered.return_number) == 1, 40_000, 30_000)
    path = flight.path.with_name("points.las")
    laspy.convert(delivered, point_format_id=6).write(path)
    return path


@pytest.fixture(scope="module")
def pulse(flight: Flight) -> Path:
    path = flight.path.with_name("pulse.csv")
    times = np.arange(-10.0, 10.01, 0.25)
    rows = zip(times.tolist(), np.exp(-(times**2) / (2 * SIGMA_NS**2)).tolist(), strict=True)
    path.write_text("time_ns,amplitude\n" + "".join(f"{t:.2f},{a:.6f}\n" for t, a in rows))
    return path


def run(*arguments: object) -> object:
    return run_in_terminal(["run", "waveform-estimate", *map(str, arguments)])


def counts_of(path: Path) -> tuple[laspy.LasData, NDArray[np.float64]]:
    """The points, and for each its packet's counts, read by another reader."""
    cloud = laspy.read(path)
    (described,) = (one.parsed_record for one in cloud.header.vlrs if one.record_id == 100)
    assert described.number_of_samples == SAMPLES
    assert described.temporal_sample_spacing == 1000
    assert described.digitizer_offset == 0.0
    raw = np.fromfile(path.with_suffix(".wdp"), np.uint8)
    begin = np.asarray(cloud.wavepacket_offset, np.int64)
    size = SAMPLES * described.bits_per_sample // 8
    samples = np.ascontiguousarray(raw[begin[:, None] + np.arange(size)]).view("<u2")
    return cloud, samples * described.digitizer_gain


def test_each_pulse_has_its_packet_with_echoes_at_its_returns(
    archive: Path, pulse: Path, tmp_path: Path
) -> None:
    output = tmp_path / "推定.las"
    assert run(archive, "--set", f"pulse={pulse}", "--output", output) == DONE
    cloud, counts = counts_of(output)
    delivered = laspy.read(archive)
    order = np.lexsort((np.asarray(delivered.return_number), np.asarray(delivered.gps_time)))
    assert cloud.header.point_format.id == 9
    for name in ("X", "Y", "Z", "intensity", "gps_time", "return_number", "number_of_returns"):
        assert np.array_equal(cloud[name], np.asarray(delivered[name])[order]), name
    location_ns = np.asarray(cloud.return_point_wave_location) / 1000
    first = np.asarray(cloud.return_number) == 1
    assert location_ns[first] == pytest.approx(FIRST_NS)
    # The packet of a pulse is shared by its returns, and both stand in it where they lie.
    later = np.flatnonzero(~first)
    assert np.array_equal(cloud.wavepacket_offset[later], cloud.wavepacket_offset[later - 1])
    rows = np.arange(len(counts))
    near = np.rint(location_ns).astype(int)
    assert counts[rows, near].min() > 0.5 * 30_000 / 257
    assert counts[:, -20:].max() < 2.0
    towards = np.stack([cloud.x_t, cloud.y_t, cloud.z_t], axis=1)
    assert np.linalg.norm(towards, axis=1) == pytest.approx(METRES_IN_PS, rel=1e-3)
    assert (towards[:, 2] > 0).all()


def test_positions_alone_do_without_intensities(archive: Path, tmp_path: Path) -> None:
    output = tmp_path / "positions.las"
    assert run(archive, "--set", "inputs=positions", "--output", output) == DONE
    cloud, counts = counts_of(output)
    alone = np.asarray(cloud.number_of_returns) == 1
    assert np.median(counts[alone].max(axis=1)) == pytest.approx(100.0, abs=40.0)


def test_what_can_not_be_done_is_told_and_nothing_is_left(
    archive: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = tmp_path / "bad.csv"
    bad.write_text("time_ns,amplitude\n1,2\n1,3\n")
    output = tmp_path / "out.las"
    assert run(archive, "--set", f"pulse={bad}", "--output", output) == BAD_INPUT
    assert run(archive, "--output", tmp_path / "out.laz") == BAD_INPUT
    assert ".las" in capsys.readouterr().err
    assert run(archive, "--output", archive) == BAD_INPUT
    assert not list(tmp_path.glob("out*"))


def test_the_aircraft_is_found_where_the_rays_come_from() -> None:
    rng = np.random.default_rng(3)
    time = np.sort(rng.uniform(100.0, 104.0, 200))
    place = np.column_stack([60.0 * (time - 100.0), np.full(200, 20.0), np.full(200, 500.0)])
    foot = np.column_stack([place[:, 0], rng.uniform(-150, 150, 200), np.zeros(200)])
    ray = (foot - place) / np.linalg.norm(foot - place, axis=1)[:, None]
    first = foot - rng.uniform(2.0, 12.0, 200)[:, None] * ray
    path = flown_path(time, np.round(first, 3), np.round(foot, 3), (100.0, 104.0))
    found = path.directions(first, time)
    assert np.degrees(np.arccos(np.clip((found * ray).sum(axis=1), -1, 1))).max() < 0.05

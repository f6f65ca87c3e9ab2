"""Echoes of waveforms from the command line: a point for each, on its ray, by its pulse's time."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest

from app.cli.terminal import run_in_terminal
from tests.waveform_flight import METRES_IN_PS, Flight, write_flight

DONE, BAD_INPUT = 0, 2
SIGMA_NS = 1.7
HALF_PS_NS = METRES_IN_PS * 1000


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> Flight:
    return write_flight(tmp_path_factory.mktemp("飛行") / "flight.las", pulses=90)


@pytest.fixture(scope="module")
def pulse(flight: Flight) -> Path:
    path = flight.path.with_name("pulse.csv")
    times = np.arange(-10.0, 10.01, 0.25)
    rows = zip(times.tolist(), np.exp(-(times**2) / (2 * SIGMA_NS**2)).tolist(), strict=True)
    path.write_text("time_ns,amplitude\n" + "".join(f"{t:.2f},{a:.6f}\n" for t, a in rows))
    return path


def run(*arguments: object) -> int:
    return run_in_terminal(["run", "waveform-decompose", *map(str, arguments)])


@pytest.mark.parametrize("is_given", [True, False])
def test_every_surface_is_a_point_by_the_time_of_its_pulse(
    flight: Flight, pulse: Path, tmp_path: Path, *, is_given: bool
) -> None:
    output = tmp_path / "エコー.laz"
    known = ["--set", f"pulse={pulse}"] if is_given else []
    assert run(flight.path, *known, "--output", output) == DONE
    found = laspy.read(output)
    assert found.header.point_format.id == 6
    assert len(found.points) == len(flight.xyz)
    delivered = laspy.read(flight.path)
    order = np.lexsort((np.asarray(found.return_number), np.asarray(found.gps_time)))
    true = np.lexsort((np.asarray(delivered.return_number), np.asarray(delivered.gps_time)))
    assert np.array_equal(found.gps_time[order], delivered.gps_time[true])
    assert np.array_equal(found.number_of_returns[order], delivered.number_of_returns[true])
    away = np.linalg.norm(np.asarray(found.xyz)[order] - flight.xyz[true], axis=1)
    assert away.max() < 0.015
    assert np.median(away) < 0.005
    assert np.asarray(found["amplitude"]) == pytest.approx(100.0, rel=0.05)
    assert np.asarray(found["range_sigma_m"]).max() < 0.01
    parsed = found.header.parse_crs()
    assert parsed is not None
    assert parsed.to_epsg() == 6677


def test_what_can_not_be_decomposed_is_told_in_a_sentence(
    flight: Flight, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "echoes.las"
    bad = tmp_path / "bad.csv"
    bad.write_text("time_ns,amplitude\n1,2\n1,3\n")
    assert run(flight.path, "--set", f"pulse={bad}", "--output", output) == BAD_INPUT
    assert "line 3" in capsys.readouterr().err or "3行目" in capsys.readouterr().err
    assert run(flight.path) == BAD_INPUT
    assert run(flight.path, "--output", tmp_path / "echoes.txt") == BAD_INPUT
    bare = tmp_path / "bare" / "flight.las"
    bare.parent.mkdir()
    bare.write_bytes(flight.path.read_bytes())
    assert run(bare, "--output", output) == BAD_INPUT
    assert not output.exists()


def test_the_delivered_file_is_never_written(flight: Flight) -> None:
    before = flight.path.read_bytes()
    assert run(flight.path, "--output", flight.path) == BAD_INPUT
    assert flight.path.read_bytes() == before

"""``zuka score`` on decomposed and estimated waveforms: the truth itself, other files."""

from __future__ import annotations

import shutil
from pathlib import Path

import laspy
import numpy as np
import pytest

from app.cli.terminal import DONE, run_in_terminal
from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest
from tests.app.score_answers import refused, scored


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("飛行") / "flight"
    simulate_flight(FlightRequest(seed=5, length_m=40.0, density=2.0), folder, SilentMonitor())
    return folder


def perfect_points(flight: Path, path: Path, *, moved_m: float = 0.0, later_s: float = 0.0) -> Path:
    """The true echoes as points."""
    beams = np.load(flight / "truth" / "beams.npz")
    beam = beams["echo_beam"]
    xyz = (
        beams["origin"][beam] + (beams["echo_range"] + moved_m)[:, None] * beams["direction"][beam]
    )
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = np.full(3, 0.0001), np.floor(xyz.min(axis=0))
    cloud = laspy.LasData(header)
    cloud.xyz, cloud.gps_time = xyz, beams["gps"][beam] + later_s
    order = np.random.default_rng(3).permutation(beam.size)
    cloud.points = cloud.points[order]
    cloud.write(path)
    return path


def test_true_echoes_are_all_found_wherever_they_stand_in_the_file(
    flight: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    points = perfect_points(flight, tmp_path / "結果.las", moved_m=0.005)
    for truth in (flight, flight / "truth", flight / "truth" / "beams.npz"):
        told = scored(capsys, "waveform-decompose", points, truth)
        shares = {name: one["share"] for name, one in told["shares"].items()}
        assert shares["alone"] == 1.0
        assert shares["false"] == 0.0
        assert shares["split"] < 0.005
        assert told["errors"]["range"]["mean"] == pytest.approx(0.005, abs=0.001)
        assert told["left_out"]["points_of_no_pulse"] == 0
    assert run_in_terminal(["score", "waveform-decompose", str(points), str(flight)]) == DONE
    assert "%" in capsys.readouterr().out


def test_points_of_other_pulses_are_refused_or_false(
    flight: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = perfect_points(flight, tmp_path / "other.las", later_s=5000.0)
    assert "other.las" in refused(capsys, "waveform-decompose", other, flight)
    cloud = laspy.read(perfect_points(flight, tmp_path / "some.las"))
    cloud.gps_time = np.where(np.arange(len(cloud.points)) < 10, 0.0, cloud.gps_time)
    cloud.write(tmp_path / "some.las")
    told = scored(capsys, "waveform-decompose", tmp_path / "some.las", flight)
    assert told["left_out"]["points_of_no_pulse"] == 10
    assert told["shares"]["false"]["count"] == 10


def test_estimated_waveforms_are_held_against_those_of_first_returns(
    flight: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "推定.las"
    pulse = f"pulse={flight / 'in' / 'system_pulse.csv'}"
    points = str(flight / "in" / "points.laz")
    assert (
        run_in_terminal(
            ["run", "waveform-estimate", points, "--set", pulse, "--output", str(output)]
        )
        == DONE
    )
    capsys.readouterr()
    told = scored(capsys, "waveform-estimate", output, flight / "truth" / "first.npz")
    assert told["shares"]["with_waveform"]["share"] > 0.99
    errors = told["errors"]
    assert errors["fitted"]["mean"] <= errors["as_written"]["mean"]
    assert told["figures"]["by_constant"] < 0.5
    assert errors["class_2"]["unit"] == "counts"
    output.with_suffix(".wdp").unlink()
    assert ".wdp" in refused(capsys, "waveform-estimate", output, flight)


def test_what_the_truth_lacks_is_told_in_a_sentence(
    flight: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    points = perfect_points(flight, tmp_path / "points.las")
    bare = tmp_path / "bare" / "truth"
    bare.mkdir(parents=True)
    assert "beams.npz" in refused(capsys, "waveform-decompose", points, bare)
    for name in ("beams.npz", "truth.npz"):
        shutil.copy(flight / "truth" / name, bare / name)
    assert str(bare.parent / "in") in refused(capsys, "waveform-decompose", points, bare)
    (bare / "beams.npz").write_bytes(b"PK\x03\x04damaged")
    assert "beams.npz" in refused(capsys, "waveform-decompose", points, bare)
    np.savez(bare / "first.npz", wave=np.zeros((2, 160)))
    assert "first.npz" in refused(capsys, "waveform-estimate", points, bare)
    assert refused(capsys, "waveform-estimate", points, flight)

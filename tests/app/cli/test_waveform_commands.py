"""``zuka info``, ``import`` and ``export`` tell and keep the waveforms of a flight."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.parser import read_arguments
from tests.pulsewaves_flight import write_pulse_flight
from tests.waveform_flight import SAMPLES, write_flight


def _printed(capsys: pytest.CaptureFixture[str], *words: object) -> str:
    command, arguments = read_arguments([str(word) for word in words])
    assert command(arguments) == 0
    return capsys.readouterr().out


def test_info_counts_the_pulses_of_a_file_and_of_its_project(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    flight = write_flight(tmp_path / "a.las", bits=16, spacing_ps=500)
    told = json.loads(_printed(capsys, "info", flight.path, "--json"))["waveforms"]
    wanted = {"pulses": 60, "points_with": 80, "samples": [SAMPLES], "interval_ns": [0.5]}
    assert {name: told[name] for name in wanted} == wanted
    assert (told["bits"], told["packets"]) == ([16], str(flight.path.with_suffix(".wdp")))
    project = tmp_path / "a.zuka"
    _printed(capsys, "import", project, flight.path)
    (drive,) = json.loads(_printed(capsys, "info", project, "--json"))["drives"]
    assert {name: drive["waveforms"][name] for name in wanted} == wanted
    assert drive["rows_by"] == "top-view"
    _printed(capsys, "export", project, "--format", "las", "--out", tmp_path / "out")
    packets = (tmp_path / "out" / "a.wdp").read_bytes()
    assert packets == flight.path.with_suffix(".wdp").read_bytes()


def test_an_import_without_the_packets_says_which_file_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    flight = write_flight(tmp_path / "a.las")
    flight.path.with_suffix(".wdp").unlink()
    assert "a.wdp" in _printed(capsys, "info", flight.path)
    assert "a.wdp" in _printed(capsys, "import", tmp_path / "a.zuka", flight.path)


def test_pulsewaves_are_imported_and_written_again_as_las(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    flight = write_pulse_flight(tmp_path / "a.pls")
    told = json.loads(_printed(capsys, "info", flight.path, "--json"))
    assert (told["format"], told["points"], told["crs"]) == ("PulseWaves", 160, "EPSG:6677")
    assert told["waveforms"]["packets"] == str(tmp_path / "a.wvs")
    assert "160" in told["waveforms"]["remarks"][0]
    project = tmp_path / "a.zuka"
    assert "160" in _printed(capsys, "import", project, flight.path)
    (drive,) = json.loads(_printed(capsys, "info", project, "--json"))["drives"]
    assert (drive["waveforms"]["pulses"], drive["rows_by"]) == (160, "top-view")
    out = tmp_path / "out"
    written = _printed(capsys, "export", project, "--format", "las", "--out", out).split()
    assert sorted(Path(one).name for one in written) == ["a.laz", "a.wdp"]
    told = json.loads(_printed(capsys, "info", out / "a.laz", "--json"))
    assert (told["points"], told["waveforms"]["pulses"]) == (160, 160)

"""The table of estimated waveforms: every estimate is held against the right truth."""

from __future__ import annotations

from pathlib import Path

import pytest

from processing.core.monitor import SilentMonitor
from processing.laboratory.accuracy.waveform_estimates import main
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest


def test_estimates_of_a_flight_are_nearer_than_what_is_said_without_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    request = FlightRequest(seed=12, length_m=40.0, density=2.0)
    simulate_flight(request, tmp_path / "flight", SilentMonitor())
    assert main([str(tmp_path / "flight"), "--seeds", ""]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("| ")]
    names, cells = ([cell.strip() for cell in line.split("|")[1:-1]] for line in lines)
    assert cells[0] == "sample `flight`"
    values = dict(zip(names[1:-1], map(float, cells[1:-1]), strict=True))
    assert values["estimated"] < values["plain"] < values["constant"] < values["zero"]
    assert values["positions"] < values["constant"]
    assert values["by plain"] == pytest.approx(values["estimated"] / values["plain"], abs=0.02)

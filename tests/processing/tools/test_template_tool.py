"""The tool TEMPLATE by its parameters: from a file, at a place in plan, with words for refusals."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import MissingInput, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.core.parameters import fill_parameters
from processing.methods.templates.template_text import template_text
from processing.recording.drive import Drive
from processing.tools.running.runner import RunRequest, run
from processing.tools.template import TEMPLATE, TemplateParameters
from processing.tools.tool import CandidateResult
from tests.builders import simulated_drive
from tests.processing.methods.templates.curb_street import (
    CURB,
    CURB_FRAME,
    TOP_M,
    imported,
    off_edge,
    recorded,
)

EAST, NORTH, HEIGHT = CURB_FRAME.position.tolist()


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return recorded(tmp_path_factory.mktemp("street"))


def run_with(drive: Drive, **values: float | str) -> CandidateResult:
    parameters = fill_parameters(TemplateParameters, values)
    result = run(
        RunRequest(TEMPLATE.id, drive, parameters), SilentMonitor(), into=drive.folder / "new"
    )
    assert isinstance(result, CandidateResult)
    return result


def test_a_file_and_a_place_in_plan_are_enough(street: Drive, tmp_path: Path) -> None:
    path = tmp_path / "縁石.json"
    path.write_text(template_text(CURB), encoding="utf-8")
    found = run_with(street, template=str(path), easting_m=EAST + 0.1, northing_m=NORTH).candidates
    assert [one.kind for one in found] == ["curb_upper", "curb_upper"]
    assert [one.attributes["edge"] for one in found] == ["upper", "lower"]
    upper = found[0]
    assert upper.geometry == "line"
    assert off_edge(upper.xyz, TOP_M).max() < 0.01
    scores = [float(one) for one in str(upper.attributes["score_per_m"]).split()]
    assert np.mean(scores) == pytest.approx(upper.confidence, abs=0.01)
    assert len(scores) == pytest.approx(float(upper.attributes["length_m"] or 0), abs=1.5)


def test_the_same_place_gives_the_same_line_by_height_and_direction(street: Drive) -> None:
    heading = (90.0 - np.degrees(CURB_FRAME.heading_rad)) % 360.0
    given = {"template": template_text(CURB), "easting_m": EAST, "northing_m": NORTH}
    by_plan = run_with(street, **given).candidates[0]
    exactly = run_with(street, **given, height_m=HEIGHT, heading_deg=heading).candidates[0]
    assert off_edge(exactly.xyz, TOP_M).max() < 0.01
    assert exactly.attributes["length_m"] == pytest.approx(
        float(by_plan.attributes["length_m"] or 0), abs=1.0
    )


def test_without_a_template_it_is_refused(street: Drive) -> None:
    with pytest.raises(MissingInput, match="No template"):
        run_with(street, easting_m=EAST, northing_m=NORTH)
    with pytest.raises(MissingInput, match="no such file"):
        run_with(street, template="nowhere.json", easting_m=EAST, northing_m=NORTH)


def test_a_start_away_from_the_recording_is_refused(street: Drive) -> None:
    with pytest.raises(Unsuitable, match="No measured point"):
        run_with(street, template=template_text(CURB), easting_m=EAST + 500.0, northing_m=NORTH)


def test_with_a_trajectory_nothing_is_remarked(street: Drive) -> None:
    assert TEMPLATE.remark(street) is None


def test_without_a_trajectory_the_direction_must_be_given(tmp_path: Path) -> None:
    straight = simulated_drive(3, pulses_per_revolution=1200.0, length_m=8.0, range_noise_m=0.0)
    drive = imported(tmp_path, straight, is_bare=True)
    remark = TEMPLATE.remark(drive)
    assert remark is not None
    assert "direction" in remark.en
    given = {"template": template_text(CURB), "easting_m": -11_034.0, "northing_m": -35_016.0}
    with pytest.raises(Unsuitable, match="direction"):
        run_with(drive, **given)
    found = run_with(drive, **given, heading_deg=0.0).candidates
    assert np.abs(found[0].xyz[:, 0] + 11_034.0).max() < 0.01

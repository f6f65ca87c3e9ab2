"""Drives registered from files: what is written, how true it is, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import laspy
import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.core.errors import BadFile, Cancelled, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.formats.trajectories.trajectory_files import read_trajectory
from processing.operations.inputs import OperationInputs
from processing.operations.registration.register import RegisterOperation, register
from tests.processing.methods.registration.driven_street import (
    ORIGIN,
    DrivenPass,
    Errors,
    drive_street,
)

_CRS = "EPSG:6677"
_FIRST = Errors((0.012, -0.008, 0.010), (0.006, 0.004, -0.005), (0.008, 0.0, -0.006))
_SECOND = Errors((-0.015, 0.010, -0.012), (-0.004, 0.0, 0.006), (-0.01, 0.005, 0.01))


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> tuple[DrivenPass, DrivenPass]:
    """Two passes with errors of their own."""
    folder = tmp_path_factory.mktemp("street")
    return drive_street(folder, 0, _FIRST), drive_street(folder, 1, _SECOND)


def _run(
    passes: tuple[DrivenPass, ...], output: Path, control: Path | None = None
) -> dict[str, Any]:
    inputs = OperationInputs(
        points=tuple(one.points for one in passes),
        trajectories=tuple(one.trajectory for one in passes),
        crs=_CRS,
    )
    parameters = {} if control is None else {"control": str(control)}
    register(RegisterOperation(inputs, output, parameters), SilentMonitor())
    report: dict[str, Any] = json.loads((output / "report.json").read_text(encoding="utf-8"))
    return report


def _control_file(path: Path, *, blunder_m: float = 0.0, swapped: bool = False) -> Path:
    """Corners of dashes along the middle; every third is a check point."""
    lines = ["id,easting_m,northing_m,height_m,role,where"]
    for number, north in enumerate(np.arange(4.0, 56.0, 4.0)):
        east, up, north = ORIGIN[0] - 0.075, ORIGIN[2], ORIGIN[1] + north
        if number == 4:
            up += blunder_m
        if swapped:
            east, north = north, east
        role = "check" if number % 3 == 2 else "control"
        lines.append(f"K{number},{east:.4f},{north:.4f},{up:.4f},{role},marking_corner")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def _errors(output: Path, one: DrivenPass) -> Floats:
    written = laspy.read(output / one.points.name)
    return np.asarray(written.xyz) - one.true_xyz


def test_two_passes_come_to_lie_on_each_other(
    street: tuple[DrivenPass, DrivenPass], tmp_path: Path
) -> None:
    report = _run(street, tmp_path / "out")
    gaps = report["between_drives"]["passes"]
    assert gaps["before"]["median_m"] > 0.01
    assert gaps["after"]["median_m"] < 0.002
    assert gaps["after"]["p95_m"] < 0.005
    # What both are off together nobody can know; how far it may be is told.
    told = report["trajectories"][0]
    for one in street:
        mean = np.abs(_errors(tmp_path / "out", one).mean(axis=0))
        assert np.hypot(*mean[:2]) < 3 * told["sigma_plan_m"]
        assert mean[2] < 3 * told["sigma_height_m"]


def test_control_points_put_the_street_where_it_is_and_a_wrong_one_is_named(
    street: tuple[DrivenPass, DrivenPass], tmp_path: Path
) -> None:
    control = _control_file(tmp_path / "control.csv", blunder_m=0.1)
    report = _run(street, tmp_path / "out", control)
    wrong = [one["id"] for one in report["control_points"] if one["left_out"]]
    # A line of paint has a second corner 15 cm away, which may be taken for the one that is meant.
    assert "K4" in wrong
    assert report["check"]["after"]["rmse_plan_m"] < 0.015
    assert report["check"]["after"]["rmse_height_m"] < 0.006
    for one in street:
        off = _errors(tmp_path / "out", one)
        # Rows lie 5 cm apart: the ends of eight dashes are known to a centimetre together.
        assert np.sqrt((off[:, :2] ** 2).sum(axis=1).mean()) < 0.012
        assert np.sqrt((off[:, 2] ** 2).mean()) < 0.006


def test_points_keep_all_but_their_places_and_delivered_files_stay(
    street: tuple[DrivenPass, DrivenPass], tmp_path: Path
) -> None:
    before = [one.points.read_bytes() for one in street]
    _run(street, tmp_path / "out")
    assert [one.points.read_bytes() for one in street] == before
    for one in street:
        delivered, written = laspy.read(one.points), laspy.read(tmp_path / "out" / one.points.name)
        for name in ("gps_time", "intensity", "point_source_id", "return_number"):
            assert np.array_equal(delivered[name], written[name])


def test_corrected_trajectories_say_the_same_in_both_formats(
    street: tuple[DrivenPass, DrivenPass], tmp_path: Path
) -> None:
    _run(street, tmp_path / "out")
    table = read_trajectory(tmp_path / "out" / "trajectory_1.csv", _CRS)
    binary = read_trajectory(tmp_path / "out" / "trajectory_1.out", _CRS)
    assert np.abs(table.xyz - binary.xyz).max() < 1e-4
    turned = table.roll_pitch_heading_deg - binary.roll_pitch_heading_deg
    assert np.abs((turned + 180.0) % 360.0 - 180.0).max() < 1e-4


@pytest.mark.parametrize("alone", [0, 1])
def test_one_pass_alone_is_refused(
    street: tuple[DrivenPass, DrivenPass], tmp_path: Path, alone: int
) -> None:
    with pytest.raises(Unsuitable, match="nothing to be set on"):
        _run((street[alone],), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_swapped_axes_of_control_points_are_named(
    street: tuple[DrivenPass, DrivenPass], tmp_path: Path
) -> None:
    control = _control_file(tmp_path / "control.csv", swapped=True)
    with pytest.raises(Unsuitable) as refused:
        _run(street, tmp_path / "out", control)
    assert "swapped" in refused.value.remedy.en


def test_fewer_than_three_control_points_are_refused(
    street: tuple[DrivenPass, DrivenPass], tmp_path: Path
) -> None:
    control = _control_file(tmp_path / "control.csv")
    lines = control.read_text(encoding="utf-8").splitlines()
    control.write_text("\n".join(lines[:3]) + "\n", encoding="utf-8")
    with pytest.raises(Unsuitable, match="Fewer than three"):
        _run(street, tmp_path / "out", control)


@pytest.mark.parametrize(
    ("line", "message"),
    [("K1,a,2,3,control,", "not a number"), ("K1,1,2,3,target,", "no role")],
)
def test_damaged_control_points_are_told_by_their_line(
    street: tuple[DrivenPass, DrivenPass], tmp_path: Path, line: str, message: str
) -> None:
    path = tmp_path / "control.csv"
    path.write_text(f"id,easting_m,northing_m,height_m,role,where\n{line}\n", encoding="utf-8")
    with pytest.raises(BadFile, match=message):
        _run(street, tmp_path / "out", path)


class _StopsAt(SilentMonitor):
    """Cancels once a share of the work is done."""

    def __init__(self, share: float) -> None:
        self._share, self._done = share, 0.0

    def report(self, fraction: float, text: Text | None = None) -> None:
        self._done = max(self._done, fraction)

    def check(self) -> None:
        if self._done >= self._share:
            raise Cancelled


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_a_cancelled_registration_leaves_nothing(
    street: tuple[DrivenPass, DrivenPass], tmp_path: Path, share: float
) -> None:
    inputs = OperationInputs(
        points=tuple(one.points for one in street),
        trajectories=tuple(one.trajectory for one in street),
        crs=_CRS,
    )
    with pytest.raises(Cancelled):
        register(RegisterOperation(inputs, tmp_path / "out"), _StopsAt(share))
    assert [one.name for one in tmp_path.iterdir() if not one.name.startswith(".")] == []

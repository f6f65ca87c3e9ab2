"""Curbs and gutters on bad recordings: a sentence, and never a line across the road."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import Cancelled
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from tests.processing.methods.road.bad_recordings import (
    HEAD_90,
    ORIGIN,
    ROAD,
    SPEED_M_S,
    START_S,
    TUNNEL,
    WALLS,
    DrivenRecording,
    Floats,
    RunOutcome,
    delivered,
    drawn_along,
    facing_along,
    imported,
    mirrored,
    nearest_to_path_m,
    recorded,
    road_along,
    straight,
    told_by,
    told_of,
    turning_back,
    with_pause,
    write_points,
)

LENGTH_M = 15.0
CLEAR_M = 1.5
"""The vehicle drove there: nothing that stops a wheel can lie nearer to its way."""
BOTH = pytest.mark.parametrize("tool", ["curbs", "gutters"])


def driving(**changes: object) -> DrivenRecording:
    """The plain case: a straight road between two curbs."""
    vehicle_path = straight(LENGTH_M)
    plain = DrivenRecording(vehicle_path, facing_along(vehicle_path), (road_along(LENGTH_M),))
    return replace(plain, **changes)  # type: ignore[arg-type] # by the fields' names


def assert_nothing_found(told: RunOutcome) -> None:
    """No candidate, but a sentence."""
    assert told.candidates == ()
    assert told.sentence.endswith(".")


def assert_clear(told: RunOutcome, vehicle_path: Floats) -> None:
    """Nothing lies where the vehicle drove."""
    assert nearest_to_path_m(told.candidates, vehicle_path) > CLEAR_M


def lines_at(told: RunOutcome, north_m: float) -> float:
    """Metres of lines along the street within 5 cm of a distance to the left of the way."""
    found = 0.0
    for one in told.candidates:
        steps = np.abs(np.diff(one.xyz[:, 0]))
        north = (one.xyz[1:, 1] + one.xyz[:-1, 1]) / 2 - ORIGIN[1]
        found += float(steps[np.abs(north - north_m) < 0.05].sum())
    return found


def test_the_plain_road_has_both_edges_of_both_curbs(tmp_path: Path) -> None:
    recording = driving()
    drives = recorded(tmp_path, recording)
    curbs = told_by("curbs", drives, tmp_path)
    assert_clear(curbs, recording.vehicle_path)
    for side in (-4.01, 4.01):
        assert lines_at(curbs, side) > LENGTH_M


@pytest.mark.parametrize("vehicle_path", ["forward", "reverse", "square"])
def test_the_plain_road_has_no_gutter(tmp_path: Path, vehicle_path: str) -> None:
    recording = driving(head=HEAD_90) if vehicle_path == "square" else driving()
    if vehicle_path == "reverse":
        recording = replace(recording, vehicle_path=recording.vehicle_path[::-1])
    assert_nothing_found(told_by("gutters", recorded(tmp_path, recording), tmp_path))


@BOTH
def test_without_a_trajectory_a_sentence_says_so(tmp_path: Path, tool: str) -> None:
    request = replace(delivered(driving(), tmp_path), trajectories=())
    assert_nothing_found(told_by(tool, imported(tmp_path, request), tmp_path))


@BOTH
def test_walls_alone_are_no_road(tmp_path: Path, tool: str) -> None:
    walls = tuple(road_along(LENGTH_M, profile) for profile in (WALLS, mirrored(WALLS)))
    recording = driving(scene=walls)
    told = told_by(tool, recorded(tmp_path, recording), tmp_path)
    assert_nothing_found(told)


@BOTH
def test_what_hangs_overhead_is_no_road(tmp_path: Path, tool: str) -> None:
    ceiling = road_along(LENGTH_M, ((-10.0, 6.0), (0.0, 6.5), (10.0, 6.0)))
    told = told_by(tool, recorded(tmp_path, driving(scene=(ceiling,))), tmp_path)
    assert_nothing_found(told)


@BOTH
def test_a_vehicle_that_only_stands_has_passed_nothing(tmp_path: Path, tool: str) -> None:
    vehicle_path = np.tile([[8.0, 0.0]], (600, 1))
    recording = driving(vehicle_path=vehicle_path, facing=np.zeros(600))
    told = told_by(tool, recorded(tmp_path, recording), tmp_path)
    assert_nothing_found(told)


@BOTH
def test_a_standstill_on_the_way_leaves_no_line_across_the_road(tmp_path: Path, tool: str) -> None:
    recording = with_pause(driving(), at=300, seconds=3.0)
    drives = recorded(tmp_path, recording)
    told = told_by(tool, drives, tmp_path)
    assert_clear(told, recording.vehicle_path)
    assert lines_at(told, 4.01) < 2.5 * LENGTH_M  # each edge once, not once a pass


def test_a_drive_in_reverse_finds_the_same_curbs(tmp_path: Path) -> None:
    vehicle_path = straight(LENGTH_M)[::-1]
    recording = driving(vehicle_path=vehicle_path, facing=np.zeros(len(vehicle_path)))
    drives = recorded(tmp_path, recording)
    curbs = told_by("curbs", drives, tmp_path)
    assert_clear(curbs, vehicle_path)
    for side in (-4.01, 4.01):
        assert lines_at(curbs, side) > LENGTH_M


@BOTH
def test_a_turn_back_joins_no_lines_across_the_road(tmp_path: Path, tool: str) -> None:
    vehicle_path = turning_back(LENGTH_M, radius_m=3.0)
    wide = tuple((across * 2.0, up) for across, up in ROAD)
    line = np.array([[-25.0, 0.0], [LENGTH_M + 40.0, 0.0]])
    recording = driving(
        vehicle_path=vehicle_path,
        facing=facing_along(vehicle_path),
        scene=(drawn_along(wide, line),),
    )
    drives = recorded(tmp_path, recording)
    assert_clear(told_by(tool, drives, tmp_path), vehicle_path)


@BOTH
def test_lines_in_a_round_tunnel_lie_at_the_foot_of_its_wall_if_anywhere(
    tmp_path: Path, tool: str
) -> None:
    recording = driving(scene=(road_along(LENGTH_M, TUNNEL),))
    drives = recorded(tmp_path, recording)
    told = told_by(tool, drives, tmp_path)
    assert_clear(told, recording.vehicle_path)
    assert all(abs(np.abs(one.xyz[:, 1] - ORIGIN[1]) - 2.6).max() < 0.4 for one in told.candidates)


@BOTH
def test_one_return_a_turn_shows_nothing(tmp_path: Path, tool: str) -> None:
    rare = driving(keep=lambda xyz, pulse: (pulse % 1_000 == 500) & (xyz[:, 2] < 1.0))
    told = told_by(tool, recorded(tmp_path, rare), tmp_path)
    assert_nothing_found(told)


@BOTH
def test_wet_road_with_holes_gives_no_line_round_the_holes(tmp_path: Path, tool: str) -> None:
    def dry(xyz: Floats, pulse: NDArray[np.int64]) -> NDArray[np.bool_]:
        puddle = np.sin(xyz[:, 0] * 1.3) + np.sin(xyz[:, 1] * 1.7 + 0.5 * xyz[:, 0]) > -0.3
        lost = np.random.default_rng(5).random(len(pulse)) < 0.3
        is_dry: NDArray[np.bool_] = (np.abs(xyz[:, 1]) > 3.8) | ~(puddle | lost)
        return is_dry

    recording = driving(keep=dry)
    drives = recorded(tmp_path, recording)
    told = told_by(tool, drives, tmp_path)
    assert nearest_to_path_m(told.candidates, recording.vehicle_path) > 3.5


@BOTH
def test_ten_points_are_no_street(tmp_path: Path, tool: str) -> None:
    few = driving(keep=lambda _, pulse: pulse < np.sort(pulse)[10])
    assert_nothing_found(told_of(tool, delivered(few, tmp_path), tmp_path))


@BOTH
def test_points_without_times_are_no_drive(tmp_path: Path, tool: str) -> None:
    request = delivered(driving(), tmp_path)
    random = np.random.default_rng(0)
    xyz = random.uniform((0, -5, 0), (LENGTH_M, 5, 0.02), (5_000, 3)) + ORIGIN
    times = START_S + np.sort(random.uniform(0, LENGTH_M / SPEED_M_S, len(xyz)))
    times[::2] = np.nan
    write_points(request.inputs[0], xyz, times)
    assert_nothing_found(told_of(tool, request, tmp_path))


def test_a_head_square_to_the_way_finds_the_curbs(tmp_path: Path) -> None:
    recording = driving(head=HEAD_90)
    drives = recorded(tmp_path, recording)
    curbs = told_by("curbs", drives, tmp_path)
    assert_clear(curbs, recording.vehicle_path)
    for side in (-4.01, 4.01):
        assert lines_at(curbs, side) > LENGTH_M


def test_two_drives_five_centimetres_apart_give_each_curb_once(tmp_path: Path) -> None:
    first = delivered(driving(), tmp_path / "a", "left")
    head = replace(HEAD_90, source_id=3)
    again = driving(head=head, start_s=START_S + 900.0, shift_m=(0.0, 0.05, 0.03), seed=1)
    second = delivered(again, tmp_path / "b", "left_2")
    drives = imported(tmp_path, first, second)
    assert len(drives) == 2
    curbs = told_by("curbs", drives, tmp_path)
    assert_clear(curbs, again.vehicle_path)
    for side in (-4.01, 4.01):
        lines = sum(lines_at(curbs, side + shift) for shift in (-0.06, 0.04, 0.14))
        assert LENGTH_M < lines < 3 * LENGTH_M  # the heads see other ends of it


class CancelAtCheck(SilentMonitor):
    """Wants to stop at the so-manyth time that it is asked; takes no going back."""

    def __init__(self, patience: int) -> None:
        self.left = patience
        self.done = 0.0

    def check(self) -> None:
        self.left -= 1
        if self.left < 0:
            raise Cancelled

    def report(self, fraction: float, text: Text | None = None) -> None:
        assert self.done - 1e-9 <= fraction <= 1.0
        self.done = fraction


@BOTH
def test_a_run_stops_whenever_it_is_told_to(tmp_path: Path, tool: str) -> None:
    drives = recorded(tmp_path, driving())
    counted = CancelAtCheck(1_000_000)
    told_by(tool, drives, tmp_path, counted)
    asked = 1_000_000 - counted.left
    assert asked > 1
    for patience in (0, asked // 2, asked - 1):
        with pytest.raises(Cancelled):
            told_by(tool, drives, tmp_path, CancelAtCheck(patience))
    assert not list(tmp_path.glob("* columns"))

"""Following curbs and markings on streets whose lines are known exactly."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.image.tracing.trace import TOLERANCE_M, TraceResult, trace
from processing.recording.drive import Drive
from tests.processing.image.profiled_streets import LOWER, UPPER, ProfiledStreet, off_line, recorded

DROPPED = ((-2.5, 0.05), (0.0, 0.0), (0.012, 0.022), (1.5, 0.07))


def nearest(drive: Drive, position: Floats) -> int:
    return int(np.linalg.norm(drive.xyz(slice(0, drive.count)) - position, axis=1).argmin())


def traced(drive: Drive, line: Floats, *, across_gaps: bool = False) -> TraceResult:
    """A trace between the points nearest to places half a metre inside the ends of a line."""
    start, end = nearest(drive, line[50]), nearest(drive, line[-50])
    return trace(drive, start, end, across_gaps=across_gaps)


def followed_share(result: TraceResult, line: Floats, within_m: float = 0.03) -> float:
    """Share of a line that lies within a distance of the polyline."""
    xyz = result.xyz
    if len(xyz) < 2:
        return 0.0
    dense = [
        a + (b - a) * np.linspace(0, 1, 2 + int(np.linalg.norm(b - a) / 0.01))[:, None]
        for a, b in itertools.pairwise(xyz)
    ]
    return float((off_line(line[50:-50], np.vstack(dense)) <= within_m).mean())


@pytest.mark.parametrize("corner", [LOWER, UPPER], ids=["lower", "upper"])
@pytest.mark.parametrize(
    "street",
    [
        ProfiledStreet(length_m=20.0),
        ProfiledStreet(length_m=20.0, noise_m=0.005),
        ProfiledStreet(length_m=20.0, row_m=0.17, spacing_m=0.05),
        ProfiledStreet(length_m=10.0, row_m=0.05, spacing_m=0.01),
        ProfiledStreet(length_m=20.0, curvature=0.1),
        ProfiledStreet(length_m=20.0, grade=-0.08, heading_rad=2.0),
    ],
    ids=["plain", "noisy", "60 km/h", "dense", "bend of 10 m radius", "steep"],
)
def test_a_curb_edge_is_followed_between_two_clicks(
    tmp_path: Path, street: ProfiledStreet, corner: Floats
) -> None:
    drive = recorded(tmp_path / "drive", street)
    line = street.edge(corner)
    result = traced(drive, line)
    assert result.is_complete
    assert result.reason.en == ""
    assert followed_share(result, line) >= 0.95
    assert followed_share(result, line, 0.02) >= 0.8


def test_the_way_back_is_as_good(tmp_path: Path) -> None:
    street = ProfiledStreet(length_m=20.0)
    drive = recorded(tmp_path / "drive", street)
    line = street.edge(UPPER)
    result = traced(drive, line[::-1])
    assert result.is_complete
    assert followed_share(result, line) >= 0.95


def test_a_dropped_curb_of_two_centimetres_is_followed(tmp_path: Path) -> None:
    street = ProfiledStreet(profile=DROPPED, length_m=12.0, noise_m=0.003)
    drive = recorded(tmp_path / "drive", street)
    line = street.edge(np.array([0.0, 0.0]))
    result = traced(drive, line, across_gaps=True)
    assert followed_share(result, line) >= 0.9


def test_the_points_are_measured_ones_and_begin_and_end_with_the_clicks(tmp_path: Path) -> None:
    street = ProfiledStreet(length_m=10.0)
    drive = recorded(tmp_path / "drive", street)
    line = street.edge(LOWER)
    start, end = nearest(drive, line[50]), nearest(drive, line[-50])
    points = trace(drive, start, end).points
    assert points.dtype == np.int64
    assert (points[0], points[-1]) == (start, end)
    assert np.unique(points).size == points.size


def test_a_straight_curb_needs_few_points(tmp_path: Path) -> None:
    street = ProfiledStreet(length_m=20.0, noise_m=0.001)
    drive = recorded(tmp_path / "drive", street)
    result = traced(drive, street.edge(LOWER))
    assert result.points.size <= 5
    assert TOLERANCE_M == 0.01


def test_it_stops_at_a_parked_car_and_says_so(tmp_path: Path) -> None:
    street = ProfiledStreet(length_m=20.0)
    drive = recorded(tmp_path / "drive", street, hidden=(8.0, 12.5))
    line = street.edge(UPPER)
    result = traced(drive, line)
    assert not result.is_complete
    assert result.reason.en == "The points become sparse here."
    last = result.xyz[-1:]
    assert off_line(last, line)[0] < 0.02
    assert np.linalg.norm(last - line[800]) < 0.7


def test_it_bridges_a_parked_car_when_told(tmp_path: Path) -> None:
    street = ProfiledStreet(length_m=20.0, curvature=0.01)
    drive = recorded(tmp_path / "drive", street, hidden=(8.0, 12.5))
    line = street.edge(UPPER)
    result = traced(drive, line, across_gaps=True)
    assert result.is_complete
    assert followed_share(result, line, 0.05) >= 0.95
    seen = np.concatenate([line[:800], line[1250:]])
    assert (off_line(result.xyz, seen) < 0.03).mean() >= 0.9


def test_a_hole_of_half_a_metre_does_not_stop_it(tmp_path: Path) -> None:
    street = ProfiledStreet(length_m=16.0)
    drive = recorded(tmp_path / "drive", street, hidden=(8.0, 8.5))
    line = street.edge(LOWER)
    result = traced(drive, line)
    assert result.is_complete
    assert followed_share(result, line) >= 0.95


@pytest.mark.parametrize("across", [-1.0, -0.925, -1.075], ids=["middle", "left", "right"])
def test_a_marking_is_followed_along_the_line_that_was_clicked(
    tmp_path: Path, across: float
) -> None:
    street = ProfiledStreet(length_m=16.0, curvature=0.02, spacing_m=0.02)
    drive = recorded(tmp_path / "drive", street)
    line = street.edge(np.array([across, 0.02]))
    result = traced(drive, line)
    assert result.is_complete
    assert followed_share(result, line) >= 0.9


def test_on_a_flat_road_without_paint_there_is_nothing_to_follow(tmp_path: Path) -> None:
    street = ProfiledStreet(profile=((0.1, 0.0), (2.5, 0.0)), noise_m=0.002, length_m=10.0)
    drive = recorded(tmp_path / "drive", street)
    result = traced(drive, street.edge(np.array([1.3, 0.0])))
    assert not result.is_complete
    assert result.points.size == 1
    assert result.reason.en == "There is no edge or marking that passes both points."
    assert result.reason.ja


def test_both_clicks_on_one_point_give_that_point(tmp_path: Path) -> None:
    drive = recorded(tmp_path / "drive", ProfiledStreet())
    point = nearest(drive, ProfiledStreet().edge(LOWER)[200])
    assert trace(drive, point, point).points.tolist() == [point]

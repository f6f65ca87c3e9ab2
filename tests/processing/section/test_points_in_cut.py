"""The points of a slab are those that plain arithmetic finds, and the curb is where it was put."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from processing.recording.drive import Drive
from processing.section import points_in_cut as module
from processing.section.cut import Cut
from processing.section.points_in_cut import ground_near, points_in_cut, section_points
from processing.section.profile import profile_of
from processing.section.stations import Stations
from tests.builders import HEIGHT_M, START
from tests.street_scene import CROSSFALL, CURB_AT_M, CURB_HEIGHT_M

LANE_M = 0.5  # the vehicle drives so far left of the middle


def across(street: Drive, station_m: float = 5.0, width_m: float = 1.0) -> Cut:
    assert street.trajectory is not None
    return Stations.of_trajectory(street.trajectory).cut_at(station_m, width_m, 15.0)


@pytest.mark.parametrize("width_m", [0.0503, 1.0003, 4.0003])
@pytest.mark.parametrize("degrees", [0.0, 25.0, 90.0, 200.0])
def test_exactly_the_points_of_the_slab_are_found(
    street: Drive, width_m: float, degrees: float
) -> None:
    angle = np.radians(degrees)
    middle = tuple((START + np.array([0.7, 5.2, 1.0])).tolist())
    cut = Cut(middle, (float(np.cos(angle)), float(np.sin(angle))), width_m, 6.0003)
    all_xyz = street.xyz(slice(0, street.count))
    expected = np.flatnonzero(cut.holds(cut.to_section(all_xyz)))
    assert expected.size
    assert points_in_cut(street, cut).tolist() == expected.tolist()


def test_too_many_points_are_thinned_evenly(street: Drive) -> None:
    cut = across(street)
    all_ = points_in_cut(street, cut)
    some = points_in_cut(street, cut, most=500)
    assert some.size == 500
    assert set(some.tolist()) <= set(all_.tolist())
    ranks = np.searchsorted(all_, some)
    assert np.diff(ranks).max() <= np.diff(ranks).min() + 1


def test_beside_the_recording_there_is_nothing(street: Drive) -> None:
    far = replace(across(street), middle=(0.0, 0.0, 0.0))
    assert points_in_cut(street, far).size == 0
    assert ground_near(street, far) == -1
    assert profile_of(far, [street]).ground == ()


def test_points_come_by_rising_offset_with_their_places(street: Drive) -> None:
    cut = across(street)
    found = section_points(street, cut)
    assert (np.diff(found.section[:, 0]) >= 0).all()
    assert cut.to_section(street.xyz(found.points)) == pytest.approx(found.section)


@pytest.mark.parametrize("offset_m", [LANE_M - CURB_AT_M, LANE_M + CURB_AT_M])
def test_a_curb_of_15_cm_is_where_it_was_put_and_as_high(
    both_heads: tuple[Drive, Drive], offset_m: float
) -> None:
    cut = across(both_heads[0])
    section = np.concatenate([section_points(drive, cut).section for drive in both_heads])
    foot_m = START[2] - CROSSFALL * CURB_AT_M
    above = section[:, 1] - foot_m
    near = np.abs(section[:, 0] - offset_m) < 0.3
    face = section[near & (above > 0.03) & (above < CURB_HEIGHT_M - 0.03), 0]
    assert face.size > 10
    assert np.abs(face - offset_m).max() < 0.03  # the vehicle sways, its trajectory says so
    assert np.median(face) == pytest.approx(offset_m, abs=0.01)
    inwards = -np.sign(offset_m)
    profile = profile_of(cut, both_heads)
    road, walk = (profile.ground_at(offset_m + side * inwards * 0.1) for side in (1.0, -1.0))
    assert road == pytest.approx(foot_m + CROSSFALL * 0.1, abs=0.01)
    assert walk == pytest.approx(foot_m + CURB_HEIGHT_M, abs=0.01)


def test_the_ground_below_the_vehicle_is_a_point_of_the_road(street: Drive) -> None:
    cut = across(street)
    point = ground_near(street, cut)
    ((offset, height, away),) = cut.to_section(street.xyz(np.array([point]))).tolist()
    assert abs(offset) < 0.2
    assert abs(away) < 0.5
    assert cut.middle[2] - height == pytest.approx(HEIGHT_M + CROSSFALL * LANE_M, abs=0.03)


def test_the_kernels_do_the_same_uncompiled() -> None:
    integers = np.array([[0, 0, 0], [900, 400, 5], [2_000, 0, 0], [0, 600, 0]], np.int32)
    plan = module._CutPlan(0.0, 0.0, 1.0, 0.0, 1.0, 0.5)
    for run in (module._inside_kernel, module._inside_kernel.py_func):  # type: ignore[attr-defined]
        found = np.empty(4, np.int64)
        count = run(integers, np.array([0.001, 0.001]), np.array([[0, 4]]), plan, found)
        assert found[:count].tolist() == [0, 1]

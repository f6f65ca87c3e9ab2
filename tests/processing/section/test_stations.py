"""Stations on lines whose lengths and directions are known."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.errors import Unsuitable
from processing.recording.vehicle_path.trajectory import Trajectory
from processing.section.stations import Stations

CORNER = Stations([(0.0, 0.0, 10.0), (0.0, 20.0, 11.0), (30.0, 20.0, 11.0)])
"""North for twenty metres, then east for thirty."""


def circle(radius_m: float) -> Stations:
    turned = np.linspace(0.0, np.pi / 2, 400)
    positions = radius_m * np.column_stack([1 - np.cos(turned), np.sin(turned), 0 * turned])
    return Stations(positions)


def test_a_station_is_metres_in_plan_from_the_beginning() -> None:
    assert CORNER.length_m == pytest.approx(50.0)
    assert CORNER.position_at(10.0) == pytest.approx((0.0, 10.0, 10.5))
    assert CORNER.position_at(35.0) == pytest.approx((15.0, 20.0, 11.0))
    assert CORNER.nearest((15.0, 26.0, 0.0)) == pytest.approx(35.0)


def test_the_section_across_has_the_left_side_of_the_line_on_its_left() -> None:
    cut = CORNER.cut_at(10.0, 1.0, 15.0)
    (offset, _, away) = cut.to_section([(-3.0, 10.0, 10.5)])[0]
    assert (offset, away) == pytest.approx((-3.0, 0.0))
    along = CORNER.cut_along(10.0, 1.0, 15.0)
    assert along.to_section([(0.0, 14.0, 10.5)])[0, 0] == pytest.approx(4.0)


def test_the_line_goes_straight_on_and_level_beyond_its_ends() -> None:
    assert CORNER.position_at(-5.0) == pytest.approx((0.0, -5.0, 10.0))
    assert CORNER.position_at(53.0) == pytest.approx((33.0, 20.0, 11.0))
    assert CORNER.nearest((4.0, -5.0, 0.0)) == pytest.approx(-5.0)
    assert CORNER.nearest((36.0, 25.0, 0.0)) == pytest.approx(56.0)


@pytest.mark.parametrize("position", [(-9.0, 24.0), (-2.0, 31.0), (5.0, 6.0), (31.0, 3.0)])
def test_the_cut_found_for_a_place_goes_through_it_at_bends_too(
    position: tuple[float, float],
) -> None:
    for stations in (CORNER, circle(30.0)):
        station = stations.through((*position, 0.0))
        cut = stations.cut_at(station, 1.0, 15.0)
        assert cut.to_section([(*position, 0.0)])[0, 2] == pytest.approx(0.0, abs=1e-3)


def test_a_place_that_is_passed_twice_is_found_on_the_pass_that_is_meant() -> None:
    there_and_back = Stations([(0, 0, 0), (0, 100, 0), (5, 100, 0), (5, 0, 0)])
    assert there_and_back.nearest((3.0, 40.0, 0.0)) == pytest.approx(165.0)
    assert there_and_back.nearest((3.0, 40.0, 0.0), (20.0, 80.0)) == pytest.approx(40.0)


def test_a_vehicle_that_trembles_at_rest_gets_no_further() -> None:
    random = np.random.default_rng(2)
    driven = np.column_stack([np.zeros(400), np.linspace(0, 40, 400), np.zeros(400)])
    rest = driven[199] + np.column_stack([random.normal(0, 0.004, (4_000, 2)), np.zeros(4_000)])
    xyz = np.concatenate([driven[:200], rest, driven[200:]])
    trajectory = Trajectory.from_positions(np.arange(len(xyz)) * 0.005, xyz)
    stations = Stations.of_trajectory(trajectory)
    assert stations.length_m == pytest.approx(40.0, abs=0.05)
    assert stations.station_at_time(float(trajectory.time[-1])) == pytest.approx(stations.length_m)
    assert stations.station_at_time(-1.0) is None
    assert CORNER.station_at_time(0.0) is None


def test_the_outline_of_an_area_leads_back_to_its_beginning() -> None:
    square = Stations([(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)], is_closed=True)
    assert square.length_m == pytest.approx(40.0)
    assert square.position_at(35.0) == pytest.approx((0.0, 5.0, 0.0))


def test_where_a_line_turns_back_its_own_side_gives_the_direction() -> None:
    hairpin = Stations([(0, 0, 0), (0, 10, 0), (0, 0, 0)])
    assert hairpin.direction_at(10.0) == pytest.approx((0.0, -1.0))


@pytest.mark.parametrize("positions", [[], [(0, 0, 0)], [(0, 0, 0), (0, 0, 5)]])
def test_a_line_without_length_in_plan_is_refused(positions: list[tuple[int, int, int]]) -> None:
    with pytest.raises(Unsuitable):
        Stations(positions)

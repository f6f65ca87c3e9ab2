"""The vehicle's path, its stations, and the round lengths of a scale bar."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtGui import QImage, QPainter

from processing.recording.drive import Drive
from widgets.map_view.map_decorations import (
    metres,
    paint_north,
    paint_scale_bar,
    paint_vehicle_paths,
    round_down,
    round_step,
)
from widgets.map_view.vehicle_path import VehiclePath, vehicle_paths_of
from widgets.plane_view.viewport import PlaneViewport

BEND = VehiclePath(np.array([[0.0, 0.0], [30.0, 0.0], [30.0, -40.0]]), np.array([0.0, 30.0, 70.0]))
"""Thirty metres to the east, then forty to the north."""


def test_stations_are_metres_along_the_path() -> None:
    assert BEND.ends == (0.0, 70.0)
    assert BEND.at(np.array([10.0, 50.0])).tolist() == [[10.0, 0.0], [30.0, -20.0]]
    assert BEND.directions(np.array([10.0, 50.0]), 1.0).tolist() == [[1.0, 0.0], [0.0, -1.0]]
    assert BEND.station_near((31.0, -39.0)) == 70.0
    assert BEND.distance_to((30.0, 5.0)) == 5.0


def test_scanners_of_one_vehicle_share_a_path(left_drive: Drive, right_drive: Drive) -> None:
    (vehicle_path,) = vehicle_paths_of([left_drive, right_drive])
    first, last = vehicle_path.ends
    # The trajectory begins half a second before the first point, at 8 m/s.
    assert first == pytest.approx(4.0, abs=0.3)
    assert last - first == pytest.approx(10.0, abs=0.3)
    assert (np.diff(vehicle_path.stations) > 0).all()


@pytest.mark.parametrize(
    ("least", "step"), [(0.7, 1.0), (1.0, 1.0), (1.1, 2.0), (3.0, 5.0), (51.0, 100.0), (0.02, 0.02)]
)
def test_a_step_is_the_next_round_length(least: float, step: float) -> None:
    assert round_step(least) == pytest.approx(step)


@pytest.mark.parametrize(
    ("most", "bar"), [(0.7, 0.5), (1.0, 1.0), (9.9, 5.0), (2.5, 2.0), (1999.0, 1000.0)]
)
def test_a_bar_is_the_last_round_length_that_fits(most: float, bar: float) -> None:
    assert round_down(most) == pytest.approx(bar)


def test_lengths_have_their_unit() -> None:
    lengths = [metres(one) for one in (5000.0, 20.0, 0.5, 0.05, 0.002)]
    assert lengths == ["5 km", "20 m", "0.5 m", "5 cm", "2 mm"]


@pytest.mark.parametrize("scale", [1e-4, 0.05, 4.0, 1e4])
def test_all_is_painted_at_any_scale(scale: float) -> None:
    image = QImage(300, 200, QImage.Format.Format_RGB32)
    image.fill(0)
    viewport = PlaneViewport(300.0, 200.0, scale, (15.0, 0.0))
    with QPainter(image) as painter:
        paint_vehicle_paths(painter, viewport, (BEND,))
        paint_scale_bar(painter, viewport)
        paint_north(painter, viewport)
    assert max(image.pixelColor(x, 100).value() for x in range(140, 160)) > 100

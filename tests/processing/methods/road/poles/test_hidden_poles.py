"""A pole behind a wall, of which only what stands above the wall was measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.laboratory.simulate.scene.mesh import box, tube
from processing.methods.road.objects.survey import survey_columns
from processing.methods.road.poles.shafts import find_hidden_shafts, find_shafts
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    ORIGIN,
    DrivenRecording,
    facing_along,
    recorded,
    road_along,
    straight,
)

LENGTH_M = 32.0
FLOOR_M = 0.15
PROFILE = ((-14.0, FLOOR_M), (-4.0, FLOOR_M), (4.0, FLOOR_M), (14.0, FLOOR_M))
PLACE, RADIUS_M, WALL_M = np.array([20.0, -8.0]), 0.14, 2.4


def test_a_pole_behind_a_wall_is_found_by_what_shows_above_it(tmp_path: Path) -> None:
    ends = np.array([[*PLACE, -0.2], [*PLACE, 8.0]])
    wall = (17.0, PLACE[1] + 0.2, 0.0), (23.0, PLACE[1] + 0.35, WALL_M)
    scene = road_along(LENGTH_M, PROFILE), tube(ends, np.full(2, RADIUS_M), 32), box(*wall)
    way, monitor = straight(LENGTH_M), SilentMonitor()
    driven = DrivenRecording(way, facing_along(way), scene, head=HEAD_45, pulses=3_000)
    drives = recorded(tmp_path, driven)
    below, columns = survey_columns(drives, monitor)
    standing = find_shafts(drives, below.plan, columns.posts, monitor)
    (pole,) = find_hidden_shafts(drives, below.plan, columns.raised, standing, monitor)
    foot = pole.foot + below.plan.origin - ORIGIN
    assert foot[:2] == pytest.approx(PLACE, abs=0.03)
    assert foot[2] == pytest.approx(FLOOR_M, abs=0.1)
    assert pole.low_m > 1.8
    assert pole.radius_at(4.0) == pytest.approx(RADIUS_M, abs=0.005)

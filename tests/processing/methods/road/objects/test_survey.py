"""The ground that all searches along a street begin with: made once, and anew with other noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.methods.road.objects.survey import survey_columns, survey_ground
from processing.recording.drive import Drive
from tests.processing.methods.road.bad_recordings import (
    DrivenRecording,
    facing_along,
    recorded,
    road_along,
    straight,
)

LENGTH_M = 12.0
NOISE = 18


@pytest.fixture
def drives(tmp_path: Path) -> tuple[Drive, ...]:
    """A short bare road."""
    way = straight(LENGTH_M)
    return recorded(tmp_path, DrivenRecording(way, facing_along(way), (road_along(LENGTH_M),)))


def test_the_ground_is_made_once_for_all_searches(drives: tuple[Drive, ...]) -> None:
    monitor = SilentMonitor()
    ground = survey_ground(drives, monitor)
    below, columns = survey_columns(drives, monitor)
    assert below is ground
    assert survey_columns(drives, monitor)[1] is columns
    assert np.isfinite(ground.heights).any()


def test_ground_and_columns_are_made_anew_when_other_points_are_noise(
    drives: tuple[Drive, ...],
) -> None:
    monitor, drive = SilentMonitor(), drives[0]
    before, columns = survey_columns(drives, monitor)
    xyz = drive.xyz(slice(0, drive.count))
    middle = np.median(xyz, axis=0)
    near = (np.abs(xyz[:, :2] - middle[:2]) < 3.0).all(axis=1)
    codes = np.where(near, NOISE, 0).astype(np.uint8)
    drive.columns.add("classification", codes)
    after = survey_ground(drives, monitor)
    assert after is not before
    assert not np.array_equal(after.heights, before.heights, equal_nan=True)
    assert survey_columns(drives, monitor)[1] is not columns

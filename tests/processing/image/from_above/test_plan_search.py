"""The road below a drive, and the measured point that one sees from above."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from processing.image.from_above.plan_ground import ceilings_above, ground_along
from processing.image.from_above.plan_points import PlanPoints, PointQuery
from processing.image.images_of_drives import image_of
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.builders import START
from tests.widgets.builders import imported_drive

KIND = ImageKind.TRAJECTORY_CENTER


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    """A street of ten metres with curbs, walls and poles."""
    street = imported_drive(tmp_path_factory.mktemp("plan"))
    image_of(street, KIND).pyramid.prepare()
    return street


def test_the_road_lies_where_the_scene_has_it(drive: Drive) -> None:
    ground = ground_along(drive)
    assert len(ground) > 50
    # The road falls by 2 % to both sides of the middle, which the vehicle follows.
    assert ground[:, 2] == pytest.approx(START[2], abs=0.08)


def test_a_drive_without_trajectory_has_no_road(drive: Drive, tmp_path: Path) -> None:
    folder = tmp_path / "copy"
    shutil.copytree(drive.folder, folder)
    (folder / "trajectory.npy").unlink()
    assert ground_along(Drive(folder)).shape == (0, 3)


def test_the_ceiling_follows_the_nearest_place_of_the_road_and_ends_far_from_it() -> None:
    ground = np.array([[0.0, 0.0, 10.0], [100.0, 0.0, 20.0]])
    positions = np.array([[5.0, 3.0], [90.0, 2.0], [0.0, 500.0]])
    assert ceilings_above(ground, positions, 3.0).tolist() == [13.0, 23.0, np.inf]


def test_a_place_where_a_point_lies_gives_that_point(drive: Drive) -> None:
    points = PlanPoints(((drive, KIND),))
    random = np.random.default_rng(2)
    for point in random.integers(0, drive.count, 40).tolist():
        x, y, _ = drive.xyz(np.array([point]))[0].tolist()
        found = points.point_at(PointQuery(x, y, 0.0, 0.05))
        assert found is not None
        there = drive.xyz(np.array([found[1]]))[0]
        # Another one may lie exactly below or above it, as on a wall.
        assert found[1] == point or np.hypot(there[0] - x, there[1] - y) <= 0.002


def test_of_what_is_close_the_highest_surface_is_seen(drive: Drive) -> None:
    """Close to a wall's foot one sees its top; with a ceiling, what is below that."""
    xyz = drive.xyz(slice(None))
    top = int(xyz[:, 2].argmax())
    x, y, z = xyz[top].tolist()
    points = PlanPoints(((drive, KIND),))
    found = points.point_at(PointQuery(x, y, 0.3, 0.5))
    assert found is not None
    assert drive.xyz(np.array([found[1]]))[0, 2] >= z - 0.1
    limited = points.point_at(PointQuery(x, y, 0.3, 0.5, ceiling_m=z - 1.0))
    assert limited is not None
    assert drive.xyz(np.array([limited[1]]))[0, 2] <= z - 1.0


def test_nothing_is_found_where_no_point_is_in_reach(drive: Drive) -> None:
    points = PlanPoints(((drive, KIND),))
    far = drive.info.highest[0] + 50.0
    assert points.point_at(PointQuery(far, START[1], 0.1, 1.0)) is None
    assert points.point_at(PointQuery(START[0], START[1], 0.1, 1.0, ceiling_m=0.0)) is None
    assert PlanPoints(()).point_at(PointQuery(0.0, 0.0, 1.0, 1.0)) is None

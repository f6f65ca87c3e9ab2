"""Ground points written as LAS and LAZ and read again by laspy."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import InUse, OutOfRange
from processing.core.monitor import SilentMonitor
from processing.formats.points.ground_las import write_ground_las
from processing.methods.earthwork.surfaces.sides import EpochGround, GroundBlock

LOW, HIGH = np.array([-12_400.25, -36_700.5, 4.0]), np.array([-12_300.0, -36_600.0, 9.0])


def _ground() -> EpochGround:
    random = np.random.default_rng(3)
    parts = [np.round(random.uniform(LOW, HIGH, (count, 3)), 3) for count in (500, 0, 70)]

    def blocks() -> Iterator[GroundBlock]:
        return (GroundBlock(xyz, station) for station, xyz in enumerate(parts))

    return EpochGround("施工後", blocks, LOW, HIGH, np.empty((0, 3)), crs="EPSG:6677")


@pytest.mark.parametrize("name", ["地面.laz", "ground.LAS"])
def test_all_ground_points_are_there_to_the_millimetre(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    ground = _ground()
    assert write_ground_las(path, ground, SilentMonitor()) == 570
    expected = np.concatenate([block.xyz for block in ground.blocks()])
    cloud = laspy.read(path)
    np.testing.assert_allclose(cloud.xyz, expected, atol=1e-9)
    assert set(np.unique(cloud.classification)) == {2}
    assert np.bincount(cloud.point_source_id).tolist() == [0, 500, 0, 70]
    assert cloud.header.are_points_compressed is (path.suffix == ".laz")
    crs = cloud.header.parse_crs()
    assert crs is not None
    assert crs.to_epsg() == 6677


def test_another_ending_and_a_delivered_file_are_refused(tmp_path: Path) -> None:
    with pytest.raises(OutOfRange):
        write_ground_las(tmp_path / "ground.xyz", _ground(), SilentMonitor())
    delivered = tmp_path / "after.laz"
    delivered.write_bytes(b"delivered")
    with pytest.raises(InUse):
        write_ground_las(delivered, _ground(), SilentMonitor(), never=(delivered,))
    assert delivered.read_bytes() == b"delivered"
    assert len(list(tmp_path.iterdir())) == 1

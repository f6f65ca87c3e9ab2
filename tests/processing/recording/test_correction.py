"""A corrected drive is, for everything that asks, one whose points were delivered elsewhere."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.monitor import SilentMonitor
from processing.image.images_of_drives import image_of
from processing.image.neighbourhoods.points_around import neighbours
from processing.image.search.enclosed_points import Sight, points_enclosed
from processing.image.search.nearest import nearest_point
from processing.image.search.ray_hits import RayHits, RaySight
from processing.labels.strokes import points_under_brush
from processing.map.drafting.heights import set_on_ground
from processing.methods.ground.drive_points import DrivePoints
from processing.project.results.point_results import write_point_results
from processing.recording.columns.columns import ColumnWriter, column_path
from processing.recording.drive import Drive
from processing.recording.drive_part import write_part
from processing.section.points_in_cut import points_in_cut, section_points
from processing.section.stations import Stations
from processing.tools.tool import FinishedColumns
from tests.older_project import forget_all_sums
from tests.widgets.builders import imported_drive


@dataclass(frozen=True)
class Drift:
    """Points drift off ever faster, to the side and up, the farther from the middle the more."""

    start_s: float
    key: str = "drift"
    by_m_s: tuple[float, float, float] = (0.71234, -1.3, 0.4)
    reach_m: float = 6.0

    def shifts(self, time: Floats, xyz: Floats) -> Floats:
        shifts = (time - self.start_s)[:, None] ** 2 * np.array(self.by_m_s)
        shifts[:, 2] += (xyz[:, 0] - np.rint(xyz[:, 0])) / 10
        return np.asarray(shifts)


@dataclass(frozen=True)
class Pair:
    """A drive with a correction, the same without, and one delivered at the corrected places."""

    corrected: Drive
    plain: Drive
    moved: Drive


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> Pair:
    plain = imported_drive(tmp_path_factory.mktemp("corrected"))
    drift = Drift(float(plain.columns["time"][0]))
    moved = plain.folder.with_name("moved")
    shutil.copytree(plain.folder, moved, ignore=shutil.ignore_patterns("tile_bounds_*"))
    scale = np.array(plain.info.scale)
    shifts = drift.shifts(plain.columns["time"], plain.xyz(slice(None)))
    integers = (plain.columns["xyz"] + np.rint(shifts / scale)).astype("<i4")
    forget_all_sums(moved)
    column_path(moved, "xyz").write_bytes(integers.tobytes())
    return Pair(Drive(plain.folder, correction=drift), plain, Drive(moved))


def test_points_lie_where_the_correction_moves_them(pair: Pair) -> None:
    drive, everything = pair.corrected, slice(None)
    drift = drive.coordinates.correction
    assert drift is not None
    wanted = pair.plain.xyz(everything)
    shifts = drift.shifts(pair.plain.columns["time"], wanted)
    assert np.abs(shifts).max() > 1.0
    # On the grid of the delivery, so never off by more than half a step of it.
    assert np.abs(drive.xyz(everything) - wanted - shifts).max() <= 0.5001 * drive.info.scale[0]
    np.testing.assert_array_equal(drive.xyz(everything), pair.moved.xyz(everything))
    points = np.array([5, 3, 3, 900])
    np.testing.assert_array_equal(drive.xyz(points), drive.xyz(everything)[points])
    origin = np.array([-11_020.0, -35_010.0, 123.0])
    np.testing.assert_array_equal(
        drive.local_xyz(points, origin), pair.moved.local_xyz(points, origin)
    )
    low, high = np.array(drive.info.lowest), np.array(drive.info.highest)
    assert ((drive.xyz(everything) >= low) & (drive.xyz(everything) <= high)).all()


def test_without_a_correction_nothing_is_other_than_before(pair: Pair) -> None:
    drive = pair.plain
    integers, scale = np.array(drive.columns["xyz"]), np.array(drive.info.scale)
    offset, origin = np.array(drive.info.offset), drive.xyz(np.array([7]))[0]
    np.testing.assert_array_equal(drive.xyz(slice(None)), integers * scale + offset)
    local = (integers * scale + (offset - origin)).astype(np.float32)
    np.testing.assert_array_equal(drive.local_xyz(slice(None), origin), local)
    assert not drive.coordinates.moved_m(0, drive.count).any()


@pytest.mark.parametrize("kind", range(4))
def test_tiles_are_where_the_points_are_and_are_kept_apart(pair: Pair, kind: int) -> None:
    images = [image_of(one, one.image_kinds[kind]) for one in (pair.corrected, pair.moved)]
    tables = [image.pyramid.table for image in images]
    np.testing.assert_array_equal(tables[0], tables[1])
    name = pair.plain.image_kinds[kind].value
    assert (pair.plain.folder / f"tile_bounds_{name}_drift.npy").is_file()
    again = Drive(pair.plain.folder, correction=pair.corrected.coordinates.correction)
    np.testing.assert_array_equal(image_of(again, again.image_kinds[kind]).pyramid.table, tables[0])
    assert (image_of(pair.plain, pair.plain.image_kinds[kind]).pyramid.table != tables[0]).any()


def test_searches_find_the_points_where_they_are_now(pair: Pair) -> None:
    one, other = pair.corrected, pair.moved
    for point in (10, one.count // 2, one.count - 5):
        xyz = other.xyz(np.array([point]))[0]
        assert nearest_point(one, xyz, 0.5) == nearest_point(other, xyz, 0.5) >= 0
        found = points_under_brush(one, xyz, xyz + 0.3, 0.4)
        assert found.size > 1
        np.testing.assert_array_equal(found, points_under_brush(other, xyz, xyz + 0.3, 0.4))
        np.testing.assert_array_equal(neighbours(one, point, 0.5), neighbours(other, point, 0.5))
    places = [tuple(xyz.tolist()) for xyz in other.xyz(np.array([50, 9_000]))]
    assert set_on_ground(places, [one]) == set_on_ground(places, [other])


def test_sections_cut_the_points_where_they_are_now(pair: Pair) -> None:
    assert pair.plain.trajectory is not None
    cut = Stations.of_trajectory(pair.plain.trajectory).cut_at(7.0, 1.0, 15.0)
    found, wanted = section_points(pair.corrected, cut), section_points(pair.moved, cut)
    np.testing.assert_array_equal(found.points, wanted.points)
    np.testing.assert_array_equal(found.section, wanted.section)
    assert found.points.size > 100
    assert points_in_cut(pair.plain, cut).tolist() != sorted(found.points.tolist())


def test_clicks_and_lassos_take_the_points_where_they_are_now(pair: Pair) -> None:
    target = pair.moved.xyz(np.array([pair.moved.count - 500]))[0]
    matrix = np.array([[50.0, 3, 0, 400], [0, 0, -50.0, 300], [0, 0, 0, 1], [0, 1.0, 0, 50]])
    sight = RaySight(matrix, target, 0.05, (400.0, 300.0))
    hits, lassos = [], []
    outline = np.array([[380.0, 280], [460, 290], [410, 360]])
    for drive in (pair.corrected, pair.moved):
        image = image_of(drive, drive.image_kinds[0])
        found = RayHits(sight)
        for key in image.pyramid.keys(0):
            found.search_tile(drive, image, key, None)
        hits.append(found.best())
        lassos.append(points_enclosed(drive, image, Sight(matrix[:3], target, 0.05), outline))
    assert hits[0] is not None
    assert (hits[0].point, hits[0].offset_px) == (hits[1].point, hits[1].offset_px)  # type: ignore[union-attr]
    assert lassos[0].size > 10
    np.testing.assert_array_equal(*lassos)


def test_tools_and_parts_get_the_points_where_they_are_now(pair: Pair, tmp_path: Path) -> None:
    one, other = (
        DrivePoints((drive,), 10_000, SilentMonitor()) for drive in (pair.corrected, pair.moved)
    )
    np.testing.assert_array_equal(np.vstack(list(one.blocks())), np.vstack(list(other.blocks())))
    np.testing.assert_array_equal(one.chunks[0].high, other.chunks[0].high)
    part = write_part(
        pair.corrected,
        lambda start, stop: np.arange(start, stop) % 3 == 0,
        tmp_path / "part",
        SilentMonitor(),
        beside=lambda _start, _stop: {},
    )
    np.testing.assert_array_equal(part.xyz(slice(None)), pair.moved.xyz(slice(None, None, 3)))


def test_exported_files_hold_the_points_where_they_are_now(pair: Pair, tmp_path: Path) -> None:
    drive, source = pair.corrected, pair.corrected.delivered_files[0]
    (tmp_path / "found").mkdir()
    with ColumnWriter(tmp_path / "found") as writer:
        writer.append({"segment": np.arange(drive.count)})
    result = FinishedColumns(tmp_path / "found", ("segment",), drive.count)
    (path,) = write_point_results([(drive, result)], tmp_path / "out.laz", SilentMonitor())
    before, after = laspy.read(source), laspy.read(path)
    written = np.asarray(after.xyz)[np.argsort(np.asarray(after["segment"]))]
    np.testing.assert_allclose(written, drive.xyz(slice(None)), atol=1e-7)
    np.testing.assert_allclose(after.header.mins, written.min(axis=0), atol=1e-7)
    np.testing.assert_allclose(after.header.maxs, written.max(axis=0), atol=1e-7)
    np.testing.assert_array_equal(after.gps_time, before.gps_time)
    (path,) = write_point_results([(pair.plain, result)], tmp_path / "as.laz", SilentMonitor())
    as_delivered = laspy.read(path)
    np.testing.assert_array_equal(as_delivered.X, before.X)
    np.testing.assert_array_equal(as_delivered.header.mins, before.header.mins)


@pytest.mark.parametrize("far_m", [1e9, np.nan])
def test_points_that_would_leave_the_grid_are_refused(pair: Pair, far_m: float) -> None:
    drive = Drive(pair.plain.folder, correction=Drift(0.0, by_m_s=(far_m, 0.0, 0.0)))
    with pytest.raises(Unsuitable):
        drive.xyz(slice(0, 10))
